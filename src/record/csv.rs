//! Text tables: comma-, tab-, semicolon- or blank-separated, with or without a header.
//!
//! Opening reads the first and the last lines and counts the rows; reading goes through the
//! file block by block and keeps only the columns that are asked for.

pub mod dialect;
pub mod header;
pub mod time_axis;

use std::path::Path;

use crate::record::csv::dialect::Dialect;
use crate::record::csv::header::Header;
use crate::record::csv::time_axis::TimeAxis;
use crate::record::source::{ChannelInfo, DatasetInfo, ReadError, Samples, Source, StoredType};
use crate::record::text::cells::{Cells, Lines, Separator, is_row};
use crate::record::text::table::{self, Kind, Layout};
use crate::record::text::{TextFile, decode, number};

/// Bytes at the front of a file from which its dialect is told.
const HEAD_BYTES: usize = 1 << 16;

/// Rows at the front of a file from which kinds and time axis are told.
pub(crate) struct HeadRows<'a> {
    lines: Vec<&'a [u8]>,
    separator: Separator,
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

struct CsvSource {
    text: TextFile,
    layout: Layout,
    datasets: Vec<DatasetInfo>,
    notes: Vec<String>,
}

/// Open a text table.
///
/// # Errors
/// Where the file cannot be read, is empty, or no separator makes a table of numbers of it.
pub fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let text = TextFile::open(path)?;
    let head = text.head(HEAD_BYTES)?;
    let quotes = memchr::memchr(b'"', &head).is_some();
    let front = Front::read(&text, &head, quotes)?;
    let rows = front.rows(&head, quotes);
    let mut layout = front.layout(&text, &rows, quotes);
    let (count, last) = table::count_rows(&text, &layout)?;
    refuse_ragged(&text, count, layout.kinds.len())?;
    let mut notes = Vec::new();
    let last_row = last_row(&text, &layout, last, &mut notes)?;
    let axis = time_axis::find(&front.header, &layout, &rows, last_row.as_deref(), count);
    layout.names.clone_from(&front.header.names);
    notes.extend(axis.iter().flat_map(|a| a.note.clone()));
    let dataset = dataset(front.header, &layout, count, axis.as_ref());
    Ok(Box::new(CsvSource {
        text,
        layout,
        datasets: vec![dataset],
        notes,
    }))
}

/// What stands before the table and where the table begins.
struct Front {
    dialect: Dialect,
    header: Header,
    /// Offset of the table in the head.
    offset: usize,
}

impl Front {
    fn read(text: &TextFile, head: &[u8], quotes: bool) -> Result<Self, ReadError> {
        if memchr::memchr(0, head).is_some() {
            return Err(no_table(text, "bytes that are no text"));
        }
        let all: Vec<(usize, &[u8])> = Lines::new(head, quotes)
            .filter(|(_, l)| !l.trim_ascii().is_empty())
            .collect();
        let plain: Vec<&[u8]> = all
            .iter()
            .map(|&(_, l)| l)
            .filter(|l| is_row(l, dialect::COMMENTS))
            .collect();
        if plain.is_empty() {
            return Err(no_table(
                text,
                if all.is_empty() {
                    "an empty file"
                } else {
                    "comments only"
                },
            ));
        }
        let dialect =
            dialect::detect(&plain).ok_or_else(|| no_table(text, "no column of numbers"))?;
        let first = all
            .iter()
            .position(|(_, l)| is_row(l, dialect::COMMENTS) && dialect::is_value_row(l, &dialect))
            .ok_or_else(|| no_table(text, "no row of numbers"))?;
        let before: Vec<&[u8]> = all[..first].iter().map(|&(_, l)| l).collect();
        let header = header::read(&before, &dialect);
        Ok(Self {
            dialect,
            header,
            offset: all[first].0,
        })
    }

