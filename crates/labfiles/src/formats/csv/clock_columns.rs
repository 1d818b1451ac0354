//! Clocks whose hours, minutes and seconds stand in columns of their own.

use crate::text::decode;
use crate::units::split_unit;

/// Lines at the front of a file among which the heading is looked for.
const LINES: usize = 40;
/// What the columns of the parts of a time of day are called, lower case, in their order.
const PARTS: [&[&str]; 4] = [
    &[
        "h", "hh", "hr", "hour", "hours", "stunde", "stunden", "std", "heure",
    ],
    &["m", "mm", "min", "mins", "minute", "minutes", "minuten"],
    &[
        "s", "ss", "sec", "secs", "second", "seconds", "sekunde", "sekunden", "sek", "seconde",
    ],
    &[
        "ms",
        "msec",
        "millis",
        "millisecond",
        "milliseconds",
        "millisekunde",
        "millisekunden",
    ],
];
/// What the column of the whole time is called.
const NAME: &str = "Time";

/// Where the columns of a clock stand.
struct Place {
    /// The line of the heading.
    line: usize,
    separator: char,
    /// The column of the hours; minutes and seconds follow.
    first: usize,
    /// Three columns, four with milliseconds.
    parts: usize,
}

/// Whether the first lines of a file have a heading with columns of hours, minutes and seconds.
pub(super) fn are_there(lines: &[&str]) -> bool {
    place(lines).is_some()
}

/// The table with one column of the time of day in place of those of its parts.
pub(super) fn joined(bytes: &[u8]) -> Option<String> {
    let text = decode(bytes);
    let lines: Vec<&str> = text.lines().collect();
    let found = place(&lines)?;
    let mut table = String::with_capacity(text.len());
    for (number, line) in lines.iter().enumerate() {
        if number < found.line {
            table.push_str(line);
        } else {
            table.push_str(&joined_line(line, &found));
        }
        table.push('\n');
    }
    Some(table)
}

fn place(lines: &[&str]) -> Option<Place> {
    let in_line = |(line, text): (usize, &&str)| {
        let separator = [';', '\t', ','].into_iter().find(|s| text.contains(*s))?;
        let cells: Vec<String> = text.split(separator).map(word).collect();
        let is = |part: usize, cell: Option<&String>| {
            cell.is_some_and(|cell| PARTS[part].contains(&cell.as_str()))
        };
        let begins = |at: &usize| (0..3).all(|part| is(part, cells.get(at + part)));
        let first = (0..cells.len()).find(begins)?;
        let parts = 3 + usize::from(is(3, cells.get(first + 3)));
        Some(Place {
            line,
            separator,
            first,
            parts,
        })
    };
    lines.iter().enumerate().take(LINES).find_map(in_line)
}

/// A heading without its unit, blanks and quotes, lower case.
fn word(cell: &str) -> String {
    let bare = cell.trim().trim_matches('"');
    split_unit(bare).0.trim().to_lowercase()
}

fn joined_line(line: &str, found: &Place) -> String {
    let cells: Vec<&str> = line.split(found.separator).collect();
    let range = found.first..found.first + found.parts;
    let Some(parts) = cells.get(range.clone()) else {
        return line.to_owned();
    };
    let parts: Vec<&str> = parts.iter().map(|c| c.trim().trim_matches('"')).collect();
    let filled = parts
        .iter()
        .all(|part| part.starts_with(|c: char| c.is_ascii_digit()));
    let time = match parts[..] {
        [h, m, s] if filled => format!("{h:0>2}:{m:0>2}:{}", two_digits(s)),
        [h, m, s, ms] if filled => format!("{h:0>2}:{m:0>2}:{s:0>2}.{ms:0>3}"),
        _ => NAME.to_owned(),
    };
    let mut all = cells[..range.start].to_vec();
    all.push(&time);
    all.extend(&cells[range.end..]);
    all.join(&found.separator.to_string())
}

/// Seconds with two digits before their decimal mark.
fn two_digits(seconds: &str) -> String {
    let whole = seconds.chars().take_while(char::is_ascii_digit).count();
    format!("{}{seconds}", "0".repeat(2usize.saturating_sub(whole)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_time_of_day_become_one_column() {
        let of = |text: &str| joined(text.as_bytes());
        let log = "Logger 7\nHour,Minute,Second,Position (m)\n9,59,9.995,0.1\n10,0,0.000,0.2\n";
        let one = "Logger 7\nTime,Position (m)\n09:59:09.995,0.1\n10:00:00.000,0.2\n";
        assert_eq!(of(log).as_deref(), Some(one));
        let german = "Datum;Stunde;Minute;Sekunde;Millisekunde;Weg\r\n1.5.2026;9;5;7;5;1,5\r\n";
        let one = "Datum;Time;Weg\n1.5.2026;09:05:07.005;1,5\n";
        assert_eq!(of(german).as_deref(), Some(one));
        assert_eq!(of("Time (s),x\n0,1\n1,2\n"), None);
        assert_eq!(of("m,s,h\n0,1,2\n"), None);
    }
}
