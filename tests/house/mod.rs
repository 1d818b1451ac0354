//! The rules of the layout that cargo cannot keep.

mod circles;
mod dependencies;
mod licences;
mod links;
mod methods;
mod signatures;
mod sources;
mod systems;

use std::fs;
use std::path::PathBuf;

use sources::{SourceFile, all_sources, packages, root, rust_files};

/// The modules of a package in order: a module never imports from one after it.
const MODULES: [(&str, &[&str]); 5] = [
    ("impact-oscillator", &["model", "parallel", "atlas"]),
    (
        "impact-records",
        &["language", "message", "signal", "record", "event", "motion"],
    ),
    ("impact-identification", &["identify", "compare", "replay"]),
    ("impact-campaign", &["campaign", "pipeline"]),
    (
        "impact-workbench",
        &[
            "figures", "theory", "coverage", "pairs", "selftest", "explore",
        ],
    ),
];

/// The packages in order: a package uses only those before it.
const PACKAGES: [&str; 11] = [
    "labfiles",
    "labfiles-write",
    "impact-oscillator",
    "impact-records",
    "simulated-rig",
    "impact-fit",
    "impact-identification",
    "impact-report",
    "impact-campaign",
    "impact-workbench",
    "impactid",
];

#[test]
fn a_package_uses_only_packages_before_it() {
    let folders = packages();
    assert_eq!(folders.len(), PACKAGES.len());
    for (number, package) in PACKAGES.iter().enumerate() {
        let manifest =
            fs::read_to_string(folders[*package].join("Cargo.toml")).expect("a manifest");
        let manifest: toml::Table = manifest.parse().expect("TOML");
        let listed = manifest["dependencies"].as_table().expect("a table");
        for name in listed.keys() {
            let other = PACKAGES.iter().position(|p| p == name);
            assert!(other.is_none_or(|o| o < number), "{package} uses {name}");
        }
    }
}

