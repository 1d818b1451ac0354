//! What a new user does: the commands of the tutorial as written, the script that reads the
//! results, the manual pages and the shell completions.

mod accelerometer;
mod experiments;
mod heights;
mod labview;
mod loggers;
mod matlab;
mod odd_tables;
mod one_of_two;
mod riders;
mod rig;
mod stepped;
mod trials;
mod workbook;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::Lab;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The fenced blocks of a document, each with its language.
fn blocks(document: &str) -> Vec<(&str, &str)> {
    let fenced = document.split("```").skip(1).step_by(2);
    fenced.filter_map(|block| block.split_once('\n')).collect()
}

/// The commands of a document that this system's shell runs: those of `sh`, and of one that stands there twice that of the
/// system.
fn scripts(document: &str) -> Vec<&str> {
    let all = blocks(document);
    let follows = |at: usize| all.get(at + 1).is_some_and(|b| b.0 == "powershell");
    let is_ours = |at: &usize| match all[*at].0 {
        "sh" => cfg!(unix) || !follows(*at),
        language => cfg!(windows) && language == "powershell",
    };
    let ours = (0..all.len()).filter(is_ours);
    ours.map(|at| all[at].1).collect()
}

/// A script for the shell that a user of this system types into; it ends at the first fault.
#[cfg(unix)]
fn typed(script: &str) -> Command {
    let mut shell = Command::new("sh");
    shell.args(["-e", "-c", script]);
    shell
}

/// A script for the shell that a user of this system types into; it ends at the first fault.
#[cfg(windows)]
fn typed(script: &str) -> Command {
    let mut shell = Command::new("powershell");
    let script = format!("$ErrorActionPreference = 'Stop'\n{script}\nexit $LASTEXITCODE");
    shell.args(["-NoProfile", "-Command", &script]);
    shell
}

/// Run a script in a folder with the program on the path; what it printed.
fn shell(folder: &Path, script: &str) -> String {
    let program = Path::new(env!("CARGO_BIN_EXE_impactid"));
    let here = program.parent().expect("a folder").to_path_buf();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::iter::once(here).chain(std::env::split_paths(&path));
    let output = typed(script)
        .current_dir(folder)
        .env("PATH", std::env::join_paths(path).expect("a path"))
        .output()
        .expect("a shell");
    let said = String::from_utf8_lossy(&output.stdout).into_owned()
        + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{script}\n{said}");
    said
}

/// A Python that has numpy and polars or pandas: `IMPACTID_PYTHON`, else the usual names.
fn python() -> Option<String> {
    let named = std::env::var("IMPACTID_PYTHON").ok();
    let usual = ["python3", "python"].map(String::from);
    named.into_iter().chain(usual).find(|python| {
        ["import numpy, polars", "import numpy, pandas, pyarrow"]
            .iter()
            .any(|c| {
                let tried = Command::new(python).args(["-c", c]).output();
                tried.is_ok_and(|o| o.status.success())
            })
    })
}

#[test]
fn the_tutorial_runs_as_written_and_its_results_are_read() {
    let tutorial = fs::read_to_string(root().join("docs/tutorial.md")).expect("the tutorial");
    let lab = tempfile::tempdir().expect("a temporary folder");
    let mut campaigns = blocks(&tutorial);
    campaigns.retain(|block| block.0 == "toml");
    let [(_, campaign)] = campaigns[..] else {
        panic!("one campaign.toml")
    };
    for script in scripts(&tutorial) {
        // the user fills campaign.toml in before it is checked
        if script.contains("impactid check") {
            fs::write(lab.path().join("day1/campaign.toml"), campaign).expect("room");
        }
        let said = shell(lab.path(), script);
        if script.contains("impactid check") {
            assert!(said.contains("40 of 40 records can be used"), "{said}");
        }
    }
    for name in ["report.pdf", "report.html", "identification.json"] {
        assert!(lab.path().join("results").join(name).exists(), "{name}");
    }
    read_with_python(lab.path());
}

/// `python/examples/read_results.py` reads all that the run left.
fn read_with_python(folder: &Path) {
    let Some(python) = python() else {
        println!("skipped: no Python with numpy and polars or pandas (IMPACTID_PYTHON names one)");
        return;
    };
    let script = root().join("python/examples/read_results.py");
    let output = Command::new(python)
        .arg(script)
        .arg("results")
        .current_dir(folder)
        .env("PYTHONPATH", root().join("python"))
        .env("IMPACTID_PROGRAM", env!("CARGO_BIN_EXE_impactid"))
        .output()
        .expect("it starts");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    for words in [
        "records: 40 rows",
        "impacts: ",
        "boundaries: ",
        "map: ",
        "restitution: 0.",
        "campaign.resolved.json: 40 records",
    ] {
        assert!(said.contains(words), "{words} is not in {said}");
    }
    let drawn = folder.join("results/records.png").exists();
    assert!(drawn || said.contains("matplotlib is not installed"));
}

#[test]
fn every_command_has_a_page_and_completions() {
    let lab = Lab::new();
    assert_eq!(lab.run(&["-q", "man", "--out", "man"]).code, 0);
    let pages: Vec<String> = fs::read_dir(lab.path("man"))
        .expect("pages")
        .map(|e| e.expect("an entry").file_name().to_string_lossy().into())
        .collect();
    let help = lab.run(&["--help"]).said;
    let verbs = help.split("Commands:").nth(1).expect("verbs");
    let verbs = verbs.split("Options:").next().expect("verbs");
    let verbs: Vec<&str> = verbs
        .lines()
        .filter_map(|l| l.strip_prefix("  ")?.split(' ').next())
        .filter(|v| !v.is_empty() && *v != "help" && v.chars().all(|c| c.is_ascii_lowercase()))
        .collect();
    assert!(verbs.len() >= 15, "{verbs:?}");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let said = lab.run(&["completions", shell]).said;
        for verb in &verbs {
            assert!(said.contains(verb), "{shell} completes no {verb}");
        }
    }
    for verb in &verbs {
        let page = format!("impactid-{verb}.1");
        assert!(pages.contains(&page), "{page} is not among {pages:?}");
        let text = lab.read(&format!("man/{page}"));
        assert!(
            text.contains(".SH NAME") && text.contains("Example"),
            "{page}"
        );
    }
}

/// On a terminal errors are coloured, unless `NO_COLOR` is set.
#[cfg(target_os = "linux")]
#[test]
fn no_color_is_heeded_on_a_terminal() {
    let lab = Lab::new();
    let program = env!("CARGO_BIN_EXE_impactid");
    let spoken = |no_color: Option<&str>| {
        let mut command = Command::new("script");
        let typed = format!("{program} check missing.toml");
        command.args(["-qec", &typed, "/dev/null"]);
        command.current_dir(lab.folder()).env_remove("NO_COLOR");
        if let Some(value) = no_color {
            command.env("NO_COLOR", value);
        }
        let output = command.output().ok()?;
        Some(String::from_utf8_lossy(&output.stdout).into_owned())
    };
    let Some(coloured) = spoken(None).filter(|s| s.contains("missing.toml")) else {
        println!("skipped: the program `script` is not installed");
        return;
    };
    assert!(coloured.contains('\u{1b}'), "{coloured:?}");
    let plain = spoken(Some("1")).expect("as before");
    assert!(!plain.contains('\u{1b}'), "{plain:?}");
}
