//! How a text table is written, found from its first lines.

use crate::text::cells::{Cells, Separator};
use crate::text::number::{self, Notation};
use crate::text::{clock, decode};

/// First characters that make a line a comment.
pub(crate) const COMMENTS: &[u8] = b"#%!";
/// Lines at the end of the head by which the dialect is judged.
const JUDGED_LINES: usize = 60;

/// The longest cell that may hold a point in time, bytes.
const LONGEST_TIME: usize = 80;

/// How a table is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Dialect {
    /// The separator between two cells.
    pub separator: Separator,
    /// How its numbers are written.
    pub notation: Notation,
    /// Number of columns.
    pub columns: usize,
}

impl Dialect {
    /// The dialect that this program writes, with the columns of its header.
    pub(crate) fn own(header: &[u8]) -> Self {
        let separator = Separator::Byte(b',');
        Self {
            separator,
            notation: Notation::plain(b'.'),
            columns: Cells::new(header, separator).count(),
        }
    }
}

/// Dialects in the order in which they are preferred when they explain a text equally well.
const CANDIDATES: [(Separator, u8); 10] = [
    (Separator::Byte(b'\t'), b'.'),
    (Separator::Byte(b';'), b'.'),
    (Separator::Byte(b','), b'.'),
    (Separator::Byte(b'|'), b'.'),
    (Separator::Blanks, b'.'),
    (Separator::Byte(b'\t'), b','),
    (Separator::Byte(b';'), b','),
    (Separator::Byte(b'|'), b','),
    (Separator::Blanks, b','),
    QUOTED,
];

/// Numbers with decimal commas between commas, which quotes keep apart.
const QUOTED: (Separator, u8) = (Separator::Byte(b','), b',');

/// The dialect that explains the lines best; `None` where none makes a table of them.
///
/// `lines` are the first lines of the file without blank lines and comments. The last of them
/// count: there may be a preamble before the table.
pub(crate) fn detect(lines: &[&[u8]]) -> Option<Dialect> {
    let judged = judged(lines);
    if is_column_of_decimals(lines, judged) {
        return Some(Dialect {
            separator: Separator::Byte(b';'),
            notation: Notation::plain(b','),
            columns: 1,
        });
    }
    let mut best: Option<(f64, Dialect)> = None;
    let parted = is_parted(judged);
    let quoted = shows_quoted_commas(judged);
    let fits = |candidate: &(Separator, u8)| match *candidate {
        QUOTED => quoted,
        (separator, _) => !(parted && separator == Separator::Blanks),
    };
    let candidates = CANDIDATES.iter().filter(|c| fits(c));
    for &(separator, decimal) in candidates {
        let notation = notation(judged, separator, decimal);
        let Some((score, columns)) = score(judged, separator, notation) else {
            continue;
        };
        let certain = score > 1.0;
        if best.is_none_or(|(b, _)| score > b + 1e-9) {
            best = Some((
                score,
                Dialect {
                    separator,
                    notation,
                    columns,
                },
            ));
        }
        if certain {
            break;
        }
    }
    best.map(|(_, dialect)| dialect)
}

