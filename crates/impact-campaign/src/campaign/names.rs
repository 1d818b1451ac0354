//! Names of records: short, unique, the same on every machine, and in natural order.

use std::collections::HashMap;
use std::path::Path;

/// What the name of a record is made of.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known<'a> {
    /// Its file.
    pub(super) file: &'a Path,
    /// Its dataset; empty if the file is the dataset.
    pub(super) dataset: &'a str,
    /// The name that the run table gives.
    pub(super) given: Option<&'a str>,
}

/// One name per record: as given; else its dataset if these alone are unique; else
/// the file's name without extension, after as many folders as make the names unique, and followed by
/// the dataset.
pub(super) fn of<'a>(records: impl Iterator<Item = Known<'a>>) -> Vec<String> {
    let records: Vec<Known<'a>> = records.collect();
    let depth = if datasets_suffice(&records) {
        0
    } else {
        depth_needed(&records)
    };
    let mut names: Vec<String> = records.iter().map(|r| name(r, depth)).collect();
    number_repeated(&mut names);
    names
}

fn name(record: &Known<'_>, depth: usize) -> String {
    if let Some(given) = record.given {
        return given.to_owned();
    }
    if depth == 0 {
        return record.dataset.trim_matches('/').to_owned();
    }
    let file = tail(record.file, depth);
    match record.dataset.trim_matches('/') {
        "" => file,
        dataset => format!("{file}/{dataset}"),
    }
}

fn datasets_suffice(records: &[Known<'_>]) -> bool {
    let names: std::collections::BTreeSet<&str> = records
        .iter()
        .map(|r| r.dataset.trim_matches('/'))
        .collect();
    !names.contains("") && names.len() == records.len()
}

/// Last parts of a path, without the extension.
fn tail(path: &Path, depth: usize) -> String {
    let bare = path.with_extension("");
    let parts: Vec<_> = bare.iter().map(|p| p.to_string_lossy()).collect();
    parts[parts.len().saturating_sub(depth)..].join("/")
}

fn depth_needed(records: &[Known<'_>]) -> usize {
    let deepest = records
        .iter()
        .map(|r| r.file.iter().count())
        .max()
        .unwrap_or(1);
    let files: std::collections::BTreeSet<&Path> = records.iter().map(|r| r.file).collect();
    (1..deepest)
        .find(|depth| {
            let tails: std::collections::BTreeSet<String> =
                files.iter().map(|f| tail(f, *depth)).collect();
            tails.len() == files.len()
        })
        .unwrap_or(1)
}

/// Append a number to names that occur more than once.
fn number_repeated(names: &mut [String]) {
    let mut count: HashMap<String, usize> = HashMap::new();
    for name in names.iter() {
        *count.entry(name.clone()).or_default() += 1;
    }
    let mut seen: HashMap<String, usize> = HashMap::new();
    for name in names.iter_mut().filter(|n| count[n.as_str()] > 1) {
        let number = seen.entry(name.clone()).or_default();
        *number += 1;
        *name = format!("{name}#{number}");
    }
}

/// A key that puts `run2` before `run10`.
pub(super) fn natural_key(name: &str) -> Vec<(u8, u64, String)> {
    let mut key: Vec<(u8, u64, String)> = Vec::new();
    for letter in name.chars() {
        match (letter.to_digit(10), key.last_mut()) {
            (Some(d), Some((0, number, text))) if number.checked_mul(10).is_some() => {
                *number = number.saturating_mul(10).saturating_add(u64::from(d));
                text.push(letter);
            }
            (Some(d), _) => key.push((0, u64::from(d), letter.to_string())),
            (None, Some((1, _, text))) => text.push(letter),
            (None, _) => key.push((1, 0, letter.to_string())),
        }
    }
    key
}

#[cfg(test)]
mod tests {
    use super::*;

    fn known<'a>(file: &'a str, dataset: &'a str) -> Known<'a> {
        Known {
            file: Path::new(file),
            dataset,
            given: None,
        }
    }

    #[test]
    fn names_are_as_short_as_unique_names_can_be() {
        let short = of([known("/a/b/one.h5", "run1"), known("/a/b/two.csv", "")].into_iter());
        assert_eq!(short, ["one/run1", "two"]);
        let sets = of([known("/a/b/one.h5", "run1"), known("/a/b/two.h5", "/run2")].into_iter());
        assert_eq!(sets, ["run1", "run2"]);
        let both = of([known("/a/one.h5", "run1"), known("/a/two.h5", "run1")].into_iter());
        assert_eq!(both, ["one/run1", "two/run1"]);
        let deep = of([known("/a/b/tps.txt", ""), known("/a/c/tps.txt", "")].into_iter());
        assert_eq!(deep, ["b/tps", "c/tps"]);
        let same = of([known("/a/x.csv", ""), known("/a/x.lvm", "")].into_iter());
        assert_eq!(same, ["x#1", "x#2"]);
    }
}
