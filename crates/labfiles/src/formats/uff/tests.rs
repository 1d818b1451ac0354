use serde_json::Value;

use super::*;
use crate::conformance::{self, Random, Statistics};
use crate::source::StoredType;

// ---- writing small files ----

/// A function to write.
#[derive(Clone)]
struct Written {
    name: &'static str,
    date: &'static str,
    kind: i64,
    even: bool,
    abscissa: (i64, &'static str),
    unit: &'static str,
    /// Abscissa, real and imaginary part of every point.
    points: Vec<[f64; 3]>,
}

fn sweep(name: &'static str, points: &[f64]) -> Written {
    let points = points
        .iter()
        .enumerate()
        .map(|(k, &y)| [k as f64 * 0.25, y, -y])
        .collect();
    Written {
        name,
        date: "NONE",
        kind: 2,
        even: true,
        abscissa: (17, "s"),
        unit: "mm",
        points,
    }
}

impl Written {
    fn header(&self) -> String {
        let (axis, unit) = self.abscissa;
        let increment = if self.even { 0.25 } else { 0.0 };
        [
            "test run\nNONE\n".to_owned(),
            format!("{}\nNONE\nNONE\n", self.date),
            format!(
                "    1         0    0         0 {:<10}         1   3 NONE               0   0\n",
                self.name
            ),
            format!(
                "{:10}{:10}{:10}  0.00000E+00 {increment:12.5E}  0.00000E+00\n",
                self.kind,
                self.points.len(),
                i32::from(self.even)
            ),
            format!("{axis:10}    0    0    0 {:<20} {unit:<20}\n", "NONE"),
            format!(
                "{:10}    0    0    0 {:<20} {:<20}\n",
                8, "Displacement", self.unit
            ),
            format!("{:10}    0    0    0 {:<20} {:<20}\n", 0, "NONE", "NONE").repeat(2),
        ]
        .concat()
    }

    fn numbers(&self) -> Vec<f64> {
        let (even, complex) = (self.even, self.kind >= 5);
        let point = |[x, re, im]: &[f64; 3]| {
            let mut out = vec![*x; usize::from(!even)];
            out.push(*re);
            out.extend(complex.then_some(*im));
            out
        };
        self.points.iter().flat_map(point).collect()
    }

    fn ascii(&self) -> Vec<u8> {
        let double = matches!(self.kind, 4 | 6);
        self.lines(if double { 4 } else { 6 }, |_| double)
    }

    /// As the format's description has uneven functions: abscissae in single precision, too,
    /// where the ordinate is in double precision.
    fn ascii_of_narrow_abscissae(&self) -> Vec<u8> {
        let double = matches!(self.kind, 4 | 6);
        let width = if self.kind >= 5 { 3 } else { 2 };
        let per_line = match (double, width) {
            (true, 3) => 3,
            (true, _) => 4,
            _ => 6,
        };
        self.lines(per_line, |index| double && index % width != 0)
    }

    fn lines(&self, per_line: usize, wide: impl Fn(usize) -> bool) -> Vec<u8> {
        let mut out = format!("    -1\n    58\n{}", self.header());
        for (index, value) in self.numbers().into_iter().enumerate() {
            let number = if wide(index) {
                format!("{:>20}", format!("{value:.12E}"))
            } else {
                format!("{:>13}", format!("{value:.5E}"))
            };
            out.push_str(&number);
            if (index + 1) % per_line == 0 {
                out.push('\n');
            }
        }
        if !out.ends_with('\n') {
            out.push('\n');
        }
        out.push_str("    -1\n");
        out.into_bytes()
    }

