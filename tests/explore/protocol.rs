//! What a page asks, and what it gets: the numbers of the library, and the files of `impactid study`.

use std::collections::BTreeMap;
use std::process::Command;

use impact_oscillator::atlas::map::{RegionMap, even, first_map};
use impact_oscillator::{
    Initial, Machine, MapGrid, MapSettings, ModelError, Restitution, Setting, Watch, region_map,
    rho_s2, settle,
};
use serde_json::{Value, json};

use super::server::{Explorer, Frame, Page, STUDIES};

/// The labels of a tile of a level, row by row.
fn labels(page: &mut Page, state: &Value, level: u64) -> Vec<String> {
    let id = page.ask(&json!({"kind": "map"}), state);
    let mut all = Vec::new();
    loop {
        let frame = page.next().expect("a tile");
        assert_eq!(frame.kind(), "map");
        if frame.header["level"] != level || frame.header["id"] != id {
            continue;
        }
        let size = &frame.header["size"];
        let columns = size[0].as_u64().expect("columns");
        assert_eq!(frame.header["first_row"], all.len() as u64 / columns);
        let motions = frame.header["motions"].as_array().expect("motions");
        let label = |cell: &u16| motions[*cell as usize]["label"].as_str().expect("a label");
        all.extend(frame.cells.iter().map(|c| label(c).to_owned()));
        if all.len() as u64 == columns * size[1].as_u64().expect("rows") {
            return all;
        }
    }
}

type Map = fn(&Machine, &MapGrid, &MapSettings) -> Result<RegionMap, ModelError>;

fn expected(
    map: Map,
    machine: &Machine,
    (columns, rows): (usize, usize),
    start: Initial,
) -> Vec<String> {
    let grid = MapGrid::even((0.6, 2.4, columns), (-0.5, 4.0, rows));
    let settings = MapSettings {
        start,
        ..MapSettings::default()
    };
    let map = map(machine, &grid, &settings).expect("a map");
    map.cells.iter().map(|c| c.label()).collect()
}

#[test]
fn valid_tiles_equal_the_maps_cell_for_cell() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let mut state = page.hello().header["state"].clone();
    state["view"] = json!({"eta": [0.6, 2.4], "rho": [-0.5, 4.0]});
    let machine = Machine::symmetric(0.07, 0.9);
    let rest = Initial::rest();
    assert_eq!(
        labels(&mut page, &state, 0),
        expected(first_map, &machine, (32, 24), rest)
    );
    assert_eq!(
        labels(&mut page, &state, 1),
        expected(first_map, &machine, (128, 96), rest)
    );
    let start = Initial::both(0.0, 3.0);
    state["map_start"] = json!(start);
    assert_eq!(
        labels(&mut page, &state, 1),
        expected(first_map, &machine, (128, 96), start)
    );
    assert_eq!(
        labels(&mut page, &state, 2),
        expected(region_map, &machine, (384, 288), start)
    );
    let law = Restitution::Table(vec![(0.0, 0.95), (6.0, 0.8)]);
    state["restitution"] = json!(law);
    let machine = machine.with_restitution(law);
    assert_eq!(
        labels(&mut page, &state, 0),
        expected(region_map, &machine, (32, 24), start)
    );
}

#[test]
fn valid_boundaries_are_the_closed_forms() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let state = page.hello().header["state"].clone();
    let id = page.ask(&json!({"kind": "boundaries", "points": 101}), &state);
    let bare = page.next().expect("the bare ones");
    assert_eq!(
        (bare.kind(), &bare.header["id"]),
        ("boundaries", &json!(id))
    );
    let checked = page.next().expect("with existence");
    assert_eq!(checked.header["name"], "s2:1");
    let machine = Machine::symmetric(0.07, 0.9);
    let mut valid = 0;
    for (i, eta) in checked.column("eta").iter().enumerate() {
        let eta_of_grid = 0.5 + 3.0 * i as f64 / 100.0;
        assert!((f64::from(*eta) - eta_of_grid).abs() < 1e-6);
        let Some(point) = rho_s2(&machine, eta_of_grid, 1) else {
            continue;
        };
        let near = |rho: f32| (f64::from(rho) - point.rho).abs() < 1e-5 * point.rho.abs().max(1.0);
        assert!(near(bare.column("s2:1")[i]) && near(checked.column("rho")[i]));
        assert_eq!(checked.column("exists")[i] > 0.0, point.is_valid());
        valid += usize::from(point.is_valid());
    }
    assert!(valid > 20);
}

