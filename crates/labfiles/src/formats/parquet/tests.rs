use super::*;
use crate::conformance::{own, real, wave};

#[test]
fn valid_wide_table_of_all_types() {
    let s = open(&own("wide.parquet")).unwrap();
    let info = &s.datasets()[0];
    assert_eq!(info.time_axis, Some(0));
    assert_eq!(info.channels[1].unit.as_deref(), Some("mm/s"));
    assert!((info.sample_rate_hz().unwrap() - 2000.0).abs() < 1e-6);
    assert!((real(&*s, 0, "x")[7] - wave(7)).abs() < 1e-15);
    for name in ["i8", "i16", "u16", "i32", "i64", "u64"] {
        assert_eq!(real(&*s, 0, name)[49], 49.0, "{name}");
    }
    assert_eq!(
        real(&*s, 0, "contact").iter().sum::<f64>(),
        (0..50).filter(|&i| wave(i) > 0.5).count() as f64
    );
    let gaps = real(&*s, 0, "gaps");
    assert!(gaps[3].is_nan() && gaps[4] == 4.0);
    let note = info.channel_index("note").unwrap();
    assert_eq!(
        s.read(0, &[note]).unwrap()[0],
        Samples::Text(vec!["fine".into(); 50])
    );
    let when = real(&*s, 0, "when");
    assert!((when[49] - 0.049).abs() < 1e-9);
    assert_eq!(s.notes(), [""; 0]);
}

#[test]
fn valid_times_of_twelve_bytes_and_numbers_of_two() {
    let s = open(&own("int96_and_half.parquet")).unwrap();
    let info = &s.datasets()[0];
    // Nanoseconds since 1970 as a floating-point number are good to 256.
    assert!((info.sample_rate_hz().unwrap() - 2000.0).abs() < 0.05);
    assert_eq!(s.notes(), [""; 0]);
    let x = real(&*s, 0, "x");
    assert!(x[3].is_nan());
    // Eleven bits of a number between 0.5 and 1.
    assert!((x[43] - wave(43)).abs() < 2.5e-4 && x[43] != wave(43));
    let when = real(&*s, 0, "when");
    assert!((when[49] - 0.0245).abs() < 3e-7);
}

#[test]
fn valid_every_compression_and_several_row_groups() {
    for codec in ["snappy", "gzip", "zstd", "lz4", "uncompressed"] {
        let s = open(&own(&format!("wide_{codec}.parquet"))).unwrap();
        let x = real(&*s, 0, "x");
        assert!(x.len() == 50 && (x[43] - wave(43)).abs() < 1e-15, "{codec}");
    }
}

#[test]
fn valid_long_tables_become_records() {
    let s = open(&own("long_by_record.parquet")).unwrap();
    let names: Vec<&str> = s.datasets().iter().map(|d| d.name.as_str()).collect();
    assert_eq!(names, ["run1", "run2", "run10"]);
    assert!((real(&*s, 2, "x")[9] - 10.0 * wave(9)).abs() < 1e-14);
    assert!((s.datasets()[1].sample_rate_hz().unwrap() - 2000.0).abs() < 1e-6);
    let s = open(&own("long_tidy.parquet")).unwrap();
    assert_eq!(s.datasets().len(), 2);
    assert!((real(&*s, 1, "vy")[9] + 2.0 * wave(9)).abs() < 1e-14);
    assert_eq!(s.datasets()[1].time_axis, Some(0));
    assert!((s.datasets()[1].sample_rate_hz().unwrap() - 2000.0).abs() < 1e-6);
}

#[test]
fn valid_files_cut_off_are_refused() {
    let bytes = std::fs::read(own("wide.parquet")).unwrap();
    let file = tempfile::NamedTempFile::new().unwrap();
    for keep in [4, 100, bytes.len() - 1] {
        std::fs::write(file.path(), &bytes[..keep]).unwrap();
        assert!(open(file.path()).is_err(), "{keep}");
    }
}
