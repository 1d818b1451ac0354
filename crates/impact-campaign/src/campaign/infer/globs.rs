//! Patterns that match the record files of a folder, and no other file in it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Folders from which on one pattern matches the files in all of them.
const MANY_FOLDERS: usize = 4;

/// Patterns for records among all files, relative to one folder: `*.csv` for each folder and ending, the files'
/// common beginning before the star where other files have that ending too, else the names themselves.
pub(super) fn of(records: &[&Path], files: &[PathBuf]) -> Vec<String> {
    let others = files.iter().map(PathBuf::as_path);
    let others: Vec<&Path> = others.filter(|f| !records.contains(f)).collect();
    let short = short(records, &others);
    if match_exactly(&short, records, &others) {
        short
    } else {
        named(records)
    }
}

/// A path with `/` on every system.
pub(super) fn slashed(path: &Path) -> String {
    path.iter()
        .map(|p| p.to_string_lossy())
        .collect::<Vec<_>>()
        .join("/")
}

/// Patterns with stars.
fn short(records: &[&Path], others: &[&Path]) -> Vec<String> {
    let mut groups: BTreeMap<(String, String), Vec<&Path>> = BTreeMap::new();
    for record in records {
        groups.entry(place(record)).or_default().push(record);
    }
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

/// The names themselves as patterns.
fn named(records: &[&Path]) -> Vec<String> {
    let names = records.iter().map(|r| slashed(r));
    names.map(|name| glob::Pattern::escape(&name)).collect()
}

/// Whether patterns match all records and no other file, as they are resolved: a star stays within its folder.
fn match_exactly(patterns: &[String], records: &[&Path], others: &[&Path]) -> bool {
    let compiled = patterns.iter().map(|p| glob::Pattern::new(p).ok());
    let compiled: Option<Vec<glob::Pattern>> = compiled.collect();
    let options = glob::MatchOptions {
        require_literal_separator: true,
        ..glob::MatchOptions::new()
    };
    let matched = |file: &Path| {
        let name = slashed(file);
        let mut all = compiled.iter().flatten();
        all.any(|pattern| pattern.matches_with(&name, options))
    };
    records.iter().all(|r| matched(r)) && !others.iter().any(|o| matched(o))
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
    let stem = |name: &String| name.strip_suffix(ending.as_str()).map(str::to_owned);
    let stems: Vec<String> = names.iter().filter_map(stem).collect();
    // run01, run02: not what their numbers happen to share
    let shared = common_start(&stems).trim_end_matches(|c: char| c.is_ascii_digit());
    let pattern = format!("{}*{ending}", escaped(shared));
    if names.len() > 1
        && shared.len() > folder.len()
        && match_exactly(std::slice::from_ref(&pattern), records, others)
    {
        vec![pattern]
    } else {
        named(records)
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
        // one record beside another file, and a name that the other begins with
        assert_eq!(found(&["data.csv"], &["notes.csv"]), ["data.csv"]);
        assert_eq!(found(&["data.csv"], &["data 2.csv"]), ["data.csv"]);
        assert_eq!(found(&["a/[1].csv"], &["a/x.csv"]), ["a/[[]1[]].csv"]);
        assert_eq!(
            found(&["run.csv", "run1.csv"], &["notes.csv"]),
            ["run*.csv"]
        );
        let folders = ["a/1.csv", "b/1.csv", "c/1.csv", "d/1.csv", "e/1.csv"];
        assert_eq!(found(&folders, &[]), ["**/*.csv"]);
        assert_eq!(found(&folders, &["e/n.csv"]).len(), 5);
    }

    proptest::proptest! {
        #[test]
        fn prop_patterns_match_the_records_and_no_other_file(
            names in proptest::collection::btree_set("([ab]/)?[ab1*\\[ ]{1,3}\\.(csv|h5)", 1..12),
            record in proptest::collection::vec(proptest::bool::ANY, 12),
        ) {
            let files: Vec<PathBuf> = names.iter().map(PathBuf::from).collect();
            let taken = files.iter().zip(&record).filter(|(_, is)| **is);
            let records: Vec<&Path> = taken.map(|(file, _)| file.as_path()).collect();
            let is_other = |f: &&Path| !records.contains(f);
            let others: Vec<&Path> = files.iter().map(PathBuf::as_path).filter(is_other).collect();
            let patterns = of(&records, &files);
            proptest::prop_assert!(match_exactly(&patterns, &records, &others), "{patterns:?}");
        }
    }
}
