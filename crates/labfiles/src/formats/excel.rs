//! Excel workbooks (`.xlsx`, `.xlsm`, `.xls`): each sheet that holds a table is a dataset.
//!
//! The cells of a sheet are written out as a text table, so that headings, units and the time axis are
//! found as in any other.

mod biff;
mod cells;
mod compound;

use std::fs::File;
use std::io::{Cursor, Read as _};
use std::path::Path;

use calamine::{Data, DataRef, Reader as _, Xls, Xlsx};

use crate::formats::csv::{self, CsvReader};
use crate::formats::documents::Document;
use crate::formats::excel::cells::{SheetCells, damaged};
use crate::formats::excel::compound::Compound;
use crate::formats::parquet::guard::caught;
use crate::source::{DatasetInfo, ReadError, Reader, Samples, Source, opened};
use crate::text::TextFile;

/// First bytes of a ZIP archive, as `.xlsx` is one.
pub(crate) const ZIP: &[u8] = b"PK\x03\x04";
/// First bytes of a compound file, as `.xls` is one.
const COMPOUND: &[u8] = b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1";
/// The largest workbook that is read: it is held whole.
const GREATEST_BYTES: u64 = 256 << 20;
/// How many times larger than its file an unpacked workbook may be.
const GREATEST_RATIO: u64 = 200;
/// Unpacked workbooks up to this size are read whatever their packing.
const HARMLESS_BYTES: u64 = 64 << 20;

/// Whether a file's first bytes are those of a workbook.
pub(crate) fn recognises(front: &[u8]) -> bool {
    front.starts_with(ZIP) || front.starts_with(COMPOUND)
}

struct Workbook {
    tables: Vec<CsvReader>,
    /// Of each dataset its table, and which part of it.
    places: Vec<(usize, usize)>,
}

impl Reader for Workbook {
    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        let (table, part) = self.places[dataset];
        self.tables[table].read(part, channels)
    }
}

/// Open a workbook.
///
/// # Errors
/// If the file cannot be read, is no workbook, or none of its sheets holds a table.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let sheets = sheets(path)?;
    let mut notes = Vec::new();
    let mut datasets: Vec<DatasetInfo> = Vec::new();
    let (mut tables, mut places) = (Vec::new(), Vec::new());
    for (name, text) in sheets {
        let opened = text.and_then(|text| csv::open_text(TextFile::of_bytes(path, text), &name));
        match opened {
            Ok(table) => {
                notes.extend(table.notes.iter().map(|n| format!("sheet '{name}': {n}")));
                places.extend((0..table.datasets.len()).map(|part| (tables.len(), part)));
                datasets.extend(table.datasets);
                tables.push(table.reader);
            }
            Err(error) => notes.push(format!("sheet '{name}' is no table: {}", error.found)),
        }
    }
    if datasets.is_empty() {
        return Err(ReadError::new(
            path,
            "a sheet with a table: one row per sample below a heading of channel names",
            match notes.first() {
                Some(note) => note.clone(),
                None => "no sheet".to_owned(),
            },
            "write the record into a sheet of its own, beginning with its heading",
        ));
    }
    opened("excel", path, datasets, notes, Workbook { tables, places })
}

/// The names and tables of a workbook's sheets, as text with tabs between the cells; `None` if the file is no workbook.
///
/// # Errors
/// If the file cannot be read, or is a damaged workbook.
pub fn workbook_tables(path: &Path) -> Result<Option<Vec<(String, Vec<u8>)>>, ReadError> {
    let mut front = Vec::new();
    let read = File::open(path).and_then(|f| f.take(COMPOUND.len() as u64).read_to_end(&mut front));
    read.map_err(|e| ReadError::io(path, &e))?;
    if !recognises(&front) {
        return Ok(None);
    }
    let tables = sheets(path)?.into_iter();
    let tables = tables.filter_map(|(name, text)| Some((name, text.ok()?)));
    Ok(Some(tables.collect()))
}

fn sheets(path: &Path) -> Result<Sheets, ReadError> {
    let bytes = whole(path)?;
    if let Some(document) = Document::of(&bytes) {
        return Err(document.refused(path));
    }
    let sheets = if bytes.starts_with(ZIP) {
        refuse_bomb(path, &bytes)?;
        caught(|| xlsx(path, bytes))
    } else {
        refuse_scattered(path, &bytes)?;
        caught(|| xls(path, bytes))
    };
    sheets.unwrap_or_else(|| Err(damaged(path, "contents that contradict each other")))
}

