use super::*;
use crate::conformance::shared_data;
use std::io::Write;

fn file(bytes: &[u8]) -> tempfile::NamedTempFile {
    let mut file = tempfile::Builder::new().suffix(".csv").tempfile().unwrap();
    file.write_all(bytes).unwrap();
    file
}

fn source(bytes: &[u8]) -> Box<dyn Source> {
    open(file(bytes).path()).unwrap()
}

fn real(source: &dyn Source, channel: usize) -> Vec<f64> {
    source
        .read(0, &[channel])
        .unwrap()
        .remove(0)
        .into_real()
        .unwrap()
}

#[test]
fn plain_table_with_units_in_the_header() {
    let s = source(b"time [s],velocity_x [mm/s],note\n0,1.5,a\n0.0005,,\"b, c\"\n0.001,2.5,\n");
    let info = &s.datasets()[0];
    assert_eq!(info.time_axis, Some(0));
    assert_eq!(info.channels[1].unit.as_deref(), Some("mm/s"));
    assert!((info.sample_rate_hz().unwrap() - 2000.0).abs() < 1e-9);
    let v = real(&*s, 1);
    assert_eq!((v[0], v[1].is_nan(), v[2]), (1.5, true, 2.5));
    assert_eq!(
        s.read(0, &[2]).unwrap()[0],
        Samples::Text(vec!["a".into(), "b, c".into(), String::new()])
    );
}

#[test]
fn commas_in_headings_do_not_shift_columns_and_decimal_commas_between_commas_are_refused() {
    let rows = "0.00,0.125,0.5\n0.05,0.130,0.4\n0.10,0.135,0.3\n";
    let heading = "Time (s), Run #1,Position, Ch P1 (m), Run #1,Position, Ch P2 (m), Run #1";
    let s = source(format!("{heading}\n{rows}").as_bytes());
    let set = &s.datasets()[0];
    assert_eq!(set.time_axis, Some(0));
    assert_eq!(real(&*s, 1), [0.125, 0.130, 0.135]);
    assert!(set.channels[1].name.contains("Ch P1"), "{set:?}");
    assert!(set.channels[2].name.contains("Ch P2"), "{set:?}");
    assert!((set.sample_rate_hz().unwrap() - 20.0).abs() < 1e-9);
    let decimal = |heading: &str| format!("{heading}\n0,00,0,125\n0,05,-0,130\n0,10,0,135\n");
    for heading in [
        "Time (s), Run #1,Position (m), Run #1",
        "Time (s),Position (m)",
    ] {
        let refused = open(file(decimal(heading).as_bytes()).path());
        let error = refused.err().expect("a refusal");
        assert!(error.found.contains("'0,00,0,125'"), "{error:?}");
    }
    // semicolons between the cells, commas in both
    let s = source(b"Time (s), Run #1;Position (m), Run #1\n0,00;0,125\n0,05;-0,130\n");
    assert_eq!(real(&*s, 1), [0.125, -0.130]);
}

/// The datasets with the samples of the first channel of each.
fn lists(source: &dyn Source) -> Vec<(&str, u64)> {
    let sets = source.datasets().iter();
    sets.map(|d| (d.name.as_str(), d.channels[0].samples))
        .collect()
}

#[test]
fn lists_of_times_called_after_throws_are_records() {
    let s = source(b"bounce no.,Throw 1 (ms),Throw 2 (ms)\n1,0.1,0.2\n2,500.0,510.0\n3,900.0,930.0\n4,1220.0,\n");
    assert_eq!(lists(&*s), [("Throw 1", 4), ("Throw 2", 3)]);
    for set in s.datasets() {
        assert_eq!(
            (set.channels.len(), set.channels[0].name.as_str()),
            (1, "time")
        );
        assert_eq!(set.channels[0].unit.as_deref(), Some("ms"));
    }
    let second = s.read(1, &[0]).unwrap().remove(0).into_real().unwrap();
    assert_eq!(second, [0.2, 510.0, 930.0]);
    // another quantity, and names that are not of runs
    for heading in ["no,Throw 1 (ms),height (m)", "no,Ball 1 (ms),Ball 2 (ms)"] {
        let text = format!("{heading}\n1,0.1,0.2\n2,500.0,510.0\n3,900.0,930.0\n");
        assert_eq!(source(text.as_bytes()).datasets().len(), 1, "{heading}");
    }
}

