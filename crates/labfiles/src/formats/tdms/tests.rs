use std::f64::consts::PI;

use serde_json::Value as Json;

use super::*;
use crate::conformance::{self, Random, Statistics};

// ---- writing small files ----

/// Writes numbers in one byte order.
#[derive(Clone, Copy)]
struct Writer {
    big: bool,
}

impl Writer {
    fn order(self, mut little: Vec<u8>) -> Vec<u8> {
        if self.big {
            little.reverse();
        }
        little
    }
    fn u32(self, value: u32) -> Vec<u8> {
        self.order(value.to_le_bytes().to_vec())
    }
    fn u64(self, value: u64) -> Vec<u8> {
        self.order(value.to_le_bytes().to_vec())
    }
    fn f64s(self, values: &[f64]) -> Vec<u8> {
        values
            .iter()
            .flat_map(|v| self.order(v.to_le_bytes().to_vec()))
            .collect()
    }
    fn text(self, text: &str) -> Vec<u8> {
        [self.u32(text.len() as u32), text.as_bytes().to_vec()].concat()
    }
    fn property(self, name: &str, value: &Property<'_>) -> Vec<u8> {
        let (code, bytes) = match value {
            Property::Float(value) => (10, self.order(value.to_le_bytes().to_vec())),
            Property::Count(value) => (7, self.u32(*value)),
            Property::Text(value) => (0x20, self.text(value)),
            Property::Time(seconds, fraction) => (0x44, self.stamp(*seconds, *fraction)),
        };
        [self.text(name), self.u32(code), bytes].concat()
    }
    fn stamp(self, seconds: i64, fraction: u64) -> Vec<u8> {
        let words = [self.u64(fraction), self.u64(seconds as u64)];
        if self.big {
            [words[1].clone(), words[0].clone()].concat()
        } else {
            words.concat()
        }
    }
    fn object(self, path: &str, index: Vec<u8>, properties: &[Vec<u8>]) -> Vec<u8> {
        let count = self.u32(properties.len() as u32);
        [self.text(path), index, count, properties.concat()].concat()
    }
    fn index(self, code: u32, count: u64) -> Vec<u8> {
        [self.u32(20), self.u32(code), self.u32(1), self.u64(count)].concat()
    }
    fn texts_index(self, count: u64, bytes: u64) -> Vec<u8> {
        [
            self.u32(28),
            self.u32(0x20),
            self.u32(1),
            self.u64(count),
            self.u64(bytes),
        ]
        .concat()
    }
    /// A segment with metadata; `flags` beside those of metadata, data and byte order.
    fn segment(self, flags: u32, objects: &[Vec<u8>], data: &[u8]) -> Vec<u8> {
        let metadata = [self.u32(objects.len() as u32), objects.concat()].concat();
        self.bare(flags | 2, &metadata, data)
    }
    fn bare(self, flags: u32, metadata: &[u8], data: &[u8]) -> Vec<u8> {
        let flags = flags | u32::from(!data.is_empty()) << 3 | u32::from(self.big) << 6;
        let next = self.u64((metadata.len() + data.len()) as u64);
        let raw = self.u64(metadata.len() as u64);
        let lead = [
            b"TDSm".to_vec(),
            flags.to_le_bytes().to_vec(),
            self.u32(4713),
            next,
            raw,
        ];
        [lead.concat(), metadata.to_vec(), data.to_vec()].concat()
    }
}

enum Property<'a> {
    Float(f64),
    Count(u32),
    Text(&'a str),
    Time(i64, u64),
}

const LITTLE: Writer = Writer { big: false };
const NEW: u32 = 4;
const INTERLEAVED: u32 = 32;

fn none(w: Writer) -> Vec<u8> {
    w.u32(u32::MAX)
}

fn opened(bytes: &[u8]) -> Result<Box<dyn Source>, ReadError> {
    let temp = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(temp.path(), bytes).unwrap();
    open(temp.path())
}

