//! Files as oscilloscopes, loggers and camera systems write them, made here after their descriptions: names,
//! units, rate, times and start of each channel.
#![allow(clippy::unwrap_used, clippy::panic, reason = "these are tests")]

use std::io::Write;

use labfiles::{Clock, DatasetInfo, ReadError, Samples, Source, open};

fn opened(name: &str, text: &str) -> Result<Box<dyn Source>, ReadError> {
    let suffix = name.rsplit_once('.').map_or("", |(_, ending)| ending);
    let mut file = tempfile::Builder::new()
        .suffix(&format!(".{suffix}"))
        .tempfile()
        .unwrap();
    file.write_all(text.as_bytes()).unwrap();
    open(file.path())
}

#[track_caller]
fn read(name: &str, text: &str) -> Box<dyn Source> {
    opened(name, text).unwrap_or_else(|error| panic!("{error}"))
}

fn real(source: &dyn Source, dataset: usize, channel: usize) -> Vec<f64> {
    let samples: Samples = source.read(dataset, &[channel]).unwrap().remove(0);
    samples.into_real().unwrap()
}

fn named(record: &DatasetInfo) -> Vec<(&str, Option<&str>)> {
    record
        .channels
        .iter()
        .map(|c| (c.name.as_str(), c.unit.as_deref()))
        .collect()
}

#[track_caller]
fn check_rate(record: &DatasetInfo, rate_hz: f64) {
    let found = record.sample_rate_hz().unwrap();
    assert!((found / rate_hz - 1.0).abs() < 1e-6, "{found}");
}

/// `count` rows of a time in steps and values, by a format.
fn rows(count: u32, row: impl Fn(u32) -> String) -> String {
    (0..count).map(|i| row(i) + "\n").collect()
}

#[test]
fn rigol_states_start_and_increment_in_its_headings() {
    let sequence = rows(40, |i| format!("{i},{:.2e},", f64::from(i) * 0.01 - 0.2));
    let text =
        format!("X,CH1,Start,Increment,\nSequence,Volt,-1.000000e-01,4.000000e-04\n{sequence}");
    let source = read("a.csv", &text);
    let record = &source.datasets()[0];
    assert_eq!(named(record), [("X", None), ("CH1", Some("Volt"))]);
    assert_eq!(record.time_axis, None);
    check_rate(record, 2500.0);
    assert_eq!(record.channels[1].samples, 40);
    assert_eq!(real(&*source, 0, 1)[1], -0.19);

    let two = rows(40, |i| {
        format!("{i},{:.2e},{:.2e},", f64::from(i) * 0.01, 0.5)
    });
    let text = format!("X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,0.0e+00,1.0e-03\n{two}");
    let source = read("a.csv", &text);
    assert_eq!(
        named(&source.datasets()[0])[1..],
        [("CH1", Some("Volt")), ("CH2", Some("Volt"))]
    );
    check_rate(&source.datasets()[0], 1000.0);

    let plain = rows(40, |i| {
        format!(
            "{:.6e},{:.2e},,",
            f64::from(i) * 1e-3 - 0.1,
            0.5 * f64::from(i)
        )
    });
    let text = format!("Time(s),CH1(V),,t0 =-1.000000e-01, tInc = 1.000000e-03,\n{plain}");
    let source = read("a.csv", &text);
    assert_eq!(
        named(&source.datasets()[0]),
        [("Time", Some("s")), ("CH1", Some("V"))]
    );
    check_rate(&source.datasets()[0], 1000.0);
}

#[test]
fn keysight_heads_columns_by_their_numbers() {
    for (heading, units, count) in [
        ("x-axis,1", "second,Volt", 1),
        ("x-axis,1,2", "second,Volt,Volt", 2),
    ] {
        let row = |i: u32| {
            format!(
                "{:.5E}{}",
                f64::from(i) * 5e-4 - 0.01,
                ",+1.5E-01".repeat(count)
            )
        };
        let source = read("a.csv", &format!("{heading}\n{units}\n{}", rows(40, row)));
        let record = &source.datasets()[0];
        assert_eq!(record.channels.len(), 1 + count);
        assert_eq!(record.time_axis, Some(0));
        assert_eq!(
            (record.channels[1].name.as_str(), record.channels[1].samples),
            ("1", 40)
        );
        check_rate(record, 2000.0);
        assert_eq!(real(&*source, 0, 1)[0], 0.15);
    }
}

