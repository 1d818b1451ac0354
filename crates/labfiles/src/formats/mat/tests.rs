use crate::source::Samples;
use std::collections::BTreeMap;
use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde_json::Value;

use super::*;
use crate::conformance::{self, Random, Statistics};
use crate::source::{Clock, StoredType};

// ---- writing small files ----

fn u32s(values: &[u32], big: bool) -> Vec<u8> {
    let bytes = |v: &u32| {
        if big {
            v.to_be_bytes()
        } else {
            v.to_le_bytes()
        }
    };
    values.iter().flat_map(bytes).collect()
}

fn element(kind: u32, data: &[u8], big: bool) -> Vec<u8> {
    let mut out = u32s(&[kind, data.len() as u32], big);
    out.extend(data);
    out.resize(out.len().next_multiple_of(8), 0);
    out
}

/// A small element, which holds up to 4 bytes in its tag.
fn small(kind: u32, data: &[u8]) -> Vec<u8> {
    let mut out = (kind | (data.len() as u32) << 16).to_le_bytes().to_vec();
    out.extend(data);
    out.resize(8, 0);
    out
}

fn array(class: u32, dims: &[u32], name: &str, content: &[u8], big: bool) -> Vec<u8> {
    let mut inner = element(6, &u32s(&[class, 0], big), big);
    inner.extend(element(5, &u32s(dims, big), big));
    inner.extend(element(1, name.as_bytes(), big));
    inner.extend(content);
    element(14, &inner, big)
}

fn doubles(values: &[f64], big: bool) -> Vec<u8> {
    let bytes = |v: &f64| {
        if big {
            v.to_be_bytes()
        } else {
            v.to_le_bytes()
        }
    };
    element(9, &values.iter().flat_map(bytes).collect::<Vec<u8>>(), big)
}

fn matrix(name: &str, rows: u32, columns: u32, values: &[f64]) -> Vec<u8> {
    array(6, &[rows, columns], name, &doubles(values, false), false)
}

fn string(name: &str, text: &str) -> Vec<u8> {
    array(
        4,
        &[1, text.len() as u32],
        name,
        &element(16, text.as_bytes(), false),
        false,
    )
}

fn structure(name: &str, dims: &[u32], fields: &[&str], children: &[Vec<u8>]) -> Vec<u8> {
    let mut content = small(5, &16u32.to_le_bytes());
    let mut names = Vec::new();
    for field in fields {
        names.extend(field.as_bytes());
        names.resize(names.len().next_multiple_of(16), 0);
    }
    content.extend(element(1, &names, false));
    content.extend(children.concat());
    array(2, dims, name, &content, false)
}

fn cell(name: &str, dims: &[u32], children: &[Vec<u8>]) -> Vec<u8> {
    array(1, dims, name, &children.concat(), false)
}

fn packed(variable: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(variable).unwrap();
    let data = encoder.finish().unwrap();
    let mut out = u32s(&[15, data.len() as u32], false);
    out.extend(data);
    out
}

fn file(variables: &[Vec<u8>], big: bool) -> Vec<u8> {
    let mut out = b"MATLAB 5.0 MAT-file".to_vec();
    out.resize(124, b' ');
    out.extend(if big { *b"\x01\0MI" } else { *b"\0\x01IM" });
    out.extend(variables.concat());
    out
}

fn v4_matrix(mopt: u32, [rows, columns]: [u32; 2], name: &str, data: &[u8], big: bool) -> Vec<u8> {
    let mut out = u32s(&[mopt, rows, columns, 0, name.len() as u32 + 1], big);
    out.extend(name.as_bytes());
    out.push(0);
    out.extend(data);
    out
}

fn opened(bytes: &[u8]) -> Result<Box<dyn Source>, ReadError> {
    let temp = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(temp.path(), bytes).unwrap();
    assert!(recognises(&bytes[..bytes.len().min(512)]));
    open(temp.path())
}

fn real(source: &dyn Source, dataset: usize, channel: usize) -> Vec<f64> {
    match source.read(dataset, &[channel]).unwrap().pop() {
        Some(Samples::Real(values)) => values,
        other => panic!("{other:?}"),
    }
}