fn real(source: &dyn Source, dataset: usize, channel: usize) -> Vec<f64> {
    match source.read(dataset, &[channel]).unwrap().pop() {
        Some(Samples::Real(values)) => values,
        other => panic!("{other:?}"),
    }
}

// ---- goldens ----

fn check_golden(source: &dyn Source, golden: &Json) {
    let (group, name) = (
        golden["group"].as_str().unwrap(),
        golden["channel"].as_str().unwrap(),
    );
    let dataset = source
        .datasets()
        .iter()
        .position(|d| d.name == group)
        .unwrap();
    let infos = &source.datasets()[dataset].channels;
    let channel = infos.iter().position(|c| c.name == name).unwrap();
    let info = &infos[channel];
    let what = format!("{}: {group}/{name}", source.path().display());
    let stored = match golden["dtype"].as_str().unwrap() {
        "uint8" => StoredType::UInt(8),
        "float64" => StoredType::Float(64),
        other => panic!("{other}"),
    };
    assert_eq!(info.stored, stored, "{what}");
    Statistics::of(real(source, dataset, channel)).check(golden, None, &what);
    for (key, value) in golden["props"].as_object().unwrap() {
        let (found, value) = (&info.properties[key], value.as_str().unwrap());
        // Numbers are spelt differently by the reference reader (2e-05 for 0.00002).
        match (found.parse::<f64>(), value.parse::<f64>()) {
            (Ok(found), Ok(value)) => assert_eq!(found, value, "{what}: {key}"),
            _ => assert_eq!(found, value, "{what}: {key}"),
        }
        if key == "wf_increment" {
            assert_eq!(
                info.sample_rate_hz,
                Some(value.parse::<f64>().unwrap().recip()),
                "{what}"
            );
        }
        if key == "unit_string" {
            assert_eq!(info.unit.as_deref(), Some(value), "{what}");
        }
    }
}

#[test]
#[ignore = "needs shared/data: conformance files of TDMS"]
fn shared_data_every_golden_is_met() {
    for (path, golden) in conformance::goldens("tdms_conformance") {
        assert!(recognises(&std::fs::read(&path).unwrap()));
        let source = open(&path).unwrap();
        let channels: usize = source.datasets().iter().map(|d| d.channels.len()).sum();
        assert_eq!(channels, golden.as_array().unwrap().len());
        golden
            .as_array()
            .unwrap()
            .iter()
            .for_each(|golden| check_golden(source.as_ref(), golden));
    }
}

#[test]
#[ignore = "needs shared/data: conformance files of TDMS"]
fn shared_data_start_times_of_conformance_files() {
    let folder = conformance::shared_data("tdms_conformance");
    let source = open(&folder.join("raw_timestamps.tdms")).unwrap();
    let start = source.datasets()[0].channels[0].start_time.clone().unwrap();
    // 0xe1d61cfb seconds after 1904-01-01 and 0x1190b80000000000 / 2^64 of a second.
    assert_eq!(start, "2024-01-24T01:48:43.068614482Z");
}

// ---- own files ----