#[test]
fn lists_of_heights_are_records_where_the_columns_are_throws() {
    let rows = "100,101,99\n66,65,67\n43,42,44\n28,28,29\n";
    for heading in [
        "h1 (cm),h2 (cm),h3 (cm)",
        "Drop 1 height (cm),Drop 2 height (cm),Drop 3 height (cm)",
    ] {
        let s = source(format!("{heading}\n{rows}").as_bytes());
        let held = lists(&*s);
        assert_eq!(
            held.iter().map(|l| l.1).collect::<Vec<_>>(),
            [4, 4, 4],
            "{heading}"
        );
    }
    // the tops of one throw in each row
    let along = "h1 (cm),h2 (cm),h3 (cm)\n100,64,41\n90,58,37\n80,51,33\n70,45,29\n";
    assert_eq!(source(along.as_bytes()).datasets().len(), 1);
}

#[test]
fn lists_of_numbered_times_are_records_where_the_rows_are_none() {
    let s = source(b"Zeit 1 (s);Zeit 2 (s);Zeit 3 (s)\n0,30;0,41;0,52\n0,65;0,70;0,79\n0,94;0,95;1,02\n1,19;1,17;\n");
    assert_eq!(lists(&*s), [("Zeit 1", 4), ("Zeit 2", 4), ("Zeit 3", 3)]);
    let s = source(
        b"Zeit 1;Zeit 2;Zeit 3\n0,30;0,41;0,52\n0,65;0,70;0,79\n0,94;0,95;1,02\n1,19;1,17;\n",
    );
    assert_eq!(lists(&*s), [("Zeit 1", 4), ("Zeit 2", 4), ("Zeit 3", 3)]);
    let third = s.read(2, &[0]).unwrap().remove(0).into_real().unwrap();
    assert_eq!(third, [0.52, 0.79, 1.02]);
    // both edges of a contact, times and flights along the rows
    for rows in [
        "0.30,0.41\n0.65,0.70\n0.94,0.95\n",
        "0.30,0.65\n0.41,0.70\n0.29,0.60\n",
        "0.30,0.25\n0.32,0.27\n0.35,0.28\n",
    ] {
        let text = format!("t1 (s),t2 (s)\n{rows}");
        assert_eq!(source(text.as_bytes()).datasets().len(), 1, "{text}");
    }
}

#[test]
fn a_unit_after_a_comma_is_that_of_the_heading() {
    let s = source(b"\"Time, ms\",\"Displacement, in\",\"Sensor, 1\"\n0,1.5,1\n4,1.4,2\n8,1.2,3\n");
    let named: Vec<_> = s.datasets()[0]
        .channels
        .iter()
        .map(|c| (c.name.as_str(), c.unit.as_deref()))
        .collect();
    assert_eq!(
        named,
        [
            ("Time", Some("ms")),
            ("Displacement", Some("in")),
            ("Sensor, 1", None)
        ]
    );
}

#[test]
fn decimal_comma_with_units_in_a_second_line_and_a_mark() {
    let text = "\u{feff}# clearance_m: 0,001\nčas;rychlost\nms;mm/s\n0;1,25\n0,5;-2,5e1\n1;3\n";
    let s = source(text.as_bytes());
    let info = &s.datasets()[0];
    assert_eq!(info.channels[0].name, "čas");
    assert_eq!(info.channels[1].unit.as_deref(), Some("mm/s"));
    assert_eq!(info.attributes["clearance_m"], "0,001");
    assert!((info.sample_rate_hz().unwrap() - 2000.0).abs() < 1e-9);
    assert_eq!(real(&*s, 1), [1.25, -25.0, 3.0]);
}

#[test]
fn utf16_and_windows_line_ends() {
    let text = "t;x [µm]\r\n0;1\r\n1;2\r\n";
    let bytes: Vec<u8> = [0xFF, 0xFE]
        .into_iter()
        .chain(text.encode_utf16().flat_map(u16::to_le_bytes))
        .collect();
    let s = source(&bytes);
    assert_eq!(s.datasets()[0].channels[1].unit.as_deref(), Some("µm"));
    assert_eq!(real(&*s, 1), [1.0, 2.0]);
}

#[test]
fn points_in_time_become_seconds() {
    let s = source(
        b"when,x\n2024-05-01 23:59:59.5,1\n2024-05-02 00:00:00.0,2\n2024-05-02 00:00:00.5,3\n",
    );
    let info = &s.datasets()[0];
    assert_eq!(info.time_axis, Some(0));
    assert_eq!(
        info.channels[1].start_time.as_deref(),
        Some("2024-05-01T23:59:59.5")
    );
    assert_eq!(info.sample_rate_hz(), Some(2.0));
    assert_eq!(real(&*s, 0), [0.0, 0.5, 1.0]);
    let s = source(b"Time\tx\n23:59:59\t1\n00:00:00\t2\n00:00:01\t3\n");
    assert_eq!(real(&*s, 0), [0.0, 1.0, 2.0]);
    let s = source(b"Time [hh:mm:ss]\tx [mm]\n23:59:59\t1\n00:00:00\t2\n00:00:01\t3\n");
    let info = &s.datasets()[0];
    assert_eq!(
        (info.channels[0].unit.as_deref(), info.sample_rate_hz()),
        (Some("s"), Some(1.0))
    );
}

