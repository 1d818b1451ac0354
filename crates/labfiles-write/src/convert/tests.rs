use super::*;
use crate::hdf5::{CampaignWriter, ColumnToWrite, RecordTable};
use labfiles::open;
use labfiles::{ChannelInfo, Clock, DatasetInfo, Samples};
use std::collections::BTreeMap;

/// The files of the readers' tests.
const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../labfiles/tests/data");

fn own(name: &str) -> PathBuf {
    Path::new(DATA).join("formats").join(name)
}

/// The samples of a channel by its name.
#[track_caller]
fn samples(source: &dyn Source, dataset: usize, name: &str) -> Samples {
    let channel = source.datasets()[dataset].channel_index(name).unwrap();
    source.read(dataset, &[channel]).unwrap().remove(0)
}

fn same(a: &DatasetInfo, b: &DatasetInfo) {
    assert_eq!(
        a.sample_rate_hz().map(f64::round),
        b.sample_rate_hz().map(f64::round)
    );
    for channel in &a.channels {
        let other = &b.channels[b.channel_index(&channel.name).unwrap()];
        assert_eq!(
            (&channel.unit, channel.samples),
            (&other.unit, other.samples),
            "{}",
            channel.name
        );
    }
}

#[test]
fn records_come_back_from_every_target() {
    let source = open(&own("tables_int16_gzip.h5")).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let sources = [source];
    let options = Options {
        attributes: [("rig".to_owned(), "A".to_owned())].into(),
        ..Options::default()
    };
    for name in ["out.h5", "out.parquet", "out.csv"] {
        let out = dir.path().join(name);
        assert_eq!(
            convert(&sources, Target::of(&out).unwrap(), &out, &options)
                .unwrap()
                .records,
            3
        );
        let back: Vec<Box<dyn Source>> = match name {
            "out.csv" => ["run1", "run2", "run10"]
                .map(|r| open(&dir.path().join(format!("out/{r}.csv"))).unwrap())
                .into(),
            _ => vec![open(&out).unwrap()],
        };
        let all = back
            .iter()
            .flat_map(|s| (0..s.datasets().len()).map(move |d| (s, d)));
        for (d, (other, e)) in all.enumerate() {
            let (a, b) = (&sources[0].datasets()[d], &other.datasets()[e]);
            same(a, b);
            assert_eq!(
                b.attributes["clearance_m"], a.attributes["clearance_m"],
                "{name}"
            );
            assert_eq!(b.attributes["rig"], "A", "{name}");
            assert_eq!(
                samples(&*sources[0], d, "velocity_y"),
                samples(&**other, e, "velocity_y"),
                "{name}"
            );
        }
    }
}

#[test]
fn mixed_types_and_lengths_survive() {
    let sources = [
        open(&own("wide.parquet")).unwrap(),
        open(&own("rows_and_time.h5")).unwrap(),
    ];
    let dir = tempfile::tempdir().unwrap();
    for name in ["out.h5", "out.parquet"] {
        let out = dir.path().join(name);
        convert(
            &sources,
            Target::of(&out).unwrap(),
            &out,
            &Options::default(),
        )
        .unwrap();
        let back = open(&out).unwrap();
        assert_eq!(back.datasets().len(), 3, "{name}");
        let wide = back
            .datasets()
            .iter()
            .position(|d| d.name == "wide")
            .unwrap();
        assert_eq!(
            samples(&*back, wide, "i16"),
            samples(&*sources[0], 0, "i16"),
            "{name}"
        );
    }
    let single = dir.path().join("single.parquet");
    let options = Options {
        single_precision: true,
        ..Options::default()
    };
    convert(&sources[..1], Target::Parquet, &single, &options).unwrap();
    let Samples::Real(x) = samples(&*open(&single).unwrap(), 0, "x") else {
        panic!()
    };
    assert_eq!(x[7], f64::from(x[7] as f32));
    let text = samples(&*open(&single).unwrap(), 0, "note");
    assert_eq!(text, samples(&*sources[0], 0, "note"));
}