#[test]
fn siglent_and_tektronix_begin_with_a_preamble() {
    let data = rows(60, |i| format!("{:.8}, {:.5}", f64::from(i) * 5e-4, 0.25));
    let siglent = format!(
        "Record Length,Analog:60\nSample Interval,Analog:5.00E-04\nVertical Units,CH1:V\nHorizontal Units,s\n\
         Model Number,SDS0000\nSource,CH1\nSecond,Volt\n{data}"
    );
    let source = read("a.csv", &siglent);
    let record = &source.datasets()[0];
    assert_eq!(
        (record.time_axis, record.channels[1].name.as_str()),
        (Some(0), "CH1")
    );
    check_rate(record, 2000.0);
    let tektronix = format!(
        "Model,MSO0000\nFirmware Version,1.0\n\nWaveform Type,ANALOG\nHorizontal Units,s\nSample Interval,5e-4\n\
         Record Length,60\nLabel,CH1\nTIME,CH1\n{data}"
    );
    let source = read("a.csv", &tektronix);
    assert_eq!(named(&source.datasets()[0])[1].0, "CH1");
    check_rate(&source.datasets()[0], 2000.0);
}

#[test]
fn valid_a_line_of_a_preamble_is_no_heading() {
    let data = rows(60, |i| format!("{:.8},{:.5}", f64::from(i) * 4e-4, 0.25));
    let siglent = format!(
        "Record Length,Analog:60\nSample Interval,Analog:4.00E-04\nVertical Units,CH1:V,,\nHorizontal Units,s,\n\
         Serial Number,SDS0000,\nSoftware Version,7.1,\nSecond,Volt\n{data}"
    );
    let source = read("a.csv", &siglent);
    let record = &source.datasets()[0];
    assert_eq!(
        named(record),
        [("Second", Some("Second")), ("CH1", Some("Volt"))]
    );
    assert_eq!(record.attributes["Software Version"], "7.1");
    assert_eq!(record.time_axis, Some(0));
    check_rate(record, 2500.0);
    let data = rows(60, |i| format!("{:.5E}", f64::from(i) * 0.01));
    let yokogawa = format!(
        "//YOKOGAWA ASCII FILE FORMAT\nHeader Size,16\n\"Model Name\",\"DL0\"\n\"BlockNumber\",1\n\
         \"TraceName\",\"CH1\"\n\"BlockSize\",60\n\"VUnit\",\"V\"\n\"SampleRate\",2.500000E+03\n\
         \"HResolution\",4.000000E-04\n\"HUnit\",\"s\"\n\"Date\",\"2024/05/02\"\n\
         \"Time\",\"10:11:12\"\n\n{data}"
    );
    let source = read("s.csv", &yokogawa);
    let record = &source.datasets()[0];
    assert_eq!(named(record), [("CH1", Some("V"))]);
    check_rate(record, 2500.0);
    assert_eq!(real(&*source, 0, 0)[..2], [0.0, 0.01]);
    assert_eq!(record.channels[0].samples, 60);
}

#[test]
fn valid_a_preamble_whose_lines_end_with_commas() {
    let data = rows(60, |i| format!("{:.5E},", f64::from(i) * 0.01));
    let instek = format!(
        "Format,2.0B,\nMemory Length,60,\nSource,CH1,\nVertical Units,V,\nLabel,,\nProbe,1.000e+00,\n\
         Horizontal Units,S,\nSampling Period,4.000e-04,\nFirmware,V1.15,\nMode,Fast,\nWaveform Data,\n{data}"
    );
    let source = read("a.csv", &instek);
    let record = &source.datasets()[0];
    assert_eq!(named(record), [("CH1", Some("V"))]);
    check_rate(record, 2500.0);
    assert_eq!(real(&*source, 0, 0)[..2], [0.0, 0.01]);
    let data = rows(60, |i| format!(",{:.5E},{:.5E},", f64::from(i) * 0.01, 1.0));
    let yokogawa = format!(
        "//YOKOGAWA ASCII FILE FORMAT\n\"Header Size\",16\n\"Model Name\",\"DL0\"\n\"TraceName\",\"CH1\",\"CH2\"\n\
         \"BlockSize\",60,60\n\"VUnit\",\"V\",\"V\"\n\"SampleRate\",2.5E+03,2.5E+03\n\"HUnit\",\"s\",\"s\"\n\n{data}"
    );
    let source = read("a.csv", &yokogawa);
    let record = &source.datasets()[0];
    let held = named(record);
    assert_eq!(
        held[held.len() - 2..],
        [("CH1", Some("V")), ("CH2", Some("V"))]
    );
    check_rate(record, 2500.0);
    assert_eq!(record.channels[held.len() - 1].samples, 60);
}

