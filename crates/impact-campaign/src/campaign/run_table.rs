//! The run table: a CSV file or a sheet of a workbook with one row per record, units in its header.

use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use std::str::FromStr;

use strum::VariantNames;

use super::context::Wrong;
use super::diagnostic::{Code, FaultCollector, first_of};
use super::nearest::nearest;
use super::values::Excitation;
use impact_records::language::{Language, RunTableWords};
use impact_records::record::Sweep;
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

/// What a word of any language is called in this program.
fn called<'a>(
    word: &str,
    of: impl Fn(&'static RunTableWords) -> &'static BTreeMap<String, Vec<String>> + 'a,
) -> Option<&'static str> {
    let lower = word.trim().to_lowercase();
    let mut each = Language::all().flat_map(|language| of(language.run_table()));
    let found = each.find(|(_, others)| others.contains(&lower));
    found.map(|(name, _)| name.as_str())
}

/// A word of a cell as this program writes it.
pub(super) fn in_english(word: &str) -> String {
    let known = called(word, |table| &table.words);
    known.map_or_else(|| word.trim().to_lowercase(), str::to_owned)
}

/// The column of a heading without its unit.
fn column_of(bare: &str) -> Option<usize> {
    let place = |name: &str| COLUMNS.iter().position(|c| *c == name);
    place(bare).or_else(|| place(called(bare, |table| &table.columns)?))
}

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

/// The text of a run table, and whether it is a sheet of a workbook.
fn text_of(path: &Path, faults: &mut FaultCollector) -> Option<(String, bool)> {
    let mut refuse = |what: String| {
        let remedy = "check run_table in [records]; its path starts at the folder of campaign.toml, where that is a \
                      link at the link's";
        faults.fault(Code::UnreadableFile, None, "", what, remedy);
    };
    let tables = match labfiles::workbook_tables(path) {
        Ok(tables) => tables,
        Err(error) => {
            refuse(format!("the run table cannot be read: {}", error.found));
            return None;
        }
    };
    let Some(tables) = tables else {
        return match std::fs::read(path) {
            Ok(bytes) => Some((decode(&bytes), false)),
            Err(error) => {
                let said = labfiles::said(&error);
                refuse(format!("the run table cannot be read: {said}"));
                None
            }
        };
    };
    let sheet = tables.into_iter().map(|bytes| decode(&bytes)).find(|text| {
        let mut reader = reader(text, separator(text));
        reader
            .headers()
            .is_ok_and(|names| lists_sheets(names.iter()))
    });
    if sheet.is_none() {
        refuse("no sheet of the workbook is a run table: none has the columns 'dataset' and 'clearance' or 'drive_frequency'".to_owned());
    }
    sheet.map(|text| (text, true))
}

/// Whether the headings of a sheet are those of a run table: the names of other sheets, and a setting.
pub(super) fn lists_sheets<'a>(headings: impl Iterator<Item = &'a str>) -> bool {
    let columns: Vec<usize> = headings
        .filter_map(|name| column_of(name).or_else(|| column_of(units::split_unit(name).0)))
        .collect();
    let has = |name: &str| columns.iter().any(|c| COLUMNS[*c] == name);
    has("dataset") && (has("clearance") || has("drive_frequency"))
}

/// Read the run table `name` of a folder; rows with a fault are left out, and each fault is noted. The rows of a
/// workbook's sheet are records of that workbook where no column names files.
pub(super) fn read(folder: &Path, name: &str, faults: &mut FaultCollector) -> Vec<Row> {
    let Some((text, in_workbook)) = text_of(&folder.join(name), faults) else {
        return Vec::new();
    };
    let workbook = in_workbook.then_some(name);
    let separator = separator(&text);
    let mut reader = reader(&text, separator);
    let header = match reader.headers() {
        Ok(names) if names.iter().any(|n| !n.is_empty()) => {
            read_header(&names.clone(), in_workbook, faults)
        }
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
    let records: Vec<csv::StringRecord> = reader
        .records()
        .filter_map(|record| whole_row(record, columns, faults))
        .collect();
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
    bad.note(faults);
    for row in &mut rows {
        row.file = beside(folder, name, &row.file).unwrap_or_else(|| row.file.clone());
    }
    if rows.is_empty() && !faults.blocks() {
        let what = "the run table has a header and no records".to_owned();
        faults.fault(Code::Missing, None, "", what, "write one line per record");
    }
    rows
}

/// The path of a file that is not in the campaign's folder but in that of the run table, below the campaign's.
fn beside(folder: &Path, table: &str, file: &str) -> Option<String> {
    let below = Path::new(table).parent()?.join(file);
    let moved = !folder.join(file).exists() && folder.join(&below).exists();
    moved.then(|| below.to_string_lossy().into_owned())
}

/// Whether a text begins as a run table does: with a header that has the column of files.
pub(super) fn is_run_table(head: &[u8]) -> bool {
    let text = decode(head);
    let mut reader = reader(&text, separator(&text));
    let names = reader.headers();
    names.is_ok_and(|names| names.iter().any(|name| column_of(name) == Some(0)))
}

/// Whether headings contain that of the drive frequency.
pub(super) fn has_frequencies<'a>(mut headings: impl Iterator<Item = &'a str>) -> bool {
    headings.any(is_frequency)
}

fn is_frequency(heading: &str) -> bool {
    let column = column_of(heading).or_else(|| column_of(units::split_unit(heading).0));
    column.is_some_and(|c| COLUMNS[c] == "drive_frequency")
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
    // the lines' numbers are counted by line feeds
    let text = without_mark.decode(bytes).0;
    text.replace("\r\n", "\n").replace('\r', "\n")
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
    in_workbook: bool,
    faults: &mut FaultCollector,
) -> Header {
    let mut header = Header {
        factor: [1.0; COLUMNS.len()],
        ..Header::default()
    };
    for (index, name) in names.iter().enumerate() {
        let (bare, symbol) = if COLUMNS.contains(&name) {
            (name, None)
        } else {
            units::split_unit(name)
        };
        let Some(column) = column_of(bare) else {
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
    let lower = bare.to_lowercase();
    let mut remarks = Language::all().flat_map(|language| &language.run_table().remarks);
    if !remarks.any(|r| lower.starts_with(r)) {
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
        assert!(is_run_table(text.as_bytes()));
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
}