#[test]
fn channels_filled_up_with_empty_cells_are_named() {
    let dir = tempfile::tempdir().unwrap();
    let made = dir.path().join("made.h5");
    let mut writer = CampaignWriter::create(&made);
    writer
        .add(RecordTable {
            name: "run".to_owned(),
            sample_rate_hz: Some(1000.0),
            channels: vec![
                ColumnToWrite::numbers("long", "V", vec![1.0, 2.0, 3.0]),
                ColumnToWrite::numbers("short", "V", vec![1.0, 2.0]),
            ],
            attributes: Vec::new(),
        })
        .unwrap();
    writer.finish().unwrap();
    let sources = [open(&made).unwrap()];
    for (name, notes) in [("out.h5", 0), ("out.parquet", 1), ("out.csv", 1)] {
        let out = dir.path().join(name);
        let target = Target::of(&out).unwrap();
        let done = convert(&sources, target, &out, &Options::default()).unwrap();
        assert_eq!(done.notes.len(), notes, "{name}: {:?}", done.notes);
        let named = |note: &String| note.contains("3 rows (short)");
        assert!(done.notes.iter().all(named), "{:?}", done.notes);
    }
}

#[test]
fn nothing_is_left_where_a_record_cannot_be_read() {
    let sources = [open(&own("claims_too_much.h5")).unwrap()];
    let dir = tempfile::tempdir().unwrap();
    for name in ["out.h5", "out.parquet", "out.csv"] {
        let out = dir.path().join(name);
        let error = convert(
            &sources,
            Target::of(&out).unwrap(),
            &out,
            &Options::default(),
        )
        .unwrap_err();
        assert!(error.to_string().contains("claims_too_much.h5"), "{error}");
    }
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
}

#[test]
fn channels_of_one_name_are_all_kept() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("in.lvm");
    let head = "LabVIEW Measurement\nSeparator\tTab\nDecimal_Separator\t.\nX_Columns\tMulti\n";
    let ends = "***End_of_Header***\n";
    let channels = "Channels\t2\t\t\nSamples\t2\t\t2\nY_Unit_Label\tV\t\tV\n";
    let rows = "X_Value\tx\tX_Value\tx\tComment\n0\t1\t0.5\t2\ta\n1\t3\t1.5\t4\tb\n";
    std::fs::write(&path, format!("{head}{ends}{channels}{ends}{rows}")).unwrap();
    let sources = [open(&path).unwrap()];
    for name in ["out.h5", "out.parquet", "out.csv"] {
        let out = dir.path().join(name);
        let target = Target::of(&out).unwrap();
        let done = convert(&sources, target, &out, &Options::default()).unwrap();
        assert_eq!(done.records, 1);
        assert_eq!(
            done.notes.len(),
            usize::from(name == "out.h5"),
            "{:?}",
            done.notes
        );
        let back = open(&out).unwrap();
        assert_eq!(
            back.datasets()[0].channels[3].clock,
            Clock::Axis(2),
            "{name}"
        );
        for (channel, values) in [
            ("X_Value", [0.0, 1.0]),
            ("x", [1.0, 3.0]),
            ("X_Value 2", [0.5, 1.5]),
            ("x 2", [2.0, 4.0]),
        ] {
            assert_eq!(
                samples(&*back, 0, channel),
                Samples::Real(values.to_vec()),
                "{name}"
            );
        }
    }
}

#[test]
fn a_file_without_numbers_is_not_converted() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("text.mat");
    // A level 4 file of one text.
    let words = [51u32, 1, 2, 0, 2].map(u32::to_le_bytes).concat();
    std::fs::write(&path, [&words[..], b"a\0hi"].concat()).unwrap();
    let sources = [open(&path).unwrap()];
    for name in ["out.h5", "out.parquet", "out.csv"] {
        let out = dir.path().join(name);
        let target = Target::of(&out).unwrap();
        let error = convert(&sources, target, &out, &Options::default()).unwrap_err();
        assert!(error.to_string().contains("channel of numbers"), "{error}");
        assert!(!out.exists());
    }
}

