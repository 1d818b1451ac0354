//! Rows of a delimited table to columns of numbers, a block of lines at a time.

use crate::source::{ReadError, Samples};
use crate::text::cells::{Cells, Lines, Separator, decode_cell, is_row, line_at};
use crate::text::clock::{self, Stamp};
use crate::text::number::{self, Notation};
use crate::text::{TextFile, decode, lone_return};

/// How the cells of a column are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Decimal numbers.
    Number,
    /// Points in time, given as seconds since the first.
    Time,
    /// Anything else.
    Text,
}

/// A column of parts of a second beside a clock that shows whole ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Fraction {
    /// The column of the clock.
    pub clock: usize,
    /// The column of the parts.
    pub column: usize,
    /// Seconds in one of them.
    pub to_s: f64,
}

/// Place and form of the rows of a table.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    /// The separator between two cells.
    pub separator: Separator,
    /// How its numbers are written.
    pub notation: Notation,
    /// The kinds of the columns.
    pub kinds: Vec<Kind>,
    /// Names of the columns, for messages.
    pub names: Vec<String>,
    /// Offset of the first row.
    pub start: u64,
    /// Offset of the end of the last row.
    pub end: u64,
    /// Whether there may be line feeds between quotes.
    pub quotes: bool,
    /// Whether `05/01/2024` is the first of May.
    pub month_first: bool,
    /// The column of parts of a second that belongs to one of points in time.
    pub fraction: Option<Fraction>,
    /// Line prefixes that make a line a comment.
    pub comments: &'static [u8],
    /// The lines that head the table, which may come again among its rows.
    pub headings: Vec<Vec<u8>>,
}

impl Layout {
    /// Whether a line heads the table once more, as where a logger was started again or a sheet is printed page by page.
    fn heads_again(&self, line: &[u8]) -> bool {
        let mut headings = self.headings.iter();
        !self.headings.is_empty() && headings.any(|heading| heading == line.trim_ascii())
    }
}

/// Columns being filled.
#[derive(Clone)]
enum Column {
    Skip,
    Number(Vec<f64>),
    Time(Box<Times>),
    Text(Vec<String>),
}

/// A column of points in time.
#[derive(Clone, Default)]
pub(crate) struct Times {
    /// Seconds since the first.
    pub(crate) values: Vec<f64>,
    origin: Option<Stamp>,
    /// What clocks that began again are behind, s.
    turned_s: f64,
}

impl Column {
    fn samples(self) -> Samples {
        match self {
            Self::Skip => Samples::Real(Vec::new()),
            Self::Number(values) => Samples::Real(values),
            Self::Time(times) => Samples::Real(times.values),
            Self::Text(values) => Samples::Text(values),
        }
    }
}

/// Read the columns `wanted` (indices, any order) of a table of `rows` rows; a clock that shows whole seconds with the parts
/// of a second that stand beside it.
pub(crate) fn read_columns(
    text: &TextFile,
    layout: &Layout,
    wanted: &[usize],
    rows: usize,
) -> Result<Vec<Samples>, ReadError> {
    let Some(fraction) = layout.fraction.filter(|f| wanted.contains(&f.clock)) else {
        return read_cells(text, layout, wanted, rows);
    };
    let with_parts = [wanted, &[fraction.column]].concat();
    let mut read = read_cells(text, layout, &with_parts, rows)?;
    let parts = read.pop().and_then(Samples::into_real).unwrap_or_default();
    for (column, samples) in wanted.iter().zip(&mut read) {
        if let Samples::Real(seconds) = samples
            && *column == fraction.clock
        {
            fraction.add(seconds, &parts);
        }
    }
    Ok(read)
}

impl Fraction {
    /// Add parts to whole seconds, so that the first is zero.
    pub(crate) fn add(self, seconds: &mut [f64], parts: &[f64]) {
        let first = parts.iter().copied().find(|p| p.is_finite()).unwrap_or(0.0);
        for (second, part) in seconds.iter_mut().zip(parts) {
            *second += (part - first) * self.to_s;
        }
    }
}

fn read_cells(
    text: &TextFile,
    layout: &Layout,
    wanted: &[usize],
    rows: usize,
) -> Result<Vec<Samples>, ReadError> {
    let width = layout.kinds.len();
    let mut columns: Vec<Column> = (0..width)
        .map(|i| {
            if wanted.contains(&i) {
                empty_column(layout.kinds[i], rows)
            } else {
                Column::Skip
            }
        })
        .collect();
    let last = wanted.iter().copied().max().map_or(0, |i| i + 1);
    let mut read = 0usize;
    text.blocks(layout.start, layout.quotes, |offset, block| {
        let mut at = 0;
        while at < block.len() && read < rows && offset + (at as u64) < layout.end {
            let plain = plain_cells(block, at, layout, &mut columns[..last]);
            if let Some(next) = plain.next {
                (at, read) = (next, read + 1);
                continue;
            }
            let (line, next) = line_at(block, at, layout.quotes);
            if is_row(line, layout.comments) && !layout.heads_again(line) {
                read_row(line, layout, &mut columns[..last], plain.done)
                    .map_err(|fault| fault.error(text, layout, read, offset + at as u64))?;
                read += 1;
            }
            at = next;
        }
        Ok(())
    })?;
    Ok(wanted
        .iter()
        .map(|&i| take_or_copy(&mut columns, wanted, i))
        .collect())
}

