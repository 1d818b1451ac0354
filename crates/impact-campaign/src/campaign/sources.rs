//! The file of a campaign that was opened last, so that its next records need not open it again.

use std::fmt::{self, Debug, Formatter};
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::SystemTime;

use labfiles::{ReadError, Source};

/// Holds the file that was opened last; clones share it. It is no part of what a campaign is: all are equal.
#[derive(Clone, Default)]
pub struct Sources(Arc<Mutex<Option<Held>>>);

#[derive(Clone)]
struct Held {
    source: Arc<dyn Source>,
    /// Of the file as it was opened.
    state: FileState,
}

/// Length and time of the last change: another state is another file.
type FileState = Option<(u64, SystemTime)>;

fn state_of(path: &Path) -> FileState {
    let metadata = std::fs::metadata(path).ok()?;
    Some((metadata.len(), metadata.modified().ok()?))
}

impl Sources {
    /// The file, opened unless it was the last one and has not changed since.
    ///
    /// # Errors
    /// If the file cannot be read.
    pub fn open(&self, path: &Path) -> Result<Arc<dyn Source>, ReadError> {
        self.open_by(path, labfiles::open)
    }

    /// As [`Sources::open`], by another way of opening files.
    ///
    /// # Errors
    /// Those of `open`.
    pub(super) fn open_by(
        &self,
        path: &Path,
        open: impl FnOnce(&Path) -> Result<Box<dyn Source>, ReadError>,
    ) -> Result<Arc<dyn Source>, ReadError> {
        // before it is opened: what changes while it is read is another file
        let state = state_of(path);
        let held = self.0.lock().ok().and_then(|held| held.clone());
        let same = |held: &Held| held.source.path() == path && held.state == state;
        if let Some(held) = held.filter(|held| state.is_some() && same(held)) {
            return Ok(held.source);
        }
        let source: Arc<dyn Source> = Arc::from(open(path)?);
        if let Ok(mut held) = self.0.lock() {
            let source = Arc::clone(&source);
            *held = Some(Held { source, state });
        }
        Ok(source)
    }

    /// Close the file: its owner may write to it.
    pub fn close(&self) {
        drop(self.take());
    }

    /// As [`Sources::close`], without waiting for it: what is known of thousands of records takes a
    /// while to be freed.
    pub fn release(&self) {
        let held = self.take();
        rayon::spawn(move || drop(held));
    }

    fn take(&self) -> Option<Held> {
        self.0.lock().ok()?.take()
    }
}

impl PartialEq for Sources {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Debug for Sources {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("Sources")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_opened_again_only_where_it_has_changed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        std::fs::write(&path, "t [s],x [mm]\n0,1\n0.5,2\n1,3\n").unwrap();
        let sources = Sources::default();
        let first = sources.open(&path).unwrap();
        assert!(Arc::ptr_eq(&first, &sources.clone().open(&path).unwrap()));
        std::fs::write(&path, "t [s],x [mm]\n0,1\n0.5,2\n1,3\n1.5,4\n").unwrap();
        let longer = sources.open(&path).unwrap();
        assert!(!Arc::ptr_eq(&first, &longer));
        assert_eq!(longer.datasets()[0].channels[1].samples, 4);
        std::fs::remove_file(&path).unwrap();
        assert!(sources.open(&path).is_err());
    }
}
