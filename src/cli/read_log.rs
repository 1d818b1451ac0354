//! Which files were read, for `-v`, and what their readers noted, for `-vv`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::Verbosity;
use labfiles::{ReadError, Source};

/// Opens files and keeps a line of each while details are asked for.
#[derive(Debug)]
pub(super) struct ReadLog {
    verbosity: Verbosity,
    files: Mutex<BTreeMap<PathBuf, Entry>>,
}

#[derive(Debug)]
struct Entry {
    format: &'static str,
    datasets: usize,
    notes: Vec<String>,
}

impl ReadLog {
    pub(super) fn new(verbosity: Verbosity) -> Self {
        let files = Mutex::default();
        Self { verbosity, files }
    }

    /// Open a file of any supported format.
    ///
    /// # Errors
    /// As [`labfiles::open`].
    pub(super) fn open(&self, path: &Path) -> Result<Box<dyn Source>, ReadError> {
        let source = labfiles::open(path)?;
        if self.verbosity.is_detailed() {
            let entry = Entry {
                format: source.format(),
                datasets: source.datasets().len(),
                notes: source.notes().to_vec(),
            };
            let mut files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
            files.insert(path.to_path_buf(), entry);
        }
        Ok(source)
    }

    /// Print the files: with `-v` a line per folder and format, with `-vv` one per file.
    pub(super) fn print(&self) {
        let files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        if self.verbosity.is_everything() {
            for (path, entry) in files.iter() {
                let path = path.display();
                let line = format!("{path}: {}, datasets: {}", entry.format, entry.datasets);
                self.verbosity.everything(&line);
                for note in &entry.notes {
                    self.verbosity.everything(&format!("{path}: note: {note}"));
                }
            }
            return;
        }
        let mut folders: BTreeMap<(&Path, &str), (usize, usize)> = BTreeMap::new();
        for (path, entry) in files.iter() {
            let folder = path.parent().unwrap_or(Path::new(""));
            let counts = folders.entry((folder, entry.format)).or_default();
            *counts = (counts.0 + 1, counts.1 + entry.datasets);
        }
        for ((folder, format), (files, datasets)) in folders {
            let folder = if folder.as_os_str().is_empty() {
                Path::new(".")
            } else {
                folder
            };
            let folder = folder.display();
            self.verbosity.detail(&format!(
                "{folder}: {format}, files: {files}, datasets: {datasets}"
            ));
        }
    }
}
