//! Text tables: comma-, tab-, semicolon- or blank-separated, with or without a header.
//!
//! Opening reads the first and the last lines and counts the rows; reading goes through the
//! file block by block and keeps only the columns that are asked for.

mod columns;
mod dialect;
mod front;
pub(crate) mod header;
mod time_axis;

use std::path::Path;

use crate::bytes::to_usize;
use crate::csv::front::Front;
pub(crate) use crate::csv::front::TEXTS_KEY;
use crate::csv::header::Header;
use crate::csv::time_axis::TimeAxis;
use crate::source::{
    ChannelInfo, DatasetInfo, ReadError, Reader, Samples, Source, StoredType, opened,
};
use crate::text::TextFile;
use crate::text::cells::{Cells, Lines};
use crate::text::table::{self, Kind, Layout};

/// Bytes at the front of a file from which its dialect is found.
const HEAD_BYTES: usize = 1 << 16;

pub(crate) struct CsvReader {
    text: TextFile,
    layout: Layout,
    rows: usize,
}

/// A table of text that was opened.
pub(crate) struct OpenedTable {
    pub(crate) dataset: DatasetInfo,
    pub(crate) notes: Vec<String>,
    pub(crate) reader: CsvReader,
}

/// Open a text table.
///
/// # Errors
/// If the file cannot be read, is empty, or no separator makes a table of numbers of it.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let table = open_text(TextFile::open(path)?, "")?;
    opened("csv", path, vec![table.dataset], table.notes, table.reader)
}

/// Open the table in a text, as a dataset of a name.
///
/// # Errors
/// As [`open`].
pub(crate) fn open_text(text: TextFile, name: &str) -> Result<OpenedTable, ReadError> {
    let head = text.head(HEAD_BYTES)?;
    let quotes = memchr::memchr(b'"', &head).is_some();
    let front = Front::read(&text, &head, quotes)?;
    let rows = front.rows(&head, quotes);
    let mut layout = front.layout(&text, &rows, quotes);
    let (count, last) = table::count_rows(&text, &layout)?;
    table::refuse_ragged(&text, count, layout.kinds.len(), text.length())?;
    let mut notes = Vec::new();
    let last_row = last_row(&text, &layout, last, &mut notes)?;
    let axis = time_axis::find(&front.header, &layout, &rows, last_row.as_deref(), count);
    layout.names.clone_from(&front.header.names);
    notes.extend(axis.iter().flat_map(|a| a.note.clone()));
    let dataset = DatasetInfo {
        name: name.to_owned(),
        ..dataset(front.header, &layout, count, axis.as_ref())
    };
    Ok(OpenedTable {
        dataset,
        notes,
        reader: CsvReader {
            text,
            layout,
            rows: to_usize(count),
        },
    })
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
    let stated = crate::attribute::sample_rate_hz(&header.attributes);
    let rate = axis.and_then(|a| a.rate_hz).or(stated);
    let start = axis
        .and_then(|a| a.start.clone())
        .or_else(|| crate::attribute::start_time(&header.attributes));
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

impl Reader for CsvReader {
    fn read(&self, _: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        table::read_columns(&self.text, &self.layout, channels, self.rows)
    }
}

#[cfg(test)]
mod tests;
