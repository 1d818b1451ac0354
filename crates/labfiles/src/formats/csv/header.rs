//! Names, units and remarks before a table's first row.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::attribute;
use crate::formats::csv::commas;
use crate::formats::csv::dialect::{COMMENTS, Dialect, is_value};
use crate::text::cells::{Cells, Separator, decode_cell};
use crate::text::{decode, number};
use crate::timing::{is_time_name, is_unit_of_time};
use crate::units::{parse_unit, split_at_comma, split_at_slash, without_slash};

/// What the lines before the first row state.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Header {
    /// Names of the columns, as many as there are columns.
    pub names: Vec<String>,
    /// Units of the columns.
    pub units: Vec<Option<String>>,
    /// Remarks of the form `key: value`, `key = value` or a row of two cells.
    pub attributes: BTreeMap<String, String>,
    /// Whether rows begin with an empty cell below the keys of a preamble.
    pub empty_first: bool,
}

/// Units that occur in headers though no channel of the rig is measured in them.
const FURTHER_UNITS: [&str; 25] = [
    "Pa", "kPa", "MPa", "bar", "°C", "C", "degC", "K", "A", "mA", "W", "J", "l", "ml", "Ohm", "Ω",
    "dB", "m²", "Nm", "-", "counts", "h", "px", "pixel", "pixels",
];

/// Read the lines before the first row. `lines` are all of them, comments too, blank ones not; `filled` are
/// the columns that rows fill. Gives the number of columns as well: those that are filled or named.
pub(crate) fn read(lines: &[&[u8]], dialect: &Dialect, filled: Range<usize>) -> (Header, usize) {
    let mut header = Header::default();
    let (comments, plain): (Vec<&[u8]>, Vec<&[u8]>) = lines.iter().partition(|l| is_comment(l));
    let keyed = keyed_above(&plain, filled.len());
    let mut rows: Vec<Vec<String>> = if keyed.is_empty() {
        plain.iter().map(|l| heading(l, dialect)).collect()
    } else {
        Vec::new()
    };
    header.empty_first = !keyed.is_empty() && filled.start == 1;
    let traces = traces_of(&keyed);
    let traces = vec![String::new(); filled.start].into_iter().chain(traces);
    let traces: Vec<String> = traces.take(filled.end).collect();
    header.attributes.extend(attributes_of(keyed));
    let filled = filled.end;
    take_values(&mut rows, filled, dialect, &mut header.attributes);
    let named = rows
        .iter()
        .map(|row| filled_cells(row))
        .filter(|n| *n <= dialect.columns);
    let columns = named
        .max()
        .unwrap_or(0)
        .max(filled)
        .clamp(1, dialect.columns.max(1));
    let dialect = &Dialect {
        columns,
        ..*dialect
    };
    of_logger(&mut rows);
    below_units(&mut rows, dialect.columns, &mut header.attributes);
    let units = units_row(&rows, dialect.columns);
    let alone = units.is_some() && units_alone(&rows);
    if units.is_some() && !alone {
        rows.pop();
    }
    let vernier = rows
        .first()
        .is_some_and(|row| row[0].starts_with("Vernier Format"));
    if alone {
        header.names = rows.pop().unwrap_or_default();
        name_by_preamble(&rows, &mut header.names);
    } else if let Some(names) = grouped_names(&rows, dialect.columns) {
        header.names = names;
        rows.truncate(rows.len() - 2);
    } else if let Some(names) = names_row(&rows, dialect.columns, vernier) {
        header.names = rows.remove(names);
    } else if let Some(names) = commented_names(&comments, dialect) {
        header.names = names;
    } else {
        header.names = traces;
    }
    if header.names.iter().take(2).eq(["Frame", "Sub Frame"]) {
        header.attributes.extend(rate_above(&rows));
    }
    for mut row in rows {
        row.truncate(filled_cells(&row));
        match &row[..] {
            [key, markers @ ..] if key == MARKERS => {
                header.attributes.insert(key.clone(), markers.join("\t"));
            }
            // Sampling rate; 2500; Hz
            [key, number, unit] if is_number(number) => {
                remark(&format!("{key}={number} {unit}"), &mut header.attributes);
            }
            [key, value] => remark(&format!("{key}={value}"), &mut header.attributes),
            [line] => remark(&keyed_alone(line), &mut header.attributes),
            _ => remark(&row.join(" "), &mut header.attributes),
        }
    }
    for comment in comments {
        let text = decode(comment.trim_ascii_start());
        remark(
            text.trim_start_matches(|c: char| COMMENTS.contains(&(c as u8))),
            &mut header.attributes,
        );
    }
    name_columns(&mut header, &units.unwrap_or_default(), dialect.columns);
    of_motion_capture(&mut header);
    (header, columns)
}

