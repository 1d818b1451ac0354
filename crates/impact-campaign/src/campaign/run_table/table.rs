//! A run table as rows of cells below headings, which may be below titles and take several rows.

use super::headings::{IsNamed, column_of, columns_of, continued, states_setting};
use super::text::{Line, reader};

/// Rows among which the headings are looked for: titles may be above them.
pub(super) const FIRST_ROWS: usize = 10;

/// A table of which the headings are found.
#[derive(Debug)]
pub(super) struct Table {
    /// What each column is called, with its unit where a row of units states it.
    pub(super) headings: Vec<String>,
    /// The column of each heading, if it is known.
    pub(super) columns: Vec<Option<usize>>,
    /// The line of the headings, from 1.
    pub(super) line: usize,
    /// What separates its cells.
    pub(super) separator: u8,
    /// What is below the headings.
    pub(super) rows: Vec<Line>,
}

impl Table {
    /// The first table in a text whose headings state a setting, below any titles, for which `is_complete` holds.
    /// `separator`: `None` where the line of the headings shows it.
    pub(super) fn find(
        text: &str,
        separator: Option<u8>,
        is_named: IsNamed<'_>,
        is_complete: impl Fn(&Self) -> bool,
    ) -> Option<Self> {
        let starts = text.match_indices('\n').map(|(at, _)| at + 1);
        let starts = std::iter::once(0).chain(starts).take(FIRST_ROWS);
        let heads = starts.map(|from| Head::at(text, from, separator));
        let mut tables = heads
            .filter(Head::states_setting)
            .map(|head| head.with_rows(is_named));
        tables.find(is_complete)
    }

    /// The table whose headings are the first row of a text.
    pub(super) fn at_front(text: &str, is_named: IsNamed<'_>) -> Self {
        Head::at(text, 0, None).with_rows(is_named)
    }

    /// Where a column is.
    pub(super) fn position(&self, column: usize) -> Option<usize> {
        self.columns.iter().position(|c| *c == Some(column))
    }

    /// The cells of a column that are not empty.
    pub(super) fn cells(&self, column: usize) -> impl Iterator<Item = &str> {
        let at = self.position(column);
        let cells = self.rows.iter().filter_map(move |row| row.cells.get(at?));
        cells.filter(|cell| !cell.is_empty())
    }
}

/// The headings in a text from one of its lines on.
struct Head<'a> {
    headings: Vec<String>,
    line: usize,
    separator: u8,
    /// The text from there on, and the lines above.
    text: &'a str,
    above: usize,
    /// Rows that are headings.
    count: usize,
}

impl<'a> Head<'a> {
    fn at(text: &'a str, from: usize, separator: Option<u8>) -> Self {
        let mut head = Self {
            headings: Vec::new(),
            line: 1,
            separator: separator.unwrap_or_else(|| most_frequent(&text[from..])),
            text: &text[from..],
            above: text[..from].matches('\n').count(),
            count: 0,
        };
        let first: Vec<Line> = head.lines().take(FIRST_ROWS).collect();
        for row in first {
            let named = row.cells.iter().any(|cell| column_of(cell).is_some());
            let headings = match head.count {
                0 => row.cells.iter().map(str::to_owned).collect(),
                _ => match continued(&head.headings, &row.cells) {
                    Some(both) => both,
                    None => break,
                },
            };
            if head.count == 0 || named {
                head.line = row.number;
            }
            head.headings = headings;
            head.count += 1;
        }
        head
    }

    fn states_setting(&self) -> bool {
        let columns: Vec<Option<usize>> = self.headings.iter().map(|h| column_of(h)).collect();
        states_setting(&columns)
    }

    fn lines(&self) -> impl Iterator<Item = Line> + use<'a> {
        let (text, above) = (self.text, self.above);
        let records = reader(text, self.separator).into_records();
        // a text has no row that cannot be read
        records.filter_map(Result::ok).map(move |cells| Line {
            number: above + number_of(&cells, text),
            cells,
        })
    }

    fn with_rows(self, is_named: IsNamed<'_>) -> Table {
        let rows: Vec<Line> = self.lines().skip(self.count).collect();
        Table {
            columns: columns_of(&self.headings, &rows, is_named),
            headings: self.headings,
            line: self.line,
            separator: self.separator,
            rows,
        }
    }
}

/// The line of a row in a text, from 1: what is stored is where the row before it ends.
fn number_of(row: &csv::StringRecord, text: &str) -> usize {
    let Some(position) = row.position() else {
        return 0;
    };
    let byte = usize::try_from(position.byte()).unwrap_or(0);
    let rest = text.get(byte..).unwrap_or("");
    let skipped = |line: &&str| line.is_empty() || line.starts_with('#');
    let between = rest.lines().take_while(skipped).count();
    usize::try_from(position.line()).unwrap_or(0) + between
}

/// The separator of the first line with cells: the most frequent of comma, semicolon and tab.
fn most_frequent(text: &str) -> u8 {
    let filled = |l: &&str| !l.starts_with('#') && !l.trim().is_empty();
    let line = text.lines().find(filled).unwrap_or("");
    let count = |b: &u8| line.bytes().filter(|c| c == b).count();
    [b',', b';', b'\t']
        .into_iter()
        .rev()
        .max_by_key(count)
        .unwrap_or(b',')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> Option<Table> {
        let all = |_: &Table| true;
        Table::find(text, None, [&|_| false, &|_| false], all)
    }

    #[test]
    fn titles_above_the_headings_may_be_separated_otherwise() {
        let text =
            "Series 7, rig, May, 2026\n;;\n\nDatei;f [Hz];Spalt [mm]\n# none\na;8,5;2\n\nb;9;2\n";
        let table = found(text).unwrap();
        assert_eq!(table.headings, ["Datei", "f [Hz]", "Spalt [mm]"]);
        assert_eq!(table.line, 4);
        let lines: Vec<usize> = table.rows.iter().map(|row| row.number).collect();
        assert_eq!(lines, [6, 8]);
        assert!(found("t;x\n0;1\n").is_none());
    }

    #[test]
    fn units_and_names_of_columns_may_be_rows_of_their_own() {
        for (text, headings, line, first) in [
            (
                "file,frequency,gap\n,Hz,mm\na,8,1\n",
                ["file", "frequency [Hz]", "gap [mm]"],
                1,
                "a",
            ),
            (
                "file,frequency,gap\n-,[Hz],(mm)\na,8,1\n",
                ["file", "frequency [Hz]", "gap [mm]"],
                1,
                "a",
            ),
            (
                "Series\nfile,Settings,\n,frequency,gap\n,Hz,mm\na,8,1\n",
                ["file", "frequency [Hz]", "gap [mm]"],
                3,
                "a",
            ),
            (
                "file,frequency_hz,note\nm,,\nb,8,\n",
                ["file", "frequency_hz", "note"],
                1,
                "m",
            ),
        ] {
            let table = found(text).unwrap();
            assert_eq!(table.headings, headings, "{text}");
            assert_eq!(table.line, line, "{text}");
            assert_eq!(table.rows[0].cells.get(0), Some(first), "{text}");
        }
    }
}