/// A column's samples; one that is wanted twice is copied.
fn take_or_copy(columns: &mut [Column], wanted: &[usize], i: usize) -> Samples {
    let column = match wanted.iter().filter(|&&w| w == i).count() {
        1 => std::mem::replace(&mut columns[i], Column::Skip),
        _ => columns[i].clone(),
    };
    column.samples()
}

fn empty_column(kind: Kind, rows: usize) -> Column {
    match kind {
        Kind::Number => Column::Number(Vec::with_capacity(rows)),
        Kind::Time => Column::Time(Box::new(Times {
            values: Vec::with_capacity(rows),
            ..Times::default()
        })),
        Kind::Text => Column::Text(Vec::with_capacity(rows)),
    }
}

/// What is wrong with a row: the column, the offset in the line, what was found.
struct Fault {
    column: usize,
    at: usize,
    found: String,
}

impl Fault {
    fn error(self, text: &TextFile, layout: &Layout, row: usize, position: u64) -> ReadError {
        let mark = char::from(layout.notation.decimal);
        let expected = match layout.kinds.get(self.column) {
            Some(Kind::Number) => {
                format!("a number with the decimal mark '{mark}', or an empty cell")
            }
            Some(Kind::Time) => "a point in time as in the rows before".to_owned(),
            _ => format!("{} cells in a row", layout.kinds.len()),
        };
        let error = ReadError::new(
            text.path(),
            expected,
            format!("{} in row {}", self.found, row + 1),
            "correct the row, or turn it into a comment with '#'",
        )
        .at(position + self.at as u64);
        match layout.names.get(self.column) {
            Some(name) => error.channel(name.clone()),
            None => error,
        }
    }
}

/// What was read at the front of a row.
#[derive(Default)]
struct Plain {
    /// How many cells.
    done: usize,
    /// Where the next row begins, if the row ends with these cells.
    next: Option<usize>,
}

/// Read the leading cells of a row that are numbers or not wanted, without looking for the ends
/// of cells and row first.
#[inline]
fn plain_cells(block: &[u8], mut at: usize, layout: &Layout, columns: &mut [Column]) -> Plain {
    let Separator::Byte(separator) = layout.separator else {
        return Plain::default();
    };
    if separator == layout.notation.decimal {
        return Plain::default();
    }
    let count = columns.len();
    for (done, column) in columns.iter_mut().enumerate() {
        let other = Plain { done, next: None };
        let (value, end) = match column {
            Column::Number(_) => match number_cell(block, at, layout.notation.decimal) {
                Some(read) => read,
                None => return other,
            },
            Column::Skip => match unwanted_cell(block, at, separator) {
                Some(end) => (f64::NAN, end),
                None => return other,
            },
            _ => return other,
        };
        let mut next = None;
        if block.get(end) != Some(&separator) {
            next = row_end(block, end).filter(|_| done + 1 == count);
            if next.is_none() {
                return other;
            }
        }
        if let Column::Number(values) = column {
            values.push(value);
        }
        if next.is_some() {
            return Plain { done: count, next };
        }
        at = end + 1;
    }
    Plain {
        done: count,
        next: None,
    }
}

/// The number of a cell that begins at `at`, and where it ends.
#[inline]
fn number_cell(block: &[u8], mut at: usize, decimal: u8) -> Option<(f64, usize)> {
    while block.get(at) == Some(&b' ') {
        at += 1;
    }
    number::parse_at(block, at, decimal)
}

/// The end of an unwanted cell, if it is known by its separator: it is not empty, not
/// quoted, no comment, and not the last of its row.
#[inline]
fn unwanted_cell(block: &[u8], at: usize, separator: u8) -> Option<usize> {
    let cell = block.get(at..)?;
    let plain = |b: &u8| b.is_ascii_alphanumeric() || matches!(b, b'+' | b'-' | b'.');
    cell.first().filter(|b| plain(b))?;
    let end = memchr::memchr3(separator, b'\n', b'"', cell)?;
    (cell[end] == separator).then_some(at + end)
}

/// Where the next row begins, if a row ends at `at`.
#[inline]
fn row_end(block: &[u8], at: usize) -> Option<usize> {
    match block.get(at..)? {
        [b'\n', ..] => Some(at + 1),
        [b'\r', b'\n', ..] => Some(at + 2),
        [] => Some(at),
        _ => None,
    }
}

