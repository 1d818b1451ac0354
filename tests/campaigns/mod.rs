//! Campaigns compared: one simulated rig measured twice, from records to the report.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

use serde_json::Value;

/// An array of jobs on a cluster.
mod cluster;
/// Mistakes that act on a whole campaign.
mod mistakes;

struct Ran {
    code: i32,
    said: String,
}

/// What `run` finds of a campaign.toml, with figures as tables alone, and its exit code.
fn found_in(folder: &Path, campaign: &str) -> (i32, Value) {
    let run = ["-q", "run", campaign, "--out", "out", "--format", "csv"];
    let ran = impactid(folder, &run);
    // 1 says that not all is identified
    assert!(ran.code <= 1, "{}", ran.said);
    (ran.code, json(&folder.join("out/identification.json")))
}

fn impactid(folder: &Path, arguments: &[&str]) -> Ran {
    let out = Command::new(env!("CARGO_BIN_EXE_impactid"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program runs");
    Ran {
        code: out.status.code().unwrap_or(-1),
        said: String::from_utf8_lossy(&[out.stdout, out.stderr].concat()).into_owned(),
    }
}

/// One rig, measured before and after R has fallen: campaigns `before` and `after` with their results.
fn rig() -> &'static Path {
    static RIG: OnceLock<(tempfile::TempDir, PathBuf)> = OnceLock::new();
    let made = RIG.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().to_owned();
        for (name, seed, restitution) in [("before", "5", "0.9"), ("after", "6", "0.87")] {
            let simulated = impactid(
                &path,
                &[
                    "-q",
                    "simulate",
                    "campaign",
                    "--rig",
                    "gaps,gap-offset",
                    "--rig-seed",
                    "3",
                    "--records",
                    "60",
                    "--seed",
                    seed,
                    "--restitution",
                    restitution,
                    "--out",
                    name,
                ],
            );
            assert_eq!(simulated.code, 0, "{}", simulated.said);
            let file = format!("{name}/campaign.toml");
            let stated = fs::read_to_string(path.join(&file)).expect("campaign.toml");
            let stated = stated.replace("Synthetic double impact oscillator", name);
            fs::write(path.join(&file), stated).expect("campaign.toml");
        }
        let run = "-q run before/campaign.toml --out results --format csv";
        let run: Vec<&str> = run.split(' ').collect();
        assert_eq!(impactid(&path, &run).code, 0);
        (folder, path)
    });
    &made.1
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).expect("a file")).expect("JSON")
}

#[test]
fn valid_a_change_of_r_is_found_and_shared_errors_cancel() {
    let rig = rig();
    let ran = impactid(
        rig,
        &[
            "compare",
            "results",
            "after/campaign.toml",
            "--out",
            "compared",
        ],
    );
    assert_eq!(ran.code, 0, "{}", ran.said);
    assert!(ran.said.contains("Changed: R"), "{}", ran.said);
    let found = json(&rig.join("compared/comparison.json"));
    let differences = found["differences"].as_array().expect("differences");
    assert_eq!(differences.len(), 4);
    let of = |name: &str| {
        let mut all = differences.iter();
        all.find(|d| d["parameter"] == name).expect(name)
    };
    let interval = |d: &Value, key: &str| [0, 1].map(|i| d[key][i].as_f64().expect("a number"));
    let r = of("restitution");
    let [low, high] = interval(r, "interval95");
    assert!(low < -0.03 && -0.03 < high, "{low} {high}");
    let deflection = of("static_deflection_m");
    let width = |key| {
        let [low, high] = interval(deflection, key);
        high - low
    };
    let narrower = width("independent_interval95") / width("interval95");
    assert!(narrower > 1.5, "{narrower}");
    let shared = found["shared"].as_array().expect("what is shared");
    let kinds = |kind: &str| shared.iter().filter(|s| s["why"]["kind"] == kind).count();
    assert!(
        kinds("same_instrument") >= 4 && kinds("stated_as_shared") >= 4,
        "{shared:?}"
    );
    assert_eq!(found["outcome"]["kind"], "changed");
    for name in [
        "comparison.pdf",
        "comparison.html",
        "comparison.csv",
        "figures/trend.csv",
    ] {
        let size = fs::metadata(rig.join("compared").join(name))
            .expect(name)
            .len();
        assert!(size > 200, "{name}: {size} bytes");
    }
}

#[test]
fn a_comparison_in_german_is_german_on_the_terminal_and_in_the_report() {
    let rig = rig();
    let compare = [
        "compare",
        "results",
        "after/campaign.toml",
        "--out",
        "verglichen",
    ];
    let ran = impactid(rig, &[&compare[..], &["--language", "de"]].concat());
    assert_eq!(ran.code, 0, "{}", ran.said);
    for words in ["Geändert: R", "Geschrieben: ", "p < 0,001"] {
        assert!(ran.said.contains(words), "{words}: {}", ran.said);
    }
    for words in ["Changed", "Written", "difference", "p < 0.001"] {
        assert!(!ran.said.contains(words), "{words}: {}", ran.said);
    }
    let page = fs::read_to_string(rig.join("verglichen/comparison.html")).expect("a page");
    assert!(page.contains("<html lang=\"de\">") && page.contains("Messreihen"));
    assert!(!page.contains("Campaigns compared"));
}