#[test]
fn no_module_imports_from_one_after_it() {
    let mut faults = Vec::new();
    for (package, modules) in MODULES {
        let of_package = all_sources().into_iter().filter(|f| f.package == package);
        for file in of_package {
            let place = |name: &str| modules.iter().position(|m| *m == name);
            let Some(own) = place(file.top()) else {
                assert_eq!(file.module, "", "{} is in no module", file.place());
                continue;
            };
            let lines = file
                .text
                .lines()
                .filter(|l| !l.trim_start().starts_with("//"));
            for after in lines.flat_map(|l| l.split("crate::").skip(1)) {
                let name = after
                    .split(|c: char| !c.is_alphanumeric() && c != '_')
                    .next();
                if name.and_then(place).is_some_and(|other| other > own) {
                    faults.push(format!("{} imports from {name:?}", file.place()));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Lines of a file that are no comment.
fn code_lines(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|l| !l.trim_start().starts_with("//"))
}

/// The report formats what it is given: it names neither the model nor what computes with it.
#[test]
fn the_report_computes_nothing() {
    let computing = [
        "impact_oscillator",
        "impact_records::event",
        "simulated_rig",
        "impact_fit::evidence",
        "impact_fit::solver",
        "identify::replay",
    ];
    // the names of the parameters and of the effects
    let named = [
        "impact_fit::parameters::Coordinate",
        "impact_fit::parameters::effect::Effect",
    ];
    for file in all_sources()
        .iter()
        .filter(|f| f.package == "impact-report")
    {
        for line in code_lines(&file.text) {
            let line = named.iter().fold(line.to_owned(), |l, n| l.replace(n, ""));
            let found = computing.iter().find(|c| line.contains(**c));
            assert!(found.is_none(), "{}: {line}", file.place());
        }
    }
}

/// The kit of the figures knows no campaign and no result.
#[test]
fn the_kit_knows_no_campaign() {
    let foreign = [
        "impact_fit",
        "impact_identification",
        "crate::content",
        "crate::figures",
        "crate::document",
        "crate::parameters",
        "impact_records::record",
        "impact_records::event",
    ];
    let kit = |f: &&SourceFile| f.package == "impact-report" && f.top() == "kit";
    let sources = all_sources();
    assert!(sources.iter().filter(kit).count() > 10);
    for file in sources.iter().filter(kit) {
        for line in code_lines(&file.text) {
            let found = foreign.iter().find(|c| line.contains(**c));
            assert!(found.is_none(), "{}: {line}", file.place());
        }
    }
}

#[test]
fn the_crates_and_modules_are_those_of_architecture_md() {
    let page = fs::read_to_string(root().join("ARCHITECTURE.md")).expect("ARCHITECTURE.md");
    let rows = page.lines().filter_map(|line| line.strip_prefix("| `"));
    let listed: Vec<&str> = rows.filter_map(|row| row.split('`').next()).collect();
    let crates: Vec<&str> = PACKAGES.to_vec();
    let found: Vec<&str> = listed
        .iter()
        .copied()
        .filter(|n| crates.contains(n))
        .collect();
    assert_eq!(found, crates, "the table of crates in ARCHITECTURE.md");
    let modules = MODULES
        .iter()
        .filter(|(package, _)| *package != "impact-oscillator");
    let modules: Vec<&str> = modules
        .flat_map(|(_, modules)| modules.iter().copied())
        .collect();
    let found: Vec<&str> = listed
        .iter()
        .copied()
        .filter(|n| modules.contains(n))
        .collect();
    assert_eq!(found, modules, "the table of modules in ARCHITECTURE.md");
}

/// Whether a file is a module that only tests see.
fn for_tests_alone(file: &SourceFile, all: &[SourceFile]) -> bool {
    let stem = file.module.rsplit("::").next().unwrap_or("");
    let declared = ["mod", "pub mod"].map(|m| format!("#[cfg(test)]\n{m} {stem};"));
    let of_package = all.iter().filter(|f| f.package == file.package);
    let mut texts = of_package.map(|f| &f.text);
    texts.any(|text| declared.iter().any(|d| text.contains(d)))
}

#[test]
fn only_the_command_line_prints_or_exits() {
    let printing = [
        "println!",
        "eprintln!",
        "print!(",
        "eprint!(",
        "process::exit",
        "dbg!",
    ];
    let all = all_sources();
    for file in &all {
        if file.package == "impactid" || for_tests_alone(file, &all) {
            continue;
        }
        let code = file.text.split("#[cfg(test)]").next().unwrap_or("");
        for line in code_lines(code) {
            let found = printing.iter().find(|p| line.contains(**p));
            assert!(found.is_none(), "{} prints or exits: {line}", file.place());
        }
    }
}

/// No network but loopback: sockets are opened in `explore` alone, and only on 127.0.0.1; its page names
/// no other address.
#[test]
fn sockets_are_opened_on_loopback_alone_and_only_by_the_explorer() {
    let sockets = ["TcpListener", "TcpStream", "UdpSocket", "axum", "tokio::"];
    let mut binds = 0;
    for file in all_sources() {
        let explorer = file.package == "impact-workbench" && file.top() == "explore";
        let code = file.text.split("#[cfg(test)]").next().unwrap_or("");
        for line in code_lines(code) {
            let used = sockets.iter().any(|s| line.contains(s));
            assert!(!used || explorer, "{}: {line}", file.place());
            if line.contains("::bind(") && line.contains("TcpListener") {
                binds += 1;
                assert!(
                    line.contains("Ipv4Addr::LOCALHOST"),
                    "{}: {line}",
                    file.place()
                );
            }
            assert!(!line.contains("::connect("), "{}: {line}", file.place());
        }
    }
    assert_eq!(binds, 1);
    let page = root().join("crates/impact-workbench/src/explore/page");
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

/// Within a package a foreign crate has one module.
#[test]
fn a_foreign_crate_is_used_in_its_module_alone() {
    let homes = [
        ("rustfft", "impact-records", "signal"),
        ("argmin", "impact-fit", "solver"),
        ("plotters", "impact-report", "kit"),
        ("axum", "impact-workbench", "explore"),
        ("hyper", "impact-workbench", "explore"),
        ("hyper_util", "impact-workbench", "explore"),
        ("tokio", "impact-workbench", "explore"),
        ("futures_util", "impact-workbench", "explore"),
    ];
    for file in all_sources() {
        for (foreign, package, module) in homes {
            let used = |l: &str| l.trim_start().starts_with(&format!("use {foreign}::"));
            let uses = file.text.lines().any(used);
            let home = file.package == package && file.top() == module;
            assert!(!uses || home, "{} uses {foreign}", file.place());
        }
    }
}

/// What is built is used: a library in Cargo.toml that no source names only costs time.
#[test]
fn every_dependency_is_used() {
    for (package, folder) in packages() {
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).expect("Cargo.toml");
        let manifest: toml::Table = manifest.parse().expect("TOML");
        let mut paths: Vec<PathBuf> = Vec::new();
        for part in ["src", "tests", "benches"] {
            rust_files(&folder.join(part), &mut paths);
        }
        let read = |path: &PathBuf| fs::read_to_string(path).expect("a source");
        let mut all: Vec<String> = paths.iter().map(read).collect();
        all.extend(fs::read_to_string(folder.join("README.md")));
        let named = |name: &str| {
            let uses = [format!("{name}::"), format!("use {name};")];
            let of = |text: &String| uses.iter().any(|u| text.contains(u.as_str()));
            all.iter().any(of)
        };
        for table in ["dependencies", "dev-dependencies"] {
            let listed = manifest.get(table).and_then(toml::Value::as_table);
            for name in listed.into_iter().flat_map(toml::Table::keys) {
                let name = name.replace('-', "_");
                assert!(
                    named(&name),
                    "{package}: {name} is listed in [{table}] and not used"
                );
            }
        }
    }
}

/// The layers of the fits and of what is concluded from them, in order: a unit (a file or a folder of `impact-fit`,
/// or of `identify` in `impact-identification`) imports only from those before it.
const LAYERS: [(&str, &str, &[&str]); 2] = [
    (
        "impact-fit",
        "",
        &[
            "method",
            "parameters",
            "solver",
            "statistics",
            "evidence",
            "messages",
            "method_fit",
            "estimate",
            "methods",
        ],
    ),
    (
        "impact-identification",
        "identify::",
        &[
            "plan",
            "replay",
            "residuals",
            "restated",
            "uncertainty",
            "identification",
            "first_values",
            "published",
            "diagnostics",
            "results",
            "widening",
            "run",
            "boundary_plan",
        ],
    ),
];

#[test]
fn a_layer_of_the_identification_imports_only_from_those_before_it() {
    let sources = all_sources();
    for (package, folder, layers) in LAYERS {
        let files: Vec<_> = sources.iter().filter(|f| f.package == package).collect();
        let unit = |module: &str| {
            let unit = module.strip_prefix(folder)?.split("::").next()?;
            (!unit.is_empty()).then(|| unit.to_owned())
        };
        let layer = |unit: &str| layers.iter().position(|l| *l == unit);
        // what uses all layers, and what only tests see
        let beyond = ["specimens", "fixture", "tests"];
        for (module, imported) in sources::Imports::new(&files).of {
            let Some(own) = unit(&module).filter(|u| !beyond.contains(&u.as_str())) else {
                continue;
            };
            let number = layer(&own);
            assert!(number.is_some(), "{own} is in no layer");
            for other in imported.iter().filter_map(|m| unit(m)) {
                assert!(
                    layer(&other) <= number && layer(&other).is_some(),
                    "{module} imports {other}"
                );
            }
        }
    }
}
