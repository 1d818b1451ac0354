//! `-v` prints more than nothing, `-vv` more than `-v`, and the help says what.

use crate::support::Lab;

const RUN: &[&str] = &["run", "campaign.toml", "--out", "out", "--format", "csv"];

/// A quick campaign: one record, whose last row is cut off.
fn lab() -> Lab {
    let lab = Lab::new();
    lab.write(
        "runs.csv",
        "file,drive_frequency_hz,clearance_mm,sweep\nr1.csv,11,1.0,up\n",
    );
    let record = lab.read("r1.csv");
    let (cut_off, _) = record.rsplit_once(',').expect("cells");
    lab.write("r1.csv", cut_off);
    lab
}

/// The standard error stream of a command.
fn said(lab: &Lab, command: &[&str], flag: &str) -> String {
    lab.run(&[command, &[flag]].concat()).said
}

#[test]
fn v_prints_versions_files_times_and_fits_and_vv_also_records_and_notes() {
    let lab = lab();
    let plain = lab.run(RUN).said;
    let (v, vv) = (said(&lab, RUN, "-v"), said(&lab, RUN, "-vv"));
    for words in [
        "versions: ",
        "impactid 0.",
        "files: 1, datasets: 1",
        "observe: ",
        "identify: ",
        "write: ",
        "total: ",
        "fit of speeds_at_impact: ",
        " iterations",
    ] {
        assert!(v.contains(words), "'{words}' is not in {v}");
        assert!(!plain.contains(words), "'{words}' is in {plain}");
    }
    for words in [
        "r1: 1",
        " 1.0000 mm, motion ",
        "confidence ",
        "r1.csv: note: the last row has",
        "fit of speeds_at_impact: ",
        "total: ",
    ] {
        assert!(vv.contains(words), "'{words}' is not in {vv}");
    }
    assert!(!v.contains("confidence ") && !v.contains("note: "), "{v}");
}

#[test]
fn the_stages_print_details_too() {
    let lab = lab();
    let ingest: &[&str] = &["ingest", "campaign.toml", "--out", "out"];
    assert!(said(&lab, ingest, "-vv").contains("note: the last row"));
    let classify: &[&str] = &["classify", "out"];
    assert!(said(&lab, classify, "-vv").contains("r1: 1"));
    assert!(!said(&lab, classify, "-v").contains("r1: 1"));
    let identify = said(&lab, &["identify", "out"], "-v");
    assert!(
        identify.contains("fit of speeds_at_impact: ") && identify.contains("identify: "),
        "{identify}"
    );
}

#[test]
fn the_help_states_what_v_and_vv_print() {
    let help = Lab::new().run(&["--help"]).said;
    let words = help.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words.contains("Print versions, files, stage times and how each fit ended"),
        "{words}"
    );
    assert!(
        words.contains("-vv also every record and the notes of the readers"),
        "{words}"
    );
}
