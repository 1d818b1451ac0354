//! The folders of several campaigns' results: short names from where each campaign.toml is.

use std::collections::{HashMap, HashSet};
use std::path::{Component, Path, PathBuf};

use super::summary;

/// One folder name per campaign, in their order: that of the folder of campaign.toml, or the name of
/// a description that is called otherwise. Names that several share, in whatever case, are preceded by as
/// many folders above as tell them apart; what is left equal is numbered.
pub fn names(campaigns: &[PathBuf]) -> Vec<String> {
    let parts: Vec<Vec<String>> = campaigns.iter().map(|c| parts(c)).collect();
    let mut depths = vec![1; parts.len()];
    loop {
        let names: Vec<String> = parts
            .iter()
            .zip(&depths)
            .map(|(p, d)| tail(p, *d))
            .collect();
        let mut count: HashMap<String, usize> = HashMap::new();
        for name in &names {
            *count.entry(name.to_lowercase()).or_default() += 1;
        }
        let mut changed = false;
        for (i, name) in names.iter().enumerate() {
            if count[&name.to_lowercase()] > 1 && depths[i] < parts[i].len() {
                depths[i] += 1;
                changed = true;
            }
        }
        if !changed {
            return numbered(names);
        }
    }
}

/// The folders above a description and its own name, unless that is the usual one.
fn parts(campaign: &Path) -> Vec<String> {
    let absolute = std::path::absolute(campaign).unwrap_or_else(|_| campaign.to_path_buf());
    let mut parts: Vec<String> = Vec::new();
    for component in absolute.with_extension("").components() {
        match component {
            Component::Normal(name) => parts.push(name.to_string_lossy().into_owned()),
            Component::ParentDir => drop(parts.pop()),
            _ => {}
        }
    }
    if parts.len() > 1 && parts.last().is_some_and(|p| p == "campaign") {
        parts.pop();
    }
    parts
}

/// The last parts; hidden names are made visible.
fn tail(parts: &[String], depth: usize) -> String {
    let last = parts[parts.len().saturating_sub(depth)..].join("-");
    match last.trim_start_matches('.') {
        "" => "campaign".to_owned(),
        name => name.to_owned(),
    }
}

/// Append a number to names that are there already, or are those of the summary's files.
fn numbered(names: Vec<String>) -> Vec<String> {
    let mut taken: HashSet<String> = [summary::CSV, summary::JSON].map(String::from).into();
    let free = |name: String| {
        let mut numbers = 2..;
        let mut free = name.clone();
        while !taken.insert(free.to_lowercase()) {
            free = format!("{name}-{}", numbers.next().unwrap_or(u32::MAX));
        }
        free
    };
    names.into_iter().map(free).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(campaigns: &[&str]) -> Vec<String> {
        let paths: Vec<PathBuf> = campaigns.iter().map(PathBuf::from).collect();
        names(&paths)
    }

    #[test]
    fn folders_are_named_after_those_of_the_campaigns() {
        assert_eq!(
            named(&["/l/day1/campaign.toml", "/l/day2/campaign.toml"]),
            ["day1", "day2"]
        );
        assert_eq!(named(&["/l/soft.toml", "/l/hard.toml"]), ["soft", "hard"]);
        assert_eq!(
            named(&["/l/day1/../day3/campaign.toml", "/l/.day/campaign.toml"]),
            ["day3", "day"]
        );
    }

    #[test]
    fn names_never_collide() {
        // only those that are alike become longer
        assert_eq!(
            named(&[
                "/a/day1/campaign.toml",
                "/b/Day1/campaign.toml",
                "/b/day2/campaign.toml"
            ]),
            ["a-day1", "b-Day1", "day2"]
        );
        // a joined name that another has of itself
        assert_eq!(
            named(&[
                "/x/a-b/campaign.toml",
                "/a/b/campaign.toml",
                "/c/b/campaign.toml"
            ]),
            ["x-a-b", "a-b", "c-b"]
        );
        // a description beside a folder of its name
        assert_eq!(
            named(&["/a/day.toml", "/a/day/campaign.toml"]),
            ["a-day", "a-day-2"]
        );
        assert_eq!(named(&["/summary.csv/campaign.toml"]), ["summary.csv-2"]);
    }

    proptest::proptest! {
        #[test]
        fn prop_every_campaign_has_a_folder_of_its_own(
            paths in proptest::collection::hash_set("(/[aAb.-]{1,2}){1,3}/(campaign|a|b)\\.(toml|txt)", 1..12),
        ) {
            let paths: Vec<PathBuf> = paths.into_iter().map(PathBuf::from).collect();
            let names = names(&paths);
            let distinct: HashSet<String> = names.iter().map(|n| n.to_lowercase()).collect();
            proptest::prop_assert_eq!(distinct.len(), paths.len());
            for name in names {
                proptest::prop_assert!(!name.is_empty() && !name.starts_with('.') && !name.contains('/'));
            }
        }
    }
}