fn names(source: &dyn Source, dataset: usize) -> Vec<&str> {
    source.datasets()[dataset]
        .channels
        .iter()
        .map(|c| c.name.as_str())
        .collect()
}

// ---- goldens ----

/// Numbers (or texts) of all channels that make up one variable, in file order.
#[derive(Default)]
struct Variable {
    stored: Option<StoredType>,
    real: Vec<f64>,
    imaginary: Vec<f64>,
    texts: Vec<String>,
}

fn variables(source: &dyn Source) -> Result<BTreeMap<String, Variable>, ReadError> {
    let mut all = BTreeMap::<String, Variable>::new();
    for (index, dataset) in source.datasets().iter().enumerate() {
        let samples = conformance::read_all(source, index)?;
        for (info, samples) in dataset.channels.iter().zip(samples) {
            let name = info.name.split("(:").next().unwrap().to_owned();
            let variable = all.entry(name).or_default();
            variable.stored = Some(info.stored);
            match samples {
                Samples::Real(values) => variable.real.extend(values),
                Samples::Complex(values) => {
                    variable.real.extend(values.iter().map(|v| v.0));
                    variable.imaginary.extend(values.iter().map(|v| v.1));
                }
                Samples::Text(values) => variable.texts.extend(values),
            }
        }
    }
    Ok(all)
}

fn check_variable(found: &Variable, golden: &Value, what: &str) {
    if golden["n"] == 0 {
        assert!(found.real.is_empty() && found.texts.is_empty(), "{what}");
        return;
    }
    let kind = golden["dtype"].as_str().unwrap().trim_start_matches('>');
    if kind.starts_with("<U") {
        // The goldens were written with texts cut after 80 characters.
        let text = |key: &str| golden[key].as_str().unwrap();
        let cut = |text: &String| text.chars().take(80).collect::<String>();
        assert_eq!(
            found.texts.len() as u64,
            golden["n"].as_u64().unwrap(),
            "{what}"
        );
        assert_eq!(
            found.texts.first().map(cut).unwrap(),
            text("first"),
            "{what}"
        );
        assert_eq!(found.texts.last().map(cut).unwrap(), text("last"), "{what}");
        return;
    }
    let stored = match kind {
        "f4" | "float32" => StoredType::Float(32),
        "f8" | "float64" => StoredType::Float(64),
        "i2" | "int16" => StoredType::Int(16),
        "int64" => StoredType::Int(64),
        "uint8" => StoredType::UInt(8),
        "complex128" => StoredType::Complex(64),
        other => panic!("{what}: {other}"),
    };
    assert_eq!(found.stored, Some(stored), "{what}");
    let complex = stored == StoredType::Complex(64);
    Statistics::of(found.real.iter().copied()).check(golden, complex.then_some(0), what);
    if complex {
        Statistics::of(found.imaginary.iter().copied()).check(golden, Some(1), what);
    }
}

#[test]
#[ignore = "needs shared/data: conformance files of MATLAB"]
fn shared_data_every_golden_is_met() {
    let goldens = conformance::goldens("mat5_conformance");
    assert!(goldens.len() > 100);
    for (path, golden) in goldens {
        let file = path.file_name().unwrap().to_str().unwrap().to_owned();
        let read = open(&path).and_then(|source| variables(source.as_ref()));
        let golden = match golden {
            Value::String(error) => {
                assert!(read.is_err(), "{file} must be refused: {error}");
                continue;
            }
            Value::Object(golden) => golden,
            other => panic!("{other}"),
        };
        if file.starts_with("testsparse") || file == "logical_sparse.mat" {
            // The reference reader has sparse matrices; here they are refused by name.
            let error = read.err().unwrap().to_string();
            assert!(
                error.contains("sparse 'testsparse") || error.contains("sparse 'sp_log"),
                "{error}"
            );
            continue;
        }
        let found = read.unwrap_or_else(|error| panic!("{file}: {error}"));
        for (name, golden) in golden {
            let what = format!("{file}: {name}");
            if golden.get("kind").is_some() {
                // The golden shows a container as the reference reader prints it; its arrays
                // are channels here, below its name.
                let below = |n: &String| n.starts_with(&name);
                assert!(found.keys().any(below), "{what}: {:?}", found.keys());
            } else {
                let variable = found
                    .get(&name)
                    .unwrap_or_else(|| panic!("{what} is missing"));
                check_variable(variable, &golden, &what);
            }
        }
    }
}

