//! Mistakes of a laboratory that act on a whole campaign: each is named, and R holds or is said not to be known.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::{found_in, impactid, json};
use crate::support::assert_holds_the_truth;

/// A simulated campaign with R = 0.75 in the folder `rig`, and the text of one of its files.
struct Simulated {
    folder: tempfile::TempDir,
}

impl Simulated {
    fn of(rig: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let truth = ["--restitution", "0.75", "--seed", "31", "--records", "100"];
        let command = ["-q", "simulate", "campaign", "--out", "rig", "--rig", rig];
        let simulated = impactid(folder.path(), &[&command[..], &truth].concat());
        assert_eq!(simulated.code, 0, "{}", simulated.said);
        Self { folder }
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    /// What is found when a file of the campaign is changed; afterwards it is as before.
    fn found_with(&self, file: &str, change: impl Fn(&str) -> String) -> Value {
        let file = self.path().join("rig").join(file);
        let before = fs::read_to_string(&file).expect("a file of the campaign");
        let after = change(&before);
        assert_ne!(before, after);
        fs::write(&file, after).expect("the changed file");
        let (_, found) = found_in(self.path(), "rig/campaign.toml");
        fs::write(&file, before).expect("the file as before");
        found
    }
}

fn interval_of_r(found: &Value) -> [f64; 2] {
    let end = |i: usize| found["joint"]["restitution"]["interval95"][i].as_f64();
    [0, 1].map(|i| end(i).expect("an interval"))
}

fn first_suspicion(found: &Value) -> &str {
    found["suspicions"][0]["kind"].as_str().unwrap_or("none")
}

/// A run table with its clearances changed.
fn with_clearances(table: &str, change: &dyn Fn(f64) -> f64) -> String {
    let mut lines = table.lines();
    let heads = lines.next().expect("a head");
    let column = heads.split(',').position(|h| h.starts_with("clearance"));
    let column = column.expect("clearances");
    let changed = lines.map(|line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if let Ok(clearance) = cells[column].parse() {
            cells[column] = change(clearance).to_string();
        }
        cells.join(",")
    });
    let all: Vec<String> = std::iter::once(heads.to_owned()).chain(changed).collect();
    all.join("\n") + "\n"
}

#[test]
fn valid_clearances_that_are_off_alike_are_named_and_not_used() {
    let simulated = Simulated::of("realistic");
    let clearances = |change: &dyn Fn(f64) -> f64| {
        simulated.found_with("runs.csv", |table| with_clearances(table, change))
    };
    let whole = clearances(&|mm| 2.0 * mm);
    let inch = clearances(&|mm| mm / 25.4);
    let shifted = clearances(&|mm| mm + 4.0);
    for (found, kind) in [
        (&whole, "whole_gaps_stated"),
        (&inch, "clearances_off_alike"),
        (&shifted, "clearances_shifted"),
    ] {
        assert_eq!(first_suspicion(found), kind);
        assert_eq!(found["verdict"]["findings"][0]["kind"], kind);
        assert!(found["methods"]["trajectories"].is_null(), "{kind}");
        let [low, high] = interval_of_r(found);
        assert!(
            low < 0.75 && 0.75 < high && high - low < 0.03,
            "{kind}: {low} {high}"
        );
        let brackets = found["left_out"].as_array().expect("a list").iter();
        assert!(
            brackets
                .filter(|l| l["reason"]["kind"] == "gap_not_as_stated")
                .count()
                > 4
        );
    }
    // as the finding of whole gaps says
    let runs = simulated.path().join("rig/runs.csv");
    let halves = fs::read_to_string(&runs).expect("the run table");
    fs::write(&runs, with_clearances(&halves, &|mm| 2.0 * mm)).expect("whole gaps");
    let stated = simulated.found_with("campaign.toml", |text| {
        text.replacen("[records]", "[records]\nwhole_gaps = true", 1)
    });
    assert!(!stated["methods"]["trajectories"].is_null());
    assert_eq!(stated["suspicions"], Value::Array(Vec::new()));
    let added = shifted["suspicions"][0]["added_m"]
        .as_f64()
        .expect("a length");
    assert!((added + 4e-3).abs() < 0.3e-3, "{added}");
}