#[test]
fn campaigns_of_different_machines_are_refused() {
    let rig = rig();
    let other = rig.join("other");
    fs::create_dir_all(&other).expect("a folder");
    let mut found = json(&rig.join("results/identification.json"));
    found["settings"]["machine"] = "single".into();
    fs::write(other.join("identification.json"), found.to_string()).expect("results");
    let ran = impactid(rig, &["compare", "results", "other", "--out", "machines"]);
    assert_eq!(ran.code, 2, "{}", ran.said);
    for words in [
        "two masses",
        "one mass against a stop",
        "check machine and flight",
    ] {
        assert!(ran.said.contains(words), "{}", ran.said);
    }
    assert!(!rig.join("machines/comparison.json").exists());
}

#[test]
fn results_that_were_copied_are_refused_as_the_same_measurement() {
    let rig = rig();
    let copy = rig.join("copy");
    fs::create_dir_all(&copy).expect("a folder");
    let name = "identification.json";
    fs::copy(rig.join("results").join(name), copy.join(name)).expect("a copy");
    let ran = impactid(rig, &["compare", "results", "copy", "--out", "refused"]);
    assert_eq!(ran.code, 2, "{}", ran.said);
    assert!(
        ran.said.contains("are the same measurement"),
        "{}",
        ran.said
    );
}

#[test]
fn proposed_settings_lower_the_error_of_r_from_what_the_campaign_states() {
    let rig = rig();
    let ran = impactid(
        rig,
        &[
            "-q",
            "plan",
            "before/campaign.toml",
            "--out",
            "plan",
            "--settings",
            "4",
        ],
    );
    assert_eq!(ran.code, 0, "{}", ran.said);
    let map = fs::read_to_string(rig.join("plan/plan.svg")).expect("the map");
    assert!(
        !map.contains("#EEEEEE"),
        "what is shown is simulated, as far as the proposals reach"
    );
    let plan = json(&rig.join("plan/plan.json"));
    let joint = &json(&rig.join("results/identification.json"))["joint"];
    let now = plan["restitution_error_now"].as_f64().expect("an error");
    assert_eq!(Some(now), joint["restitution"]["standard_error"].as_f64());
    let after = |p: &Value| p["restitution_error_after"].as_f64().expect("an error");
    let proposals = plan["proposals"].as_array().expect("proposals");
    let errors: Vec<f64> = proposals.iter().map(after).collect();
    assert_eq!(errors.len(), 4);
    assert!(
        errors[0] < now && errors.is_sorted_by(|a, b| a >= b),
        "{now} {errors:?}"
    );
    // a record more of 60 alike cannot halve the error
    assert!(errors[0] > 0.5 * now, "{now} {errors:?}");
}

/// Without clearances R rests on the speeds at impacts alone: nothing tells how long the contacts last, nor
/// corrects for it.
#[test]
fn valid_r_without_clearances_allows_for_contacts_and_delays() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path();
    for (rig, seed) in [
        ("contact=0.6", "51"),
        ("delays=0.5", "52"),
        ("realistic", "31"),
    ] {
        let of_rig = ["--rig", rig, "--seed", seed, "--records", "60"];
        let command = ["-q", "simulate", "campaign", "--out", "rig", "--force"];
        let simulated = impactid(path, &[&command[..], &of_rig].concat());
        assert_eq!(simulated.code, 0, "{}", simulated.said);
        let runs = path.join("rig/runs.csv");
        without_column(&runs, "clearance");
        without_column(&runs, "sweep");
        let bare = fs::read_to_string(&runs).expect("the run table");
        assert_eq!(bare.lines().next(), Some("file,dataset,drive_frequency_hz"));
        let (code, found) = found_in(path, "rig/campaign.toml");
        assert_eq!(code, 0, "{rig}");
        let interval = |i: usize| found["joint"]["restitution"]["interval95"][i].as_f64();
        let [low, high] = [0, 1].map(|i| interval(i).expect("an interval"));
        assert!(
            low < 0.9 && 0.9 < high && high - low < 0.02,
            "{rig}: {low} {high}"
        );
    }
}

#[test]
fn without_clearances_nothing_is_proposed_and_that_is_the_reason() {
    let rig = rig();
    let folder = rig.join("unstated");
    fs::create_dir_all(&folder).expect("a folder");
    for entry in fs::read_dir(rig.join("before")).expect("the campaign") {
        let file = entry.expect("an entry").path();
        let name = file.file_name().expect("a name");
        if file.is_file() {
            fs::copy(&file, folder.join(name)).expect("a copy");
        }
    }
    without_column(&folder.join("runs.csv"), "clearance");
    let ran = impactid(rig, &["plan", "unstated/campaign.toml", "--out", "none"]);
    assert_eq!(ran.code, 1, "{}", ran.said);
    assert!(
        ran.said
            .contains("Nothing can be proposed: no record states a clearance."),
        "{}",
        ran.said
    );
    assert!(!ran.said.contains("error of R then"), "{}", ran.said);
    let plan = json(&rig.join("none/plan.json"));
    assert_eq!(plan["obstacle"]["kind"], "no_clearance");
}

/// Remove the column of a run table whose name begins so.
fn without_column(table: &Path, name: &str) {
    let text = fs::read_to_string(table).expect("a run table");
    let heads = text.lines().next().expect("a head").split(',');
    let column = heads.clone().position(|h| h.starts_with(name)).expect(name);
    let rest = |line: &str| {
        let cells = line.split(',').enumerate();
        let cells = cells.filter(|(i, _)| *i != column).map(|(_, cell)| cell);
        cells.collect::<Vec<_>>().join(",") + "\n"
    };
    fs::write(table, text.lines().map(rest).collect::<String>()).expect("a run table");
}