    fn binary(&self, big: bool, wide_abscissa: bool) -> Vec<u8> {
        let double = matches!(self.kind, 4 | 6);
        let width = 1 + usize::from(!self.even) + usize::from(self.kind >= 5);
        let mut data = Vec::new();
        for (index, value) in self.numbers().into_iter().enumerate() {
            let abscissa = !self.even && index % width == 0;
            let wide = double && (wide_abscissa || !abscissa);
            let mut bytes = if wide {
                value.to_le_bytes().to_vec()
            } else {
                (value as f32).to_le_bytes().to_vec()
            };
            if big {
                bytes.reverse();
            }
            data.extend(bytes);
        }
        let order = if big { 2 } else { 1 };
        let mark = format!(
            "    -1\r\n    58b{order:6}{:6}{:12}{:12}     0     0           0           0\r\n",
            2,
            11,
            data.len()
        );
        let header = self.header().replace('\n', "\r\n");
        [mark.as_bytes(), header.as_bytes(), &data, b"    -1\r\n"].concat()
    }
}

fn opened(bytes: &[u8]) -> Result<Box<dyn Source>, ReadError> {
    let temp = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(temp.path(), bytes).unwrap();
    open(temp.path())
}

// ---- goldens ----

struct Read {
    stored: StoredType,
    properties: std::collections::BTreeMap<String, String>,
    unit: Option<String>,
    abscissa: Vec<f64>,
    real: Vec<f64>,
    imaginary: Vec<f64>,
}

/// All functions of a file in file order.
fn functions(source: &dyn Source) -> Vec<Read> {
    let mut all = Vec::new();
    for (index, dataset) in source.datasets().iter().enumerate() {
        let mut samples = conformance::read_all(source, index).unwrap();
        let mut infos = dataset.channels.clone();
        let apart = !infos[0].properties.contains_key("func_type");
        let shared = apart.then(|| (infos.remove(0), samples.remove(0)));
        for (info, samples) in infos.into_iter().zip(samples) {
            let number = |key: &str| info.properties[key].parse::<f64>().unwrap();
            let abscissa = match &shared {
                Some((_, Samples::Real(values))) => values.clone(),
                _ => (0..info.samples)
                    .map(|k| number("abscissa_min") + k as f64 * number("abscissa_inc"))
                    .collect(),
            };
            let (real, imaginary) = match samples {
                Samples::Real(values) => (values, Vec::new()),
                Samples::Complex(values) => values.into_iter().unzip(),
                Samples::Text(_) => panic!(),
            };
            all.push(Read {
                stored: info.stored,
                properties: info.properties,
                unit: info.unit,
                abscissa,
                real,
                imaginary,
            });
        }
    }
    all
}

fn check_function(read: &Read, golden: &Value, what: &str) {
    // The reference reader makes every number a double; here the type is the file's.
    let stored = match golden["ord_data_type"].as_i64().unwrap() {
        2 => StoredType::Float(32),
        4 => StoredType::Float(64),
        5 => StoredType::Complex(32),
        _ => StoredType::Complex(64),
    };
    assert_eq!(read.stored, stored, "{what}");
    let complex = golden["data"]["dtype"] == "complex128";
    Statistics::of(read.real.iter().copied()).check(&golden["data"], complex.then_some(0), what);
    if complex {
        Statistics::of(read.imaginary.iter().copied()).check(&golden["data"], Some(1), what);
    }
    Statistics::of(read.abscissa.iter().copied()).check(&golden["x"], None, what);
    // Units were read as UTF-8 by the reference reader, which loses the ² of code page 1252.
    let unit = golden["ordinate_unit"]
        .as_str()
        .unwrap()
        .replace('\u{fffd}', "²");
    assert_eq!(read.unit.as_deref(), Some(unit.as_str()), "{what}");
    for key in ["func_type", "rsp_node", "rsp_dir", "ref_node"] {
        assert_eq!(
            read.properties[key],
            golden[key].to_string(),
            "{what}: {key}"
        );
    }
    // The goldens were written with texts cut after 60 characters, and NONE is no name.
    let id1 = read.properties.get("id1").map_or("NONE", |id| id);
    assert_eq!(
        id1.chars().take(60).collect::<String>(),
        golden["id1"].as_str().unwrap(),
        "{what}"
    );
}

#[test]
#[ignore = "needs shared/data: conformance files of UFF"]
fn shared_data_every_golden_is_met() {
    for (path, golden) in conformance::goldens("uff_conformance") {
        let what = path.display().to_string();
        assert!(recognises(&std::fs::read(&path).unwrap()[..16]), "{what}");
        let source = open(&path).unwrap_or_else(|error| panic!("{error}"));
        let found = functions(source.as_ref());
        let wanted = golden["sets58"].as_array().unwrap();
        assert_eq!(found.len(), wanted.len(), "{what}");
        for (index, (found, golden)) in found.iter().zip(wanted).enumerate() {
            check_function(found, golden, &format!("{what}, function {}", index + 1));
        }
        // Every other set is named in a note, but for those that name and measure the file.
        let others = golden["types"]
            .as_array()
            .unwrap()
            .iter()
            .map(|t| t.as_i64().unwrap());
        for other in others.filter(|t| ![58, 151, 164].contains(t)) {
            let named = source
                .notes()
                .iter()
                .any(|note| note.contains(&format!("{other} (")));
            assert!(named, "{what}: {other} in {:?}", source.notes());
        }
    }
}

#[test]
#[ignore = "needs shared/data: conformance files of UFF"]
fn shared_data_names_and_times_of_conformance_files() {
    let folder = conformance::shared_data("uff_conformance");
    let source = open(&folder.join("Sample_UFF58b_bin.uff")).unwrap();
    let channel = &source.datasets()[0].channels[0];
    assert_eq!(channel.name, "Mic 01");
    assert_eq!(channel.start_time.as_deref(), Some("2016-04-18T13:49:58"));
    assert_eq!(channel.sample_rate_hz, Some(1.0 / 1.52588e-5));
    let source = open(&folder.join("MPSTD#Set001_2024_10_08_10_27_07.uff")).unwrap();
    assert_eq!(source.datasets().len(), 1);
    let names: Vec<&str> = source.datasets()[0]
        .channels
        .iter()
        .map(|c| c.name.as_str())
        .collect();
    assert_eq!(
        names,
        [
            "MPS set1 Dof1",
            "MPS set1 Dof2",
            "MPS set1 Dof3",
            "MPS set1 Dof4"
        ]
    );
    // A header that states 2508876 points over 42: read, with a note.
    let source = open(&folder.join("dataset_milestone_in_header.uff")).unwrap();
    assert!(
        source.notes()[0].contains("states 2508876 points and holds 42"),
        "{:?}",
        source.notes()
    );
}

// ---- own files ----

#[test]
fn every_form_of_numbers_holds_the_same() {
    let values: Vec<f64> = (0..17).map(|k| f64::from(k * k) * 0.125 - 3.0).collect();
    for kind in [2, 4, 5, 6] {
        for even in [true, false] {
            let written = Written {
                kind,
                even,
                ..sweep("x", &values)
            };
            let files = [
                written.ascii(),
                written.binary(false, true),
                written.binary(true, true),
                written.binary(true, false),
            ];
            for bytes in files {
                let source = opened(&bytes).unwrap();
                let read = functions(source.as_ref()).remove(0);
                assert_eq!(read.real, values, "type {kind}, even {even}");
                let imaginary: Vec<f64> = values.iter().map(|v| -v).filter(|_| kind >= 5).collect();
                assert_eq!(read.imaginary, imaginary);
                assert_eq!(read.abscissa[16], 4.0);
                assert_eq!(source.datasets()[0].time_axis, (!even).then_some(0));
            }
        }
    }
}

/// Points at uneven times: steps of 0.1 to 0.4.
fn uneven(name: &'static str, kind: i64) -> Written {
    let values = [1.5, -2.5, 3.5, -4.5, 5.5, -6.5, 7.5];
    let mut written = Written {
        kind,
        even: false,
        ..sweep(name, &values)
    };
    let times = [0.0, 0.125, 0.5, 0.625, 1.0, 1.125, 1.5];
    let points = written.points.iter_mut().zip(times);
    points.for_each(|(point, time)| point[0] = time);
    written
}

#[test]
fn uneven_abscissae_are_read_as_they_stand() {
    for kind in [2, 4, 5, 6] {
        let written = uneven("x", kind);
        let times: Vec<f64> = written.points.iter().map(|point| point[0]).collect();
        let files = [
            written.ascii_of_narrow_abscissae(),
            written.ascii(),
            written.binary(false, true),
            written.binary(true, true),
            written.binary(false, false),
        ];
        for bytes in files {
            let source = opened(&bytes).unwrap();
            let dataset = &source.datasets()[0];
            assert_eq!(dataset.time_axis, Some(0));
            assert_eq!(dataset.channels[1].sample_rate_hz, None);
            let time = source.read(0, &[0]).unwrap().remove(0);
            assert_eq!(time, Samples::Real(times.clone()), "type {kind}");
        }
    }
}

#[test]
fn channels_over_the_same_uneven_times_are_one_record() {
    let mut late = uneven("z", 2);
    late.points[3][0] += 0.0625;
    let all = [uneven("x", 2), uneven("y", 2), late];
    let forms: [fn(&Written) -> Vec<u8>; 2] = [Written::ascii, |w| w.binary(false, true)];
    for form in forms {
        let bytes: Vec<u8> = all.iter().flat_map(form).collect();
        let source = opened(&bytes).unwrap();
        let names = |d: usize| -> Vec<&str> {
            let channels = source.datasets()[d].channels.iter();
            channels.map(|c| c.name.as_str()).collect()
        };
        assert_eq!(source.datasets().len(), 2);
        assert_eq!(names(0), ["time", "x", "y"]);
        assert_eq!(names(1), ["time", "z"]);
        let all = source.read(0, &[0, 2]).unwrap();
        assert_eq!(all[1], source.read(0, &[2]).unwrap()[0]);
        let Samples::Real(times) = &source.read(1, &[0]).unwrap()[0] else {
            panic!()
        };
        assert_eq!(times[3], 0.6875);
    }
}

#[test]
fn records_begin_where_a_channel_comes_again() {
    let record = |date| {
        [
            Written {
                date,
                ..sweep("x", &[1.0, 2.0])
            },
            Written {
                date,
                ..sweep("y", &[3.0, 4.0])
            },
        ]
    };
    let all = [record("18-Apr-16 13:49:58"), record("18-Apr-16 13:50:58")].concat();
    let bytes: Vec<u8> = all.iter().flat_map(Written::ascii).collect();
    let source = opened(&bytes).unwrap();
    let names: Vec<&str> = source.datasets().iter().map(|d| d.name.as_str()).collect();
    assert_eq!(names, ["1", "2"]);
    let channels = &source.datasets()[1].channels;
    assert_eq!(
        (channels[0].name.as_str(), channels[1].name.as_str()),
        ("x", "y")
    );
    assert_eq!(
        channels[1].start_time.as_deref(),
        Some("2016-04-18T13:50:58")
    );
    assert_eq!(channels[0].unit.as_deref(), Some("mm"));
    let samples = source.read(1, &[1]).unwrap();
    assert_eq!(samples, [Samples::Real(vec![3.0, 4.0])]);
}

/// Two records of two channels; second lines and load cases as given.
#[test]
fn functions_that_begin_later_are_channels_of_one_record() {
    let text = |name, start: &str| {
        let bytes = sweep(name, &[1.0; 8]).ascii();
        let text = String::from_utf8(bytes).unwrap();
        text.replacen("  0.00000E+00", &format!("  {start}"), 1)
    };
    let bytes = text("x", "0.00000E+00") + &text("contact", "5.00000E-01");
    let source = opened(bytes.as_bytes()).unwrap();
    assert_eq!(source.datasets().len(), 1);
    let starts: Vec<_> = source.datasets()[0]
        .channels
        .iter()
        .map(|c| c.start_s)
        .collect();
    assert_eq!(starts, [Some(0.0), Some(0.5)]);
    // functions of unlike times are records
    let bytes = text("x", "0.00000E+00") + &text("contact", "5.00000E+01");
    assert_eq!(opened(bytes.as_bytes()).unwrap().datasets().len(), 2);
    // lines may end by carriage returns alone
    let returns = text("x", "0.00000E+00").replace('\n', "\r");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("old.uff");
    std::fs::write(&path, returns).unwrap();
    assert_eq!(
        crate::open(&path).unwrap().datasets()[0].channels[0].samples,
        8
    );
}

fn two_records(names: [&str; 4], cases: [i64; 4]) -> Vec<u8> {
    let functions = names.into_iter().zip(cases).enumerate();
    let one = |(index, (name, case)): (usize, (&str, i64))| {
        let written = sweep(["x", "y"][index % 2], &[1.0, 2.0]).ascii();
        let text = String::from_utf8(written).unwrap();
        let text = text.replacen("\nNONE\n", &format!("\n{name}\n"), 1);
        let place = "    1         0    0         0 ";
        text.replacen(place, &format!("    1         0    0{case:10} "), 1)
    };
    functions.flat_map(|f| one(f).into_bytes()).collect()
}

#[test]
fn records_are_named_by_their_second_lines_if_those_are_as_we_write_them() {
    let names = |lines, cases| -> Vec<String> {
        let source = opened(&two_records(lines, cases)).unwrap();
        let names = source.datasets().iter().map(|d| d.name.clone());
        names.collect()
    };
    let cases = [1, 1, 2, 2];
    let stated = ["day/r7", "day/r7", "day/r3", "day/r3"];
    assert_eq!(names(stated, cases), ["day/r7", "day/r3"]);
    let numbered = ["1", "2"];
    assert_eq!(names(["a", "a", "a", "a"], cases), numbered);
    assert_eq!(names(["a", "a", "NONE", "NONE"], cases), numbered);
    assert_eq!(names(["a", "b", "c", "c"], cases), numbered);
    assert_eq!(names(stated, [0, 0, 1, 1]), numbered);
    assert_eq!(names(["a", "a", "", ""], [1, 1, 1, 1]), [""]);
}

#[test]
fn units_follow_from_the_unit_system() {
    let system = b"    -1\n   164\n         1SI: Meter (newton)           2\n  1.0D+00  1.0D+00  1.0D+00\n    -1\n";
    let written = Written {
        unit: "",
        ..sweep("x", &[1.0])
    };
    let source = opened(&[&system[..], &written.ascii()].concat()).unwrap();
    assert_eq!(source.datasets()[0].channels[0].unit.as_deref(), Some("m"));
    assert_eq!(source.datasets()[0].attributes["units_code"], "1");
}

#[test]
fn frequency_is_a_channel() {
    let written = Written {
        abscissa: (18, "Hz"),
        kind: 5,
        ..sweep("x", &[1.0, 2.0])
    };
    let source = opened(&written.ascii()).unwrap();
    let dataset = &source.datasets()[0];
    assert_eq!(dataset.channels[0].name, "frequency");
    assert_eq!(
        (dataset.time_axis, dataset.channels[1].sample_rate_hz),
        (None, None)
    );
    assert_eq!(
        source.read(0, &[0]).unwrap(),
        [Samples::Real(vec![0.0, 0.25])]
    );
}

#[test]
fn broken_files_are_refused_at_a_byte() {
    let good = sweep("x", &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]).ascii();
    let text = String::from_utf8(good).unwrap();
    let word = text.replace("6.00000E0", "6.0x000E0");
    let error = opened(word.as_bytes()).unwrap().read(0, &[0]).unwrap_err();
    assert_eq!(error.byte, Some(word.find("x000").unwrap() as u64));
    let kind = text.replace(
        "         2         7         1",
        "         3         7         1",
    );
    let error = opened(kind.as_bytes()).err().unwrap().to_string();
    assert!(error.contains("ordinate type 2, 4, 5 or 6"), "{error}");
    let more = text.replace(
        "         2         7         1",
        "         2         1         1",
    );
    assert!(opened(more.as_bytes()).unwrap().read(0, &[0]).is_err());
    let huge = text.replace(
        "         2         7         1",
        "         21000000000         1",
    );
    let (source, peak) = conformance::peak_bytes(|| opened(huge.as_bytes()).unwrap());
    assert_eq!(source.datasets()[0].channels[0].samples, 7);
    assert!(peak < 100_000, "{peak}");
    let binary = sweep("x", &[1.0; 40]).binary(false, true);
    let vax =
        String::from_utf8_lossy(&binary).replacen("     2          11", "     1          11", 1);
    assert!(
        opened(vax.as_bytes())
            .err()
            .unwrap()
            .to_string()
            .contains("DEC VMS")
    );
    let cut = opened(&binary[..binary.len() - 50]).unwrap();
    assert_eq!(cut.datasets()[0].channels[0].samples, 29);
    assert!(cut.notes()[0].contains("cut short"));
}