/// Whether lines are one column of numbers with a decimal comma, not two columns of whole numbers: the comma parts
/// digits alone, the last with a power of ten or none, and the heading is one cell, or what follows the comma has as many
/// digits everywhere and begins with a zero somewhere, as no number does.
fn is_column_of_decimals(lines: &[&[u8]], judged: &[&[u8]]) -> bool {
    let halves = |line: &&[u8]| {
        let line = line.trim_ascii();
        let comma = line.iter().position(|b| *b == b',')?;
        let (whole, part) = (&line[..comma], &line[comma + 1..]);
        let unsigned = whole.strip_prefix(b"-").unwrap_or(whole);
        let digits = |text: &[u8]| !text.is_empty() && text.iter().all(u8::is_ascii_digit);
        let power = part.iter().position(|b| matches!(b, b'e' | b'E'));
        let (part, power) = part.split_at(power.unwrap_or(part.len()));
        let power = power.get(1..).unwrap_or_default();
        let power = power
            .strip_prefix(b"-")
            .or(power.strip_prefix(b"+"))
            .unwrap_or(power);
        (digits(unsigned) && digits(part) && power.iter().all(u8::is_ascii_digit))
            .then(|| part.to_vec())
    };
    let Some(parts) = judged.iter().map(halves).collect::<Option<Vec<_>>>() else {
        return false;
    };
    let heading = lines.iter().rev().find(|line| halves(line).is_none());
    let is_one = |line: &&[u8]| {
        let letters = line.iter().any(u8::is_ascii_alphabetic);
        letters && !line.iter().any(|b| b",;\t|".contains(b))
    };
    let alike = parts.windows(2).all(|w| w[0].len() == w[1].len());
    let zeros = parts.iter().any(|p| p.len() > 1 && p[0] == b'0');
    !parts.is_empty() && (heading.is_some_and(is_one) || (alike && zeros))
}

/// Whether cells between commas, in quotes, hold numbers whose comma is that of decimals: it does not part groups of three
/// digits.
fn shows_quoted_commas(lines: &[&[u8]]) -> bool {
    let (separator, decimal) = QUOTED;
    let mut cells = lines.iter().flat_map(|l| Cells::new(l, separator));
    cells.any(|cell| {
        cell.contains(&decimal)
            && number::parse_cell(cell, decimal).is_some()
            && number::parse_grouped(cell, b'.').is_none()
    })
}

/// Whether nearly all lines have as many tabs, semicolons or bars, and some: blanks are part of their cells then.
fn is_parted(lines: &[&[u8]]) -> bool {
    [b'\t', b';', b'|'].into_iter().any(|mark| {
        let widths = lines
            .iter()
            .map(|l| Cells::new(l, Separator::Byte(mark)).count());
        let widths: Vec<usize> = widths.collect();
        let like = |usual: usize| widths.iter().filter(|w| **w == usual).count();
        usual(&widths).is_some_and(|usual| usual > 1 && 10 * like(usual) >= 9 * widths.len())
    })
}

/// The lines by which a table is judged. A preamble in a short file must not outvote the table:
/// the second half decides.
fn judged<'a, 'b>(lines: &'b [&'a [u8]]) -> &'b [&'a [u8]] {
    let last = &lines[lines.len().saturating_sub(JUDGED_LINES)..];
    &last[last.len() / 2..]
}

/// How well a dialect explains lines: the share of lines with the usual number of cells times
/// the share of filled cells that hold a value; and that number of cells.
fn score(lines: &[&[u8]], separator: Separator, notation: Notation) -> Option<(f64, usize)> {
    let widths: Vec<usize> = lines
        .iter()
        .map(|l| Cells::new(l, separator).count())
        .collect();
    let columns = usual(&widths)?;
    let consistent = widths.iter().filter(|&&w| w == columns).count() as f64;
    let (mut filled, mut values) = (0usize, 0usize);
    for cell in lines
        .iter()
        .flat_map(|l| Cells::new(l, separator))
        .filter(|c| !c.is_empty())
    {
        filled += 1;
        values += usize::from(is_value(cell, notation));
    }
    if values == 0 {
        return None;
    }
    let score = consistent / lines.len() as f64 * values as f64 / filled as f64;
    // Among equals the dialect that finds a table wins over the one that finds a column.
    Some((score + if columns > 1 { 1e-6 } else { 0.0 }, columns))
}

/// How numbers with a decimal mark are written: a table in which the mark occurs may separate thousands by others.
fn notation(lines: &[&[u8]], separator: Separator, decimal: u8) -> Notation {
    let shows = |cell: &[u8]| {
        let plain = cell.contains(&decimal) && number::parse_cell(cell, decimal).is_some();
        plain || number::parse_grouped(cell, decimal).is_some_and(|(_, both)| both)
    };
    let mut cells = lines.iter().flat_map(|l| Cells::new(l, separator));
    Notation {
        decimal,
        groups: cells.any(shows),
    }
}

