//! Names of records as names of files, such that every system takes them.

use std::collections::BTreeSet;

/// What Windows refuses in a name; `/` separates folders everywhere, and `:` would name a stream.
const REFUSED: [char; 9] = ['/', '\\', ':', '*', '?', '"', '<', '>', '|'];

/// Names that Windows keeps for devices, with any extension; so are COM and LPT with a digit.
const DEVICES: [&str; 6] = ["CON", "PRN", "AUX", "NUL", "CONIN$", "CONOUT$"];

/// One name per record, without extension: each once in a folder that does not tell capitals from small
/// letters.
pub(super) fn of_records<'a>(records: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut taken = BTreeSet::new();
    let mut own = |record: &str| {
        let plain = portable(record);
        let mut name = plain.clone();
        let mut number = 2;
        while !taken.insert(name.to_lowercase()) {
            name = format!("{plain}_{number}");
            number += 1;
        }
        name
    };
    records.into_iter().map(&mut own).collect()
}

/// A name in which `_` stands for what a system refuses.
fn portable(name: &str) -> String {
    let refused = |c: char| c.is_control() || REFUSED.contains(&c);
    let mut taken = name.replace(refused, "_");
    // Windows drops dots and blanks at the end
    let kept = taken.trim_end_matches(['.', ' ']).len();
    let ending = taken.split_off(kept);
    taken.extend(ending.chars().map(|_| '_'));
    if taken.is_empty() || is_device(&taken) {
        format!("_{taken}")
    } else {
        taken
    }
}

/// Whether Windows takes a name for a device's: what is before the first dot says so.
fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or("").trim_end();
    let stem = stem.to_ascii_uppercase();
    let port = ["COM", "LPT"].iter().find_map(|p| stem.strip_prefix(p));
    let numbered = port.is_some_and(|n| {
        let mut digits = n.chars();
        matches!(digits.next(), Some('1'..='9' | '¹' | '²' | '³')) && digits.next().is_none()
    });
    numbered || DEVICES.contains(&stem.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_is_refused_by_windows() {
        for (record, file) in [
            ("run1", "run1"),
            ("Messung 3.2 größer", "Messung 3.2 größer"),
            ("a/b\\c", "a_b_c"),
            ("12:30:05", "12_30_05"),
            ("what? *\"<x>|y", "what_ ___x__y"),
            ("tab\there", "tab_here"),
            ("run.", "run_"),
            ("run. .", "run___"),
            ("..", "__"),
            ("", "_"),
            ("CON", "_CON"),
            ("nul.first", "_nul.first"),
            ("aux .x", "_aux .x"),
            ("com1", "_com1"),
            ("LPT²", "_LPT²"),
            ("com", "com"),
            ("COM10", "COM10"),
            ("console", "console"),
        ] {
            assert_eq!(portable(record), file, "{record:?}");
        }
    }

    #[test]
    fn names_stay_apart_whatever_their_case() {
        let records = ["a:b", "a?b", "A_B", "a_b_2", "c"];
        let names = of_records(records);
        assert_eq!(names, ["a_b", "a_b_2", "A_B_3", "a_b_2_2", "c"]);
    }
}
