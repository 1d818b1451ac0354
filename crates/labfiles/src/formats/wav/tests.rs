use serde_json::Value;

use super::*;
use crate::conformance::{self, Statistics};
use crate::source::StoredType;

// ---- writing small files ----

struct Written {
    big: bool,
    tag: u16,
    channels: u16,
    bits: u16,
    bytes: u16,
    data: Vec<u8>,
}

impl Written {
    fn order(&self, mut little: Vec<u8>) -> Vec<u8> {
        if self.big {
            little.reverse();
        }
        little
    }
    fn u16(&self, value: u16) -> Vec<u8> {
        self.order(value.to_le_bytes().to_vec())
    }
    fn u32(&self, value: u32) -> Vec<u8> {
        self.order(value.to_le_bytes().to_vec())
    }
    fn chunk(&self, name: &[u8; 4], content: &[u8]) -> Vec<u8> {
        let padding = vec![0; content.len() % 2];
        [
            name.to_vec(),
            self.u32(content.len() as u32),
            content.to_vec(),
            padding,
        ]
        .concat()
    }
    fn format(&self) -> Vec<u8> {
        let (rate, block) = (1000u32, self.bytes * self.channels);
        let per_second = rate * u32::from(block);
        [
            self.u16(self.tag),
            self.u16(self.channels),
            self.u32(rate),
            self.u32(per_second),
            self.u16(block),
            self.u16(self.bits),
        ]
        .concat()
    }
    fn file(&self, more: &[Vec<u8>]) -> Vec<u8> {
        let name = if self.big { b"RIFX" } else { b"RIFF" };
        let format = self.chunk(b"fmt ", &self.format());
        let chunks = [format, more.concat(), self.chunk(b"data", &self.data)].concat();
        [
            name.to_vec(),
            self.u32(chunks.len() as u32 + 4),
            b"WAVE".to_vec(),
            chunks,
        ]
        .concat()
    }
}

/// Two channels of integers of a width, in an order.
fn integers(bytes: u16, big: bool, values: &[i64]) -> Written {
    let mut written = Written {
        big,
        tag: 1,
        channels: 2,
        bits: 8 * bytes,
        bytes,
        data: Vec::new(),
    };
    written.data = values
        .iter()
        .flat_map(|v| written.order(v.to_le_bytes()[..bytes as usize].to_vec()))
        .collect();
    written
}

fn opened(bytes: &[u8]) -> Result<Box<dyn Source>, ReadError> {
    let temp = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(temp.path(), bytes).unwrap();
    open(temp.path())
}

fn real(samples: Samples) -> Vec<f64> {
    match samples {
        Samples::Real(values) => values,
        other => panic!("{other:?}"),
    }
}

// ---- goldens ----

#[test]
#[ignore = "needs shared/data: conformance files of WAV"]
fn shared_data_every_golden_is_met() {
    for (path, golden) in conformance::goldens("wav_conformance") {
        let what = path.display().to_string();
        let opened = open(&path);
        if let Value::String(error) = &golden {
            assert!(opened.is_err(), "{what} must be refused: {error}");
            continue;
        }
        let source = opened.unwrap_or_else(|error| panic!("{error}"));
        let infos = &source.datasets()[0].channels;
        let stored = match golden["dtype"].as_str().unwrap().trim_start_matches('>') {
            "uint8" => StoredType::UInt(8),
            "int16" => StoredType::Int(16),
            "int32" | "i4" => StoredType::Int(32),
            "int64" => StoredType::Int(64),
            "float32" | "f4" => StoredType::Float(32),
            "float64" => StoredType::Float(64),
            other => panic!("{other}"),
        };
        let channels: Vec<Vec<f64>> = conformance::read_all(source.as_ref(), 0)
            .unwrap()
            .into_iter()
            .map(real)
            .collect();
        for info in infos {
            assert_eq!(info.stored, stored, "{what}");
            assert_eq!(info.sample_rate_hz, golden["fs"].as_f64(), "{what}");
        }
        let shape: Vec<u64> = golden["shape"]
            .as_array()
            .unwrap()
            .iter()
            .map(|n| n.as_u64().unwrap())
            .collect();
        assert_eq!(infos[0].samples, shape[0], "{what}");
        assert_eq!(
            infos.len() as u64,
            shape.get(1).copied().unwrap_or(1),
            "{what}"
        );
        let rows = (0..channels[0].len()).flat_map(|row| channels.iter().map(move |c| c[row]));
        Statistics::of(rows).check(&golden, None, &what);
    }
}

