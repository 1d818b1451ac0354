//! Every direct dependency has its line in docs/dependencies.md: why it is there, what it costs.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use super::sources::{packages, root};

/// A manifest.
fn read(folder: &Path) -> toml::Table {
    let text = fs::read_to_string(folder.join("Cargo.toml")).expect("Cargo.toml");
    text.parse().expect("TOML")
}

/// Names of foreign crates in the tables of dependencies of a manifest, those of one platform too; `shared` are those of
/// the workspace.
fn foreign(
    manifest: &toml::Table,
    shared: &toml::Value,
    own: &BTreeSet<String>,
) -> BTreeSet<String> {
    let platforms = manifest.get("target").and_then(toml::Value::as_table);
    let platforms = platforms.into_iter().flat_map(toml::Table::values);
    let mut places: Vec<&toml::Table> = platforms.filter_map(toml::Value::as_table).collect();
    places.push(manifest);
    let mut names = BTreeSet::new();
    for place in places {
        for kind in ["dependencies", "dev-dependencies", "build-dependencies"] {
            let listed = place.get(kind).and_then(toml::Value::as_table);
            for (name, asked) in listed.into_iter().flatten() {
                let of_workspace = || shared.get(name)?.get("package");
                let renamed = asked.get("package").or_else(of_workspace);
                let renamed = renamed.and_then(toml::Value::as_str);
                names.insert(renamed.unwrap_or(name).to_owned());
            }
        }
    }
    names.retain(|name| !own.contains(name));
    names
}

#[test]
fn every_dependency_has_its_reason_and_its_cost() {
    let folders = packages();
    let own: BTreeSet<String> = folders.keys().cloned().collect();
    let shared = read(root())["workspace"]["dependencies"].clone();
    let mut used = BTreeSet::new();
    for folder in folders.values() {
        used.extend(foreign(&read(folder), &shared, &own));
    }
    let page = fs::read_to_string(root().join("docs/dependencies.md")).expect("the page");
    let rows = page.lines().filter_map(|line| line.strip_prefix("| `"));
    let listed: BTreeSet<String> = rows
        .filter_map(|row| row.split('`').next())
        .map(str::to_owned)
        .collect();
    let without: Vec<&String> = used.difference(&listed).collect();
    assert!(without.is_empty(), "no line in the page: {without:?}");
    let gone: Vec<&String> = listed.difference(&used).collect();
    assert!(gone.is_empty(), "no longer asked for: {gone:?}");
}