/// Finds the clearance of a gap of the sample that is stated as another one, in millimetres.
fn finds_the_gap_stated_as(true_mm: &str, stated_mm: &str) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("data-samples/double-oscillator");
    for name in ["campaign.toml", "records.h5"] {
        fs::copy(sample.join(name), folder.path().join(name)).expect("a copy");
    }
    let runs = fs::read_to_string(sample.join("runs.csv")).expect("the run table");
    let wrong = runs.replace(&format!(",{true_mm},"), &format!(",{stated_mm},"));
    assert_ne!(runs, wrong);
    fs::write(folder.path().join("runs.csv"), wrong).expect("the run table");
    let (_, found) = found_in(folder.path(), "campaign.toml");
    assert_eq!(
        found["verdict"]["kind"], "identified",
        "{}",
        found["verdict"]
    );
    let mut named = found["suspicions"].as_array().expect("a list").iter();
    let gap = named
        .find(|s| s["kind"] == "wrong_clearance")
        .expect("the gap");
    let fitting_mm = 1e3 * gap["fitting_m"].as_f64().expect("a length");
    let true_mm: f64 = true_mm.parse().expect("a length");
    assert!((fitting_mm / true_mm - 1.0).abs() < 0.01, "{fitting_mm}");
}

/// The first order about a fit tells 5.7 mm; all of the gap's records that a start by the others knows are of no motion
/// of the model.
#[test]
fn valid_a_gap_that_is_far_off_is_named_with_its_true_value() {
    finds_the_gap_stated_as("5", "7");
}

/// Parts of the campaign that are fitted each by itself, to tell whether the rig changed, leave the gap out too.
#[test]
fn valid_a_small_gap_that_is_far_off_is_no_change_of_the_rig() {
    finds_the_gap_stated_as("0.6", "0.8");
}

#[test]
fn valid_velocities_in_another_unit_leave_the_static_deflection_open() {
    let thousand = |toml: &str| {
        toml.replace(" m/s/V\"", " mm/s/V\"")
            .replace(" m/V\"", " mm/V\"")
    };
    let found = Simulated::of("realistic").found_with("campaign.toml", thousand);
    // the masses seem to hit at clearances a thousand times smaller
    assert_eq!(first_suspicion(&found), "clearances_off_alike");
    let ratio = found["suspicions"][0]["ratio"].as_f64().expect("a ratio");
    // contacts that last lengthen the flights by which the clearances are told
    assert!((ratio / 1e-3 - 1.0).abs() < 0.2, "{ratio}");
    let deflection = &found["joint"]["static_deflection_m"];
    assert_eq!(deflection["status"], "weak");
    assert_eq!(deflection["note"]["kind"], "instrument_off");
    let [low, high] = interval_of_r(&found);
    assert!(low < 0.75 && 0.75 < high, "{low} {high}");
}

#[test]
fn valid_a_high_pass_that_is_not_stated_is_named() {
    let without = |toml: &str| {
        let lines = toml.lines().filter(|line| !line.starts_with("high_pass"));
        lines.map(|line| format!("{line}\n")).collect()
    };
    let found = Simulated::of("exact").found_with("campaign.toml", without);
    // fits of all methods are bent by it: nothing is called known
    assert_eq!(found["joint"]["restitution"]["note"]["kind"], "bent");
    assert_ne!(found["verdict"]["kind"], "identified");
    let suspicions = found["suspicions"].as_array().expect("a list").iter();
    let named: Vec<&Value> = suspicions
        .filter(|s| s["kind"] == "undeclared_high_pass")
        .collect();
    assert!(!named.is_empty(), "{}", found["suspicions"]);
    for finding in named {
        assert_ne!(finding["channel"], "velocity_x", "the laser has none");
        let corner_hz = finding["corner_hz"].as_f64().expect("a frequency");
        assert!((0.3..0.7).contains(&corner_hz), "{corner_hz}");
    }
}

#[test]
fn valid_a_drive_that_was_not_recorded_is_named_and_r_holds() {
    let without = |toml: &str| {
        let (head, rest) = toml.split_once("[channels.drive]").expect("the drive");
        let (_, others) = rest.split_once("\n\n").expect("other channels");
        format!("{head}{others}")
    };
    let found = Simulated::of("realistic").found_with("campaign.toml", without);
    assert_eq!(first_suspicion(&found), "phase_not_measured");
    let [low, high] = interval_of_r(&found);
    assert!(
        low < 0.75 && 0.75 < high && high - low < 0.1,
        "{low} {high}"
    );
    // of all records with impacts, none taken for one of the wrong sign
    let records = found["methods"]["speeds_at_impact"]["records"].as_u64();
    assert!(records > Some(30), "{records:?}");
}

