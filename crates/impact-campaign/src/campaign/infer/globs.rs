//! Patterns that match the record files of a folder, and no other file in it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::slashed;

/// Folders from which on one pattern matches the files in all of them.
const MANY_FOLDERS: usize = 4;

/// Patterns for records among all files, relative to one folder: `*.csv` for each folder and ending, the files'
/// common beginning before the star where other files have that ending too, else the names themselves.
pub(super) fn of(records: &[&Path], files: &[PathBuf]) -> Vec<String> {
    let is_record = |file: &Path| records.contains(&file);
    let mut groups: BTreeMap<(String, String), Vec<&Path>> = BTreeMap::new();
    for record in records {
        groups.entry(place(record)).or_default().push(record);
    }
    let others: Vec<&Path> = files
        .iter()
        .map(PathBuf::as_path)
        .filter(|f| !is_record(f))
        .collect();
    let endings: BTreeSet<&str> = groups.keys().map(|(_, ending)| ending.as_str()).collect();
    let alone = others
        .iter()
        .all(|other| !endings.contains(place(other).1.as_str()));
    if groups.len() > MANY_FOLDERS && alone {
        return endings
            .iter()
            .map(|ending| format!("**/*{ending}"))
            .collect();
    }
    let each = groups.iter().flat_map(|(key, group)| {
        let strangers: Vec<&Path> = others
            .iter()
            .copied()
            .filter(|o| place(o) == *key)
            .collect();
        patterns(key, group, &strangers)
    });
    each.collect()
}

/// The folder of a file, with a slash, and its ending, with a point.
fn place(path: &Path) -> (String, String) {
    let folder = path.parent().map(slashed).filter(|f| !f.is_empty());
    let ending = path
        .extension()
        .map(|e| format!(".{}", e.to_string_lossy()));
    (
        folder.map(|f| f + "/").unwrap_or_default(),
        ending.unwrap_or_default(),
    )
}

/// Patterns for the records of a folder and ending beside other files of that ending.
fn patterns(
    (folder, ending): &(String, String),
    records: &[&Path],
    others: &[&Path],
) -> Vec<String> {
    let escaped = |text: &str| glob::Pattern::escape(text);
    if others.is_empty() {
        return vec![format!("{}*{ending}", escaped(folder))];
    }
    let names: Vec<String> = records.iter().map(|r| slashed(r)).collect();
    // run01, run02: not what their numbers happen to share
    let shared = common_start(&names).trim_end_matches(|c: char| c.is_ascii_digit());
    let pattern = format!("{}*{ending}", escaped(shared));
    let matches = |other: &&Path| {
        let compiled = glob::Pattern::new(&pattern);
        compiled.is_ok_and(|p| p.matches(&slashed(other)))
    };
    if shared.len() > folder.len() && !others.iter().any(matches) {
        vec![pattern]
    } else {
        names.iter().map(|name| escaped(name)).collect()
    }
}

/// What all names begin with.
fn common_start(names: &[String]) -> &str {
    let Some(first) = names.first() else {
        return "";
    };
    let shared = |name: &String| {
        let pairs = first.char_indices().zip(name.chars());
        let mut unlike = pairs.skip_while(|((_, a), b)| a == b);
        unlike
            .next()
            .map_or(first.len().min(name.len()), |((at, _), _)| at)
    };
    let end = names.iter().map(shared).min().unwrap_or(0);
    &first[..end]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(records: &[&str], others: &[&str]) -> Vec<String> {
        let records: Vec<&Path> = records.iter().map(|r| Path::new(*r)).collect();
        let all = records.iter().map(|r| r.to_path_buf());
        let all = all.chain(others.iter().map(PathBuf::from));
        of(&records, &all.collect::<Vec<_>>())
    }

    #[test]
    fn patterns_match_the_records_alone() {
        assert_eq!(found(&["a.csv", "b.csv", "c.h5"], &[]), ["*.csv", "*.h5"]);
        assert_eq!(found(&["x/a.csv"], &["runs.csv"]), ["x/*.csv"]);
        assert_eq!(
            found(&["run1.csv", "run2.csv"], &["notes.csv"]),
            ["run*.csv"]
        );
        assert_eq!(
            found(&["r1.csv", "q2.csv"], &["notes.csv"]),
            ["r1.csv", "q2.csv"]
        );
        assert_eq!(
            found(&["run1.csv", "run2.csv"], &["run list.csv"]),
            ["run1.csv", "run2.csv"]
        );
        let folders = ["a/1.csv", "b/1.csv", "c/1.csv", "d/1.csv", "e/1.csv"];
        assert_eq!(found(&folders, &[]), ["**/*.csv"]);
        assert_eq!(found(&folders, &["e/n.csv"]).len(), 5);
    }
}
