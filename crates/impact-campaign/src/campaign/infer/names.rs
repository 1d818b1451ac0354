//! Settings that the names of files state: `run_9.4Hz_1.65mm_up.mat`.

use std::path::Path;

/// Part of the files whose names must state a length.
const MOSTLY: f64 = 0.8;
/// Units of length in names, lower case.
const UNITS: [&str; 4] = ["mm", "um", "µm", "cm"];
/// Fewest files.
const FEWEST: usize = 4;

/// That the names of files state lengths, which may be their clearances; none where few do, or all state one.
pub(super) fn note(files: &[&Path]) -> Option<String> {
    let stem = |file: &&Path| file.file_stem().map(|s| s.to_string_lossy().to_lowercase());
    let stated: Vec<String> = files
        .iter()
        .filter_map(stem)
        .filter_map(|s| length(&s))
        .collect();
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

/// The first number in a name with a unit of length behind it.
fn length(name: &str) -> Option<String> {
    let of = |unit: &str| {
        name.match_indices(unit).find_map(|(at, _)| {
            let ends = !name[at + unit.len()..].starts_with(char::is_alphabetic);
            let before = name[..at].trim_end_matches([' ', '_', '-']);
            let digit = |c: char| c.is_ascii_digit() || matches!(c, '.' | ',' | 'p');
            let number = &before[before.trim_end_matches(digit).len()..];
            let counts = number.starts_with(|c: char| c.is_ascii_digit());
            (ends && counts).then(|| format!("{number} {unit}"))
        })
    };
    UNITS.into_iter().find_map(of)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(names: &[&str]) -> Option<String> {
        note(&names.iter().map(Path::new).collect::<Vec<_>>())
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
        assert_eq!(length("spalt_2p4mm_ab").as_deref(), Some("2p4 mm"));
        assert_eq!(of(&["r1.csv", "r2.csv", "r3.csv", "r4.csv"]), None);
        assert_eq!(of(&["x_5mm_1", "x_5mm_2", "x_5mm_3", "x_5mm_4"]), None);
        assert_eq!(of(&["hammer1", "hammer2", "commute 3", "3 mmol"]), None);
    }
}
