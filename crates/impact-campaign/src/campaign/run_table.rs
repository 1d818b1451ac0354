//! The run table: a CSV file or a sheet of a workbook with one row per record, units in its header.

mod files;
mod headings;
mod sheets;
mod text;

use std::collections::HashSet;
use std::path::Path;
use std::str::FromStr;

use strum::VariantNames;

use super::context::Wrong;
use super::diagnostic::{Code, Diagnostic, FaultCollector, Place, Severity, first_of};
use super::nearest::nearest;
use super::slashes;
use super::values::Excitation;
use impact_records::language::Language;
use impact_records::record::Sweep;
use labfiles::units::{self, Dimension};

use headings::{
    COLUMNS, DATASET, FILE, FREQUENCY, begun_with, column_of, columns_of, states_setting,
};

use text::{decode, reader};

pub(super) use headings::{column_name, in_english};
pub(super) use sheets::sheet_of;
pub(super) use text::is_file;

/// The columns that hold numbers.
const NUMBERS: [usize; 3] = [3, 4, 6];

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

/// A run table as it is written.
struct Written {
    text: String,
    separator: u8,
    /// The names of the sheets of the workbook in which it is one.
    sheets: Option<Vec<String>>,
}

/// The text of a run table.
fn text_of(folder: &Path, name: &str, faults: &mut FaultCollector) -> Option<Written> {
    let path = &folder.join(name);
    let mut refuse = |what: String, remedy: &str| {
        faults.fault(Code::UnreadableFile, None, "", what, remedy);
    };
    let lies = "check run_table in [records]; its path starts at the folder of campaign.toml, where that is a \
                link at the link's";
    let cannot = |said: &str| {
        if !slashes::is_foreign(name) {
            return (format!("the run table cannot be read: {said}"), lies);
        }
        let shown = slashes::shown(name);
        let what = format!("the run table cannot be read: its name '{shown}' has a backslash");
        (what, slashes::REMEDY)
    };
    let tables = match labfiles::workbook_tables(path) {
        Ok(tables) => tables,
        Err(error) => {
            let (what, remedy) = cannot(&error.found);
            refuse(what, remedy);
            return None;
        }
    };
    let Some(tables) = tables else {
        return match std::fs::read(path) {
            Ok(bytes) => {
                let text = decode(&bytes);
                Some(Written {
                    separator: separator(&text),
                    text,
                    sheets: None,
                })
            }
            Err(error) => {
                let (what, remedy) = cannot(&labfiles::said(&error));
                refuse(what, remedy);
                None
            }
        };
    };
    let sheet = sheets::among(tables, &is_file(folder, name));
    if sheet.is_none() {
        refuse(sheets::none_found(), lies);
    }
    sheet.map(|sheet| Written {
        text: sheet.text,
        separator: sheets::SEPARATOR,
        sheets: Some(sheet.sheets),
    })
}

/// Read the run table `name` of a folder; rows with a fault are left out, and each fault is noted. The rows of a
/// workbook's sheet are records of that workbook where no column names files.
pub(super) fn read(folder: &Path, name: &str, faults: &mut FaultCollector) -> Vec<Row> {
    let Some(written) = text_of(folder, name, faults) else {
        return Vec::new();
    };
    let (text, separator) = (&written.text, written.separator);
    let workbook = written.sheets.is_some().then_some(name);
    let mut reader = reader(text, separator);
    let names = reader.headers().cloned().unwrap_or_default();
    if names.iter().all(str::is_empty) {
        let remedy = "write a header line and one line per record";
        faults.fault(Code::Missing, Some(1), "", "the run table is empty", remedy);
        return Vec::new();
    }
    let columns = written.columns(&names, &is_file(folder, name));
    let header = read_header(&names, &columns, workbook.is_some(), faults);
    if faults.blocks() {
        return Vec::new();
    }
    let records: Vec<csv::StringRecord> = reader
        .records()
        .filter_map(|record| whole_row(record, names.len(), faults))
        .collect();
    if let Some(own) = written.sheets.as_deref()
        && names_none(own, &header, &records, faults)
    {
        return Vec::new();
    }
    let Some(mark) = decimal_mark(separator, &records, &header, faults) else {
        return Vec::new();
    };
    let mut bad = BadCells::default();
    let mut rows: Vec<Row> = records
        .iter()
        .filter_map(|record| {
            let cells = Cells {
                record,
                header: &header,
                mark,
                workbook,
            };
            read_row(&cells, &mut bad, faults)
        })
        .collect();
    let mut files: Vec<&mut String> = rows.iter_mut().map(|row| &mut row.file).collect();
    files::find(folder, name, &mut files);
    rows.retain(|row| {
        let missing = slashes::is_foreign(&row.file) && !folder.join(&row.file).exists();
        if missing {
            bad.0[FILE].push((row.line, slashes::shown(&row.file)));
        }
        !missing
    });
    bad.note(faults);
    if rows.is_empty() && !faults.blocks() {
        let what = "the run table has a header and no records".to_owned();
        faults.fault(Code::Missing, None, "", what, "write one line per record");
    }
    rows
}