#[test]
fn table_without_header_and_with_stated_rate() {
    let s = source(b"# sample_rate_hz = 2000\n1.5 2\n2.5 3\n3.5 7\n");
    let info = &s.datasets()[0];
    assert_eq!(info.channels[1].name, "column_2");
    assert_eq!(real(&*s, 1), [2.0, 3.0, 7.0]);
    let s = source(b"# sample_rate_hz = 2000\n1\n3\n2\n");
    assert_eq!(s.datasets()[0].sample_rate_hz(), Some(2000.0));
}

#[test]
fn a_wrong_cell_is_named_and_located() {
    let s = source(b"t,x\n0,1\n1,2\n2,4..5\n3,4\n4,5\n5,6\n6,7\n");
    let error = s.read(0, &[1]).unwrap_err();
    assert_eq!(error.channel.as_deref(), Some("x"));
    assert_eq!(error.byte, Some(14));
    assert!(error.found.contains("4..5"), "{error}");
    let s = source(b"t,x\n0,1\n1,2\n2,4,9\n3,4\n4,5\n5,6\n6,7\n");
    assert!(
        s.read(0, &[0])
            .unwrap_err()
            .found
            .contains("further cell '9'")
    );
}

#[test]
fn rows_of_few_numbers_among_texts_are_rows() {
    let s = source(b"name,place,note,x\nalpha,left,\"a, b\",0\nbeta,right,fine,1\n,,,2\n,,,3\n");
    let info = &s.datasets()[0];
    let names: Vec<&str> = info.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["name", "place", "note", "x"]);
    assert_eq!(real(&*s, 3), [0.0, 1.0, 2.0, 3.0]);
    let s = source(b"name,place,note,x\nalpha,left,fine,0\n");
    assert_eq!(real(&*s, 3), [0.0]);
}

#[test]
fn files_that_are_no_table_are_refused() {
    for bytes in [
        &b""[..],
        b"hello world\n",
        b"# only a comment\n",
        b"\x00\x01\x02",
    ] {
        assert!(open(file(bytes).path()).is_err(), "{bytes:?}");
    }
    let wide = format!("{}\n", vec!["1"; 500].join(","));
    let short = format!("{}{}", wide.repeat(70), "1\n".repeat(50_000));
    assert!(open(file(short.as_bytes()).path()).is_err());
}

#[test]
fn blocks_join_without_a_seam() {
    let mut text = String::from("t,x,y\n");
    for i in 0..60_000 {
        text.push_str(&format!(
            "{:.4},{},{:.6}\n",
            f64::from(i) * 1e-4,
            i,
            f64::from(i) * 0.25
        ));
    }
    let s = source(text.as_bytes());
    let all = s.read(0, &[2, 1, 1]).unwrap();
    let y = all[0].clone().into_real().unwrap();
    assert_eq!(y.len(), 60_000);
    assert!(y.iter().enumerate().all(|(i, v)| *v == i as f64 * 0.25));
    assert_eq!(all[1], all[2]);
    assert!((s.datasets()[0].sample_rate_hz().unwrap() - 1e4).abs() < 1e-6);
}

/// Cells as tables have them, and the number that each holds.
const CELLS: [(&str, f64); 12] = [
    ("0.020142826306052714", 0.020142826306052714),
    ("-1.5", -1.5),
    ("+2", 2.0),
    ("", f64::NAN),
    (" 3.25", 3.25),
    ("4.5 ", 4.5),
    ("NaN", f64::NAN),
    ("-1.234567890123456789e-03", -0.001_234_567_890_123_456_8),
    ("123456789012", 123456789012.0),
    ("-inf", f64::NEG_INFINITY),
    ("0.000000000000000000001", 1e-21),
    // last, so that tables without quotes leave it out
    ("\"6.5\"", 6.5),
];

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(64))]

    #[test]
    fn prop_every_cell_is_read_alike_in_any_company(
        mut rows in proptest::collection::vec([0..CELLS.len(), 0..CELLS.len(), 0..CELLS.len()], 60..400),
        quotes: bool,
        separator in proptest::sample::select(vec![",", ";", "\t"]),
        end in proptest::sample::select(vec!["\n", "\r\n", "\n\n", "\n# remark, 1, 2\n", ",\n"]),
        wanted in proptest::sample::subsequence(vec![0usize, 1, 2, 3], 1..=4),
    ) {
        if !quotes {
            let others = CELLS.len() - 1;
            rows.iter_mut().flatten().for_each(|c| *c %= others);
        }
        let end = end.replace(",\n", &format!("{separator}\n"));
        let mut text = ["n", "x", "y", "z"].join(separator) + "\n";
        for (i, row) in rows.iter().enumerate() {
            let cells = row.map(|c| CELLS[c].0);
            text += &format!("1{i}{separator}{}{end}", cells.join(separator));
        }
        // the last line needs no end
        let s = source(text.trim_end_matches(['\n', '\r']).as_bytes());
        let read = s.read(0, &wanted).unwrap();
        for (column, samples) in wanted.iter().zip(read) {
            let values = samples.into_real().unwrap();
            proptest::prop_assert_eq!(values.len(), rows.len());
            for (i, value) in values.into_iter().enumerate() {
                let expected = match column {
                    0 => format!("1{i}").parse().unwrap(),
                    c => CELLS[rows[i][c - 1]].1,
                };
                proptest::prop_assert!(value.to_bits() == expected.to_bits() || value.is_nan() && expected.is_nan(), "row {i} column {column}: {value}");
            }
        }
    }
}

