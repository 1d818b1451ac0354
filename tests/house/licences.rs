//! Every library that is built in has a licence that deny.toml allows.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Whether an SPDX expression can be met by allowed licences; "/" stands for OR, as of old.
fn is_met(expression: &str, allowed: &BTreeSet<String>) -> bool {
    let spaced = expression
        .replace('/', " OR ")
        .replace('(', " ( ")
        .replace(')', " ) ")
        .replace(" WITH ", "\u{1}WITH\u{1}");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    let mut rest = words.as_slice();
    let met = any(&mut rest, allowed);
    met && rest.is_empty()
}

fn any(rest: &mut &[&str], allowed: &BTreeSet<String>) -> bool {
    let mut met = all(rest, allowed);
    while let Some(("OR", after)) = rest.split_first().map(|(w, a)| (*w, a)) {
        *rest = after;
        met |= all(rest, allowed);
    }
    met
}

fn all(rest: &mut &[&str], allowed: &BTreeSet<String>) -> bool {
    let mut met = one(rest, allowed);
    while let Some(("AND", after)) = rest.split_first().map(|(w, a)| (*w, a)) {
        *rest = after;
        met &= one(rest, allowed);
    }
    met
}

fn one(rest: &mut &[&str], allowed: &BTreeSet<String>) -> bool {
    let Some((word, after)) = rest.split_first() else {
        return false;
    };
    *rest = after;
    if *word != "(" {
        return allowed.contains(&word.replace('\u{1}', " "));
    }
    let met = any(rest, allowed);
    match rest.split_first() {
        Some((&")", after)) => {
            *rest = after;
            met
        }
        _ => false,
    }
}

fn allowed() -> BTreeSet<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("deny.toml");
    let text = fs::read_to_string(path).expect("deny.toml");
    let table: toml::Table = text.parse().expect("TOML");
    let list = table["licenses"]["allow"].as_array().expect("a list");
    let names = list.iter().map(|l| l.as_str().expect("a name").to_owned());
    names.collect()
}

/// The platform that this is built for.
fn host() -> String {
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let told = Command::new(rustc).arg("-vV").output().expect("rustc");
    let told = String::from_utf8(told.stdout).expect("text");
    let host = told.lines().find_map(|l| l.strip_prefix("host: "));
    host.expect("a host").to_owned()
}

/// The name and the licence of every library that is built in.
fn licences() -> Vec<(String, String)> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".into());
    let told = Command::new(cargo)
        .args(["metadata", "--format-version", "1", "--locked", "--offline"])
        .args(["--filter-platform", &host()])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo");
    assert!(
        told.status.success(),
        "{}",
        String::from_utf8_lossy(&told.stderr)
    );
    let told: serde_json::Value = serde_json::from_slice(&told.stdout).expect("JSON");
    let packages = told["packages"].as_array().expect("packages");
    assert!(packages.len() > 100);
    let text = |of: &serde_json::Value, none: &str| of.as_str().unwrap_or(none).to_owned();
    let stated = packages.iter();
    let stated = stated.map(|p| (text(&p["name"], ""), text(&p["license"], "none stated")));
    stated.collect()
}

#[test]
fn every_library_has_a_licence_that_is_allowed() {
    let allowed = allowed();
    for (name, licence) in licences() {
        assert!(is_met(&licence, &allowed), "{name}: {licence}");
    }
}

#[test]
fn no_licence_is_allowed_that_no_library_has() {
    let alternatives = |licence: String| {
        let parts = licence.replace(['(', ')'], "").replace('/', " OR ");
        let parts = parts.replace(" AND ", " OR ");
        let each = parts.split(" OR ").map(|l| l.trim().to_owned());
        each.collect::<Vec<_>>()
    };
    let all = licences().into_iter();
    let stated = all.flat_map(|(_, licence)| alternatives(licence));
    let stated: BTreeSet<String> = stated.collect();
    let allowed = allowed();
    let unused: Vec<&String> = allowed.difference(&stated).collect();
    assert!(unused.is_empty(), "{unused:?}");
}

#[test]
fn valid_expressions_are_met_as_spdx_has_them() {
    let allowed: BTreeSet<String> = ["MIT", "Apache-2.0 WITH LLVM-exception", "Zlib"]
        .map(String::from)
        .into();
    for good in [
        "MIT",
        "GPL-3.0 OR MIT",
        "MIT/GPL-2.0",
        "(GPL-3.0 OR Zlib) AND MIT",
        "Apache-2.0 WITH LLVM-exception OR GPL-2.0",
    ] {
        assert!(is_met(good, &allowed), "{good}");
    }
    for bad in [
        "GPL-3.0",
        "MIT AND GPL-3.0",
        "none stated",
        "",
        "(MIT",
        "Apache-2.0",
    ] {
        assert!(!is_met(bad, &allowed), "{bad}");
    }
}
