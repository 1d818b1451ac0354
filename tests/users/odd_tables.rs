//! Tables as people keep them, from `init` to the answer: headings that come again, rows that sum up, tables on their side,
//! overloads, laps, clocks in several columns.

use std::fmt::Write as _;

use crate::users::experiments::{Folder, holds};

const R: f64 = 0.78;
const F0_HZ: f64 = 1.7;
const BETA: f64 = 0.02;

fn folder(text: &str) -> Folder {
    Folder::of(&[("table.csv".to_owned(), text.as_bytes().to_vec())])
}

/// A drop and its rebound, cm, read to a millimetre.
fn drop_cm(k: usize) -> [f64; 2] {
    let height = 40.0 + 10.0 * (k % 7) as f64;
    let error = 0.3 * (k as f64 * 2.399_963).sin();
    [height, ((R * R * height + error) * 10.0).round() / 10.0]
}

fn holds_r(text: &str) -> serde_json::Value {
    let found = folder(text).play();
    assert!(
        holds(&found, "restitution", R),
        "{text}: {}",
        found["joint"]
    );
    found
}

#[test]
fn valid_headings_again_and_averages_are_no_drops() {
    let heading = "Trial,Drop height (cm),Rebound height (cm)\n";
    let mut text = String::new();
    for k in 0..12 {
        if k % 5 == 0 {
            text += heading;
        }
        let [before, after] = drop_cm(k);
        let _ = writeln!(text, "{},{before:.1},{after:.1}", k + 1);
    }
    text += "Average,68.3,41.6\nSD,19.5,11.9\n";
    let found = holds_r(&text);
    assert_eq!(found["methods"]["flight_times"]["observations"], 12);
    let (said, _) = folder(&text).run(&["init", "day"]);
    for told in [
        "(Average, SD) sum up those above",
        "2 lines among the rows are the table's heading again",
    ] {
        assert!(said.contains(told), "{said}");
    }
}

#[test]
fn valid_a_table_of_heights_on_its_side() {
    let of = |i: usize| {
        let cells = (0..6).map(|k| format!("{:.1}", drop_cm(k)[i]));
        cells.collect::<Vec<_>>().join(";").replace('.', ",")
    };
    let text = format!("Fallhöhe (cm);{}\r\nSprunghöhe (cm);{}\r\n", of(0), of(1));
    let found = holds_r(&text);
    assert_eq!(found["methods"]["flight_times"]["observations"], 6);
}

#[test]
fn valid_heights_beside_their_uncertainties() {
    let row = |k: usize| {
        let [before, after] = drop_cm(k);
        format!("{k},{before:.1},0.2,{after:.1},0.5\n")
    };
    let rows: String = (0..10).map(row).collect();
    let found = holds_r(&format!("trial,h0 (cm),Δh0 (cm),h1 (cm),Δh1 (cm)\n{rows}"));
    assert_eq!(found["methods"]["flight_times"]["observations"], 10);
}

#[test]
fn valid_laps_of_a_stopwatch_in_either_order() {
    let (mut total, mut laps) = (0.0, Vec::new());
    for k in 0..8 {
        let lap = 0.7 * R.powi(k) + 4e-3 * (f64::from(k) * 2.399_963).sin();
        total += lap;
        laps.push(format!("{},00:0{lap:.2},00:0{total:.2}\n", k + 1));
    }
    holds_r(&format!("Lap,Lap Time,Total Time\n{}", laps.concat()));
    laps.reverse();
    holds_r(&format!("Lap,Time,Total\n{}", laps.concat()));
}

/// Times, s, and positions, mm, of a free decay at 200 Hz.
fn decay() -> impl Iterator<Item = (f64, f64)> {
    let omega = std::f64::consts::TAU * F0_HZ;
    (0..4000).map(move |i| {
        let t = f64::from(i) / 200.0;
        let noise = 0.02 * (f64::from(i) * f64::from(i) * 2.399_963).sin();
        let swing = (omega * (1.0 - BETA * BETA).sqrt() * t).cos();
        (t, 50.0 * (-BETA * omega * t).exp() * swing + noise)
    })
}

fn holds_the_decay(text: &str) {
    let found = folder(text).play();
    for (parameter, truth) in [("natural_frequency_hz", F0_HZ), ("damping_ratio", BETA)] {
        assert!(holds(&found, parameter, truth), "{}", found["joint"]);
    }
}

#[test]
fn valid_a_decay_below_a_step_of_time_and_hours_minutes_and_seconds() {
    let rows: String = decay().map(|(_, x)| format!("{x:.4}\r\n")).collect();
    holds_the_decay(&format!(
        "Gerät;Logger 7\r\nAbtastintervall;5,0;ms\r\nWeg (mm)\r\n{}",
        rows.replace('.', ",")
    ));
    let row = |(t, x): (f64, f64)| {
        format!(
            "10,{},{:.3},{x:.4}\n",
            59 - i32::from(t < 10.0),
            (t + 50.0) % 60.0
        )
    };
    let rows: String = decay().map(row).collect();
    holds_the_decay(&format!("Hour,Minute,Second,Position (mm)\n{rows}"));
}

#[test]
fn valid_a_decay_that_begins_beyond_the_range() {
    let row = |(t, x): (f64, f64)| match x {
        x if x.abs() > 44.0 => format!("{t:.4},OVLD\n"),
        x => format!("{t:.4},{x:.4}\n"),
    };
    let rows: String = decay().map(row).collect();
    holds_the_decay(&format!("Time (s),Position (mm)\n{rows}"));
}

#[test]
fn valid_a_force_plate_in_volts() {
    let rate = 2000.0;
    let (mut at, mut speed, mut bounces) = (0.5, 4.0, Vec::new());
    while speed > 0.4 {
        bounces.push((at, speed));
        speed *= R;
        at += 4e-3 + 2.0 * speed / 9.81;
    }
    let mut text = String::from("Time (s),Force [V]\n");
    for i in 0..11_000 {
        let t = f64::from(i) / rate;
        let pulse = |(at, speed): &(f64, f64)| {
            let part = (t - at) / 4e-3;
            if (0.0..1.0).contains(&part) {
                speed * (std::f64::consts::PI * part).sin()
            } else {
                0.0
            }
        };
        let noise = 0.01 * (f64::from(i) * f64::from(i) * 2.399_963).sin();
        let force = bounces.iter().map(pulse).sum::<f64>() + noise;
        let _ = writeln!(text, "{t:.4},{force:.4}");
    }
    holds_r(&text);
}