#[test]
fn both_orders_contiguous_and_interleaved() {
    for big in [false, true] {
        let w = Writer { big };
        let objects = [
            w.object(
                "/",
                none(w),
                &[w.property("operator", &Property::Text("Peterka"))],
            ),
            w.object(
                "/'run 1'",
                none(w),
                &[w.property("clearance_m", &Property::Float(0.002))],
            ),
            w.object(
                "/'run 1'/'x'",
                w.index(10, 3),
                &[w.property("wf_increment", &Property::Float(0.001))],
            ),
            w.object(
                "/'run 1'/'y'",
                w.index(2, 3),
                &[w.property("unit_string", &Property::Text("mm"))],
            ),
        ];
        let y = |v: i16| w.order(v.to_le_bytes().to_vec());
        let apart = [w.f64s(&[0.5, -1.5, PI]), y(1), y(-2), y(300)].concat();
        let rows = [
            w.f64s(&[0.5]),
            y(1),
            w.f64s(&[-1.5]),
            y(-2),
            w.f64s(&[PI]),
            y(300),
        ]
        .concat();
        for (flags, data) in [(NEW, apart), (NEW | INTERLEAVED, rows)] {
            // The same chunk twice in the first segment, once more in one without metadata.
            let bytes = [
                w.segment(flags, &objects, &data.repeat(2)),
                w.bare(flags & !NEW, &[], &data),
            ];
            let source = opened(&bytes.concat()).unwrap();
            assert_eq!(real(source.as_ref(), 0, 0), [0.5, -1.5, PI].repeat(3));
            assert_eq!(real(source.as_ref(), 0, 1), [1.0, -2.0, 300.0].repeat(3));
            let dataset = &source.datasets()[0];
            assert_eq!(
                (dataset.name.as_str(), dataset.channels[1].samples),
                ("run 1", 9)
            );
            assert_eq!(dataset.channels[0].sample_rate_hz, Some(1000.0));
            assert_eq!(dataset.channels[1].unit.as_deref(), Some("mm"));
            assert_eq!(dataset.attributes["clearance_m"], "0.002");
            assert_eq!(dataset.attributes["operator"], "Peterka");
        }
    }
}

