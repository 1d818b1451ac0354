//! Every reader on small files of the field's own writers: `data/goldens/make_goldens.py` made them
//! and read them back with the field's own readers. The values here are those that it states.
#![allow(clippy::unwrap_used, clippy::panic, reason = "these are tests")]

use std::path::{Path, PathBuf};

use labfiles::{Samples, Source, StoredType, open};

const X: [f64; 6] = [0.5, -1.25, 3.0, 1e-3, -2.5, 7.75];
const COUNT: [f64; 6] = [1.0, -2.0, 300.0, -4000.0, 32767.0, -32768.0];

fn golden(name: &str) -> PathBuf {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let folders = ["goldens", "formats"].map(|folder| data.join(folder).join(name));
    folders.into_iter().find(|path| path.is_file()).unwrap()
}

#[track_caller]
fn opened(name: &str, format: &str) -> Box<dyn Source> {
    let source = open(&golden(name)).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(source.format(), format, "{name}");
    source
}

#[track_caller]
fn samples(source: &dyn Source, dataset: usize, channel: &str) -> Samples {
    let info = &source.datasets()[dataset];
    let index = info
        .channel_index(channel)
        .unwrap_or_else(|| panic!("no {channel}"));
    source.read(dataset, &[index]).unwrap().remove(0)
}

#[track_caller]
fn check(source: &dyn Source, dataset: usize, channel: &str, expected: &[f64]) {
    let found = samples(source, dataset, channel);
    assert_eq!(found, Samples::Real(expected.to_vec()), "{channel}");
}

fn twice() -> [f64; 6] {
    X.map(|v| 2.0 * v)
}

#[test]
fn valid_tdms_of_nptdms() {
    let source = opened("small.tdms", "tdms");
    let record = &source.datasets()[0];
    assert_eq!(record.name, "run 1");
    assert_eq!(record.attributes["clearance_m"], "0.001");
    assert_eq!(record.attributes["operator"], "Novák");
    let x = &record.channels[record.channel_index("x").unwrap()];
    assert_eq!(x.unit.as_deref(), Some("mm"));
    assert_eq!(x.sample_rate_hz, Some(2000.0));
    assert_eq!(
        x.start_time.as_deref(),
        Some("2024-05-01T12:00:00.000000000Z")
    );
    check(&*source, 0, "x", &X);
    check(&*source, 0, "count", &COUNT);
    let labels = (0..6).map(|i| format!("no {i}")).collect();
    assert_eq!(samples(&*source, 0, "label"), Samples::Text(labels));
}

#[test]
fn valid_universal_files_of_pyuff() {
    for name in ["small_text.uff", "small_binary.uff"] {
        let source = opened(name, "uff");
        let [time, frequency] = source.datasets() else {
            panic!("{name}: {} datasets", source.datasets().len())
        };
        assert_eq!(time.sample_rate_hz(), Some(2000.0), "{name}");
        assert_eq!(time.channels[0].unit.as_deref(), Some("mm"), "{name}");
        assert_eq!(time.attributes["id1"], "run 1", "{name}");
        check(&*source, 0, "3:+Z", &X);
        assert_eq!(
            frequency.channels[1].stored,
            StoredType::Complex(64),
            "{name}"
        );
        check(&*source, 1, "frequency", &[0.0, 0.5, 1.0]);
        let force = vec![(1.0, 2.0), (-0.5, 0.25), (3.0, -4.0)];
        assert_eq!(
            samples(&*source, 1, "3:+Z"),
            Samples::Complex(force),
            "{name}"
        );
    }
}

#[test]
fn valid_lvm_as_lvm_read_has_it() {
    let source = opened("small.lvm", "lvm");
    let record = &source.datasets()[0];
    assert_eq!(record.time_axis, Some(0));
    assert!((record.sample_rate_hz().unwrap() - 2000.0).abs() < 1e-9);
    let units: Vec<_> = record.channels.iter().map(|c| c.unit.as_deref()).collect();
    assert_eq!(units, [Some("s"), Some("mm"), Some("Volts")]);
    assert_eq!(
        record.channels[1].start_time.as_deref(),
        Some("2024-05-01T12:00:00.5")
    );
    check(&*source, 0, "x", &X);
    check(&*source, 0, "count", &COUNT);
}

