//! What taken files hold, kept so that each is opened once to be listed.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use labfiles::{DatasetInfo, ReadError, Samples, Source};

/// The metadata of files as they were when they were taken.
#[derive(Debug, Default)]
pub(super) struct Listings(HashMap<PathBuf, Arc<Listed>>);

#[derive(Debug)]
struct Listed {
    path: PathBuf,
    format: &'static str,
    datasets: Vec<DatasetInfo>,
    notes: Vec<String>,
}

impl Listings {
    /// Open a file and keep what it holds.
    ///
    /// # Errors
    /// Where it cannot be opened, or holds nothing yet.
    pub(super) fn take(&mut self, path: &Path) -> Result<(), ReadError> {
        let source = labfiles::open_growing(path)?;
        if source.datasets().is_empty() {
            return Err(ReadError::new(
                path,
                "a dataset",
                "none",
                "wait until it is written, or remove the file",
            ));
        }
        let listed = Listed {
            path: path.to_path_buf(),
            format: source.format(),
            datasets: source.datasets().to_vec(),
            notes: source.notes().to_vec(),
        };
        self.0.insert(path.to_path_buf(), Arc::new(listed));
        Ok(())
    }

    /// A taken file as it was then, for a list of records; another file is opened.
    ///
    /// # Errors
    /// Those of opening it.
    pub(super) fn open(&self, path: &Path) -> Result<Box<dyn Source>, ReadError> {
        match self.0.get(path) {
            Some(listed) => Ok(Box::new(Handle(Arc::clone(listed)))),
            None => labfiles::open_growing(path),
        }
    }

    /// Forget the files that are no longer there.
    pub(super) fn keep(&mut self, taken: impl Fn(&Path) -> bool) {
        self.0.retain(|path, _| taken(path));
    }
}

/// A taken file; its samples are read from the file as it is now.
struct Handle(Arc<Listed>);

impl Source for Handle {
    fn format(&self) -> &'static str {
        self.0.format
    }

    fn path(&self) -> &Path {
        &self.0.path
    }

    fn datasets(&self) -> &[DatasetInfo] {
        &self.0.datasets
    }

    fn notes(&self) -> &[String] {
        &self.0.notes
    }

    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        labfiles::open_growing(&self.0.path)?.read(dataset, channels)
    }
}
