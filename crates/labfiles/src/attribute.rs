//! What the attributes of a file, a group or a comment state: rates, start times, lists of names.

use std::collections::BTreeMap;

use crate::source::{ChannelInfo, StoredType};
use crate::units::{Dimension, parse_unit};

/// Attribute names that give samples per second, lower case.
const RATE_KEYS: [&str; 11] = [
    "sample_rate_hz",
    "sample_rate",
    "samplerate",
    "sampling_rate_hz",
    "sampling_rate",
    "sampling_frequency_hz",
    "sampling_frequency",
    "rate_hz",
    "rate",
    "fs_hz",
    "fs",
];
/// Attribute names that give the time between two samples, lower case.
const STEP_KEYS: [&str; 9] = [
    "dt",
    "dt_s",
    "delta_t",
    "delta_x",
    "time_step",
    "sample_interval",
    "sample_interval_s",
    "sampling_interval",
    "wf_increment",
];
/// Attribute names that give the start of the acquisition, lower case.
const START_KEYS: [&str; 7] = [
    "start_time",
    "start",
    "t0",
    "timestamp",
    "acquisition_start",
    "date_time",
    "datetime",
];

/// Samples per second that the attributes state, Hz: as a rate or as a time step, in the unit
/// after the number or in `<name>_unit(s)`.
///
/// ```
/// let stated = |pairs: &[(&str, &str)]| {
///     let all = pairs.iter().map(|(name, value)| (name.to_string(), value.to_string()));
///     labfiles::attribute::sample_rate_hz(&all.collect())
/// };
/// assert_eq!(stated(&[("Sample Rate", "2 kHz")]), Some(2000.0));
/// assert_eq!(stated(&[("dt", "0.5"), ("dt_units", "ms")]), Some(2000.0));
/// assert_eq!(stated(&[("operator", "A")]), None);
/// ```
pub fn sample_rate_hz(attributes: &BTreeMap<String, String>) -> Option<f64> {
    let rate = RATE_KEYS
        .iter()
        .find_map(|k| quantity(attributes, k, Dimension::Frequency));
    let step = || {
        STEP_KEYS
            .iter()
            .find_map(|k| quantity(attributes, k, Dimension::Time))
    };
    rate.or_else(|| step().map(|s| 1.0 / s))
        .filter(|r| r.is_finite() && *r > 0.0)
}

/// The start of the acquisition as the attributes spell it, under `start_time`, `t0` and the like.
pub fn start_time(attributes: &BTreeMap<String, String>) -> Option<String> {
    START_KEYS
        .iter()
        .find_map(|k| lookup(attributes, k))
        .map(|(_, v)| v.clone())
}

fn lookup<'a>(
    attributes: &'a BTreeMap<String, String>,
    key: &str,
) -> Option<(&'a String, &'a String)> {
    attributes.iter().find(|(k, _)| same_key(k, key))
}

/// Whether two attribute names differ only in case, blanks and hyphens.
fn same_key(a: &str, b: &str) -> bool {
    let plain = |c: char| {
        if matches!(c, ' ' | '-') {
            '_'
        } else {
            c.to_ascii_lowercase()
        }
    };
    a.trim().chars().map(plain).eq(b.chars())
}

/// A number of a dimension in SI (frequencies in Hz): a bare number is SI already.
fn quantity(attributes: &BTreeMap<String, String>, key: &str, wanted: Dimension) -> Option<f64> {
    let (name, text) = lookup(attributes, key)?;
    let (number, beside) = number_and_unit(text)?;
    let companion = ["unit", "units"]
        .iter()
        .find_map(|s| attributes.get(&format!("{name}_{s}")).map(String::as_str));
    let unit = Some(beside).filter(|u| !u.is_empty()).or(companion);
    match unit {
        None => Some(number),
        Some(symbol) => {
            let unit = parse_unit(symbol).filter(|u| u.dimension == wanted)?;
            Some(number * unit.to_si)
        }
    }
}

/// `2000 Hz` as a number and a unit (empty where none is written).
fn number_and_unit(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let (number, taken) = crate::text::number::parse_prefix(text.as_bytes(), b'.')
        .filter(|&(_, n)| text.as_bytes().get(n) != Some(&b','))
        .or_else(|| crate::text::number::parse_prefix(text.as_bytes(), b','))?;
    Some((number, text[taken..].trim()))
}

/// Names of time axes, lower case; `time…` counts as well.
const TIME_NAMES: [&str; 11] = [
    "t",
    "zeit",
    "temps",
    "tempo",
    "tiempo",
    "čas",
    "cas",
    "x_value",
    "timestamp",
    "elapsed",
    "date",
];

/// Whether a name is that of a time axis.
pub(crate) fn is_time_name(name: &str) -> bool {
    let lower = name.trim().to_lowercase();
    let word = lower.split([' ', '_', ':']).next().unwrap_or_default();
    word == "time" || TIME_NAMES.contains(&word) || TIME_NAMES.contains(&lower.as_str())
}

/// Whether a channel is a time axis by its name, with a unit of time or none.
pub fn is_time_axis(channel: &ChannelInfo) -> bool {
    let unit = channel.unit.as_deref();
    let time = unit.is_none_or(|u| parse_unit(u).is_some_and(|u| u.dimension == Dimension::Time));
    time && is_time_name(&channel.name) && channel.stored != StoredType::Text
}

/// The parts of `a, b, c`, `a; b` or `["a", "b"]`.
///
/// ```
/// assert_eq!(labfiles::attribute::list("[\"x\", 'y']"), ["x", "y"]);
/// assert_eq!(labfiles::attribute::list("x; y"), ["x", "y"]);
/// ```
pub fn list(text: &str) -> Vec<String> {
    let inner = text.trim().trim_start_matches('[').trim_end_matches(']');
    let mark = if inner.contains(';') && !inner.contains(',') {
        ';'
    } else {
        ','
    };
    inner
        .split(mark)
        .map(|part| part.trim().trim_matches(['"', '\'']).to_owned())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(pairs: &[(&str, &str)]) -> BTreeMap<String, String> {
        pairs
            .iter()
            .map(|(k, v)| ((*k).to_owned(), (*v).to_owned()))
            .collect()
    }

    #[test]
    fn rates_however_they_are_stated() {
        for (pairs, rate) in [
            (&[("sample_rate_hz", "2000")][..], Some(2000.0)),
            (&[("Sample Rate", "2 kHz")], Some(2000.0)),
            (&[("dt", "0,0005")], Some(2000.0)),
            (&[("dt", "0.5"), ("dt_units", "ms")], Some(2000.0)),
            (&[("fs", "0")], None),
            (&[("rate", "2000 mm")], None),
            (&[("clearance_m", "1")], None),
        ] {
            assert_eq!(sample_rate_hz(&map(pairs)), rate, "{pairs:?}");
        }
    }

    #[test]
    fn lists_of_names() {
        assert_eq!(list("a, b,c"), ["a", "b", "c"]);
        assert_eq!(list("[\"a\", 'b']"), ["a", "b"]);
        assert_eq!(list("a; b"), ["a", "b"]);
    }
}
