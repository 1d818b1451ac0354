//! Which sheet of a workbook is a run table.

use std::path::Path;

use super::files::is_file;
use super::headings::{DATASET, FILE, FREQUENCY, IsNamed, words_of, words_of_settings};
use super::table::{FIRST_ROWS, Table};
use super::text::decode;

/// What separates the cells of a sheet's text.
pub(super) const SEPARATOR: u8 = b'\t';
/// A sheet of a workbook that is a run table.
#[derive(Debug)]
pub(in super::super) struct Sheet {
    /// Its name.
    pub(in super::super) name: String,
    /// Its headings and rows.
    pub(super) table: Table,
    /// The names of all sheets of the workbook.
    pub(super) sheets: Vec<String>,
    /// Whether its rows name files, or at least one sheet of its workbook.
    pub(in super::super) names_records: bool,
    /// Whether it has drive frequencies.
    pub(in super::super) states_drive: bool,
}

/// The sheet that is the run table `name` of a folder, if the file is a workbook with one.
pub(in super::super) fn sheet_of(folder: &Path, name: &str) -> Option<Sheet> {
    let tables = labfiles::workbook_tables(&folder.join(name)).ok()??;
    among(tables, &is_file(folder, name))
}

/// The first sheet that is a run table.
pub(super) fn among(
    tables: Vec<(String, Vec<u8>)>,
    is_file: &dyn Fn(&str) -> bool,
) -> Option<Sheet> {
    let sheets: Vec<String> = tables.iter().map(|(name, _)| name.clone()).collect();
    tables.into_iter().find_map(|(name, bytes)| {
        let is_sheet = |cell: &str| sheets.iter().any(|sheet| sheet == cell);
        let names_rows =
            |table: &Table| [FILE, DATASET].iter().any(|c| table.position(*c).is_some());
        let is_named: IsNamed<'_> = [is_file, &is_sheet];
        let table = Table::find(&decode(&bytes), Some(SEPARATOR), is_named, names_rows)?;
        let names_sheet = table.cells(DATASET).any(|cell| holds(&sheets, cell));
        Some(Sheet {
            name,
            names_records: table.position(FILE).is_some() || names_sheet,
            states_drive: table.position(FREQUENCY).is_some(),
            sheets: sheets.clone(),
            table,
        })
    })
}

/// Whether a dataset is one of a workbook's sheets, or of the tables in one.
pub(super) fn holds(sheets: &[String], dataset: &str) -> bool {
    let bare = dataset.trim_start_matches('/');
    sheets.iter().any(|sheet| bare.starts_with(sheet.as_str()))
}

/// That a workbook has no run table.
pub(super) fn none_found() -> String {
    format!(
        "no sheet of the workbook is a run table: none has, in one of its first {FIRST_ROWS} rows, the headings {} and {}",
        words_of(DATASET),
        words_of_settings()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(sheets: &[(&str, &str)]) -> Option<Sheet> {
        let bytes = |(name, text): &(&str, &str)| ((*name).to_owned(), text.as_bytes().to_vec());
        among(sheets.iter().map(bytes).collect(), &|_| false)
    }

    const RECORD: (&str, &str) = ("run 1", "t [s]\tv [m/s]\n0\t1\n1\t2\n");

    #[test]
    fn headings_of_a_sheet_may_be_below_titles() {
        let text = "Settings, May\t\t\n\t\t\nsheet\tfrequency [Hz]\tgap [mm]\nrun 1\t8\t2\n";
        let found = of(&[RECORD, ("Settings", text)]).unwrap();
        assert_eq!(
            (found.name.as_str(), found.names_records),
            ("Settings", true)
        );
        assert_eq!(found.table.headings[0], "sheet");
        assert_eq!((found.table.line, found.table.rows[0].number), (3, 4));
        assert!(of(&[RECORD]).is_none());
        assert!(
            none_found().contains("'dataset' (or 'sheet', "),
            "{}",
            none_found()
        );
    }

    #[test]
    fn a_column_whose_cells_are_names_of_sheets_is_that_of_datasets() {
        let text = "run\tgap [mm]\nrun 1\t2\n\t\n";
        assert!(of(&[RECORD, ("S", text)]).unwrap().names_records);
        let other = "run\tgap [mm]\nrun 7\t2\n";
        assert!(of(&[RECORD, ("S", other)]).is_none());
    }

    #[test]
    fn a_sheet_that_names_datasets_of_other_workbooks_names_no_records() {
        let text = "sheet\tgap [mm]\nrun 1\t2\n";
        assert!(!of(&[("S", text)]).unwrap().names_records);
        let named = "file\tsheet\tgap [mm]\nrecs.xlsx\trun 1\t2\n";
        assert!(of(&[("S", named)]).unwrap().names_records);
    }
}