/// Whether a text is a number with either decimal mark.
fn is_number(text: &str) -> bool {
    let number = |mark| number::parse_cell(text.as_bytes(), mark).is_some_and(f64::is_finite);
    number(b'.') || number(b',')
}

/// Whether a row is a key, a number and its unit: `Abtastintervall;0,5;ms`.
fn is_keyed_quantity(row: &[String]) -> bool {
    match row {
        [key, number, unit] => {
            !key.is_empty() && !is_number(key) && is_number(number) && parse_unit(unit).is_some()
        }
        _ => false,
    }
}

/// A line above one column of numbers, whose cells nothing separates, as `key=number unit` where it is a key, a number and a
/// unit between separators: `Abtastintervall;0,5;ms`.
fn keyed_alone(line: &str) -> String {
    let parted = [';', '\t', ','].into_iter().find_map(|separator| {
        let cells: Vec<&str> = line.split(separator).map(str::trim).collect();
        match cells[..] {
            [key, number, unit] if is_number(number) => Some(format!("{key}={number} {unit}")),
            [key, number] if is_number(number) => Some(format!("{key}={number}")),
            _ => None,
        }
    });
    parted.unwrap_or_else(|| line.to_owned())
}

/// Fewest lines of a key and its value that are a preamble.
const FEWEST_PAIRS: usize = 3;

/// A key of a preamble and its values: one, or one for each column.
type Keyed = (String, Vec<String>);

/// The keys and values of the lines `"key",value` above columns of numbers, of which no line is the heading: above one column,
/// or above several where a line names the trace of each; none where they are few.
fn keyed_above(plain: &[&[u8]], signals: usize) -> Vec<Keyed> {
    let keyed = |line: &&[u8]| {
        let cells = Cells::new(line, Separator::Byte(b',')).map(decode_cell);
        let cells: Vec<String> = cells.collect();
        let (key, values) = cells.split_first()?;
        let word = key.starts_with(char::is_alphabetic) && !values.is_empty();
        // a key may have no value, and a comma may end each line
        let values = &values[..filled_cells(values)];
        let given = values.len() <= signals && values.iter().all(|v| !v.is_empty());
        let key = key.trim_end_matches(':').to_owned();
        (word && given).then(|| (key, values.to_vec()))
    };
    let above = plain.iter().rev().skip_while(|line| says_data(line));
    let mut all: Vec<Keyed> = above.map_while(keyed).collect();
    if all.first().is_some_and(|(_, values)| values.is_empty()) {
        // a heading
        return Vec::new();
    }
    all.retain(|(_, values)| !values.is_empty());
    let named = all
        .iter()
        .any(|(key, names)| TRACES.contains(&key.as_str()) && names.len() == signals);
    if all.len() < FEWEST_PAIRS || !(signals == 1 || named) {
        Vec::new()
    } else {
        all
    }
}

/// Whether a line says that the data follow: `data:`, `Waveform Data,`.
fn says_data(line: &[u8]) -> bool {
    let line = decode(line).to_lowercase();
    let said = line.trim().trim_end_matches([',', ':']);
    said == "data" || said == "waveform data"
}

/// The keys by which Yokogawa and GW Instek name the traces, and those of their units.
const TRACES: [&str; 2] = ["TraceName", "Source"];
const TRACE_UNITS: [&str; 2] = ["VUnit", "Vertical Units"];

