//! Records of other laboratories: a blade spring's free decays and forced runs, and a cart that
//! bounces on a stop. They are not part of the repository, so these tests run by name only
//! (`cargo test -- --ignored real_data`).

mod free_flights;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

fn data(folder: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../shared/data")
        .join(folder);
    path.canonicalize().expect("the laboratory's data")
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut all: Vec<PathBuf> = Vec::new();
    for entry in std::fs::read_dir(folder).expect("the folder").flatten() {
        let path = entry.path();
        if path.is_dir() {
            all.extend(files(&path));
        } else {
            all.push(path);
        }
    }
    all.sort();
    all
}

fn name_of(path: Option<&Path>) -> String {
    path.and_then(Path::file_name)
        .map(|n| n.to_string_lossy().into_owned())
        .unwrap_or_default()
}

/// Run the program on a campaign and give its identification and exit code.
fn identified(campaign: &str, runs: &str) -> (Value, i32) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::write(folder.path().join("campaign.toml"), campaign).expect("campaign.toml");
    std::fs::write(folder.path().join("runs.csv"), runs).expect("runs.csv");
    let out = folder.path().join("out");
    let ran = Command::new(env!("CARGO_BIN_EXE_impactid"))
        .args(["-q", "run"])
        .arg(folder.path().join("campaign.toml"))
        .arg("--out")
        .arg(&out)
        .output()
        .expect("the program runs");
    let said = String::from_utf8_lossy(&ran.stderr).into_owned();
    let text = std::fs::read_to_string(out.join("identification.json"))
        .unwrap_or_else(|_| panic!("{said}"));
    (
        serde_json::from_str(&text).expect("JSON"),
        ran.status.code().unwrap_or(-1),
    )
}

/// Published natural frequency, rad/s, and damping ratio of each free decay; where the published values are those of one mode
/// alone from 0.1 s on though another is beside it, those of independent least squares (numpy): of test1-4 and test2-4 on
/// three modes (from 0.16 s, 0.25 s and 0.36 s on alike), of test1-3 on two (0.0185, 0.0178 and 0.0173 from 0.1 s, 0.2 s and
/// 0.3 s on, where one alone gives the published 0.0213 and then 0.0168).
const DECAYS: [(&str, f64, f64); 9] = [
    ("test1-1", 70.34, 0.0138),
    ("test1-2", 90.02, 0.0162),
    ("test2-2", 89.67, 0.0183),
    ("test3-2", 124.36, 0.0178),
    ("test1-3", 124.49, 0.0179),
    ("test2-3", 123.93, 0.0197),
    ("test1-4", 141.6, 0.0310),
    ("test2-4", 141.3, 0.0320),
    ("test3-4", 143.32, 0.0205),
];

#[test]
#[ignore = "needs shared/data: records of other laboratories"]
fn valid_free_decays_of_the_blade_spring_meet_the_published_table() {
    let folder = data("unb_cantilever_sdof/first_experiment");
    for path in files(&folder)
        .iter()
        .filter(|p| name_of(Some(p)) == "tps.txt")
    {
        let test = name_of(path.parent());
        let specimen = name_of(path.parent().and_then(Path::parent));
        let runs = format!(
            "file,record,excitation,specimen\n{},{test},free_decay,{specimen}\n",
            path.display()
        );
        let campaign = "[campaign]\nmachine = \"single\"\n[records]\nrun_table = \"runs.csv\"\n\
                        [channels.acceleration_x]\nchannel = 2\nunit = \"g\"\n";
        let (found, _) = identified(campaign, &runs);
        let method = &found["methods"]["free_decay"];
        let (_, rate, damping) = *DECAYS
            .iter()
            .find(|d| d.0 == test)
            .expect("a published decay");
        let f = method["natural_frequency_hz"]["value"]
            .as_f64()
            .expect("f0");
        let beta = method["damping_ratio"]["value"].as_f64().expect("β");
        assert!(
            (f * std::f64::consts::TAU / rate - 1.0).abs() < 4e-3,
            "{test}: {f}"
        );
        assert!((beta / damping - 1.0).abs() < 0.14, "{test}: {beta}");
    }
}

