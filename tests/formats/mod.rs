//! `impactid inspect` and `impactid convert` as a user meets them.

use std::path::{Path, PathBuf};

use crate::support::Lab;

fn own(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("crates/labfiles/tests/data/formats")
        .join(name)
}

fn channels(lab: &Lab, file: &str, dataset: &str) -> Vec<serde_json::Value> {
    let ran = lab.run(&["inspect", file, "--json", "--dataset", dataset]);
    assert_eq!(ran.code, 0, "{}", ran.said);
    serde_json::from_str(&ran.said).expect("a list of channels")
}

#[test]
fn inspect_lists_channels_for_programs() {
    let lab = Lab::new();
    let file = own("tables_int16_gzip.h5");
    let list = channels(&lab, file.to_str().expect("a path"), "run2");
    let keys = [
        "name",
        "unit",
        "type",
        "samples",
        "sample_rate_hz",
        "first",
        "last",
        "sum",
        "min",
        "max",
    ];
    assert_eq!(list.len(), 3);
    for channel in &list {
        assert!(keys.iter().all(|k| channel.get(k).is_some()), "{channel}");
    }
    assert_eq!(list[1]["name"], "velocity_x");
    assert_eq!(
        (&list[1]["unit"], &list[1]["type"]),
        (&"mm/s".into(), &"int16".into())
    );
    assert_eq!(
        (&list[1]["samples"], &list[1]["first"]),
        (&50.into(), &101.0.into())
    );
}

#[test]
fn inspect_draws_and_goes_on_after_a_bad_file() {
    let lab = Lab::new();
    lab.write("empty.csv", "");
    let good = own("compact.h5");
    let ran = lab.run(&[
        "inspect",
        "empty.csv",
        good.to_str().expect("a path"),
        "--plot",
    ]);
    assert_eq!(ran.code, 2);
    assert!(
        ran.said.contains("an empty file") && ran.said.contains('\u{2800}'),
        "{}",
        ran.said
    );
}

#[test]
fn convert_keeps_numbers_units_and_attributes() {
    let lab = Lab::new();
    let from = own("tables_int16_gzip.h5");
    let from = from.to_str().expect("a path");
    let before = channels(&lab, from, "run10");
    for out in ["out.h5", "out.parquet"] {
        let ran = lab.run(&["convert", from, "--out", out, "--set", "specimen=A"]);
        assert_eq!(ran.code, 0, "{}", ran.said);
        let after = channels(&lab, out, "run10");
        for (a, b) in before.iter().zip(&after) {
            for key in [
                "name",
                "unit",
                "samples",
                "sample_rate_hz",
                "first",
                "last",
                "sum",
                "min",
                "max",
            ] {
                assert_eq!(a[key], b[key], "{out}: {key}");
            }
        }
        let told = lab.run(&["inspect", out, "--dataset", "run10"]).said;
        assert!(
            told.contains("specimen = A") && told.contains("clearance_m = 0.01"),
            "{told}"
        );
    }
}

#[test]
fn convert_writes_over_files_with_force_alone_and_never_over_what_it_reads() {
    let lab = Lab::new();
    let before = ["r1.csv", "r2.csv"].map(|name| lab.read(name));
    // the pattern is left to the program, as by the shells of Windows
    let day = ["convert", "r[12].csv", "--out", "day.csv"];
    assert_eq!(lab.run(&day).code, 0);
    lab.write("day/r2.csv", "mine");
    std::fs::remove_file(lab.path("day/r1.csv")).expect("it was written");
    let ran = lab.run(&day);
    assert_eq!(ran.code, 2);
    let says = ["day/r2.csv exists already", "add --force to overwrite"];
    assert!(says.iter().all(|s| ran.said.contains(s)), "{}", ran.said);
    assert!(lab.read("day/r2.csv") == "mine" && !lab.path("day/r1.csv").exists());
    assert_eq!(lab.run(&[&day[..], &["--force"]].concat()).code, 0);
    assert_ne!(lab.read("day/r2.csv"), "mine");
    // a folder of the records' own names would be that of the input
    std::fs::create_dir(lab.path("raw")).expect("a folder");
    for (name, text) in ["r1.csv", "r2.csv"].iter().zip(&before) {
        lab.write(&format!("raw/{name}"), text);
    }
    let ran = lab.run(&["convert", "raw/*.csv", "--out", "raw.csv", "--force"]);
    assert_eq!(ran.code, 2);
    assert!(
        ran.said.contains("is read and would be written over"),
        "{}",
        ran.said
    );
    let after = ["r1.csv", "r2.csv"].map(|name| lab.read(&format!("raw/{name}")));
    assert!(after == before, "raw records were changed");
}

#[test]
fn convert_refuses_what_it_cannot_write() {
    let lab = Lab::new();
    let from = own("compact.h5");
    let from = from.to_str().expect("a path");
    assert_eq!(lab.run(&["convert", from, "--out", "out.xyz"]).code, 2);
    assert_eq!(
        lab.run(&["convert", from, "--out", "no/such/folder/out.h5"])
            .code,
        2
    );
    let claims = own("claims_too_much.h5");
    let ran = lab.run(&[
        "convert",
        claims.to_str().expect("a path"),
        "--out",
        "out.h5",
    ]);
    assert_eq!(ran.code, 2);
    assert!(!lab.path("out.h5").exists() && !lab.path("out.xyz").exists());
}

#[test]
fn a_library_that_panics_on_a_broken_file_prints_nothing() {
    let lab = Lab::new();
    let whole = std::fs::read(own("wide_uncompressed.parquet")).expect("a file of the tests");
    // A page that claims another length, and a footer that contradicts itself.
    for (at, byte) in [(16, 1), (2142, 0x83)] {
        let mut bytes = whole.clone();
        bytes[at] = byte;
        lab.write_bytes("broken.parquet", &bytes);
        for args in [
            &["inspect", "broken.parquet"][..],
            &["convert", "broken.parquet", "--out", "out.h5"],
        ] {
            let ran = lab.run(args);
            assert_eq!(ran.code, 2, "{}", ran.said);
            assert!(ran.said.contains("broken.parquet"), "{}", ran.said);
            assert!(ran.said.contains("contradict each other"), "{}", ran.said);
            for word in ["panicked at", "RUST_BACKTRACE"] {
                assert!(!ran.said.contains(word), "{}", ran.said);
            }
        }
    }
}