/// A record of channels of any kind, in memory.
struct Made {
    datasets: Vec<DatasetInfo>,
    samples: Vec<Samples>,
}

impl Source for Made {
    fn format(&self) -> &'static str {
        "made"
    }

    fn path(&self) -> &Path {
        Path::new("made.mat")
    }

    fn datasets(&self) -> &[DatasetInfo] {
        &self.datasets
    }

    fn read(&self, _: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        Ok(channels.iter().map(|&c| self.samples[c].clone()).collect())
    }
}

fn made(channels: &[(&str, Option<&str>, Samples)]) -> Made {
    let info = |(name, unit, samples): &(&str, Option<&str>, Samples)| ChannelInfo {
        name: (*name).to_owned(),
        unit: unit.map(str::to_owned),
        stored: match samples {
            Samples::Real(_) => StoredType::Float(64),
            Samples::Complex(_) => StoredType::Complex(64),
            Samples::Text(_) => StoredType::Text,
        },
        samples: samples.len() as u64,
        sample_rate_hz: Some(250.0),
        start_time: None,
        clock: Clock::Shared,
        start_s: None,
        properties: BTreeMap::new(),
    };
    let dataset = DatasetInfo {
        name: String::new(),
        channels: channels.iter().map(info).collect(),
        time_axis: None,
        attributes: [("remark", "a, \"b\" = c"), ("clearance_m", "0.001")]
            .map(|(k, v)| (k.to_owned(), v.to_owned()))
            .into(),
    };
    Made {
        datasets: vec![dataset],
        samples: channels.iter().map(|(_, _, s)| s.clone()).collect(),
    }
}

/// Texts that could be taken for something else in a table.
const TEXTS: [&str; 12] = [
    "a, b",
    "12.5",
    "",
    "say \"hi\"",
    "# note",
    " two; blanks ",
    "NaN",
    "1\t2",
    "x\ny",
    "2024-05-01 12:00:00",
    "-",
    "\"",
];

/// Channels of every kind that is written, most of them texts.
fn every_kind() -> Vec<(&'static str, Option<&'static str>, Samples)> {
    let texts = |from: usize| {
        let turned = TEXTS.iter().cycle().skip(from).take(TEXTS.len());
        Samples::Text(turned.map(|t| (*t).to_owned()).collect())
    };
    let real =
        |value: fn(f64) -> f64| Samples::Real((0..TEXTS.len()).map(|i| value(i as f64)).collect());
    let pairs = (0..TEXTS.len()).map(|i| (i as f64, -0.1 * i as f64));
    let empty = Samples::Text(vec![String::new(); TEXTS.len()]);
    vec![
        ("names{1}", None, texts(0)),
        ("labels, all", None, texts(3)),
        ("units \"odd\"", Some("m/s²"), texts(5)),
        ("empty", None, empty),
        ("7", None, texts(7)),
        ("mass (kg)", None, real(|i| 1e-310 * i)),
        ("velocity; x", Some("mm/s"), real(|i| (i - 3.0) / 7.0)),
        (
            "gaps [1]",
            Some("V"),
            real(|i| if i == 0.0 { f64::NAN } else { 1e300 * i }),
        ),
        ("transfer", Some("N/m"), Samples::Complex(pairs.collect())),
        ("whole", None, real(|i| 9_007_199_254_740_993.0 - i)),
    ]
}

/// What a channel must be after it was written: two channels of real numbers for a complex one.
fn written(channels: &[(&str, Option<&str>, Samples)]) -> Vec<(String, Option<String>, Samples)> {
    let mut all = Vec::new();
    for (name, unit, samples) in channels {
        let unit = unit.map(str::to_owned);
        match samples {
            Samples::Complex(values) => {
                let (re, im) = values.iter().copied().unzip();
                all.push((format!("{name}.re"), unit.clone(), Samples::Real(re)));
                all.push((format!("{name}.im"), unit, Samples::Real(im)));
            }
            other => all.push(((*name).to_owned(), unit, other.clone())),
        }
    }
    all
}