#[test]
fn valid_a_time_without_a_name_beside_the_numbers_of_the_rows() {
    let data = rows(60, |i| {
        format!("{}\t{:.6e}\t{:.6e}", i + 1, f64::from(i) * 4e-4, 0.25)
    });
    let pulse = format!("Title 1:\tTime(Input)\nX-axis size:\t60\nY-axis unit:\tm/s²\n\n{data}");
    let source = read("a.txt", &pulse);
    let record = &source.datasets()[0];
    assert_eq!(record.time_axis, Some(1));
    check_rate(record, 2500.0);
}

#[test]
fn remarks_beside_a_table_are_no_channels() {
    let remarks = [
        "Record Length,2.5e+03",
        "Sample Interval,4.0e-04",
        "Trigger Point,2.5e+02",
        ",",
        "Source,CH1",
        "Vertical Units,V",
        "Horizontal Units,s",
    ];
    let row = |i: u32| {
        let beside = remarks.get(i as usize).copied().unwrap_or(",");
        format!("{beside},,{:+.12},  {:.5},", f64::from(i) * 4e-4 - 0.1, 0.5)
    };
    let source = read("F0000CH1.CSV", &rows(60, row));
    let record = &source.datasets()[0];
    assert_eq!(named(record), [("Time", Some("s")), ("CH1", Some("V"))]);
    assert_eq!(record.time_axis, Some(0));
    check_rate(record, 2500.0);
    assert_eq!(record.attributes["Trigger Point"], "2.5e+02");
    assert_eq!(real(&*source, 0, 1), vec![0.5; 60]);
}

#[test]
fn valid_tables_beside_their_remarks_are_a_channel_each() {
    let remarks = [
        "Record Length",
        "Sample Interval",
        "Source",
        "Vertical Units",
    ];
    let beside = |i: u32, channel: &str| {
        let values = ["60", "4e-4", channel, "V"];
        match remarks.get(i as usize) {
            Some(key) => format!("{key},{}", values[i as usize]),
            None => ",".to_owned(),
        }
    };
    for (late, clock) in [(0.0, Clock::Shared), (1e-3, Clock::Axis(2))] {
        let row = |i: u32| {
            let (t, value) = (f64::from(i) * 4e-4, f64::from(i));
            format!(
                "{},,{t:.9},{value:.5},,{},,{:.9},{:.5},",
                beside(i, "CH1"),
                beside(i, "CH2"),
                t + late,
                -value
            )
        };
        let source = read("T.CSV", &rows(60, row));
        let record = &source.datasets()[0];
        assert_eq!(source.datasets().len(), 1);
        let place = |name: &str| record.channel_index(name).unwrap();
        assert_eq!(record.time_axis, Some(place("Time")));
        assert_eq!(record.channels.len(), if late > 0.0 { 4 } else { 3 });
        check_rate(record, 2500.0);
        for (name, sign) in [("CH1", 1.0), ("CH2", -1.0)] {
            let channel = place(name);
            assert_eq!(record.channels[channel].unit.as_deref(), Some("V"));
            assert_eq!(real(&*source, 0, channel)[7], 7.0 * sign, "{name}");
        }
        assert_eq!(record.channels[place("CH2")].clock, clock);
        assert_eq!(record.attributes["Source"], "CH1");
    }
}

