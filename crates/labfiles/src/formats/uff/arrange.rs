//! From the functions of a file to datasets and channels.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::header::{Freedom, Header};
use super::samples::{self, Side};
use super::sets::{Function, Sets};
use crate::bytes::FileBytes;
use crate::conventions::{STARTS_KEY, Span};
use crate::source::{ChannelInfo, Clock, DatasetInfo, StoredType};

/// The datasets of a file and the origins of their channels.
pub(super) type Arranged = (Vec<DatasetInfo>, Vec<Vec<(usize, Side)>>);

/// What distinguishes one channel of a record from another, and one record from the next.
type Identity<'a> = (i64, [&'a Freedom; 2], Option<&'a str>);

fn identity(header: &Header) -> Identity<'_> {
    let freedoms = [&header.response, &header.reference];
    (header.function, freedoms, header.axes[1].label.as_deref())
}

/// Whether two functions have the same abscissa: even ones by their headers, uneven ones value by
/// value. `known` is the first one's, once it was read.
fn same_abscissa(
    file: &FileBytes,
    first: &Function,
    other: &Function,
    known: &mut Option<Vec<f64>>,
) -> bool {
    let (x, y) = (&first.header, &other.header);
    if x.even && y.even && x.over_time() && y.over_time() {
        return span(first).overlaps(span(other)) || of_stated_starts(x, y);
    }
    let alike = x.even == y.even && first.samples == other.samples && x.axes[0] == y.axes[0];
    if x.even || !alike {
        return alike && x.start == y.start && x.increment == y.increment;
    }
    let read = |f: &Function| samples::read(file, f, Side::Abscissa).ok()?.into_real();
    if known.is_none() {
        *known = read(first);
    }
    known.is_some() && *known == read(other)
}

/// The time that a function at even times covers.
fn span(function: &Function) -> Span {
    let unit_s = function.header.abscissa_s();
    Span {
        start_s: function.header.start * unit_s,
        length_s: function.samples as f64 * function.header.increment * unit_s,
    }
}

/// Whether two functions are channels of one record whose starts our own writer states.
fn of_stated_starts(first: &Header, other: &Header) -> bool {
    let mut stated = first.lines[3..].iter().filter_map(|line| pairs(line));
    let states = stated.any(|pairs| pairs.iter().any(|(name, _)| name == STARTS_KEY));
    states && first.lines[1..] == other.lines[1..] && first.load_case == other.load_case
}

/// Group functions that follow each other with the same abscissa, or at the same time; a channel that comes again with
/// the same names, or at another time or load case, begins the next record.
fn group(file: &FileBytes, functions: &[Function]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut known = None;
    let mut seen: HashMap<Identity<'_>, Vec<usize>> = HashMap::new();
    for (index, function) in functions.iter().enumerate() {
        let header = &function.header;
        let before = seen.get(&identity(header)).map_or(&[][..], Vec::as_slice);
        let again = before.iter().take(8).any(|&other| {
            let other = &functions[other].header;
            let moved = other.lines[2] != header.lines[2] || other.load_case != header.load_case;
            moved || other.lines == header.lines
        });
        let last = groups.last().filter(|_| !again);
        if !last.is_some_and(|g| same_abscissa(file, &functions[g[0]], function, &mut known)) {
            groups.push(Vec::new());
            seen.clear();
            known = None;
        }
        if let Some(group) = groups.last_mut() {
            group.push(index);
        }
        seen.entry(identity(header)).or_default().push(index);
    }
    groups
}

/// Names of the functions of a dataset: the first kind of name that distinguishes them.
fn names(headers: &[&Header]) -> Vec<String> {
    let kinds: [fn(&Header) -> Option<String>; 4] = [
        |h| h.response.name.clone(),
        |h| h.response.place(),
        |h| Some(h.lines[0].clone()).filter(|line| !line.is_empty()),
        |h| h.axes[1].label.clone(),
    ];
    for kind in kinds {
        let all: Option<Vec<String>> = headers.iter().map(|h| kind(h)).collect();
        if let Some(all) = all {
            let distinct: HashSet<&String> = all.iter().collect();
            if distinct.len() == all.len() {
                return all;
            }
        }
    }
    let any = |h: &Header| kinds.iter().find_map(|kind| kind(h)).unwrap_or_default();
    let numbered = headers.iter().enumerate();
    numbered
        .map(|(k, h)| format!("{} #{}", any(h), k + 1).trim_start().to_owned())
        .collect()
}

/// Names of the datasets: none for a single one; those that the second lines state, if our own writer put
/// them there, else numbers.
fn record_names(sets: &Sets, groups: &[Vec<usize>]) -> Vec<String> {
    let numbered = (1..=groups.len()).map(|number| number.to_string());
    match groups {
        [_] => vec![String::new()],
        _ => stated_names(sets, groups).unwrap_or_else(|| numbered.collect()),
    }
}

