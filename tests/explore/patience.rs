//! Simulations that nobody waits for end, and one page never stops another.

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use super::server::{Explorer, Page, SAMPLE};

/// The slowest that is accepted: thousands of natural periods in a drive period.
fn slowest(state: &Value) -> Value {
    let mut slow = state.clone();
    slow["asymmetry"]["stiffness"] = json!(100.0);
    slow["damping_ratio"] = json!(0.001);
    slow["view"] = json!({"eta": [0.02, 0.021], "rho": [0.5, 1.0]});
    slow["cursor"]["eta"] = json!(0.02);
    slow["line"] = json!({"eta": [0.02, 0.03], "rho": [0.5, 0.5], "steps": 2001});
    slow["watch"] = json!({"settle_periods": 250.0, "watch_periods": 60.0, "tolerance": 1e-9});
    slow["basins"] = json!({"x": [-1.0, 0.5], "vx": [-1.0, 1.0], "cells": [1000, 1000]});
    slow
}

/// Everything that is answered in a stream or in one go.
fn ask_all(page: &mut Page, state: &Value) {
    for kind in ["map", "basins", "line", "coexisting", "motion"] {
        page.ask(&json!({"kind": kind}), state);
    }
    page.ask(&json!({"kind": "boundaries", "points": 2000}), state);
}

/// Time that the server's threads have computed so far, in ticks of the system.
#[cfg(target_os = "linux")]
fn computed(explorer: &Explorer) -> u64 {
    let stat = format!("/proc/{}/stat", explorer.process());
    let stat = std::fs::read_to_string(stat).expect("the server lives");
    let fields = stat.rsplit_once(')').expect("a name").1;
    let ticks = fields.split_whitespace().skip(11).take(2);
    ticks.map(|t| t.parse::<u64>().expect("a number")).sum()
}

/// Wait until nothing is computed for a second.
#[cfg(target_os = "linux")]
fn rests(explorer: &Explorer) {
    let begin = Instant::now();
    let mut before = computed(explorer);
    loop {
        std::thread::sleep(Duration::from_secs(1));
        let now = computed(explorer);
        if now <= before + 2 {
            return;
        }
        assert!(begin.elapsed() < Duration::from_secs(60), "it computes on");
        before = now;
    }
}

#[test]
#[cfg(target_os = "linux")]
fn what_a_page_asked_for_ends_when_it_is_gone() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let state = page.hello().header["state"].clone();
    ask_all(&mut page, &slowest(&state));
    // everything is under way
    while page.next().expect("a frame").kind() != "boundaries" {}
    std::thread::sleep(Duration::from_secs(1));
    drop(page);
    rests(&explorer);
}

/// Of a kind of request on the sample what is asked and takes minutes: a record with a rig of thousands of natural
/// periods between two samples, tables of a slow machine.
fn slow_of(kind: &str, hello: &Value) -> Value {
    if kind == "tables" {
        return slowest(&hello["state"]);
    }
    let mut state = hello["state"].clone();
    state["rig"] = json!({"natural_frequency_hz": 1e6, "static_deflection_m": 1.0});
    state["damping_ratio"] = json!(1e-4);
    state["record"] = hello["campaign"]["records"][100]["id"].clone();
    state
}

#[test]
#[cfg(target_os = "linux")]
fn records_and_tables_end_when_their_page_is_gone() {
    let explorer = Explorer::start(&[SAMPLE], &std::env::temp_dir());
    for kind in ["record", "tables"] {
        let mut page = explorer.page();
        let hello = page.hello().header;
        page.ask(&json!({"kind": kind}), &slow_of(kind, &hello));
        std::thread::sleep(Duration::from_secs(1));
        drop(page);
        rests(&explorer);
    }
}

