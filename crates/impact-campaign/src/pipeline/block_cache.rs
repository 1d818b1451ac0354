//! Blocks of work saved while a long study runs, so that an interrupted one can be resumed: a
//! resumed study gives the same bytes as an uninterrupted one.

use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};

use crate::pipeline::gzip_json;
use crate::pipeline::inputs::hexadecimal;
use labfiles_write::output::{self, OutputError};

/// Folder of the blocks in the output folder; it is removed when the work is done.
const FOLDER: &str = ".impactid-blocks";

/// The blocks of one study.
#[derive(Debug)]
pub struct BlockCache {
    /// `None`: nothing is kept.
    folder: Option<PathBuf>,
    key: String,
}

#[derive(serde::Serialize, serde::Deserialize)]
struct Block<T> {
    key: String,
    content: T,
}

impl BlockCache {
    /// Keeps nothing: for work whose results are not written into a folder.
    pub fn none() -> Self {
        Self {
            folder: None,
            key: String::new(),
        }
    }

    /// The blocks in an output folder, of work that a text describes in full. Without `resume`
    /// the blocks of an earlier run are removed.
    ///
    /// # Errors
    /// Where the folder cannot be written into.
    pub fn open(out: &Path, work: &str, resume: bool) -> Result<Self, OutputError> {
        let mut hash = Sha256::new();
        hash.update(env!("CARGO_PKG_VERSION"));
        hash.update(format!(
            "{:?}",
            impact_oscillator::atlas::map::Kernel::of_this_machine()
        ));
        hash.update(work);
        Self::in_folder(out.join(FOLDER), hexadecimal(hash), resume)
    }

    /// The blocks in a folder of their own, of work with a key; see [`open`](Self::open).
    pub(super) fn in_folder(
        folder: PathBuf,
        key: String,
        resume: bool,
    ) -> Result<Self, OutputError> {
        let cache = Self {
            folder: Some(folder.clone()),
            key,
        };
        if !resume {
            cache.remove();
        }
        output::make_folder(&folder)?;
        output::clear_parts(&folder);
        Ok(cache)
    }

    /// A block; `None` where it is not there, of other work or unreadable.
    pub fn load<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        let block: Block<T> = gzip_json::read(&self.path(name)?).ok()?;
        (block.key == self.key).then_some(block.content)
    }

    /// Keep a block.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn save<T: Serialize>(&self, name: &str, content: &T) -> Result<(), OutputError> {
        let Some(path) = self.path(name) else {
            return Ok(());
        };
        let block = Block {
            key: self.key.clone(),
            content,
        };
        gzip_json::write(&path, &block)
    }

    /// A block of an earlier run, or one that is computed and saved now.
    ///
    /// # Errors
    /// Those of the computation, or where the block cannot be written.
    pub fn block<T: Serialize + DeserializeOwned, E: From<OutputError>>(
        &self,
        name: &str,
        compute: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        if let Some(found) = self.load(name) {
            return Ok(found);
        }
        let content = compute()?;
        self.save(name, &content)?;
        Ok(content)
    }

    /// Remove all blocks: the work is done.
    pub fn remove(&self) {
        if let Some(folder) = &self.folder {
            // a block that cannot be removed does no harm: blocks are reused by their key alone
            let _ = std::fs::remove_dir_all(folder);
        }
    }

    fn path(&self, name: &str) -> Option<PathBuf> {
        let safe: String = name
            .chars()
            .map(|c| if c.is_alphanumeric() { c } else { '_' })
            .collect();
        Some(self.folder.as_ref()?.join(format!("{safe}.json.gz")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_reused_by_the_same_work_alone() {
        let folder = tempfile::tempdir().unwrap();
        let cache = BlockCache::open(folder.path(), "work", false).unwrap();
        cache.save("rows 0", &vec![0.1, 0.2]).unwrap();
        let again = BlockCache::open(folder.path(), "work", true).unwrap();
        assert_eq!(again.load("rows 0"), Some(vec![0.1, 0.2]));
        let other = BlockCache::open(folder.path(), "other work", true).unwrap();
        assert_eq!(other.load::<Vec<f64>>("rows 0"), None);
        let anew = BlockCache::open(folder.path(), "work", false).unwrap();
        assert_eq!(anew.load::<Vec<f64>>("rows 0"), None);
    }
}