#[test]
#[ignore = "needs shared/data: records of carts and blade springs"]
fn shared_data_cart_and_blade_spring_records() {
    let dir = shared_data("");
    let s = open(&dir.join("pasco_cart_bouncing_on_stop/csv/cart_run07.csv")).unwrap();
    let info = &s.datasets()[0];
    assert_eq!(info.time_axis, Some(0));
    assert_eq!(info.channels.len(), 11);
    assert!((info.sample_rate_hz().unwrap() - 20.0).abs() < 1e-6);
    assert!(real(&*s, 1)[0].is_nan());
    let s = open(&dir.join("unb_cantilever_sdof/first_experiment/massa1/test1-1/tps.txt")).unwrap();
    let info = &s.datasets()[0];
    assert_eq!(info.time_axis, Some(0));
    assert_eq!(info.channels[2].name, "column_3");
    let rate = info.sample_rate_hz().unwrap();
    // 4107 steps in 2.48666 s.
    assert!((rate - 1651.613).abs() < 1e-3, "{rate}");
    assert_eq!(real(&*s, 3)[0], -0.190312);
}

#[test]
fn prop_mutated_tables_are_read_or_refused() {
    use crate::conformance::{mutate_text, survive};
    let seeds = [
        "time [s],velocity_x [mm/s],note\n0,1.5,a\n0.0005,,\"b, c\"\n0.001,2.5,\n",
        "# rate = 2000\nt;x;y\ns;mm;mm\n0;1,25;3\n0,5;-2,5e1;4\n1;3;5\n",
        "1.5 2\n2.5 3\n3.5 7\n4.5 8\n",
        "when\tx\n2024-05-01 23:59:59.5\t1\n2024-05-02 00:00:00.0\t2\n2024-05-02 00:00:00.5\t3\n",
    ];
    let seeds: Vec<Vec<u8>> = seeds.iter().map(|s| s.as_bytes().to_vec()).collect();
    survive(&seeds, open, mutate_text, 64);
}

#[test]
fn valid_a_unit_without_a_name_heads_the_time() {
    let s = source(b"in s,C1 in V\n0.0,9.5E-01\n4.0E-04,9.4E-01\n8.0E-04,9.3E-01\n");
    let info = &s.datasets()[0];
    assert_eq!(info.time_axis, Some(0));
    assert!((info.sample_rate_hz().unwrap() - 2500.0).abs() < 1e-6);
    let signal = &info.channels[1];
    assert_eq!(
        (signal.name.as_str(), signal.unit.as_deref()),
        ("C1", Some("V"))
    );
}

#[test]
fn valid_times_with_a_number_are_those_of_the_run_with_that_number() {
    let row = |k: u32| {
        let t = f64::from(k) * 0.02;
        let second = if k < 10 {
            format!("{t:.4},{:.4}", 0.8 - t)
        } else {
            ",".to_owned()
        };
        format!("{t:.4},{:.4},{second}\n", 0.9 - t)
    };
    let rows: String = (0..14).map(row).collect();
    let s = source(format!("t1,y1,t2,y2\n{rows}").as_bytes());
    let names: Vec<&str> = s.datasets().iter().map(|d| d.name.as_str()).collect();
    assert_eq!(names, ["1", "2"]);
    for (run, samples) in [(0, 14), (1, 10)] {
        let info = &s.datasets()[run];
        let names: Vec<&str> = info.channels.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["t", "y"]);
        assert_eq!(info.time_axis, Some(0));
        assert_eq!(info.channels[1].samples, samples);
        assert!((info.sample_rate_hz().unwrap() - 50.0).abs() < 1e-6);
    }
    // temperatures, which do not climb, and a table with one of them
    for text in [
        "t1,p1,t2,p2\n20,1,21,2\n19,2,20,3\n20,1,21,2\n",
        "t1,y1\n0,1\n1,2\n2,1\n",
    ] {
        let s = source(text.as_bytes());
        assert_eq!(s.datasets()[0].time_axis, None, "{text}");
    }
}