/// The second lines as names, where they are names as `labfiles-write` writes them: one for all functions
/// of a record and no other, beside the record's number as load case.
fn stated_names(sets: &Sets, groups: &[Vec<usize>]) -> Option<Vec<String>> {
    let mut seen = HashSet::new();
    let numbers = 1i64..;
    let named = |(members, number): (&Vec<usize>, i64)| {
        let mut headers = members.iter().map(|&m| &sets.functions[m].header);
        let name = &sets.functions[members[0]].header.lines[1];
        let alike = headers.all(|h| h.lines[1] == *name && h.load_case == number);
        (alike && !name.is_empty() && seen.insert(name)).then(|| name.clone())
    };
    groups.iter().zip(numbers).map(named).collect()
}

/// Arrange the functions of a file as datasets.
pub(super) fn arrange(file: &FileBytes, sets: &Sets) -> Arranged {
    let groups = group(file, &sets.functions);
    let record_names = record_names(sets, &groups);
    let mut arranged: Arranged = (Vec::new(), Vec::new());
    for ((number, members), name) in groups.iter().enumerate().zip(record_names) {
        let headers: Vec<&Header> = members.iter().map(|&m| &sets.functions[m].header).collect();
        let first = &sets.functions[members[0]];
        let (mut channels, mut origins) = (Vec::new(), Vec::new());
        if !(first.header.even && first.header.over_time()) {
            channels.push(abscissa(first));
            origins.push((members[0], Side::Abscissa));
        }
        for (&member, name) in members.iter().zip(names(&headers)) {
            channels.push(ordinate(sets, &sets.functions[member], name));
            origins.push((member, Side::Ordinate));
        }
        let time_axis = (first.header.over_time() && !first.header.even).then_some(0);
        let attributes = attributes(sets, first, number);
        arranged.0.push(DatasetInfo {
            name,
            channels,
            time_axis,
            attributes,
        });
        arranged.1.push(origins);
    }
    arranged
}

fn abscissa(function: &Function) -> ChannelInfo {
    let header = &function.header;
    let axis = &header.axes[0];
    let fallback = match axis.kind {
        17 => "time",
        18 => "frequency",
        _ => "abscissa",
    };
    let double = header.even || header.double();
    ChannelInfo {
        name: axis.label.clone().unwrap_or_else(|| fallback.to_owned()),
        unit: axis.unit.clone(),
        stored: StoredType::Float(if double { 64 } else { 32 }),
        samples: function.samples,
        sample_rate_hz: None,
        start_time: header.start_time(),
        clock: Clock::Shared,
        start_s: None,
        properties: BTreeMap::new(),
    }
}

fn ordinate(sets: &Sets, function: &Function, name: String) -> ChannelInfo {
    let header = &function.header;
    let bits = if header.double() { 64 } else { 32 };
    let system = function.system.map(|index| &sets.systems[index]);
    let of = |axis: usize| {
        let axis = &header.axes[axis];
        axis.unit
            .clone()
            .or_else(|| system.and_then(|system| system.unit(axis.kind)))
    };
    let unit = match (of(1), of(2)) {
        (Some(numerator), Some(denominator)) => Some(format!("({numerator})/({denominator})")),
        (numerator, _) => numerator,
    };
    let rate = header.sample_rate_hz();
    let timed = header.even && header.over_time() && rate.is_finite() && rate > 0.0;
    ChannelInfo {
        name,
        unit,
        stored: if header.complex() {
            StoredType::Complex(bits)
        } else {
            StoredType::Float(bits)
        },
        samples: function.samples,
        sample_rate_hz: timed.then_some(rate),
        start_time: header.start_time(),
        clock: Clock::Shared,
        start_s: timed.then(|| header.start_s()),
        properties: header.properties(),
    }
}

/// Attributes that a line holds as `name=value; name=value`, as our own files have them.
fn pairs(line: &str) -> Option<Vec<(String, String)>> {
    let pair = |text: &str| {
        let (name, value) = text.split_once('=')?;
        let (name, value) = (name.trim(), value.trim());
        let word = !name.is_empty() && !name.contains(char::is_whitespace);
        word.then(|| (name.to_owned(), value.to_owned()))
    };
    line.split(';').map(pair).collect()
}

/// Names and unit system of the file, and the identification of the record. The file's names go
/// with its first datasets only, so that many small records do not multiply them.
fn attributes(sets: &Sets, first: &Function, number: usize) -> BTreeMap<String, String> {
    let mut all = BTreeMap::new();
    if number < 1000 {
        all.extend(sets.model.iter().cloned());
    }
    let system = first.system.map(|index| sets.systems[index].attributes());
    all.extend(system.into_iter().flatten());
    all.extend(first.header.named_lines());
    for line in &first.header.lines[3..] {
        all.extend(pairs(line).into_iter().flatten());
    }
    all.insert("load_case_id".into(), first.header.load_case.to_string());
    all
}
