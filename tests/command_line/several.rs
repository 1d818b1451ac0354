//! Several campaigns in one run.

use std::fs;

use crate::support::{Lab, files};

/// A laboratory with three days: two good ones, and one whose machine is not known.
fn days() -> Lab {
    let lab = Lab::new();
    let names = ["campaign.toml", "runs.csv", "r1.csv", "r2.csv", "r3.csv"];
    for day in ["day1", "day2", "day3"] {
        fs::create_dir(lab.path(day)).expect("a folder");
        for name in names {
            fs::copy(lab.path(name), lab.path(&format!("{day}/{name}"))).expect("a copy");
        }
    }
    lab.replace("day2/campaign.toml", "\"double\"", "\"triple\"");
    lab
}

#[test]
fn each_campaign_is_as_if_run_alone_and_one_that_fails_stops_none() {
    let lab = days();
    let alone = lab.run(&["-q", "run", "day3/campaign.toml", "--out", "out/day3"]);
    let expected = files(&lab.path("out/day3"));
    assert!(expected.contains_key("report.pdf"), "{}", alone.said);
    fs::remove_dir_all(lab.path("out")).expect("it is there");

    // the pattern is left to the program, as by the shells of Windows
    let ran = lab.run(&[
        "run",
        "*/campaign.toml",
        "day1/campaign.toml",
        "--out",
        "out",
    ]);
    assert_eq!(ran.code, 2, "{}", ran.said);
    for words in [
        "[2/3] day2/campaign.toml",
        "unknown variant `triple`",
        "failed: ",
    ] {
        assert!(ran.said.contains(words), "{words} is not in {}", ran.said);
    }
    assert!(files(&lab.path("out/day3")) == expected, "day3 differs");
    assert!(lab.path("out/day1/identification.json").is_file());
    assert!(!lab.path("out/day2").exists());

    let rows = lab.read("out/summary.csv");
    let rows: Vec<&str> = rows.lines().collect();
    assert_eq!(rows.len(), 4);
    assert!(rows[1].starts_with(&format!("day1/campaign.toml,day1,{},", alone.code)));
    assert!(rows[2].starts_with("day2/campaign.toml,day2,2,,"));
    let summary: serde_json::Value =
        serde_json::from_str(&lab.read("out/summary.json")).expect("JSON");
    let found: serde_json::Value =
        serde_json::from_str(&lab.read("out/day1/identification.json")).expect("JSON");
    let listed = &summary["campaigns"];
    assert_eq!(listed[0]["result"]["verdict"], found["verdict"]["kind"]);
    assert_eq!(listed[0]["result"]["usable_records"], 3);
    let remedy = listed[1]["errors"][0]["remedy"].as_str();
    assert!(remedy.is_some_and(|r| !r.is_empty()), "{listed}");
}

#[test]
fn results_of_another_version_fail_their_campaign_alone() {
    let lab = days();
    fs::create_dir_all(lab.path("out/day1")).expect("a folder");
    let old = r#"{"versions": {"identification.json": "1"}}"#;
    lab.write("out/day1/identification.json", old);
    let ran = lab.run(&[
        "run",
        "day1/campaign.toml",
        "day3/campaign.toml",
        "--out",
        "out",
        "--format",
        "html",
    ]);
    assert_eq!(ran.code, 2, "{}", ran.said);
    assert!(
        ran.said.contains("identification.json has layout 1"),
        "{}",
        ran.said
    );
    assert_eq!(lab.read("out/day1/identification.json"), old);
    assert!(lab.path("out/day3/report.html").is_file());
}
