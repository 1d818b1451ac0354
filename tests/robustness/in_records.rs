//! Faults in the record files.

use super::{Case, edited, noted, refused};
use crate::support::{Lab, SAMPLES, wav_format};

/// The cases.
pub(super) fn cases() -> Vec<Case> {
    let mut all = files();
    all.extend(channels());
    all.extend(values());
    all.extend(times());
    all.extend(units_of_time());
    all.extend(bombs());
    all
}

/// The second record is this file instead.
fn instead(lab: &Lab, name: &str, bytes: &[u8]) {
    lab.write_bytes(name, bytes);
    lab.replace("runs.csv", "r2.csv", name);
}

/// An RF64 file whose chunk of samples is said to have so many bytes.
fn wav_of(bytes: u64) -> Vec<u8> {
    let mut file = b"RF64\xff\xff\xff\xffWAVEds64".to_vec();
    file.extend(28_u32.to_le_bytes());
    for number in [bytes + 72, bytes, bytes / 2] {
        file.extend(number.to_le_bytes());
    }
    file.extend([0; 4]);
    file.extend(wav_format());
    file.extend(b"data\xff\xff\xff\xff");
    file.extend([7; 100]);
    file
}

/// A UFF 58 file whose function is said to have so many points.
fn uff_of(points: &str) -> String {
    let axis = "         17    0    0    0 time                 s                   \n";
    format!(
        "    -1\n    58\nvx\nNONE\n01-Jan-24 12:00:00\nNONE\nNONE\n\
             1         0    1         0 NONE         1   1 NONE         1   1\n\
                  4{points}         1  0.00000e+00  5.00000e-04  0.00000e+00\n\
         {axis}{axis}{axis}{axis}  1.00000e+00  2.00000e+00\n    -1\n"
    )
}

/// An HDF5 file with a record at the bottom of so many groups.
fn nested_groups(path: &std::path::Path, depth: usize) {
    use labfiles_write::hdf5::{CampaignWriter, ColumnToWrite, RecordTable};
    // who writes so deep a tree needs a deep stack
    let path = path.to_path_buf();
    let write = move || {
        let mut writer = CampaignWriter::create(&path);
        let column = |name| ColumnToWrite::numbers(name, "V", vec![0.5; 50]);
        let written = writer.add(RecordTable {
            name: vec!["g"; depth].join("/"),
            sample_rate_hz: Some(2000.0),
            channels: vec![column("a"), column("b")],
            attributes: Vec::new(),
        });
        written.expect("a name");
        writer.finish().expect("it is written");
    };
    let thread = std::thread::Builder::new().stack_size(1 << 28);
    let running = thread.spawn(write).expect("a thread");
    running.join().expect("it is written");
}

