//! Files that vanish, grow or are cut short after the campaign was listed.

use std::fs;
use std::io::Write;
use std::path::Path;

use impact_campaign::pipeline::Observed;
use labfiles::open;
use labfiles::{Samples, Source};

use crate::support::{Lab, wav_format};

/// A good campaign listed, one of its files changed, then observed.
fn observed_after(change: impl Fn(&Path)) -> Observed {
    let lab = Lab::new();
    let loaded = impact_campaign::campaign::load(&lab.path("campaign.toml"), &open);
    let campaign = loaded.campaign.expect("a good campaign");
    change(&lab.path("r2.csv"));
    Observed::of(&campaign, &|_, _, _| {}).expect("the others can be used")
}

fn append(path: &Path, text: &str) {
    let mut file = fs::OpenOptions::new()
        .append(true)
        .open(path)
        .expect("it is there");
    file.write_all(text.as_bytes()).expect("room");
}

#[test]
fn a_file_that_vanishes_leaves_out_its_record_alone() {
    let observed = observed_after(|path| fs::remove_file(path).expect("it is there"));
    let [first, second, third] = &observed.observations[..] else {
        panic!("three records")
    };
    assert!(!first.excluded() && second.excluded() && !third.excluded());
    let flag = second.flags.iter().find(|f| f.excludes).expect("a flag");
    assert_eq!(flag.code.name(), "unreadable");
    assert!(!flag.message().is_empty() && !flag.remedy().is_empty());
}

#[test]
fn a_file_that_grows_is_read_or_left_out() {
    let observed = observed_after(|path| append(path, "1.000000,0.1,0.02,0.1,0.1\n"));
    assert!(!observed.observations[1].excluded());
    // a row that is being written: half of it is there
    let observed = observed_after(|path| append(path, "1.000000,0.1,0.0"));
    assert_eq!(observed.observations.len(), 3);
    assert!(!observed.observations[0].excluded() && !observed.observations[2].excluded());
}

/// The good record in every format that `convert` writes, and one instrument format.
fn in_formats(lab: &Lab) -> Vec<String> {
    for name in ["grown.h5", "grown.parquet"] {
        assert_eq!(lab.run(&["-q", "convert", "r1.csv", "--out", name]).code, 0);
    }
    lab.write_bytes("grown.wav", &wav());
    ["r1.csv", "grown.h5", "grown.parquet", "grown.wav"]
        .map(String::from)
        .to_vec()
}

/// 2,000 samples of 16 bits.
fn wav() -> Vec<u8> {
    let mut bytes = b"RIFF".to_vec();
    bytes.extend(4036_u32.to_le_bytes());
    bytes.extend(b"WAVE");
    bytes.extend(wav_format());
    bytes.extend(b"data");
    bytes.extend(4000_u32.to_le_bytes());
    bytes.extend((0..2000_i16).flat_map(i16::to_le_bytes));
    bytes
}

fn read(source: &dyn Source) -> Result<Vec<Samples>, String> {
    let all: Vec<usize> = (0..source.datasets()[0].channels.len()).collect();
    source.read(0, &all).map_err(|e| e.to_string())
}

#[test]
fn open_files_that_change_give_their_samples_or_an_error() {
    let lab = Lab::new();
    for name in in_formats(&lab) {
        let path = lab.path(&name);
        let whole = fs::read(&path).expect("it is there");
        let before = read(&*open(&path).expect("it opens")).expect("it reads");
        let grown = open(&path).expect("it opens");
        append(&path, "0.1,");
        match read(&*grown) {
            Ok(samples) => assert_eq!(samples, before, "{name}"),
            Err(error) => assert!(error.contains(&name), "{error}"),
        }
        fs::write(&path, &whole).expect("it is made anew");
        let cut = open(&path).expect("it opens");
        let file = fs::OpenOptions::new().write(true).open(&path).expect("it");
        file.set_len(fs::metadata(&path).expect("it").len() / 2)
            .expect("it can be cut");
        let error = read(&*cut).expect_err("half of the samples are gone");
        assert!(error.contains(&name), "{error}");
    }
    let vanished = open(&lab.path("r2.csv")).expect("it opens");
    lab.remove("r2.csv");
    match read(&*vanished) {
        Ok(samples) => assert!(!samples.is_empty()),
        Err(error) => assert!(error.contains("r2.csv"), "{error}"),
    }
}