/// Whether samples are alike, those that are missing too.
fn alike(a: &Samples, b: &Samples) -> bool {
    match (a, b) {
        (Samples::Real(a), Samples::Real(b)) => {
            let bits = |v: &f64| if v.is_nan() { 0 } else { v.to_bits() };
            a.iter().map(bits).eq(b.iter().map(bits))
        }
        (a, b) => a == b,
    }
}

#[test]
fn every_kind_of_channel_comes_back_from_every_target() {
    let channels = every_kind();
    let sources: [Box<dyn Source>; 1] = [Box::new(made(&channels))];
    let dir = tempfile::tempdir().unwrap();
    for name in ["out.h5", "out.parquet", "out.csv"] {
        let out = dir.path().join(name);
        let target = Target::of(&out).unwrap();
        convert(&sources, target, &out, &Options::default()).unwrap();
        let back = open(&out).unwrap();
        let info = &back.datasets()[0];
        let mut expected = written(&channels);
        if target == Target::Hdf5 {
            expected.retain(|(_, _, s)| !matches!(s, Samples::Text(_)));
        }
        assert_eq!(info.channels.len(), expected.len(), "{name}");
        assert_eq!(info.sample_rate_hz(), Some(250.0), "{name}");
        assert_eq!(info.attributes["remark"], "a, \"b\" = c", "{name}");
        let all: Vec<usize> = (0..expected.len()).collect();
        let read = back.read(0, &all).unwrap();
        for ((channel, read), (expected, unit, samples)) in
            info.channels.iter().zip(&read).zip(&expected)
        {
            assert_eq!((&channel.name, &channel.unit), (expected, unit), "{name}");
            assert_eq!(channel.samples, samples.len() as u64, "{name} {expected}");
            let text = channel.stored == StoredType::Text;
            assert_eq!(
                text,
                matches!(samples, Samples::Text(_)),
                "{name} {expected}"
            );
            assert!(alike(read, samples), "{name} {expected}: {read:?}");
        }
    }
}

#[test]
fn starts_of_channels_come_back_from_every_target() {
    let numbers = |from: f64| Samples::Real((0..20).map(|i| from + f64::from(i)).collect());
    let mut record = made(&[
        ("x", Some("mm"), numbers(0.0)),
        ("contact", Some("V"), numbers(5.0)),
    ]);
    record.datasets[0].channels[0].start_s = Some(0.0);
    record.datasets[0].channels[1].start_s = Some(0.3);
    record.datasets[0].channels[1].clock = Clock::Rate;
    let sources: [Box<dyn Source>; 1] = [Box::new(record)];
    let dir = tempfile::tempdir().unwrap();
    for name in ["out.h5", "out.parquet", "out.csv", "out.uff"] {
        let out = dir.path().join(name);
        convert(
            &sources,
            Target::of(&out).unwrap(),
            &out,
            &Options::default(),
        )
        .unwrap();
        let back = open(&out).unwrap();
        let starts: Vec<Option<f64>> = back.datasets()[0]
            .channels
            .iter()
            .map(|c| c.start_s)
            .collect();
        assert_eq!(starts, [Some(0.0), Some(0.3)], "{name}");
        assert_eq!(back.datasets()[0].channels[1].clock, Clock::Rate, "{name}");
    }
}

/// A record with a time axis of 2000 Hz, and a channel with one of its own.
fn two_clocks(own: Samples) -> Made {
    let even = (0..20).map(|i| f64::from(i) / 2000.0).collect();
    let numbers = |from: f64| Samples::Real((0..20).map(|i| from + f64::from(i)).collect());
    let mut record = made(&[
        ("t", Some("s"), Samples::Real(even)),
        ("x", Some("mm"), numbers(0.0)),
        ("t2", Some("s"), own),
        ("slow", Some("m/s"), numbers(5.0)),
    ]);
    let set = &mut record.datasets[0];
    set.time_axis = Some(0);
    for (channel, rate) in set.channels.iter_mut().zip([2000.0, 2000.0, 400.0, 400.0]) {
        channel.sample_rate_hz = Some(rate);
    }
    set.channels[3].clock = Clock::Axis(2);
    record
}

