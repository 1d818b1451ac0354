//! The explorer without server and browser: states, demos, frames, studies.

use serde_json::{Value, json};

use super::demo::{self, Demo};
use super::frame::Frame;
use super::state::{Line, Panel, State};
use super::{ExploreError, Session, export};
use crate::theory::Study;

#[test]
fn a_frame_is_its_header_then_numbers_then_cells() {
    let frame = Frame::new("map", 7)
        .with("level", 1)
        .column("x", [1.5, f64::NAN])
        .cells(vec![3, 4, 500]);
    let bytes = frame.bytes();
    let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
    assert_eq!((4 + length) % 4, 0);
    let header: Value = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
    let want = json!({"kind": "map", "id": 7, "level": 1, "columns": [["x", 2]], "cells": 3});
    assert_eq!(header, want);
    let number = |at: usize| {
        let at = 4 + length + 4 * at;
        f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
    };
    assert!(number(0) == 1.5 && number(1).is_nan());
    assert_eq!(&bytes[4 + length + 8..], [3, 0, 4, 0, 244, 1]);
}

fn on_line(line: Line) -> State {
    State {
        panel: Panel::Line,
        line: Some(line),
        ..State::default()
    }
}

#[test]
fn a_state_is_the_same_after_writing_and_reading() {
    let line = Line {
        eta: (0.1 + 0.2, 1.0),
        rho: (1.0, -1.0 / 3.0),
        steps: 17,
        start: impact_oscillator::Initial::both(0.1, -0.2),
    };
    let state = on_line(line);
    let value = serde_json::to_value(&state).unwrap();
    let text = value.to_string();
    assert_eq!(State::read(value).unwrap(), state);
    let again: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(State::read(again).unwrap(), state);
}

#[test]
fn a_state_of_another_version_is_refused_as_such() {
    let mut value = serde_json::to_value(State::default()).unwrap();
    value["version"] = json!(99);
    value["from the future"] = json!(true);
    let refused = State::read(value).unwrap_err();
    assert!(
        matches!(&refused, ExploreError::Version { found, expected: 1 } if found == "99"),
        "{refused}"
    );
    assert!(refused.remedy().contains("version"));
}

const TWO_STEPS: &str = r#"
version = 1
title = "two steps"

[[step]]
seconds = 1.0
[step.state]
restitution = 0.5
line = { eta = [1.0, 2.0], rho = [1.0, 1.0], steps = 5 }

[[step]]
seconds = 2.0
[step.state]
cursor = { eta = 1.5 }
line = "none"
"#;

#[test]
fn a_step_of_a_demo_states_what_differs_from_the_one_before() {
    let demo = Demo::read(TWO_STEPS).unwrap();
    let [(_, first), (_, second)] = demo.steps.as_slice() else {
        panic!("two steps");
    };
    assert_eq!(first.cursor, State::default().cursor);
    assert_eq!(first.line.map(|l| l.steps), Some(5));
    assert_eq!(second.restitution, first.restitution);
    assert_eq!((second.cursor.eta, second.cursor.rho), (1.5, 1.0));
    assert_eq!(second.line, None);
    let states = demo
        .steps
        .iter()
        .map(|(s, state)| (s.seconds, json!(state)));
    let text = demo::write("again", &states.collect::<Vec<_>>()).unwrap();
    assert!(
        text.contains("line = \"none\"") && !text.contains("damping_ratio"),
        "{text}"
    );
    let shown = |demo: Demo| {
        let steps = demo.steps.into_iter();
        let all = steps.map(|(s, state)| (s.seconds, s.caption, s.carry, s.expect, state));
        all.collect::<Vec<_>>()
    };
    assert_eq!(shown(Demo::read(&text).unwrap()), shown(demo));
}

#[test]
fn demos_that_are_wrong_name_the_step() {
    for (from, to, word) in [
        ("eta = 1.5", "eta = -1.5", "step 2"),
        ("seconds = 2.0", "seconds = 1e9", "step 2"),
        ("steps = 5", "stesp = 5", "step 1"),
        ("version = 1", "version = 3", "version 3"),
        ("title", "titel", "title"),
    ] {
        let refused = Demo::read(&TWO_STEPS.replace(from, to))
            .unwrap_err()
            .to_string();
        assert!(refused.contains(word), "{refused}");
    }
}

#[test]
fn the_exported_study_opens_as_the_same_state() {
    let state = on_line(Line {
        eta: (1.0, 1.2),
        rho: (2.0, 2.0),
        steps: 3,
        start: impact_oscillator::Initial::rest(),
    });
    let study: Study = toml::from_str(&export::study_text(&state).unwrap()).unwrap();
    let opened = Session::study(&study).unwrap();
    assert_eq!(opened.state().line, state.line);
    assert_eq!(opened.state().view, state.view);
    assert_eq!(opened.state().panel, Panel::Line);
    let files = export::files(&state).unwrap();
    let names: Vec<&str> = files.iter().map(|f| f.0.as_str()).collect();
    assert!(
        names.contains(&"map.csv") && names.contains(&"characteristics.csv"),
        "{names:?}"
    );
    let rows = |name: &str| {
        let file = files.iter().find(|f| f.0 == name).unwrap();
        file.1.lines().count() - 1
    };
    assert_eq!(
        (rows("map.csv"), rows("characteristics.csv")),
        (128 * 96, 6)
    );
}