/// The headings that a preamble gives the columns: names and units.
fn traces_of(keyed: &[Keyed]) -> Vec<String> {
    let stated = |keys: [&str; 2]| {
        let found = keyed.iter().find(|(key, _)| keys.contains(&key.as_str()));
        found.map_or(&[][..], |(_, values)| values)
    };
    let units = stated(TRACE_UNITS);
    let name = |(i, name): (usize, &String)| match units.get(i) {
        Some(unit) => format!("{} [{}]", name.trim(), unit.trim()),
        None => name.trim().to_owned(),
    };
    stated(TRACES).iter().enumerate().map(name).collect()
}

/// Keys and values as attributes: what is alike for all columns once.
fn attributes_of(keyed: Vec<Keyed>) -> impl Iterator<Item = (String, String)> {
    keyed.into_iter().map(|(key, mut values)| {
        values.dedup();
        (key, values.join(", "))
    })
}

/// Leave of the four lines that head a table of Campbell loggers those with names and units, and none of the units of stamps
/// and row numbers.
fn of_logger(rows: &mut Vec<Vec<String>>) {
    let is_one = rows.len() == 4 && rows[0].first().is_some_and(|cell| cell == "TOA5");
    if !is_one {
        return;
    }
    rows.truncate(3);
    for unit in rows[2]
        .iter_mut()
        .filter(|u| ["TS", "RN"].contains(&u.as_str()))
    {
        unit.clear();
    }
}

/// The rate that stands alone in a line above a table of trajectories.
fn rate_above(rows: &[Vec<String>]) -> Option<(String, String)> {
    let mut alone = rows.iter().filter(|row| filled_cells(row) == 1);
    let rate = alone.find(|row| number::parse_cell(row[0].as_bytes(), b'.').is_some())?;
    Some(("sample_rate_hz".to_owned(), rate[0].clone()))
}

/// Whether the row of units heads the table by itself, below a preamble of keys and values that does not name the
/// columns.
fn units_alone(rows: &[Vec<String>]) -> bool {
    const NAMING: [&str; 5] = ["source", "label", "trace", "channel", "x"];
    let [preamble @ .., units] = rows else {
        return false;
    };
    let Some(key) = preamble.last().and_then(|row| row.first()) else {
        return false;
    };
    let lower = key.to_lowercase();
    let names = is_time_name(key) || NAMING.iter().any(|word| lower.starts_with(word));
    let pair = |row: &Vec<String>| filled_cells(row) == 2 && !row[0].is_empty();
    // Second, not ms
    let spelled = |unit: &String| is_time_name(unit) && unit.chars().count() > 2;
    let time = units.first().is_some_and(spelled);
    preamble.len() > FEWEST_PAIRS && preamble.iter().all(pair) && time && !names
}

/// Name the columns behind the time by the channels of the preamble: `Vertical Units,CH1:V` names `Volt`.
fn name_by_preamble(rows: &[Vec<String>], names: &mut [String]) {
    let mut keyed = rows.iter().filter_map(|row| row.split_first());
    let Some((_, stated)) = keyed.find(|(key, _)| key.eq_ignore_ascii_case("vertical units"))
    else {
        return;
    };
    let channels = stated.iter().filter_map(|cell| cell.split_once(':'));
    let channels: Vec<&str> = channels.map(|(channel, _)| channel.trim()).collect();
    let signals = filled_cells(names).saturating_sub(1);
    if channels.len() == signals && channels.iter().all(|c| !c.is_empty()) {
        let named = names.iter_mut().skip(1).zip(channels);
        named.for_each(|(name, channel)| *name = channel.to_owned());
    }
}

/// Number of cells up to the last that is filled.
fn filled_cells(row: &[String]) -> usize {
    row.iter().rposition(|c| !c.is_empty()).map_or(0, |i| i + 1)
}