#[test]
fn a_record_and_tables_that_are_asked_for_again_end_in_their_middle() {
    let explorer = Explorer::start(&[SAMPLE], &std::env::temp_dir());
    let mut page = explorer.page();
    let hello = page.hello().header;
    for kind in ["record", "tables"] {
        let slow = slow_of(kind, &hello);
        page.ask(&json!({"kind": kind}), &slow);
        std::thread::sleep(Duration::from_secs(1));
        let mut moderate = hello["state"].clone();
        moderate["record"] = slow["record"].clone();
        let begin = Instant::now();
        let answer = page.answer(&json!({"kind": kind}), &moderate);
        assert_ne!(answer.kind(), "refused", "{}", answer.header);
        assert!(begin.elapsed() < Duration::from_secs(30), "{kind}");
    }
}

#[test]
fn one_page_never_stops_the_map_of_another() {
    let explorer = Explorer::theory();
    let mut first = explorer.page();
    let state = first.hello().header["state"].clone();
    ask_all(&mut first, &slowest(&state));
    while first.next().expect("a frame").kind() != "boundaries" {}
    let mut second = explorer.page();
    let id = second.ask(&json!({"kind": "map"}), &state);
    loop {
        let frame = second.next().expect("a frame");
        assert_eq!((frame.kind(), &frame.header["id"]), ("map", &json!(id)));
        if frame.header["last"] == json!(true) {
            break;
        }
    }
}

#[test]
fn what_is_replaced_ends_in_the_middle_of_a_simulation() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let state = page.hello().header["state"].clone();
    ask_all(&mut page, &slowest(&state));
    while page.next().expect("a frame").kind() != "boundaries" {}
    // the same page, back at moderate values
    let mut moderate = state.clone();
    moderate["line"] = json!({"eta": [1.0, 1.1], "rho": [1.0, 1.0], "steps": 5});
    ask_all(&mut page, &moderate);
    let mut open = BTreeSet::from([
        "map",
        "basins",
        "line",
        "coexisting",
        "motion",
        "boundaries",
    ]);
    while !open.is_empty() {
        let frame = page.next().expect("a frame");
        if frame.header["id"].as_u64() > Some(7) {
            assert_ne!(frame.kind(), "refused");
            open.remove(frame.kind());
        }
    }
}

#[test]
fn a_motion_that_would_take_minutes_is_refused() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let mut state = slowest(&page.hello().header["state"]);
    let motion = json!({"kind": "motion"});
    state["watch"]["settle_periods"] = json!(20000.0);
    let refused = page.answer(&motion, &state);
    assert_eq!(refused.kind(), "refused");
    let message = refused.header["message"].as_str().expect("a message");
    assert!(message.contains("too long"), "{message}");
    // the same number of periods at η = 1 is not
    let mut moderate = page.hello().header["state"].clone();
    moderate["watch"] = json!({"settle_periods": 20000.0, "watch_periods": 20000.0});
    assert_eq!(page.answer(&motion, &moderate).kind(), "motion");
}

#[test]
fn a_motion_of_countless_impacts_ends_and_what_was_given_up_is_no_answer() {
    let explorer = Explorer::theory();
    let mut page = explorer.page();
    let mut state = page.hello().header["state"].clone();
    state["asymmetry"] = json!({"drive_amplitude": 1.0, "stiffness": 100.0, "mass": 0.01});
    let motion = json!({"kind": "motion", "carried_from": [1.3, 1.0]});
    for start in [
        json!({"x": 0.47234, "vx": 2.2476, "y": 0.34557, "vy": 2.2169}),
        json!({"x": 0.44453, "vx": 2.1837, "y": 0.44453, "vy": 2.1837}),
    ] {
        state["cursor"]["start"] = start;
        let id = page.ask(&motion, &state);
        let mut last = page.next().expect("an answer");
        if last.kind() == "motion" {
            // it is whole: nothing else follows until the next answer
            page.ask(&json!({"kind": "boundaries", "points": 2}), &state);
            last = page.next().expect("the next answer");
            assert_eq!(last.kind(), "boundaries");
        } else {
            assert_eq!((last.kind(), &last.header["id"]), ("refused", &json!(id)));
        }
    }
}