/// Files that claim or unfold to more than a machine holds.
pub(super) fn bombs() -> Vec<Case> {
    vec![
        refused(
            "HDF5 that claims more samples than its bytes can hold",
            |lab| {
                let bytes =
                    include_bytes!("../../crates/labfiles/tests/data/formats/claims_too_much.h5");
                instead(lab, "r2.h5", bytes);
            },
            &["r2.h5", "2 of 3 records can be used"],
        ),
        refused(
            "MATLAB v5 that unfolds to a quarter of a gigabyte",
            |lab| instead(lab, "r2.mat", &matlab_bomb()),
            &[
                "r2.mat",
                "compressed bytes that claim to hold",
                "2 of 3 records can be used",
            ],
        ),
        refused(
            "TDMS with 100 GB of metadata",
            |lab| {
                let mut bytes = b"TDSm".to_vec();
                bytes.extend(0x0e_u32.to_le_bytes());
                bytes.extend(4713_u32.to_le_bytes());
                bytes.extend(1_000_000_000_000_u64.to_le_bytes());
                bytes.extend(100_000_000_000_u64.to_le_bytes());
                bytes.extend([0xff; 100]);
                instead(lab, "r2.tdms", &bytes);
            },
            &[
                "r2.tdms",
                "copy or export it again",
                "2 of 3 records can be used",
            ],
        ),
        refused(
            "WAV whose header claims a terabyte of samples",
            |lab| instead(lab, "r2.wav", &wav_of(1_000_000_000_000)),
            &["r2.wav", "2 of 3 records can be used"],
        ),
        refused(
            "UFF 58 that claims ten thousand million points",
            |lab| instead(lab, "r2.uff", uff_of("9999999999").as_bytes()),
            &["r2.uff", "2 of 3 records can be used"],
        ),
        refused(
            "LVM that claims a million million samples",
            |lab| {
                let text = "LabVIEW Measurement\t\nSeparator\tTab\n***End_of_Header***\t\n\
                            Channels\t1\nSamples\t1000000000000\nDelta_X\t0.0005\n\
                            ***End_of_Header***\t\nX_Value\tvx\n0.0\t1.0\n";
                instead(lab, "r2.lvm", text.as_bytes());
            },
            &["r2.lvm", "2 of 3 records can be used"],
        ),
        refused(
            "HDF5 of two thousand nested groups",
            |lab| {
                nested_groups(&lab.path("r2.h5"), 2000);
                lab.replace("runs.csv", "r2.csv", "r2.h5");
            },
            &["r2.h5", "2 of 3 records can be used"],
        ),
        refused(
            "CSV of one endless line",
            |lab| instead(lab, "r2.csv", &[b'a'; 20_000_000]),
            &[
                "r2.csv",
                "no column of numbers",
                "2 of 3 records can be used",
            ],
        ),
        refused(
            "CSV of half a million columns",
            |lab| {
                let names: Vec<String> = (0..500_000).map(|i| format!("c{i}")).collect();
                instead(lab, "r2.csv", (names.join(",") + "\n1\n").as_bytes());
            },
            &["r2.csv", "2 of 3 records can be used"],
        ),
    ]
}

/// A header and one compressed element that holds a quarter of a gigabyte of zeros.
fn matlab_bomb() -> Vec<u8> {
    let mut packed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    let mut put = |bytes: &[u8]| std::io::Write::write_all(&mut packed, bytes).expect("memory");
    put(&14_u32.to_le_bytes());
    put(&(1_u32 << 28).to_le_bytes());
    let zeros = vec![0; 1 << 20];
    for _ in 0..256 {
        put(&zeros);
    }
    let packed = packed.finish().expect("memory");
    let mut bytes = b"MATLAB 5.0 MAT-file".to_vec();
    bytes.resize(124, b' ');
    bytes.extend([0, 1, b'I', b'M']);
    bytes.extend(15_u32.to_le_bytes());
    bytes.extend(u32::try_from(packed.len()).expect("short").to_le_bytes());
    bytes.extend(packed);
    bytes
}

fn files() -> Vec<Case> {
    vec![
        refused(
            "an empty file",
            |lab| lab.write("r2.csv", ""),
            &["r2.csv", "an empty file", "2 of 3 records can be used"],
        ),
        refused(
            "a file with a header alone",
            |lab| lab.write("r2.csv", "time [s],drive [V],contact [V],vx [V],vy [V]\n"),
            &["r2.csv", "2 of 3 records can be used"],
        ),
        refused(
            "a file of random bytes",
            |lab| {
                let bytes: Vec<u8> = (0..4096_u32)
                    .map(|i| i.wrapping_mul(2_654_435_761).to_le_bytes()[2])
                    .collect();
                lab.write_bytes("r2.bin", &bytes);
                lab.replace("runs.csv", "r2.csv", "r2.bin");
            },
            &["r2.bin", "no known format", "2 of 3 records can be used"],
        ),
        refused(
            "a folder where a file should be",
            |lab| {
                lab.remove("r2.csv");
                std::fs::create_dir(lab.path("r2.csv")).expect("a folder");
            },
            &["r2.csv", "a directory", "2 of 3 records can be used"],
        ),
        refused(
            "a truncated HDF5 file",
            |lab| {
                let mut bytes = b"\x89HDF\r\n\x1a\n".to_vec();
                bytes.extend([0; 40]);
                lab.write_bytes("r2.h5", &bytes);
                lab.replace("runs.csv", "r2.csv", "r2.h5");
            },
            &["r2.h5", "2 of 3 records can be used"],
        ),
        noted(
            "a file cut off in the middle of a row",
            |lab| {
                let text = lab.read("r2.csv");
                lab.write("r2.csv", &text[..text.len() / 2 - 7]);
            },
            &[
                "r2.csv: it holds 99",
                "the usual record 2000",
                "stopped early",
            ],
        ),
    ]
}

