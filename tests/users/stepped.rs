//! A campaign as a recorder leaves it that runs all day: a file for each sweep, in which the drive waits at one frequency after
//! another. Cut with `convert --cut`, from there to the answer.

use std::fmt::Write as _;
use std::fs;

use super::rig::{RATE_HZ, Take, assert_the_answer_is_true, done, state, takes};
use crate::support::Lab;

/// Columns of the simulated rig, their heads as saved, and the factors from V.
const COLUMNS: [(&str, &str, f64); 4] = [
    ("generator", "Generator (V)", 1.0),
    ("contact", "Contact (V)", 1.0),
    ("laser_x", "Laser x (m/s)", 0.2),
    ("integrator_vy", "Velocity y (m/s)", 0.2),
];

/// The records of a sweep one after the other, on one time.
fn saved(sweep: &[&Take]) -> String {
    let titles = COLUMNS.map(|c| c.1).join(",");
    let mut text = format!("Time (s),{titles}\n");
    let mut row = 0;
    for take in sweep {
        let columns = COLUMNS.map(|(name, _, factor)| take.channel(name, factor));
        for i in 0..columns[0].len() {
            let _ = write!(text, "{:.4}", f64::from(row) / RATE_HZ);
            for column in &columns {
                let _ = write!(text, ",{:.6}", column[i]);
            }
            text.push('\n');
            row += 1;
        }
    }
    text
}

#[test]
fn valid_sweeps_in_one_file_each_are_cut_and_identified() {
    let lab = Lab::new();
    let rig = [
        "--rig",
        "exact",
        "--seed",
        "52",
        "--records",
        "60",
        "--natural-frequency-hz",
        "25",
    ];
    let takes = takes(&lab, &rig);
    let alike = |a: &Take, b: &Take| a.clearance_mm == b.clearance_mm && a.upward == b.upward;
    fs::create_dir(lab.path("raw")).expect("room");
    for (k, sweep) in takes.chunk_by(alike).enumerate() {
        let raw = format!("raw/sweep{k}.csv");
        fs::write(lab.path(&raw), saved(&sweep.iter().collect::<Vec<_>>())).expect("room");
        let clearance = format!("clearance_m={}e-3", sweep[0].clearance_mm);
        let out = format!("day/sweep{k}.csv");
        let said = done(
            &lab,
            &[
                "convert",
                &raw,
                "--cut",
                "Generator",
                "--set",
                &clearance,
                "--out",
                &out,
            ],
        );
        assert!(
            said.contains(&format!("cut into {} record", sweep.len())),
            "{said}"
        );
    }
    done(&lab, &["init", "day"]);
    state(&lab, "Velocity y", "high_pass = \"0.5 Hz\"");
    assert_the_answer_is_true(&lab, takes.len());
}

#[test]
fn a_record_of_many_settings_names_the_way_to_cut_it() {
    let lab = Lab::new();
    let takes = takes(
        &lab,
        &[
            "--rig",
            "exact",
            "--seed",
            "52",
            "--records",
            "12",
            "--natural-frequency-hz",
            "25",
        ],
    );
    let all = saved(&takes.iter().collect::<Vec<_>>());
    fs::write(lab.path("day/all.csv"), all).expect("room");
    let said = done(&lab, &["init", "day"]);
    let words = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words.contains("impactid convert all.csv --cut 'Generator' --out"),
        "{said}"
    );
    let checked = lab.run(&["check", "day/campaign.toml"]);
    assert_eq!(checked.code, 2, "{}", checked.said);
    assert!(
        checked.said.contains("impactid convert FILE --cut CHANNEL"),
        "{}",
        checked.said
    );
    let refused = lab.run(&[
        "convert",
        "day/all.csv",
        "--cut",
        "Generatr",
        "--out",
        "cut.csv",
    ]);
    assert_eq!(refused.code, 2);
    assert!(
        refused.said.contains("one of Time, Generator"),
        "{}",
        refused.said
    );
}