#[test]
fn more_points_than_the_binary_holds_are_refused() {
    let binary = sweep("x", &[1.0; 40]).binary(false, true);
    let fewer = String::from_utf8_lossy(&binary[..])
        .find("        40")
        .unwrap();
    let mut wrong = binary;
    wrong[fewer..fewer + 10].copy_from_slice(b"        30");
    let error = opened(&wrong).err().unwrap().to_string();
    assert!(
        error.contains("the end of a set after 30 points"),
        "{error}"
    );
}

// ---- mutations ----

/// Change digits and fields of the text as often as any byte.
fn mutate_text(random: &mut Random, bytes: &mut Vec<u8>) {
    if bytes.is_empty() || random.below(2) == 0 {
        return conformance::mutate(random, bytes);
    }
    const PIECES: [&[u8]; 10] = [
        b"    -1\n",
        b"    58\n",
        b"    58b     1     2          11         400     0     0\n",
        b"9999999999",
        b"         0",
        b"        -1",
        b"1.0E+999",
        b"-5.0-123",
        b"\n",
        b"\xff\xfe",
    ];
    for _ in 0..=random.below(3) {
        let reach = if random.below(2) == 0 {
            bytes.len().min(900)
        } else {
            bytes.len()
        };
        let at = random.below(reach);
        let piece = PIECES[random.below(PIECES.len())];
        let over = if random.below(2) == 0 {
            (at + piece.len()).min(bytes.len())
        } else {
            at
        };
        bytes.splice(at..over, piece.iter().copied());
    }
}

#[test]
fn prop_mutated_files_are_read_or_refused() {
    let mut seeds = conformance::own_seeds("uff");
    let written = Written {
        kind: 5,
        even: false,
        ..sweep("x", &[1.5; 20])
    };
    seeds.extend([
        written.ascii(),
        written.binary(true, false),
        sweep("y", &[2.5; 9]).binary(false, true),
    ]);
    seeds.push(
        [
            sweep("x", &[1.0; 7]).ascii(),
            sweep("y", &[2.0; 7]).ascii(),
            written.ascii(),
        ]
        .concat(),
    );
    conformance::survive(&seeds, open, mutate_text, 40);
}

#[test]
#[ignore = "needs shared/data: conformance files of UFF"]
fn shared_data_mutated_files_are_read_or_refused() {
    let mut seeds = conformance::shared_seeds("uff_conformance", 16 << 10);
    seeds.retain(|seed| recognises(seed));
    conformance::survive(&seeds, open, mutate_text, 40);
}