#[test]
#[ignore = "needs shared/data: conformance files of MATLAB"]
fn shared_data_containers_hold_what_the_laboratory_put_in() {
    let folder = conformance::shared_data("mat5_conformance");
    let nest = open(&folder.join("testcellnest_7.4_GLNX86.mat")).unwrap();
    let found = variables(nest.as_ref()).unwrap();
    let value = |name: &str| found[name].real.clone();
    assert_eq!(value("testcellnest{1}"), [1.0]);
    assert_eq!(value("testcellnest{2}{1}"), [2.0]);
    assert_eq!(value("testcellnest{2}{3}{2}"), [5.0]);
    let structs = open(&folder.join("teststructarr_6.1_SOL2.mat")).unwrap();
    let found = variables(structs.as_ref()).unwrap();
    assert_eq!(found["teststructarr(1).one"].real, [1.0]);
    assert_eq!(found["teststructarr(2).two"].texts, ["number 2"]);
    let units = open(&folder.join("nasty_duplicate_fieldnames.mat")).unwrap();
    let track = units.datasets()[0]
        .channels
        .iter()
        .find(|c| c.name == "Summary.Track(:,1)")
        .unwrap();
    assert_eq!(track.unit.as_deref(), Some("m"));
}

// ---- own files ----

#[test]
fn plain_big_endian_and_compressed_hold_the_same() {
    let values: Vec<f64> = (0..12).map(|k| f64::from(k) * 0.5 - 1.0).collect();
    let plain = matrix("data", 6, 2, &values);
    let big = array(6, &[6, 2], "data", &doubles(&values, true), true);
    for bytes in [
        file(std::slice::from_ref(&plain), false),
        file(&[big], true),
        file(&[packed(&plain)], false),
    ] {
        let source = opened(&bytes).unwrap();
        assert_eq!(names(source.as_ref(), 0), ["data(:,1)", "data(:,2)"]);
        assert_eq!(real(source.as_ref(), 0, 1), values[6..]);
        assert_eq!(real(source.as_ref(), 0, 0), values[..6]);
        assert_eq!(source.datasets()[0].channels[0].samples, 6);
    }
}

#[test]
fn v4_in_both_orders() {
    for big in [false, true] {
        let word = |v: i16| {
            if big {
                v.to_be_bytes()
            } else {
                v.to_le_bytes()
            }
        };
        let data: Vec<u8> = [3i16, -4].into_iter().flat_map(word).collect();
        let mopt = if big { 1030 } else { 30 };
        let text = v4_matrix(mopt + 21, [1, 2], "unit", b"mm", big);
        let bytes = [v4_matrix(mopt, [2, 1], "x", &data, big), text].concat();
        let source = opened(&bytes).unwrap();
        assert_eq!(real(source.as_ref(), 0, 0), [3.0, -4.0]);
        assert_eq!(source.datasets()[0].attributes["unit"], "mm");
        assert_eq!(source.datasets()[0].channels[0].stored, StoredType::Int(16));
    }
}

#[test]
fn array_of_records_gives_datasets() {
    let run = |k: f64| {
        vec![
            matrix("", 4, 1, &[k, k + 1.0, k + 2.0, k + 3.0]),
            matrix("", 1, 1, &[k / 1e3]),
        ]
    };
    let runs: Vec<Vec<u8>> = [run(1.0), run(7.0)].concat();
    let time = matrix("t", 4, 1, &[0.0, 0.1, 0.2, 0.3]);
    let rate = matrix("fs", 1, 1, &[10.0]);
    let array = structure("runs", &[1, 2], &["v", "clearance_m"], &runs);
    for bytes in [
        file(
            &[
                array.clone(),
                time.clone(),
                rate.clone(),
                string("v_unit", "mm/s"),
            ],
            false,
        ),
        file(&[packed(&array), packed(&time), packed(&rate)], false),
    ] {
        let source = opened(&bytes).unwrap();
        let datasets: Vec<&str> = source.datasets().iter().map(|d| d.name.as_str()).collect();
        assert_eq!(datasets, ["", "runs(1)", "runs(2)"]);
        assert_eq!(names(source.as_ref(), 2), ["t", "v", "clearance_m"]);
        assert_eq!(real(source.as_ref(), 2, 1), [7.0, 8.0, 9.0, 10.0]);
        assert_eq!(real(source.as_ref(), 2, 0), [0.0, 0.1, 0.2, 0.3]);
        let second = &source.datasets()[2];
        assert_eq!(second.time_axis, Some(0));
        assert_eq!(second.attributes["clearance_m"], "0.007");
        assert_eq!(second.channels[1].sample_rate_hz, Some(10.0));
    }
}

