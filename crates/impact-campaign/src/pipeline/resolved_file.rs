//! `campaign.resolved.json`, from which results lead to their inputs.

use std::path::{Component, Path, PathBuf};

use super::PipelineError;
use super::json::{read_json, write_json};
use crate::campaign::resolved::{RESOLVED, ResolvedCampaign};
use crate::campaign::slashes;

/// A resolved campaign with where it was resolved.
#[derive(serde::Serialize, serde::Deserialize)]
struct Placed<C> {
    #[serde(flatten)]
    campaign: C,
    /// The folder in which relative paths begin, seen from the results; `None` of absolute paths.
    #[serde(default, serialize_with = "slashes::serialize_option")]
    #[serde(skip_serializing_if = "Option::is_none")]
    paths_begin_at: Option<PathBuf>,
}

/// Write the resolved campaign beside the results.
///
/// # Errors
/// If it cannot be written.
pub fn write_resolved(campaign: &ResolvedCampaign, out: &Path) -> Result<(), PipelineError> {
    let seen = || seen_from(&whole(out), &whole(Path::new(".")));
    let placed = Placed {
        campaign,
        paths_begin_at: campaign.file.is_relative().then(seen).flatten(),
    };
    write_json(&out.join(RESOLVED), &placed)
}

/// Read the resolved campaign of a previous stage. Its paths are as they were stated; where they began in another
/// directory, they are those below it. Of results that were moved, or do not state it, they are below the nearest folder
/// above the results that has them.
///
/// # Errors
/// If it is missing or unreadable.
pub fn read_resolved(out: &Path) -> Result<ResolvedCampaign, PipelineError> {
    let placed: Placed<ResolvedCampaign> = read_json(&out.join(RESOLVED))?;
    let (campaign, results) = (placed.campaign, whole(out));
    let stated = placed.paths_begin_at.map(|base| whole(&results.join(base)));
    let here = [whole(Path::new("."))];
    let mut places = stated
        .iter()
        .chain(&here)
        .map(PathBuf::as_path)
        .chain(results.ancestors().skip(1));
    let found = places.find(|base| base.join(&campaign.file).exists());
    // files that are nowhere are missed where they were
    Ok(match found.or(stated.as_deref()) {
        Some(base) if base != here[0] => campaign.below(base),
        _ => campaign,
    })
}

/// A path from the root on, without links where it exists.
fn whole(path: &Path) -> PathBuf {
    let absolute = || std::path::absolute(path).ok();
    let canonical = path.canonicalize().ok().or_else(absolute);
    canonical.unwrap_or_else(|| path.to_owned())
}

/// The way from one folder to another, both from the root on; `None` where they have no root in common, or the way from it
/// is not known.
fn seen_from(from: &Path, to: &Path) -> Option<PathBuf> {
    let (from, to): (Vec<_>, Vec<_>) = (from.components().collect(), to.components().collect());
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if shared == 0 || from.contains(&Component::ParentDir) {
        return None;
    }
    let up = from[shared..].iter().map(|_| Component::ParentDir);
    let way: PathBuf = up.chain(to[shared..].iter().copied()).collect();
    Some(way)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn results_lead_to_their_inputs_from_another_directory() {
        // paths of the example begin at the workspace, and tests run in their crate
        let example = concat!(env!("CARGO_MANIFEST_DIR"), "/../../reports/example");
        let campaign = read_resolved(Path::new(example)).unwrap();
        let table = campaign.run_table.iter();
        let files = campaign.records.iter().map(|r| &r.file).chain(table);
        for file in files.chain([&campaign.file]) {
            assert!(file.exists(), "{}", file.display());
        }
    }

    #[test]
    fn results_anywhere_lead_to_where_their_paths_begin() {
        let example = concat!(env!("CARGO_MANIFEST_DIR"), "/../../reports/example");
        let mut campaign = read_resolved(Path::new(example)).unwrap();
        campaign.records.clear();
        campaign.run_table = None;
        campaign.file = "Cargo.toml".into();
        let folder = tempfile::tempdir().unwrap();
        write_resolved(&campaign, folder.path()).unwrap();
        assert_eq!(read_resolved(folder.path()).unwrap(), campaign);
        // as if it had been resolved elsewhere, where a file of that name was; one is here too
        let written = folder.path().join(RESOLVED);
        let mut text: serde_json::Value = read_json(&written).unwrap();
        let begin = Path::new(text["paths_begin_at"].as_str().unwrap()).join("../labfiles");
        text["paths_begin_at"] = begin.to_str().into();
        write_json(&written, &text).unwrap();
        let found = read_resolved(folder.path()).unwrap().file;
        assert!(found.ends_with("crates/labfiles/Cargo.toml") && found.exists());
        // and as if that file were gone from there
        text["file"] = "gone.toml".into();
        write_json(&written, &text).unwrap();
        let missed = read_resolved(folder.path()).unwrap().file;
        assert!(missed.is_absolute() && missed.ends_with("crates/labfiles/gone.toml"));
    }

    #[test]
    fn a_folder_is_seen_from_another_one() {
        let seen = |from: &str, to: &str| seen_from(Path::new(from), Path::new(to));
        assert_eq!(seen("/a/b/out", "/a/b"), Some("..".into()));
        assert_eq!(seen("/a/out", "/a/day 1"), Some("../day 1".into()));
        assert_eq!(seen("/a", "/a"), Some("".into()));
        assert_eq!(seen("a", "b"), None);
        assert_eq!(seen("/a/b/../out", "/a/b"), None);
    }
}
