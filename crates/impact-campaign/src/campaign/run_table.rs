//! The run table: a CSV file or a sheet of a workbook with one row per record, units in its header.

mod files;
mod headings;
mod sheets;
mod table;
mod text;

use std::collections::HashSet;
use std::path::Path;
use std::str::FromStr;

use strum::VariantNames;

use super::context::Wrong;
use super::diagnostic::{Code, Diagnostic, FaultCollector, Severity, first_of};
use super::nearest::nearest;
use super::slashes;
use super::values::Excitation;
use impact_records::language::Language;
use impact_records::record::Sweep;
use labfiles::units::{self, Dimension};

use headings::{
    CLEARANCE, COLUMNS, DATASET, FILE, FREQUENCY, IsNamed, NUMBERS, begun_with, column_of,
    states_setting,
};
use table::Table;
use text::{Line, decode};

pub(super) use files::is_file;
pub(super) use headings::{column_name, in_english, states_whole_gaps};
pub(super) use sheets::sheet_of;

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
    /// Whether the heading says that it is a whole gap between two masses.
    pub(super) whole_gap: bool,
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
    whole_gap: bool,
}

/// A run table as it is written.
struct Written {
    table: Table,
    /// Its sheet, and the names of all sheets, of the workbook that it is in.
    book: Option<(String, Vec<String>)>,
}

/// The table that a file is, or that a sheet of a workbook is.
fn written(folder: &Path, name: &str, faults: &mut FaultCollector) -> Option<Written> {
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
                let is_file = is_file(folder, name);
                Some(Written {
                    table: table_in(&decode(&bytes), [&is_file, &|_| false]),
                    book: None,
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
        table: sheet.table,
        book: Some((sheet.name, sheet.sheets)),
    })
}

/// The table in a text, whether it is a run table or not.
fn table_in(text: &str, is_named: IsNamed<'_>) -> Table {
    let found = Table::find(text, None, is_named, |table| table.position(FILE).is_some());
    found.unwrap_or_else(|| Table::at_front(text, is_named))
}

