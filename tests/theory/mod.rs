//! The verbs of the theory: what they leave, replays, parts and their merge, runs broken off.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use crate::support::Lab;

/// All files of a folder.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    fs::read_dir(folder)
        .expect("the folder")
        .map(|e| e.expect("an entry"))
        .filter(|e| e.path().is_file())
        .map(|e| {
            let bytes = fs::read(e.path()).expect("a file");
            (e.file_name().to_string_lossy().into_owned(), bytes)
        })
        .collect()
}

fn run(lab: &Lab, words: &str) -> String {
    let words: Vec<&str> = words.split_whitespace().collect();
    let ran = lab.run(&words);
    assert_eq!(ran.code, 0, "{words:?}: {}", ran.said);
    ran.said
}

#[test]
fn each_verb_writes_tables_figures_and_a_study_that_replays_it() {
    let lab = Lab::new();
    let verbs = [
        (
            "motion",
            "simulate --eta 0.95 --rho 0.7 --restitution 0 --damping-ratio 0.1 \
             --start=-1,1.5,-3,2.5 --phase 0.785398 --periods 3 --poincare-periods 60",
        ),
        (
            "sweep",
            "sweep --eta 1.1..1.7 --rho 2 --steps 13 --settle-periods 60 --watch-periods 20",
        ),
        (
            "basins",
            "basins --eta 1.4 --rho 2 --x=-6..2 --vx=-6..6 --columns 9 --rows 9 --phase 0.3",
        ),
        (
            "atlas",
            "atlas --eta 0.8..1.6 --rho 0.2..4 --columns 9 --rows 9 --largest-p 2 --largest-n 2",
        ),
    ];
    for (name, verb) in verbs {
        run(&lab, &format!("{verb} --out first/{name}"));
        let first = files(&lab.path(&format!("first/{name}")));
        let table = if name == "atlas" { "atlas-map" } else { name };
        for file in [
            format!("{table}.csv"),
            format!("{table}.parquet"),
            format!("{name}.svg"),
            format!("{name}.png"),
            format!("{name}.pdf"),
            "study.toml".to_owned(),
        ] {
            assert!(first.contains_key(&file), "{name} leaves no {file}");
        }
        assert!(first[&format!("{name}.pdf")].starts_with(b"%PDF"));
        run(&lab, &format!("study first/{name}/study.toml --out again"));
        let again = files(&lab.path(&format!("again/{name}")));
        assert!(first == again, "{name} is not replayed");
    }
}

#[test]
fn merged_parts_are_the_whole_atlas_byte_for_byte() {
    let lab = Lab::new();
    let atlas = "atlas --eta 0.8..2.4 --rho 0.05..3 --columns 11 --rows 10 --largest-p 2 \
                 --largest-n 2";
    run(&lab, &format!("{atlas} --out whole"));
    for part in ["0/3", "1/3", "2/3"] {
        run(&lab, &format!("{atlas} --shard {part} --out parts"));
    }
    let all = "parts/part-0-of-3.json parts/part-1-of-3.json parts/part-2-of-3.json";
    run(&lab, &format!("merge {all} --out merged"));
    let whole = files(&lab.path("whole"));
    assert!(whole.contains_key("study.toml"));
    assert!(whole == files(&lab.path("merged")));
    run(&lab, "study merged/study.toml --out again");
    assert!(whole == files(&lab.path("again/merged")));
    run(
        &lab,
        &format!("{atlas} --restitution 0.8 --shard 1/3 --out other"),
    );
    for (parts, said) in [
        ("parts/part-0-of-3.json parts/part-2-of-3.json", "missing"),
        (
            "parts/part-0-of-3.json parts/part-0-of-3.json parts/part-1-of-3.json",
            "twice",
        ),
        (
            "parts/part-0-of-3.json other/part-1-of-3.json parts/part-2-of-3.json",
            "another atlas",
        ),
        ("runs.csv", "no part"),
    ] {
        let words: Vec<&str> = ["merge"]
            .into_iter()
            .chain(parts.split(' '))
            .chain(["--out", "refused"])
            .collect();
        let ran = lab.run(&words);
        assert_eq!(ran.code, 2, "{parts}");
        assert!(ran.said.contains(said), "{}", ran.said);
        assert!(!lab.path("refused").join("atlas.svg").exists());
    }
}

#[test]
fn a_killed_sweep_resumes_to_the_same_bytes() {
    let lab = Lab::new();
    let sweep = "sweep --eta 1.1..1.7 --rho 2 --steps 66 --settle-periods 100";
    run(&lab, &format!("{sweep} --out whole"));
    let mut child = Command::new(env!("CARGO_BIN_EXE_impactid"))
        .args(format!("{sweep} --out broken").split_whitespace())
        .current_dir(lab.path("."))
        .stderr(Stdio::null())
        .spawn()
        .expect("the program");
    let block = lab.path("broken/.impactid-blocks/sweep_forward.json.gz");
    let start = Instant::now();
    while !block.exists() && start.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().expect("a kill");
    child.wait().expect("an end");
    assert!(block.exists());
    assert!(!lab.path("broken/study.toml").exists());
    run(&lab, &format!("{sweep} --resume --out broken"));
    assert!(files(&lab.path("whole")) == files(&lab.path("broken")));
    assert!(!lab.path("broken/.impactid-blocks").exists());
}

