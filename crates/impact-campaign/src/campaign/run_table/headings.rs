//! The headings of run tables: which column each is, by its words or by what its cells name.

use std::collections::BTreeMap;

use impact_records::language::{Language, RunTableWords};
use labfiles::units;

/// The columns that a run table may have.
pub(super) const COLUMNS: [&str; 9] = [
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

/// The column of files.
pub(super) const FILE: usize = 0;
/// The column of datasets.
pub(super) const DATASET: usize = 1;
/// The column of drive frequencies.
pub(super) const FREQUENCY: usize = 3;
/// The columns of settings, of which a run table in a workbook states one.
const SETTINGS: [usize; 2] = [FREQUENCY, 4];

/// A word as it is compared: in small letters, but for symbols (`f` is a frequency, `F` a force).
fn compared(word: &str) -> String {
    let word = word.trim();
    match word.chars().count() {
        1 => word.to_owned(),
        _ => word.to_lowercase(),
    }
}

/// What a word of any language is called in this program.
fn called<'a>(
    word: &str,
    of: impl Fn(&'static RunTableWords) -> &'static BTreeMap<String, Vec<String>> + 'a,
) -> Option<&'static str> {
    let word = compared(word);
    let mut each = Language::all().flat_map(|language| of(language.run_table()));
    let found = each.find(|(_, others)| others.contains(&word));
    found.map(|(name, _)| name.as_str())
}

/// A word of a cell as this program writes it.
pub(in super::super) fn in_english(word: &str) -> String {
    let known = called(word, |table| &table.words);
    known.map_or_else(|| word.trim().to_lowercase(), str::to_owned)
}

/// The column of a heading, with its unit or without, in small letters or capitals.
pub(super) fn column_of(heading: &str) -> Option<usize> {
    let place = |name: &str| COLUMNS.iter().position(|c| *c == name);
    let of = |bare: &str| {
        place(&compared(bare)).or_else(|| place(called(bare, |table| &table.columns)?))
    };
    of(heading).or_else(|| of(units::split_unit(heading).0))
}

/// The name of the column that a heading means.
pub(in super::super) fn column_name(heading: &str) -> Option<&'static str> {
    column_of(heading).map(|column| COLUMNS[column])
}

/// The column of a setting with whose word a heading begins: `Spalt 2r`, `gap width`.
pub(super) fn begun_with(heading: &str) -> Option<usize> {
    let first = heading.split(|c: char| !c.is_alphanumeric()).next()?;
    let column = (first.chars().count() > 1).then(|| column_of(first))??;
    SETTINGS.contains(&column).then_some(column)
}

/// The column of each heading: by its words, and where none is that of files or of datasets, the first whose cells all
/// are names of such.
pub(super) fn columns_of(
    headings: &csv::StringRecord,
    rows: &[csv::StringRecord],
    is_named: [&dyn Fn(&str) -> bool; 2],
) -> Vec<Option<usize>> {
    let mut columns: Vec<Option<usize>> = headings.iter().map(column_of).collect();
    for (column, is_named) in [FILE, DATASET].into_iter().zip(is_named) {
        if columns.contains(&Some(column)) {
            continue;
        }
        let names_all = |index: &usize| {
            let cells = rows.iter().filter_map(|row| row.get(*index));
            let mut cells = cells.filter(|cell| !cell.is_empty()).peekable();
            cells.peek().is_some() && cells.all(is_named)
        };
        if let Some(index) = (0..headings.len()).find(names_all) {
            columns[index] = Some(column);
        }
    }
    columns
}

/// Whether a clearance or a drive frequency is among columns.
pub(super) fn states_setting(columns: &[Option<usize>]) -> bool {
    SETTINGS.iter().any(|c| columns.contains(&Some(*c)))
}

/// A column's name and its words in all languages, for messages.
pub(super) fn words_of(column: usize) -> String {
    let name = COLUMNS[column];
    let others = Language::all().filter_map(|language| language.run_table().columns.get(name));
    let others: Vec<String> = others.flatten().map(|word| format!("'{word}'")).collect();
    format!("'{name}' (or {})", others.join(", "))
}

/// The words of the columns of settings.
pub(super) fn words_of_settings() -> String {
    SETTINGS.map(words_of).join(" or ")
}
