//! Runs that are broken off, run twice, or cannot write: nothing half-written under a final
//! name, nothing lost that was there, and the same bytes in the end.

mod changing_inputs;
mod disk;
mod everywhere;
mod kills;
mod signals;
mod threads;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::support::Lab;

/// A synthetic campaign of so many records in a folder of its own.
fn campaign(records: usize) -> Lab {
    let lab = Lab::new();
    let records = records.to_string();
    let made = lab.run(&[
        "-q",
        "simulate",
        "campaign",
        "--seed",
        "7",
        "--records",
        &records,
        "--force",
        "--out",
        ".",
    ]);
    assert_eq!(made.code, 0, "{}", made.said);
    lab
}

fn program(lab: &Lab, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_impactid"));
    command
        .args(args)
        .current_dir(lab.folder())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command
}

/// All files in a folder and below that bear a final name, with their bytes.
fn outputs(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    let Ok(entries) = fs::read_dir(folder) else {
        return all;
    };
    for entry in entries.filter_map(Result::ok) {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with('.') {
            continue;
        }
        if entry.path().is_dir() {
            let below = outputs(&entry.path());
            all.extend(below.into_iter().map(|(n, b)| (format!("{name}/{n}"), b)));
        } else if let Ok(bytes) = fs::read(entry.path()) {
            all.insert(name, bytes);
        }
    }
    all
}

/// Names of hidden files in a folder and below.
fn hidden(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut all = Vec::new();
    for entry in entries.filter_map(Result::ok) {
        let name = entry.file_name().to_string_lossy().into_owned();
        if name.starts_with('.') {
            all.push(name);
        } else if entry.path().is_dir() {
            all.extend(hidden(&entry.path()));
        }
    }
    all
}

fn assert_same(found: &BTreeMap<String, Vec<u8>>, expected: &BTreeMap<String, Vec<u8>>) {
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(found), names(expected));
    for (name, bytes) in found {
        assert!(bytes == &expected[name], "{name} differs");
    }
}

const RUN: &[&str] = &["-q", "run", "campaign.toml", "--out", "out"];
