//! What the columns of a text table hold, found from its first rows.

use std::ops::Range;

use crate::formats::csv::dialect::{self, Dialect};
use crate::text::cells::{Cells, Separator};
use crate::text::decode;
use crate::text::number::{self, Notation};
use crate::text::table::Kind;

/// Rows at the front of a file from which kinds and time axis are found.
pub(crate) struct HeadRows<'a> {
    /// The rows, comments and blank lines left out.
    pub(crate) lines: Vec<&'a [u8]>,
    /// The separator between two cells.
    pub(crate) separator: Separator,
}

impl<'a> HeadRows<'a> {
    /// The cells of each row.
    fn rows(&self) -> impl Iterator<Item = Cells<'a>> {
        self.lines.iter().map(|l| Cells::new(l, self.separator))
    }

    /// The cells of a column, of the rows that have it.
    pub(crate) fn column(&self, i: usize) -> impl Iterator<Item = &'a [u8]> {
        self.rows().filter_map(move |mut row| row.nth(i))
    }

    /// The cell of the first row in a column.
    pub(crate) fn first(&self, i: usize) -> Option<&'a [u8]> {
        self.rows().next()?.nth(i)
    }
}

/// Filled cells by which the kind of a column is judged.
const JUDGED_CELLS: usize = 64;

/// What the first filled cells of a column hold.
#[derive(Debug, Clone, Default)]
struct Judged {
    filled: usize,
    numbers: usize,
    times: usize,
}

impl Judged {
    fn add(&mut self, cell: &[u8], notation: Notation) {
        if cell.is_empty() || self.filled == JUDGED_CELLS {
            return;
        }
        self.filled += 1;
        if notation.parse(cell).is_some() {
            self.numbers += 1;
        } else if dialect::is_time(cell) {
            self.times += 1;
        }
    }

    fn kind(&self) -> Kind {
        if 2 * self.times > self.filled {
            Kind::Time
        } else if 2 * self.numbers >= self.filled {
            Kind::Number
        } else {
            Kind::Text
        }
    }
}

/// The columns between the first and the last cell that is filled in any row of the head.
pub(crate) fn filled(rows: &HeadRows<'_>) -> Range<usize> {
    let filled = |row: Cells<'_>| {
        let mut cells = row.enumerate().filter(|(_, cell)| !cell.is_empty());
        let (first, _) = cells.next()?;
        Some(first..cells.last().map_or(first, |(i, _)| i) + 1)
    };
    let both = |a: Range<usize>, b: Range<usize>| a.start.min(b.start)..a.end.max(b.end);
    rows.rows().filter_map(filled).reduce(both).unwrap_or(0..0)
}

/// A cell that may be a number with three decimals or one with its thousands separated: all marked cells of its
/// column have three digits behind the mark, others are whole numbers of hundreds, and nothing else in the
/// table shows what the mark is.
pub(crate) fn ambiguous<'a>(
    rows: &HeadRows<'a>,
    kinds: &[Kind],
    decimal: u8,
) -> Option<(usize, &'a [u8])> {
    let other = if decimal == b'.' { b',' } else { b'.' };
    let marked = |cell: &[u8]| cell.contains(&decimal);
    let like_groups = |cell: &[u8]| number::parse_grouped(cell, other).is_some();
    let proven = |cell: &[u8]| {
        marked(cell) && number::parse_cell(cell, decimal).is_some() && !like_groups(cell)
    };
    if rows.rows().flatten().any(proven) {
        return None;
    }
    let mut numbers = (0..kinds.len()).filter(|i| kinds[*i] == Kind::Number);
    numbers.find_map(|i| {
        let cells = || rows.column(i).filter(|c| !c.is_empty()).take(JUDGED_CELLS);
        let hundreds = |cell: &[u8]| {
            let value = number::parse_cell(cell, decimal).filter(|_| !marked(cell));
            value.is_some_and(|v| (100.0..1000.0).contains(&v.abs()))
        };
        let found = cells().find(|c| marked(c))?;
        cells().any(hundreds).then_some((i, found))
    })
}

/// The kinds of the columns by their first filled cells in the head.
pub(crate) fn kinds(rows: &HeadRows<'_>, dialect: &Dialect) -> Vec<Kind> {
    let mut columns = vec![Judged::default(); dialect.columns];
    for row in rows.rows() {
        for (cell, column) in row.zip(&mut columns) {
            column.add(cell, dialect.notation);
        }
        if columns.iter().all(|c| c.filled == JUDGED_CELLS) {
            break;
        }
    }
    columns.iter().map(Judged::kind).collect()
}

/// Whether dates are written month first: only where one has its second number above 12.
pub(crate) fn month_first(rows: &HeadRows<'_>) -> bool {
    let mut dates = rows.rows().flatten().filter(|cell| cell.contains(&b'/'));
    dates.any(|cell| {
        let text = decode(cell);
        let date = text.split([' ', 'T']).next().unwrap_or_default();
        let mut parts = date.split('/').map(str::parse::<u32>);
        matches!((parts.next(), parts.next(), parts.next()), (Some(Ok(m)), Some(Ok(d)), Some(Ok(_))) if m <= 12 && d > 12)
    })
}