#[test]
fn valid_a_time_that_states_its_unit_wins_over_stamps_that_do_not() {
    let row = |k: u32| {
        let ms = f64::from(k) * 10.0;
        let stamp = 1_701_234_567_890_000_000u64 + u64::from(k) * 10_000_000;
        format!("{stamp},{:.4},{:.3}\n", 1e-3 * ms, (0.3 * ms).cos())
    };
    let rows: String = (0..20).map(row).collect();
    for (heading, axis) in [("time,seconds_elapsed,z", 1), ("time,level,z", 0)] {
        let s = source(format!("{heading}\n{rows}").as_bytes());
        let info = &s.datasets()[0];
        assert_eq!(info.time_axis, Some(axis), "{heading}");
        let rate = info.sample_rate_hz().unwrap();
        assert!((rate - 100.0).abs() < 0.01, "{heading}: {rate}");
    }
}

#[test]
fn headings_of_loggers_oscilloscopes_and_cameras_are_read() {
    // the lines of a data logger: names, units, and how each value was formed
    let logger = source(
        b"\"TOA5\",\"CR1000X\",\"CR1000X\",\"12345\",\"CR1000X.Std.05\",\"CPU:a.CR1X\",\"1234\",\"Table1\"\n\
          \"TIMESTAMP\",\"RECORD\",\"Disp\",\"Batt\"\n\"TS\",\"RN\",\"mm\",\"V\"\n\"\",\"\",\"Smp\",\"Smp\"\n\
          \"2025-11-27 10:59:57\",0,1.25,12.6\n\"2025-11-27 10:59:57.01\",1,1.5,12.6\n\
          \"2025-11-27 10:59:57.02\",2,1.25,12.6\n",
    );
    let set = &logger.datasets()[0];
    assert_eq!(set.time_axis, Some(0));
    assert_eq!(
        (
            set.channels[2].name.as_str(),
            set.channels[2].unit.as_deref()
        ),
        ("Disp", Some("mm"))
    );
    assert!((set.sample_rate_hz().unwrap() - 100.0).abs() < 1e-6);
    // one column below keys, the step among them
    let scope = source(
        b"Revision:,1\nType:,normal\nPoints:,4\nXInc:,+1.00000000E-003\nXOrg:,0\nData:,\n1.5E+00\n2.5E+00\n\
          -1.5E+00\n0.0E+00\n",
    );
    let set = &scope.datasets()[0];
    assert_eq!((set.channels.len(), set.channels[0].samples), (1, 4));
    assert!((set.sample_rate_hz().unwrap() - 1000.0).abs() < 1e-6);
    // trajectories below their rate
    let camera = source(
        b"Trajectories\n100\n,,A:top,,\nFrame,Sub Frame,X,Y,Z\n,,mm,mm,mm\n1,0,20.5,100.1,1000.2\n\
          2,0,19.5,100.1,1000.1\n3,0,18.5,100.2,1000.0\n",
    );
    let set = &camera.datasets()[0];
    let names: Vec<&str> = set.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["Frame", "Sub Frame", "X", "Y", "Z"]);
    assert!((set.sample_rate_hz().unwrap() - 100.0).abs() < 1e-6);
}

/// Rows of two channels with times of their own, the first of 200 Hz and 60 samples, the second of 100 Hz and 40.
fn unlike_rates(separator: &str, between: &str) -> String {
    let row = |k: u32| {
        let k = f64::from(k);
        let second = if k < 40.0 {
            format!("{:.3}{separator}{:.4}", k * 0.01, (k * 0.4).cos())
        } else {
            separator.to_owned()
        };
        let x = (k * 0.2).cos();
        format!("{:.3}{separator}{x:.4}{between}{second}\n", k * 0.005)
    };
    (0..60).map(row).collect()
}

