//! Where the files of a run table are, beside where its rows say.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Correct the names of files that are not below the campaign's folder as they stand.
pub(super) fn find(folder: &Path, table: &str, files: &mut [&mut String]) {
    for file in &mut *files {
        if let Some(moved) = beside(folder, table, file) {
            **file = moved;
        }
    }
    complete_names(folder, files);
    if let Some(below) = subfolder(folder, files) {
        for file in files {
            **file = format!("{below}/{file}");
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
fn complete_names(folder: &Path, files: &mut [&mut String]) {
    let lacks = |file: &&mut &mut String| {
        Path::new(&***file).extension().is_none() && !folder.join(&***file).exists()
    };
    let mut lacking = files.iter_mut().filter(lacks).peekable();
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
    for file in lacking {
        if let Some([name]) = named.get(&**file).map(Vec::as_slice) {
            **file = name.clone();
        }
    }
}

/// The folder below the campaign's in which the files of a run table are, where none of them is where the table says and they
/// are in no other one.
fn subfolder(folder: &Path, files: &[&mut String]) -> Option<String> {
    if files.iter().any(|file| folder.join(&**file).exists()) {
        return None;
    }
    let holds = |below: &PathBuf| files.iter().any(|file| below.join(&**file).is_file());
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