#[test]
fn valid_universal_files_state_start_and_rate_of_each_channel() {
    let own = (0..20).map(|i| 0.001 + f64::from(i) / 400.0).collect();
    let sources: [Box<dyn Source>; 1] = [Box::new(two_clocks(Samples::Real(own)))];
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out.uff");
    convert(&sources, Target::Uff, &out, &Options::default()).unwrap();
    let back = open(&out).unwrap();
    assert_eq!(back.datasets().len(), 1);
    let set = &back.datasets()[0];
    for (name, rate, start) in [("x", 2000.0, 0.0), ("slow", 400.0, 0.001)] {
        let channel = &set.channels[set.channel_index(name).unwrap()];
        assert_eq!(channel.sample_rate_hz, Some(rate), "{name}");
        assert_eq!(channel.start_s, Some(start), "{name}");
        assert_eq!(samples(&*back, 0, name), samples(&*sources[0], 0, name));
    }
}

#[test]
fn channels_whose_times_a_universal_file_cannot_hold_are_refused_by_name() {
    let own = (0..20).map(|i| f64::from(i * i)).collect();
    let uneven = two_clocks(Samples::Real(own));
    let numbers = || Samples::Real(vec![1.0; 20]);
    let mut unknown = made(&[
        ("x", Some("mm"), numbers()),
        ("y", Some("mm"), numbers()),
        ("contact", Some("V"), numbers()),
    ]);
    unknown.datasets[0].channels[0].start_s = Some(0.0);
    unknown.datasets[0].channels[1].start_s = Some(0.01);
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out.uff");
    for (record, fault) in [
        (uneven, "channel 'slow': its times are not even"),
        (
            unknown,
            "channel 'contact': its start is not known beside that of other channels",
        ),
    ] {
        let sources: [Box<dyn Source>; 1] = [Box::new(record)];
        let error = convert(&sources, Target::Uff, &out, &Options::default()).unwrap_err();
        assert!(error.to_string().contains(fault), "{error}");
        assert!(!out.exists());
    }
}

/// A record of numbers that need all their bits, with attributes, and one without a rate.
fn bits(dir: &Path) -> Vec<Box<dyn Source>> {
    let made = dir.join("made.h5");
    let mut writer = CampaignWriter::create(&made);
    let odd: Vec<f64> = (0..257).map(|i| f64::from(i) / 3.0 - 41.0).collect();
    let even: Vec<f64> = (0..257).map(|i| 1e-7 / (1.0 + f64::from(i))).collect();
    for (name, rate) in [
        ("run 1", Some(2000.0)),
        ("run 2", Some(2000.0)),
        ("run 3", None),
    ] {
        let channels = vec![
            ColumnToWrite::numbers("velocity of mass x", "mm/s", odd.clone()),
            ColumnToWrite::numbers("displacement of mass x", "m", even.clone()),
        ];
        let record = RecordTable {
            name: name.to_owned(),
            sample_rate_hz: rate,
            channels,
            attributes: vec![
                ("clearance_m".to_owned(), 5e-4.into()),
                ("sweep".to_owned(), "up".into()),
            ],
        };
        writer.add(record).unwrap();
    }
    writer.finish().unwrap();
    vec![open(&made).unwrap()]
}

