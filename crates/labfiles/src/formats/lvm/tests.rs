use super::*;
use crate::conformance::{mutate_text, own_seeds, shared_data, shared_seeds, survive};

fn sum_of_numbers(samples: &Samples) -> f64 {
    match samples {
        Samples::Real(values) => values.iter().filter(|v| !v.is_nan()).sum(),
        _ => 0.0,
    }
}

#[test]
#[ignore = "needs shared/data: conformance files of LVM"]
fn shared_data_goldens_of_the_python_reader() {
    let dir = shared_data("");
    let golden = std::fs::read_to_string(dir.join("lvm_conformance/golden.json")).unwrap();
    let golden: serde_json::Value = serde_json::from_str(&golden).unwrap();
    let mut files = 0;
    for (file, segments) in golden.as_object().unwrap() {
        let source = open(&dir.join(file)).unwrap_or_else(|e| panic!("{e}"));
        let segments = segments.as_array().unwrap();
        assert_eq!(source.datasets().len(), segments.len(), "{file}");
        for (d, golden) in segments.iter().enumerate() {
            meets(&*source, d, golden, file);
        }
        files += 1;
    }
    assert_eq!(files, 55);
}

fn meets(source: &dyn Source, d: usize, golden: &serde_json::Value, file: &str) {
    let info = &source.datasets()[d];
    let all: Vec<usize> = (0..info.channels.len()).collect();
    let read = source.read(d, &all).unwrap();
    let shape: Vec<usize> = golden["shape"]
        .as_array()
        .unwrap()
        .iter()
        .map(|v| v.as_u64().unwrap() as usize)
        .collect();
    // The remarks of with_comments.lvm count as a fifth column there, of NaN: the Python reader
    // has no texts. Here they are a text channel.
    assert_eq!(read.len(), shape[1], "{file}");
    assert!(read.iter().all(|s| s.len() == shape[0]), "{file}");
    for (samples, golden) in read.iter().zip(golden["colsum"].as_array().unwrap()) {
        let (sum, expected) = (sum_of_numbers(samples), golden.as_f64().unwrap());
        assert!(
            (sum - expected).abs() <= 1e-9 * expected.abs().max(1.0),
            "{file}: {sum} {expected}"
        );
    }
    // The names of the Python reader begin with X_Value only if it keeps that column, and its
    // decoder drops the letters that are not UTF-8: 'Presso ABS. (MPa)'.
    for (channel, name) in info
        .channels
        .iter()
        .zip(golden["names"].as_array().unwrap())
    {
        let name = name.as_str().unwrap();
        assert!(
            channel.name == name || !channel.name.is_ascii(),
            "{file}: {} {name}",
            channel.name
        );
    }
    let steps = golden["Delta_X"].as_array().unwrap();
    let signals = info
        .channels
        .iter()
        .filter(|c| c.name != "X_Value" && c.stored != StoredType::Text);
    for (channel, step) in signals.zip(steps) {
        let stated: f64 = header::decimal_any(&channel.properties["Delta_X"]).unwrap();
        assert_eq!(stated, step.as_f64().unwrap(), "{file}");
    }
}

#[test]
#[ignore = "needs shared/data: records of a blade spring"]
fn shared_data_units_rate_and_start_of_a_forced_run() {
    let dir = shared_data("");
    let source =
        open(&dir.join("unb_cantilever_sdof/second_experiment/massa1/1Hz_tmp_001.txt")).unwrap();
    let info = &source.datasets()[0];
    assert_eq!(info.time_axis, Some(0));
    assert_eq!(info.channels[1].unit.as_deref(), Some("g"));
    assert_eq!(info.channels[2].unit.as_deref(), Some("Newtons"));
    assert_eq!(
        info.channels[1].start_time.as_deref(),
        Some("2019-10-09T15:00:53.0601601499997089444")
    );
    let rate = info.sample_rate_hz().unwrap();
    // The X column ends at 1.239404 s after 2047 steps; the printed step 0.000605 is rounded.
    assert!((rate - 1651.6).abs() < 0.1, "{rate}");
}

const TWO: &str = "LabVIEW Measurement,\nSeparator,Comma\nDecimal_Separator,.\nX_Columns,One\n\
***End_of_Header***,\n,\nChannels,1,\nSamples,2,\nY_Unit_Label,mm/s,\nX_Dimension,Time,\nX0,0,\n\
Delta_X,0.5,\n***End_of_Header***,,\nX_Value,v,Comment\n0,1\n0.5,2,dropped\n\n\
***Start_Special***\nanything,1,2\n***End_Special***\nChannels,1,\nSamples,1,\nDelta_X,0.5,\n\
***End_of_Header***,,\nX_Value,v,Comment\n0,7\n";

fn of_text(text: &str) -> Result<Box<dyn Source>, ReadError> {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), text).unwrap();
    open(file.path())
}

#[test]
fn commas_two_segments_and_a_special_one() {
    let source = of_text(TWO).unwrap();
    assert_eq!(source.datasets().len(), 2);
    assert_eq!(source.datasets()[1].name, "segment_2");
    assert_eq!(source.datasets()[0].sample_rate_hz(), Some(2.0));
    let read = source.read(0, &[1, 2]).unwrap();
    assert_eq!(read[0], Samples::Real(vec![1.0, 2.0]));
    assert_eq!(
        read[1],
        Samples::Text(vec![String::new(), "dropped".into()])
    );
    assert_eq!(source.read(1, &[1]).unwrap()[0], Samples::Real(vec![7.0]));
    assert_eq!(source.notes(), ["special segments are left out"]);
}

#[test]
fn files_cut_off_are_refused() {
    for keep in [30, 100, 200] {
        let error = of_text(&TWO[..keep]).err().unwrap();
        assert!(error.byte.is_some(), "{error}");
    }
    let (whole, _) = TWO.split_once("0,1\n0.5").unwrap();
    assert!(of_text(whole).is_err());
}

#[test]
fn prop_mutated_files_are_read_or_refused() {
    let mut all = own_seeds("lvm");
    all.push(TWO.as_bytes().to_vec());
    survive(&all, open, mutate_text, 64);
}

#[test]
#[ignore = "needs shared/data: conformance files of LVM"]
fn shared_data_mutated_files_are_read_or_refused() {
    let mut all = shared_seeds("lvm_conformance", 2000);
    all.retain(|bytes| bytes.starts_with(b"LabVIEW"));
    survive(&all, open, mutate_text, 64);
}
