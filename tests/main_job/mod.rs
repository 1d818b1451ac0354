//! The main job on campaigns with known truth: the parameters and the types of motion come back.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

fn impactid(arguments: &[&str]) -> i32 {
    Command::new(env!("CARGO_BIN_EXE_impactid"))
        .args(arguments)
        .output()
        .expect("the program runs")
        .status
        .code()
        .unwrap_or(-1)
}

fn json(path: &Path) -> Value {
    let text = std::fs::read_to_string(path).expect("the file is there");
    serde_json::from_str(&text).expect("it is JSON")
}

fn text(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// A synthetic campaign and the results of a run on it.
struct Study {
    _folder: tempfile::TempDir,
    campaign: PathBuf,
    results: PathBuf,
}

impl Study {
    fn new(seed: u64, truth: [(&str, &str); 3], records: usize) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let campaign = folder.path().join("campaign");
        let results = folder.path().join("results");
        let (seed, records) = (seed.to_string(), records.to_string());
        let out = text(&campaign);
        let mut arguments = vec![
            "simulate",
            "campaign",
            "--seed",
            &seed,
            "--records",
            &records,
        ];
        for (name, value) in truth {
            arguments.extend([name, value]);
        }
        arguments.extend(["--out", &out]);
        assert_eq!(impactid(&arguments), 0);
        assert_eq!(run(&campaign.join("campaign.toml"), &results, "csv"), 0);
        Self {
            _folder: folder,
            campaign,
            results,
        }
    }

    fn truth(&self) -> Value {
        json(&self.campaign.join("truth.json"))
    }

    fn found(&self) -> Value {
        json(&self.results.join("identification.json"))
    }
}

/// Run a campaign into a folder, with a report in a format; the exit code.
fn run(campaign: &Path, out: &Path, format: &str) -> i32 {
    let (campaign, out) = (text(campaign), text(out));
    impactid(&["-q", "run", &campaign, "--out", &out, "--format", format])
}

fn value(of: &Value, name: &str) -> f64 {
    of[name]["value"].as_f64().unwrap_or(f64::NAN)
}

#[test]
fn parameters_of_synthetic_campaigns_are_recovered() {
    let truths = [
        (41, ["0.62", "0.035", "14.3"]),
        (42, ["0.88", "0.075", "9.4"]),
    ];
    for (seed, [r, beta, f0]) in truths {
        let names = ["--restitution", "--damping-ratio", "--natural-frequency-hz"];
        let truth = [(names[0], r), (names[1], beta), (names[2], f0)];
        let study = Study::new(seed, truth, 120);
        let (truth, found) = (study.truth(), study.found());
        assert_eq!(found["verdict"]["kind"], "identified", "seed {seed}");
        let joint = &found["joint"];
        let of = |name: &str| (value(joint, name), truth[name].as_f64().expect("a truth"));
        let (r, r_true) = of("restitution");
        assert!((r - r_true).abs() < 0.005, "seed {seed}: R {r} {r_true}");
        let (f, f_true) = of("natural_frequency_hz");
        assert!(
            (f / f_true - 1.0).abs() < 1e-3,
            "seed {seed}: f0 {f} {f_true}"
        );
        let (b, b_true) = of("damping_ratio");
        assert!(
            (b / b_true - 1.0).abs() < 0.03,
            "seed {seed}: β {b} {b_true}"
        );
    }
}

#[test]
fn a_corner_stated_wrongly_is_named_and_r_is_right() {
    let truth = [
        ("--restitution", "0.7"),
        ("--damping-ratio", "0.05"),
        ("--natural-frequency-hz", "12"),
    ];
    let study = Study::new(6, truth, 60);
    let file = study.campaign.join("campaign.toml");
    let stated = std::fs::read_to_string(&file).expect("campaign.toml");
    let at = stated
        .find("[channels.displacement_y]")
        .expect("the channel");
    let (head, tail) = stated.split_at(at);
    let wrong = format!("{head}{}", tail.replacen("0.5 Hz", "0.65 Hz", 1));
    std::fs::write(&file, wrong).expect("campaign.toml again");
    let out = study.campaign.join("again");
    assert_eq!(run(&file, &out, "csv"), 0);
    let found = json(&out.join("identification.json"));
    let named = found["suspicions"].as_array().expect("suspicions");
    assert_eq!(named.len(), 1, "{named:?}");
    assert_eq!(named[0]["kind"], "wrong_corner");
    assert_eq!(named[0]["channel"], "displacement_y");
    let r = value(&found["joint"], "restitution");
    assert!((r - 0.7).abs() < 1e-3, "{r}");
}

#[test]
fn stages_alone_give_what_run_gives() {
    let truth = [
        ("--restitution", "0.8"),
        ("--damping-ratio", "0.06"),
        ("--natural-frequency-hz", "12"),
    ];
    let study = Study::new(5, truth, 60);
    let description = study.campaign.join("campaign.toml");
    assert_eq!(run(&description, &study.results, "pdf"), 0);
    let staged = study.campaign.join("staged");
    let folder = text(&staged);
    let file = text(&description);
    assert_eq!(impactid(&["-q", "ingest", &file, "--out", &folder]), 0);
    for stage in ["classify", "identify", "report"] {
        assert_eq!(impactid(&["-q", stage, &folder]), 0, "{stage}");
    }
    let (whole, parts) = (study.found(), json(&staged.join("identification.json")));
    let (a, b) = (
        value(&whole["joint"], "restitution"),
        value(&parts["joint"], "restitution"),
    );
    assert!((a - b).abs() < 1e-9, "{a} {b}");
    for name in [
        "records.parquet",
        "impacts.parquet",
        "boundaries.csv",
        "report.pdf",
    ] {
        assert!(staged.join(name).exists(), "{name}");
        assert!(study.results.join(name).exists(), "{name}");
    }
}

#[test]
fn prop_the_same_campaign_gives_the_same_bytes_on_any_number_of_threads() {
    let truth = [
        ("--restitution", "0.7"),
        ("--damping-ratio", "0.05"),
        ("--natural-frequency-hz", "11"),
    ];
    let study = Study::new(9, truth, 50);
    let again = study.campaign.join("again");
    let file = text(&study.campaign.join("campaign.toml"));
    let again_to = text(&again);
    let on_one = ["-q", "-j", "1", "run", &file, "--out", &again_to];
    assert_eq!(impactid(&[&on_one[..], &["--format", "csv"]].concat()), 0);
    for name in [
        "identification.json",
        "records.parquet",
        "impacts.parquet",
        "boundaries.csv",
    ] {
        let read = |folder: &Path| std::fs::read(folder.join(name)).expect("an output");
        assert!(read(&study.results) == read(&again), "{name} differs");
    }
}

#[test]
fn valid_published_speeds_tell_the_damping_ratio() {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("data-samples/published-speeds");
    let folder = tempfile::tempdir().expect("a temporary folder");
    assert_eq!(run(&sample.join("campaign.toml"), folder.path(), "csv"), 0);
    let found = json(&folder.path().join("identification.json"));
    let beta = value(&found["joint"], "damping_ratio");
    assert!((beta - 0.005).abs() < 5e-4, "{beta}");
    let findings = found["verdict"]["findings"].to_string();
    assert!(findings.contains("0.02 does not fit") && findings.contains("0.002 does not fit"));
}
