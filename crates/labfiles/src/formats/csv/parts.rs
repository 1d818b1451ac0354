//! Tables side by side: several runs in one sheet, each with its own time, or channels with times of their own.

use crate::formats::csv::columns::HeadRows;
use crate::formats::csv::header::{Header, without_number};
use crate::formats::csv::time_axis::{head_of, heads_pair, is_further};
use crate::text::table::{Kind, Layout};
use crate::timing::{is_time_name, is_unit_of_time, numbers_rows};
use crate::units::{Dimension, parse_unit};

/// A table beside others, or the only one.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Part {
    /// Its name, empty for the only one.
    pub name: String,
    /// Its columns in the whole table, its time first.
    pub columns: Vec<usize>,
    /// What its columns are called in it.
    pub names: Vec<String>,
}

/// How a table is made up.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Makeup {
    /// One table with one time axis, or none.
    One,
    /// Several runs of the same quantities.
    Runs(Vec<Part>),
    /// One table whose columns have times of their own: for each column the one with its time.
    OwnTimes(Vec<Option<usize>>),
    /// Tables beside the remarks on them, as some oscilloscopes write, one for each channel.
    BesideRemarks(Vec<Block>),
}

/// A table beside the remarks on it.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Block {
    /// Its columns, its time first.
    pub part: Part,
    /// The remarks.
    pub remarks: Vec<(String, String)>,
    /// Whether its times are not those of the first block.
    pub own_time: bool,
}

impl Block {
    /// Its columns without a time that is that of the first block.
    pub(crate) fn kept(&self) -> &[usize] {
        &self.part.columns[usize::from(!self.own_time)..]
    }
}

/// Find out how a table is made up; `times` are the columns that may be time axes.
pub(crate) fn find(
    header: &Header,
    layout: &Layout,
    rows: &HeadRows<'_>,
    times: &[usize],
) -> Makeup {
    let kinds = &layout.kinds[..];
    if let Some(blocks) = beside_remarks(header, kinds, rows) {
        return Makeup::BesideRemarks(blocks);
    }
    let filled = |i: usize| rows.column(i).any(|c| !c.is_empty());
    let used: Vec<usize> = (0..kinds.len())
        .filter(|&i| filled(i) || header.names[i] != format!("column_{}", i + 1))
        .collect();
    let lists = lists_of_runs(header, kinds, &used);
    let head = |c: usize| head_of(layout, rows, c);
    let lists = lists
        .or_else(|| numbered_times(header, head, &used, times))
        .or_else(|| numbered_heights(header, head, &used));
    if let Some(parts) = lists {
        return Makeup::Runs(parts);
    }
    let blocks = blocks(&used, times, |axis, column| {
        is_time_name(&header.names[column])
            || heads_pair(header, column)
            || is_further(header, layout, rows, [axis, column])
    });
    if blocks.len() < 2 {
        return shared_time(header, kinds, &used, times).map_or(Makeup::One, Makeup::Runs);
    }
    match runs(header, &blocks, rows) {
        Some(parts) => Makeup::Runs(parts),
        None => Makeup::OwnTimes(own_times(kinds.len(), &blocks)),
    }
}

/// A time column and the columns after it, up to the next: those before the first belong to its block, and a
/// time column without any is a further column of the block before. `is_axis` tells whether a time column beside the first
/// block's is the time of what follows it.
fn blocks(
    used: &[usize],
    times: &[usize],
    is_axis: impl Fn(usize, usize) -> bool,
) -> Vec<Vec<usize>> {
    let mut blocks: Vec<Vec<usize>> = Vec::new();
    let mut before = Vec::new();
    for (place, &column) in used.iter().enumerate() {
        let next = used.get(place + 1);
        let precedes = times.contains(&column) && next.is_some_and(|n| !times.contains(n));
        let first = blocks.first().map(|block| block[0]);
        let heads = precedes && first.is_none_or(|axis| is_axis(axis, column));
        match (heads, blocks.last_mut()) {
            (true, _) => {
                let mut block = vec![column];
                block.append(&mut before);
                blocks.push(block);
            }
            (false, Some(block)) => block.push(column),
            (false, None) => before.push(column),
        }
    }
    blocks
}