#[test]
fn valid_the_motion_is_the_one_that_settles_and_is_carried_through_hysteresis() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let mut state = page.hello().header["state"].clone();
    let machine = Machine::symmetric(0.07, 0.9);
    let (motion, _) = settle(
        &machine,
        Setting::new(1.3, 1.0),
        Initial::rest(),
        &Watch::default(),
    )
    .expect("a motion");
    let frame = page.answer(&json!({"kind": "motion"}), &state);
    assert_eq!(frame.header["motion"]["label"], motion.label());
    assert_eq!(frame.column("x").len(), 1601);
    // up through the hysteresis region at ρ = 2 to beyond s2 (η = 1.5688), and back
    let mut seen = Vec::new();
    let mut at = json!([1.3, 1.0]);
    for eta in [1.2, 1.5, 1.6, 1.5, 1.19] {
        state["cursor"]["eta"] = json!(eta);
        state["cursor"]["rho"] = json!(2.0);
        let frame = page.answer(&json!({"kind": "motion", "carried_from": at}), &state);
        seen.push(
            frame.header["motion"]["label"]
                .as_str()
                .expect("a label")
                .to_owned(),
        );
        state["cursor"] = frame.header["cursor"].clone();
        at = json!([eta, 2.0]);
    }
    assert_eq!(seen, ["1", "1", "0", "0", "1"]);
}

#[test]
fn valid_coexisting_motions_are_those_that_the_basins_grid_settles_on() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let mut state = page.hello().header["state"].clone();
    // within the hysteresis region of z = 1 and z = 0
    state["cursor"] = json!({"eta": 1.5, "rho": 2.0});
    state["basins"] = json!({"x": [-8.0, 2.0], "vx": [-8.0, 8.0], "cells": [12, 9]});
    let frame = page.answer(&json!({"kind": "coexisting"}), &state);
    let machine = Machine::symmetric(0.07, 0.9);
    let mut want: BTreeMap<String, u64> = BTreeMap::new();
    for vx in even((-8.0, 8.0, 9)) {
        for x in even((-8.0, 2.0, 12)) {
            let start = Initial::both(x, vx);
            let found = settle(&machine, Setting::new(1.5, 2.0), start, &Watch::default());
            *want.entry(found.expect("a motion").0.label()).or_default() += 1;
        }
    }
    let motions = frame.header["motions"].as_array().expect("motions");
    let counts = frame.header["counts"].as_array().expect("counts");
    let found = motions.iter().zip(counts).map(|(m, n)| {
        let label = m["label"].as_str().expect("a label").to_owned();
        (label, n.as_u64().expect("a count"))
    });
    assert_eq!(found.collect::<BTreeMap<_, _>>(), want);
    assert_eq!(want.keys().collect::<Vec<_>>(), ["0", "1"]);
}

#[test]
fn an_inset_shows_the_motion_that_its_start_settles_on() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let mut state = page.hello().header["state"].clone();
    state["cursor"] = json!({"eta": 1.3, "rho": 1.0});
    let inset = page.answer(&json!({"kind": "inset"}), &state);
    assert_eq!(inset.header["motion"]["label"], "1");
    // settled: every period passes the same point
    let x = inset.column("poincare_x");
    assert!(x.iter().all(|v| (v - x[0]).abs() < 1e-4), "{x:?}");
    state["insets"] = json!(vec![json!({"eta": 1.3, "rho": 1.0}); 13]);
    refused(&page.answer(&json!({"kind": "motion"}), &state), "insets");
}

#[test]
fn a_running_motion_goes_on_where_it_was() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let mut state = page.hello().header["state"].clone();
    let mut last: Option<f32> = None;
    for _ in 0..40 {
        let frame = page.answer(&json!({"kind": "run", "periods": 0.37}), &state);
        let x = frame.column("x");
        if let Some(last) = last {
            assert!((x[0] - last).abs() < 1e-5, "{} after {last}", x[0]);
        }
        last = x.last().copied();
        state["cursor"] = frame.header["cursor"].clone();
    }
    let much = page.answer(&json!({"kind": "run", "periods": 1e9}), &state);
    assert_eq!(much.kind(), "refused");
}