/// Read the run table `name` of a folder; rows with a fault are left out, and each fault is noted. The rows of a
/// workbook's sheet are records of that workbook where no column names files.
pub(super) fn read(folder: &Path, name: &str, faults: &mut FaultCollector) -> Vec<Row> {
    let Some(Written { table, book }) = written(folder, name, faults) else {
        return Vec::new();
    };
    if let Some((sheet, _)) = &book {
        faults.in_sheet(sheet);
    }
    let workbook = book.is_some().then_some(name);
    if table.headings.iter().all(String::is_empty) {
        let remedy = "write a header line and one line per record";
        faults.fault(Code::Missing, Some(1), "", "the run table is empty", remedy);
        return Vec::new();
    }
    let header = read_header(&table, workbook.is_some(), faults);
    if faults.blocks() {
        return Vec::new();
    }
    if let Some((_, own)) = &book
        && names_none(own, &table, faults)
    {
        return Vec::new();
    }
    let whole = |row: &&Line| is_whole(row, table.headings.len(), faults);
    let rows: Vec<&Line> = table.rows.iter().filter(whole).collect();
    let Some(mark) = decimal_mark(table.separator, &rows, &header, faults) else {
        return Vec::new();
    };
    let mut bad = BadCells::default();
    let mut rows: Vec<Row> = rows
        .iter()
        .filter_map(|row| {
            let cells = Cells {
                row,
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

/// Whether the rows of a workbook's sheet name datasets of which none is in it, and no file; noted as a fault.
fn names_none(own: &[String], table: &Table, faults: &mut FaultCollector) -> bool {
    if table.position(FILE).is_some() {
        return false;
    }
    let named: Vec<&str> = table.cells(DATASET).collect();
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

/// Whether a text begins as a run table does: with the headings of files, or of a setting and a column whose cells name
/// files, below any titles. A preamble of a record may name its own file above numbers.
pub(super) fn is_run_table(head: &[u8], is_file: &dyn Fn(&str) -> bool) -> bool {
    let table = table_in(&decode(head), [is_file, &|_| false]);
    let numbers = table.cells(FILE).filter(|cell| is_number(cell)).count();
    let headed = table.headings.iter().any(|h| column_of(h) == Some(FILE));
    let named = headed && 2 * numbers <= table.cells(FILE).count();
    named || table.position(FILE).is_some() && states_setting(&table.columns)
}

/// Whether a cell is a number with either decimal mark.
fn is_number(cell: &str) -> bool {
    cell.replace(',', ".").parse::<f64>().is_ok()
}

/// Whether the front of a run table states drive frequencies, and no free decays.
pub(super) fn states_drive(head: &[u8]) -> bool {
    let table = table_in(&decode(head), [&|_| true, &|_| false]);
    let decays = |row: &Line| {
        row.cells
            .iter()
            .any(|cell| in_english(cell) == "free_decay")
    };
    let stated = |cell: &str| cell.chars().any(|c| ('1'..='9').contains(&c));
    table.cells(FREQUENCY).any(stated) && !table.rows.iter().any(decays)
}

fn read_header(table: &Table, in_workbook: bool, faults: &mut FaultCollector) -> Header {
    let mut header = Header {
        factor: [1.0; COLUMNS.len()],
        ..Header::default()
    };
    let line = Some(table.line);
    let mut unknown = Vec::new();
    let named = table.headings.iter().map(String::as_str);
    for (index, (name, column)) in named.zip(&table.columns).enumerate() {
        if name.is_empty() && column.is_none() {
            continue;
        }
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
            faults.fault(Code::Conflict, line, name, what, "remove one of them");
        }
        header.whole_gap |= states_whole_gaps(name);
        match factor(column, symbol) {
            Ok(factor) => header.factor[column] = factor,
            Err(wrong) => {
                let (what, remedy) = (wrong.message, &wrong.remedy);
                faults.fault(Code::InvalidValue, line, name, what, remedy);
            }
        }
    }
    if header.at[0].is_none() && !in_workbook {
        let what = "the run table has no column 'file'".to_owned();
        faults.fault(
            Code::Missing,
            line,
            "file",
            what,
            "add it: the names of the files, one per record",
        );
    }
    let complete = (header.at[FILE].is_some() || in_workbook) && states_setting(&table.columns);
    let missing = |column: usize| header.at[column].is_none();
    note_unknown(line, &unknown, &missing, complete, faults);
    header
}

/// Columns that are none of a run table, and no remarks: notes where the columns that are needed are there and nothing like
/// them is meant.
fn note_unknown(
    line: Option<usize>,
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
        faults.fault(Code::UnknownEntry, line, name, what, &remedy);
    }
    if !unused.is_empty() {
        let place = faults.place(line, "");
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

/// Whether a row has as many cells as there are headings; noted as a fault if not.
fn is_whole(row: &Line, columns: usize, faults: &mut FaultCollector) -> bool {
    let own = row.cells.len();
    if own != columns {
        let what = format!("the row has {own} cells, the header {columns}");
        faults.fault(Code::Syntax, Some(row.number), "", what, "fix the row");
    }
    own == columns
}

/// The decimal mark of all numbers of a table; `None`, with a fault, where both are in use.
fn decimal_mark(
    separator: u8,
    rows: &[&Line],
    header: &Header,
    faults: &mut FaultCollector,
) -> Option<char> {
    if separator == b',' {
        return Some('.');
    }
    let with = |mark: char| {
        let cells = rows.iter().flat_map(|row| {
            let columns = NUMBERS.iter().filter_map(|column| header.at[*column]);
            columns.filter_map(move |at| Some((row.number, row.cells.get(at)?)))
        });
        let mut cells = cells.filter(|(_, cell)| is_of_digits(cell));
        cells.find(|(_, cell)| cell.contains(mark))
    };
    match (with('.'), with(',')) {
        (Some((line, point)), Some((other, comma))) => {
            let what = format!(
                "'{point}' has a point and '{comma}' in line {other} a comma: which is the decimal mark?"
            );
            let remedy = "write one decimal mark in all numbers, and no mark between thousands";
            faults.fault(Code::InvalidValue, Some(line), "", what, remedy);
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
    let line = cells.row.number;
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
    let clearance_m = cells.number(CLEARANCE, bad);
    Some(Row {
        line,
        file,
        dataset: cells.text(1),
        record: cells.text(2),
        drive_frequency_hz: cells.number(3, bad),
        clearance_m,
        whole_gap: clearance_m.is_some() && cells.header.whole_gap,
        sweep: cells.word(5, bad),
        drive_amplitude: cells.number(6, bad),
        excitation: cells.word(7, bad),
        specimen: cells.text(8),
    })
}

/// The cells of a row.
struct Cells<'a> {
    row: &'a Line,
    header: &'a Header,
    /// The decimal mark of the table.
    mark: char,
    /// The workbook of which the table is a sheet.
    workbook: Option<&'a str>,
}

impl Cells<'_> {
    fn text(&self, column: usize) -> Option<String> {
        let cell = self.row.cells.get(self.header.at[column]?)?;
        (!cell.is_empty()).then(|| cell.to_owned())
    }

    fn number(&self, column: usize, bad: &mut BadCells) -> Option<f64> {
        let cell = self.text(column)?;
        match cell.replace(self.mark, ".").parse::<f64>() {
            Ok(value) if value.is_finite() => Some(value * self.header.factor[column]),
            _ => {
                bad.0[column].push((self.row.number, cell));
                None
            }
        }
    }

    fn word<T: FromStr>(&self, column: usize, bad: &mut BadCells) -> Option<T> {
        let cell = self.text(column)?;
        let found = in_english(&cell).parse().ok();
        if found.is_none() {
            bad.0[column].push((self.row.number, cell));
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
            let by_point = |text: &String| {
                let bare = text.trim_matches('\'').replace(',', ".");
                bare.trim().parse::<f64>().is_ok()
            };
            let remedy = if texts.iter().any(by_point) {
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
        let hioki =
            "File name,AUTO1.MEM\nCH1-1,Range\nTime,CH1-1[V]\n0.0,1.5\n0.1,1.4\n0.2,1.2\n0.3,1\n";
        for text in ["", "t;x\n0;1\n", "profile;my file\n", "1,2\n", hioki] {
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

    /// A run table may be made from a table of the report.
    #[test]
    fn headings_and_words_of_the_reports_own_tables_are_known() {
        for language in Language::all() {
            for (key, column) in [
                ("record", "record"),
                ("sweep", "sweep"),
                ("specimen", "specimen"),
                ("drive_frequency", "drive_frequency"),
                ("clearance", "clearance"),
            ] {
                let heading = language.text("phrase", key).replace('$', "");
                let known = column_of(&heading).map(|c| COLUMNS[c]);
                assert_eq!(known, Some(column), "{heading}");
            }
            for sweep in Sweep::VARIANTS {
                assert_eq!(in_english(language.text("sweep", sweep)), *sweep);
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
            text += &format!("r{k},\"8,{k}\",{k} Hz,quer\n");
        }
        let (_, faults) = read_text(text.as_bytes());
        assert_eq!(
            faults,
            [
                "drive_frequency: '0 Hz', '1 Hz', '2 Hz', '3 Hz', '4 Hz', '5 Hz', … are not numbers \
                 (in 8 lines: 2, 3, 4, 5, 6, 7, …). write a number; the unit belongs in the header",
                "clearance: '8,0', '8,1', '8,2', '8,3', '8,4', '8,5', … are not numbers (in 8 lines: \
                 2, 3, 4, 5, 6, 7, …). write a decimal point",
                "sweep: 'quer' is not one of up, down, unknown (in 8 lines: 2, 3, 4, 5, 6, 7, …). \
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
            assert_eq!(column_of(heading), Some(FREQUENCY), "{heading}");
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
        let text = "Datei;Frequenz [Hz];Spalt unten [mm]\na.csv;8,5;2\n";
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
    fn names_without_ending_are_found_in_a_folder_below() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("raw data")).unwrap();
        for name in ["raw data/test_1.csv", "raw data/test_2.csv"] {
            std::fs::write(at(name), "").unwrap();
        }
        for names in [
            ["test_1", "test_2"],
            ["raw data/test_1", "raw data/test_2.csv"],
        ] {
            let [one, other] = names;
            let text = format!(
                "Table 3: tests (J. Doe),,\nTest No.,Shaker frequency (Hz),Gap (mm)\n{one},5,2\n{other},6,2\n"
            );
            std::fs::write(at("t.csv"), &text).unwrap();
            assert!(is_run_table(
                text.as_bytes(),
                &is_file(folder.path(), "t.csv")
            ));
            let mut faults = FaultCollector::new(&at("t.csv"));
            let rows = read(folder.path(), "t.csv", &mut faults);
            let files: Vec<(usize, &str)> = rows
                .iter()
                .map(|row| (row.line, row.file.as_str()))
                .collect();
            assert_eq!(
                files,
                [(3, "raw data/test_1.csv"), (4, "raw data/test_2.csv")]
            );
            assert_eq!(rows[0].drive_frequency_hz, Some(5.0));
        }
    }

    #[test]
    fn headings_below_titles_and_their_line_are_found() {
        let text = "Messprotokoll Sto, M. M, 02.04.2026;;;\n;;;\nDatei;Erregerfrequenz [Hz];Spaltmaß;Durchlauf\na.lvm;10,92;0,4;aufwärts\n";
        let (rows, faults) = read_text(text.as_bytes());
        assert!(rows.is_empty());
        let what =
            "3: Spaltmaß: a clearance without unit. call it clearance_mm or \"clearance [mm]\"";
        assert_eq!(faults, [what]);
        let (rows, faults) = read_text(text.replace("aß;", "aß [mm];").as_bytes());
        assert_eq!(faults, [""; 0]);
        assert_eq!((rows[0].line, rows[0].sweep), (4, Some(Sweep::Up)));
    }

    #[test]
    fn the_sheet_of_a_fault_is_named() {
        let mut faults = FaultCollector::new(Path::new("s.xlsx"));
        faults.in_sheet("Overview");
        faults.fault(
            Code::InvalidValue,
            Some(5),
            "Gap",
            "a clearance without unit",
            "",
        );
        let said = faults.into_diagnostics().to_string();
        assert!(
            said.contains("s.xlsx:5: sheet Overview: Gap: a clearance"),
            "{said}"
        );
    }

    #[test]
    fn whole_gaps_are_told_by_their_heading() {
        for (heading, whole) in [
            ("gap_2r_mm", true),
            ("Spalt 2r [mm]", true),
            ("Spalt ges. [mm]", true),
            ("gap total (mm)", true),
            ("Total gap (mm)", true),
            ("gap_mm", false),
        ] {
            let (rows, faults) = read_text(format!("file,{heading}\na,2\n").as_bytes());
            assert_eq!(faults, [""; 0]);
            assert_eq!(
                (rows[0].clearance_m, rows[0].whole_gap),
                (Some(2e-3), whole),
                "{heading}"
            );
        }
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
        let table = Table::at_front("sheet\nrun 1\nrun 2\n", [&|_| false, &|_| false]);
        let said = |own: &str| {
            let mut faults = FaultCollector::new(Path::new("s.xlsx"));
            let none = names_none(&[own.to_owned()], &table, &mut faults);
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