#[test]
fn vernier_has_names_short_names_and_units() {
    let data = rows(40, |i| format!("{:.5}\t{:.6}\t", f64::from(i) * 4e-4, 0.5));
    let text = format!(
        "Vernier Format 2\nlab.cmbl 1/1/2020 10:00:00 .\nRun 1\nTime\tVelocity\nt\tv\ns\tm/s\n\n{data}"
    );
    let source = read("lab.txt", &text);
    assert_eq!(
        named(&source.datasets()[0]),
        [("Time", Some("s")), ("Velocity", Some("m/s"))]
    );
    check_rate(&source.datasets()[0], 2500.0);
}

#[test]
fn motion_capture_states_its_rate_as_frequency() {
    let data = rows(40, |i| format!("{}.5\t80.1\t401.2\t", 500 + i));
    let text = format!(
        "NO_OF_FRAMES\t40\nNO_OF_CAMERAS\t2\nNO_OF_MARKERS\t1\nFREQUENCY\t500\nNO_OF_ANALOG\t0\n\
         DATA_INCLUDED\t3D\nMARKER_NAMES\ta\na X\ta Y\ta Z\t\n{data}"
    );
    let source = read("m.tsv", &text);
    let record = &source.datasets()[0];
    assert_eq!(
        named(record),
        [
            ("a X", Some("mm")),
            ("a Y", Some("mm")),
            ("a Z", Some("mm"))
        ]
    );
    check_rate(record, 500.0);
}

#[test]
fn runs_side_by_side_are_records_of_their_own_length_and_rate() {
    let row = |i: u32| {
        let short = if i < 30 {
            format!("{:.3},{:.2}", f64::from(i) * 0.01, 7.0)
        } else {
            ",".to_owned()
        };
        format!("{:.3},{:.2},{short}", f64::from(i) * 0.02, f64::from(i))
    };
    let runs = rows(50, row);
    for heading in [
        "Time (s) Run #1,Position (m) Run #1,Time (s) Run #2,Position (m) Run #2",
        "Run 1: Time (s),Run 1: Position (m),Run 2: Time (s),Run 2: Position (m)",
        "Time (s),Position (m),Time (s),Position (m)",
    ] {
        let source = read("runs.csv", &format!("{heading}\n{runs}"));
        let [first, second] = source.datasets() else {
            panic!("{heading}: {} datasets", source.datasets().len())
        };
        for record in [first, second] {
            assert_eq!(
                named(record),
                [("Time", Some("s")), ("Position", Some("m"))],
                "{heading}"
            );
            assert_eq!(record.time_axis, Some(0));
        }
        assert_ne!(first.name, second.name);
        assert_eq!(
            (first.channels[1].samples, second.channels[1].samples),
            (50, 30)
        );
        check_rate(first, 50.0);
        check_rate(second, 100.0);
        assert_eq!(real(&*source, 1, 1), vec![7.0; 30]);
    }
    let shared = rows(40, |i| {
        format!("{:.2};{};{}", f64::from(i) * 0.01, i, i + 1)
    });
    let source = read(
        "a.csv",
        &format!("t [s];y Throw 1 [m];y Throw 2 [m]\n{shared}"),
    );
    assert_eq!(source.datasets().len(), 2);
    assert_eq!(
        named(&source.datasets()[1]),
        [("t", Some("s")), ("y", Some("m"))]
    );
    assert_eq!(real(&*source, 1, 1)[0], 1.0);
}

#[test]
fn channels_with_times_of_their_own_are_one_record() {
    let row = |i: u32| {
        format!(
            "{:.4},0.1,{:.4},0.2",
            f64::from(i) * 1e-3,
            f64::from(i) * 1e-3 + 0.3
        )
    };
    let source = read(
        "a.csv",
        &format!("Time (s),CH1 (V),Time (s),CH2 (V)\n{}", rows(40, row)),
    );
    let [record] = source.datasets() else {
        panic!()
    };
    let clocks: Vec<Clock> = record.channels.iter().map(|c| c.clock).collect();
    assert_eq!(clocks[1..], [Clock::Shared, Clock::Shared, Clock::Axis(2)]);
}

