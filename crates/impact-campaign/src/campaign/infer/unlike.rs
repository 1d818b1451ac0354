//! Records that have other channels than most.

use std::collections::{BTreeMap, BTreeSet};

use super::place::Place;

/// The names of a record's channels, without those of runs.
fn names(place: Place<'_>) -> BTreeSet<String> {
    let channels = place.set().channels.iter();
    let bare = |name: &str| labfiles::without_run(name).map_or_else(|| name.to_owned(), |(b, _)| b);
    channels.map(|c| bare(&c.name)).collect()
}

/// Put a record with the channels that most have first, so that it stands for all; a note on the others.
pub(super) fn usual_first(places: &mut [Place<'_>]) -> Option<String> {
    let of_places: Vec<BTreeSet<String>> = places.iter().map(|p| names(*p)).collect();
    let mut counts: BTreeMap<&BTreeSet<String>, usize> = BTreeMap::new();
    for set in &of_places {
        *counts.entry(set).or_default() += 1;
    }
    let most = counts.values().copied().max()?;
    let usual = of_places.iter().position(|set| counts[set] == most)?;
    places[..=usual].rotate_right(1);
    let unlike: Vec<_> = of_places
        .iter()
        .filter(|s| **s != of_places[usual])
        .collect();
    if most == 1 || unlike.is_empty() {
        return None;
    }
    let of = |set: BTreeSet<&String>| set.into_iter().cloned().collect::<Vec<_>>().join(", ");
    let lacking = unlike.iter().flat_map(|s| of_places[usual].difference(s));
    let further = unlike.iter().flat_map(|s| s.difference(&of_places[usual]));
    let parts = [
        ("without", of(lacking.collect())),
        ("with", of(further.collect())),
    ];
    let parts = parts.iter().filter(|(_, names)| !names.is_empty());
    let parts: Vec<String> = parts.map(|(how, names)| format!("{how} {names}")).collect();
    Some(format!(
        "{} of {} records have other channels than the others ({}): where a channel with a role is missing, its record cannot be used",
        unlike.len(),
        places.len(),
        parts.join("; ")
    ))
}