impl Written {
    /// The column of each heading, if it is known.
    fn columns(
        &self,
        names: &csv::StringRecord,
        is_file: &dyn Fn(&str) -> bool,
    ) -> Vec<Option<usize>> {
        let mut reader = reader(&self.text, self.separator);
        let rows: Vec<csv::StringRecord> = reader.records().filter_map(Result::ok).collect();
        let sheets = self.sheets.as_deref().unwrap_or_default();
        let is_sheet = |cell: &str| sheets.iter().any(|sheet| sheet == cell);
        columns_of(names, &rows, [is_file, &is_sheet])
    }
}

/// Whether the rows of a workbook's sheet name datasets of which none is in it, and no file; noted as a fault.
fn names_none(
    own: &[String],
    header: &Header,
    records: &[csv::StringRecord],
    faults: &mut FaultCollector,
) -> bool {
    let (None, Some(at)) = (header.at[FILE], header.at[DATASET]) else {
        return false;
    };
    let cells = records.iter().filter_map(|record| record.get(at));
    let named: Vec<&str> = cells.filter(|cell| !cell.is_empty()).collect();
    let none = !named.is_empty() && !named.iter().any(|cell| sheets::holds(own, cell));
    if none {
        let names: Vec<String> = named.iter().map(|name| format!("'{name}'")).collect();
        let what = format!(
            "the run table has no column 'file', and none of the datasets that it names is in its own workbook: {}",
            first_of(&names)
        );
        let remedy =
            "add a column file: in each row the name of the workbook that holds the record";
        faults.fault(Code::Missing, None, "file", what, remedy);
    }
    none
}

/// Rows at the front of a file from which is told what its cells name.
const LOOKED_AT: usize = 50;

/// Whether a text begins as a run table does: with a header that has the column of files, or a setting and a column whose
/// cells name files.
pub(super) fn is_run_table(head: &[u8], is_file: &dyn Fn(&str) -> bool) -> bool {
    let text = decode(head);
    let mut reader = reader(&text, separator(&text));
    let Ok(names) = reader.headers().cloned() else {
        return false;
    };
    if names.iter().any(|name| column_of(name) == Some(FILE)) {
        return true;
    }
    let rows = reader.records().filter_map(Result::ok).take(LOOKED_AT);
    let rows: Vec<csv::StringRecord> = rows.collect();
    let columns = columns_of(&names, &rows, [is_file, &|_: &str| false]);
    columns.contains(&Some(FILE)) && states_setting(&columns)
}

fn is_frequency(heading: &str) -> bool {
    column_of(heading) == Some(FREQUENCY)
}

