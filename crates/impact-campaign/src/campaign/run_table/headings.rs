//! The headings of run tables: which column each is, by its words or by what its cells name.

use std::collections::BTreeMap;

use impact_records::language::{Language, RunTableWords};
use labfiles::units;

use super::text::Line;

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
/// The column of clearances.
pub(super) const CLEARANCE: usize = 4;
/// The columns of settings, of which a run table in a workbook states one.
const SETTINGS: [usize; 2] = [FREQUENCY, CLEARANCE];

/// What the cells of a column without a known heading may name: files, and datasets.
pub(super) type IsNamed<'a> = [&'a dyn Fn(&str) -> bool; 2];

/// A word as it is compared: in small letters, but for symbols (`f` is a frequency, `F` a force), and with one blank between
/// its parts.
fn compared(word: &str) -> String {
    let parts = word.split(|c: char| c == '_' || c.is_whitespace());
    let parts: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
    let word = parts.join(" ");
    match word.chars().count() {
        1 => word,
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
    let found = each.find(|(name, others)| others.contains(&word) || compared(name) == word);
    found.map(|(name, _)| name.as_str())
}

/// A word of a cell as this program writes it.
pub(in super::super) fn in_english(word: &str) -> String {
    let known = called(word, |table| &table.words);
    known.map_or_else(|| word.trim().to_lowercase(), str::to_owned)
}

/// The column of a heading, with its unit or without, in small letters or capitals.
pub(super) fn column_of(heading: &str) -> Option<usize> {
    let place = |word: &str, name: &str| {
        *name == compared(word) || Some(name) == called(word, |table| &table.columns)
    };
    let of = |bare: &str| {
        COLUMNS
            .iter()
            .position(|name| place(bare, name))
            .or_else(|| is_whole_gap(bare).then_some(CLEARANCE))
    };
    of(heading).or_else(|| of(units::split_unit(heading).0))
}

/// Whether a heading without its unit is that of whole gaps between two masses: `gap 2r`.
pub(super) fn is_whole_gap(bare: &str) -> bool {
    let word = compared(bare);
    Language::all().any(|language| language.run_table().whole_gaps.contains(&word))
}

/// Whether an attribute's name says so, with its unit or without and behind the structs that hold it.
pub(in super::super) fn states_whole_gaps(name: &str) -> bool {
    let field = name.rsplit('.').next().unwrap_or(name);
    // a full stop ends an abbreviation too
    [name, field]
        .map(|words| units::split_unit(words).0)
        .into_iter()
        .any(is_whole_gap)
}

/// The headings of which a row is the next one: it names columns that the rows above do not name, or their units, and
/// nothing else that is known.
pub(super) fn continued(above: &[String], row: &csv::StringRecord) -> Option<Vec<String>> {
    let count = above.len().max(row.len());
    let mut counts = false;
    let mut both = Vec::with_capacity(count);
    for index in 0..count {
        let upper = above.get(index).map_or("", String::as_str);
        let cell = row.get(index).unwrap_or("");
        let known = column_of(upper);
        let unit = unit_in(cell).filter(|_| units::split_unit(upper).1.is_none());
        both.push(match (known, unit) {
            _ if EMPTY.contains(&cell) => upper.to_owned(),
            (None, _) if column_of(cell).is_some() => {
                counts = true;
                cell.to_owned()
            }
            (Some(column), Some(unit)) if NUMBERS.contains(&column) => {
                counts = true;
                format!("{upper} [{unit}]")
            }
            (None, Some(unit)) if !upper.is_empty() => format!("{upper} [{unit}]"),
            (None, None) if !cell.contains(|c: char| c.is_ascii_digit()) => cell.to_owned(),
            _ => return None,
        });
    }
    counts.then_some(both)
}

/// Cells that say nothing.
const EMPTY: [&str; 4] = ["", "-", "–", "—"];

/// The unit that a cell is, also in brackets.
fn unit_in(cell: &str) -> Option<&str> {
    let bare = cell.trim_matches(['[', ']', '(', ')']).trim();
    let unit = units::parse_unit(bare)?;
    let starts = bare.starts_with(|c: char| !c.is_ascii_digit());
    (starts && (unit.dimension != units::Dimension::Number || bare == "%")).then_some(bare)
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

/// The columns that hold numbers.
pub(super) const NUMBERS: [usize; 3] = [FREQUENCY, CLEARANCE, 6];

/// The column of each heading: by its words, and where none is that of files or of datasets, the first whose cells all
/// are names of such.
pub(super) fn columns_of(
    headings: &[String],
    rows: &[Line],
    is_named: IsNamed<'_>,
) -> Vec<Option<usize>> {
    let mut columns: Vec<Option<usize>> = headings.iter().map(|h| column_of(h)).collect();
    let [is_file, is_dataset] = is_named;
    for (column, is_named) in [(DATASET, is_dataset), (FILE, is_file)] {
        if columns.contains(&Some(column)) {
            continue;
        }
        let names_all = |index: &usize| {
            // a column of words may be called as another one
            let counts = |known: usize| known == DATASET || NUMBERS.contains(&known);
            if columns[*index].is_some_and(counts) {
                return false;
            }
            let cells = rows.iter().filter_map(|row| row.cells.get(*index));
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
