//! Rows at the end of a table that sum it up: an average, a standard deviation.

use crate::source::ReadError;
use crate::text::{TextFile, decode};

/// Bytes at the end of a file in which rows that sum it up are looked for.
const TAIL_BYTES: usize = 1 << 12;
/// What the first filled cell of such a row says, lower case.
const WORDS: [&str; 40] = [
    "average",
    "averages",
    "avg",
    "avg.",
    "mean",
    "means",
    "mean value",
    "median",
    "mittel",
    "mittelwert",
    "durchschnitt",
    "moyenne",
    "media",
    "std",
    "std.",
    "std dev",
    "std. dev.",
    "stddev",
    "stdev",
    "st. dev.",
    "st dev",
    "standard deviation",
    "sd",
    "sem",
    "standard error",
    "std error",
    "standardabweichung",
    "stabw",
    "stabw.",
    "écart-type",
    "ecart-type",
    "min",
    "max",
    "minimum",
    "maximum",
    "range",
    "sum",
    "summe",
    "variance",
    "varianz",
];

/// Where the rows that sum a table up begin, and what they are called.
pub(super) struct Summary {
    pub(super) at: u64,
    names: Vec<String>,
}

impl Summary {
    /// A note that they are left out.
    pub(super) fn note(&self) -> String {
        let rows = if self.names.len() == 1 { "row" } else { "rows" };
        let names = self.names.join(", ");
        format!("the last {rows} ({names}) sum up those above, and are left out")
    }
}

/// The rows at the end of a table that sum it up; none where no row is above them.
pub(super) fn begins(text: &TextFile) -> Result<Option<Summary>, ReadError> {
    let from = text
        .length()
        .saturating_sub(TAIL_BYTES as u64)
        .max(text.start());
    let tail = text.range(from, TAIL_BYTES)?;
    let mut found: Option<Summary> = None;
    let mut end = tail.len();
    while end > 0 {
        let begin = memchr::memrchr(b'\n', &tail[..end - 1]).map_or(0, |at| at + 1);
        let line = decode(tail[begin..end].trim_ascii());
        let first = first_cell(&line);
        if WORDS.contains(&word_of(first).as_str()) && begin > 0 {
            let summary = found.get_or_insert_with(|| Summary {
                at: 0,
                names: Vec::new(),
            });
            summary.at = from + begin as u64;
            summary.names.insert(0, first.to_owned());
        } else if !first.is_empty() {
            break;
        }
        end = begin;
    }
    Ok(found)
}

/// The first filled cell of a line, however its cells are separated; between blanks the line's first word.
fn first_cell(line: &str) -> &str {
    const MARKS: [char; 4] = ['\t', ';', ',', '|'];
    let quoted = |c: char| MARKS.contains(&c) || c.is_whitespace() || c == '"';
    let line = line.trim_start_matches(quoted);
    let marks: &[char] = if line.contains(MARKS) { &MARKS } else { &[' '] };
    let cell = line.split(marks).next().unwrap_or(line);
    cell.trim_matches(|c: char| c.is_whitespace() || c == '"')
}

/// The words of a cell without a unit in brackets, a colon or an equals sign behind them, lower case.
fn word_of(cell: &str) -> String {
    let bare = cell.split(['(', '[', ':', '=', '/']).next().unwrap_or(cell);
    bare.trim().to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn of(text: &str) -> Option<(usize, Vec<String>)> {
        let file = TextFile::of_bytes(Path::new("r.csv"), text.as_bytes().to_vec());
        let found = begins(&file).unwrap()?;
        let rows = text[..usize::try_from(found.at).unwrap()].lines().count();
        Some((rows, found.names))
    }

    #[test]
    fn rows_that_sum_up_are_the_last_ones() {
        let table = "Trial,h0 (cm),h1 (cm)\n1,100,61\n2,100,60\n";
        let with = |rows: &str| of(&format!("{table}{rows}"));
        let one = with("Average,100,60.5\n");
        assert_eq!(one, Some((3, vec!["Average".to_owned()])));
        let several = with("\nMean (cm),100,60.5\r\nStd. Dev.,0,0.7\r\n,,\r\n");
        assert_eq!(several.map(|s| s.1.len()), Some(2));
        assert_eq!(with(",Mittelwert:,60\n").map(|s| s.0), Some(3));
        assert_eq!(with("3,100,59\n"), None);
        assert_eq!(
            of("t;x\n0;1\n1;2\nSumme;3"),
            Some((3, vec!["Summe".into()]))
        );
        // a heading is no row that sums up
        assert_eq!(of("mean,sd\n1,2\n3,4\n"), None);
        assert_eq!(of("mean\n"), None);
    }
}