#[test]
fn single_boundary_points_are_json() {
    let lab = Lab::new();
    for (words, rho) in [
        ("s2 --eta 1.3", 4.151_754),
        ("s2 --eta 1.1", 6.351_142),
        ("s2 --eta 1.6", 1.812_702),
        ("s1 --eta 0.9", 1.760_461),
        ("grazing --eta 1.3", 1.401_347),
        ("joined --eta 1.3", -1.0),
    ] {
        let said = run(
            &lab,
            &format!("boundary --restitution 0.9 --damping-ratio 0.07 --json --kind {words}"),
        );
        let value: serde_json::Value = serde_json::from_str(&said).expect("JSON");
        let found = value["rho"].as_f64().expect("a number");
        assert!((found - rho).abs() < 2e-6, "{words}: {found}");
        assert_eq!(value["valid"], true, "{words}");
    }
    assert_eq!(
        lab.run(&["boundary", "--kind", "s2", "--motion", "5/1", "--eta", "4"])
            .code,
        1
    );
}

fn boundary(lab: &Lab, words: &str) -> serde_json::Value {
    let said = run(
        lab,
        &format!("boundary --restitution 0.9 --damping-ratio 0.07 --json {words}"),
    );
    serde_json::from_str(&said).expect("JSON")
}

#[test]
fn boundaries_at_a_clearance_are_those_at_their_frequency_ratio() {
    let lab = Lab::new();
    for (kind, rho) in [
        ("s1 --motion 2/1", "-0.3"),
        ("s2 --motion 3/2", "0.13"),
        ("s2 --motion 2/1", "-0.4"),
        ("further-impact --motion 1/2", "1.9"),
        ("further-impact --motion 2/1", "-0.45"),
        ("s1 --motion 3/2", "0"),
        ("dead-zone --motion 1j", "-0.875"),
    ] {
        let at_rho = boundary(&lab, &format!("--kind {kind} --rho={rho}"));
        let eta = at_rho["eta"].as_f64().expect("a number");
        let at_eta = boundary(&lab, &format!("--kind {kind} --eta {eta}"));
        let others = at_eta["others"].as_array().cloned().unwrap_or_default();
        let rho: f64 = rho.parse().expect("a number");
        let nearest = others
            .iter()
            .chain([&at_eta])
            .filter_map(|v| v["rho"].as_f64())
            .map(|found| (found - rho).abs())
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < 2e-5, "{kind}: η = {eta}, {nearest} away");
    }
}

#[test]
fn dead_zones_of_uneven_machines_and_of_speed_dependent_restitution() {
    let lab = Lab::new();
    let point = |words: &str| -> serde_json::Value {
        let said = run(&lab, &format!("boundary --kind dead-zone --json {words}"));
        serde_json::from_str(&said).expect("JSON")
    };
    for (words, eta) in [
        (
            "--restitution 0 --drive-ratio 0.9 --damping-ratio 0.07",
            1.3,
        ),
        ("--restitution 0 --mass-ratio 1.2 --damping-ratio 0.05", 1.1),
        (
            "--restitution table=[[0,0.6],[4,0.5]] --damping-ratio 0.07",
            0.9,
        ),
        (
            "--restitution 0.5 --stiffness-ratio 0.9 --damping-ratio 0.07",
            0.7,
        ),
    ] {
        let at_eta = point(&format!("--motion 1j {words} --eta {eta}"));
        let rho = at_eta["rho"].as_f64().expect("a number");
        let at_rho = point(&format!("--motion 1j {words} --rho={rho}"));
        let others = at_rho["others"].as_array().cloned().unwrap_or_default();
        let nearest = others
            .iter()
            .chain([&at_rho])
            .filter_map(|v| v["eta"].as_f64())
            .map(|found| (found - eta).abs())
            .fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-5, "{words}: {at_eta} {at_rho}");
        if words.contains("--restitution 0 ") {
            let moving = point(&format!("--motion 1/1 {words} --eta {eta}"));
            let other = moving["rho"].as_f64().expect("a number");
            assert!((other - rho).abs() < 1e-6, "{words}: {rho} {other}");
        }
    }
    for (words, why) in [
        ("--motion 3/1 --restitution 0.9", "after a complete chatter"),
        ("--motion 1j --restitution 1", "never come to rest"),
    ] {
        let words = format!("boundary --kind dead-zone {words} --eta 0.8");
        let ran = lab.run(&words.split_whitespace().collect::<Vec<_>>());
        assert_eq!(ran.code, 1);
        assert!(ran.said.contains(why), "{}", ran.said);
    }
}

#[test]
fn a_motion_without_a_boundary_at_a_clearance_is_named() {
    let lab = Lab::new();
    let words = ["boundary", "--kind", "s2", "--motion", "7/5", "--rho", "30"];
    let ran = lab.run(&words);
    assert_eq!(ran.code, 1);
    assert!(
        ran.said.contains("s2 of z = 7/5: none at ρ = 30"),
        "{}",
        ran.said
    );
}
