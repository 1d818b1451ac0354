//! Ctrl-C, and two runs into one folder.

use std::fs;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use super::{RUN, campaign, hidden, outputs, program};
use crate::support::Lab;

/// Wait until a run has its folder.
fn wait_for_lock(lab: &Lab) {
    let begin = Instant::now();
    while !lab.path("out/.impactid.lock").exists() && begin.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_second_run_into_the_same_folder_is_refused() {
    let lab = campaign(66);
    let mut first = program(&lab, RUN).spawn().expect("the program starts");
    wait_for_lock(&lab);
    let second = lab.run(RUN);
    let stage = lab.run(&["-q", "classify", "out"]);
    let still_running = first.try_wait().expect("its state").is_none();
    first.wait().expect("it ends");
    assert!(still_running, "the first run ended too soon to be met");
    for ran in [second, stage] {
        assert_eq!(ran.code, 2);
        assert!(
            ran.said.contains("another run of impactid writes into out"),
            "{}",
            ran.said
        );
    }
    assert!(hidden(&lab.path("out")).is_empty());
    assert!(outputs(&lab.path("out")).contains_key("report.pdf"));
}

fn spoken(mut run: Child) -> (String, Option<i32>) {
    let mut said = String::new();
    let words = run.stderr.as_mut().expect("its words");
    std::io::Read::read_to_string(words, &mut said).expect("text");
    (said, run.wait().expect("it ends").code())
}

#[cfg(unix)]
#[test]
fn ctrl_c_is_reported_ends_with_130_and_loses_nothing() {
    let lab = campaign(66);
    fs::create_dir(lab.path("out")).expect("a folder");
    lab.write("out/report.pdf", "the report of yesterday");
    for signal in ["-INT", "-TERM"] {
        let run = Command::new(env!("CARGO_BIN_EXE_impactid"))
            .args(["run", "campaign.toml", "--out", "out"])
            .current_dir(lab.folder())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts");
        wait_for_lock(&lab);
        std::thread::sleep(Duration::from_millis(150));
        let id = run.id().to_string();
        let sent = Command::new("kill").args([signal, &id]).status();
        assert!(sent.expect("kill").success());
        let (said, code) = spoken(run);
        assert_eq!(code, Some(130), "{said}");
        assert!(
            said.contains("interrupted") && said.contains("--resume"),
            "{said}"
        );
        assert_eq!(lab.read("out/report.pdf"), "the report of yesterday");
        let parts = hidden(&lab.path("out"));
        assert!(parts.iter().all(|p| !p.contains("part")), "{parts:?}");
    }
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_no_file_of_a_folder_that_is_being_written() {
    let lab = campaign(66);
    fs::create_dir(lab.path("tables")).expect("a folder");
    lab.write("tables/other.csv", "of another program");
    let run = Command::new(env!("CARGO_BIN_EXE_impactid"))
        .args(["convert", "records.h5", "--out", "tables/day.csv"])
        .current_dir(lab.folder())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let begin = Instant::now();
    let started = || {
        let parts = hidden(&lab.path("tables"));
        parts.iter().any(|p| p.contains("part"))
    };
    while !started() && begin.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(1));
    }
    let id = run.id().to_string();
    let sent = Command::new("kill").args(["-INT", &id]).status();
    assert!(sent.expect("kill").success());
    let (said, code) = spoken(run);
    assert_eq!(code, Some(130), "{said}");
    assert!(
        said.contains("interrupted") && !said.contains("could not"),
        "{said}"
    );
    let left = outputs(&lab.path("tables"));
    assert_eq!(left.keys().collect::<Vec<_>>(), ["other.csv"]);
    assert!(hidden(&lab.path("tables")).is_empty());
    // the same command starts again
    let again = lab.run(&["-q", "convert", "records.h5", "--out", "tables/day.csv"]);
    assert_eq!(again.code, 0, "{}", again.said);
    assert_eq!(outputs(&lab.path("tables/day")).len(), 66);
}
