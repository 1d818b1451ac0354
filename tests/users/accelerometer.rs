//! A campaign with an accelerometer: one mass against a stop, a CSV file a record, all voltages in mV as the amplifier gives
//! them. From `init` to the report.

use std::fmt::Write as _;
use std::fs;

use super::rig::{RATE_HZ, Take, assert_the_answer_is_true, done, state, takes};
use crate::support::Lab;

/// A g in m/s², and the accelerometer's sensitivity.
const G_M_S2: f64 = 9.80665;
const MV_A_G: f64 = 100.0;

/// Noise of the accelerometer, mV, from a row of numbers without a period.
fn noise(i: usize, record: usize) -> f64 {
    0.3 * ((i * i + 31 * record) as f64 * 2.399_963).sin()
}

/// A record: the load cell, the contact, and the mean acceleration from one sample to the next, as a filter before the
/// converter leaves it.
fn saved(take: &Take, number: usize) -> String {
    let velocity = take.channel("laser_x", 0.1);
    let drive = take.channel("generator", 1000.0);
    let contact = take.channel("contact", 1000.0);
    let mut text = String::from("time (s),load cell (mV),contact (mV),acceleration (mV)\n");
    for i in 0..velocity.len() - 1 {
        let acceleration = (velocity[i + 1] - velocity[i]) * RATE_HZ;
        let millivolts = acceleration / G_M_S2 * MV_A_G + noise(i, number);
        let middle = |c: &[f64]| 0.5 * (c[i] + c[i + 1]);
        let _ = writeln!(
            text,
            "{:.5},{:.4},{:.2},{millivolts:.4}",
            (i as f64 + 0.5) / RATE_HZ,
            middle(&drive),
            middle(&contact),
        );
    }
    text
}

#[test]
fn valid_an_accelerometer_in_millivolts_from_init_to_the_report() {
    let lab = Lab::new();
    let rig = ["--ideal", "--seed", "54", "--records", "60"];
    let truth = ["--restitution", "0.6", "--damping-ratio", "0.04"];
    let more = [
        "--natural-frequency-hz",
        "12",
        "--static-deflection-m",
        "0.0003",
    ];
    let takes = takes(&lab, &[&rig[..], &truth, &more].concat());
    let mut book = String::from("file,frequency (Hz),gap (mm),sweep\n");
    for (number, take) in takes.iter().enumerate() {
        let name = format!("run{number:02}.csv");
        fs::write(lab.path(&format!("day/{name}")), saved(take, number)).expect("room");
        let way = if take.upward { "up" } else { "down" };
        let _ = writeln!(
            book,
            "{name},{},{},{way}",
            take.frequency_hz, take.clearance_mm
        );
    }
    fs::write(lab.path("day/runs.csv"), book).expect("room");
    done(&lab, &["init", "day"]);
    let written = lab.read("day/campaign.toml");
    assert!(written.contains("machine = \"single\""), "{written}");
    assert!(written.contains("channel = \"load cell\""), "{written}");
    // what the user knows and no file states
    state(&lab, "acceleration", "scale = \"100 mV/g\"");
    assert_the_answer_is_true(&lab, 60);
}
