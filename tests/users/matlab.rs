//! A campaign as MATLAB saves it: one struct `rec` a file, with the record's vectors and the numbers of its setting. From
//! `init` to the report.

use std::fs;

use super::rig::{Take, assert_the_answer_is_true, done, state, takes};
use crate::support::Lab;

/// Kinds of elements of a MAT file of level 5.
const BYTES: u32 = 1;
const UNITS_OF_TEXT: u32 = 4;
const DIMENSIONS: u32 = 5;
const FLAGS: u32 = 6;
const DOUBLES: u32 = 9;
const ARRAY: u32 = 14;
/// Classes of arrays.
const STRUCT: u32 = 2;
const TEXT: u32 = 4;
const NUMBERS: u32 = 6;
/// Length of a field's name in the list of names.
const FIELD_BYTES: usize = 32;

fn element(kind: u32, data: &[u8]) -> Vec<u8> {
    let length = u32::try_from(data.len()).expect("a small file");
    let mut out = [kind.to_le_bytes(), length.to_le_bytes()].concat();
    out.extend(data);
    out.resize(out.len().next_multiple_of(8), 0);
    out
}

fn words(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

fn array(class: u32, rows: usize, columns: usize, name: &str, content: &[u8]) -> Vec<u8> {
    let size = [rows, columns].map(|n| u32::try_from(n).expect("a small file"));
    let parts = [
        element(FLAGS, &words(&[class, 0])),
        element(DIMENSIONS, &words(&size)),
        element(BYTES, name.as_bytes()),
        content.to_vec(),
    ];
    element(ARRAY, &parts.concat())
}

fn numbers(values: &[f64]) -> Vec<u8> {
    let data: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    array(NUMBERS, values.len(), 1, "", &element(DOUBLES, &data))
}

fn text(value: &str) -> Vec<u8> {
    let units: Vec<u8> = value.encode_utf16().flat_map(u16::to_le_bytes).collect();
    array(TEXT, 1, value.len(), "", &element(UNITS_OF_TEXT, &units))
}

/// A MAT file with one struct.
fn file(name: &str, fields: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut names = Vec::new();
    for (field, _) in fields {
        names.extend(field.as_bytes());
        names.resize(names.len().next_multiple_of(FIELD_BYTES), 0);
    }
    let mut content = element(DIMENSIONS, &words(&[32]));
    content.extend(element(BYTES, &names));
    content.extend(fields.iter().flat_map(|f| &f.1));
    let mut out = b"MATLAB 5.0 MAT-file, Platform: GLNXA64".to_vec();
    out.resize(124, b' ');
    out.extend([0, 1, b'I', b'M']);
    out.extend(array(STRUCT, 1, 1, name, &content));
    out
}

/// A record as the user's script saves it: velocities calibrated, m/s; no units.
fn saved(take: &Take) -> Vec<u8> {
    let number = |text: &str| numbers(&[text.parse().expect("a number")]);
    let fields = [
        ("time", numbers(&take.times())),
        ("drive", numbers(&take.channel("generator", 1.0))),
        ("contact", numbers(&take.channel("contact", 1.0))),
        ("vx", numbers(&take.channel("laser_x", 0.2))),
        ("vy", numbers(&take.channel("integrator_vy", 0.2))),
        ("gap_mm", number(&take.clearance_mm)),
        ("freq_hz", number(&take.frequency_hz)),
        ("sweep", text(if take.upward { "up" } else { "down" })),
        ("operator", text("F. P.")),
    ];
    file("rec", &fields)
}

#[test]
fn valid_matlab_structs_from_init_to_the_report() {
    let lab = Lab::new();
    let takes = takes(&lab, &["--rig", "exact", "--seed", "52", "--records", "60"]);
    for (number, take) in takes.iter().enumerate() {
        fs::write(lab.path(&format!("day/run{number:02}.mat")), saved(take)).expect("room");
    }
    done(&lab, &["init", "day"]);
    let written = lab.read("day/campaign.toml");
    for attribute in ["rec.gap_mm", "rec.freq_hz", "rec.sweep"] {
        assert!(written.contains(&format!("= \"{attribute}\"")), "{written}");
        assert!(
            !written.contains(&format!("channel = \"{attribute}\"")),
            "{written}"
        );
    }
    assert!(!written.contains("[channels.displacement"), "{written}");
    // what the user knows and no file states
    for (channel, unit) in [
        ("drive", "V"),
        ("contact", "V"),
        ("vx", "m/s"),
        ("vy", "m/s"),
    ] {
        state(
            &lab,
            &format!("rec.{channel}"),
            &format!("unit = \"{unit}\""),
        );
    }
    state(&lab, "rec.vy", "high_pass = \"0.5 Hz\"");
    assert_the_answer_is_true(&lab, 60);
}
