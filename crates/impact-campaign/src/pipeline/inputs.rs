//! Hashes of all inputs.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use sha2::{Digest, Sha256};

use crate::campaign::resolved::ResolvedCampaign;
use crate::campaign::slashes;

/// SHA-256 of campaign.toml and of every record file, by path (relative to the folder of campaign.toml
/// if the file is in it, with `/` on every system). A file that cannot be read has the hash "unreadable".
pub fn hashes(campaign: &ResolvedCampaign) -> BTreeMap<String, String> {
    let mut files: BTreeSet<PathBuf> = campaign.records.iter().map(|r| r.file.clone()).collect();
    files.insert(campaign.file.clone());
    files.extend(campaign.run_table.clone());
    files.extend(
        campaign
            .published
            .as_ref()
            .map(|p| campaign.folder().join(&p.speeds)),
    );
    let files: Vec<PathBuf> = files.into_iter().collect();
    files
        .par_iter()
        .map(|path| {
            let name = path.strip_prefix(campaign.folder()).unwrap_or(path);
            let hash = hash(path).unwrap_or_else(|_| "unreadable".to_owned());
            (slashes::text(name), hash)
        })
        .collect()
}

/// SHA-256 of a file as lower-case hexadecimal.
fn hash(path: &Path) -> std::io::Result<String> {
    let mut file = BufReader::with_capacity(1 << 18, File::open(path)?);
    let mut hasher = Sha256::new();
    std::io::copy(&mut file, &mut hasher)?;
    Ok(hexadecimal(hasher))
}

/// A finished hash as lower-case hexadecimal.
pub fn hexadecimal(hasher: Sha256) -> String {
    let bytes = hasher.finalize();
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