// ---- own files ----

#[test]
fn integers_of_every_width_are_left_justified() {
    for bytes in 2u16..=8 {
        for big in [false, true] {
            let most = i64::MAX >> (64 - 8 * bytes);
            let source =
                opened(&integers(bytes, big, &[1, -1, most, -most - 1]).file(&[])).unwrap();
            let native: i32 = match bytes {
                2 => 16,
                3 | 4 => 32,
                _ => 64,
            };
            let unit = 2f64.powi(native - 8 * i32::from(bytes));
            let channels: Vec<Vec<f64>> = source
                .read(0, &[0, 1])
                .unwrap()
                .into_iter()
                .map(real)
                .collect();
            assert_eq!(channels[0], [unit, most as f64 * unit], "{bytes} bytes");
            assert_eq!(
                channels[1],
                [-unit, (-most - 1) as f64 * unit],
                "{bytes} bytes"
            );
            let full: f64 = source.datasets()[0].channels[0].properties["full_scale"]
                .parse()
                .unwrap();
            assert_eq!(-channels[1][1], full);
        }
    }
}

#[test]
fn floats_extensible_texts_and_broadcast() {
    let data = [0.5f32, -0.25]
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    let written = Written {
        big: false,
        tag: 0xfffe,
        channels: 2,
        bits: 32,
        bytes: 4,
        data,
    };
    let extension = [
        &[22, 0, 32, 0, 3, 0, 0, 0, 3, 0][..],
        b"\0\0\0\0\x10\0\x80\0\0\xaa\0\x38\x9b\x71",
    ]
    .concat();
    let format = [written.format(), extension].concat();
    let mut broadcast = vec![0; 602];
    broadcast[320..338].copy_from_slice(b"2024-02-2913:49:58");
    let texts = [b"INFO".to_vec(), written.chunk(b"INAM", b"gap 2 mm\0\0")].concat();
    let chunks = [
        written.chunk(b"fmt ", &format),
        written.chunk(b"bext", &broadcast),
        written.chunk(b"LIST", &texts),
        written.chunk(b"data", &written.data),
    ];
    let bytes = [b"RIFF\0\0\0\0WAVE".to_vec(), chunks.concat()].concat();
    assert!(recognises(&bytes));
    let source = opened(&bytes).unwrap();
    let dataset = &source.datasets()[0];
    assert_eq!(dataset.attributes["INAM"], "gap 2 mm");
    assert_eq!(
        dataset.channels[1].start_time.as_deref(),
        Some("2024-02-29T13:49:58")
    );
    assert_eq!(real(source.read(0, &[1]).unwrap().remove(0)), [-0.25]);
}

#[test]
fn broken_files_are_refused_at_a_byte() {
    let good = integers(2, false, &[1, 2, 3, 4]).file(&[]);
    let mut rate = good.clone();
    rate[28] ^= 1;
    assert!(
        opened(&rate)
            .err()
            .unwrap()
            .to_string()
            .contains("4000 bytes per second")
    );
    let mut law = good.clone();
    law[20] = 7;
    assert!(opened(&law).err().unwrap().to_string().contains("mu-law"));
    let mut huge = good.clone();
    huge[40..44].fill(0xff);
    let (source, peak) = conformance::peak_bytes(|| opened(&huge).unwrap());
    assert_eq!(source.datasets()[0].channels[0].samples, 2);
    assert!(source.notes()[0].contains("cut short") && peak < 100_000);
    let odd = opened(&good[..good.len() - 1]).unwrap();
    assert_eq!(odd.datasets()[0].channels[1].samples, 1);
    let headless = opened(&good[..36]).err().unwrap();
    assert_eq!(headless.byte, Some(36));
    assert!(source.read(0, &[2]).is_err());
}

// ---- mutations ----

#[test]
fn prop_mutated_files_are_read_or_refused() {
    let mut seeds = conformance::own_seeds("wav");
    seeds.push(integers(3, false, &[5; 40]).file(&[]));
    seeds.push(integers(7, true, &[-5; 40]).file(&[]));
    conformance::survive(&seeds, open, conformance::mutate, 40);
}

#[test]
#[ignore = "needs shared/data: conformance files of WAV"]
fn shared_data_mutated_files_are_read_or_refused() {
    let mut seeds = conformance::shared_seeds("wav_conformance", 8 << 10);
    seeds.retain(|seed| recognises(seed));
    conformance::survive(&seeds, open, conformance::mutate, 40);
}
