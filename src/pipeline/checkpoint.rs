//! Checkpoints of the observations of a long run, so that an interrupted run can be resumed.
//!
//! The records are observed in chunks; each chunk's observations are written as a whole under a
//! key of everything they depend on: the program's version, the resolved campaign, and length
//! and time of change of every file. A chunk with another key, or one that cannot be read, is
//! observed again, so a resumed run gives the same bytes as an uninterrupted one.

use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use sha2::{Digest, Sha256};

use crate::campaign::resolved::ResolvedCampaign;
use crate::motion::Observation;
use crate::pipeline::gzip_json;
use crate::pipeline::inputs::hexadecimal;
use labfiles::output::{self, OutputError};

/// Folder of the chunks in the output folder; it is removed when the run is done.
const FOLDER: &str = ".impactid-observed";

/// Campaigns of fewer records are faster to observe again than to save: the default of
/// [`Destination::keep_from`](crate::pipeline::Destination::keep_from).
pub const FEWEST: usize = 2000;

/// Records per chunk for a campaign of `records`: a sixteenth, so that little is lost, but enough
/// that saving takes no time.
pub fn chunk_of(records: usize) -> usize {
    (records / 16).clamp(8, 512)
}

/// The chunks of one run in its output folder.
#[derive(Debug)]
pub struct Checkpoint {
    folder: PathBuf,
    key: String,
}

/// A chunk as it is stored.
#[derive(serde::Serialize, serde::Deserialize)]
struct Chunk<T> {
    key: String,
    observations: T,
}

impl Checkpoint {
    /// The chunks in an output folder. Without `resume` those of an earlier run are removed.
    ///
    /// # Errors
    /// If the folder cannot be written into.
    pub fn open(
        campaign: &ResolvedCampaign,
        out: &Path,
        resume: bool,
    ) -> Result<Self, OutputError> {
        let checkpoint = Self {
            folder: out.join(FOLDER),
            key: key(campaign),
        };
        if !resume {
            remove(out);
        }
        output::make_folder(&checkpoint.folder)?;
        output::clear_parts(&checkpoint.folder);
        Ok(checkpoint)
    }

    fn path(&self, number: usize) -> PathBuf {
        self.folder.join(format!("{number:06}.json.gz"))
    }

    /// The observations of a chunk; `None` if it is missing, of another run or unreadable.
    pub fn load(&self, number: usize, records: usize) -> Option<Vec<Observation>> {
        let chunk: Chunk<Vec<Observation>> = gzip_json::read(&self.path(number)).ok()?;
        (chunk.key == self.key && chunk.observations.len() == records).then_some(chunk.observations)
    }

    /// Save the observations of a chunk.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn save(&self, number: usize, observations: &[Observation]) -> Result<(), OutputError> {
        let chunk = Chunk {
            key: self.key.clone(),
            observations,
        };
        gzip_json::write(&self.path(number), &chunk)
    }
}

/// Remove all chunks in an output folder: the run is done.
pub fn remove(out: &Path) {
    // a chunk that cannot be removed is harmless: it is loaded only if its key matches
    let _ = std::fs::remove_dir_all(out.join(FOLDER));
}

/// Version of the layout of saved observations; another one is not loaded.
const LAYOUT: u32 = 3;

/// A hash of everything that observations depend on.
fn key(campaign: &ResolvedCampaign) -> String {
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    hash.update(LAYOUT.to_le_bytes());
    hash.update(format!("{campaign:?}"));
    let mut files: Vec<&PathBuf> = campaign.records.iter().map(|r| &r.file).collect();
    files.sort();
    files.dedup();
    for file in files {
        hash.update(file.to_string_lossy().as_bytes());
        hash.update(state(file).as_bytes());
    }
    hexadecimal(hash)
}

/// Length and time of the last change of a file.
fn state(file: &Path) -> String {
    let Ok(metadata) = std::fs::metadata(file) else {
        return "missing".to_owned();
    };
    let changed = metadata
        .modified()
        .ok()
        .and_then(|t| t.duration_since(UNIX_EPOCH).ok());
    format!("{} {:?}", metadata.len(), changed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::observe::{observe_all, observe_in_chunks};
    use crate::pipeline::synthesise::{Recipe, write_campaign};
    use crate::synthetic::Truth;
    use labfiles::open;

    #[test]
    fn a_resumed_observation_is_that_of_an_uninterrupted_run() {
        let folder = tempfile::tempdir().unwrap();
        let recipe = Recipe {
            truth: Truth::symmetric(0.9, 12.6, 0.07, 1e-3),
            faults: crate::synthetic::Faults::default(),
            rig: crate::synthetic::RigSpec::exact(),
            records: 12,
            seed: 5,
            rig_seed: None,
        };
        write_campaign(&recipe, folder.path()).unwrap();
        let toml = folder.path().join("campaign.toml");
        let campaign = crate::campaign::load(&toml, &open).campaign.unwrap();
        let quiet = |_: &'static str, _: u64, _: u64| {};
        let whole = observe_all(&campaign, &quiet);

        let out = folder.path().join("out");
        let kept = Checkpoint::open(&campaign, &out, false).unwrap();
        let first = observe_in_chunks(&campaign, &kept, 5, &quiet).unwrap();
        assert_eq!(json(&whole), json(&first));
        // interrupted: one chunk was not yet written, one is damaged
        std::fs::remove_file(kept.path(1)).unwrap();
        std::fs::write(kept.path(2), b"half").unwrap();
        let kept = Checkpoint::open(&campaign, &out, true).unwrap();
        assert!(kept.load(0, 5).is_some() && kept.load(2, 2).is_none());
        let resumed = observe_in_chunks(&campaign, &kept, 5, &quiet).unwrap();
        assert_eq!(json(&whole), json(&resumed));

        // another campaign loads nothing
        let mut other = campaign.clone();
        other.analysis.skip_s = 0.1;
        let kept = Checkpoint::open(&other, &out, true).unwrap();
        assert!(kept.load(0, 5).is_none());
    }

    fn json(observations: &[Observation]) -> String {
        serde_json::to_string(observations).unwrap()
    }
}
