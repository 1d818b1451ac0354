//! The rules of the layout: a module never imports from a module to its right.

mod circles;
mod licences;
mod links;

use std::fs;
use std::path::{Path, PathBuf};

/// The modules from left to right.
const MODULES: [&str; 14] = [
    "message",
    "signal",
    "record",
    "event",
    "motion",
    "synthetic",
    "identify",
    "difference",
    "compare",
    "report",
    "campaign",
    "pipeline",
    "explore",
    "cli",
];

fn sources(folder: &Path, all: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder)
        .expect("src can be read")
        .map(|e| e.expect("an entry"))
    {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, all);
        } else if path.extension().is_some_and(|e| e == "rs") {
            all.push(path);
        }
    }
}

fn all_sources() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut paths = Vec::new();
    sources(&root, &mut paths);
    paths
        .iter()
        .map(|p| {
            let name = p
                .strip_prefix(&root)
                .expect("below src")
                .to_string_lossy()
                .into_owned();
            (name, fs::read_to_string(p).expect("a source is text"))
        })
        .collect()
}

/// The module of a file: the first part of its path; `None` for lib.rs and main.rs.
fn module(name: &str) -> Option<usize> {
    let first = name.split(['/', '.']).next()?;
    MODULES.iter().position(|r| *r == first)
}

/// Modules that a source names after `crate::`, tests in it included.
fn imports(text: &str) -> Vec<&str> {
    text.lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .flat_map(|line| line.split("crate::").skip(1))
        .flat_map(|after| match after.strip_prefix('{') {
            Some(list) => list.split(',').map(str::trim).collect(),
            None => vec![after],
        })
        .filter_map(|path| {
            path.split(|c: char| !c.is_alphanumeric() && c != '_')
                .next()
        })
        .collect()
}