/// Take values out of headings that are wider than the rows: `tInc = 4e-9`, or a name above its value, as
/// oscilloscopes write start and increment.
fn take_values(
    rows: &mut [Vec<String>],
    filled: usize,
    dialect: &Dialect,
    attributes: &mut BTreeMap<String, String>,
) {
    let is_number =
        |text: &String| number::parse_cell(text.as_bytes(), dialect.notation.decimal).is_some();
    for row in rows.iter_mut() {
        for cell in row.iter_mut().skip(filled).filter(|c| c.contains('=')) {
            remark(cell, attributes);
            cell.clear();
        }
    }
    for at in 1..rows.len() {
        let (above, below) = rows.split_at_mut(at);
        let (Some(names), Some(values)) = (above.last_mut(), below.first_mut()) else {
            continue;
        };
        if is_keyed_quantity(values) {
            continue;
        }
        for (name, value) in names.iter_mut().zip(values).skip(filled) {
            if !name.is_empty() && !is_number(name) && !value.is_empty() && is_number(value) {
                attributes.insert(std::mem::take(name), std::mem::take(value));
            }
        }
    }
}

/// The row that names the markers of a table of their positions.
const MARKERS: &str = "MARKER_NAMES";

/// Tables of marker positions state their rate as FREQUENCY, and have mm.
fn of_motion_capture(header: &mut Header) {
    if !header.attributes.contains_key("NO_OF_FRAMES") {
        return;
    }
    if let Some(rate) = header.attributes.get("FREQUENCY").cloned() {
        header.attributes.insert("sample_rate_hz".to_owned(), rate);
    }
    let markers = header.attributes.get(MARKERS).map_or("", String::as_str);
    let markers: Vec<&str> = markers.split('\t').filter(|m| !m.is_empty()).collect();
    let unnamed = header.names.iter().all(|name| name.starts_with("column_"));
    if unnamed && 3 * markers.len() == header.names.len() {
        let axes = markers
            .iter()
            .flat_map(|m| ["X", "Y", "Z"].map(|axis| format!("{m} {axis}")));
        header.names = axes.collect();
    }
    for (name, unit) in header.names.iter().zip(&mut header.units) {
        let position = [" X", " Y", " Z"].iter().any(|axis| name.ends_with(axis));
        if unit.is_none() && position {
            *unit = Some("mm".to_owned());
        }
    }
}

fn is_comment(line: &[u8]) -> bool {
    line.trim_ascii_start()
        .first()
        .is_some_and(|b| COMMENTS.contains(b))
}

fn cells(line: &[u8], dialect: &Dialect) -> Vec<String> {
    Cells::new(line, dialect.separator)
        .map(decode_cell)
        .collect()
}

/// The cells of a line above the table; between commas a name may contain some.
fn heading(line: &[u8], dialect: &Dialect) -> Vec<String> {
    let by_comma = dialect.separator == Separator::Byte(b',');
    let joined = by_comma.then(|| commas::names(line, dialect.columns));
    joined.flatten().unwrap_or_else(|| cells(line, dialect))
}

/// Whether a row of cells can head the table: its width, give or take an empty cell at the end.
fn fits(row: &[String], columns: usize) -> bool {
    let filled = filled_cells(row);
    let wide = row.len() == columns || row.len() == columns + 1;
    filled == columns || (wide && (1..columns).contains(&filled))
}

/// Lines above the table among which its heading is looked for.
const HEADING_LINES: usize = 4;

/// The row that heads the table: of the last ones that fit, the one with most distinct columns; of those alike
/// the last, or the `first`, where short names follow.
fn names_row(rows: &[Vec<String>], columns: usize, first: bool) -> Option<usize> {
    let distinct = |row: &Vec<String>| {
        let filled = row.iter().filter(|c| !c.is_empty());
        filled.collect::<std::collections::BTreeSet<_>>().len()
    };
    let from = rows.len().saturating_sub(HEADING_LINES);
    let place = |i: usize| if first { rows.len() - i } else { i };
    (from..rows.len())
        .filter(|i| fits(&rows[*i], columns))
        .max_by_key(|i| (distinct(&rows[*i]), place(*i)))
}