/// Whether the front of a run table states drive frequencies, and no free decays.
pub(super) fn states_drive(head: &[u8]) -> bool {
    let text = decode(head);
    let mut reader = reader(&text, separator(&text));
    let headings = reader.headers().cloned().unwrap_or_default();
    let Some(column) = headings.iter().position(is_frequency) else {
        return false;
    };
    let rows: Vec<csv::StringRecord> = reader.records().filter_map(Result::ok).collect();
    let decays = |row: &csv::StringRecord| row.iter().any(|cell| in_english(cell) == "free_decay");
    let stated = |row: &csv::StringRecord| {
        let cell = row.get(column).unwrap_or("");
        cell.chars().any(|c| ('1'..='9').contains(&c))
    };
    rows.iter().any(stated) && !rows.iter().any(decays)
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

fn read_header(
    names: &csv::StringRecord,
    columns: &[Option<usize>],
    in_workbook: bool,
    faults: &mut FaultCollector,
) -> Header {
    let mut header = Header {
        factor: [1.0; COLUMNS.len()],
        ..Header::default()
    };
    let mut unknown = Vec::new();
    for (index, (name, column)) in names.iter().zip(columns).enumerate() {
        let (bare, symbol) = if COLUMNS.contains(&name) {
            (name, None)
        } else {
            units::split_unit(name)
        };
        let Some(column) = *column else {
            unknown.push((name, bare));
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
    if header.at[0].is_none() && !in_workbook {
        let what = "the run table has no column 'file'".to_owned();
        faults.fault(
            Code::Missing,
            Some(1),
            "file",
            what,
            "add it: the names of the files, one per record",
        );
    }
    let complete = (header.at[FILE].is_some() || in_workbook) && states_setting(columns);
    let missing = |column: usize| header.at[column].is_none();
    note_unknown(&unknown, &missing, complete, faults);
    header
}

/// Columns that are none of a run table, and no remarks: notes where the columns that are needed are there and nothing like
/// them is meant.
fn note_unknown(
    unknown: &[(&str, &str)],
    missing: &dyn Fn(usize) -> bool,
    complete: bool,
    faults: &mut FaultCollector,
) {
    let mut unused = Vec::new();
    for (name, bare) in unknown {
        let lower = bare.to_lowercase();
        let mut remarks = Language::all().flat_map(|language| &language.run_table().remarks);
        if remarks.any(|r| lower.starts_with(r)) {
            continue;
        }
        let setting = begun_with(bare).filter(|column| missing(*column));
        let setting = setting.map(|column| COLUMNS[column]);
        let remedy = match setting.or_else(|| nearest(bare, &COLUMNS)) {
            Some(near) => format!("did you mean '{near}'? Otherwise begin its name with 'note'"),
            None if complete => {
                unused.push((*name).to_owned());
                continue;
            }
            None => format!(
                "the columns are {}; begin a remark's name with 'note'",
                COLUMNS.join(", ")
            ),
        };
        let what = format!("the column '{name}' is not known");
        faults.fault(Code::UnknownEntry, Some(1), name, what, &remedy);
    }
    if !unused.is_empty() {
        let place = Place {
            file: faults.file().to_path_buf(),
            line: Some(1),
            ..Place::default()
        };
        let what = format!(
            "columns that are not known are not used: {}",
            unused.join(", ")
        );
        let remedy = format!(
            "nothing, if they are notes; the columns are {}",
            COLUMNS.join(", ")
        );
        let kind = (Code::UnknownEntry, Severity::Note);
        faults.extend([Diagnostic::new(kind, place, what, &remedy)]);
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

/// A row with as many cells as the header.
fn whole_row(
    record: csv::Result<csv::StringRecord>,
    columns: usize,
    faults: &mut FaultCollector,
) -> Option<csv::StringRecord> {
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
    if record.len() != columns {
        let line = record.position().and_then(line_of);
        let what = format!("the row has {} cells, the header {columns}", record.len());
        faults.fault(Code::Syntax, line, "", what, "fix the row");
        return None;
    }
    Some(record)
}

/// The decimal mark of all numbers of a table; `None`, with a fault, where both are in use.
fn decimal_mark(
    separator: u8,
    records: &[csv::StringRecord],
    header: &Header,
    faults: &mut FaultCollector,
) -> Option<char> {
    if separator == b',' {
        return Some('.');
    }
    let with = |mark: char| {
        let cells = records.iter().flat_map(|record| {
            let line = record.position().and_then(line_of);
            let columns = NUMBERS.iter().filter_map(|column| header.at[*column]);
            columns.filter_map(move |at| Some((line, record.get(at)?)))
        });
        let mut cells = cells.filter(|(_, cell)| is_of_digits(cell));
        cells.find(|(_, cell)| cell.contains(mark))
    };
    match (with('.'), with(',')) {
        (Some((line, point)), Some((other, comma))) => {
            let what = format!(
                "'{point}' has a point and '{comma}' in line {} a comma: which is the decimal \
                 mark?",
                other.unwrap_or(0)
            );
            let remedy = "write one decimal mark in all numbers, and no mark between thousands";
            faults.fault(Code::InvalidValue, line, "", what, remedy);
            None
        }
        (None, Some(_)) => Some(','),
        _ => Some('.'),
    }
}

/// Whether a cell holds digits, marks, signs and exponents alone.
fn is_of_digits(cell: &str) -> bool {
    let part = |c: char| c.is_ascii_digit() || "+-.,eE".contains(c);
    cell.contains(|c: char| c.is_ascii_digit()) && cell.chars().all(part)
}

fn read_row(cells: &Cells<'_>, bad: &mut BadCells, faults: &mut FaultCollector) -> Option<Row> {
    let line = cells.line();
    let file = cells.text(0).or_else(|| cells.workbook.map(str::to_owned));
    let Some(file) = file else {
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
        drive_frequency_hz: cells.number(3, bad),
        clearance_m: cells.number(4, bad),
        sweep: cells.word(5, bad),
        drive_amplitude: cells.number(6, bad),
        excitation: cells.word(7, bad),
        specimen: cells.text(8),
    })
}

/// The cells of a row.
struct Cells<'a> {
    record: &'a csv::StringRecord,
    header: &'a Header,
    /// The decimal mark of the table.
    mark: char,
    /// The workbook of which the table is a sheet.
    workbook: Option<&'a str>,
}

impl Cells<'_> {
    fn line(&self) -> usize {
        self.record.position().and_then(line_of).unwrap_or(0)
    }

    fn text(&self, column: usize) -> Option<String> {
        let cell = self.record.get(self.header.at[column]?)?;
        (!cell.is_empty()).then(|| cell.to_owned())
    }

    fn number(&self, column: usize, bad: &mut BadCells) -> Option<f64> {
        let cell = self.text(column)?;
        match cell.replace(self.mark, ".").parse::<f64>() {
            Ok(value) if value.is_finite() => Some(value * self.header.factor[column]),
            _ => {
                bad.0[column].push((self.line(), cell));
                None
            }
        }
    }

    fn word<T: FromStr>(&self, column: usize, bad: &mut BadCells) -> Option<T> {
        let cell = self.text(column)?;
        let found = in_english(&cell).parse().ok();
        if found.is_none() {
            bad.0[column].push((self.line(), cell));
        }
        found
    }
}

/// Lines and texts of the cells of each column that cannot be read.
#[derive(Debug, Default)]
struct BadCells([Vec<(usize, String)>; COLUMNS.len()]);

impl BadCells {
    /// One fault for each column with such cells.
    fn note(&self, faults: &mut FaultCollector) {
        for (column, cells) in self.0.iter().enumerate() {
            let Some((first, _)) = cells.first() else {
                continue;
            };
            let mut texts: Vec<String> = cells.iter().map(|(_, t)| format!("'{t}'")).collect();
            let mut seen = HashSet::new();
            texts.retain(|text| seen.insert(text.clone()));
            let (what, remedy) = expected(column, &texts);
            let (line, lines) = match cells.len() {
                1 => (Some(*first), String::new()),
                count => {
                    let lines: Vec<String> = cells.iter().map(|(l, _)| l.to_string()).collect();
                    let lines = first_of(&lines);
                    (None, format!(" (in {count} lines: {lines})"))
                }
            };
            let what = format!("{} {what}{lines}", first_of(&texts));
            faults.fault(Code::InvalidValue, line, COLUMNS[column], what, remedy);
        }
    }
}

/// What texts of a column should have been, as the end of a sentence, and what to do.
fn expected(column: usize, texts: &[String]) -> (String, &'static str) {
    let one = texts.len() == 1;
    let verb = if one { "is" } else { "are" };
    let of = |words: &[&str]| {
        let what = format!("{verb} not one of {}", words.join(", "));
        (what, "write one of these words")
    };
    match column {
        FILE => {
            let has = if one { "has" } else { "have" };
            (
                format!("{has} a backslash, and no such file exists"),
                slashes::REMEDY,
            )
        }
        5 => of(Sweep::VARIANTS),
        7 => of(Excitation::VARIANTS),
        _ => {
            let what = if one { "a number" } else { "numbers" };
            let remedy = if texts.iter().any(|text| text.contains(',')) {
                "write a decimal point"
            } else {
                "write a number; the unit belongs in the header"
            };
            (format!("{verb} not {what}"), remedy)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &[u8]) -> (Vec<Row>, Vec<String>) {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        let mut faults = FaultCollector::new(file.path());
        let name = file.path().to_string_lossy();
        let rows = read(Path::new(""), &name, &mut faults);
        let all = faults.into_diagnostics().0;
        let said = |d: &super::super::diagnostic::Diagnostic| {
            let line = d.place.line.map_or(String::new(), |l| format!("{l}: "));
            format!("{line}{}: {}. {}", d.place.item, d.message, d.remedy)
        };
        (rows, all.iter().map(said).collect())
    }

    fn clearances(text: &str) -> Vec<Option<f64>> {
        let (rows, faults) = read_text(text.as_bytes());
        assert_eq!(faults, [""; 0], "{text}");
        rows.iter().map(|row| row.clearance_m).collect()
    }

    #[test]
    fn a_run_table_is_recognised_by_its_header_whatever_separates_it() {
        for text in [
            "file,sweep\n",
            "sweep;file\n",
            "# made by hand\n\nsweep\tfile\n",
            "\u{feff}file;clearance in mm\n",
            "file;gap / mm;f / Hz\n",
            "\"file\";\"note\"\n",
        ] {
            assert!(is_run_table(text.as_bytes(), &|_| false), "{text}");
        }
        let unicode: Vec<u8> = "\u{feff}file\tsweep\n"
            .encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect();
        assert!(is_run_table(&unicode, &|_| false));
        for text in ["", "t;x\n0;1\n", "profile;my file\n", "1,2\n"] {
            assert!(!is_run_table(text.as_bytes(), &|_| false), "{text}");
        }
    }

    #[test]
    fn words_of_every_language_name_a_column_or_what_a_cell_states() {
        for table in Language::all().map(Language::run_table) {
            for (name, headings) in &table.columns {
                let column = COLUMNS.iter().position(|c| c == name);
                assert!(column.is_some(), "{name} is no column");
                for heading in headings {
                    assert_eq!(column_of(units::split_unit(heading).0), column, "{heading}");
                }
            }
            for (name, words) in &table.words {
                let known = name.parse::<Sweep>().is_ok() || name.parse::<Excitation>().is_ok();
                assert!(known, "{name}");
                assert!(words.iter().all(|word| in_english(word) == *name), "{name}");
            }
        }
    }

    #[test]
    fn decimal_commas_are_read_where_no_comma_separates() {
        for text in [
            "file;clearance [m]\na;8,82\nb;9\nc;\n",
            "file\tclearance [m]\na\t8,82\nb\t9\nc\t\n",
            "file;clearance [m]\na;8.82\nb;9\nc;\n",
            "file;clearance [m];note\na;8.82;1,5\nb;9;\nc;;\n",
            "file,clearance [m]\na,8.82\nb,9\nc,\n",
        ] {
            assert_eq!(clearances(text), [Some(8.82), Some(9.0), None], "{text}");
        }
        assert_eq!(clearances("file;clearance_m\na;8,929\n"), [Some(8.929)]);
        let (rows, _) = read_text(b"file;drive_frequency_hz;drive_amplitude\na;1,5e1;0,5\n");
        assert_eq!(
            (rows[0].drive_frequency_hz, rows[0].drive_amplitude),
            (Some(15.0), Some(0.5))
        );
    }

    #[test]
    fn a_table_with_both_decimal_marks_is_refused_once() {
        let remedy = "write one decimal mark in all numbers, and no mark between thousands";
        for (text, what) in [
            (
                "file;clearance_mm\na;1\nb;8.82\nc;8,93\nd;8,94\n",
                "3: : '8.82' has a point and '8,93' in line 4 a comma: which is the decimal mark?",
            ),
            (
                "file;clearance_mm\na;1.234,5\n",
                "2: : '1.234,5' has a point and '1.234,5' in line 2 a comma: which is the decimal \
                 mark?",
            ),
        ] {
            let (rows, faults) = read_text(text.as_bytes());
            assert!(rows.is_empty());
            assert_eq!(faults, [format!("{what}. {remedy}")]);
        }
    }

    #[test]
    fn cells_that_cannot_be_read_are_one_fault_for_each_column() {
        let mut text = "file,clearance_mm,drive_frequency_hz,sweep\n".to_owned();
        for k in 0..8 {
            text += &format!("r{k},\"8,{k}\",{k} Hz,hoch\n");
        }
        let (_, faults) = read_text(text.as_bytes());
        assert_eq!(
            faults,
            [
                "drive_frequency: '0 Hz', '1 Hz', '2 Hz', '3 Hz', '4 Hz', '5 Hz', … are not numbers \
                 (in 8 lines: 2, 3, 4, 5, 6, 7, …). write a number; the unit belongs in the header",
                "clearance: '8,0', '8,1', '8,2', '8,3', '8,4', '8,5', … are not numbers (in 8 lines: \
                 2, 3, 4, 5, 6, 7, …). write a decimal point",
                "sweep: 'hoch' is not one of up, down, unknown (in 8 lines: 2, 3, 4, 5, 6, 7, …). \
                 write one of these words",
            ]
        );
        let (_, faults) = read_text(b"file,clearance_mm\na,1\nb,two\n");
        let one =
            "3: clearance: 'two' is not a number. write a number; the unit belongs in the header";
        assert_eq!(faults, [one]);
    }

    #[test]
    fn lines_are_counted_whatever_ends_them() {
        for end in ["\n", "\r\n", "\r"] {
            let text = ["file,clearance_mm", "a,1", "b,two", ""].join(end);
            let (_, faults) = read_text(text.as_bytes());
            assert!(faults[0].starts_with("3: clearance"), "{end:?}: {faults:?}");
        }
    }

    #[test]
    fn german_headings_and_words_are_read() {
        let text = "Datei;Frequenz [Hz];Spalt in mm;Richtung;Bemerkung\na.csv;12,5;1,2;auf;gut\nb.csv;12;1,2;Ab;\n";
        assert!(is_run_table(text.as_bytes(), &|_| false));
        let (windows, _, _) = encoding_rs::WINDOWS_1252.encode(text);
        let (rows, faults) = read_text(&windows);
        assert_eq!(faults, [""; 0]);
        assert_eq!(rows[0].file, "a.csv");
        assert_eq!(
            (rows[0].drive_frequency_hz, rows[0].sweep),
            (Some(12.5), Some(Sweep::Up))
        );
        assert!((rows[1].clearance_m.unwrap() - 1.2e-3).abs() < 1e-15);
        assert_eq!(rows[1].sweep, Some(Sweep::Down));
    }

    #[test]
    fn headings_may_have_capitals() {
        let text = b"File,Frequency [Hz],CLEARANCE_mm,Sweep\na,8.5,2,Up\n";
        assert!(is_run_table(text, &|_| false));
        let (rows, faults) = read_text(text);
        assert_eq!(faults, [""; 0]);
        assert_eq!(rows[0].drive_frequency_hz, Some(8.5));
        assert_eq!(rows[0].clearance_m, Some(2e-3));
        assert_eq!(rows[0].sweep, Some(Sweep::Up));
    }

    #[test]
    fn symbols_and_other_words_of_a_gap_and_a_sweep_are_headings() {
        for heading in ["f [Hz]", "f (Hz)", "Excitation frequency (Hz)"] {
            assert!(is_frequency(heading), "{heading}");
        }
        assert_eq!(column_of("F [N]"), None);
        for (heading, column) in [
            ("Luftspalt [mm]", "clearance"),
            ("Spaltmaß [mm]", "clearance"),
            ("Sweeprichtung", "sweep"),
        ] {
            assert_eq!(column_of(heading).map(|c| COLUMNS[c]), Some(column));
        }
    }

    #[test]
    fn unknown_columns_beside_all_that_are_needed_are_one_note() {
        let text = "Nr.;Datum;Datei;Frequenz [Hz];Prüfer\n1;3.5.;a.csv;8,5;FP\n";
        let (rows, faults) = read_text(text.as_bytes());
        assert_eq!(rows.len(), 1);
        assert_eq!(faults.len(), 1);
        let found = "1: : columns that are not known are not used: Nr., Datum, Prüfer. ";
        assert!(faults[0].starts_with(found), "{faults:?}");
        // one that is needed may be meant, also a setting that is not there so
        let text = "Datei;Frequenz [Hz];Spalt 2r [mm]\na.csv;8,5;2\n";
        let (_, faults) = read_text(text.as_bytes());
        assert!(
            faults[0].contains("did you mean 'clearance'?"),
            "{faults:?}"
        );
        for text in ["file,Nr.\na,1\n", "file,gap [mm],swep\na,1,up\n"] {
            let (_, faults) = read_text(text.as_bytes());
            assert!(faults[0].contains("is not known"), "{faults:?}");
        }
    }

    #[test]
    fn a_name_without_its_ending_is_that_of_the_one_file() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let text = "fname,freq_Hz,gap_mm,dir\nrun1,8,1,1\nrun2,9,1,-1\n";
        for name in ["log.csv", "run1.csv", "run2.csv", "run2.txt"] {
            std::fs::write(at(name), text).unwrap();
        }
        let mut faults = FaultCollector::new(&at("log.csv"));
        let rows = read(folder.path(), "log.csv", &mut faults);
        let files: Vec<&str> = rows.iter().map(|row| row.file.as_str()).collect();
        assert_eq!(files, ["run1.csv", "run2"]);
        let sweeps: Vec<Option<Sweep>> = rows.iter().map(|row| row.sweep).collect();
        assert_eq!(sweeps, [Some(Sweep::Up), Some(Sweep::Down)]);
    }

    #[test]
    fn files_that_are_all_in_one_folder_below_are_found_there() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for name in ["data", "old"] {
            std::fs::create_dir(at(name)).unwrap();
        }
        for name in ["runs.csv", "data/a.csv", "data/b.csv"] {
            std::fs::write(at(name), "file,gap [mm]\na.csv,1\nb.csv,1\n").unwrap();
        }
        let files = || {
            let mut faults = FaultCollector::new(&at("runs.csv"));
            let rows = read(folder.path(), "runs.csv", &mut faults);
            rows.into_iter().map(|row| row.file).collect::<Vec<_>>()
        };
        assert_eq!(files(), ["data/a.csv", "data/b.csv"]);
        // where more folders have such files, or one is where the table says, none is guessed
        std::fs::write(at("old/b.csv"), "").unwrap();
        assert_eq!(files(), ["a.csv", "b.csv"]);
        std::fs::remove_file(at("old/b.csv")).unwrap();
        std::fs::write(at("a.csv"), "").unwrap();
        assert_eq!(files(), ["a.csv", "b.csv"]);
    }

    #[test]
    #[cfg(unix)]
    fn backslashes_in_names_are_named() {
        let (_, faults) = read_text(b"file,gap [mm]\nsub\\r0.csv,1\nsub\\r1.csv,1\n");
        let remedy = slashes::REMEDY;
        let what = r"file: 'sub\r0.csv', 'sub\r1.csv' have a backslash, and no such file exists (in 2 lines: 2, 3)";
        assert_eq!(faults, [format!("{what}. {remedy}")]);
        for table in ["sub\\runs.csv", "sub\runs.csv"] {
            let mut faults = FaultCollector::new(Path::new(table));
            read(Path::new(""), table, &mut faults);
            let said = faults.into_diagnostics().0.remove(0).to_string();
            let what = format!(r"its name 'sub\runs.csv' has a backslash. {remedy}");
            assert!(said.contains(&what), "{said}");
            assert!(!said.contains('\r'), "{said:?}");
        }
    }

    #[test]
    fn rows_of_a_workbook_that_name_datasets_of_another_lack_a_column_of_files() {
        let mut header = Header::default();
        header.at[DATASET] = Some(0);
        let rows = ["run 1", "run 2"].map(|name| csv::StringRecord::from(vec![name]));
        let said = |own: &str| {
            let mut faults = FaultCollector::new(Path::new("s.xlsx"));
            let none = names_none(&[own.to_owned()], &header, &rows, &mut faults);
            (none, faults.into_diagnostics().to_string())
        };
        assert_eq!(said("run 2"), (false, String::new()));
        let (none, text) = said("S");
        assert!(none, "{text}");
        assert!(
            text.contains("'run 1', 'run 2'. add a column file"),
            "{text}"
        );
        assert_eq!(text.lines().count(), 1);
    }
}