#[test]
fn valid_each_channel_has_the_time_before_it_however_both_are_called() {
    for (heading, second) in [
        ("t1 (s),vel (m/s),t2 (s),pos (m)", "t2"),
        ("X_Value,CH1 (V),X_Value,CH2 (V)", "X_Value 2"),
        ("x [s],vel [m/s],x [s],pos [m]", "x 2"),
        ("fast [s],vel [m/s],slow [s],pos [m]", "slow"),
        ("X (ms),vel,X (ms),pos", "X 2"),
    ] {
        let s = source(format!("{heading}\n{}", unlike_rates(",", ",")).as_bytes());
        let info = &s.datasets()[0];
        assert_eq!(s.datasets().len(), 1, "{heading}");
        assert_eq!(info.time_axis, Some(0), "{heading}");
        assert_eq!(info.channels[2].name, second);
        let clocks: Vec<Clock> = info.channels.iter().map(|c| c.clock).collect();
        assert_eq!(clocks[1], Clock::Shared, "{heading}");
        assert_eq!(clocks[3], Clock::Axis(2), "{heading}");
    }
    let text = format!(
        "X [s];vel [m/s];;X [s];pos [m]\n{}",
        unlike_rates(";", ";;")
    );
    let s = source(text.as_bytes());
    assert_eq!(s.datasets()[0].channels[4].clock, Clock::Axis(3));
    // a signal in s that does not climb evenly, and one before the channels
    let rows = |k: u32| format!("{:.2},{},{},{}\n", 0.01 * f64::from(k), k % 7, k * k, k % 5);
    let rows: String = (0..60).map(rows).collect();
    let s = source(format!("t (s),x (m),period (s),y (m)\n{rows}").as_bytes());
    assert!(
        s.datasets()[0]
            .channels
            .iter()
            .all(|c| c.clock == Clock::Shared)
    );
}

#[test]
fn valid_times_before_all_channels_are_theirs_by_name_or_are_noted() {
    let row = |k: u32| {
        let k = f64::from(k);
        format!(
            "{:.3},{:.2},{:.3},{:.3}\n",
            k * 0.005,
            k * 0.01,
            k.cos(),
            k.sin()
        )
    };
    let rows: String = (0..60).map(row).collect();
    let s = source(format!("t_vel (s),t_pos (s),vel (m/s),pos (m)\n{rows}").as_bytes());
    let clocks: Vec<Clock> = s.datasets()[0].channels.iter().map(|c| c.clock).collect();
    assert_eq!(clocks[2..], [Clock::Shared, Clock::Axis(1)]);
    assert!(s.notes().is_empty(), "{:?}", s.notes());
    let s = source(format!("t1 (s),t2 (s),vel (m/s),pos (m)\n{rows}").as_bytes());
    assert_eq!(
        s.notes(),
        [
            "'t1' is taken as the time of all columns, and 't2' goes by other steps: where it is the time of some, put it \
          before them, or name it after them, as 't_x' for 'x'"
        ]
    );
}

#[test]
fn valid_a_date_and_a_time_of_day_go_on_past_midnight() {
    let row = |k: u32| {
        let (day, time) = match k {
            0..=99 => (12, format!("23:59:59,{k:02}")),
            k => (13, format!("00:00:00,{:02}", k - 100)),
        };
        format!("{day}.05.2024;{time};{},5\n", k % 9)
    };
    let rows: String = (0..200).map(row).collect();
    let s = source(format!("Datum;Zeit;x [mm]\n{rows}").as_bytes());
    let info = &s.datasets()[0];
    assert_eq!(info.time_axis, Some(1));
    assert!((info.sample_rate_hz().unwrap() - 100.0).abs() < 1e-3);
    let start = info.channels[2].start_time.as_deref();
    assert_eq!(start, Some("2024-05-12T23:59:59"));
    let times = real(&*s, 1);
    assert!((times[199] - 1.99).abs() < 1e-9, "{}", times[199]);
}

#[test]
fn valid_parts_of_a_second_beside_a_clock_are_added_to_it() {
    for (heading, count, step, to_s) in [("ms", 300u32, 10u32, 1e-3), ("us", 12_000, 400, 1e-6)] {
        let per_second = if step == 10 { 100 } else { 2500 };
        let row = |k: u32| {
            let k = k + 7;
            let (second, part) = (11 + k / per_second, k % per_second * step);
            format!(
                "\"{k}\",\"2024/05/12 14:03:{second}\",\"{part}\",\"+{}.5\"\n",
                k % 5
            )
        };
        let rows: String = (0..count).map(row).collect();
        let text = format!(
            "\"Vendor\",\"a maker\"\n\"Sampling interval\",\"1s\"\n\"Number\",\"Date&Time\",\"{heading}\",\"CH1\"\n\
             \"NO.\",\"Time\",\"{heading}\",\"V\"\n{rows}"
        );
        let s = source(text.as_bytes());
        let info = &s.datasets()[0];
        assert_eq!(info.time_axis, Some(1));
        let rate = f64::from(step) * to_s;
        assert!((info.sample_rate_hz().unwrap() * rate - 1.0).abs() < 1e-6);
        let times = s.read(0, &[3, 1, 2]).unwrap()[1]
            .clone()
            .into_real()
            .unwrap();
        let even = |(k, t): (usize, &f64)| (t - k as f64 * rate).abs() < 1e-9;
        assert!(times.iter().enumerate().all(even));
        assert_eq!(real(&*s, 2)[0], f64::from(7 * step));
    }
    // milliseconds since the start of a short record are no parts of a second
    let row = |k: u32| format!("12:00:0{},{},{}\n", (k + 50) / 100, 10 * k, k % 3);
    let rows: String = (0..90).map(row).collect();
    let s = source(format!("clock,ms,x\n{rows}").as_bytes());
    assert_eq!(real(&*s, 0)[89], 1.0);
}

