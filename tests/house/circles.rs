//! Files of a package do not import from each other in a circle.

use std::collections::BTreeSet;

use super::sources::{Imports, all_sources, packages};

#[test]
fn files_do_not_import_in_a_circle() {
    let sources = all_sources();
    let (mut imports, mut found) = (0, BTreeSet::new());
    for package in packages().keys() {
        let files: Vec<_> = sources.iter().filter(|f| f.package == *package).collect();
        let of_package = Imports::new(&files);
        imports += of_package.of.values().map(BTreeSet::len).sum::<usize>();
        let circles = of_package.circles().into_iter();
        found.extend(circles.map(|files| format!("{package}: {}", files.join(", "))));
    }
    assert!(imports > 1000, "{imports} imports only");
    assert_eq!(found, BTreeSet::new());
}
