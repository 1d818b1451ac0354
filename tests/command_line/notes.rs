//! What the commands say about a campaign, and in which language.

use crate::support::{Lab, Ran};

fn run(lab: &Lab, more: &[&str]) -> Ran {
    let usual = ["run", "campaign.toml", "--out", "out", "--format", "csv"];
    lab.run(&[&usual[..], more].concat())
}

#[test]
fn run_speaks_the_language_of_its_report() {
    let lab = Lab::new();
    let english = run(&lab, &[]);
    assert!(english.said.contains("Report (csv): "), "{}", english.said);
    let german = run(&lab, &["--language", "DE"]);
    assert_eq!(german.code, english.code);
    assert!(german.said.contains("Bericht (csv): "), "{}", german.said);
    let verdict = |ran: &Ran| ran.said.lines().next().map(str::to_owned);
    assert_ne!(verdict(&german), verdict(&english));
    for raw in ["mass_asymmetry", "gain_velocity", "velocity_x reads"] {
        assert!(!english.said.contains(raw), "{}", english.said);
    }
}

#[test]
fn a_language_without_texts_is_named() {
    let lab = Lab::new();
    lab.edit("paper = \"a4\"", "paper = \"a4\"\nlanguage = \"fr\"");
    let says = "there are no texts in the language \"fr\"";
    let checked = lab.run(&["check", "campaign.toml"]);
    assert_eq!(checked.code, 0, "{}", checked.said);
    for said in [checked.said, run(&lab, &[]).said] {
        assert!(said.contains(says), "{said}");
    }
    let german = run(&lab, &["--language", "de"]).said;
    assert!(!german.contains(says), "{german}");
}

#[test]
fn run_prints_which_unit_of_time_was_assumed() {
    let lab = Lab::new();
    lab.replace("r2.csv", "time [s]", "time");
    let says = "time axis 'time' has no unit: taken as seconds";
    assert!(run(&lab, &[]).said.contains(says));
    let quiet = run(&lab, &["-q"]).said;
    assert!(!quiet.contains(says), "{quiet}");
}

#[test]
fn a_folder_holds_the_results_of_one_campaign() {
    let lab = Lab::new();
    let first = run(&lab, &[]);
    lab.write("other.toml", &lab.read("campaign.toml"));
    let other = lab.run(&["run", "other.toml", "--out", "out", "--format", "csv"]);
    assert_eq!(other.code, 2, "{}", other.said);
    let says = "out holds results of other work (campaign.toml)";
    assert!(other.said.contains(says), "{}", other.said);
    assert_eq!(run(&lab, &[]).code, first.code);
    let folder = lab.run(&["report", "."]);
    assert!(
        folder.said.contains(". is the folder of a campaign"),
        "{}",
        folder.said
    );
}

#[test]
fn a_clearance_that_nothing_states_is_noted() {
    let lab = Lab::new();
    lab.replace("runs.csv", "clearance_mm", "note");
    let says = "no clearance is stated: R rests on the speeds at impacts alone";
    let checked = lab.run(&["check", "campaign.toml"]);
    assert!(checked.said.contains(says), "{}", checked.said);
    let ran = run(&lab, &[]);
    assert!(ran.said.contains(says), "{}", ran.said);
}

#[test]
fn run_says_that_nothing_is_stated_to_identify_from() {
    let lab = Lab::new();
    // a decay that is not stated to be one, of a mass that moves alone
    let rows: String = (0..2000)
        .map(|i| {
            let t = f64::from(i) * 1e-3;
            format!("{t:.3},{:.6}\n", (-0.5 * t).exp() * (38.0 * t).sin())
        })
        .collect();
    lab.write("decay.csv", &format!("t [s],v [m/s]\n{rows}"));
    let campaign = "[campaign]\nmachine = \"single\"\n[records]\nfiles = \"decay.csv\"\n[channels.velocity_x]\n\
                    channel = \"v\"\n";
    lab.write("campaign.toml", campaign);
    let says = "neither a drive nor free decays nor free flights are stated";
    let checked = lab.run(&["check", "campaign.toml"]).said;
    assert!(checked.contains(says), "{checked}");
    let ran = run(&lab, &[]).said;
    assert!(ran.contains(says), "{ran}");
    assert!(ran.contains("excitation = \"free_decay\""), "{ran}");
}

#[test]
fn init_counts_signals_and_names_those_left_over() {
    let lab = Lab::new();
    for name in ["r1.csv", "r2.csv", "r3.csv"] {
        lab.lines(name, |i, line| {
            let cell = if i == 0 { "lamp [K]" } else { "1" };
            Some(format!("{line},{cell}"))
        });
    }
    let ran = lab.run(&["init", ".", "--force"]);
    let says = "4 of 5 signals assigned to a role (not lamp)";
    assert!(ran.said.contains(says), "{}", ran.said);
}

#[test]
fn stages_go_on_from_another_directory() {
    let lab = Lab::new();
    std::fs::create_dir(lab.path("elsewhere")).expect("a folder");
    let done = lab.run(&["ingest", "campaign.toml", "--out", "out"]);
    assert_eq!(done.code, 0, "{}", done.said);
    let from_elsewhere = |stage: &str| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_impactid"))
            .args([stage, "../out"])
            .current_dir(lab.path("elsewhere"))
            .output()
            .expect("the program starts");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code().unwrap_or(-1), said)
    };
    for stage in ["classify", "identify", "report"] {
        let (code, said) = from_elsewhere(stage);
        assert!(
            code == 0 || stage == "identify" && code == 1,
            "{stage}: {said}"
        );
    }
    // what stage 1 left is named where it is gone
    lab.remove("out/ingested.h5");
    let (code, said) = from_elsewhere("classify");
    assert_eq!(code, 2);
    assert!(said.contains("out/ingested.h5: it is not there"), "{said}");
}

/// A folder whose name is no Unicode: its records are found from elsewhere too.
#[cfg(target_os = "linux")]
#[test]
fn records_in_a_folder_whose_name_is_no_unicode_are_found() {
    use std::os::unix::ffi::OsStrExt;
    let lab = Lab::new();
    let folder = lab.folder().join(std::ffi::OsStr::from_bytes(b"day\xff"));
    std::fs::create_dir_all(folder.join("sub")).expect("room");
    for name in ["campaign.toml", "runs.csv", "r1.csv", "r2.csv", "r3.csv"] {
        let below = if name.starts_with('r') && name != "runs.csv" {
            "sub"
        } else {
            ""
        };
        std::fs::copy(lab.path(name), folder.join(below).join(name)).expect("room");
    }
    let description = folder.join("campaign.toml");
    let text = std::fs::read_to_string(&description).expect("text");
    let text = text.replace("run_table = \"runs.csv\"", "files = \"s*/r*.csv\"");
    std::fs::write(&description, text).expect("room");
    let checked = std::process::Command::new(env!("CARGO_BIN_EXE_impactid"))
        .arg("check")
        .arg(&description)
        .output()
        .expect("it starts");
    let said = [checked.stdout, checked.stderr].concat();
    let said = String::from_utf8_lossy(&said);
    assert!(said.contains("3 of 3 records can be used"), "{said}");
}