fn channels() -> Vec<Case> {
    vec![
        refused(
            "a channel missing in one file",
            |lab| lab.replace("r2.csv", "vy [V]", "vz [V]"),
            &[
                "r2.csv: vy: no channel 'vy' for the role velocity_y",
                "the channels are: time, drive, contact, vx, vz",
                "name one of them in [channels.velocity_y]",
                "2 of 3 records can be used",
            ],
        ),
        edited(
            "a channel missing in all files",
            "channel = \"vy\"",
            "channel = \"laser 2\"",
            &["in all 3 records: no channel 'laser 2'", "velocity_y"],
        ),
        edited(
            "an index beyond the last channel",
            "channel = \"vy\"",
            "channel = 12",
            &["in all 3 records: no channel 'number 12'"],
        ),
        refused(
            "another unit in the file than in campaign.toml",
            |lab| lab.replace("r2.csv", "vx [V]", "vx [mV]"),
            &[
                "the file states the unit 'mV' for channel",
                "campaign.toml 'V'",
                "ignore_file_unit = true",
                "2 of 3 records can be used",
            ],
        ),
        refused(
            "no unit in the file nor in campaign.toml",
            |lab| {
                lab.replace("r2.csv", "vx [V]", "vx");
                lab.edit("channel = \"vx\"\nunit = \"V\"", "channel = \"vx\"");
            },
            &[
                "the file states no unit for channel 'vx'",
                "[channels.velocity_x]",
            ],
        ),
    ]
}

fn spoil(lab: &Lab, column: usize, text: &'static str) {
    lab.column("r2.csv", column, |i, v| {
        if i == 700 {
            text.into()
        } else {
            format!("{v:.6}")
        }
    });
}

fn values() -> Vec<Case> {
    vec![
        refused(
            "NaN in a channel",
            |lab| spoil(lab, 3, "NaN"),
            &[
                "r2.csv: vx",
                "has 1 values that are not numbers (NaN or infinite), the first at sample 700",
                "2 of 3 records can be used",
            ],
        ),
        refused(
            "an infinite value",
            |lab| spoil(lab, 4, "inf"),
            &[
                "r2.csv: vy",
                "not numbers (NaN or infinite)",
                "2 of 3 records can be used",
            ],
        ),
        refused(
            "a gap in a channel",
            |lab| spoil(lab, 3, ""),
            &["r2.csv: vx", "not numbers", "2 of 3 records can be used"],
        ),
        noted(
            "no values at a channel's beginning",
            |lab| {
                lab.column("r2.csv", 3, |i, v| {
                    if i < 5 { String::new() } else { format!("{v}") }
                });
            },
            &[
                "5 samples without a value at the ends are cut off",
                "3 of 3 records",
            ],
        ),
        refused(
            "a constant velocity",
            |lab| lab.column("r2.csv", 3, |_, _| "0.125".into()),
            &[
                "r2.csv: vx",
                "is constant at",
                "loose cable",
                "2 of 3 records can be used",
            ],
        ),
        refused(
            "a record that was cut off after two samples",
            |lab| lab.lines("r2.csv", |i, line| (i < 3).then(|| line.to_owned())),
            &[
                "the record is too short: 2 samples",
                "whether the file is whole",
                "2 of 3 records can be used",
            ],
        ),
        refused(
            "a constant drive",
            |lab| lab.column("r2.csv", 1, |_, _| "0".into()),
            &["r2.csv: drive", "is constant", "2 of 3 records can be used"],
        ),
        refused(
            "a saturated velocity",
            |lab| lab.column("r2.csv", 3, |_, v| format!("{:.6}", v.clamp(-1.0, 1.0))),
            &[
                "r2.csv: vx",
                "is clipped",
                "larger range",
                "2 of 3 records can be used",
            ],
        ),
        noted(
            "a saturated drive",
            |lab| lab.column("r2.csv", 1, |_, v| format!("{:.6}", v.clamp(-0.7, 0.7))),
            &["r2.csv: drive", "is clipped", "3 of 3 records can be used"],
        ),
        refused(
            "samples held by the converter",
            |lab| {
                let text = lab.read("r2.csv");
                let held = text.lines().nth(900).expect("a row").to_owned();
                let (_, held) = held.split_once(',').expect("cells");
                lab.lines("r2.csv", |i, line| {
                    let (time, rest) = line.split_once(',').expect("cells");
                    let rest = if (900..925).contains(&i) { held } else { rest };
                    Some(format!("{time},{rest}"))
                });
            },
            &[
                "all channels hold their value for 24 samples",
                "2 of 3 records can be used",
            ],
        ),
    ]
}

