use super::*;
use crate::conformance::{mutate, own, real, shared_seeds, survive_within, wave};

#[test]
fn valid_tables_of_counts_with_scale_and_offset() {
    let s = open(&own("tables_int16_gzip.h5")).unwrap();
    let names: Vec<&str> = s.datasets().iter().map(|d| d.name.as_str()).collect();
    assert_eq!(names, ["run1", "run2", "run10"]);
    let info = &s.datasets()[2];
    assert_eq!(info.channels[1].name, "velocity_x");
    assert_eq!(info.channels[1].unit.as_deref(), Some("mm/s"));
    assert_eq!(info.sample_rate_hz(), Some(2000.0));
    assert_eq!(info.attributes["clearance_m"], "0.01");
    assert_eq!(info.attributes["sweep"], "up");
    let drive = real(&*s, 2, "drive");
    assert_eq!(drive.len(), 50);
    for (i, v) in drive.iter().enumerate() {
        assert_eq!(*v, (1000.0 * wave(i)).round() * 0.005 + 1.0);
    }
    let both = s.read(2, &[2, 0]).unwrap();
    assert_eq!(both[1], Samples::Real(drive));
}

#[test]
fn valid_groups_of_arrays_of_many_types() {
    let s = open(&own("groups_mixed_types.h5")).unwrap();
    assert_eq!(s.datasets().len(), 2);
    let info = &s.datasets()[1];
    assert_eq!(info.name, "set/rec02");
    assert_eq!(info.attributes["drive_frequency_hz"], "12.5");
    assert_eq!(info.attributes["operator"], "Novák");
    assert_eq!(info.attributes["gain"], "2.5");
    assert_eq!(info.time_axis, info.channel_index("time"));
    assert!((info.sample_rate_hz().unwrap() - 2000.0).abs() < 1e-6);
    assert_eq!(real(&*s, 1, "x")[7], f64::from(wave(7) as f32));
    assert_eq!(real(&*s, 1, "count")[49], 49.0);
    assert_eq!(
        real(&*s, 1, "contact").iter().sum::<f64>(),
        (0..50).filter(|&i| wave(i) > 0.5).count() as f64
    );
    assert!((real(&*s, 1, "half")[0] - 1.0).abs() < 1e-3);
    let z = info.channel_index("z").unwrap();
    let Samples::Complex(z) = s.read(1, &[z]).unwrap().remove(0) else {
        panic!()
    };
    assert!((z[3].0 - wave(3)).abs() < 1e-15 && (z[0].1 - 1.0).abs() < 1e-15);
}

#[test]
fn valid_a_table_of_one_channel_has_its_name_and_its_attributes() {
    let s = open(&own("one_channel.h5")).unwrap();
    let info = &s.datasets()[0];
    assert_eq!(info.channels[0].name, "position");
    assert_eq!(info.attributes["frequency_hz"], "12.5");
    assert_eq!(info.sample_rate_hz(), Some(2000.0));
    assert!((real(&*s, 0, "position")[9] - wave(9)).abs() < 1e-15);
}

#[test]
fn valid_channels_in_rows_and_a_table_beside_its_time() {
    let s = open(&own("rows_and_time.h5")).unwrap();
    let of = |name: &str| s.datasets().iter().position(|d| d.name == name).unwrap();
    assert!((real(&*s, of("wide"), "vx")[9] - wave(9)).abs() < 1e-15);
    assert_eq!(s.datasets()[of("wide")].sample_rate_hz(), Some(2000.0));
    let timed = of("timed");
    assert_eq!(s.datasets()[timed].time_axis, Some(0));
    assert!((real(&*s, timed, "a")[9] - wave(9)).abs() < 1e-15);
    assert!((s.datasets()[timed].sample_rate_hz().unwrap() - 2000.0).abs() < 1e-6);
}

#[test]
fn valid_fields_and_three_dimensions() {
    let s = open(&own("fields_and_cube.h5")).unwrap();
    let of = |name: &str| s.datasets().iter().position(|d| d.name == name).unwrap();
    assert_eq!(real(&*s, of("table"), "n")[49], 49.0);
    assert_eq!(
        real(&*s, of("cube[1]"), "b"),
        [16.0, 19.0, 22.0, 25.0, 28.0]
    );
}

#[test]
fn valid_compact_and_newest_layouts() {
    for name in ["compact.h5", "latest.h5"] {
        let s = open(&own(name)).unwrap();
        assert!(
            (real(&*s, 0, "y")[3] - (std::f64::consts::TAU * 12.6 * 3.0 / 2000.0).cos()).abs()
                < 1e-15,
            "{name}"
        );
        assert!((real(&*s, 0, "x")[9] - wave(9)).abs() < 1e-15, "{name}");
    }
    let s = open(&own("latest.h5")).unwrap();
    assert_eq!(s.notes(), [""; 0]);
    assert_eq!(s.datasets()[0].sample_rate_hz(), Some(2000.0));
    let x = s.datasets()[0].channel_index("x").unwrap();
    assert_eq!(s.datasets()[0].channels[x].unit.as_deref(), Some("mm/s"));
    let s = open(&own("latest_attributes.h5")).unwrap();
    let info = &s.datasets()[0];
    assert_eq!(info.sample_rate_hz(), Some(2000.0));
    assert_eq!(info.attributes["rig"], "A");
    let units: Vec<_> = info.channels.iter().map(|c| c.unit.as_deref()).collect();
    assert_eq!(units, [Some("mm/s"), Some("V")]);
    assert!((real(&*s, 0, "x")[9] - wave(9)).abs() < 1e-15);
    let s = open(&own("latest_two_unlimited.h5")).unwrap();
    assert!((real(&*s, 0, "column_1")[9] - wave(9)).abs() < 1e-15);
}