/// Names that come again and again below a row with one cell above each of several groups of columns, as a sheet
/// with runs side by side has them: `t Throw 1`, `y Throw 1`, `t Throw 2` ….
fn grouped_names(rows: &[Vec<String>], columns: usize) -> Option<Vec<String>> {
    let [.., groups, names] = rows else {
        return None;
    };
    let filled = |row: &[String]| row.iter().filter(|c| !c.is_empty()).count();
    let repeated = |row: &[String]| {
        row.iter()
            .enumerate()
            .any(|(i, c)| !c.is_empty() && row[..i].contains(c))
    };
    let above =
        groups.len() <= columns + 1 && filled(groups) > 1 && 2 * filled(groups) <= filled(names);
    if !fits(names, columns) || !above || repeated(groups) || !repeated(names) {
        return None;
    }
    let mut group = "";
    let named = names.iter().enumerate().map(|(i, name)| {
        group = groups.get(i).filter(|g| !g.is_empty()).map_or(group, |g| g);
        if name.is_empty() {
            String::new()
        } else {
            format!("{name} {group}").trim().to_owned()
        }
    });
    Some(named.collect())
}

/// The last row, if it holds units under a row of names.
fn units_row(rows: &[Vec<String>], columns: usize) -> Option<Vec<Option<String>>> {
    let [.., names, units] = rows else {
        return None;
    };
    if !fits(names, columns) || !fits(units, columns) {
        return None;
    }
    let filled: Vec<&String> = units.iter().filter(|c| !c.is_empty()).collect();
    let known = filled.iter().filter(|c| is_unit(unwrapped(c))).count();
    (known > 0 && 2 * known >= filled.len()).then(|| {
        units
            .iter()
            // the numbers of the rows
            .map(|c| Some(unwrapped(c).to_owned()).filter(|u| !u.is_empty() && u != "Sequence"))
            .collect()
    })
}

/// Take out the line below one of units, the time's among them, and their names, as loggers state the rate of each column there.
fn below_units(
    rows: &mut Vec<Vec<String>>,
    columns: usize,
    attributes: &mut BTreeMap<String, String>,
) {
    let Some((last, above)) = rows.split_last() else {
        return;
    };
    let timed = above.last().is_some_and(|row| {
        let mut cells = row.iter().filter(|cell| !cell.is_empty());
        cells.clone().any(|cell| is_unit_of_time(unwrapped(cell)))
            && cells.all(|cell| is_unit(unwrapped(cell)))
    });
    if timed && units_row(above, columns).is_some() && units_row(rows, columns).is_none() {
        last.iter().for_each(|cell| remark(cell, attributes));
        rows.pop();
    }
}

/// Names in the last comment before the table, if it has as many words as columns.
fn commented_names(comments: &[&[u8]], dialect: &Dialect) -> Option<Vec<String>> {
    let last = comments.last()?.trim_ascii_start();
    let body = last
        .iter()
        .position(|b| !COMMENTS.contains(b))
        .map(|i| &last[i..])?;
    let names = cells(body.trim_ascii(), dialect);
    let words = names
        .iter()
        .all(|n| !n.is_empty() && !is_value(n.as_bytes(), dialect.notation));
    (names.len() == dialect.columns
        && words
        && (names.len() > 1 || !names[0].contains([':', '=', ' '])))
    .then_some(names)
}

fn remark(text: &str, attributes: &mut BTreeMap<String, String>) {
    let text = text.trim();
    let pair = text.split_once('=').or_else(|| text.split_once(':'));
    // of a table of one column, in which no mark separates cells
    let cells = || {
        let cells = text.split_once([',', ';', '\t']);
        cells.filter(|(key, _)| attribute::states_rate(key))
    };
    let Some((key, value)) = pair.or_else(cells) else {
        return;
    };
    let (key, value) = (key.trim(), value.trim());
    if !key.is_empty() && key.len() <= 80 && !value.is_empty() {
        attributes.insert(key.to_owned(), value.to_owned());
    }
}

/// Whether a text is the symbol of a unit.
fn is_unit(text: &str) -> bool {
    let text = text.trim();
    parse_unit(text).is_some() || FURTHER_UNITS.contains(&text) || is_unit_of_time(text)
}