#[test]
fn channels_appear_later_change_length_and_rest() {
    let w = LITTLE;
    let a = "/'g'/'a'";
    let b = "/'g'/'b'";
    let bytes = [
        w.segment(
            NEW,
            &[w.object(a, w.index(10, 2), &[])],
            &w.f64s(&[1.0, 2.0]),
        ),
        // b joins; a keeps its index
        w.segment(
            0,
            &[w.object(b, w.index(10, 1), &[])],
            &w.f64s(&[3.0, 4.0, 10.0]),
        ),
        // a rests
        w.segment(0, &[w.object(a, none(w), &[])], &w.f64s(&[20.0])),
        // a comes back as it was; b longer
        w.segment(
            0,
            &[w.object(a, w.u32(0), &[]), w.object(b, w.index(10, 2), &[])],
            &w.f64s(&[5.0, 6.0, 30.0, 40.0]),
        ),
        // a new list: b alone, with the index it had
        w.segment(NEW, &[w.object(b, w.u32(0), &[])], &w.f64s(&[50.0, 60.0])),
    ];
    let source = opened(&bytes.concat()).unwrap();
    assert_eq!(real(source.as_ref(), 0, 0), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert_eq!(
        real(source.as_ref(), 0, 1),
        [10.0, 20.0, 30.0, 40.0, 50.0, 60.0]
    );
}

#[test]
fn last_segment_cut_short() {
    let w = LITTLE;
    let objects = [
        w.object("/'g'/'a'", w.index(10, 3), &[]),
        w.object("/'g'/'b'", w.index(10, 3), &[]),
    ];
    let data = w.f64s(&[1.0, 2.0, 3.0, 10.0, 20.0, 30.0]);
    let whole = w.segment(NEW, &objects, &data.repeat(2));
    let cut = opened(&whole[..whole.len() - 12]).unwrap();
    assert_eq!(real(cut.as_ref(), 0, 0), [1.0, 2.0, 3.0, 1.0, 2.0, 3.0]);
    assert_eq!(real(cut.as_ref(), 0, 1), [10.0, 20.0, 30.0, 10.0]);
    assert!(cut.notes().iter().any(|note| note.contains("cut short")));
    // A program that crashed leaves the length unset.
    let mut crashed = whole.clone();
    crashed[12..20].fill(0xff);
    assert_eq!(real(opened(&crashed).unwrap().as_ref(), 0, 0).len(), 6);
    let rows = w.segment(NEW | INTERLEAVED, &objects, &data.repeat(2));
    let cut = opened(&rows[..rows.len() - 12]).unwrap();
    assert_eq!(real(cut.as_ref(), 0, 0).len(), 5);
    assert_eq!(real(cut.as_ref(), 0, 1).len(), 5);
    // A complete segment may end with a short chunk, shared in proportion.
    let short = w.segment(
        NEW,
        &objects,
        &[data, w.f64s(&[4.0, 5.0, 40.0, 50.0])].concat(),
    );
    let short = opened(&short).unwrap();
    assert_eq!(real(short.as_ref(), 0, 0), [1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!(real(short.as_ref(), 0, 1), [10.0, 20.0, 30.0, 40.0, 50.0]);
}

#[test]
fn every_kind_of_sample() {
    for big in [false, true] {
        let w = Writer { big };
        let b = |bytes: &[u8]| w.order(bytes.to_vec());
        let kinds: [(u32, Vec<u8>, StoredType, f64); 12] = [
            (1, b(&(-3i8).to_le_bytes()), StoredType::Int(8), -3.0),
            (2, b(&(-300i16).to_le_bytes()), StoredType::Int(16), -300.0),
            (
                3,
                b(&(-70_000i32).to_le_bytes()),
                StoredType::Int(32),
                -70_000.0,
            ),
            (
                4,
                b(&(-5_000_000_000i64).to_le_bytes()),
                StoredType::Int(64),
                -5e9,
            ),
            (5, vec![250], StoredType::UInt(8), 250.0),
            (
                6,
                b(&60_000u16.to_le_bytes()),
                StoredType::UInt(16),
                60_000.0,
            ),
            (
                7,
                b(&4_000_000_000u32.to_le_bytes()),
                StoredType::UInt(32),
                4e9,
            ),
            (
                8,
                b(&(1u64 << 60).to_le_bytes()),
                StoredType::UInt(64),
                (1u64 << 60) as f64,
            ),
            (9, b(&0.5f32.to_le_bytes()), StoredType::Float(32), 0.5),
            (0x19, b(&1.5f32.to_le_bytes()), StoredType::Float(32), 1.5),
            (0x1a, b(&2.5f64.to_le_bytes()), StoredType::Float(64), 2.5),
            (0x21, vec![1], StoredType::Bool, 1.0),
        ];
        for (code, bytes, stored, value) in kinds {
            let object = w.object("/'g'/'c'", w.index(code, 1), &[]);
            let source = opened(&w.segment(NEW, &[object], &bytes)).unwrap();
            assert_eq!(source.datasets()[0].channels[0].stored, stored);
            assert_eq!(real(source.as_ref(), 0, 0), [value], "type {code}");
        }
        let complex = w.object("/'g'/'c'", w.index(0x10_000d, 2), &[]);
        let source = opened(&w.segment(NEW, &[complex], &w.f64s(&[1.0, 2.0, 3.0, 4.0]))).unwrap();
        let samples = source.read(0, &[0]).unwrap();
        assert_eq!(samples, [Samples::Complex(vec![(1.0, 2.0), (3.0, 4.0)])]);
    }
}

#[test]
fn texts_and_time_stamps() {
    for big in [false, true] {
        let w = Writer { big };
        let texts = [w.u32(3), w.u32(3), w.u32(6), b"abcdef".to_vec()].concat();
        let stamps = [w.stamp(3_540_000_000, 1 << 63), w.stamp(3_540_000_002, 0)].concat();
        let objects = [
            w.object("/'g'/'label'", w.texts_index(3, texts.len() as u64), &[]),
            w.object(
                "/'g'/'time'",
                w.index(0x44, 2),
                &[w.property("set", &Property::Time(3_540_000_000, 0))],
            ),
        ];
        let source =
            opened(&w.segment(NEW, &objects, &[texts, stamps].concat().repeat(2))).unwrap();
        let expected: Vec<String> = ["abc", "", "def"]
            .repeat(2)
            .iter()
            .map(|t| (*t).to_owned())
            .collect();
        assert_eq!(source.read(0, &[0]).unwrap(), [Samples::Text(expected)]);
        assert_eq!(real(source.as_ref(), 0, 1), [0.0, 1.5, 0.0, 1.5]);
        let dataset = &source.datasets()[0];
        assert_eq!(dataset.time_axis, Some(1));
        assert_eq!(
            dataset.channels[1].start_time.as_deref(),
            Some("2016-03-05T05:20:00.500000000Z")
        );
        assert_eq!(
            dataset.channels[1].properties["set"],
            "2016-03-05T05:20:00.000000000Z"
        );
    }
}

/// Raw data index of a `DAQmx` channel: scalers as (type, buffer, offset, scale).
fn device_index(
    w: Writer,
    digital: bool,
    rows: u64,
    scalers: &[[u32; 4]],
    widths: &[u32],
) -> Vec<u8> {
    let mut out = w.u32(if digital { 0x126a } else { 0x1269 });
    out.extend(
        [
            w.u32(u32::MAX),
            w.u32(1),
            w.u64(rows),
            w.u32(scalers.len() as u32),
        ]
        .concat(),
    );
    for [kind, buffer, offset, scale] in scalers {
        out.extend([w.u32(*kind), w.u32(*buffer), w.u32(*offset)].concat());
        out.extend(if digital { vec![0] } else { w.u32(0) });
        out.extend(w.u32(*scale));
    }
    out.extend(w.u32(widths.len() as u32));
    out.extend(widths.iter().flat_map(|&width| w.u32(width)));
    out
}

#[test]
fn device_data_in_two_buffers_with_a_scale() {
    let w = LITTLE;
    let scale = [
        w.property("NI_Number_Of_Scales", &Property::Count(2)),
        w.property("NI_Scale[1]_Scale_Type", &Property::Text("Linear")),
        w.property("NI_Scale[1]_Linear_Slope", &Property::Float(0.5)),
        w.property("NI_Scale[1]_Linear_Y_Intercept", &Property::Float(1.0)),
        w.property("NI_Scale[1]_Linear_Input_Source", &Property::Count(0)),
    ];
    let objects = [
        w.object(
            "/'g'/'a'",
            device_index(w, false, 2, &[[3, 0, 0, 0]], &[4, 2]),
            &scale,
        ),
        w.object(
            "/'g'/'b'",
            device_index(w, false, 2, &[[3, 0, 2, 0]], &[4, 2]),
            &[],
        ),
        w.object(
            "/'g'/'c'",
            device_index(w, false, 3, &[[2, 1, 0, 0]], &[4, 2]),
            &[],
        ),
    ];
    let words: Vec<u8> = [1i16, -1, 2, -2, 7, 8, 9]
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let source = opened(&w.segment(NEW, &objects, &words.repeat(2))).unwrap();
    assert_eq!(real(source.as_ref(), 0, 0), [1.5, 2.0, 1.5, 2.0]);
    assert_eq!(real(source.as_ref(), 0, 1), [-1.0, -2.0, -1.0, -2.0]);
    assert_eq!(real(source.as_ref(), 0, 2), [7.0, 8.0, 9.0, 7.0, 8.0, 9.0]);
    let channels = &source.datasets()[0].channels;
    assert_eq!(channels[0].stored, StoredType::Float(64));
    assert_eq!(channels[1].stored, StoredType::Int(16));
}

#[test]
fn channels_of_a_group_state_when_they_begin() {
    let w = LITTLE;
    let channel = |name: &str, stamp: i64, offset: f64, step: f64, unit: &str| {
        let properties = [
            w.property("wf_start_time", &Property::Time(stamp, 0)),
            w.property("wf_start_offset", &Property::Float(offset)),
            w.property("wf_increment", &Property::Float(step)),
            w.property("wf_xunit_string", &Property::Text(unit)),
        ];
        w.object(&format!("/'run'/'{name}'"), w.index(10, 2), &properties)
    };
    let objects = [
        w.object("/'run'", none(w), &[]),
        channel("x", 3_800_000_000, 0.0, 1e-3, ""),
        channel("late", 3_800_000_001, 0.25, 1e-3, "s"),
        channel("in ms", 3_800_000_000, 300.0, 1.0, "ms"),
        w.object("/'run'/'bare'", w.index(10, 2), &[]),
    ];
    let source = opened(&w.segment(NEW, &objects, &w.f64s(&[0.0; 8]))).unwrap();
    let channels = &source.datasets()[0].channels;
    let starts: Vec<Option<f64>> = channels.iter().map(|c| c.start_s).collect();
    assert_eq!(starts, [Some(0.0), Some(1.25), Some(0.3), None]);
    assert!((channels[2].sample_rate_hz.unwrap() - 1000.0).abs() < 1e-9);
}

#[test]
fn digital_lines() {
    let w = LITTLE;
    let line = |bit: u32| device_index(w, true, 3, &[[0, 0, bit, 0]], &[1]);
    let objects = [
        w.object("/'g'/'line0'", line(0), &[]),
        w.object("/'g'/'line2'", line(2), &[]),
    ];
    let source = opened(&w.segment(NEW, &objects, &[0b101, 0b100, 0b001])).unwrap();
    assert_eq!(real(source.as_ref(), 0, 0), [1.0, 0.0, 1.0]);
    assert_eq!(real(source.as_ref(), 0, 1), [1.0, 1.0, 0.0]);
}

#[test]
fn scaling_that_is_not_done_is_refused_by_name() {
    let w = LITTLE;
    let strain = w.property("NI_Scale[0]_Scale_Type", &Property::Text("Strain"));
    let objects = [
        w.object("/'g'/'a'", w.index(10, 1), &[strain]),
        w.object("/'g'/'b'", w.index(10, 1), &[]),
    ];
    let source = opened(&w.segment(NEW, &objects, &w.f64s(&[1.0, 2.0]))).unwrap();
    let error = source.read(0, &[0]).unwrap_err();
    assert!(error.to_string().contains("Strain scaling"), "{error}");
    assert_eq!(error.channel.as_deref(), Some("g/a"));
    assert_eq!(real(source.as_ref(), 0, 1), [2.0]);
}

#[test]
fn broken_files_are_refused_at_a_byte() {
    let w = LITTLE;
    let good = w.segment(
        NEW,
        &[w.object("/'g'/'a'", w.index(10, 1), &[])],
        &w.f64s(&[1.0]),
    );
    let mut version = good.clone();
    version[8] = 1;
    assert_eq!(opened(&version).err().unwrap().byte, Some(8));
    let second = [good.clone(), b"garbage garbage garbage garbage".to_vec()].concat();
    assert_eq!(opened(&second).err().unwrap().byte, Some(good.len() as u64));
    let much = w.segment(
        NEW,
        &[w.object("/'g'/'a'", w.index(10, 1 << 62), &[])],
        &w.f64s(&[1.0]),
    );
    assert!(
        opened(&much)
            .err()
            .unwrap()
            .to_string()
            .contains("4611686018427387904 samples")
    );
    let many = w.segment(
        NEW,
        &[w.object("/'g'/'a'", w.index(10, 1_000_000_000_000), &[])],
        &w.f64s(&[1.0]),
    );
    // A chunk that is not there but for one sample: that sample is read, with a note.
    let (source, peak) = conformance::peak_bytes(|| opened(&many).unwrap());
    assert_eq!(real(source.as_ref(), 0, 0).len(), 1);
    assert!(peak < 100_000, "{peak}");
    let extended = w.segment(NEW, &[w.object("/'g'/'a'", w.index(11, 1), &[])], &[0; 16]);
    let error = opened(&extended).err().unwrap().to_string();
    assert!(error.contains("extended float"), "{error}");
    assert!(error.contains("as double precision"), "{error}");
    assert!(opened(b"TDSh").err().unwrap().to_string().contains("index"));
}

#[test]
fn many_layouts_of_many_channels_are_refused_within_memory() {
    let w = LITTLE;
    let path = |k: usize| format!("/'g'/'{k}'");
    let all: Vec<_> = (0..2000)
        .map(|k| w.object(&path(k), w.index(5, 1), &[]))
        .collect();
    let mut bytes = w.segment(NEW, &all, &[1; 2000]);
    for k in 0..2000 {
        bytes.extend(w.segment(0, &[w.object(&path(k), w.index(5, 2), &[])], &[]));
    }
    let (error, peak) = conformance::peak_bytes(|| opened(&bytes).err().unwrap());
    assert!(error.to_string().contains("in proportion"), "{error}");
    assert!(peak < 30 * bytes.len(), "{peak} for {}", bytes.len());
}

// ---- mutations ----

/// Change a lead-in or the metadata after it, or anything.
fn mutate_segment(random: &mut Random, bytes: &mut Vec<u8>) {
    let tags: Vec<usize> = (0..bytes.len().saturating_sub(4))
        .filter(|&at| bytes[at..].starts_with(b"TDSm"))
        .collect();
    if tags.is_empty() || random.below(2) == 0 {
        return conformance::mutate(random, bytes);
    }
    for _ in 0..=random.below(2) {
        let tag = tags[random.below(tags.len())];
        let reach = if random.below(2) == 0 { 28 } else { 600 };
        let at = (tag + 4 + random.below(reach)).min(bytes.len() - 1);
        match random.below(3) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = bytes[at].wrapping_add(1),
            _ => conformance::put_extreme(random, bytes, at),
        }
    }
}

#[test]
fn prop_mutated_files_are_read_or_refused() {
    let mut seeds = conformance::own_seeds("tdms");
    for w in [LITTLE, Writer { big: true }] {
        let texts = [w.u32(3), w.u32(6), b"abcdef".to_vec()].concat();
        let objects = [
            w.object(
                "/",
                none(w),
                &[w.property("wf_increment", &Property::Float(0.1))],
            ),
            w.object(
                "/'g'/'a'",
                w.index(10, 2),
                &[w.property("t", &Property::Time(1, 2))],
            ),
            w.object("/'g'/'s'", w.texts_index(2, texts.len() as u64), &[]),
            w.object("/'g'/'t'", w.index(0x44, 1), &[]),
        ];
        let data = [w.f64s(&[1.0, 2.0]), texts, w.stamp(5, 6)].concat();
        let rest = w.segment(
            0,
            &[w.object("/'g'/'s'", none(w), &[])],
            &[w.f64s(&[3.0, 4.0]), w.stamp(7, 8)].concat(),
        );
        seeds.push([w.segment(NEW, &objects, &data.repeat(3)), rest].concat());
        let lines = [w.object(
            "/'g'/'l'",
            device_index(w, true, 3, &[[0, 0, 1, 0]], &[1]),
            &[],
        )];
        let device = [w.object(
            "/'h'/'d'",
            device_index(w, false, 2, &[[3, 0, 0, 0]], &[4]),
            &[],
        )];
        seeds.push(
            [
                w.segment(NEW, &lines, &[1, 2, 3]),
                w.segment(NEW, &device, &[1; 16]),
            ]
            .concat(),
        );
    }
    conformance::survive(&seeds, open, mutate_segment, 40);
}

#[test]
#[ignore = "needs shared/data: conformance files of TDMS"]
fn shared_data_mutated_files_are_read_or_refused() {
    let mut seeds = conformance::shared_seeds("tdms_conformance", 40 << 10);
    seeds.retain(|seed| recognises(seed));
    conformance::survive(&seeds, open, mutate_segment, 40);
}
