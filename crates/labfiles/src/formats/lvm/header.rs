//! What the headers of a `LabVIEW` measurement file state on a table and its channels.

use std::collections::BTreeMap;

use crate::formats::lvm::scan::{FIRST_WORDS, Keys, Segment};
use crate::text::cells::Separator;
use crate::text::{clock, number};

/// What a column of a table holds.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Column {
    /// X values for the channels from this number on.
    X(usize),
    /// The channel of this number.
    Y(usize),
    /// Remarks.
    Comment,
}

/// The value of a header key for a channel; a single value holds for all.
pub(super) fn value_for(keys: &Keys, key: &str, n: usize) -> Option<String> {
    let values: Vec<&String> = keys.get(key)?.iter().collect();
    let packed: Vec<&String> = values.iter().copied().filter(|v| !v.is_empty()).collect();
    // With an X column for each channel the header has an empty cell for each of them.
    let sparse = values.iter().filter(|v| !v.is_empty()).count() * 2 <= values.len() + 1;
    let found = if sparse { packed.get(n) } else { values.get(n) };
    found
        .or(packed.first().filter(|_| packed.len() == 1))
        .map(|v| (*v).clone())
        .filter(|v| !v.is_empty())
}

/// A number with either decimal mark.
pub(super) fn decimal_any(text: &str) -> Option<f64> {
    number::parse_cell(text.as_bytes(), b'.').or_else(|| number::parse_cell(text.as_bytes(), b','))
}

/// Whether the X values of a channel are points in time, as they are if nothing is stated.
pub(super) fn x_is_time(segment: &Segment, n: usize) -> bool {
    value_for(&segment.keys, "X_Dimension", n).is_none_or(|d| d.trim() == "Time")
}

/// The number of channels that a table's header states.
pub(super) fn stated_channels(segment: &Segment) -> Option<usize> {
    let stated: usize = segment.keys.get("Channels")?.first()?.trim().parse().ok()?;
    // More channels than the header has cells for are no channels.
    let cells = segment.keys.values().map(Vec::len).max().unwrap_or(0);
    Some(stated.min(cells))
}

/// The decimal mark that the header states; a header without it leaves it to the rows.
pub(super) fn decimal(keys: &Keys, separator: Separator, head: &[u8]) -> u8 {
    let stated = keys
        .get("Decimal_Separator")
        .and_then(|v| v.iter().find(|v| !v.is_empty()));
    match stated.and_then(|v| v.bytes().next()) {
        Some(mark @ (b'.' | b',')) => mark,
        _ if separator != Separator::Byte(b',')
            && head.contains(&b',')
            && !head.contains(&b'.') =>
        {
            b','
        }
        _ => b'.',
    }
}

/// The unit of the X values of a channel.
pub(super) fn x_unit(segment: &Segment, n: usize) -> Option<String> {
    match value_for(&segment.keys, "X_Dimension", n)?.trim() {
        "Time" => Some("s".to_owned()),
        "Frequency" => Some("Hz".to_owned()),
        _ => None,
    }
}

/// Date and time of a header as ISO 8601.
pub(super) fn start_time(keys: &Keys, n: usize) -> Option<String> {
    let date = value_for(keys, "Date", n)?.replace('/', "-");
    let time = value_for(keys, "Time", n)?.replace(',', ".");
    Some(format!("{date}T{time}"))
}

/// Whether the header states another step for a channel than for the first.
pub(super) fn has_own_step(segment: &Segment, n: usize) -> bool {
    let step = |n: usize| decimal_any(&value_for(&segment.keys, "Delta_X", n)?);
    step(n)
        .zip(step(0))
        .is_some_and(|(own, first)| (own / first - 1.0).abs() > STEPS_DIFFER)
}

/// Relative difference of steps that their rounding does not explain: half a unit of the third digit of 1.00.
const STEPS_DIFFER: f64 = 5e-3;

/// When the clocks of channels begin, s after that of the first: by their dates and times, and by `X0` where
/// there is no X column. Absolute X values begin with 1904 for all.
pub(super) fn starts_s(
    keys: &Keys,
    segment: &Segment,
    shown: &[(usize, Column)],
) -> Vec<Option<f64>> {
    let absolute = keys
        .get("Time_Pref")
        .and_then(|v| v.first())
        .is_some_and(|v| v == "Absolute");
    let has_x = |n: usize| shown.iter().any(|(_, c)| *c == Column::X(n));
    let stamp = |n: usize| clock::parse(&start_time(&segment.keys, n)?, false);
    let origin = stamp(0);
    let of = |n: usize| {
        let x0 = |n: usize| decimal_any(&value_for(&segment.keys, "X0", n)?);
        let x0 = match (has_x(0), n > 0 && has_x(n)) {
            (_, true) => 0.0,
            (true, false) => x0(n).zip(x0(0)).map_or(0.0, |(own, first)| own - first),
            (false, false) => x0(n)?,
        };
        let after = match (origin, stamp(n)) {
            (Some(origin), Some(stamp)) if !absolute => stamp.since(origin),
            _ => 0.0,
        };
        Some(x0 + after).filter(|s| s.is_finite())
    };
    let start = |(_, column): &(usize, Column)| match column {
        Column::Y(n) => of(*n),
        Column::X(_) | Column::Comment => None,
    };
    shown.iter().map(start).collect()
}

/// What the headers state on the whole table.
pub(super) fn attributes(keys: &Keys, segment: &Segment) -> BTreeMap<String, String> {
    let own = [
        "Notes",
        "Test_Name",
        "Test_Numbers",
        "Test_Series",
        "UUT_Name",
        "UUT_M/N",
        "UUT_S/N",
    ];
    let of_segment = segment
        .keys
        .iter()
        .filter(|(k, _)| own.contains(&k.as_str()));
    keys.iter()
        .filter(|(k, _)| !matches!(k.as_str(), FIRST_WORDS | "Separator" | "Decimal_Separator"))
        .chain(of_segment)
        .map(|(k, v)| (k.clone(), v.join(" ").trim().to_owned()))
        .filter(|(_, v)| !v.is_empty())
        .collect()
}