/// A unit without the brackets around it.
fn unwrapped(text: &str) -> &str {
    let text = text.trim();
    text.strip_prefix('[')
        .and_then(|t| t.strip_suffix(']'))
        .or_else(|| text.strip_prefix('(').and_then(|t| t.strip_suffix(')')))
        .unwrap_or(text)
        .trim()
}

/// A heading such as `velocity_x [mm/s]`, `h0 cm`, `Position (m) Run 1`, `x / mm`, `v/(m/s)`, `Zeit in s` or `Load, lbf` as name and unit.
///
/// Empty brackets at its end state that there is no unit: `mass (kg) []`.
pub fn name_and_unit(heading: &str) -> (String, Option<String>) {
    let heading = heading.trim();
    if let Some(name) = heading.strip_suffix("[]") {
        return (name.trim_end().to_owned(), None);
    }
    for (open, close, any) in [('[', ']', true), ('(', ')', false)] {
        let Some(from) = heading.rfind(open) else {
            continue;
        };
        let Some(length) = heading[from..].find(close) else {
            continue;
        };
        let unit = heading[from + 1..from + length].trim();
        let before = without_slash(&heading[..from]);
        let name = [before, heading[from + length + 1..].trim()].join(" ");
        if !unit.is_empty() && (any || is_unit(unit)) && !name.trim().is_empty() {
            return (name.trim().to_owned(), Some(unit.to_owned()));
        }
    }
    for between in [" / ", " in "] {
        let parts = heading.rsplit_once(between);
        if let Some((name, unit)) = parts.filter(|(_, unit)| is_unit(unit)) {
            return (name.trim().to_owned(), Some(unit.trim().to_owned()));
        }
    }
    if let Some((name, unit)) = split_at_slash(heading).or_else(|| split_at_comma(heading)) {
        return (name.to_owned(), Some(unit.to_owned()));
    }
    let parts = heading.rsplit_once(' ');
    if let Some((name, unit)) = parts.filter(|(_, unit)| LENGTHS.contains(unit)) {
        return (name.trim_end().to_owned(), Some(unit.to_owned()));
    }
    (heading.to_owned(), None)
}

/// Units of length that are no words nor names of channels, so that they may follow a name without a bracket (`h0 cm`).
const LENGTHS: [&str; 4] = ["cm", "mm", "µm", "um"];

/// A name without a number at its end, and that: `y 2`, `y2`.
pub(crate) fn without_number(name: &str) -> (String, String) {
    let bare = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let trimmed = bare.trim_end_matches([' ', '_', '#', '.', '-']);
    (trimmed.to_owned(), name[bare.len()..].to_owned())
}