fn own_times(columns: usize, blocks: &[Vec<usize>]) -> Vec<Option<usize>> {
    let mut own = vec![None; columns];
    for block in blocks {
        for &column in &block[1..] {
            own[column] = Some(block[0]);
        }
    }
    own
}

/// Words that name one of several runs, lower case.
const RUN_WORDS: [&str; 16] = [
    "run",
    "trial",
    "throw",
    "drop",
    "take",
    "test",
    "measurement",
    "repeat",
    "data set",
    "dataset",
    "versuch",
    "messung",
    "wurf",
    "durchgang",
    "lauf",
    "mesure",
];

/// Bare names whose numbers tell channels apart, not runs, lower case.
const CHANNELS: [&str; 9] = [
    "ch", "channel", "kanal", "c", "ai", "sensor", "probe", "analog", "mass",
];

/// A name without what tells its run, and that: `Time Run #2` is `Time` of `Run #2`.
///
/// ```
/// use labfiles::without_run;
/// assert_eq!(without_run("Position Run #2"), Some(("Position".into(), "Run #2".into())));
/// assert_eq!(without_run("Position"), None);
/// ```
pub fn without_run(name: &str) -> Option<(String, String)> {
    let lower = name.to_lowercase();
    if lower.len() != name.len() {
        return None;
    }
    let latest = lower.find("latest").map(|at| (at, at + "latest".len()));
    let (from, to) = latest.or_else(|| RUN_WORDS.iter().find_map(|word| numbered(&lower, word)))?;
    let bare = format!("{} {}", &name[..from], &name[to..]);
    let bare = bare.trim_matches(|c: char| {
        c.is_whitespace() || matches!(c, ':' | ',' | '-' | '_' | '(' | ')')
    });
    Some((bare.to_owned(), name[from..to].trim().to_owned()))
}

/// Where a word with a number after it stands in a text.
fn numbered(text: &str, word: &str) -> Option<(usize, usize)> {
    let starts = text.match_indices(word).map(|(at, _)| at);
    let mut alone = starts.filter(|&at| !text[..at].ends_with(char::is_alphanumeric));
    alone.find_map(|at| {
        let rest = &text[at + word.len()..];
        let number = rest.trim_start_matches([' ', '#', '_', '-', '.']);
        let digits = number.len()
            - number
                .trim_start_matches(|c: char| c.is_ascii_digit())
                .len();
        (digits > 0).then(|| (at, text.len() - number.len() + digits))
    })
}

/// Blocks that hold the same quantities, as runs: their headings differ by the name of the run, or by a number.
fn runs(header: &Header, blocks: &[Vec<usize>], rows: &HeadRows<'_>) -> Option<Vec<Part>> {
    let by_word = parts_of(header, blocks, &|name| without_run(name));
    by_word.or_else(|| {
        let channel =
            |name: &str| CHANNELS.contains(&without_number(name).0.to_lowercase().as_str());
        let mut columns = blocks.iter().flatten();
        let repeated = repeated_headings(header, blocks);
        if columns.any(|&c| channel(&header.names[c])) || !(repeated || unlike_times(blocks, rows))
        {
            return None;
        }
        parts_of(header, blocks, &|name| Some(without_number(name)))
    })
}

/// Whether all headings of the first block come again in the others, which the reader numbers: `t 2`.
fn repeated_headings(header: &Header, blocks: &[Vec<usize>]) -> bool {
    let (first, others) = (&blocks[0], &blocks[1..]);
    let plain = |column: &usize| !header.names[*column].ends_with(|c: char| c.is_ascii_digit());
    let numbered = |column: &usize| {
        let name = &header.names[*column];
        name.rsplit_once(' ')
            .is_some_and(|(_, number)| number.bytes().all(|b| b.is_ascii_digit()))
    };
    first.iter().all(plain) && others.iter().flatten().all(numbered)
}

/// Whether the times of the blocks differ in the head: two sensors at the same times are one run.
fn unlike_times(blocks: &[Vec<usize>], rows: &HeadRows<'_>) -> bool {
    let time = |block: &Vec<usize>| {
        rows.column(block[0])
            .map(<[u8]>::to_vec)
            .collect::<Vec<_>>()
    };
    let first = time(&blocks[0]);
    blocks[1..].iter().any(|block| time(block) != first)
}