fn whole(path: &Path) -> Result<Vec<u8>, ReadError> {
    let length = std::fs::metadata(path)
        .map_err(|e| ReadError::io(path, &e))?
        .len();
    if length > GREATEST_BYTES {
        return Err(ReadError::new(
            path,
            format!("a workbook of at most {} MiB", GREATEST_BYTES >> 20),
            format!("{} MiB", length >> 20),
            "save the sheet as CSV: it is read piece by piece",
        ));
    }
    std::fs::read(path).map_err(|e| ReadError::io(path, &e))
}

/// Refuse an archive whose parts state a size far beyond the file's.
fn refuse_bomb(path: &Path, bytes: &[u8]) -> Result<(), ReadError> {
    let entries = memchr::memmem::find_iter(bytes, b"PK\x01\x02");
    let size = |at: usize| {
        let field = bytes.get(at + 24..at + 28)?;
        Some(u64::from(u32::from_le_bytes(field.try_into().ok()?)))
    };
    let stated: u64 = entries.filter_map(size).sum();
    let most = HARMLESS_BYTES.max(GREATEST_RATIO * bytes.len() as u64);
    if stated <= most {
        return Ok(());
    }
    Err(ReadError::new(
        path,
        format!("a workbook of at most {} MiB unpacked", most >> 20),
        format!("parts of {} MiB", stated >> 20),
        "save the sheet as CSV",
    ))
}

/// Refuse a compound file that the library would not end with, or whose cells it would lay out in far
/// more memory than the file takes.
fn refuse_scattered(path: &Path, bytes: &[u8]) -> Result<(), ReadError> {
    let stream = Compound::new(path, bytes)?.stream(&["Workbook", "Book"]);
    let fault = stream.and_then(|stream| biff::fault(&stream));
    fault.map_or(Ok(()), |found| Err(damaged(path, &found)))
}

/// Names of sheets with their tables as text, or why one has none.
type Sheets = Vec<(String, Result<Vec<u8>, ReadError>)>;

fn xlsx(path: &Path, bytes: Vec<u8>) -> Result<Sheets, ReadError> {
    let mut book = Xlsx::new(Cursor::new(bytes)).map_err(|e| damaged(path, &e.to_string()))?;
    let mut sheets = Vec::new();
    for name in book.sheet_names() {
        let text = xlsx_sheet(path, &mut book, &name);
        sheets.push((name, text));
    }
    Ok(sheets)
}

fn xlsx_sheet(
    path: &Path,
    book: &mut Xlsx<Cursor<Vec<u8>>>,
    name: &str,
) -> Result<Vec<u8>, ReadError> {
    let refused = |e: calamine::XlsxError| damaged(path, &e.to_string()).channel(name);
    let mut reader = book.worksheet_cells_reader(name).map_err(refused)?;
    let mut cells = SheetCells::default();
    while let Some(cell) = reader.next_cell().map_err(refused)? {
        let (row, column) = cell.get_position();
        let value = match cell.get_value() {
            DataRef::SharedString(text) => cells::text(text),
            other => cells::value(&Data::from(other.clone())),
        };
        cells.push(row, column, value);
    }
    cells.table(path, name)
}

fn xls(path: &Path, bytes: Vec<u8>) -> Result<Sheets, ReadError> {
    let mut book: Xls<_> =
        Xls::new(Cursor::new(bytes)).map_err(|e| damaged(path, &e.to_string()))?;
    let mut sheets = Vec::new();
    for name in book.sheet_names() {
        let text = book
            .worksheet_range(&name)
            .map_err(|e| damaged(path, &e.to_string()).channel(&name))
            .and_then(|range| {
                let mut cells = SheetCells::default();
                for (row, column, value) in range.used_cells() {
                    let at = |i: usize| u32::try_from(i).unwrap_or(u32::MAX);
                    cells.push(at(row), at(column), cells::value(value));
                }
                cells.table(path, &name)
            });
        sheets.push((name, text));
    }
    Ok(sheets)
}

#[cfg(test)]
mod tests;