    /// The rows of the head.
    fn rows<'a>(&self, head: &'a [u8], quotes: bool) -> HeadRows<'a> {
        let lines = Lines::new(&head[self.offset..], quotes);
        let rows = lines.filter(|(_, l)| is_row(l, dialect::COMMENTS));
        HeadRows {
            lines: rows.map(|(_, l)| l).collect(),
            separator: self.dialect.separator,
        }
    }

    fn layout(&self, text: &TextFile, rows: &HeadRows<'_>, quotes: bool) -> Layout {
        let kinds = kinds(rows, &self.dialect);
        Layout {
            separator: self.dialect.separator,
            decimal: self.dialect.decimal,
            names: Vec::new(),
            start: text.start() + self.offset as u64,
            end: text.length(),
            quotes,
            month_first: kinds.contains(&Kind::Time) && month_first(rows),
            kinds,
            comments: dialect::COMMENTS,
        }
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
    fn add(&mut self, cell: &[u8], decimal: u8) {
        if cell.is_empty() || self.filled == JUDGED_CELLS {
            return;
        }
        self.filled += 1;
        if number::parse_cell(cell, decimal).is_some() {
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

/// The kinds of the columns by their first filled cells in the head.
fn kinds(rows: &HeadRows<'_>, dialect: &Dialect) -> Vec<Kind> {
    let mut columns = vec![Judged::default(); dialect.columns];
    for row in rows.rows() {
        for (cell, column) in row.zip(&mut columns) {
            column.add(cell, dialect.decimal);
        }
        if columns.iter().all(|c| c.filled == JUDGED_CELLS) {
            break;
        }
    }
    columns.iter().map(Judged::kind).collect()
}

/// Whether dates are written month first: only where one has its second number above 12.
fn month_first(rows: &HeadRows<'_>) -> bool {
    let mut dates = rows.rows().flatten().filter(|cell| cell.contains(&b'/'));
    dates.any(|cell| {
        let text = decode(cell);
        let date = text.split([' ', 'T']).next().unwrap_or_default();
        let mut parts = date.split('/').map(str::parse::<u32>);
        matches!((parts.next(), parts.next(), parts.next()), (Some(Ok(m)), Some(Ok(d)), Some(Ok(_))) if m <= 12 && d > 12)
    })
}

/// Refuse a table whose rows are so much shorter than its header that filling them up would
/// take far more memory than the file.
fn refuse_ragged(text: &TextFile, rows: u64, columns: usize) -> Result<(), ReadError> {
    if rows.saturating_mul(columns as u64) <= 2 * text.length() + 1024 {
        return Ok(());
    }
    Err(ReadError::new(
        text.path(),
        format!("rows of {columns} cells as in the first ones"),
        format!("{rows} rows, most of them much shorter"),
        "Split the file where its number of columns changes.",
    ))
}

/// The cells of the last row; a last line without all its cells is noted as cut off.
fn last_row(
    text: &TextFile,
    layout: &Layout,
    at: Option<u64>,
    notes: &mut Vec<String>,
) -> Result<Option<Vec<Vec<u8>>>, ReadError> {
    let Some(at) = at else { return Ok(None) };
    let bytes = text.range(at, HEAD_BYTES)?;
    let Some((_, line)) = Lines::new(&bytes, layout.quotes).next() else {
        return Ok(None);
    };
    let cells: Vec<Vec<u8>> = Cells::new(line, layout.separator)
        .map(<[u8]>::to_vec)
        .collect();
    if cells.len() < layout.kinds.len() && !bytes.ends_with(b"\n") {
        notes.push(format!(
            "the last row has {} of {} cells and no line end: the file may be cut off",
            cells.len(),
            layout.kinds.len()
        ));
    }
    Ok(Some(cells))
}

fn dataset(header: Header, layout: &Layout, rows: u64, axis: Option<&TimeAxis>) -> DatasetInfo {
    let stated = crate::record::attribute::sample_rate_hz(&header.attributes);
    let rate = axis.and_then(|a| a.rate_hz).or(stated);
    let start = axis
        .and_then(|a| a.start.clone())
        .or_else(|| crate::record::attribute::start_time(&header.attributes));
    let channel = |(i, (name, unit)): (usize, (String, Option<String>))| ChannelInfo {
        name,
        unit: unit.or_else(|| axis.filter(|a| a.column == i).and_then(|a| a.unit.clone())),
        stored: match layout.kinds[i] {
            Kind::Number => StoredType::Float(64),
            Kind::Time => StoredType::Time,
            Kind::Text => StoredType::Text,
        },
        samples: rows,
        sample_rate_hz: rate,
        start_time: start.clone(),
        properties: Default::default(),
    };
    let columns = header.names.into_iter().zip(header.units);
    DatasetInfo {
        name: String::new(),
        channels: columns.enumerate().map(channel).collect(),
        time_axis: axis.map(|a| a.column),
        attributes: header.attributes,
    }
}

fn no_table(text: &TextFile, found: &str) -> ReadError {
    ReadError::new(
        text.path(),
        "a table of numbers separated by commas, semicolons, tabs or blanks",
        found,
        "Export the record as CSV with one row a sample and a header of channel names.",
    )
}

impl Source for CsvSource {
    fn format(&self) -> &'static str {
        "csv"
    }

    fn path(&self) -> &Path {
        self.text.path()
    }

    fn datasets(&self) -> &[DatasetInfo] {
        &self.datasets
    }

    fn notes(&self) -> &[String] {
        &self.notes
    }

    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        let info = crate::record::source::requested(self, dataset, channels)?;
        let rows = info.channels.first().map_or(0, |c| c.samples) as usize;
        table::read_columns(&self.text, &self.layout, channels, rows)
    }
}

#[cfg(test)]
mod tests;
