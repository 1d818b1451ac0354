//! The layouts of the results' files: those of another version of the program are refused by name.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use super::error::PipelineError;
use super::identify;
use super::summary;

/// The part of a results' file that states its layout.
#[derive(Debug, Deserialize)]
struct Stated {
    #[serde(default)]
    versions: BTreeMap<String, String>,
}

/// Check that what a folder holds of an earlier run has this program's layouts. Nothing is read of a
/// folder without results.
///
/// # Errors
/// [`PipelineError::Layout`] for results of another layout or of none.
pub fn check(folder: &Path) -> Result<(), PipelineError> {
    for name in [identify::FILE, summary::JSON] {
        let path = folder.join(name);
        // a folder that cannot be read is reported when it is written into
        if let Ok(text) = std::fs::read_to_string(&path) {
            let stated: Option<Stated> = serde_json::from_str(&text).ok();
            check_versions(&path, name, &stated.map(|s| s.versions).unwrap_or_default())?;
        }
    }
    Ok(())
}

/// Check the layout that a file states among its versions, under its name.
///
/// # Errors
/// [`PipelineError::Layout`] where it is another one than this program's.
pub fn check_versions(
    path: &Path,
    name: &str,
    stated: &BTreeMap<String, String>,
) -> Result<(), PipelineError> {
    let expected = summary::versions().remove(name).unwrap_or_default();
    match stated.get(name) {
        Some(found) if *found == expected => Ok(()),
        found => Err(PipelineError::Layout {
            path: path.display().to_string(),
            found: found.cloned().unwrap_or_else(|| "none".to_owned()),
            expected,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_of_another_layout_are_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        check(folder.path()).unwrap();
        let path = folder.path().join(identify::FILE);
        let text = serde_json::json!({ "versions": identify::versions() }).to_string();
        std::fs::write(&path, &text).unwrap();
        check(folder.path()).unwrap();
        for other in [
            text.replace("\"6\"", "\"1\""),
            "{}".into(),
            "no JSON".into(),
        ] {
            std::fs::write(&path, &other).unwrap();
            let refused = check(folder.path()).unwrap_err();
            let PipelineError::Layout { path, expected, .. } = &refused else {
                panic!("{refused}")
            };
            assert!(path.ends_with(identify::FILE) && expected == "6");
            assert!(refused.remedy().contains("--out"));
        }
    }
}
