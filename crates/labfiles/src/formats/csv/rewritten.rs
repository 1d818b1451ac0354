//! Texts that become a table of cells with one column for each quantity: what a microcontroller prints with a label before
//! each number, the blocks of a NI `SignalExpress` export, tables on their side, and clocks in several columns.

use std::fmt::Write as _;

use super::{clock_columns, turned};
use crate::bytes::to_usize;
use crate::source::ReadError;
use crate::text::{TextFile, clock, decode, number};
use crate::units::parse_unit;

/// Bytes at the front of a file by which it is recognised.
const FRONT_BYTES: usize = 1 << 13;
/// Lines that are looked at, and how many of ten must be labelled: the first may be cut, or a greeting.
const LINES: usize = 60;
const MOST_OF_TEN: usize = 8;
/// Fewest lines.
const FEWEST_LINES: usize = 4;
/// What heads the blocks of `SignalExpress`.
const SIGNAL_EXPRESS: [&str; 4] = ["channel names:", "start times:", "dt:", "data:"];

/// The text as a table of cells; as it is where it is one.
pub(super) fn plain(text: TextFile) -> Result<TextFile, ReadError> {
    let front = text.head(FRONT_BYTES)?;
    let front = decode(&front);
    let lines: Vec<&str> = front.lines().filter(|l| !l.trim().is_empty()).collect();
    let express = lines.first().is_some_and(|l| heads(l, SIGNAL_EXPRESS[0]));
    let labels = labels(&lines);
    let of_clock = clock_columns::are_there(&lines);
    if !express && labels.is_none() && !of_clock {
        let short = text.length() <= turned::MOST_BYTES as u64;
        return Ok(match turned::upright(&front).filter(|_| short) {
            Some(table) => TextFile::of_bytes(text.path(), table.into_bytes()),
            None => text,
        });
    }
    let whole = text.range(text.start(), to_usize(text.length()))?;
    if of_clock && let Some(table) = clock_columns::joined(&whole) {
        return Ok(TextFile::of_bytes(text.path(), table.into_bytes()));
    }
    let whole = decode(&whole);
    let table = match labels {
        Some(labels) if !express => of_labels(&whole, &labels),
        _ => of_signal_express(&whole),
    };
    Ok(match table {
        Some(table) => TextFile::of_bytes(text.path(), table.into_bytes()),
        None => text,
    })
}

fn heads(line: &str, word: &str) -> bool {
    line.trim().eq_ignore_ascii_case(word)
}

/// Names, start, step and rows of `channel names:`, `start times:`, `dt:` and `data:`, each above its cells. The step is
/// that of the first channel; with unlike ones the text stays as it is.
fn of_signal_express(text: &str) -> Option<String> {
    let mut lines = text.lines().filter(|l| !l.trim().is_empty()).peekable();
    let mut stated: [&str; 3] = [""; 3];
    while let Some(line) = lines.next() {
        if heads(line, SIGNAL_EXPRESS[3]) {
            break;
        }
        let key = SIGNAL_EXPRESS.iter().position(|key| heads(line, key))?;
        stated[key] = lines.next()?.trim_end();
    }
    let [names, starts, steps] = stated;
    let cells = |line: &str| {
        line.split('\t')
            .map(str::trim)
            .filter(|c| !c.is_empty())
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let steps = cells(steps);
    let step = steps
        .first()
        .filter(|first| steps.iter().all(|s| s == *first))?;
    let mut table = format!("# dt = {step}\n");
    if let Some(start) = cells(starts).first() {
        writeln!(table, "# start_time = {start}").ok()?;
    }
    writeln!(table, "{}", cells(names).join("\t")).ok()?;
    for line in lines {
        writeln!(table, "{}", line.trim_end()).ok()?;
    }
    Some(table)
}

/// The labels that most lines have, in their order; `None` where there are none.
fn labels(lines: &[&str]) -> Option<Vec<String>> {
    let some = &lines[..lines.len().min(LINES)];
    let each: Vec<Option<Vec<String>>> = some
        .iter()
        .map(|line| labelled(line).map(|found| found.into_iter().map(|l| l.name).collect()))
        .collect();
    let usual = each.iter().flatten().max_by_key(|own| {
        let like = each.iter().flatten().filter(|other| other == own);
        (like.count(), own.len())
    })?;
    let like = each.iter().flatten().filter(|own| *own == usual).count();
    (like >= FEWEST_LINES && 10 * like >= MOST_OF_TEN * some.len()).then(|| usual.clone())
}

/// A table of the numbers behind labels; other lines, as a greeting or one that was cut, are left out.
fn of_labels(text: &str, labels: &[String]) -> Option<String> {
    let rows = text.lines().filter_map(labelled);
    let mut rows = rows
        .filter(|row| row.iter().map(|l| &l.name).eq(labels))
        .peekable();
    let heading = rows.peek()?.iter().map(Label::heading);
    let mut table = heading.collect::<Vec<_>>().join(",");
    table.push('\n');
    for row in rows {
        let cells: Vec<&str> = row.iter().map(|l| l.value).collect();
        writeln!(table, "{}", cells.join(",")).ok()?;
    }
    Some(table)
}

/// A number behind its label.
struct Label<'a> {
    name: String,
    value: &'a str,
    unit: &'a str,
}