#[test]
fn a_blank_unit_is_none() {
    let units = [
        string("x_unit", ""),
        string("y_unit", " "),
        string("y_units", "mm "),
    ];
    let vectors = ["x", "y"].map(|name| matrix(name, 2, 1, &[0.5, 1.5]));
    let source = opened(&file(&[vectors.concat(), units.concat()], false)).unwrap();
    let channels = &source.datasets()[0].channels;
    assert_eq!(channels[0].unit, None);
    assert_eq!(channels[1].unit.as_deref(), Some("mm"));
}

#[test]
fn the_unit_of_a_struct_is_that_of_its_only_signal() {
    let trial = |unit: &str, signals: &[&str]| {
        let vectors = [0.0, 1.0].map(|k| matrix("", 3, 1, &[k, k + 0.1, k + 0.2]));
        let values = vectors.into_iter().take(signals.len());
        let fields: Vec<Vec<u8>> = values.chain([string("", unit)]).collect();
        let names: Vec<&str> = signals.iter().copied().chain(["unit"]).collect();
        structure("trial", &[1, 1], &names, &fields)
    };
    let unit_of_last = |array: Vec<u8>, signals: usize| {
        let source = opened(&file(&[array], false)).unwrap();
        source.datasets()[0].channels[signals - 1].unit.clone()
    };
    let unit = |unit, signals: &[&str]| unit_of_last(trial(unit, signals), signals.len());
    assert_eq!(unit("mm/s", &["velocity"]).as_deref(), Some("mm/s"));
    assert_eq!(unit("mm/s", &["t", "velocity"]).as_deref(), Some("mm/s"));
    assert_eq!(unit("mm/s", &["velocity", "force"]), None);
    assert_eq!(unit("s", &["velocity"]), None);
}

#[test]
fn cell_of_matrices_gives_datasets() {
    let record = |k: f64| matrix("", 3, 2, &[k, k, k, 2.0 * k, 2.0 * k, 2.0 * k]);
    let bytes = file(
        &[cell("shots", &[2, 1], &[record(1.0), record(5.0)])],
        false,
    );
    let source = opened(&bytes).unwrap();
    assert_eq!(source.datasets().len(), 2);
    assert_eq!(source.datasets()[1].name, "shots{2}");
    assert_eq!(names(source.as_ref(), 1), ["shots(:,1)", "shots(:,2)"]);
    assert_eq!(real(source.as_ref(), 1, 1), [10.0; 3]);
}

#[test]
fn wide_matrix_is_read_by_rows_where_its_time_says_so() {
    let data: Vec<f64> = (0..6).map(f64::from).collect();
    let bytes = file(
        &[
            matrix("time", 1, 3, &[0.0, 1.0, 2.0]),
            matrix("y", 2, 3, &data),
        ],
        false,
    );
    let source = opened(&bytes).unwrap();
    assert_eq!(names(source.as_ref(), 0), ["time", "y(1,:)", "y(2,:)"]);
    assert_eq!(real(source.as_ref(), 0, 2), [1.0, 3.0, 5.0]);
    assert!(source.notes()[0].contains("by rows"));
}