#[test]
fn valid_wav_of_scipy_and_of_python() {
    let source = opened("small_16.wav", "wav");
    assert_eq!(source.datasets()[0].sample_rate_hz(), Some(2000.0));
    assert_eq!(source.datasets()[0].channels[0].stored, StoredType::Int(16));
    check(&*source, 0, "channel 1", &COUNT);
    check(
        &*source,
        0,
        "channel 2",
        &[0.0, 1.0, -150.0, 2000.0, -16383.0, 16384.0],
    );
    let source = opened("small_24.wav", "wav");
    check(
        &*source,
        0,
        "channel 1",
        &[256.0, -256.0, 2_147_483_392.0, -2_147_483_648.0],
    );
    let source = opened("small_float.wav", "wav");
    assert_eq!(
        source.datasets()[0].channels[0].stored,
        StoredType::Float(32)
    );
    check(
        &*source,
        0,
        "channel 1",
        &[0.5, -1.25, 3.0, f64::from(1e-3f32), -2.5, 7.75],
    );
}

#[test]
fn valid_matlab_files_of_scipy() {
    for name in ["small_v4.mat", "small_v6.mat", "small_v7.mat"] {
        let source = opened(name, "mat");
        let record = &source.datasets()[0];
        assert_eq!(record.attributes["fs"], "2000", "{name}");
        let x = &record.channels[record.channel_index("x").unwrap()];
        assert_eq!(
            (x.unit.as_deref(), x.sample_rate_hz),
            (Some("mm"), Some(2000.0)),
            "{name}"
        );
        check(&*source, 0, "x", &X);
        check(&*source, 0, "pair(:,1)", &X);
        check(&*source, 0, "pair(:,2)", &twice());
        if name == "small_v4.mat" {
            continue;
        }
        check(&*source, 0, "count", &COUNT);
        let z = vec![(1.0, 2.0), (3.0, -4.0)];
        assert_eq!(samples(&*source, 0, "z"), Samples::Complex(z), "{name}");
        let names: Vec<_> = source.datasets().iter().map(|d| d.name.as_str()).collect();
        assert_eq!(names, ["", "runs(1)", "runs(2)"], "{name}");
        assert_eq!(
            source.datasets()[2].attributes["clearance_m"],
            "0.002",
            "{name}"
        );
        check(&*source, 2, "v", &twice());
    }
}

#[test]
fn valid_matlab_7_3_as_mat73_has_it() {
    let source = opened("small_v73.mat", "mat");
    let record = &source.datasets()[0];
    assert_eq!(record.attributes["fs"], "2000");
    assert_eq!(record.attributes["x_unit"], "mm");
    check(&*source, 0, "pair(:,1)", &X);
    check(&*source, 0, "pair(:,2)", &twice());
    check(&*source, 0, "count", &COUNT);
    let z = vec![(1.0, 2.0), (3.0, -4.0)];
    assert_eq!(samples(&*source, 0, "rig.z"), Samples::Complex(z));
}

#[test]
fn valid_text_tables_of_polars() {
    for name in ["comma.csv", "decimal_comma.csv"] {
        let source = opened(name, "csv");
        let record = &source.datasets()[0];
        assert_eq!(record.time_axis, Some(0), "{name}");
        assert!(
            (record.sample_rate_hz().unwrap() - 2000.0).abs() < 1e-9,
            "{name}"
        );
        assert_eq!(record.channels[1].unit.as_deref(), Some("mm"), "{name}");
        check(&*source, 0, "x", &X);
    }
    let notes = ["a", "", "say \"hi\"", "b;c", "d", "e"].map(str::to_owned);
    let source = opened("comma.csv", "csv");
    assert_eq!(samples(&*source, 0, "note"), Samples::Text(notes.to_vec()));
}

#[test]
fn valid_hdf5_of_h5py_and_parquet_of_polars() {
    let sine = |i: i32| (std::f64::consts::TAU * 12.6 * f64::from(i) / 2000.0).sin();
    let source = opened("tables_int16_gzip.h5", "hdf5");
    assert_eq!(source.datasets()[0].name, "run1");
    assert_eq!(source.datasets()[0].sample_rate_hz(), Some(2000.0));
    // value = count · 0.005 + 1 with count = round(100 sin)
    let drive: Vec<f64> = (0..50)
        .map(|i| (100.0 * sine(i)).round() * 0.005 + 1.0)
        .collect();
    check(&*source, 0, "drive", &drive);
    let source = opened("wide.parquet", "parquet");
    check(
        &*source,
        0,
        "i16",
        &(0..50).map(f64::from).collect::<Vec<_>>(),
    );
    let x = samples(&*source, 0, "x").into_real().unwrap();
    assert!((0..50).zip(&x).all(|(i, x)| (x - sine(i)).abs() < 1e-15));
}
