//! The run table: a CSV file with one row per record, units in its header.

use std::path::Path;
use std::str::FromStr;

use strum::VariantNames;

use super::context::Wrong;
use super::diagnostic::{Code, FaultCollector};
use super::read::nearest;
use super::written::Excitation;
use crate::record::Sweep;
use labfiles::units::{self, Dimension};

/// The columns that a run table may have.
const COLUMNS: [&str; 9] = [
    "file",
    "dataset",
    "record",
    "drive_frequency",
    "clearance",
    "sweep",
    "drive_amplitude",
    "excitation",
    "specimen",
];

/// One row; `None` where the cell is empty or the column missing.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    /// Line in the table, from 1.
    pub(super) line: usize,
    /// The file, as written.
    pub(super) file: String,
    /// The dataset in it.
    pub(super) dataset: Option<String>,
    /// The record's name.
    pub(super) record: Option<String>,
    /// Stated drive frequency, Hz.
    pub(super) drive_frequency_hz: Option<f64>,
    /// Clearance r, m.
    pub(super) clearance_m: Option<f64>,
    /// Direction of the sweep.
    pub(super) sweep: Option<Sweep>,
    /// Drive amplitude, relative.
    pub(super) drive_amplitude: Option<f64>,
    /// How the record was excited.
    pub(super) excitation: Option<Excitation>,
    /// Which rig, mass or bumper it was taken on.
    pub(super) specimen: Option<String>,
}

/// Index and unit factor of each column found.
#[derive(Debug, Default)]
struct Header {
    at: [Option<usize>; COLUMNS.len()],
    factor: [f64; COLUMNS.len()],
}

/// Read a run table; rows with a fault are left out, and each fault is noted.
pub(super) fn read(path: &Path, faults: &mut FaultCollector) -> Vec<Row> {
    let bytes = match std::fs::read(path) {
        Ok(bytes) => bytes,
        Err(error) => {
            let what = format!("the run table cannot be read: {error}");
            faults.fault(
                Code::UnreadableFile,
                None,
                "",
                what,
                "check run_table in [records]",
            );
            return Vec::new();
        }
    };
    let text = decode(&bytes);
    let mut reader = reader(&text, separator(&text));
    let header = match reader.headers() {
        Ok(names) if names.iter().any(|n| !n.is_empty()) => read_header(&names.clone(), faults),
        _ => {
            let what = "the run table is empty".to_owned();
            faults.fault(
                Code::Missing,
                Some(1),
                "",
                what,
                "write a header line and one line per record",
            );
            return Vec::new();
        }
    };
    if faults.blocks() {
        return Vec::new();
    }
    let columns = reader.headers().map_or(0, csv::StringRecord::len);
    let rows: Vec<Row> = reader
        .records()
        .filter_map(|record| read_row(record, columns, &header, faults))
        .collect();
    if rows.is_empty() && !faults.blocks() {
        let what = "the run table has a header and no records".to_owned();
        faults.fault(Code::Missing, None, "", what, "write one line per record");
    }
    rows
}

/// Whether a text begins as a run table does: with a header that has the column of files.
pub(super) fn is_run_table(head: &[u8]) -> bool {
    let text = decode(head);
    let mut reader = reader(&text, separator(&text));
    let names = reader.headers();
    names.is_ok_and(|names| names.iter().any(|name| name == COLUMNS[0]))
}

fn reader(text: &str, separator: u8) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new()
        .delimiter(separator)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes())
}

/// By its byte-order mark, else UTF-8, else Windows-1252.
fn decode(bytes: &[u8]) -> String {
    let without_mark = match std::str::from_utf8(bytes) {
        Ok(_) => encoding_rs::UTF_8,
        Err(_) => encoding_rs::WINDOWS_1252,
    };
    without_mark.decode(bytes).0.into_owned()
}

/// The separator of the header line: the most frequent of comma, semicolon and tab.
fn separator(text: &str) -> u8 {
    let filled = |l: &&str| !l.starts_with('#') && !l.trim().is_empty();
    let line = text.lines().find(filled).unwrap_or("");
    let count = |b: &u8| line.bytes().filter(|c| c == b).count();
    [b',', b';', b'\t']
        .into_iter()
        .rev()
        .max_by_key(count)
        .unwrap_or(b',')
}

fn read_header(names: &csv::StringRecord, faults: &mut FaultCollector) -> Header {
    let mut header = Header {
        factor: [1.0; COLUMNS.len()],
        ..Header::default()
    };
    for (index, name) in names.iter().enumerate() {
        let (bare, symbol) = match COLUMNS.contains(&name) {
            true => (name, None),
            false => units::split_unit(name),
        };
        let Some(column) = COLUMNS.iter().position(|c| *c == bare) else {
            note_unknown(name, bare, faults);
            continue;
        };
        if header.at[column].replace(index).is_some() {
            let what = format!("the column '{bare}' is there twice");
            faults.fault(Code::Conflict, Some(1), name, what, "remove one of them");
        }
        match factor(column, symbol) {
            Ok(factor) => header.factor[column] = factor,
            Err(wrong) => {
                faults.fault(
                    Code::InvalidValue,
                    Some(1),
                    name,
                    wrong.message,
                    &wrong.remedy,
                );
            }
        }
    }
    if header.at[0].is_none() {
        let what = "the run table has no column 'file'".to_owned();
        faults.fault(
            Code::Missing,
            Some(1),
            "file",
            what,
            "add it: the names of the files, one per record",
        );
    }
    header
}