#[test]
fn valid_decimal_commas_in_quotes_are_read_between_commas() {
    let row = |k: u32| format!("\"0,{k:02}\",\"-1,5\",{k},7\n");
    let rows: String = (0..40).map(row).collect();
    let s = source(format!("\"Zeit in s\",\"Weg in mm\",n,k\n{rows}").as_bytes());
    let info = &s.datasets()[0];
    assert_eq!(info.channels.len(), 4);
    assert!((info.sample_rate_hz().unwrap() - 100.0).abs() < 1e-6);
    let read = s.read(0, &[1, 2, 3]).unwrap();
    assert_eq!(read[0], crate::Samples::Real(vec![-1.5; 40]));
    assert_eq!(read[2], crate::Samples::Real(vec![7.0; 40]));
    // groups of three digits may be thousands: no decimals are seen in them
    let rows: String = (0..40)
        .map(|k| format!("{k},\"1,{:03}\"\n", 200 + k))
        .collect();
    let s = source(format!("n,x\n{rows}").as_bytes());
    assert_eq!(s.datasets()[0].channels[1].stored, crate::StoredType::Text);
}

#[test]
fn valid_traces_of_yokogawa_have_their_names_with_and_without_a_comma_before_the_rows() {
    for (comma, traces) in [(",", 1), (",", 2), ("", 1), ("", 2), ("", 3)] {
        let each = |of: &dyn Fn(usize) -> String| (0..traces).map(of).collect::<Vec<_>>().join(",");
        let row = |k: usize| format!("{comma}{}\n", each(&|i| format!("{}.5E-01", k % 7 + i)));
        let rows: String = (0..60).map(row).collect();
        let text = format!(
            "\"Header Size\",16\n\"Model Name\",\"DL850\"\n\"BlockNumber\",1\n\"TraceName\",{}\n\"BlockSize\",{}\n\
             \"VUnit\",{}\n\"SampleRate\",{}\n\"HUnit\",{}\n\"Date\",\"2024/05/12\"\n\"Time\",\"14:03:11\"\n{rows}",
            each(&|i| format!("\"CH{}\"", i + 1)),
            each(&|_| "60".to_owned()),
            each(&|_| "\"V\"".to_owned()),
            each(&|_| "2.5E+03".to_owned()),
            each(&|_| "\"s\"".to_owned()),
        );
        let s = source(text.as_bytes());
        let info = &s.datasets()[0];
        let names: Vec<&str> = info.channels.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["CH1", "CH2", "CH3"][..traces], "{comma}{traces}");
        assert!(info.channels.iter().all(|c| c.unit.as_deref() == Some("V")));
        assert!(info.channels.iter().all(|c| c.samples == 60));
        assert!((info.sample_rate_hz().unwrap() - 2500.0).abs() < 1e-6);
        assert_eq!(info.attributes["Model Name"], "DL850");
        assert_eq!(real(&*s, traces - 1)[1], [0.15, 0.25, 0.35][traces - 1]);
    }
}

#[test]
fn valid_clocks_of_minutes_turn_at_the_hour_and_durations_have_their_unit_behind() {
    let row = |k: u32| {
        let ms = 3_599_500 + 10 * k;
        let (minutes, seconds) = (ms / 60_000 % 60, f64::from(ms % 60_000) * 1e-3);
        format!("{minutes:02}:{seconds:06.3},{}\n", k % 5)
    };
    let rows: String = (0..150).map(row).collect();
    let s = source(format!("Time,a [m/s^2]\n{rows}").as_bytes());
    assert_eq!(s.datasets()[0].time_axis, Some(0));
    assert!((real(&*s, 0)[149] - 1.49).abs() < 1e-9);
    let row = |k: u32| format!("{} sec,-{}.5\n", f64::from(k) / 1200.0, k % 5);
    let rows: String = (0..90).map(row).collect();
    let s = source(format!("Time,drive_N\n{rows}").as_bytes());
    let info = &s.datasets()[0];
    assert_eq!(info.time_axis, Some(0));
    assert!((info.sample_rate_hz().unwrap() - 1200.0).abs() < 1e-3);
    assert_eq!(info.channels[1].start_time, None);
}