#[test]
fn thousands_are_read_or_refused_by_cell() {
    let german = rows(40, |i| {
        format!("0,{i:03};{}", if i < 20 { "-2.387,95" } else { "884,45" })
    });
    let source = read("a.csv", &format!("Zeit in s;Spannung in mV\n{german}"));
    let values = real(&*source, 0, 1);
    assert_eq!((values[0], values[39]), (-2387.95, 884.45));
    let counts = rows(40, |i| {
        format!("0,{i:03};{}", if i < 20 { "2.388" } else { "884" })
    });
    let source = read("a.csv", &format!("Zeit in s;Spannung in mV\n{counts}"));
    let values = real(&*source, 0, 1);
    assert_eq!((values[0], values[39]), (2388.0, 884.0));
    let unsure = rows(40, |i| {
        format!("{i};{}", if i < 20 { "2.388" } else { "884" })
    });
    let error = opened("a.csv", &format!("n;U\n{unsure}")).err().unwrap();
    assert_eq!(error.channel.as_deref(), Some("U"));
    assert!(
        error.found.contains("'2.388' beside whole numbers"),
        "{error}"
    );
    let quoted = rows(40, |i| format!("{:.2},\"1,234.5\"", f64::from(i) * 0.01));
    let source = read("a.csv", &format!("t [s],x [mm]\n{quoted}"));
    assert_eq!(real(&*source, 0, 1)[0], 1234.5);
}

#[test]
fn line_ends_that_are_mixed_are_read_or_refused_by_row() {
    let mut text = String::from("t [s],x [mm],note\r");
    for i in 0..50 {
        let end = if i == 20 { "\r\n" } else { "\r" };
        text += &format!("{:.1},{i},test{end}", f64::from(i) * 0.1);
    }
    let source = read("a.csv", &text);
    let record = &source.datasets()[0];
    assert_eq!((record.channels.len(), record.channels[1].samples), (3, 50));
    assert_eq!(real(&*source, 0, 1)[49], 49.0);
    let notes = source.read(0, &[2]).unwrap().remove(0);
    assert_eq!(notes, Samples::Text(vec!["test".to_owned(); 50]));
    // twice translated line ends
    let source = read("a.csv", &text.replace("\r\n", "\r").replace('\r', "\r\r\n"));
    assert_eq!(source.datasets()[0].channels[1].samples, 50);
    // a carriage return alone far behind the front of the file
    let mut late = String::from("t [s],x [mm],note\n");
    for i in 0..20_000 {
        let end = if i == 19_000 { '\r' } else { '\n' };
        late += &format!("{:.1},{i},test{end}", f64::from(i) * 0.1);
    }
    let error = opened("a.csv", &late).err().unwrap();
    assert_eq!(
        error.found,
        "a carriage return without a line feed in row 19001"
    );
}

#[test]
fn time_without_a_unit_is_told_from_seconds_by_name_and_number() {
    let rate = |heading: &str, time: &dyn Fn(u32) -> String| {
        let source = read(
            "a.csv",
            &format!("{heading},x\n{}", rows(40, |i| format!("{},0.5", time(i)))),
        );
        let record = &source.datasets()[0];
        (
            record.time_axis,
            record.sample_rate_hz(),
            source.notes().to_vec(),
        )
    };
    let whole = |i: u32| (10 * i).to_string();
    for name in [
        "time_ms",
        "Time (ms)",
        "millis",
        "t_ms",
        "timeMs",
        "Zeit in ms",
        "ms",
    ] {
        assert_eq!(rate(name, &whole), (Some(0), Some(100.0), vec![]), "{name}");
    }
    for name in ["micros", "time_us", "Time (µs)"] {
        let found = rate(name, &whole).1.unwrap();
        assert!((found / 1e5 - 1.0).abs() < 1e-9, "{name}: {found}");
    }
    let (axis, hz, notes) = rate("timestamp", &|i| {
        (1_486_512_345_678_u64 + u64::from(10 * i)).to_string()
    });
    assert_eq!((axis, hz), (Some(0), Some(100.0)));
    assert_eq!(
        notes,
        ["time axis 'timestamp' has no unit: taken as ms since 1970"]
    );
    let (axis, hz, notes) = rate("time", &whole);
    assert_eq!((axis, hz), (Some(0), None));
    assert_eq!(
        notes,
        [
            "time axis 'time' has no unit, and its numbers, 0 and on by steps of 10, may be s, ms, µs or counts of samples"
        ]
    );
    assert_eq!(
        rate("time", &|i| format!("{:.2}", f64::from(i) * 0.01)).1,
        Some(100.0)
    );
}