#[test]
fn valid_a_mass_that_is_driven_alone_is_named_and_all_holds() {
    let simulated = Simulated::of("exact,drive-asymmetry=2");
    let found = simulated.found_with("campaign.toml", |toml| format!("{toml}\n"));
    assert_eq!(first_suspicion(&found), "drives_unlike", "{found}");
    assert_eq!(found["verdict"]["kind"], "identified");
    assert_eq!(found["suspicions"].as_array().map(Vec::len), Some(1));
    let truth = json(&simulated.path().join("rig/truth.json"));
    assert_holds_the_truth(&found, &truth);
}

#[test]
fn valid_contacts_of_two_milliseconds_are_impacts_and_those_of_ten_give_no_r() {
    let as_is = |toml: &str| format!("{toml}\n");
    let short = Simulated::of("contact=2").found_with("campaign.toml", as_is);
    let [low, high] = interval_of_r(&short);
    assert!(
        low < 0.75 && 0.75 < high && high - low < 0.02,
        "{low} {high}"
    );
    let long = Simulated::of("contact=10").found_with("campaign.toml", as_is);
    assert_ne!(long["verdict"]["kind"], "identified");
}

#[test]
fn valid_a_gain_that_is_far_off_is_named_and_bends_nothing_else() {
    let simulated = Simulated::of("realistic");
    let truth = json(&simulated.path().join("rig/truth.json"));
    for (scale, deviation) in [("0.24 m/s/V", 0.2), ("0.17 m/s/V", -0.15)] {
        let found = simulated.found_with("campaign.toml", |text| {
            let (before, x) = text.split_once("[channels.velocity_x]").expect("x");
            let x = x.replacen("0.2 m/s/V", scale, 1);
            format!("{before}[channels.velocity_x]{x}")
        });
        let suspicion = &found["suspicions"][0];
        assert_eq!(first_suspicion(&found), "wrong_gain", "{found}");
        assert_eq!(suspicion["channel"], "velocity_x");
        let told = suspicion["deviation"].as_f64().expect("a deviation");
        assert!((told - deviation).abs() < 0.01, "{told} of {deviation}");
        let kinds = found["suspicions"].as_array().expect("a list").iter();
        let kinds: Vec<&Value> = kinds.map(|s| &s["kind"]).collect();
        assert!(!kinds.contains(&&Value::from("sides_unlike")), "{kinds:?}");
        assert!(
            !kinds.contains(&&Value::from("wrong_clearance")),
            "{kinds:?}"
        );
        for parameter in ["restitution", "static_deflection_m"] {
            let estimate = &found["joint"][parameter];
            let (value, half) = (&estimate["value"], &estimate["interval95"]);
            let off =
                value.as_f64().expect("a value") - truth[parameter].as_f64().expect("a truth");
            let width = half[1].as_f64().expect("an end") - half[0].as_f64().expect("an end");
            assert!(off.abs() < 0.75 * width, "{parameter}: {estimate}");
        }
    }
}

#[test]
fn valid_a_drive_that_is_later_than_stated_is_named_and_moved_back() {
    let simulated = Simulated::of("realistic");
    // the drive's samples are taken for later than they are: moved back by that, they are early
    let stated = |delay: &str| {
        simulated.found_with("campaign.toml", |text| {
            let (before, drive) = text.split_once("[channels.drive]\n").expect("a drive");
            format!("{before}[channels.drive]\ndelay = \"{delay}\"\n{drive}")
        })
    };
    for (delay, later_ms) in [("-5 ms", 5.0), ("12 ms", -12.0)] {
        let found = stated(delay);
        let suspicion = &found["suspicions"][0];
        assert_eq!(first_suspicion(&found), "late_channel", "{found}");
        assert_eq!(suspicion["channel"], "drive");
        let told = suspicion["later_ms"].as_f64().expect("a lag");
        assert!((told - later_ms).abs() < 0.5, "{told} ms of {later_ms}");
        let [low, high] = interval_of_r(&found);
        assert!(
            low < 0.75 && 0.75 < high && high - low < 0.03,
            "{low} to {high}"
        );
    }
}

#[test]
fn valid_a_velocity_of_the_wrong_sign_is_named_and_turned_around() {
    let simulated = Simulated::of("realistic");
    let found = simulated.found_with("campaign.toml", |text| {
        let (before, x) = text.split_once("[channels.velocity_x]\n").expect("x");
        format!("{before}[channels.velocity_x]\nsign = -1\n{x}")
    });
    assert_eq!(first_suspicion(&found), "inverted_channel", "{found}");
    assert_eq!(found["suspicions"][0]["channel"], "velocity_x");
    let [low, high] = interval_of_r(&found);
    assert!(
        low < 0.75 && 0.75 < high && high - low < 0.01,
        "{low} to {high}"
    );
}
