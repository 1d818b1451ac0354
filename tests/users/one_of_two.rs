//! Two masses of which one is measured, as a user with a single sensor saves them.

use std::fmt::Write as _;
use std::fs;

use super::rig::{done, takes};
use crate::support::Lab;

#[test]
fn a_stop_that_may_be_a_second_mass_is_named() {
    let lab = Lab::new();
    // two masses of unlike damping, which no stop replaces
    let rig = "--rig damping-asymmetry=0.3 --seed 53 --records 24";
    let takes = takes(&lab, &rig.split(' ').collect::<Vec<_>>());
    let mut book = String::from("file,frequency [Hz],clearance [mm],sweep\n");
    for (number, take) in takes.iter().enumerate() {
        let columns = [("generator", 1.0), ("contact", 1.0), ("laser_x", 0.2)];
        let columns = columns.map(|(name, factor)| take.channel(name, factor));
        let mut text = String::from("Time [s],Generator [V],Contact [V],Velocity [m/s]\n");
        for (i, time) in take.times().iter().enumerate() {
            let [drive, contact, velocity] = [0, 1, 2].map(|k| columns[k][i]);
            let _ = writeln!(text, "{time:.4},{drive:.6},{contact:.6},{velocity:.6}");
        }
        fs::write(lab.path(&format!("day/run{number:03}.csv")), text).expect("room");
        let way = if take.upward { "up" } else { "down" };
        let _ = writeln!(
            book,
            "run{number:03}.csv,{},{},{way}",
            take.frequency_hz, take.clearance_mm
        );
    }
    fs::write(lab.path("day/runs.csv"), book).expect("room");
    let said = done(&lab, &["init", "day"]);
    assert!(
        said.contains("if it strikes a second mass, write machine = \"double\""),
        "{said}"
    );
    let run = [
        "run",
        "day/campaign.toml",
        "--out",
        "results",
        "--format",
        "csv",
    ];
    let ran = lab.run(&run);
    let said = ran.said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("a second mass that moves too"), "{said}");
    assert!(said.contains("R, x_st only weakly"), "{said}");
}
