//! Where the files of a run table are, beside where its rows say.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::Row;

/// Correct the names of files that are not below the campaign's folder as they stand.
pub(super) fn find(folder: &Path, table: &str, rows: &mut [Row]) {
    for row in &mut *rows {
        row.file = beside(folder, table, &row.file).unwrap_or_else(|| row.file.clone());
    }
    complete_names(folder, rows);
    if let Some(below) = subfolder(folder, rows) {
        for row in rows {
            row.file = format!("{below}/{}", row.file);
        }
    }
}

/// The path of a file that is not in the campaign's folder but in that of the run table, below the campaign's.
fn beside(folder: &Path, table: &str, file: &str) -> Option<String> {
    let below = Path::new(table).parent()?.join(file);
    let moved = !folder.join(file).exists() && folder.join(&below).exists();
    moved.then(|| below.to_string_lossy().into_owned())
}

/// Names without an ending become those of the one file that has the name before its ending.
fn complete_names(folder: &Path, rows: &mut [Row]) {
    let lacks = |row: &&mut Row| {
        Path::new(&row.file).extension().is_none() && !folder.join(&row.file).exists()
    };
    let mut lacking = rows.iter_mut().filter(lacks).peekable();
    if lacking.peek().is_none() {
        return;
    }
    let mut named: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for path in entries(folder) {
        let text = |part: Option<&OsStr>| part.and_then(OsStr::to_str).map(str::to_owned);
        if let (Some(stem), Some(name)) = (text(path.file_stem()), text(path.file_name())) {
            named.entry(stem).or_default().push(name);
        }
    }
    for row in lacking {
        if let Some([name]) = named.get(&row.file).map(Vec::as_slice) {
            row.file = name.clone();
        }
    }
}

/// The folder below the campaign's in which the files of a run table are, where none of them is where the table says and they
/// are in no other one.
fn subfolder(folder: &Path, rows: &[Row]) -> Option<String> {
    if rows.iter().any(|row| folder.join(&row.file).exists()) {
        return None;
    }
    let holds = |below: &PathBuf| rows.iter().any(|row| below.join(&row.file).is_file());
    let mut found = entries(folder).filter(holds);
    let first = found.next()?.file_name()?.to_str()?.to_owned();
    found.next().is_none().then_some(first)
}

/// What is in a folder; `""` is the working directory.
fn entries(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = Path::new(".").join(folder).read_dir();
    let entries = entries.into_iter().flatten();
    entries.filter_map(|entry| Some(entry.ok()?.path()))
}
