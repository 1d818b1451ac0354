//! A campaign as `LabVIEW` leaves it: a CSV file a record with decimal commas and German heads, and the laboratory book
//! beside them. From `init` to the report.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::support::Lab;

/// Columns of the simulated rig, their heads as saved, and the factors from V.
const COLUMNS: [(&str, &str, f64); 5] = [
    ("generator", "Generator [V]", 1.0),
    ("contact", "Kontakt [V]", 1.0),
    ("laser_x", "Laser x [m/s]", 0.2),
    ("integrator_vy", "Geschw. y [m/s]", 0.2),
    ("integrator_x", "Weg x [mm]", 2.0),
];

/// Samples a second.
const RATE: f64 = 2000.0;

/// A record as the program converts it, as `LabVIEW` writes it.
fn saved(record: &str) -> String {
    let mut lines = record.lines().filter(|l| !l.starts_with('#'));
    let heads: Vec<&str> = lines.next().expect("heads").split(',').collect();
    let place = |name: &str| heads.iter().position(|h| h.starts_with(name)).expect(name);
    let columns = COLUMNS.map(|(name, head, factor)| (place(name), head, factor));
    let titles = columns.map(|c| c.1).join(";");
    let mut text = format!("Zeit [s];{titles}\r\n");
    for (i, line) in lines.enumerate() {
        let cells: Vec<f64> = line
            .split(',')
            .map(|c| c.parse().expect("a number"))
            .collect();
        let _ = write!(text, "{:.4}", i as f64 / RATE);
        for (at, _, factor) in columns {
            let _ = write!(text, ";{:.6}", factor * cells[at]);
        }
        text.push_str("\r\n");
    }
    text.replace('.', ",").replace("Geschw,", "Geschw.")
}

/// The run table as a laboratory book, and the records beside it.
fn save(lab: &Lab, folder: &Path) {
    let runs = lab.read("rig/runs.csv");
    let mut book = String::from("Datei;Frequenz [Hz];Spalt [mm];Richtung\r\n");
    for (number, run) in runs.lines().skip(1).enumerate() {
        let cells: Vec<&str> = run.split(',').collect();
        let [_, record, frequency, clearance, sweep] = cells[..] else {
            panic!("{run}")
        };
        let name = format!("Lauf_{number:03}.csv");
        let text = saved(&lab.read(&format!("records/{record}.csv")));
        fs::write(folder.join(&name), text).expect("room");
        let way = if sweep == "up" { "auf" } else { "ab" };
        let row = format!("{frequency};{clearance}").replace('.', ",");
        let _ = write!(book, "{name};{row};{way}\r\n");
    }
    fs::write(folder.join("Laborbuch.csv"), book).expect("room");
}

#[test]
fn valid_labview_files_with_decimal_commas_from_init_to_the_report() {
    let lab = Lab::new();
    let run = |arguments: &[&str]| {
        let ran = lab.run(arguments);
        assert_eq!(ran.code, 0, "{arguments:?}: {}", ran.said);
        ran.said
    };
    let rig = ["--rig", "exact", "--seed", "51", "--records", "60"];
    let simulate = ["-q", "simulate", "campaign", "--out", "rig"];
    run(&[&simulate[..], &rig].concat());
    run(&["-q", "convert", "rig/records.h5", "--out", "records.csv"]);
    fs::create_dir(lab.path("day")).expect("a folder");
    save(&lab, &lab.path("day"));
    run(&["init", "day"]);
    // what the user knows and no file states
    for channel in ["Geschw. y", "Weg x"] {
        let line = format!("channel = \"{channel}\"");
        lab.replace(
            "day/campaign.toml",
            &line,
            &format!("{line}\nhigh_pass = \"0.5 Hz\""),
        );
    }
    let checked = run(&["check", "day/campaign.toml"]);
    assert!(
        checked.contains("60 of 60 records can be used"),
        "{checked}"
    );
    run(&["run", "day/campaign.toml", "--out", "results"]);
    assert!(lab.path("results/report.pdf").exists());
    let found: serde_json::Value =
        serde_json::from_str(&lab.read("results/identification.json")).expect("JSON");
    let truth: serde_json::Value = serde_json::from_str(&lab.read("rig/truth.json")).expect("JSON");
    let parameters = [
        "restitution",
        "natural_frequency_hz",
        "damping_ratio",
        "static_deflection_m",
    ];
    for parameter in parameters {
        let interval = &found["joint"][parameter]["interval95"];
        let [low, high] = [0, 1].map(|i| interval[i].as_f64().expect("an interval"));
        let true_value = truth[parameter].as_f64().expect("a number");
        assert!(
            low <= true_value && true_value <= high,
            "{parameter}: {interval}"
        );
    }
}
