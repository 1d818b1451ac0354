//! Where the files of a run table are, beside where its rows say.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Whether a cell of a run table names a file: of a folder, beside the table, whose path may start there, or of a folder
/// below.
pub(in super::super) fn is_file(folder: &Path, table: impl AsRef<Path>) -> impl Fn(&str) -> bool {
    let folder = folder.to_path_buf();
    let beside = folder.join(table).parent().map(Path::to_path_buf);
    let listed = RefCell::new(Listed::default());
    move |cell| {
        let mut listed = listed.borrow_mut();
        let mut is_in = |place: &Path| listed.called(place, cell).is_some();
        is_in(&folder)
            || beside.as_deref().is_some_and(&mut is_in)
            || folders_in(&folder).any(|below| is_in(&below))
    }
}

/// Correct the names of files that are not below the campaign's folder as they stand.
pub(super) fn find(folder: &Path, table: &str, files: &mut [&mut String]) {
    let mut listed = Listed::default();
    let beside = Path::new(table).parent().unwrap_or(Path::new(""));
    let mut any = false;
    for file in &mut *files {
        let mut in_place = |place: &Path| {
            let name = listed.called(&folder.join(place), file)?;
            Some(place.join(name).to_string_lossy().into_owned())
        };
        if let Some(found) = in_place(Path::new("")).or_else(|| in_place(beside)) {
            **file = found;
            any = true;
        }
    }
    let below = (!any).then(|| subfolder(folder, files, &mut listed));
    if let Some(below) = below.flatten() {
        for file in files {
            let name = listed.called(&folder.join(&below), file);
            **file = format!("{below}/{}", name.as_ref().unwrap_or(file));
        }
    }
}

/// The folder below the campaign's in which the files of a run table are, where they are in no other one.
fn subfolder(folder: &Path, files: &[&mut String], listed: &mut Listed) -> Option<String> {
    let mut holds = |below: &PathBuf| {
        let mut files = files.iter();
        files.any(|file| listed.called(below, file).is_some())
    };
    let mut found = folders_in(folder).filter(&mut holds);
    let first = found.next()?.file_name()?.to_str()?.to_owned();
    found.next().is_none().then_some(first)
}

/// The files of folders by their names without ending, each folder read once.
#[derive(Debug, Default)]
struct Listed(BTreeMap<PathBuf, BTreeMap<String, Vec<String>>>);

impl Listed {
    /// What a folder has under a name: that path, or where the name lacks its ending that of the one file that has it.
    fn called(&mut self, folder: &Path, name: &str) -> Option<String> {
        let path = folder.join(name);
        if path.exists() {
            return Some(name.to_owned());
        }
        let (of, stem) = (path.parent()?, path.file_name()?.to_str()?);
        if path.extension().is_some() {
            return None;
        }
        let named = self
            .0
            .entry(of.to_path_buf())
            .or_insert_with(|| by_stem(of));
        match named.get(stem)?.as_slice() {
            [one] => Some(
                Path::new(name)
                    .with_file_name(one)
                    .to_string_lossy()
                    .into_owned(),
            ),
            _ => None,
        }
    }
}

/// The names of a folder's files by what is before their ending.
fn by_stem(folder: &Path) -> BTreeMap<String, Vec<String>> {
    let mut named: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for path in entries(folder) {
        let text = |part: Option<&OsStr>| part.and_then(OsStr::to_str).map(str::to_owned);
        if let (Some(stem), Some(name)) = (text(path.file_stem()), text(path.file_name())) {
            named.entry(stem).or_default().push(name);
        }
    }
    named
}

/// The folders in one.
fn folders_in(folder: &Path) -> impl Iterator<Item = PathBuf> {
    entries(folder).filter(|path| path.is_dir())
}

/// What is in a folder; `""` is the working directory.
fn entries(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = Path::new(".").join(folder).read_dir();
    let entries = entries.into_iter().flatten();
    entries.filter_map(|entry| Some(entry.ok()?.path()))
}
