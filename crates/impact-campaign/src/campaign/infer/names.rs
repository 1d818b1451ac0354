//! Settings that the names of files state: `run_9.4Hz_1.65mm_up.mat`.

use std::fmt::Write as _;
use std::path::Path;

use super::globs::slashed;
use crate::campaign::run_table::in_english;

/// Part of the files whose names must state a length.
const MOSTLY: f64 = 0.8;
/// Units of length in names, lower case, and their mm.
const LENGTHS: [(&str, f64); 4] = [("mm", 1.0), ("um", 1e-3), ("µm", 1e-3), ("cm", 10.0)];
/// Units of frequency in names, lower case, and their Hz.
const FREQUENCIES: [(&str, f64); 1] = [("hz", 1.0)];
/// Fewest files.
const FEWEST: usize = 4;

/// That the names of files state lengths, which may be their clearances; none where few do, or all state one.
pub(super) fn note(files: &[&Path]) -> Option<String> {
    let stated = files.iter().filter_map(|file| {
        let length = quantity(&lower(file), &LENGTHS)?;
        Some(format!("{} {}", length.number, length.unit))
    });
    let stated: Vec<String> = stated.collect();
    let mut distinct = stated.clone();
    distinct.sort();
    distinct.dedup();
    let mostly = stated.len() as f64 >= MOSTLY * files.len() as f64;
    let [first, second, ..] = &distinct[..] else {
        return None;
    };
    (mostly && files.len() >= FEWEST).then(|| {
        format!(
            "the names of the files state lengths ({first}, {second} …), which are not read: if they are the clearances, write \
             them into a run table with the columns file, clearance_mm and sweep"
        )
    })
}

/// The run table that the names of files state: each a length, which may be its clearance, and a frequency, and where it
/// does, whether the frequency rose or fell.
pub(super) fn table(files: &[&Path]) -> Option<String> {
    let mut text = String::from("file,drive_frequency_hz,clearance_mm,sweep\n");
    for file in files {
        let name = lower(file);
        let clearance_mm = quantity(&name, &LENGTHS)?.value;
        let frequency_hz = quantity(&name, &FREQUENCIES)?.value;
        let path = slashed(file).replace('"', "\"\"");
        let sweep = sweep(&name).unwrap_or_default();
        let _ = writeln!(text, "\"{path}\",{frequency_hz},{clearance_mm},{sweep}");
    }
    (files.len() >= FEWEST).then_some(text)
}

fn lower(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default();
    stem.to_string_lossy().to_lowercase()
}

/// Whether a name has a word for a rising or a falling frequency.
fn sweep(name: &str) -> Option<String> {
    let words = name.split(|c: char| !c.is_alphabetic());
    let mut words = words.filter(|w| !w.is_empty()).map(in_english);
    words.find(|word| ["up", "down"].contains(&word.as_str()))
}

/// A quantity that a name states.
struct Named<'a> {
    /// As written.
    number: String,
    unit: &'a str,
    /// In the first of the units that were looked for.
    value: f64,
}

/// The first number in a name with one of the units behind it.
fn quantity<'a>(name: &str, units: &[(&'a str, f64)]) -> Option<Named<'a>> {
    units.iter().find_map(|(unit, factor)| {
        name.match_indices(unit).find_map(|(at, _)| {
            let ends = !name[at + unit.len()..].starts_with(char::is_alphabetic);
            let before = name[..at].trim_end_matches([' ', '_', '-']);
            let digit = |c: char| c.is_ascii_digit() || matches!(c, '.' | ',' | 'p');
            let number = &before[before.trim_end_matches(digit).len()..];
            let number = number.trim_start_matches(['.', ',', 'p']);
            let value: f64 = number.replace([',', 'p'], ".").parse().ok()?;
            ends.then(|| Named {
                number: number.to_owned(),
                unit,
                value: factor * value,
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths<'a>(names: &'a [&'a str]) -> Vec<&'a Path> {
        names.iter().map(|name| Path::new(*name)).collect()
    }

    fn of(names: &[&str]) -> Option<String> {
        note(&paths(names))
    }

    #[test]
    fn lengths_in_most_names_are_told() {
        let named = [
            "a_9.4Hz_1.65mm_up.mat",
            "a_9.8Hz_1.65mm_up.mat",
            "a_9.4Hz_3.3mm_up.mat",
            "a_9.8Hz_3.3mm.mat",
        ];
        let told = of(&named).expect("a note");
        assert!(told.contains("1.65 mm, 3.3 mm"), "{told}");
        let length = quantity("spalt_2p4mm_ab", &LENGTHS).expect("a length");
        let found = (length.number.as_str(), length.unit, length.value);
        assert_eq!(found, ("2p4", "mm", 2.4));
        assert_eq!(of(&["r1.csv", "r2.csv", "r3.csv", "r4.csv"]), None);
        assert_eq!(of(&["x_5mm_1", "x_5mm_2", "x_5mm_3", "x_5mm_4"]), None);
        assert_eq!(of(&["hammer1", "hammer2", "commute 3", "3 mmol"]), None);
    }

    #[test]
    fn names_that_state_each_setting_are_a_run_table() {
        let named = [
            "f9,4Hz_spalt1,65mm_auf.lvm",
            "f9,8Hz_spalt1,65mm_auf.lvm",
            "sub/f9.8Hz_spalt500um_ab.lvm",
            "run1_9.4Hz_3.3mm.lvm",
        ];
        let table = table(&paths(&named)).expect("a table");
        let expected = "file,drive_frequency_hz,clearance_mm,sweep\n\
                        \"f9,4Hz_spalt1,65mm_auf.lvm\",9.4,1.65,up\n\
                        \"f9,8Hz_spalt1,65mm_auf.lvm\",9.8,1.65,up\n\
                        \"sub/f9.8Hz_spalt500um_ab.lvm\",9.8,0.5,down\n\
                        \"run1_9.4Hz_3.3mm.lvm\",9.4,3.3,\n";
        assert_eq!(table, expected);
        // one of them states no frequency
        let some = ["9Hz_1mm", "10Hz_1mm", "11Hz_1mm", "1mm"];
        assert_eq!(super::table(&paths(&some)), None);
        assert_eq!(super::table(&paths(&some[..3])), None);
    }
}