impl Label<'_> {
    fn heading(&self) -> String {
        if self.unit.is_empty() {
            self.name.clone()
        } else {
            format!("{} [{}]", self.name, self.unit)
        }
    }
}

/// What the stamp of a serial monitor is called.
const STAMP: &str = "stamp";

/// The numbers of a line, each behind a label and a colon or an equals sign, with a unit or none behind; a stamp of a serial
/// monitor, `12:00:00.010 -> `, before them is one of them. `None` where anything else is in the line.
fn labelled(line: &str) -> Option<Vec<Label<'_>>> {
    let (stamp, rest) = match line.split_once("->") {
        Some((stamp, rest)) => (Some(stamp.trim()), rest),
        None => (None, line),
    };
    let mut found = Vec::new();
    if let Some(value) = stamp {
        clock::parse(value, false)?;
        found.push(Label {
            name: STAMP.to_owned(),
            value,
            unit: "",
        });
    }
    let mut rest = rest.trim();
    while !rest.is_empty() {
        let (name, behind) = rest.split_at(rest.find([':', '='])?);
        let name = name.trim();
        let word = name.starts_with(char::is_alphabetic)
            && name
                .chars()
                .all(|c| c.is_alphanumeric() || matches!(c, '_' | ' ' | '.'));
        let behind = behind[1..].trim_start();
        let (_, taken) = number::parse_prefix(behind.as_bytes(), b'.').filter(|_| word)?;
        let (value, after) = behind.split_at(taken);
        let after = after.trim_start_matches([' ', '\t']);
        let end = after
            .find([' ', '\t', ',', ';', '|'])
            .unwrap_or(after.len());
        let unit = &after[..end];
        let is_unit = !unit.contains([':', '=']) && parse_unit(unit).is_some();
        let unit = if is_unit { unit } else { "" };
        rest = after[unit.len()..].trim_start_matches([' ', '\t', ',', ';', '|']);
        found.push(Label {
            name: name.to_owned(),
            value,
            unit,
        });
    }
    let numbers = found.len() > usize::from(stamp.is_some());
    numbers.then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn rewritten(text: &str) -> String {
        let file = TextFile::of_bytes(Path::new("r.txt"), text.as_bytes().to_vec());
        let table = plain(file).unwrap();
        decode(&table.range(0, 1 << 16).unwrap())
    }

    #[test]
    fn labels_become_headings() {
        let log = "Ready.\nt:123 ax:0.02\nt:133 ax:-0.01\nt:14\nt:153 ax:1e-2\nt:163 ax:0.03\nt:173 ax:0\n\
                   t:183 ax:0\nt:193 ax:0\nt:203 ax:0\nt:213 ax:0\n";
        assert!(rewritten(log).starts_with("t,ax\n123,0.02\n133,-0.01\n153,1e-2\n"));
        let units = "millis = 10, Distance: 12.5 cm\n".repeat(5);
        assert!(rewritten(&units).starts_with("millis,Distance [cm]\n10,12.5\n"));
        let monitor = "12:00:00.010 -> x:1,y:2\n".repeat(5);
        assert!(rewritten(&monitor).starts_with("stamp,x,y\n12:00:00.010,1,2\n"));
    }

    #[test]
    fn blocks_of_signal_express_become_a_table() {
        let export = "channel names: \nDev1_ai0\tDev1_ai1\nstart times: \n1/2/2020 14:22:31.5\t1/2/2020 14:22:31.5\n\
                      dt: \n0.002\t0.002\ndata: \n0.1\t0.2\n0.3\t0.4\n";
        assert_eq!(
            rewritten(export),
            "# dt = 0.002\n# start_time = 1/2/2020 14:22:31.5\nDev1_ai0\tDev1_ai1\n0.1\t0.2\n0.3\t0.4\n"
        );
    }

    #[test]
    fn tables_stay_as_they_are() {
        for text in [
            "t,x\n0,1\n1,2\n2,3\n3,4\n",
            "rate: 2000\nunit: mm\n1\n2\n3\n4\n5\n",
            "12:00:01,1\n12:00:02,2\n12:00:03,3\n12:00:04,4\n",
        ] {
            assert_eq!(rewritten(text), text);
        }
    }
}