#[test]
fn no_module_imports_from_its_right() {
    let mut faults = Vec::new();
    for (name, text) in all_sources() {
        let Some(own) = module(&name) else { continue };
        for import in imports(&text) {
            let other = MODULES.iter().position(|r| *r == import);
            if other.is_some_and(|o| o > own) {
                faults.push(format!(
                    "{name} imports from {import}, a module to its right"
                ));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The report formats what it is given: it names neither the model nor what computes with it.
#[test]
fn the_report_computes_nothing() {
    let computing = [
        "impact_oscillator",
        "crate::event",
        "crate::synthetic",
        "identify::evidence",
        "identify::fit",
        "identify::replay",
    ];
    let mut faults = Vec::new();
    for (name, text) in all_sources() {
        if !name.starts_with("report/") {
            continue;
        }
        let code = text.lines().filter(|l| !l.trim_start().starts_with("//"));
        // the names of the parameters and of the effects
        let named = [
            "identify::fit::parameters::Coordinate",
            "identify::fit::effect::Effect",
        ];
        let code = code.map(|l| named.iter().fold(l.to_owned(), |l, n| l.replace(n, "")));
        for line in code {
            let found = computing.iter().find(|c| line.contains(**c));
            faults.extend(found.map(|c| format!("src/{name} names {c}: {line}")));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn the_modules_are_those_of_architecture_md_in_its_order() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    let rows = page.lines().filter_map(|line| line.strip_prefix("| `"));
    let listed: Vec<&str> = rows
        .filter_map(|row| row.split('`').next())
        .filter(|name| !name.contains('/'))
        .collect();
    assert_eq!(listed, MODULES, "the table of ARCHITECTURE.md");
    for (name, _) in all_sources() {
        let known = module(&name).is_some() || ["lib.rs", "main.rs"].contains(&name.as_str());
        assert!(known, "{name} is in no module");
    }
}

/// Whether a file is a module that only tests see.
fn for_tests_alone(name: &str, all: &[(String, String)]) -> bool {
    let stem = name
        .trim_end_matches(".rs")
        .rsplit('/')
        .next()
        .unwrap_or("");
    let declared = ["mod", "pub mod"].map(|m| format!("#[cfg(test)]\n{m} {stem};"));
    all.iter()
        .any(|(_, text)| declared.iter().any(|d| text.contains(d)))
}

#[test]
fn only_the_command_line_prints_or_exits() {
    let all = all_sources();
    let printing = [
        "println!",
        "eprintln!",
        "print!(",
        "eprint!(",
        "process::exit",
        "dbg!",
    ];
    for (name, text) in &all {
        if name.starts_with("cli/") || for_tests_alone(name, &all) {
            continue;
        }
        let code = text.split("#[cfg(test)]").next().unwrap_or("");
        for (number, line) in code.lines().enumerate() {
            let comment = line.trim_start().starts_with("//");
            let found = printing.iter().find(|p| line.contains(**p));
            assert!(
                comment || found.is_none(),
                "src/{name}:{} prints or exits: {line}",
                number + 1
            );
        }
    }
}

/// No network but loopback: sockets are opened in `explore` alone, and only on 127.0.0.1; its page names
/// no other address.
#[test]
fn sockets_are_opened_on_loopback_alone_and_only_by_the_explorer() {
    let sockets = ["TcpListener", "TcpStream", "UdpSocket", "axum", "tokio::"];
    let mut binds = 0;
    for (name, text) in all_sources() {
        let code = text.split("#[cfg(test)]").next().unwrap_or("");
        for line in code.lines().filter(|l| !l.trim_start().starts_with("//")) {
            let used = sockets.iter().any(|s| line.contains(s));
            assert!(!used || name.starts_with("explore/"), "src/{name}: {line}");
            if line.contains("::bind(") && line.contains("TcpListener") {
                binds += 1;
                assert!(line.contains("Ipv4Addr::LOCALHOST"), "src/{name}: {line}");
            }
            let connects = line.contains("::connect(");
            assert!(!connects, "src/{name} connects: {line}");
        }
    }
    assert_eq!(binds, 1);
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/explore/page");
    for entry in fs::read_dir(page).expect("the page") {
        let path = entry.expect("an entry").path();
        let name = path
            .file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned();
        let text = fs::read_to_string(&path).expect("text");
        let foreign = |scheme: &str| text.matches(scheme).count();
        let all = foreign("https://") + foreign("http://");
        assert!(all == 0, "{name} names another address");
    }
}

#[test]
fn a_foreign_crate_is_used_in_its_module_alone() {
    let homes = [
        ("rustfft", &["signal"][..]),
        ("realfft", &["signal"]),
        ("argmin", &["identify"]),
        ("plotters", &["report"]),
        ("indicatif", &["cli"]),
        ("miette", &["cli"]),
        ("clap", &["cli"]),
        ("axum", &["explore"]),
        ("hyper", &["explore"]),
        ("hyper_util", &["explore"]),
        ("tokio", &["explore"]),
        ("futures_util", &["explore"]),
    ];
    for (name, text) in all_sources() {
        for (foreign, modules) in homes {
            let uses = text
                .lines()
                .any(|l| l.trim_start().starts_with(&format!("use {foreign}::")));
            let home = modules.iter().any(|r| name.starts_with(r));
            assert!(
                !uses || home,
                "src/{name} uses {foreign}, which belongs to {modules:?}"
            );
        }
    }
}

/// What is built is used: a library in Cargo.toml that no source names only costs time.
#[test]
fn every_dependency_is_used() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let packages = [
        (".", &["src", "tests", "benches"][..]),
        ("crates/impact-oscillator", &["src"]),
        ("crates/labfiles", &["src"]),
    ];
    for (package, folders) in packages {
        let package = root.join(package);
        let manifest = fs::read_to_string(package.join("Cargo.toml")).expect("Cargo.toml");
        let manifest: toml::Table = manifest.parse().expect("TOML");
        let mut paths = Vec::new();
        for folder in folders {
            sources(&package.join(folder), &mut paths);
        }
        let read = |path: &PathBuf| fs::read_to_string(path).expect("a source");
        let all: Vec<String> = paths.iter().map(read).collect();
        let named = |name: &str| {
            let uses = [format!("{name}::"), format!("use {name};")];
            let of = |text: &String| uses.iter().any(|u| text.contains(u.as_str()));
            all.iter().any(of)
        };
        for table in ["dependencies", "dev-dependencies"] {
            let listed = manifest[table].as_table().expect("a table");
            for name in listed.keys() {
                let name = name.replace('-', "_");
                assert!(
                    named(&name),
                    "{}: {name} is listed in [{table}] and not used",
                    package.display()
                );
            }
        }
    }
}