#[test]
fn broken_files_are_refused_at_a_byte() {
    let good = file(&[matrix("data", 6, 2, &[0.5; 12])], false);
    let cut = opened(&good[..good.len() - 9]).err().unwrap();
    assert_eq!(cut.byte, Some(128));
    let mut claim = good.clone();
    claim[128 + 8 + 16 + 8..][..4].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(
        opened(&claim)
            .err()
            .unwrap()
            .to_string()
            .contains("dimensions between 0 and")
    );
    let mut longer = good;
    longer[128 + 8 + 16 + 8..][..4].copy_from_slice(&100_000_000u32.to_le_bytes());
    assert!(
        opened(&longer)
            .err()
            .unwrap()
            .to_string()
            .contains("200000000 numbers")
    );
    let sparse = file(&[array(5, &[2, 2], "stiffness", &[], false)], false);
    assert!(
        opened(&sparse)
            .err()
            .unwrap()
            .to_string()
            .contains("sparse 'stiffness'")
    );
}

#[test]
fn an_oscilloscopes_interval_and_a_structs_own_start_are_those_of_its_channels() {
    let long = |name: &str| matrix(name, 4, 1, &[1.0, 2.0, 3.0, 4.0]);
    let scope = [
        matrix("Tstart", 1, 1, &[-0.1]),
        matrix("Tinterval", 1, 1, &[4e-4]),
        matrix("Length", 1, 1, &[4.0]),
        long("A"),
        long("B"),
    ];
    let source = opened(&file(&scope, false)).unwrap();
    let rate = source.datasets()[0].sample_rate_hz().unwrap();
    assert!((rate - 2500.0).abs() < 1e-9);

    let fields = |t0: f64| {
        vec![
            matrix("", 1, 1, &[1e-3]),
            matrix("", 1, 1, &[t0]),
            matrix("", 4, 1, &[1.0, 2.0, 3.0, 4.0]),
        ]
    };
    let names = ["dt", "t0", "data"];
    let apart = [
        structure("x", &[1, 1], &names, &fields(0.0)),
        structure("contact", &[1, 1], &names, &fields(0.3)),
    ];
    let source = opened(&file(&apart, false)).unwrap();
    let starts: Vec<_> = source.datasets()[0]
        .channels
        .iter()
        .filter(|c| c.samples > 1)
        .map(|c| (c.name.as_str(), c.start_s))
        .collect();
    assert_eq!(starts, [("x.data", Some(0.0)), ("contact.data", Some(0.3))]);
}

#[test]
fn structures_with_time_have_labels_and_their_own_times() {
    let signal = |label: &str| {
        structure(
            "",
            &[1, 1],
            &["values", "label"],
            &[matrix("", 4, 1, &[1.0, 2.0, 3.0, 4.0]), string("", label)],
        )
    };
    let scope = structure(
        "scope",
        &[1, 1],
        &["time", "signals"],
        &[
            matrix("", 4, 1, &[0.0, 0.1, 0.2, 0.3]),
            signal("velocity (m/s)"),
        ],
    );
    let source = opened(&file(&[scope], false)).unwrap();
    let record = &source.datasets()[0];
    let values = &record.channels[record.channel_index("scope.signals.values").unwrap()];
    assert_eq!(values.properties["label"], "velocity");
    assert_eq!(values.unit.as_deref(), Some("m/s"));
    assert_eq!(record.time_axis, record.channel_index("scope.time"));
}

#[test]
fn what_is_not_read_is_named_with_what_to_save_instead() {
    let sparse = |name: &str| array(5, &[1, 1], name, &[], false);
    let all: Vec<Vec<u8>> = (0..9).map(|i| sparse(&format!("s{i}"))).collect();
    let error = opened(&file(&all, false)).err().unwrap();
    assert!(
        error
            .found
            .starts_with("sparse 's0' 's1' 's2' and 6 more and nothing else"),
        "{error}"
    );
    assert!(error.remedy.contains("full(S)"), "{error}");
}

#[test]
fn deep_nesting_is_refused_without_a_crash() {
    let mut inner = matrix("", 1, 1, &[1.0]);
    for _ in 0..2000 {
        inner = cell("", &[1, 1], &[inner]);
    }
    let error = opened(&file(&[cell("c", &[1, 1], &[inner])], false))
        .err()
        .unwrap();
    assert!(error.to_string().contains("nested"), "{error}");
}

#[test]
fn expanding_stream_is_refused_within_memory() {
    let zeros = vec![0.0; 9 << 20];
    let bytes = file(&[packed(&matrix("z", 9 << 20, 1, &zeros))], false);
    drop(zeros);
    let (error, peak) = conformance::peak_bytes(|| opened(&bytes).err().unwrap());
    assert!(error.to_string().contains("expansion"), "{error}");
    assert!(peak < 1 << 20, "{peak}");
}

