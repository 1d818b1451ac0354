//! The cells of a sheet, written out as a table of text.

use std::path::Path;

use calamine::Data;

use crate::source::ReadError;

/// Cells of a table beyond those that hold something, for each of these.
pub(super) const GREATEST_SPARSITY: u64 = 64;
/// Tables up to this number of cells are written whatever they hold.
pub(super) const HARMLESS_CELLS: u64 = 1 << 20;
/// The largest number of cells of a sheet.
const MOST_CELLS: usize = 50_000_000;

/// The filled cells of a sheet, in any order.
#[derive(Default)]
pub(super) struct SheetCells {
    filled: Vec<(u32, u32, String)>,
    too_many: bool,
}

impl SheetCells {
    pub(super) fn push(&mut self, row: u32, column: u32, value: String) {
        if value.is_empty() {
            return;
        }
        if self.filled.len() >= MOST_CELLS {
            self.too_many = true;
            return;
        }
        self.filled.push((row, column, value));
    }

    /// The cells as lines with tabs between them, without empty columns before the first.
    ///
    /// # Errors
    /// If there are none, or if they are scattered so widely that the lines would be far larger than
    /// what they hold.
    pub(super) fn table(mut self, path: &Path, sheet: &str) -> Result<Vec<u8>, ReadError> {
        self.filled.sort_by_key(|(row, column, _)| (*row, *column));
        let refused = |found: String| {
            let expected = "a sheet with one table";
            let remedy = "keep one table in a sheet, or save it as CSV";
            ReadError::new(path, expected, found, remedy).channel(sheet)
        };
        let Some(first) = self.filled.iter().map(|(_, column, _)| *column).min() else {
            return Err(refused("an empty sheet".to_owned()));
        };
        let widths: u64 = self
            .filled
            .chunk_by(|a, b| a.0 == b.0)
            .filter_map(|row| Some(u64::from(row.last()?.1 - first) + 1))
            .sum();
        let most = HARMLESS_CELLS.max(GREATEST_SPARSITY * self.filled.len() as u64);
        if self.too_many || widths > most {
            return Err(refused(format!(
                "{} cells scattered over rows of {widths}",
                self.filled.len()
            )));
        }
        // A row is as long as the widest, where that takes little: a column of few notes is one too.
        let widest = self.filled.iter().map(|(_, column, _)| *column).max();
        let rows = self.filled.chunk_by(|a, b| a.0 == b.0).count() as u64;
        let last = widest.filter(|w| rows * (u64::from(*w - first) + 1) <= most);
        let mut text = Vec::new();
        for row in self.filled.chunk_by(|a, b| a.0 == b.0) {
            let mut at = first;
            for (_, column, value) in row {
                while at < *column {
                    text.push(b'\t');
                    at += 1;
                }
                text.extend_from_slice(value.as_bytes());
            }
            while last.is_some_and(|last| at < last) {
                text.push(b'\t');
                at += 1;
            }
            text.push(b'\n');
        }
        Ok(text)
    }
}

/// A text without the signs that part cells.
pub(super) fn text(value: &str) -> String {
    let part = |c: char| c.is_control() || c == '"';
    value.replace(part, " ").trim().to_owned()
}

/// The value of a cell as a text table has it.
pub(super) fn value(data: &Data) -> String {
    match data {
        Data::Int(number) => number.to_string(),
        Data::Float(number) => number.to_string(),
        Data::Bool(flag) => u8::from(*flag).to_string(),
        Data::String(value) | Data::DateTimeIso(value) | Data::DurationIso(value) => text(value),
        Data::DateTime(time) if time.is_duration() => (time.as_f64() * 86_400.0).to_string(),
        Data::DateTime(time) => {
            let (year, month, day, hour, minute, second, millisecond) = time.to_ymd_hms_milli();
            format!(
                "{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{millisecond:03}"
            )
        }
        Data::Error(_) => "NaN".to_owned(),
        Data::Empty => String::new(),
    }
}

/// A workbook that cannot be read.
pub(super) fn damaged(path: &Path, found: &str) -> ReadError {
    ReadError::new(
        path,
        "an Excel workbook",
        found,
        "open it in a spreadsheet program and save it as .xlsx or CSV",
    )
}
