//! Files of a module do not import from each other in a circle.

use std::collections::{BTreeMap, BTreeSet};

/// The path of a file's module: `identify::fit` of `identify/fit/mod.rs` and of `identify/fit.rs`.
fn path_of(file: &str) -> String {
    let path = file.trim_end_matches(".rs").trim_end_matches("/mod");
    path.replace('/', "::")
}

/// Paths that a source names in `use crate::…;` outside its tests.
fn used(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]").next().unwrap_or(text);
    let statements = code.split("use crate::").skip(1);
    statements
        .filter_map(|rest| rest.split_once(';'))
        .flat_map(|(statement, _)| match statement.split_once('{') {
            Some((before, list)) => list
                .split([',', '{', '}'])
                .map(|item| format!("{before}{}", item.trim()))
                .collect(),
            None => vec![statement.to_owned()],
        })
        .collect()
}

/// The file that a path leads into: that of its longest part which is a module.
fn file_of<'a>(path: &str, files: &'a BTreeMap<String, BTreeSet<String>>) -> Option<&'a String> {
    let mut part = path.trim_end_matches("::");
    loop {
        if let Some((name, _)) = files.get_key_value(part) {
            return Some(name);
        }
        part = part.rsplit_once("::")?.0;
    }
}

/// Files that are reached from one, the file itself only by a circle.
fn reached<'a>(
    from: &str,
    imports: &'a BTreeMap<String, BTreeSet<String>>,
) -> BTreeSet<&'a String> {
    let mut found = BTreeSet::new();
    let mut open: Vec<&String> = imports[from].iter().collect();
    while let Some(next) = open.pop() {
        if found.insert(next) {
            open.extend(&imports[next]);
        }
    }
    found
}

#[test]
fn files_of_a_module_do_not_import_in_a_circle() {
    let sources = super::all_sources();
    let names = sources.iter().map(|(file, _)| path_of(file));
    let empty: BTreeMap<String, BTreeSet<String>> = names.map(|n| (n, BTreeSet::new())).collect();
    let mut imports = empty.clone();
    for (file, text) in &sources {
        let own = path_of(file);
        let first = |path: &str| path.split("::").next().map(str::to_owned);
        let others = used(text).into_iter().filter_map(|p| file_of(&p, &empty));
        let others: BTreeSet<String> = others
            .filter(|other| **other != own && first(other) == first(&own))
            .cloned()
            .collect();
        imports.insert(own, others);
    }
    assert!(imports.values().map(BTreeSet::len).sum::<usize>() > 100);
    let in_circle = |name: &&String| reached(name, &imports).contains(name);
    let circles: Vec<&String> = imports.keys().filter(in_circle).collect();
    assert!(
        circles.is_empty(),
        "files that import in a circle: {circles:?}"
    );
}