#[test]
fn universal_files_keep_every_bit_in_binary_and_thirteen_digits_as_text() {
    let dir = tempfile::tempdir().unwrap();
    let sources = bits(dir.path());
    for (target, digits) in [(Target::Uff, 0.0), (Target::UffText, 1e-12)] {
        let out = dir.path().join("out.uff");
        let done = convert(&sources, target, &out, &Options::default()).unwrap();
        assert_eq!(done.records, 3);
        assert_eq!(
            done.notes.len(),
            usize::from(digits > 0.0),
            "{:?}",
            done.notes
        );
        let back = open(&out).unwrap();
        assert_eq!(back.datasets().len(), 3);
        for (d, info) in back.datasets().iter().enumerate() {
            assert_eq!(info.attributes["clearance_m"], "0.0005");
            assert_eq!(info.attributes["sweep"], "up");
            assert_eq!(info.name, format!("run {}", d + 1));
            assert_eq!(info.attributes["id2"], info.name);
            assert_eq!(info.sample_rate_hz(), (d < 2).then_some(2000.0));
            for name in ["velocity of mass x", "displacement of mass x"] {
                let index = info.channel_index(name).unwrap();
                let unit = if name.starts_with('v') { "mm/s" } else { "m" };
                assert_eq!(info.channels[index].unit.as_deref(), Some(unit));
                let (Samples::Real(a), Samples::Real(b)) =
                    (samples(&*sources[0], d, name), samples(&*back, d, name))
                else {
                    panic!("real numbers")
                };
                assert_eq!(a.len(), b.len());
                let near = |(a, b): (&f64, &f64)| (a - b).abs() <= digits * a.abs();
                assert!(a.iter().zip(&b).all(near), "{name}");
            }
        }
    }
}

/// The bytes of a file that pyuff has read back bit by bit (`data/goldens/check_written.py`).
#[test]
fn valid_universal_files_are_those_that_pyuff_has_read() {
    let dir = tempfile::tempdir().unwrap();
    let sources = bits(dir.path());
    let goldens = Path::new(DATA).join("goldens");
    for (target, name) in [
        (Target::Uff, "written_binary.uff"),
        (Target::UffText, "written_text.uff"),
    ] {
        let out = dir.path().join("out.uff");
        convert(&sources, target, &out, &Options::default()).unwrap();
        let written = std::fs::read(&out).unwrap();
        let golden = goldens.join(name);
        if std::env::var_os("UPDATE_GOLDENS").is_some() {
            std::fs::write(&golden, &written).unwrap();
        }
        assert!(
            written == std::fs::read(&golden).unwrap(),
            "{name} has changed"
        );
    }
}

#[test]
fn what_is_said_of_several_records_is_said_once() {
    let dir = tempfile::tempdir().unwrap();
    let made: Vec<_> = ["a", "b", "c"]
        .map(|n| dir.path().join(format!("{n}.csv")))
        .into();
    for path in &made {
        std::fs::write(path, "t [s],x [mm],state\n0,1,up\n0.5,2,up\n1,3,down\n").unwrap();
    }
    let sources: Vec<_> = made.iter().map(|path| open(path).unwrap()).collect();
    let out = dir.path().join("out.h5");
    let done = convert(&sources, Target::Hdf5, &out, &Options::default()).unwrap();
    let [note] = &done.notes[..] else {
        panic!("{:?}", done.notes)
    };
    let says = "3 records from 'a' on: texts are left out (state)";
    assert!(note.starts_with(says), "{note}");
}

#[test]
fn the_files_that_are_written_are_known_before() {
    let sources = [open(&own("tables_int16_gzip.h5")).unwrap()];
    let dir = tempfile::tempdir().unwrap();
    let options = Options::default();
    for (target, name) in [(Target::Csv, "day.csv"), (Target::Hdf5, "day.h5")] {
        let out = dir.path().join(name);
        let written = files(&sources, target, &out, &options);
        assert!(written.iter().all(|path| !path.exists()));
        convert(&sources, target, &out, &options).unwrap();
        assert!(written.iter().all(|path| path.is_file()), "{written:?}");
    }
    let within = std::fs::read_dir(dir.path().join("day")).unwrap().count();
    let out = dir.path().join("day.csv");
    assert_eq!(files(&sources, Target::Csv, &out, &options).len(), within);
}