/// The blocks as parts, if the bare names and units of each are those of the first, or the first of them.
fn parts_of(
    header: &Header,
    blocks: &[Vec<usize>],
    bare: &dyn Fn(&str) -> Option<(String, String)>,
) -> Option<Vec<Part>> {
    let mut parts: Vec<Part> = Vec::new();
    for (number, block) in blocks.iter().enumerate() {
        let split: Option<Vec<(String, String)>> =
            block.iter().map(|&c| bare(&header.names[c])).collect();
        let split = split?;
        let unit = |k: usize| &header.units[block[k]];
        if let Some(first) = parts.first() {
            let same = |k: usize| {
                let alike = first.names.get(k) == Some(&split[k].0);
                alike && header.units[first.columns[k]] == *unit(k)
            };
            if !(0..block.len()).all(same) {
                return None;
            }
        }
        let run = split.iter().map(|(_, run)| run).find(|run| !run.is_empty());
        parts.push(Part {
            name: run.cloned().unwrap_or_else(|| (number + 1).to_string()),
            columns: block.clone(),
            names: split.into_iter().map(|(name, _)| name).collect(),
        });
    }
    let mut names: Vec<&str> = parts.iter().map(|p| p.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    let distinct = names.len() == parts.len();
    if !distinct {
        parts
            .iter_mut()
            .enumerate()
            .for_each(|(number, part)| part.name = (number + 1).to_string());
    }
    let named = parts
        .iter()
        .all(|p| p.names.iter().all(|name| !name.is_empty()));
    named.then_some(parts)
}

/// What the only column of a list is called whose heading names its run alone: of times, and of heights.
const TIMES: &str = "time";
const HEIGHTS: &str = "height";

/// Words for a height, lower case.
const HEIGHT_WORDS: [&str; 8] = [
    "h",
    "height",
    "rebound",
    "rebound height",
    "höhe",
    "hoehe",
    "hauteur",
    "altezza",
];

/// Whether a name is that of a height alone.
fn is_height(name: &str) -> bool {
    HEIGHT_WORDS.contains(&name.to_lowercase().as_str())
}

/// Whether a unit is one of length.
fn is_length(unit: &str) -> bool {
    parse_unit(unit).is_some_and(|u| u.dimension == Dimension::Length)
}

/// Lists of times or of heights that are called after runs alone (`Throw 1 (ms)`, `Throw 2 (ms)`), or after what they hold too
/// (`Throw 1 height`), with no other column but such that count the rows: one time axis for all would be wrong.
fn lists_of_runs(header: &Header, kinds: &[Kind], used: &[usize]) -> Option<Vec<Part>> {
    let numbers = |c: &usize| kinds[*c] == Kind::Number;
    if !used.iter().all(numbers) {
        return None;
    }
    let lists = no_counts(header, used).into_iter();
    let list = |column: usize| {
        let (bare, run) = without_run(&header.names[column])?;
        let unit = header.units[column].as_deref()?;
        let (name, own) = if is_unit_of_time(unit) {
            (TIMES, is_time_name(&bare))
        } else if is_length(unit) {
            (HEIGHTS, is_height(&bare))
        } else {
            return None;
        };
        let part = || Part {
            name: run,
            columns: vec![column],
            names: vec![name.to_owned()],
        };
        (bare.is_empty() || own).then(part)
    };
    let parts: Vec<Part> = lists.map(list).collect::<Option<_>>()?;
    let known = |(k, part): (usize, &Part)| parts[..k].iter().any(|p| p.name == part.name);
    let repeated = parts.iter().enumerate().any(known);
    (parts.len() > 1 && !repeated).then_some(parts)
}

/// The columns that do not count the rows.
fn no_counts(header: &Header, used: &[usize]) -> Vec<usize> {
    let columns = used.iter().copied();
    columns.filter(|c| !counts(header, *c)).collect()
}

/// Lists of times that are called times and numbered (`Zeit 1 (s)`, `Zeit 2 (s)`; all may lack the unit), with no other column but
/// such that count the rows: each is one run's. Where they rise along all rows, or fall, the rows are the runs, or times of one.
fn numbered_times(
    header: &Header,
    head: impl Fn(usize) -> Vec<f64>,
    used: &[usize],
    times: &[usize],
) -> Option<Vec<Part>> {
    let lists = no_counts(header, used);
    let first = header.units[*lists.first()?].as_deref();
    let list = |&column: &usize| {
        let (bare, number) = without_number(&header.names[column]);
        let unit = header.units[column].as_deref();
        let timed = unit.map_or(first.is_none(), is_unit_of_time);
        let of_times = is_time_name(&bare) && !number.is_empty() && timed;
        (of_times && times.contains(&column)).then(|| Part {
            name: header.names[column].clone(),
            columns: vec![column],
            names: vec![TIMES.to_owned()],
        })
    };
    let parts: Vec<Part> = lists.iter().map(list).collect::<Option<_>>()?;
    let heads: Vec<Vec<f64>> = lists.iter().map(|c| head(*c)).collect();
    let longest = heads.iter().map(Vec::len).max()?;
    let in_row = |row: usize| heads.iter().filter_map(move |h| h.get(row).copied());
    let rise = (0..longest).all(|row| in_row(row).is_sorted());
    let fall = (0..longest).all(|row| in_row(row).is_sorted_by(|a, b| a >= b));
    (parts.len() > 1 && !rise && !fall).then_some(parts)
}

/// How many times what lies between columns beside each other heights fall from row to row, at least, where each column is a
/// throw: along the rows of one throw they fall more.
const ALIKE: f64 = 4.0;

/// Lists of heights that are called so and numbered (`h1 (cm)`, `h2 (cm)`), each of which falls from row to row while they are alike
/// along the rows, with no other column but such that count the rows: each is one throw's.
fn numbered_heights(
    header: &Header,
    head: impl Fn(usize) -> Vec<f64>,
    used: &[usize],
) -> Option<Vec<Part>> {
    let lists = no_counts(header, used);
    let list = |&column: &usize| {
        let (bare, number) = without_number(&header.names[column]);
        let length = header.units[column].as_deref().is_some_and(is_length);
        (is_height(&bare) && !number.is_empty() && length).then(|| Part {
            name: header.names[column].clone(),
            columns: vec![column],
            names: vec![HEIGHTS.to_owned()],
        })
    };
    let parts: Vec<Part> = lists.iter().map(list).collect::<Option<_>>()?;
    let heads: Vec<Vec<f64>> = lists.iter().map(|c| head(*c)).collect();
    let steps = |column: &Vec<f64>| -> Vec<f64> {
        let falls = column.windows(2).map(|w| (w[0] / w[1]).ln());
        falls.collect()
    };
    let least = heads.iter().flat_map(steps).fold(f64::INFINITY, f64::min);
    let beside = heads.windows(2).flat_map(|two| {
        let pairs = two[0].iter().zip(&two[1]);
        pairs.map(|(a, b)| (a / b).ln().abs()).collect::<Vec<_>>()
    });
    let mut beside: Vec<f64> = beside.collect();
    beside.sort_by(f64::total_cmp);
    let typical = *beside.get(beside.len() / 2)?;
    (parts.len() > 1 && least.is_finite() && least > ALIKE * typical).then_some(parts)
}

/// Whether a column counts the rows, by its heading.
fn counts(header: &Header, column: usize) -> bool {
    header.units[column].is_none() && numbers_rows(&header.names[column])
}

/// Runs that share one time: every other column is named for one of several.
fn shared_time(
    header: &Header,
    kinds: &[Kind],
    used: &[usize],
    times: &[usize],
) -> Option<Vec<Part>> {
    let [time, ..] = *times else { return None };
    let others = used
        .iter()
        .copied()
        .filter(|&c| c != time && kinds[c] == Kind::Number);
    let mut parts: Vec<Part> = Vec::new();
    for column in others {
        let (bare, run) = without_run(&header.names[column])?;
        let part = match parts.iter().position(|p| p.name == run) {
            Some(known) => &mut parts[known],
            None => {
                parts.push(Part {
                    name: run,
                    columns: vec![time],
                    names: vec![header.names[time].clone()],
                });
                parts.last_mut()?
            }
        };
        let bare = if bare.is_empty() {
            "value".to_owned()
        } else {
            bare
        };
        part.columns.push(column);
        part.names.push(bare);
    }
    let same = parts.iter().all(|p| p.names == parts[0].names);
    (parts.len() > 1 && same).then_some(parts)
}

/// Fewest remarks beside a table.
const FEWEST_REMARKS: usize = 3;

/// Tables each of whose first columns hold remarks, a word and its value, in its first rows, and nothing below.
fn beside_remarks(header: &Header, kinds: &[Kind], rows: &HeadRows<'_>) -> Option<Vec<Block>> {
    let unnamed = |i: usize| header.names[i] == format!("column_{}", i + 1);
    let mut starts: Vec<usize> = (0..kinds.len())
        .filter(|&i| unnamed(i) && holds_words(rows, i))
        .collect();
    // values that are words too
    starts.dedup_by(|own, before| *own == *before + 1);
    if starts.first() != Some(&0) {
        return None;
    }
    let ends = starts.iter().skip(1).copied().chain([kinds.len()]);
    let mut blocks: Vec<Block> = Vec::new();
    for (start, end) in starts.iter().copied().zip(ends) {
        let mut block = block(header, kinds, rows, start..end)?;
        let same = |first: &Block| {
            let [a, b] = [first, &block].map(|b| b.part.columns[0]);
            rows.column(a).eq(rows.column(b))
        };
        block.own_time = !blocks.first().is_some_and(same);
        if block.own_time && !blocks.is_empty() {
            block.part.names[0] = format!("Time {}", blocks.len() + 1);
        }
        blocks.push(block);
    }
    Some(blocks)
}

/// Whether a column holds words in its first rows, and nothing below.
fn holds_words(rows: &HeadRows<'_>, column: usize) -> bool {
    let cells = rows.column(column).filter(|cell| !cell.is_empty());
    let words: Vec<String> = cells.map(crate::text::decode).collect();
    let is_word = |word: &String| word.starts_with(|c: char| c.is_alphabetic());
    words.len() >= FEWEST_REMARKS
        && 2 * words.len() < rows.lines.len().max(2 * FEWEST_REMARKS + 1)
        && words.iter().all(is_word)
}

/// The table of numbers in some columns, of which the first two hold the remarks on it.
fn block(
    header: &Header,
    kinds: &[Kind],
    rows: &HeadRows<'_>,
    within: std::ops::Range<usize>,
) -> Option<Block> {
    let start = within.start;
    let whole = |i: &usize| kinds[*i] == Kind::Number && rows.column(*i).all(|c| !c.is_empty());
    let empty = |i: &usize| rows.column(*i).all(<[u8]>::is_empty);
    let from = (start + 2..within.end).find(whole)?;
    let mut after = from..within.end;
    if !after.all(|i| whole(&i) || empty(&i)) {
        return None;
    }
    let columns: Vec<usize> = (from..within.end).filter(whole).collect();
    if columns.len() < 2 {
        return None;
    }
    let words = rows.column(start).map(crate::text::decode);
    let values = rows.column(start + 1).map(crate::text::decode);
    let remarks = words
        .zip(values)
        .filter(|(k, v)| !k.is_empty() && !v.is_empty());
    let remarks: Vec<(String, String)> = remarks.collect();
    let mut names: Vec<String> = columns.iter().map(|&i| header.names[i].clone()).collect();
    names[0] = "Time".to_owned();
    let source = remarks.iter().find(|(key, _)| key == "Source");
    if let (Some((_, source)), 2) = (source, names.len()) {
        names[1].clone_from(source);
    }
    let part = Part {
        name: String::new(),
        columns,
        names,
    };
    Some(Block {
        part,
        remarks,
        own_time: true,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_runs_are_told_from_what_was_measured() {
        for (name, bare, run) in [
            ("Time Run #2", "Time", "Run #2"),
            ("Run 1: Position", "Position", "Run 1"),
            ("Latest: Time", "Time", "Latest"),
            ("y (Versuch 3)", "y", "Versuch 3"),
            ("Throw_12 height", "height", "Throw_12"),
        ] {
            assert_eq!(without_run(name), Some((bare.into(), run.into())), "{name}");
        }
        for name in ["Time", "turn 2", "Position, Ch 1", "running"] {
            assert_eq!(without_run(name), None, "{name}");
        }
        assert_eq!(without_number("y 2"), ("y".into(), "2".into()));
        assert_eq!(without_number("y2"), ("y".into(), "2".into()));
    }
}