const LVM: &str = "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\n\
                   Multi_Headings\tNo\nX_Columns\tMulti\nTime_Pref\tRelative\n***End_of_Header***\t\n\t\n";

#[test]
fn each_channel_of_an_lvm_file_may_have_its_own_x_column() {
    let row = |i: u32| {
        let slow = if i < 20 {
            format!("{:.3}\t0.2", 0.3 + f64::from(i) * 2e-3)
        } else {
            "\t".to_owned()
        };
        format!("{:.3}\t0.1\t{slow}", f64::from(i) * 1e-3)
    };
    let text = format!(
        "{LVM}Channels\t2\nSamples\t40\t\t20\t\nX_Dimension\tTime\t\tTime\t\nX0\t0.0E+0\t\t3.0E-1\t\n\
         Delta_X\t0.001000\t\t0.002000\t\n***End_of_Header***\t\nX_Value\tfast\tX_Value\tslow\tComment\n{}",
        rows(40, row)
    );
    let source = read("a.lvm", &text);
    let record = &source.datasets()[0];
    assert_eq!(record.channels[3].clock, Clock::Axis(2));
    assert_eq!(record.channels[1].clock, Clock::Shared);
    assert!((record.channels[3].sample_rate_hz.unwrap() - 500.0).abs() < 1e-6);
    assert_eq!(real(&*source, 0, 2)[0], 0.3);
}

#[test]
fn lvm_channels_without_x_columns_state_start_and_step() {
    let text = format!(
        "{}Channels\t2\nSamples\t40\t40\nDate\t2024/05/01\t2024/05/01\nTime\t12:00:00.5\t12:00:00.75\n\
         X_Dimension\tTime\tTime\nX0\t0.0E+0\t5.0E-2\nDelta_X\t0.001\t0.001\n***End_of_Header***\t\n\
         X_Value\tx\tcontact\tComment\n{}",
        LVM.replace("Multi\nTime", "No\nTime"),
        rows(40, |_| "\t0.1\t0.2".to_owned())
    );
    let source = read("a.lvm", &text);
    let starts: Vec<Option<f64>> = source.datasets()[0]
        .channels
        .iter()
        .map(|c| c.start_s)
        .collect();
    assert_eq!(starts, [Some(0.0), Some(0.3)]);
}

#[test]
fn octave_text_holds_what_matlab_files_hold() {
    let text = "# Created by Octave 8.4.0, Wed Jan 01 10:00:00 2020 UTC <user@host>\n\
                # name: t\n# type: range\n# base, limit, increment\n0 0.019 0.0005\n\n\n\
                # name: data\n# type: matrix\n# rows: 3\n# columns: 2\n 1 4\n 2 5\n 3 -6.5e-1\n\n\n\
                # name: fs\n# type: scalar\n2000\n\n\n\
                # name: x_unit\n# type: string\n# elements: 1\n# length: 2\nmm\n\n\n\
                # name: x\n# type: int16 matrix\n# ndims: 2\n 3 1\n  7\n  -8\n  9\n\n\n\
                # name: rig\n# type: scalar struct\n# ndims: 2\n 1 1\n# length: 2\n\
                # name: v\n# type: matrix\n# rows: 2\n# columns: 1\n 0.5\n 0.25\n\n\n\
                # name: r_mm\n# type: scalar\n1.5\n\n\n\n\n\
                # name: runs\n# type: struct\n# ndims: 2\n 1 2\n# length: 1\n# name: w\n# type: cell\n# rows: 1\n\
                # columns: 2\n# name: <cell-element>\n# type: matrix\n# rows: 2\n# columns: 1\n 1\n 2\n\n\n\n\
                # name: <cell-element>\n# type: matrix\n# rows: 2\n# columns: 1\n 3\n 4\n\n\n\n\n\n\n\
                # name: z\n# type: complex matrix\n# rows: 1\n# columns: 2\n (1,2) (3,4)\n\n\n";
    let source = read("a.mat", text);
    assert_eq!(source.format(), "mat");
    let record = &source.datasets()[0];
    let channel = |name: &str| {
        let at = record
            .channel_index(name)
            .unwrap_or_else(|| panic!("no {name}"));
        real(&*source, 0, at)
    };
    assert_eq!(channel("t").len(), 39);
    assert_eq!(channel("data(:,2)"), [4.0, 5.0, -0.65]);
    assert_eq!(channel("x"), [7.0, -8.0, 9.0]);
    assert_eq!(channel("rig.v"), [0.5, 0.25]);
    assert_eq!(
        record.channels[record.channel_index("x").unwrap()]
            .unit
            .as_deref(),
        Some("mm")
    );
    assert_eq!(record.attributes["fs"], "2000");
    assert_eq!(record.attributes["rig.r_mm"], "1.5");
    let runs: Vec<&str> = source.datasets().iter().map(|d| d.name.as_str()).collect();
    assert_eq!(runs, ["", "runs(1)", "runs(2)"]);
    assert_eq!(real(&*source, 2, 0), [3.0, 4.0]);
    assert!(
        source
            .notes()
            .iter()
            .any(|n| n.starts_with("complex matrix 'z' not read")),
        "{:?}",
        source.notes()
    );
    let cut = opened("a.mat", &text[..text.find(" 2 5").unwrap()])
        .err()
        .unwrap();
    assert!(cut.expected.contains("the numbers of a matrix"), "{cut}");
}

