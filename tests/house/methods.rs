//! A method of identification is a folder: what others ask of it is a property, not its name.

use std::collections::{BTreeMap, BTreeSet};

use super::sources::{SourceFile, all_sources};

/// Where variants are named beside the enum with its properties (`method.rs`, as `Self::…`): the table of blocks.
const TABLE: &str = "crates/impact-fit/src/methods/blocks.rs";

/// The variants of `Method` that a code names.
fn named(code: &str) -> BTreeSet<String> {
    let after = code.match_indices("Method::").filter(|(at, _)| {
        let before = code[..*at].chars().next_back();
        !before.is_some_and(|c| c.is_alphanumeric() || c == '_')
    });
    let words = after.map(|(at, path)| {
        let rest = &code[at + path.len()..];
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
        rest[..end.unwrap_or(rest.len())].to_owned()
    });
    // neither functions nor lists of the enum
    words
        .filter(|w| w.starts_with(char::is_uppercase) && w.contains(char::is_lowercase))
        .collect()
}

#[test]
fn a_method_is_named_in_its_folder_and_in_one_table() {
    let mut places: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let of_tests = |f: &&SourceFile| f.module.split("::").any(|part| part == "tests");
    for file in all_sources().iter().filter(|f| !of_tests(f)) {
        let folder = file.module.split("::").take(2).collect::<Vec<_>>();
        let of_method = file.package == "impact-fit" && folder.len() == 2 && folder[0] == "methods";
        let place = if of_method && file.place() != TABLE {
            folder.join("::")
        } else {
            file.place()
        };
        for variant in named(&file.code()) {
            places.entry(variant).or_default().insert(place.clone());
        }
    }
    assert_eq!(places.len(), 8, "{places:#?}");
    for (variant, mut places) in places {
        assert!(places.remove(TABLE), "{variant} is not in the table");
        assert_eq!(places.len(), 1, "{variant}: {places:?}");
        assert!(
            places.iter().all(|p| p.starts_with("methods::")),
            "{variant}: {places:?}"
        );
    }
}

#[test]
fn variants_are_told_from_functions_and_lists() {
    let code = "Method::Impacts => a, IntervalMethod::Other, Method::FITTED, Method::iter()";
    assert_eq!(named(code), BTreeSet::from(["Impacts".to_owned()]));
}
