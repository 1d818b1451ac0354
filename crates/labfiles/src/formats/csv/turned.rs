//! Tables that lie on their side: each line is a quantity, with its name and unit in the first cell.

use crate::text::number;
use crate::timing::numbers_rows;
use crate::units::{Dimension, parse_unit, split_unit};

/// Bytes of the longest table that is turned, and its fewest lines and cells behind the name.
pub(super) const MOST_BYTES: usize = 1 << 13;
const FEWEST_LINES: usize = 2;
const FEWEST_CELLS: usize = 3;
/// Stems of words that name a height where no unit is stated, lower case.
const HEIGHTS: [&str; 6] = ["height", "höhe", "hoehe", "drop", "rebound", "bounce"];
/// Words in the first cell of a line that numbers the columns, lower case.
const NUMBERING: [&str; 10] = [
    "trial", "drop", "throw", "run", "test", "no", "versuch", "nr", "wurf", "messung",
];

/// The table with its lines as columns, separated by semicolons or tabs as they were; `None` where it stands upright.
///
/// Each line must begin with the name of a quantity, in a unit of length or time or called a height, before numbers. A line above
/// them may name the columns; a unit that all its names have is that of lines without one.
pub(super) fn upright(text: &str) -> Option<String> {
    let separator = [';', '\t', ','].into_iter().find(|s| text.contains(*s))?;
    let lines = text.lines().filter(|l| !l.trim().is_empty());
    let mut rows: Vec<Vec<&str>> = lines
        .map(|line| line.split(separator).map(bare).collect())
        .collect();
    let width = rows.iter().map(|row| filled(row)).max()?;
    rows.iter_mut().for_each(|row| row.resize(width, ""));
    let mark = if separator == ',' {
        b'.'
    } else {
        decimal_mark(text)
    };
    let names: Vec<&str> = rows.first()?.iter().skip(1).copied().collect();
    let headed = names
        .iter()
        .any(|name| value(name, mark).is_none() && !name.is_empty());
    let numbered = |row: &[&str]| numbers_columns(row[0]) || numbers_rows(row[0]);
    let skipped = usize::from(headed || numbered(&rows[0]));
    let quantities = &rows[skipped..];
    let unit = common_unit(&names).filter(|_| headed);
    let whole = quantities.len() >= FEWEST_LINES && width > FEWEST_CELLS;
    if !whole || !quantities.iter().all(|row| is_quantity(row, unit, mark)) {
        return None;
    }
    let named = |row: &Vec<&str>| match (unit, split_unit(row[0]).1) {
        (Some(unit), None) => format!("{} ({unit})", row[0]),
        _ => row[0].to_owned(),
    };
    let mut table: Vec<Vec<String>> = vec![quantities.iter().map(named).collect()];
    for column in 1..width {
        table.push(
            quantities
                .iter()
                .map(|row| row[column].to_owned())
                .collect(),
        );
    }
    let joined = table.iter().map(|row| row.join(&separator.to_string()));
    Some(joined.collect::<Vec<_>>().join("\n") + "\n")
}

/// A cell without blanks and quotes around it.
fn bare(cell: &str) -> &str {
    cell.trim().trim_matches('"').trim()
}

/// The number of cells up to the last that is filled.
fn filled(row: &[&str]) -> usize {
    row.iter().rposition(|c| !c.is_empty()).map_or(0, |i| i + 1)
}

/// The decimal mark of a table whose cells no comma separates.
fn decimal_mark(text: &str) -> u8 {
    let digit_beside = |at: usize| {
        let before = text[..at].ends_with(|c: char| c.is_ascii_digit());
        before && text[at + 1..].starts_with(|c: char| c.is_ascii_digit())
    };
    let comma = text.match_indices(',').any(|(at, _)| digit_beside(at));
    if comma { b',' } else { b'.' }
}

fn value(cell: &str, mark: u8) -> Option<f64> {
    number::parse_cell(cell.as_bytes(), mark).filter(|v| v.is_finite())
}

/// Whether a cell is a word that numbers the columns.
fn numbers_columns(cell: &str) -> bool {
    let lower = cell.to_lowercase();
    let word = lower.trim_matches(|c: char| !c.is_alphanumeric());
    NUMBERING.contains(&word)
}

/// The unit that all names have.
fn common_unit<'a>(names: &[&'a str]) -> Option<&'a str> {
    let mut units = names
        .iter()
        .filter(|n| !n.is_empty())
        .map(|n| split_unit(n).1);
    let first = units.next()??;
    units.all(|unit| unit == Some(first)).then_some(first)
}

/// Whether a line is a quantity: the name of a length, a time or a height, and numbers alone behind it.
fn is_quantity(row: &[&str], unit: Option<&str>, mark: u8) -> bool {
    let name = row[0].to_lowercase();
    let dimension = split_unit(row[0]).1.or(unit).and_then(parse_unit);
    let measured = dimension.map(|u| u.dimension);
    let known = matches!(measured, Some(Dimension::Length | Dimension::Time))
        || HEIGHTS.iter().any(|word| name.contains(word));
    let cells = row[1..].iter().filter(|c| !c.is_empty());
    let numbers = cells.clone().filter(|c| value(c, mark).is_some()).count();
    let word = row[0].starts_with(char::is_alphabetic);
    word && known && numbers >= FEWEST_CELLS - 1 && numbers == cells.count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_quantities_become_columns() {
        let two = "Drop height (cm),40,60,80\nRebound height (cm),24.4,36.5,48.6\n";
        let upright_two = "Drop height (cm),Rebound height (cm)\n40,24.4\n60,36.5\n80,48.6\n";
        assert_eq!(upright(two).as_deref(), Some(upright_two));
        let german = "Versuch;1;2;3\nFallhöhe (cm);40;60;80\nSprunghöhe (cm);24,4;36,5;48,6\n";
        let upright_german = "Fallhöhe (cm);Sprunghöhe (cm)\n40;24,4\n60;36,5\n80;48,6\n";
        assert_eq!(upright(german).as_deref(), Some(upright_german));
        let trials = ",Trial 1 (cm),Trial 2 (cm),Trial 3 (cm)\nDrop height,120,120,120\nRebound 1,73,74,72\n";
        let upright_trials = "Drop height (cm),Rebound 1 (cm)\n120,73\n120,74\n120,72\n";
        assert_eq!(upright(trials).as_deref(), Some(upright_trials));
    }

    #[test]
    fn other_tables_stay_as_they_are() {
        for text in [
            "Drop height (cm),Rebound height (cm)\n40,24.4\n60,36.5\n",
            "Surface,Drop height (cm),Rebound (cm),Mass (g)\noak,100,61,5\nsteel,100,81,5\n",
            "Time (s),0.1,0.2\n0.0,1,2\n",
            "Sampling rate,2000\nx,y\n1,2\n",
            "bounce,height (cm)\n0,100\n1,64\n",
            "",
        ] {
            assert_eq!(upright(text), None, "{text}");
        }
    }
}
