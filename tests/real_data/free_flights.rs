//! Experiments of a students' laboratory: two carts, bouncing balls, springs, marbles on paper. What is
//! known of them is in the README of the data.

use std::fmt::Write as _;
use std::path::PathBuf;

use serde_json::Value;

use super::{data, files, identified, name_of};

/// A run table of all files of a folder, each with what a function says of its name.
fn runs(folder: &str, columns: &str, of: impl Fn(&str) -> Option<String>) -> String {
    let mut runs = format!("file,record,{columns}\n");
    for path in files(&data(folder)) {
        let name = name_of(Some(&path));
        if let Some(cells) = of(&name) {
            let stem = PathBuf::from(&name).with_extension("");
            let _ = writeln!(runs, "\"{}\",{},{cells}", path.display(), stem.display());
        }
    }
    runs
}

fn interval(estimate: &Value) -> [f64; 2] {
    [0, 1].map(|i| estimate["interval95"][i].as_f64().unwrap_or(f64::NAN))
}

fn holds(estimate: &Value, truth: f64) -> bool {
    let [low, high] = interval(estimate);
    low <= truth && truth <= high
}

const EVENTS: &str = "[campaign]\nmachine = \"single\"\nflight = \"constant_force\"\n[records]\n\
                      run_table = \"runs.csv\"\n[channels.contact]\nchannel = \"Event time\"\n\
                      content = \"times\"\n";

#[test]
#[ignore = "needs shared/data: records of other laboratories"]
fn valid_real_data_restitution_of_balls_from_the_times_of_bounces() {
    for (folder, truth) in [
        ("bouncing_balls/tennis", 0.763),
        ("bouncing_balls/blue_25cm", 0.886),
    ] {
        let (found, _) = identified(EVENTS, &runs(folder, "note", |_| Some(String::new())));
        let r = &found["joint"]["restitution"];
        assert!(holds(r, truth), "{folder}: {r}");
        let [low, high] = interval(r);
        assert!(high - low < 0.04, "{folder}: {r}");
    }
}

#[test]
#[ignore = "needs shared/data: records of other laboratories"]
fn valid_real_data_restitution_of_two_carts_run_by_run() {
    let campaign = "[campaign]\nmachine = \"double\"\nflight = \"constant_force\"\n\
                    [records]\nrun_table = \"runs.csv\"\n\
                    [channels.velocity_x]\nchannel = \"Blue Velocity\"\n\
                    [channels.velocity_y]\nchannel = \"Red Velocity\"\n";
    let table = runs("two_carts", "specimen", |name| {
        Some(name.split('_').nth(1).unwrap_or("").to_owned())
    });
    let (found, _) = identified(campaign, &table);
    for (specimen, low, high) in [("elastico", 0.955, 1.015), ("ana500ros", -0.012, 0.015)] {
        let impacts = &found["specimens"][specimen]["methods"]["speeds_at_impact"];
        let each = impacts["impact_groups"]["by_record"]
            .as_array()
            .expect("runs");
        assert!(each.len() >= 4, "{specimen}: {each:?}");
        for run in each {
            let r = run["restitution"].as_f64().expect("R");
            let error = run["standard_error"].as_f64().expect("an error");
            let off = (low - r).max(r - high).max(0.0);
            assert!(off < 1.96 * error, "{specimen}: {run}");
            assert!(error < 0.03, "{specimen}: {run}");
        }
    }
}

#[test]
#[ignore = "needs shared/data: records of other laboratories"]
fn valid_real_data_springs_meet_least_squares_on_the_position() {
    const F0: [f64; 9] = [
        2.9473, 2.6781, 2.4723, 2.3081, 2.0561, 1.6684, 1.4319, 1.2761, 1.1680,
    ];
    const BETA: [f64; 9] = [
        0.00145, 0.00159, 0.00147, 0.00124, 0.00169, 0.0048, 0.0023, 0.0025, 0.0027,
    ];
    let campaign = "[campaign]\nmachine = \"single\"\n[records]\nrun_table = \"runs.csv\"\n\
                    [channels.displacement_x]\nchannel = \"1 Position\"\n\
                    [channels.velocity_x]\nchannel = \"1 Velocity\"\n\
                    [channels.acceleration_x]\nchannel = \"1 Acceleration\"\n";
    let table = runs("spring_decays", "excitation,specimen", |name| {
        Some(format!("free_decay,m{}", name.get(..2)?))
    });
    let (found, _) = identified(campaign, &table);
    for (i, (f0, beta)) in F0.into_iter().zip(BETA).enumerate() {
        let specimen = &found["specimens"][format!("m0{}", i + 1)];
        let joint = &specimen["joint"];
        // The values known have four digits.
        let [low, high] = interval(&joint["natural_frequency_hz"]);
        assert!(low - 5e-5 < f0 && f0 < high + 5e-5, "{i}: {joint}");
        let [low, high] = interval(&joint["damping_ratio"]);
        assert!(low - 5e-5 < beta && beta < high + 5e-5, "{i}: {joint}");
        assert_eq!(specimen["methods"]["free_decay"]["fits"], true, "{i}");
    }
}

#[test]
#[ignore = "needs shared/data: records of other laboratories"]
fn valid_real_data_marbles_on_paper_bounce_by_bounce() {
    const KNOWN: [(&str, f64, f64); 6] = [
        ("1", 0.490, 0.496),
        ("2", 0.468, 0.451),
        ("8", 0.341, 0.474),
        ("16", 0.404, 0.509),
        ("20", 0.430, 0.525),
        ("100", 0.574, 0.626),
    ];
    let campaign = "[campaign]\nmachine = \"single\"\nflight = \"constant_force\"\n\
                    [records]\nrun_table = \"runs.csv\"\n\
                    [channels.displacement_x]\nchannel = \"height below start\"\n";
    let table = runs("paper_stack", "specimen", |name| {
        Some(name.split('-').nth(1)?.to_owned())
    });
    let (found, _) = identified(campaign, &table);
    for (sheets, first, second) in KNOWN {
        let specimen = &found["specimens"][sheets];
        let bounces = &specimen["methods"]["speeds_at_impact"]["impact_groups"]["by_bounce"];
        for (i, truth) in [first, second].into_iter().enumerate() {
            let r = bounces[i]["restitution"].as_f64().expect("R");
            let error = bounces[i]["standard_error"].as_f64().expect("an error");
            assert!(
                (r - truth).abs() < 1.96 * error,
                "{sheets}, {i}: {r} ± {error}"
            );
        }
        // R that changes is not one number, whatever interval would hold it.
        if (first - second).abs() > 0.05 {
            assert_eq!(specimen["verdict"]["kind"], "does_not_fit", "{sheets}");
        }
    }
}