/// Append the cells of one row from the one with the number `done` on; cells that the row lacks
/// become NaN or empty.
fn read_row(
    line: &[u8],
    layout: &Layout,
    columns: &mut [Column],
    done: usize,
) -> Result<(), Fault> {
    let mut cells = Cells::new(line, layout.separator).skip(done);
    for (column, i) in columns[done..].iter_mut().zip(done..) {
        let cell = cells.next().unwrap_or(b"");
        push(column, cell, layout).ok_or_else(|| Fault {
            column: i,
            at: offset_of(line, cell),
            found: format!("'{}'", shortened(cell)),
        })?;
    }
    extra_cells(line, layout)
}

/// Refuse a row with more filled cells than the table has columns.
fn extra_cells(line: &[u8], layout: &Layout) -> Result<(), Fault> {
    let width = layout.kinds.len();
    if let Separator::Byte(b) = layout.separator
        && memchr::memchr_iter(b, line).count() < width
    {
        return Ok(());
    }
    match Cells::new(line, layout.separator)
        .skip(width)
        .find(|c| !c.is_empty())
    {
        None => Ok(()),
        Some(cell) => Err(Fault {
            column: width,
            at: offset_of(line, cell),
            found: format!("a further cell '{}'", shortened(cell)),
        }),
    }
}

fn offset_of(line: &[u8], cell: &[u8]) -> usize {
    (cell.as_ptr() as usize)
        .saturating_sub(line.as_ptr() as usize)
        .min(line.len())
}

fn shortened(cell: &[u8]) -> String {
    let text = decode(cell);
    if text.chars().count() <= 24 {
        text
    } else {
        text.chars().take(24).chain(['…']).collect()
    }
}

/// Append a cell to a column; `None` where the column is of another kind.
fn push(column: &mut Column, cell: &[u8], layout: &Layout) -> Option<()> {
    match column {
        Column::Skip => {}
        Column::Number(values) => {
            values.push(layout.notation.parse(cell)?);
        }
        Column::Time(times) => times.push(cell, layout.month_first)?,
        Column::Text(values) => values.push(decode_cell(cell)),
    }
    Some(())
}

impl Times {
    /// Append the seconds of a cell since the column's first; a clock that passes midnight, or the full hour where it shows
    /// none, goes on.
    pub(crate) fn push(&mut self, cell: &[u8], month_first: bool) -> Option<()> {
        if cell.is_empty() {
            self.values.push(f64::NAN);
            return Some(());
        }
        let stamp = clock::parse_cell(&decode(cell), month_first)?;
        let origin = *self.origin.get_or_insert(stamp);
        let mut value = stamp.since(origin) + self.turned_s;
        let before = self.values.last().copied();
        if let Some((turn_s, before)) = stamp.turn_s().zip(before)
            && value < before - 0.5 * turn_s
        {
            self.turned_s += turn_s;
            value += turn_s;
        }
        self.values.push(value);
        Some(())
    }
}

/// Refuse a table whose rows are so much shorter than its header that filling them up would
/// take far more memory than the file.
pub(crate) fn refuse_ragged(
    text: &TextFile,
    rows: u64,
    columns: usize,
    bytes: u64,
) -> Result<(), ReadError> {
    if rows.saturating_mul(columns as u64) <= 2 * bytes + 1024 {
        return Ok(());
    }
    Err(ReadError::new(
        text.path(),
        format!("rows of {columns} cells as in the first ones"),
        format!("{rows} rows, most of them much shorter"),
        "split the file where its number of columns changes",
    ))
}

/// A line that a carriage return alone ends, far behind the front of a file whose lines end otherwise.
fn mixed_line_ends(text: &TextFile, row: u64, at: u64) -> ReadError {
    ReadError::new(
        text.path(),
        "lines that all end alike",
        format!("a carriage return without a line feed in row {}", row + 1),
        "save the file again with one kind of line ends",
    )
    .at(at)
}

/// The rows of a table.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counted {
    /// How many.
    pub rows: u64,
    /// Where the last begins.
    pub last: Option<u64>,
    /// How many lines among them head the table once more.
    pub headings: u64,
}

/// Count the rows of a table.
///
/// # Errors
/// If the file cannot be read, or a line ends by a carriage return alone.
pub(crate) fn count_rows(text: &TextFile, layout: &Layout) -> Result<Counted, ReadError> {
    let mut counted = Counted::default();
    text.blocks(layout.start, layout.quotes, |offset, block| {
        for (at, line) in Lines::new(block, layout.quotes) {
            let position = offset + at as u64;
            if position >= layout.end {
                break;
            }
            if let Some(at) = lone_return(line).filter(|_| !layout.quotes) {
                return Err(mixed_line_ends(text, counted.rows, position + at as u64));
            }
            if layout.heads_again(line) {
                counted.headings += 1;
            } else if is_row(line, layout.comments) {
                counted.rows += 1;
                counted.last = Some(position);
            }
        }
        Ok(())
    })?;
    Ok(counted)
}
