//! Patterns of files among a command's arguments, which some shells leave as typed.

use std::path::PathBuf;

use super::Failure;
use impact_campaign::campaign::matching;

/// The paths as typed; a pattern that the shell has left as it is stands for the files and folders that match
/// it, without hidden ones, as in shells that expand it.
///
/// # Errors
/// [`Failure`] with the remedy where nothing matches a pattern.
pub(super) fn expanded(typed: &[PathBuf], remedy: &str) -> Result<Vec<PathBuf>, Failure> {
    let mut all = Vec::new();
    for path in typed {
        let text = path.to_string_lossy();
        if text.contains(['*', '?', '[']) && !path.exists() {
            let found = matching(&text);
            if found.is_empty() {
                return Err(Failure::new(format!("no file matches '{text}'"), remedy));
            }
            all.extend(found);
        } else {
            all.push(path.clone());
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pattern_stands_for_its_files_and_a_path_for_itself() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for name in ["b.csv", "a.csv", "._a.csv", "c.txt", "[d].csv"] {
            std::fs::write(path(name), "").unwrap();
        }
        let all = expanded(&[path("?.csv"), path("none.h5"), path("[d].csv")], "").unwrap();
        let expected = ["a.csv", "b.csv", "none.h5", "[d].csv"].map(path);
        assert_eq!(all, expected);
        let error = expanded(&[path("*.h5")], "name a file").unwrap_err();
        assert_eq!(error.problems()[0].1, "name a file");
    }
}
