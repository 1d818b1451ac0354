use super::*;
use crate::record::open::open;
use crate::record::source::DatasetInfo;

fn own(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data/formats")
        .join(name)
}

fn samples(source: &dyn Source, dataset: usize, name: &str) -> Samples {
    let channel = source.datasets()[dataset]
        .channel_index(name)
        .unwrap_or_else(|| panic!("no {name}"));
    source.read(dataset, &[channel]).unwrap().remove(0)
}

fn same(a: &DatasetInfo, b: &DatasetInfo) {
    assert_eq!(
        a.sample_rate_hz().map(|r| r.round()),
        b.sample_rate_hz().map(|r| r.round())
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
fn valid_records_come_back_from_every_target() {
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
            convert(&sources, Target::of(&out).unwrap(), &out, &options).unwrap(),
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
fn valid_mixed_types_and_lengths_survive() {
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
fn valid_nothing_is_left_where_a_record_cannot_be_read() {
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
