//! Headings and numbers with commas between commas, as `PASCO Capstone` writes them: `Time (s), Run #1`, `0,05`.

use crate::text::decode;

/// The names of a heading in which a comma before a blank is part of a name, if it has so many names; none where a
/// quote tells what belongs to a name.
pub(super) fn names(line: &[u8], columns: usize) -> Option<Vec<String>> {
    let names = split(line)?;
    let bare = line.split(|b| *b == b',').count() == names.len();
    (!bare && columns > 1 && names.len() == columns).then_some(names)
}

/// A row of numbers whose decimal marks are commas too: below a heading of half as many names every second cell has
/// digits alone, and the others are whole numbers.
pub(super) fn are_decimals(heading: &[u8], row: &[u8]) -> bool {
    let Some(names) = split(heading) else {
        return false;
    };
    let cells: Vec<&[u8]> = row.split(|b| *b == b',').map(<[u8]>::trim_ascii).collect();
    let digits = |cell: &[u8]| !cell.is_empty() && cell.iter().all(u8::is_ascii_digit);
    let pairs = cells.chunks_exact(2);
    let whole = |cell: &[u8]| digits(cell.strip_prefix(b"-").unwrap_or(cell));
    let of_words = names.iter().all(|n| n.starts_with(char::is_alphabetic));
    of_words
        && pairs.remainder().is_empty()
        && pairs.len() == names.len()
        && pairs.into_iter().all(|p| whole(p[0]) && digits(p[1]))
}

/// The names between commas before which no blank follows; `None` where there are quotes.
fn split(line: &[u8]) -> Option<Vec<String>> {
    if line.contains(&b'"') {
        return None;
    }
    let mut names: Vec<String> = Vec::new();
    for cell in decode(line).split(',') {
        match names.last_mut().filter(|_| cell.starts_with(' ')) {
            Some(name) => {
                name.push(',');
                name.push_str(cell);
            }
            None => names.push(cell.to_owned()),
        }
    }
    names
        .iter_mut()
        .for_each(|name| *name = name.trim().to_owned());
    Some(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comma_before_a_blank_is_part_of_a_name() {
        let line = b"Time (s), Run #1,Position, Red (m), Run #1";
        let expected = ["Time (s), Run #1", "Position, Red (m), Run #1"].map(str::to_owned);
        assert_eq!(names(line, 2), Some(expected.to_vec()));
        assert_eq!(names(line, 3), None);
        // one name to a cell, whatever blanks are before it
        assert_eq!(names(b"a, b, c", 3), None);
        assert_eq!(names(b"a,b", 2), None);
    }

    #[test]
    fn commas_in_numbers_are_told_by_the_heading() {
        let heading = b"Time (s), Run #1,Position (m), Run #1";
        assert!(are_decimals(heading, b"0,05,-0,123"));
        assert!(are_decimals(b"Time (s),Position (m)", b"0,05,0,123"));
        assert!(!are_decimals(heading, b"0.05,0.123"));
        assert!(!are_decimals(b"a,b,c,d", b"0,5,1,2"));
        assert!(!are_decimals(heading, b"0,-5,1,2"));
    }
}