#[test]
fn a_rate_that_the_columns_do_not_hold_is_named_once() {
    let dir = tempfile::tempdir().unwrap();
    let made = dir.path().join("made.h5");
    let mut writer = CampaignWriter::create(&made);
    for (name, rate) in [("a", 44_100.0), ("b", 2000.0), ("c", 44_100.0), ("d", 3.0)] {
        let record = RecordTable {
            name: name.to_owned(),
            sample_rate_hz: Some(rate),
            channels: vec![ColumnToWrite::numbers("x", "V", vec![1.0, 2.0])],
            attributes: Vec::new(),
        };
        writer.add(record).unwrap();
    }
    writer.finish().unwrap();
    let sources = [open(&made).unwrap()];
    let out = dir.path().join("out.uff");
    let done = convert(&sources, Target::Uff, &out, &Options::default()).unwrap();
    let [several, one] = &done.notes[..] else {
        panic!("{:?}", done.notes)
    };
    assert!(several.starts_with("2 records from 'a' on: "), "{several}");
    assert!(several.contains("instead of 44100 Hz"), "{several}");
    assert!(one.starts_with("record 'd': "), "{one}");
    let rate = open(&out).unwrap().datasets()[0].sample_rate_hz().unwrap();
    assert!((rate / 44_100.0 - 1.0).abs() < 1e-6);
}

#[test]
fn channels_of_a_tidy_table_may_have_times_of_their_own() {
    let dir = tempfile::tempdir().unwrap();
    let table = dir.path().join("tidy.csv");
    let row = |channel: &str, i: u32, start: f64, step: f64| {
        format!("{channel},{:.4},{i}\n", start + f64::from(i) * step)
    };
    let mut text = String::from("channel,time [s],value\n");
    for (channel, start, step) in [("x", 0.0, 1e-3), ("y", 0.0, 1e-3), ("slow", 0.3, 2e-3)] {
        text += &(0..30)
            .map(|i| row(channel, i, start, step))
            .collect::<String>();
    }
    std::fs::write(&table, text).unwrap();
    let out = dir.path().join("tidy.parquet");
    let sources = [open(&table).unwrap()];
    convert(
        &sources,
        Target::of(&out).unwrap(),
        &out,
        &Options::default(),
    )
    .unwrap();
    let source = open(&out).unwrap();
    let channels = &source.datasets()[0].channels;
    let clocks: Vec<(&str, Clock)> = channels
        .iter()
        .map(|c| (c.name.as_str(), c.clock))
        .collect();
    assert_eq!(
        clocks,
        [
            ("time", Clock::Shared),
            ("x", Clock::Shared),
            ("y", Clock::Shared),
            ("slow", Clock::Axis(4)),
            ("time of slow", Clock::Shared),
        ]
    );
    let times = source.read(0, &[4]).unwrap().remove(0).into_real().unwrap();
    assert_eq!((times[0], times[1]), (0.3, 0.302));
}

#[test]
fn records_of_unlike_channels_have_their_own_in_one_table() {
    let dir = tempfile::tempdir().unwrap();
    let path = |name: &str| dir.path().join(name);
    std::fs::write(path("a.csv"), "t [s],x [mm]\n0,1\n0.5,2\n1,3\n").unwrap();
    std::fs::write(path("b.csv"), "t [s],v [m/s]\n0,1\n0.5,2\n1,3\n").unwrap();
    let sources = ["a.csv", "b.csv"].map(|name| open(&path(name)).unwrap());
    let out = path("both.parquet");
    convert(
        &sources,
        Target::of(&out).unwrap(),
        &out,
        &Options::default(),
    )
    .unwrap();
    let back = open(&out).unwrap();
    let names = |d: usize| {
        let channels = back.datasets()[d].channels.iter();
        channels.map(|c| c.name.as_str()).collect::<Vec<_>>()
    };
    assert_eq!((names(0), names(1)), (vec!["t", "x"], vec!["t", "v"]));
}
