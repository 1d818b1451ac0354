//! A campaign as `LabVIEW` leaves it: a CSV file a record with decimal commas and German heads, and the laboratory book
//! beside them. From `init` to the report.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use super::rig::{Take, assert_the_answer_is_true, done, state, takes};
use crate::support::Lab;

/// Columns of the simulated rig, their heads as saved, and the factors from V.
const COLUMNS: [(&str, &str, f64); 5] = [
    ("generator", "Generator [V]", 1.0),
    ("contact", "Kontakt [V]", 1.0),
    ("laser_x", "Laser x [m/s]", 0.2),
    ("integrator_vy", "Geschw. y [m/s]", 0.2),
    ("integrator_x", "Weg x [mm]", 2.0),
];

/// A record as `LabVIEW` writes it.
fn saved(take: &Take, channels: &[(&str, &str, f64)]) -> String {
    let columns = channels.iter();
    let columns = columns.map(|(name, _, factor)| take.channel(name, *factor));
    let columns: Vec<Vec<f64>> = columns.collect();
    let mut text = String::new();
    for (i, time) in take.times().iter().enumerate() {
        let _ = write!(text, "{time:.4}");
        for column in &columns {
            let _ = write!(text, ";{:.6}", column[i]);
        }
        text.push_str("\r\n");
    }
    let titles: Vec<&str> = channels.iter().map(|c| c.1).collect();
    format!(
        "Zeit [s];{}\r\n{}",
        titles.join(";"),
        text.replace('.', ",")
    )
}

/// The run table as a laboratory book, and the records in a folder beside it.
fn save(takes: &[Take], folder: &Path) {
    let mut book = String::from("Datei;Frequenz [Hz];Spalt [mm];Richtung\r\n");
    fs::create_dir(folder.join("Messungen")).expect("room");
    for (number, take) in takes.iter().enumerate() {
        let name = format!("Lauf_{number:03}.csv");
        let text = saved(take, &COLUMNS);
        fs::write(folder.join("Messungen").join(&name), text).expect("room");
        let way = if take.upward { "auf" } else { "ab" };
        let row = format!("{};{}", take.frequency_hz, take.clearance_mm).replace('.', ",");
        let _ = write!(book, "{name};{row};{way}\r\n");
    }
    fs::write(folder.join("Laborbuch.csv"), book).expect("room");
}

#[test]
fn valid_labview_files_with_decimal_commas_from_init_to_the_report() {
    let lab = Lab::new();
    let takes = takes(&lab, &["--rig", "exact", "--seed", "51", "--records", "60"]);
    save(&takes, &lab.path("day"));
    done(&lab, &["init", "day"]);
    // what the user knows and no file states
    for channel in ["Geschw. y", "Weg x"] {
        state(&lab, channel, "high_pass = \"0.5 Hz\"");
    }
    assert_the_answer_is_true(&lab, 60);
}

/// No laboratory book: frequency, gap and direction are in the names of the files.
#[test]
fn valid_files_that_are_named_after_their_settings_have_a_run_table() {
    let lab = Lab::new();
    let takes = takes(&lab, &["--rig", "exact", "--seed", "51", "--records", "24"]);
    for take in &takes {
        let way = if take.upward { "auf" } else { "ab" };
        let name = format!(
            "f{}Hz_spalt{}mm_{way}",
            take.frequency_hz, take.clearance_mm
        );
        let path = lab
            .path("day")
            .join(format!("{}.csv", name.replace('.', ",")));
        assert!(!path.exists(), "{name}");
        fs::write(path, saved(take, &COLUMNS[..4])).expect("room");
    }
    let said = done(&lab, &["init", "day"]);
    assert!(said.contains("runs.csv states the frequencies"), "{said}");
    state(&lab, "Geschw. y", "high_pass = \"0.5 Hz\"");
    assert_the_answer_is_true(&lab, 24);
    // a table that was corrected stays
    lab.write("day/runs.csv", "file,clearance_mm\n");
    done(&lab, &["init", "day", "--force"]);
    assert_eq!(lab.read("day/runs.csv"), "file,clearance_mm\n");
}
