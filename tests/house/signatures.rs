//! Signatures and names: few tuples, few booleans that choose, one name for one type. The limits only become
//! lower.

use std::collections::BTreeMap;

use super::sources::all_sources;

/// Functions that take or give a tuple of more than two.
const WIDE_TUPLES: usize = 26;
/// Functions that take arguments packed in a tuple, which they unpack: other than coordinates, arguments are
/// arguments or a struct.
const PACKED: usize = 78;
/// Choices by `match` on a boolean, and public functions that take one.
const BOOLEANS: usize = 15;
/// Names that two public types have.
const TWICE: usize = 12;

/// The signatures of a code: whether it is public, and what is between the name and the body.
fn signatures(code: &str) -> Vec<(bool, String)> {
    let mut found = Vec::new();
    for (at, _) in code.match_indices("fn ") {
        let line = code[..at].rsplit('\n').next().unwrap_or("");
        let qualified = line.split_whitespace().all(|word| {
            ["pub", "const", "async", "unsafe"].contains(&word) || word.starts_with("pub(")
        });
        if !qualified && !line.trim_start().starts_with("pub(in") {
            continue;
        }
        let mut depth = 0;
        let end = code[at..].find(|c: char| {
            depth += i32::from("([".contains(c)) - i32::from(")]".contains(c));
            depth == 0 && "{;".contains(c)
        });
        let signature = &code[at + 3..end.map_or(code.len(), |end| at + end)];
        found.push((line.trim_start().starts_with("pub "), signature.to_owned()));
    }
    found
}

/// The most types in a tuple of a signature.
fn widest_tuple(signature: &str) -> usize {
    // of each open bracket whether it may be a tuple, and its commas
    let mut open: Vec<(bool, usize)> = Vec::new();
    let (mut widest, mut before, mut last) = (0, String::new(), ' ');
    for c in signature.chars() {
        match c {
            '(' => {
                // after a name it is the list of arguments, of the function or of a closure
                let name = before
                    .trim_end()
                    .ends_with(|c: char| c.is_alphanumeric() || c == '_');
                let generic = before.trim_end().ends_with('>') && open.is_empty();
                open.push((!name && !generic, 0));
            }
            '[' | '<' | '{' => open.push((false, 0)),
            '>' if "-=".contains(last) => {}
            ')' | ']' | '>' | '}' => {
                let trailing = before.trim_end().ends_with(',');
                if let Some((true, commas)) = open.pop() {
                    widest = widest.max(commas + usize::from(!trailing));
                }
            }
            ',' => {
                if let Some(inner) = open.last_mut() {
                    inner.1 += 1;
                }
            }
            _ => {}
        }
        before.push(c);
        last = c;
    }
    widest
}

#[test]
fn signatures_have_few_wide_tuples_and_booleans() {
    let (mut wide, mut packed, mut booleans) = (Vec::new(), Vec::new(), Vec::new());
    for file in all_sources() {
        let code = file.code();
        for (public, signature) in signatures(&code) {
            let name = signature.split(['(', '<']).next().unwrap_or("").to_owned();
            let place = format!("{} {name}", file.place());
            if widest_tuple(&signature) > 2 {
                wide.push(place.clone());
            }
            if signature.contains("): (") || signature.contains("): &(") {
                packed.push(place.clone());
            }
            let arguments = signature.split("->").next().unwrap_or("");
            if public && arguments.contains(": bool") {
                booleans.push(place);
            }
        }
        let lines: Vec<&str> = code.lines().map(str::trim).collect();
        for pair in lines.windows(2) {
            let arm = pair[1].starts_with("true =>") || pair[1].starts_with("false =>");
            if arm && pair[0].contains("match ") && pair[0].ends_with('{') {
                booleans.push(file.place());
            }
        }
    }
    assert!(wide.len() <= WIDE_TUPLES, "{}: {wide:#?}", wide.len());
    assert!(packed.len() <= PACKED, "{}: {packed:#?}", packed.len());
    assert!(
        booleans.len() <= BOOLEANS,
        "{}: {booleans:#?}",
        booleans.len()
    );
}

#[test]
fn a_name_is_that_of_one_public_type() {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in all_sources() {
        for line in file.code().lines() {
            let kinds = ["pub struct ", "pub enum ", "pub trait ", "pub type "];
            let Some(rest) = kinds.iter().find_map(|kind| line.strip_prefix(kind)) else {
                continue;
            };
            let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
            let name = rest[..end.unwrap_or(rest.len())].to_owned();
            places.entry(name).or_default().push(file.place());
        }
    }
    places.retain(|_, files| files.len() > 1);
    assert!(places.len() <= TWICE, "{}: {places:#?}", places.len());
}

#[test]
fn a_tuple_is_told_from_arguments() {
    assert_eq!(widest_tuple("f(a: (u8, u8, u8), b: u8) -> (u8, u8)"), 3);
    assert_eq!(widest_tuple("f<T: Fn(u8, u8, u8)>(a: u8, b: u8, c: u8)"), 0);
    assert_eq!(widest_tuple("f(a: Vec<(u8, Vec<u8>)>) -> Result<(), E>"), 2);
}