/// Fill names and units up to the number of columns; repeated names gain a number.
fn name_columns(header: &mut Header, units: &[Option<String>], columns: usize) {
    let headings = std::mem::take(&mut header.names);
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for i in 0..columns {
        let (mut name, unit) = headings
            .get(i)
            .map(|h| name_and_unit(h))
            .unwrap_or_default();
        if name.is_empty() {
            name = format!("column_{}", i + 1);
        }
        let times = seen
            .entry(name.clone())
            .and_modify(|n| *n += 1)
            .or_insert(1);
        if *times > 1 {
            name = format!("{name} {times}");
        }
        header.names.push(name);
        header.units.push(units.get(i).cloned().flatten().or(unit));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::number::Notation;

    const SEMICOLON: Dialect = Dialect {
        separator: Separator::Byte(b';'),
        notation: Notation {
            decimal: b',',
            groups: false,
        },
        columns: 3,
    };

    fn header(lines: &[&str]) -> Header {
        read(
            &lines.iter().map(|l| l.as_bytes()).collect::<Vec<_>>(),
            &SEMICOLON,
            0..3,
        )
        .0
    }

    #[test]
    fn headings_give_names_and_units() {
        for (heading, name, unit) in [
            ("velocity_x [mm/s]", "velocity_x", Some("mm/s")),
            ("velocity_x (mm/s)", "velocity_x", Some("mm/s")),
            ("Position (m) Run 1", "Position Run 1", Some("m")),
            ("Force (Trigger)", "Force (Trigger)", None),
            ("x / mm", "x", Some("mm")),
            ("t/s", "t", Some("s")),
            ("v / (m/s)", "v", Some("m/s")),
            ("v/m/s", "v", Some("m/s")),
            ("m/s", "m/s", None),
            ("left/right", "left/right", None),
            ("Zeit in s", "Zeit", Some("s")),
            ("mass x in motion in mm/s", "mass x in motion", Some("mm/s")),
            ("signal in channel 1", "signal in channel 1", None),
            ("length in", "length in", None),
            ("in V", "in V", None),
            ("Blue:Acceleration - x", "Blue:Acceleration - x", None),
            ("[V]", "[V]", None),
            ("mass (kg) []", "mass (kg)", None),
        ] {
            assert_eq!(
                name_and_unit(heading),
                (name.into(), unit.map(Into::into)),
                "{heading}"
            );
        }
    }

    #[test]
    fn units_in_a_second_line_and_remarks() {
        let h = header(&[
            "# clearance_m: 0.001",
            "Operator;Novák",
            "t;x;x",
            "s;mm;[mm/s]",
        ]);
        assert_eq!(h.names, ["t", "x", "x 2"]);
        assert_eq!(
            h.units,
            [Some("s".into()), Some("mm".into()), Some("mm/s".into())]
        );
        assert_eq!(h.attributes["clearance_m"], "0.001");
        assert_eq!(h.attributes["Operator"], "Novák");
    }

    #[test]
    fn a_line_below_that_of_units_is_no_heading() {
        let h = header(&[
            "Zeit;Weg;Kraft",
            "s;mm;N",
            "Rate: 50 Hz;Rate: 50 Hz;Rate: 50 Hz",
        ]);
        assert_eq!(h.names, ["Zeit", "Weg", "Kraft"]);
        assert_eq!(h.units[1].as_deref(), Some("mm"));
        assert_eq!(h.attributes["Rate"], "50 Hz");
    }

    #[test]
    fn of_two_heading_lines_the_one_that_tells_columns_apart_is_taken() {
        assert_eq!(
            header(&["Run 1;Run 1;Run 1", "t;x;y"]).names,
            ["t", "x", "y"]
        );
        assert_eq!(header(&["t;x;y", "Run 1;Run 1;"]).names, ["t", "x", "y"]);
        assert_eq!(
            header(&["Frame;X1;Y1", "Tracks 1 to 1"]).names,
            ["Frame", "X1", "Y1"]
        );
    }

    #[test]
    fn a_row_wider_than_the_table_is_not_its_heading() {
        let lines = ["Segment;Time;Count;Of", "t;x;y"];
        assert_eq!(header(&lines).names, ["t", "x", "y"]);
    }

    #[test]
    fn positions_without_a_heading_have_the_names_of_their_markers() {
        let found = header(&["NO_OF_FRAMES;100", "FREQUENCY;500", "MARKER_NAMES;cart"]);
        assert_eq!(found.names, ["cart X", "cart Y", "cart Z"]);
        assert_eq!(found.units[0].as_deref(), Some("mm"));
    }

    #[test]
    fn names_below_groups_of_columns_are_told_apart_by_them() {
        let dialect = Dialect {
            columns: 5,
            ..SEMICOLON
        };
        let lines: [&[u8]; 2] = [b"Throw 1;;;Throw 2;", b"t [s];y [m];;t [s];y [m]"];
        let (found, _) = read(&lines, &dialect, 0..5);
        assert_eq!(
            found.names,
            [
                "t Throw 1",
                "y Throw 1",
                "column_3",
                "t Throw 2",
                "y Throw 2"
            ]
        );
        assert_eq!(found.units[4].as_deref(), Some("m"));
    }

    #[test]
    fn names_in_a_comment_or_none_at_all() {
        assert_eq!(
            header(&["# made by hand", "# t;x;y"]).names,
            ["t", "x", "y"]
        );
        assert_eq!(header(&[]).names, ["column_1", "column_2", "column_3"]);
    }
}