/// The files that the explorer exports, by name.
fn exported(page: &mut Page, kind: &str, state: &Value) -> BTreeMap<String, String> {
    let frame = page.answer(&json!({"kind": kind}), state);
    assert_eq!(frame.kind(), "files", "{}", frame.header);
    let files = frame.header["files"].as_array().expect("files");
    let text = |f: &Value, key: &str| f[key].as_str().expect("text").to_owned();
    files
        .iter()
        .map(|f| (text(f, "name"), text(f, "text")))
        .collect()
}

#[test]
fn valid_the_exported_study_leaves_the_same_tables() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let mut state = page.hello().header["state"].clone();
    state["view"] = json!({"eta": [0.6, 2.4], "rho": [0.1, 4.0]});
    state["cursor"] = json!({"eta": 1.234567, "rho": 1.1, "phase": 0.3,
        "start": {"x": 0.1234567890123, "vx": -0.2, "y": 0.3, "vy": 0.1}});
    state["line"] = json!({"eta": [1.0, 1.7], "rho": [2.0, 2.1], "steps": 12});
    state["basins"] = json!({"x": [-3.0, 1.0], "vx": [-3.0, 3.0], "cells": [11, 9]});
    let folder = tempfile::tempdir().expect("a folder");
    for (panel, table) in [
        ("motion", "motion.csv"),
        ("line", "characteristics.csv"),
        ("basins", "basins.csv"),
    ] {
        state["panel"] = json!(panel);
        let study = exported(&mut page, "study", &state);
        let path = folder.path().join(format!("{panel}.toml"));
        std::fs::write(&path, &study["study.toml"]).expect("it is written");
        let done = Command::new(env!("CARGO_BIN_EXE_impactid"))
            .args(["-q", "study"])
            .arg(&path)
            .arg("--out")
            .arg(folder.path())
            .status()
            .expect("it runs");
        assert!(done.success());
        let files = exported(&mut page, "tables", &state);
        assert!(
            files.contains_key(table) && files.contains_key("map.csv"),
            "{:?}",
            files.keys()
        );
        for (name, text) in files {
            let theirs = std::fs::read_to_string(folder.path().join(panel).join(&name));
            assert!(theirs.expect("a table") == text, "{panel}: {name} differs");
        }
    }
}

fn refused(frame: &Frame, word: &str) {
    assert_eq!(frame.kind(), "refused", "{}", frame.header);
    let message = frame.header["message"].as_str().expect("a message");
    assert!(message.contains(word), "{message}");
    assert!(
        !frame.header["remedy"]
            .as_str()
            .expect("a remedy")
            .is_empty()
    );
}

#[test]
fn states_of_other_versions_and_out_of_range_are_refused_with_a_reason() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let state = page.hello().header["state"].clone();
    let motion = json!({"kind": "motion"});
    for (key, value, word) in [
        ("/version", json!(2), "version 2"),
        ("/version", json!("1"), "version"),
        ("/restitution", json!(1.5), "restitution"),
        ("/damping_ratio", json!(-0.1), "damping"),
        ("/cursor/eta", json!(0.0), "cursor"),
        ("/cursor/eta", json!(1e-6), "0.02 to 100"),
        ("/cursor/start/vx", json!(-1e308), "cursor = -1e308"),
        ("/asymmetry/stiffness", json!(1e9), "0.01 to 100"),
        ("/asymmetry/mass", json!(1e308), "asymmetry.mass = 1e308"),
        ("/view/eta", json!([2.0, 1.0]), "view.eta"),
        ("/periods", json!(1e9), "periods"),
        ("/watch/settle_periods", json!(1e12), "settle_periods"),
        (
            "/line",
            json!({"eta": [1.0, 2.0], "rho": [1.0, 1.0], "steps": 1_000_000}),
            "line.steps",
        ),
        (
            "/line",
            json!({"eta": [1.0, 1.0], "rho": [1.0, 1.0], "steps": 20}),
            "another one where η stays",
        ),
        (
            "/basins",
            json!({"x": [0.0, 1.0], "vx": [0.0, 1.0], "cells": [100_000, 2]}),
            "basins.cells",
        ),
        ("/panel", json!("nothing"), "unknown variant"),
    ] {
        let mut spoiled = state.clone();
        *spoiled.pointer_mut(key).expect(key) = value;
        refused(&page.answer(&motion, &spoiled), word);
    }
    let mut more = state.clone();
    more["surprise"] = json!(1);
    refused(&page.answer(&motion, &more), "surprise");
    refused(
        &page.answer(&json!({"kind": "record"}), &state),
        "no campaign",
    );
    refused(
        &page.answer(&json!({"kind": "demo", "name": "/etc/passwd"}), &state),
        "/etc/passwd",
    );
}

