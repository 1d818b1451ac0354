//! The same input gives the same bytes on any number of threads, for everything that is written.

use std::fs;

use super::{assert_same, campaign, outputs};

/// Run a command on 1, 2 and 4 threads; what it leaves in `out`, and what it says, is the same.
fn same_on_any_number_of_threads(lab: &crate::support::Lab, command: &[&str]) {
    same_on(&["1", "2", "4"], lab, command);
}

/// Run a command on so many threads each time.
fn same_on(threads: &[&str], lab: &crate::support::Lab, command: &[&str]) {
    let run = |threads: &str| {
        let mut args = vec!["-q", "--threads", threads];
        args.extend(command);
        let ran = lab.run(&args);
        assert!(ran.code == 0 || ran.code == 1, "{command:?}: {}", ran.said);
        let out = lab.path("out");
        let files = outputs(&out);
        if out.exists() {
            fs::remove_dir_all(&out).expect("the outputs");
        }
        assert!(!files.is_empty() || !ran.said.is_empty(), "{command:?}");
        (ran.said, files)
    };
    let (said, expected) = run(threads[0]);
    for threads in &threads[1..] {
        let (again, files) = run(threads);
        assert_eq!(again, said, "{command:?} on {threads} threads");
        assert_same(&files, &expected);
    }
}

#[test]
fn a_run_with_every_format() {
    let lab = campaign(12);
    let run = ["run", "campaign.toml", "--out", "out", "--format"];
    let documents = [&run[..], &["pdf,html,svg"]].concat();
    same_on_any_number_of_threads(&lab, &documents);
    // the development profile takes long to draw pixels
    let pixels = [&run[..], &["png"]].concat();
    same_on(&["1", "4"], &lab, &pixels);
}

#[test]
fn a_run_that_keeps_observations_on_the_way() {
    let lab = campaign(66);
    let run = ["run", "campaign.toml", "--out", "out", "--format", "csv"];
    same_on_any_number_of_threads(&lab, &run);
}

#[test]
fn stages_and_conversions() {
    let lab = campaign(8);
    for command in [
        &["ingest", "campaign.toml", "--out", "out"][..],
        &["convert", "records.h5", "--out", "out/a.h5"],
        &["convert", "records.h5", "--out", "out/a.parquet"],
        &["convert", "records.h5", "--out", "out/a.csv"],
        &["inspect", "records.h5", "--json"],
        &["check", "campaign.toml"],
    ] {
        if command[0] == "convert" {
            // the folder goes with every run
            for threads in ["1", "2", "4"] {
                fs::create_dir_all(lab.path("out")).expect("a folder");
                let mut args = vec!["-q", "--threads", threads];
                args.extend(command);
                assert_eq!(lab.run(&args).code, 0, "{command:?}");
                fs::rename(lab.path("out"), lab.path(threads)).expect("a folder");
            }
            let first = outputs(&lab.path("1"));
            assert!(!first.is_empty());
            for threads in ["2", "4"] {
                assert_same(&outputs(&lab.path(threads)), &first);
            }
            for threads in ["1", "2", "4"] {
                fs::remove_dir_all(lab.path(threads)).expect("the outputs");
            }
        } else if command[0] == "check" {
            let said = |threads| {
                lab.run(&["--threads", threads, "check", "campaign.toml"])
                    .said
            };
            assert_eq!(said("1"), said("4"));
        } else {
            same_on_any_number_of_threads(&lab, command);
        }
    }
    same_stages(&lab);
}

/// `classify`, `identify` and `report`, one after the other, on 1, 2 and 4 threads.
fn same_stages(lab: &crate::support::Lab) {
    let all = |threads: &str| {
        for stage in [
            &["ingest", "campaign.toml", "--out", "out"][..],
            &["classify", "out"],
            &["identify", "out"],
            &["report", "out", "--format", "html"],
        ] {
            let mut args = vec!["-q", "--threads", threads];
            args.extend(stage);
            let ran = lab.run(&args);
            assert!(ran.code < 2, "{stage:?}: {}", ran.said);
        }
        let files = outputs(&lab.path("out"));
        fs::remove_dir_all(lab.path("out")).expect("the outputs");
        files
    };
    let expected = all("1");
    for threads in ["2", "4"] {
        assert_same(&all(threads), &expected);
    }
}

#[test]
fn simulated_campaigns_and_theory() {
    let lab = crate::support::Lab::new();
    let simulate = ["simulate", "campaign", "--records", "30", "--out", "out"];
    same_on_any_number_of_threads(&lab, &simulate);
    let realistic = [&simulate[..], &["--rig", "realistic"]].concat();
    same_on_any_number_of_threads(&lab, &realistic);
    let said = |threads| lab.run(&["--threads", threads, "selftest"]).said;
    let expected = said("1");
    assert!(expected.contains("published"), "{expected}");
    for threads in ["2", "4"] {
        assert_eq!(said(threads), expected);
    }
    let map = [
        "atlas",
        "--eta",
        "0.8..2.4",
        "--rho",
        "0.2..2",
        "--columns",
        "12",
        "--rows",
        "8",
        "--out",
        "out",
    ];
    same_on_any_number_of_threads(&lab, &map);
}

#[test]
fn sweeps_basins_and_replayed_studies() {
    let lab = crate::support::Lab::new();
    let short = "--settle-periods 40 --watch-periods 15";
    for command in [
        format!("sweep --eta 0.9..1.2 --rho 1 --steps 9 --drive-ratio 0.9 {short} --out out"),
        format!(
            "basins --eta 1.4 --rho 2 --x=-6..2 --vx=-6..6 --columns 7 --rows 9 --mass-ratio 1.1 {short} --out out"
        ),
        "atlas --eta 0.7..1.3 --rho=-1.2..1.4 --columns 7 --rows 6 --restitution 0.6 \
         --drive-ratio 0.9 --largest-p 2 --largest-n 2 --out out"
            .to_owned(),
    ] {
        let words: Vec<&str> = command.split_whitespace().collect();
        same_on_any_number_of_threads(&lab, &words);
    }
    std::fs::write(lab.path("mine.toml"), STUDY).expect("a study");
    same_on_any_number_of_threads(&lab, &["study", "mine.toml", "--out", "out"]);
}

/// Every kind of work that a study may hold.
const STUDY: &str = r#"
title = "all kinds"
damping_ratio = 0.07
restitution = 0.7

[time_series.motion]
setting = { frequency_ratio = 0.95, clearance = 0.7 }
start = { x = -1.0, vx = 1.5, y = -3.0, vy = 2.5 }
periods = 4

[sweep.there]
eta = [0.9, 1.3]
rho = [1.0, 1.0]
steps = 9
watch = { settle_periods = 40, watch_periods = 15 }

[basins.starts]
setting = { frequency_ratio = 1.4, clearance = 2.0 }
grid = { x = [-4.0, 2.0, 5], vx = [-4.0, 4.0, 7], starts = "both_masses" }
watch = { settle_periods = 40, watch_periods = 15 }

[regions.plane]
eta = [0.8, 1.6, 7]
rho = [-1.2, 2.0, 6]
largest_p = 2
largest_n = 2
"#;