/// The most frequent number, the greatest of several.
fn usual(widths: &[usize]) -> Option<usize> {
    let count = |w: usize| widths.iter().filter(|&&v| v == w).count();
    widths.iter().copied().max_by_key(|&w| (count(w), w))
}

/// Whether a cell holds a number (or states that there is none) or a point in time.
pub(crate) fn is_value(cell: &[u8], notation: Notation) -> bool {
    if cell.is_empty() {
        return false;
    }
    notation.parse(cell).is_some() || is_time(cell)
}

/// Whether a cell holds a point in time.
pub(crate) fn is_time(cell: &[u8]) -> bool {
    cell.len() <= LONGEST_TIME && clock::parse_cell(&decode(cell), false).is_some()
}

/// Lines below a row that may be one of a preamble among which a heading shows that it is.
const HEADING_LINES: usize = 4;

/// The number of the first line that is a row of the table: a row of values, or one that has
/// values wherever the last lines have values alone, as rows of few numbers among texts do. Numbers in a preamble, with less
/// cells than the table or more, are none: a heading follows them.
pub(crate) fn first_row(lines: &[&[u8]], dialect: &Dialect) -> Option<usize> {
    let mut from = 0;
    loop {
        let first = from + row_at(lines, from, dialect)?;
        match heading_below(lines, first, dialect) {
            Some(heading) => from = heading + 1,
            None => return Some(first),
        }
    }
}

/// The heading of the table some lines below a row of another width; a heading that was there before comes again among rows.
fn heading_below(lines: &[&[u8]], row: usize, dialect: &Dialect) -> Option<usize> {
    let cells = |line: &[u8]| -> Vec<Vec<u8>> {
        let cells = Cells::new(line, dialect.separator);
        cells.map(<[u8]>::to_vec).collect()
    };
    if cells(lines[row]).len() == dialect.columns {
        return None;
    }
    let words = |cells: &[Vec<u8>]| {
        let word = |c: &Vec<u8>| !c.is_empty() && !is_value(c, dialect.notation);
        cells.len() == dialect.columns && cells.iter().all(word)
    };
    let below = (row + 1..lines.len()).take(HEADING_LINES);
    let mut headings = below.filter(|i| words(&cells(lines[*i])));
    headings.find(|i| !lines[..row].contains(&lines[*i]))
}

/// How many lines after one the first is that looks like a row of the table.
fn row_at(lines: &[&[u8]], from: usize, dialect: &Dialect) -> Option<usize> {
    let values = columns_of_values(judged(lines), dialect);
    let begins_empty = begins_empty(judged(lines), &values, dialect);
    lines[from..].iter().position(|line| {
        let cells: Vec<&[u8]> = Cells::new(line, dialect.separator).collect();
        let near = cells.len().abs_diff(dialect.columns) <= dialect.columns / 2;
        let row = is_value_row(&cells, dialect) || agrees(&cells, &values, dialect);
        let keyed = begins_empty && !cells[0].is_empty();
        near && row && !keyed && !heads(&cells, &values, dialect)
    })
}

/// Whether lines begin with an empty cell before columns of values alone, as Yokogawa writes them below `"Model","DL850"`.
fn begins_empty(lines: &[&[u8]], values: &[bool], dialect: &Dialect) -> bool {
    let mut firsts = lines
        .iter()
        .map(|line| Cells::new(line, dialect.separator).next());
    let empty = firsts.all(|cell| cell.is_some_and(<[u8]>::is_empty));
    // a separator may end each line
    let end = values.iter().rposition(|of_values| *of_values);
    let others = end.and_then(|end| values.get(1..=end)).unwrap_or_default();
    empty && !others.is_empty() && others.iter().all(|of_values| *of_values)
}

/// Whether some of the cells are filled, and most of those hold values.
fn is_value_row(cells: &[&[u8]], dialect: &Dialect) -> bool {
    let filled = cells.iter().filter(|c| !c.is_empty()).count();
    let values = cells.iter().filter(|c| is_value(c, dialect.notation));
    let values = values.count();
    values > 0 && 2 * values >= filled
}