#[test]
fn demos_show_the_motions_that_they_state() {
    let done = Command::new(env!("CARGO_BIN_EXE_impactid"))
        .args(["explore", "--check"])
        .output()
        .expect("it runs");
    let said =
        String::from_utf8_lossy(&done.stderr).into_owned() + &String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success(), "{said}");
    let mut demos = 0;
    for line in said.lines().filter(|line| line.contains(" steps, ")) {
        let (steps, expected) = line.rsplit_once(" steps, ").expect("the counts");
        let steps = steps.rsplit(' ').next();
        assert_eq!(
            steps,
            expected.split(' ').next(),
            "a step expects nothing: {line}"
        );
        demos += 1;
    }
    assert!(demos > 8, "{said}");
    for figure in [
        "Fig. 2",
        "Fig. 4",
        "Fig. 5",
        "Fig. 7(b)",
        "Fig. 8",
        "Figs. 11 to 13",
    ] {
        assert!(said.contains(figure), "{figure} is missing:\n{said}");
    }
}

#[test]
fn a_recorded_demo_is_replayed_as_it_was() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let first = page.hello().header["state"].clone();
    let mut second = first.clone();
    second["restitution"] = json!({"table": [[0.0, 0.95], [6.0, 0.8]]});
    second["cursor"]["eta"] = json!(1.55);
    second["panel"] = json!("line");
    second["line"] = json!({"eta": [1.0, 2.0], "rho": [1.0, 1.0], "steps": 20,
        "start": {"x": 0.0, "vx": 0.0, "y": 0.0, "vy": 0.0}});
    let steps = json!([[0.5, first], [1.25, second], [0.75, first]]);
    let ask = json!({"kind": "write_demo", "title": "by hand", "steps": steps});
    let text = page.answer(&ask, &first).header["text"]
        .as_str()
        .expect("text")
        .to_owned();
    let demo = page.answer(&json!({"kind": "read_demo", "text": text}), &first);
    let read = demo.header["steps"].as_array().expect("steps");
    let states: Vec<Value> = read.iter().map(|s| s["state"].clone()).collect();
    let without_nulls = |v: &Value| {
        let mut v = v.clone();
        if let Some(o) = v.as_object_mut() {
            o.retain(|_, v| !v.is_null());
        }
        v
    };
    let states: Vec<Value> = states.iter().map(without_nulls).collect();
    let wanted: Vec<Value> = [&first, &second, &first].map(without_nulls).to_vec();
    assert_eq!(states, wanted);
    assert_eq!(read[1]["seconds"], 1.25);
    let older = text.replace("version = 1", "version = 0");
    refused(
        &page.answer(&json!({"kind": "read_demo", "text": older}), &first),
        "version",
    );
}

#[test]
fn the_newest_request_of_a_slot_is_answered_to_its_end() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let mut state = page.hello().header["state"].clone();
    state["asymmetry"]["stiffness"] = json!(0.95);
    let mut newest = 0;
    for i in 0..30 {
        state["restitution"] = json!(0.5 + 0.01 * f64::from(i));
        newest = page.ask(&json!({"kind": "basins"}), &state);
    }
    let mut answered = 0;
    let mut rows = 0;
    while rows < 101 {
        let frame = page.next().expect("a frame");
        answered += usize::from(frame.header["id"] != newest);
        if frame.header["id"] == newest && frame.header["level"] == 1 {
            rows += frame.cells.len() / 101;
        }
    }
    // the others were dropped, or stopped after a strip or two
    assert!(
        answered < 30 * 8,
        "{answered} frames of requests that were replaced"
    );
}

#[test]
fn every_sample_study_opens_under_its_title() {
    let studies = std::fs::read_dir(STUDIES).expect("studies");
    let mut opened = 0;
    for study in studies.map(|f| f.expect("a file").path()) {
        let text = std::fs::read_to_string(&study).expect("a study");
        let table: toml::Table = text.parse().expect("TOML");
        let explorer = Explorer::start(&[study.to_str().expect("a path")], &std::env::temp_dir());
        let mut page = explorer.page();
        let hello = page.hello();
        assert_eq!(hello.header["title"].as_str(), table["title"].as_str());
        let motion = page.answer(&json!({"kind": "motion"}), &hello.header["state"]);
        assert_eq!(motion.kind(), "motion", "{}", study.display());
        opened += 1;
    }
    assert!(opened >= 9);
}