fn times() -> Vec<Case> {
    vec![
        refused(
            "time running backward",
            |lab| {
                lab.column("r2.csv", 0, |i, t| {
                    format!("{:.6}", if i > 1200 { 1.2 - t } else { t })
                });
            },
            &[
                "r2.csv",
                "the time runs backward",
                "2 of 3 records can be used",
            ],
        ),
        refused(
            "time running backward from the first sample on",
            |lab| lab.column("r2.csv", 0, |_, t| format!("{:.6}", 1.0 - t)),
            &[
                "r2.csv",
                "the record is read from its end",
                "2 of 3 records can be used",
            ],
        ),
        refused(
            "dropped samples",
            |lab| {
                lab.lines("r2.csv", |i, l| {
                    (!(800..817).contains(&i)).then(|| l.to_owned())
                });
            },
            &[
                "17 samples are missing in the time axis",
                "2 of 3 records can be used",
            ],
        ),
        refused(
            "a repeated time stamp",
            |lab| {
                lab.column("r2.csv", 0, |i, t| {
                    format!("{:.6}", if i == 500 { t - 0.0005 } else { t })
                });
            },
            &["time stamps are repeated", "2 of 3 records can be used"],
        ),
        refused(
            "a time axis that is not uniform",
            |lab| lab.column("r2.csv", 0, |_, t| format!("{:.6}", t * t)),
            &["the time axis is not uniform", "2 of 3 records can be used"],
        ),
        refused(
            "no time axis and no sample rate",
            |lab| {
                lab.lines("r2.csv", |i, line| {
                    let (_, rest) = line.split_once(',').expect("cells");
                    let _ = (i, SAMPLES);
                    Some(rest.to_owned())
                });
            },
            &[
                "neither a time axis nor a sample rate",
                "sample_rate = \"2 kHz\"",
            ],
        ),
    ]
}

fn units_of_time() -> Vec<Case> {
    vec![
        refused(
            "milliseconds without a unit",
            |lab| {
                lab.replace("r2.csv", "time [s]", "time");
                lab.column("r2.csv", 0, |i, _| (10 * i).to_string());
            },
            &[
                "time axis 'time' has no unit, and its numbers",
                "by steps of 10, may be s, ms, µs or counts of samples",
                "time_unit = \"ms\"",
                "2 of 3 records can be used",
            ],
        ),
        noted(
            "a time axis without a unit",
            |lab| lab.replace("r2.csv", "time [s]", "time"),
            &["time axis 'time' has no unit: taken as seconds"],
        ),
        edited(
            "times of unlike units",
            "[records]",
            "[records]\ntime_unit = \"ms\"",
            &["the time axis 'time' has a unit of 1 s, campaign.toml states time_unit as 0.001 s"],
        ),
        edited(
            "a unit of time that is none",
            "[records]",
            "[records]\ntime_unit = \"mm\"",
            &["'mm' is no unit of time", "write s, ms, us, ns or min"],
        ),
        refused(
            "a time that is printed too coarsely, with samples lost",
            |lab| {
                lab.column("r2.csv", 0, |i, t| {
                    let lost = if i > 900 { 0.05 } else { 0.0 };
                    format!("{:.2}", t + lost)
                });
            },
            &["samples share stamps of", "2 of 3 records can be used"],
        ),
    ]
}