#[test]
fn whole_steps_of_many_seconds_are_noted() {
    let table = |heading: &str, step: u32| {
        let rows: String = (0..200)
            .map(|k| format!("{},{}.5\n", step * k, k % 5))
            .collect();
        source(format!("{heading},x (mm)\n{rows}").as_bytes())
    };
    assert_eq!(
        table("Time (s)", 10).notes(),
        ["time axis 'Time' is stated in s and goes by steps of 10: check that it is not in ms"]
    );
    for (heading, step) in [("Time (s)", 1), ("Time (ms)", 10)] {
        assert!(table(heading, step).notes().is_empty(), "{heading}");
    }
}

#[test]
fn a_file_that_is_not_there_asks_for_its_path() {
    let error = crate::open(std::path::Path::new("nope.csv")).err().unwrap();
    assert_eq!(error.remedy, "check the path and its spelling");
}

#[test]
fn numbers_in_a_preamble_are_no_row_and_no_name() {
    let rows = "0.00\t0.1\n0.01\t0.2\n0.02\t0.3\n0.03\t0.4\n0.04\t0.5\n0.05\t0.6\n";
    for preamble in ["5000\n", "Samples\t5000\n5000\n", "; Channels\n\t1\t2\n"] {
        let s = source(format!("{preamble}Time (s)\tPosition (m)\n{rows}").as_bytes());
        let set = &s.datasets()[0];
        let names: Vec<&str> = set.channels.iter().map(|c| c.name.as_str()).collect();
        assert_eq!(names, ["Time", "Position"], "{preamble}");
        assert_eq!(real(&*s, 1).len(), 6, "{preamble}");
    }
}

#[test]
fn headings_that_come_again_are_left_out_with_a_note() {
    let part = "t [s],x [mm]\n0.0,1\n0.1,2\n0.2,3\n";
    let again = "t [s],x [mm]\r\n0.3,4\n0.4,5\nt [s],x [mm]\n0.5,6\n";
    let s = source(format!("{part}{again}").as_bytes());
    assert_eq!(real(&*s, 1), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert!(
        s.notes().iter().any(|n| n.starts_with("2 lines")),
        "{:?}",
        s.notes()
    );
}

#[test]
fn rows_that_sum_a_table_up_are_left_out_with_a_note() {
    let s = source(b"Trial,h0 (cm),h1 (cm)\n1,100,61\n2,100,60\nAverage,100,60.5\nSD,0,0.7\n");
    assert_eq!(real(&*s, 2), [61.0, 60.0]);
    assert!(s.notes()[0].contains("Average, SD"), "{:?}", s.notes());
}

#[test]
fn overloads_are_gaps_where_most_rows_at_the_front_have_them() {
    let mut text = String::from("Time (s),Position (m)\n");
    for i in 0..200 {
        let cell = if i < 50 {
            "OVLD".to_owned()
        } else {
            format!("{}", i % 7)
        };
        text += &format!("{:.2},{cell}\n", f64::from(i) * 0.01);
    }
    let s = source(text.as_bytes());
    assert_eq!(s.datasets()[0].channels[1].stored, StoredType::Float(64));
    assert_eq!(real(&*s, 1).iter().filter(|v| v.is_nan()).count(), 50);
}

#[test]
fn a_step_of_time_in_cells_above_one_column_is_the_rate() {
    let rate = |text: &str| source(text.as_bytes()).datasets()[0].sample_rate_hz();
    let german =
        "Ger\u{e4}t;Logger 7\r\nAbtastintervall;0,5;ms\r\nWeg (mm)\r\n1,5\r\n2,5\r\n3,5\r\n";
    assert!(rate(german).is_some_and(|r| (r - 2000.0).abs() < 1e-6));
    let english = "Sampling interval,0.5,ms\nPosition (mm)\n1.5\n2.5\n3.5\n";
    assert!(rate(english).is_some_and(|r| (r - 2000.0).abs() < 1e-6));
}

#[test]
fn hours_minutes_and_seconds_in_columns_are_one_time() {
    // from 9:59:59 on, a tenth of a second each
    let row = |i: i32| {
        let tenths = 359_990 + i;
        let seconds = f64::from(tenths % 600) / 10.0;
        format!(
            "{},{},{seconds:.1},{i}\n",
            tenths / 36_000,
            tenths / 600 % 60
        )
    };
    let rows: String = (0..20).map(row).collect();
    let s = source(format!("Hour,Minute,Second,x (mm)\n{rows}").as_bytes());
    let set = &s.datasets()[0];
    assert_eq!((set.time_axis, set.channels.len()), (Some(0), 2));
    let times = real(&*s, 0);
    assert!((times[19] - 1.9).abs() < 1e-9, "{times:?}");
}