#[test]
fn valid_claims_and_cuts_are_refused() {
    let s = open(&own("claims_too_much.h5")).unwrap();
    let error = s.read(0, &[0]).unwrap_err();
    assert!(error.found.contains("1000000000000"), "{error}");
    let bytes = std::fs::read(own("tables_int16_gzip.h5")).unwrap();
    let dir = tempfile::tempdir().unwrap();
    for keep in [100, 1000, bytes.len() / 2, bytes.len() - 300] {
        let path = dir.path().join("cut.h5");
        std::fs::write(&path, &bytes[..keep]).unwrap();
        if let Ok(s) = open(&path) {
            let all: Vec<_> = (0..s.datasets().len()).map(|d| s.read(d, &[0])).collect();
            assert!(all.iter().any(Result::is_err), "{keep}");
        }
    }
}

#[test]
#[ignore = "needs shared/data: conformance files of MATLAB 7.3"]
fn shared_data_goldens_of_matlab_7_3() {
    use crate::conformance::{Statistics, goldens};
    let mut arrays = 0;
    for (path, golden) in goldens("mat73_conformance") {
        // One of the goldens is among the files of the older levels.
        let path = if path.exists() {
            path
        } else {
            path.parent()
                .unwrap()
                .parent()
                .unwrap()
                .join("mat5_conformance")
                .join(path.file_name().unwrap())
        };
        let (store, tree) = open_store(&path).unwrap();
        for (name, golden) in golden.as_object().unwrap() {
            let array = find_array(&tree, name).unwrap_or_else(|| panic!("{path:?}: no {name}"));
            let shape: Vec<u64> = serde_json::from_value(golden["shape"].clone()).unwrap();
            assert_eq!(array.shape, shape, "{path:?}: {name}");
            if golden.get("n").is_none() || golden["sum"].is_null() {
                continue;
            }
            let raw = store.raw(array).unwrap();
            let count = array.count().unwrap() as usize;
            let spacing = Spacing {
                offset: 0,
                stride: array.element.bytes(),
                count,
            };
            if let Some(Samples::Real(values)) = array.element.decode(&raw, spacing) {
                let nan = values.iter().filter(|v| v.is_nan()).count();
                assert_eq!(
                    nan as u64,
                    golden["nan"].as_u64().unwrap(),
                    "{path:?}: {name}"
                );
                if nan == 0 {
                    Statistics::of(values).check(golden, None, name);
                }
                arrays += 1;
            }
        }
        open(&path)
            .map(|s| {
                (0..s.datasets().len())
                    .for_each(|d| drop(crate::conformance::read_all(&*s, d).unwrap()));
            })
            .unwrap_or_else(|e| println!("{e}"));
    }
    assert!(arrays > 200, "{arrays}");
}

fn find_array<'a>(tree: &'a Tree, path: &str) -> Option<&'a Array> {
    let own = tree.arrays.iter().find(|a| a.path == path);
    own.or_else(|| tree.groups.iter().find_map(|g| find_array(g, path)))
}

#[test]
#[ignore = "needs shared/data: conformance files of MATLAB 7.3"]
fn shared_data_matlab_7_3_variables_are_named_as_in_older_levels() {
    let dir = crate::conformance::shared_data("mat73_conformance");
    let s = open(&dir.join("testfile1.mat")).unwrap();
    let of = |name: &str| {
        let d = s
            .datasets()
            .iter()
            .position(|d| d.channel_index(name).is_some())
            .unwrap_or_else(|| panic!("no {name}"));
        s.read(d, &[s.datasets()[d].channel_index(name).unwrap()])
            .unwrap()
            .remove(0)
    };
    assert_eq!(of("data.arr_double").len(), 3);
    assert_eq!(of("data.string_").len(), 1);
    assert!(matches!(of("data.complex_"), Samples::Complex(_)));
    assert_eq!(of("data.arr_two_three(:,1)").len(), 3);
    assert_eq!(of("data.struct_.test").len(), 4);
    assert!(
        s.notes().iter().any(|n| n.contains("sparse")),
        "{:?}",
        s.notes()
    );
}

#[test]
#[ignore = "needs shared/data: conformance files of MATLAB 7.3"]
fn shared_data_mutated_files_are_read_or_refused() {
    let mut all = shared_seeds("mat73_conformance", 4000);
    all.retain(|b| b.starts_with(b"MATLAB"));
    survive_within(&all, open, mutate, [1200, 8 << 20]);
}

#[test]
fn valid_filters_of_plugins_are_undone_and_others_are_refused_by_name() {
    let s = open(&own("packed_by_plugins.h5")).unwrap();
    assert_eq!(s.datasets().len(), 6);
    for (number, info) in s.datasets().iter().enumerate() {
        let x = real(&*s, number, "x");
        assert_eq!(x.len(), 50, "{}", info.name);
        for (i, v) in x.iter().enumerate() {
            assert!((v - wave(i)).abs() < 1e-15, "{} at {i}", info.name);
        }
    }
    let s = open(&own("packed_by_zfp.h5")).unwrap();
    let x = s.datasets()[0].channel_index("x").unwrap();
    let error = s.read(0, &[x]).unwrap_err();
    assert!(error.found.contains("ZFP"), "{error}");
    assert!(error.remedy.contains("h5repack"), "{error}");
    // The array beside it is read all the same.
    assert_eq!(real(&*s, 0, "y").len(), 50);
}