/// Name, dataset, channel, unit and rate of files after public reports.
const FIELD_CASES: [(&str, &str, Option<&str>, f64); 11] = [
    (
        "01-tektronix-five-columns/F0001CH1.CSV",
        "CH1",
        Some("V"),
        2500.0,
    ),
    (
        "02-rigol-sequence-increment/NewFile1.csv",
        "CH1",
        Some("Volt"),
        2500.0,
    ),
    (
        "04-picoscope-csv-ms-infinity/run.csv",
        "Channel A",
        Some("V"),
        2500.0,
    ),
    ("05-picoscope-mat/run.mat", "A", None, 2500.0),
    (
        "07-vernier-format-2/lab.txt",
        "Velocity",
        Some("m/s"),
        2500.0,
    ),
    ("08-rigol-rounded-time/long.csv", "CH1", Some("V"), 20_000.0),
    ("10-epoch-milliseconds/recording.csv", "value", None, 100.0),
    (
        "12-thousands-separators/german.csv",
        "Spannung",
        Some("mV"),
        1000.0,
    ),
    (
        "14-thousands-dots-integers/counts.csv",
        "Spannung",
        Some("mV"),
        1000.0,
    ),
    (
        "25-simulink-structure-with-time/scope.mat",
        "ScopeData.signals(1).values",
        None,
        1000.0,
    ),
    (
        "50-qtm-riders/gummi/Measurement52.tsv",
        "a X",
        Some("mm"),
        500.0,
    ),
];

#[test]
#[ignore = "needs shared/data: files after public reports"]
fn shared_data_field_cases_have_names_units_and_rates() {
    let folder =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/field_cases");
    for (file, name, unit, rate_hz) in FIELD_CASES {
        let source = open(&folder.join(file)).unwrap_or_else(|error| panic!("{error}"));
        let record = &source.datasets()[0];
        let channel = record
            .channel_index(name)
            .unwrap_or_else(|| panic!("{file}: no {name}"));
        let info = &record.channels[channel];
        if unit.is_some() {
            assert_eq!(info.unit.as_deref(), unit, "{file}");
        }
        if file.ends_with("scope.mat") {
            assert_eq!(info.properties["label"], "velocity", "{file}");
        }
        if let Some(found) = info.sample_rate_hz {
            assert!((found / rate_hz - 1.0).abs() < 2e-3, "{file}: {found}");
        }
        assert!(
            info.sample_rate_hz.is_some() || record.time_axis.is_some(),
            "{file}"
        );
        let values = real(&*source, 0, channel);
        assert!(values.iter().all(|v| v.is_finite()), "{file}");
    }
    for file in ["test_tables_v7.mat", "test_tables_v73.mat"] {
        let error = open(&folder.join("26-matlab-tables-objects").join(file))
            .err()
            .unwrap();
        assert!(error.found.contains("table 'table_"), "{error}");
        assert!(error.remedy.contains("table2struct"), "{error}");
    }
}