/// For each column whether lines hold values in it, and nothing else.
fn columns_of_values(lines: &[&[u8]], dialect: &Dialect) -> Vec<bool> {
    let mut columns = vec![(false, true); dialect.columns];
    for line in lines {
        let cells = Cells::new(line, dialect.separator).zip(&mut columns);
        for (cell, (some, only)) in cells.filter(|(c, _)| !c.is_empty()) {
            let value = is_value(cell, dialect.notation);
            (*some, *only) = (*some || value, *only && value);
        }
    }
    columns.iter().map(|(some, only)| *some && *only).collect()
}

/// Whether a row has a word in the first column of values, or in most of them, as `x-axis,1,2` and
/// `Sequence,Volt,-1e-3,4e-6` have, which head a table.
fn heads(cells: &[&[u8]], columns: &[bool], dialect: &Dialect) -> bool {
    let held = cells
        .iter()
        .zip(columns)
        .filter(|(_, of_values)| **of_values);
    let words = held.map(|(cell, _)| !cell.is_empty() && !is_value(cell, dialect.notation));
    let words: Vec<bool> = words.collect();
    let count = words.iter().filter(|w| **w).count();
    words.first() == Some(&true) || 2 * count > words.len()
}

/// Whether a row has values in columns of values: in one at least, and no word in any.
fn agrees(cells: &[&[u8]], columns: &[bool], dialect: &Dialect) -> bool {
    let held = cells
        .iter()
        .zip(columns)
        .filter(|(_, of_values)| **of_values);
    let mut filled = held
        .map(|(cell, _)| cell)
        .filter(|c| !c.is_empty())
        .peekable();
    filled.peek().is_some() && filled.all(|c| is_value(c, dialect.notation))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Dialect {
        let lines: Vec<&[u8]> = text.lines().map(str::as_bytes).collect();
        detect(&lines).unwrap()
    }

    #[test]
    fn dialects_are_told_apart() {
        let tab = Separator::Byte(b'\t');
        let is = |text, separator, decimal, columns| {
            assert_eq!(
                of(text),
                Dialect {
                    separator,
                    notation: Notation {
                        decimal,
                        ..of(text).notation
                    },
                    columns
                },
                "{text}"
            );
        };
        is("a,b\n1.5,2\n2.5,3", Separator::Byte(b','), b'.', 2);
        is("a;b\n1,5;2\n2,5;3", Separator::Byte(b';'), b',', 2);
        is("1,5\t2\n2,5\t3", tab, b',', 2);
        is("1.5\t2\n2.5\t3", tab, b'.', 2);
        // cells with blanks
        is("run 1\t8.25\tup\nrun 2\t8.5\tup", tab, b'.', 3);
        is(" 1.5   2\n 12.5  3", Separator::Blanks, b'.', 2);
        is("1, 2, 3\n4, 5, 6", Separator::Byte(b','), b'.', 3);
        is("1\n2\n3", tab, b'.', 1);
        is("0,5\n0,7\n", Separator::Byte(b','), b'.', 2);
        // one number to a line, by its heading and by what follows the comma
        let lone = Separator::Byte(b';');
        is("Weg [mm]\n3,00000\n2,99931\n-1,5", lone, b',', 1);
        is("Zeit in ms\n400,0\n761,3", lone, b',', 1);
        is("3,00\n2,99\n2,05", lone, b',', 1);
        is(
            "data:\n1,034500E-03\n-2,500000E+00\n9,99E-01",
            lone,
            b',',
            1,
        );
        is("a,b\n3,10\n2,99\n2,45", Separator::Byte(b','), b'.', 2);
        is(
            "2024-05-01 12:00:00;1,5\n2024-05-01 12:00:01;1,6",
            Separator::Byte(b';'),
            b',',
            2,
        );
        is(
            "t,x,note\n0,1,fine\n1,2,\n2,3,\"a, b\"\n3,4,",
            Separator::Byte(b','),
            b'.',
            3,
        );
    }
}
