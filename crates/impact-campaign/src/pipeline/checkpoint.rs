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
use crate::pipeline::block_cache::BlockCache;
use crate::pipeline::inputs::hexadecimal;
use labfiles_write::output::OutputError;

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

/// The chunks in an output folder. Without `resume` those of an earlier run are removed.
///
/// # Errors
/// If the folder cannot be written into.
pub fn open(
    campaign: &ResolvedCampaign,
    out: &Path,
    resume: bool,
) -> Result<BlockCache, OutputError> {
    BlockCache::in_folder(out.join(FOLDER), key(campaign), resume)
}

/// Remove all chunks in an output folder: the run is done.
pub fn remove(out: &Path) {
    // a chunk that cannot be removed is harmless: it is loaded only if its key matches
    let _ = std::fs::remove_dir_all(out.join(FOLDER));
}

/// Version of the layout of saved observations; another one is not loaded.
const LAYOUT: u32 = 4;

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
    use crate::pipeline::observe::observe_in_chunks;
    use crate::pipeline::synthesise::{Recipe, write_campaign};
    use impact_records::motion::Observation;
    use simulated_rig::Truth;

    #[test]
    fn a_resumed_observation_is_that_of_an_uninterrupted_run() {
        let folder = tempfile::tempdir().unwrap();
        let recipe = Recipe {
            truth: Truth::symmetric(0.9, 12.6, 0.07, 1e-3),
            faults: simulated_rig::Faults::default(),
            rig: simulated_rig::RigSpec::exact(),
            records: 12,
            beats: false,
            seed: 5,
            rig_seed: None,
        };
        write_campaign(&recipe, folder.path()).unwrap();
        let toml = folder.path().join("campaign.toml");
        let campaign = crate::campaign::load(&toml, &labfiles::open)
            .campaign
            .unwrap();
        let quiet = |_: &'static str, _: u64, _: u64| {};
        let whole = observe_in_chunks(&campaign, &BlockCache::none(), 12, &quiet).unwrap();

        let out = folder.path().join("out");
        let kept = open(&campaign, &out, false).unwrap();
        let first = observe_in_chunks(&campaign, &kept, 5, &quiet).unwrap();
        assert_eq!(json(&whole), json(&first));
        // interrupted: one chunk was not yet written, one is damaged
        let chunks = out.join(FOLDER);
        std::fs::remove_file(chunks.join("000001.json.gz")).unwrap();
        std::fs::write(chunks.join("000002.json.gz"), b"half").unwrap();
        let kept = open(&campaign, &out, true).unwrap();
        let is_there = |kept: &BlockCache, name| kept.load::<Vec<Observation>>(name).is_some();
        assert!(is_there(&kept, "000000") && !is_there(&kept, "000002"));
        let resumed = observe_in_chunks(&campaign, &kept, 5, &quiet).unwrap();
        assert_eq!(json(&whole), json(&resumed));

        // another campaign loads nothing
        let mut other = campaign.clone();
        other.analysis.skip_s = 0.1;
        let kept = open(&other, &out, true).unwrap();
        assert!(!is_there(&kept, "000000"));
    }

    fn json(observations: &[Observation]) -> String {
        serde_json::to_string(observations).unwrap()
    }
}