#[test]
#[ignore = "needs shared/data: records of other laboratories"]
fn valid_the_misfiled_decay_is_named() {
    let folder = data("unb_cantilever_sdof/first_experiment");
    let mut runs = String::from("file,record,excitation,specimen\n");
    for path in files(&folder)
        .iter()
        .filter(|p| name_of(Some(p)) == "tps.txt")
    {
        let test = name_of(path.parent());
        let specimen = name_of(path.parent().and_then(Path::parent));
        let _ = writeln!(runs, "{},{test},free_decay,{specimen}", path.display());
    }
    let campaign = "[campaign]\nmachine = \"single\"\n[records]\nrun_table = \"runs.csv\"\n\
                    [channels.acceleration_x]\nchannel = 2\nunit = \"g\"\n";
    let (found, _) = identified(campaign, &runs);
    let findings = found["verdict"]["findings"].to_string();
    assert!(
        findings.contains("test3-2: filed under massa2"),
        "{findings}"
    );
    assert!(findings.contains("behaves as massa3"), "{findings}");
}

#[test]
#[ignore = "needs shared/data: records of other laboratories"]
fn valid_forced_runs_of_masses_3_and_4_are_no_single_degree_of_freedom() {
    let folder = data("unb_cantilever_sdof/second_experiment");
    let mut runs = String::from("file,record,specimen\n");
    for path in files(&folder) {
        let specimen = name_of(path.parent());
        let _ = writeln!(
            runs,
            "{},{specimen}-{},{specimen}",
            path.display(),
            name_of(Some(&path))
        );
    }
    let campaign = "[campaign]\nmachine = \"single\"\n[records]\nrun_table = \"runs.csv\"\n\
                    [channels.drive]\nchannel = \"Force (Trigger)\"\n\
                    [channels.acceleration_x]\nchannel = \"Acceleration (Trigger)\"\nunit = \"g\"\n";
    let (found, code) = identified(campaign, &runs);
    assert_eq!(code, 1);
    for mass in ["massa3", "massa4"] {
        assert_eq!(
            found["specimens"][mass]["verdict"]["kind"], "does_not_fit",
            "{mass}"
        );
        let remarks = found["specimens"][mass]["methods"]["resonance_curve"]["remarks"].to_string();
        assert!(remarks.contains("one degree of freedom"), "{remarks}");
    }
}

#[test]
#[ignore = "needs shared/data: records of other laboratories"]
fn valid_restitution_of_the_cart_and_the_long_contact_of_the_magnet() {
    let folder = data("pasco_cart_bouncing_on_stop/csv");
    let mut runs = String::from("file,record,specimen\n");
    for path in files(&folder) {
        let name = name_of(Some(&path));
        let number: u32 = name
            .trim_start_matches("cart_run")
            .trim_end_matches(".csv")
            .parse()
            .expect("a number");
        let bumper = if number <= 6 { "magnet" } else { "spring" };
        let _ = writeln!(runs, "{},{name},{bumper}", path.display());
    }
    let campaign = "[campaign]\nmachine = \"single\"\nflight = \"constant_force\"\n\
                    [records]\nrun_table = \"runs.csv\"\n\
                    [channels.velocity_x]\nchannel = \"Blue:Velocity\"\nunit = \"m/s\"\n\
                    [channels.displacement_x]\nchannel = \"Blue:Position\"\nunit = \"m\"\n";
    let (found, _) = identified(campaign, &runs);
    let spring = &found["specimens"]["spring"]["joint"]["restitution"];
    // at 20 Hz a contact takes up to two samples, in each of which the slope changes R by 0.01
    let end = |k: usize| spring["interval95"][k].as_f64().expect("R");
    assert!(end(0) < 0.9 && 0.9 < end(1), "{spring}");
    assert!(end(1) - end(0) < 0.06, "{spring}");
    assert_eq!(
        found["specimens"]["magnet"]["verdict"]["kind"],
        "does_not_fit"
    );
    let remarks =
        found["specimens"]["magnet"]["methods"]["speeds_at_impact"]["remarks"].to_string();
    assert!(remarks.contains("not an instantaneous impact"), "{remarks}");
}