fn note_unknown(name: &str, bare: &str, faults: &mut FaultCollector) {
    let remedy = match nearest(bare, &COLUMNS) {
        Some(near) => format!("did you mean '{near}'? Otherwise begin its name with 'note'"),
        None => format!(
            "the columns are {}; begin a remark's name with 'note'",
            COLUMNS.join(", ")
        ),
    };
    if !bare.starts_with("note") {
        faults.fault(
            Code::UnknownEntry,
            Some(1),
            name,
            format!("the column '{name}' is not known"),
            &remedy,
        );
    }
}

/// Factor to SI of a column, from the unit in its name.
fn factor(column: usize, symbol: Option<&str>) -> Result<f64, Wrong> {
    let name = COLUMNS[column];
    let (expected, remedy) = match name {
        "drive_frequency" => (
            Dimension::Frequency,
            "call it drive_frequency_hz or \"drive_frequency [Hz]\"",
        ),
        "clearance" => (
            Dimension::Length,
            "call it clearance_mm or \"clearance [mm]\"",
        ),
        _ => return Ok(1.0),
    };
    let wrong = |message| Wrong {
        message,
        remedy: remedy.to_owned(),
    };
    let unit = symbol.map(|s| (s, units::parse_split_unit(s)));
    match unit {
        None => Err(wrong(format!("a {} without unit", name.replace('_', " ")))),
        Some((_, Some(unit))) if unit.dimension == expected => Ok(unit.to_si),
        Some((symbol, _)) => Err(wrong(format!(
            "'{symbol}' is no unit of {}",
            expected.name()
        ))),
    }
}

/// Line of a position, from 1.
fn line_of(position: &csv::Position) -> Option<usize> {
    usize::try_from(position.line()).ok()
}

fn read_row(
    record: csv::Result<csv::StringRecord>,
    columns: usize,
    header: &Header,
    faults: &mut FaultCollector,
) -> Option<Row> {
    let record = match record {
        Ok(record) => record,
        Err(error) => {
            let line = error.position().and_then(line_of);
            faults.fault(
                Code::Syntax,
                line,
                "",
                format!("the row cannot be read: {error}"),
                "fix the row",
            );
            return None;
        }
    };
    let line = record.position().and_then(line_of).unwrap_or(0);
    if record.len() != columns {
        let what = format!("the row has {} cells, the header {columns}", record.len());
        faults.fault(Code::Syntax, Some(line), "", what, "fix the row");
        return None;
    }
    let cells = Cells {
        record: &record,
        header,
        line,
    };
    let Some(file) = cells.text(0) else {
        faults.fault(
            Code::Missing,
            Some(line),
            "file",
            "no file is named".to_owned(),
            "name it or remove the row",
        );
        return None;
    };
    Some(Row {
        line,
        file,
        dataset: cells.text(1),
        record: cells.text(2),
        drive_frequency_hz: cells.number(3, faults),
        clearance_m: cells.number(4, faults),
        sweep: cells.word(5, faults),
        drive_amplitude: cells.number(6, faults),
        excitation: cells.word(7, faults),
        specimen: cells.text(8),
    })
}

struct Cells<'a> {
    record: &'a csv::StringRecord,
    header: &'a Header,
    line: usize,
}

impl Cells<'_> {
    fn text(&self, column: usize) -> Option<String> {
        let cell = self.record.get(self.header.at[column]?)?;
        (!cell.is_empty()).then(|| cell.to_owned())
    }

    fn number(&self, column: usize, faults: &mut FaultCollector) -> Option<f64> {
        let cell = self.text(column)?;
        match cell.parse::<f64>() {
            Ok(value) if value.is_finite() => Some(value * self.header.factor[column]),
            _ => {
                let what = format!("'{cell}' is not a number");
                let remedy = match cell.contains(',') {
                    true => "write a decimal point",
                    false => "write a number; the unit belongs in the header",
                };
                faults.fault(
                    Code::InvalidValue,
                    Some(self.line),
                    COLUMNS[column],
                    what,
                    remedy,
                );
                None
            }
        }
    }

    fn word<T: FromStr + VariantNames>(
        &self,
        column: usize,
        faults: &mut FaultCollector,
    ) -> Option<T> {
        let cell = self.text(column)?;
        let found = cell.parse().ok();
        if found.is_none() {
            let what = format!("'{cell}' is not one of {}", T::VARIANTS.join(", "));
            faults.fault(
                Code::InvalidValue,
                Some(self.line),
                COLUMNS[column],
                what,
                "write one of these words",
            );
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_table_is_recognised_by_its_header_whatever_separates_it() {
        for text in [
            "file,sweep\n",
            "sweep;file\n",
            "# made by hand\n\nsweep\tfile\n",
            "\u{feff}file;clearance in mm\n",
            "\"file\";\"note\"\n",
        ] {
            assert!(is_run_table(text.as_bytes()), "{text}");
        }
        let unicode: Vec<u8> = "\u{feff}file\tsweep\n"
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect();
        assert!(is_run_table(&unicode));
        for text in ["", "t;x\n0;1\n", "profile;file name\n", "1,2\n"] {
            assert!(!is_run_table(text.as_bytes()), "{text}");
        }
    }
}