// ---- mutations ----

/// Inflate one variable, change it inside, and pack it again.
fn mutate_inside(random: &mut Random, bytes: &mut Vec<u8>) {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    if bytes.len() < 136 || word(128) != 15 || random.below(3) == 0 {
        return conformance::mutate(random, bytes);
    }
    let end = (136 + word(132)).min(bytes.len());
    let mut inner = Vec::new();
    let read = std::io::Read::read_to_end(
        &mut flate2::read::ZlibDecoder::new(&bytes[136..end]),
        &mut inner,
    );
    if read.is_err() {
        return conformance::mutate(random, bytes);
    }
    conformance::mutate(random, &mut inner);
    let tail = bytes.split_off(end);
    bytes.truncate(128);
    bytes.extend(packed(&inner));
    bytes.extend(tail);
}

#[test]
fn prop_mutated_files_are_read_or_refused() {
    let mut seeds = conformance::own_seeds("mat");
    seeds.retain(|seed| recognises(seed));
    let fields = [
        matrix("", 8, 2, &[1.5; 16]),
        string("", "text"),
        matrix("", 1, 1, &[3.0]),
    ];
    let record = structure("s", &[1, 1], &["x", "name", "k"], &fields);
    let cells = cell("c", &[1, 2], &[record.clone(), string("", "µ")]);
    seeds.push(file(&[record.clone(), cells.clone()], false));
    seeds.push(file(&[packed(&record), packed(&cells)], false));
    seeds.push(v4_matrix(0, [2, 1], "x", &[1; 16], false));
    conformance::survive(&seeds, open, mutate_inside, 40);
}

#[test]
#[ignore = "needs shared/data: conformance files of MATLAB"]
fn shared_data_mutated_files_are_read_or_refused() {
    let mut seeds = conformance::shared_seeds("mat5_conformance", 16 << 10);
    seeds.retain(|seed| recognises(seed));
    conformance::survive(&seeds, open, mutate_inside, 40);
}

#[test]
fn valid_a_matrix_of_time_and_signal_has_the_name_and_unit_beside_it() {
    let source = open(&conformance::own("pair_with_name_and_unit.mat")).unwrap();
    let info = &source.datasets()[0];
    let time = info.time_axis.unwrap();
    assert_eq!(info.channels[time].unit.as_deref(), Some("s"));
    let laser = info.channel_index("Laser").unwrap();
    assert_eq!(info.channels[laser].unit.as_deref(), Some("m/s"));
    let samples = source
        .read(0, &[laser])
        .unwrap()
        .remove(0)
        .into_real()
        .unwrap();
    assert!((samples[9] - conformance::wave(9)).abs() < 1e-15);
}

#[test]
fn a_matrix_without_names_whose_first_column_climbs_evenly_has_its_time_there() {
    let columns = |first: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let signal = (0..50).map(|i| (i as f64 * 0.3).cos());
        (0..50).map(first).chain(signal).collect()
    };
    let even = matrix("data", 50, 2, &columns(&|i| i as f64 * 2e-3));
    let source = opened(&file(&[even], false)).unwrap();
    let set = &source.datasets()[0];
    assert_eq!(set.time_axis, Some(0));
    assert_eq!(set.channels[1].clock, Clock::Axis(0));
    assert!(
        source.notes()[0].contains("data(:,1) climbs evenly"),
        "{:?}",
        source.notes()
    );
    // counts of samples, two signals, a rate that is stated
    let counts = matrix("data", 50, 2, &columns(&|i| i as f64));
    let signals = matrix("data", 50, 2, &columns(&|i| (i as f64 * 0.3).sin()));
    let rated = [
        matrix("data", 50, 2, &columns(&|i| i as f64 * 2e-3)),
        matrix("fs", 1, 1, &[500.0]),
    ];
    for variables in [&[counts][..], &[signals], &rated] {
        let source = opened(&file(variables, false)).unwrap();
        assert_eq!(source.datasets()[0].time_axis, None);
    }
}
