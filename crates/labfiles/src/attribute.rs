//! What the attributes of a file, a group or a comment state: rates, start times, lists of names.

use std::collections::BTreeMap;

use crate::text::number;
use crate::units::{Dimension, parse_split_unit, split_unit};

/// Attribute names that give samples per second, lower case.
const RATE_KEYS: &[&str] = &[
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
    "frame_rate",
    "framerate",
    "capture_rate",
    "acquisition_rate",
    "abtastrate",
    "abtastfrequenz",
    "scan_rate",
];
/// Attribute names that give the time between two samples, lower case.
const STEP_KEYS: &[&str] = &[
    "dt",
    "dt_s",
    "delta_t",
    "delta_x",
    "time_step",
    "sample_interval",
    "sample_interval_s",
    "sampling_interval",
    "wf_increment",
    "increment",
    "tinc",
    "x_increment",
    "xincrement",
    "xinc",
    "sample_period",
    "sampling_period",
    "time_interval",
    "abtastintervall",
];
/// One that does only with a unit of time behind the number, as Hantek writes it, lower case.
const CLOCK_KEY: &str = "clock";

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
/// after the number, in `<name>_unit(s)` or in the name.
///
/// ```
/// let stated = |pairs: &[(&str, &str)]| {
///     let all = pairs.iter().map(|(name, value)| (name.to_string(), value.to_string()));
///     labfiles::attribute::sample_rate_hz(&all.collect())
/// };
/// assert_eq!(stated(&[("Sample Rate", "2 kHz")]), Some(2000.0));
/// assert_eq!(stated(&[("dt", "0.5"), ("dt_units", "ms")]), Some(2000.0));
/// assert_eq!(stated(&[("dt_ms", "0.5")]), Some(2000.0));
/// assert_eq!(stated(&[("operator", "A")]), None);
/// ```
pub fn sample_rate_hz(attributes: &BTreeMap<String, String>) -> Option<f64> {
    sample_rate_beside(attributes, None)
}

/// The same beside numbers whose decimal mark is known: `2,000 Hz` beside decimal points is 2 kHz. Where it is not known,
/// such a rate is none.
pub(crate) fn sample_rate_beside(
    attributes: &BTreeMap<String, String>,
    decimal: Option<u8>,
) -> Option<f64> {
    let of = |keys: &[&str], wanted: Dimension| {
        keys.iter()
            .find_map(|k| quantity(attributes, k, wanted, decimal))
    };
    let step = || {
        of(STEP_KEYS, Dimension::Time)
            .or_else(|| clock_s(attributes))
            .map(f64::recip)
    };
    let rate = of(RATE_KEYS, Dimension::Frequency).or_else(step);
    rate.filter(|r| r.is_finite() && *r > 0.0)
}

/// The step of a clock that states its unit, s.
fn clock_s(attributes: &BTreeMap<String, String>) -> Option<f64> {
    let (_, text) = lookup(attributes, CLOCK_KEY)?;
    let (number, unit) = number_and_unit(text, Some(b'.'))?;
    Some(number * factor(unit, Dimension::Time)?)
}

/// How many samples each stored one stands for, where the attributes state that samples were left out.
pub fn decimation(attributes: &BTreeMap<String, String>) -> Option<f64> {
    let keys = [
        "decimation",
        "decimation_factor",
        "downsampling",
        "downsample",
    ];
    let (_, text) = keys.iter().find_map(|key| lookup(attributes, key))?;
    let (number, unit) = number_and_unit(text, Some(b'.'))?;
    (unit.is_empty() && number > 1.0).then_some(number)
}

/// Whether an attribute of this name states a rate or a time step.
pub(crate) fn states_rate(name: &str) -> bool {
    let mut keys = RATE_KEYS.iter().chain(STEP_KEYS);
    keys.any(|key| same_key(name, key) || unit_in_name(name, key).is_some())
}

/// Attribute names that give the time of a channel's first sample, lower case.
const OFFSET_KEYS: [&str; 12] = [
    "wf_start_offset",
    "start_offset",
    "start_offset_s",
    "time_offset",
    "t0",
    "t0_s",
    "t_0",
    "t_start",
    "tstart",
    "start_s",
    "start_time_s",
    "x0",
];

/// When a channel's first sample was taken, s, as its attributes state it: a point in time, a time after it,
/// or both together; points in time count from 1970.
pub fn start_s(attributes: &BTreeMap<String, String>) -> Option<f64> {
    let origin = crate::text::clock::Stamp {
        days: Some(0),
        ..Default::default()
    };
    let texts = [
        "wf_start_time",
        "start_time",
        "acquisition_start",
        "timestamp",
    ];
    let texts = texts.iter().find_map(|k| lookup(attributes, k));
    let stamp = texts.and_then(|(_, text)| crate::text::clock::parse(text, false));
    let stamp = stamp.map(|s| s.since(origin));
    let numbers = OFFSET_KEYS.iter().chain(&["start_time", "start"]);
    let offset = numbers
        .copied()
        .find_map(|k| quantity(attributes, k, Dimension::Time, None));
    match (stamp, offset) {
        (None, None) => None,
        (stamp, offset) => Some(stamp.unwrap_or(0.0) + offset.unwrap_or(0.0)),
    }
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

/// Whether two attribute names differ only in case, blanks, hyphens and a colon at the end.
fn same_key(a: &str, b: &str) -> bool {
    let plain = |c: char| {
        if matches!(c, ' ' | '-') {
            '_'
        } else {
            c.to_ascii_lowercase()
        }
    };
    let a = a.trim_end_matches([' ', ':']).trim_start();
    a.chars().map(plain).eq(b.chars())
}

/// The unit after a key in an attribute's name: `dt_ms`, `Sample Interval [ms]`.
fn unit_in_name<'a>(name: &'a str, key: &str) -> Option<&'a str> {
    let (bare, unit) = split_unit(name);
    unit.filter(|_| same_key(bare, key))
}

/// A number of a dimension in SI (frequencies in Hz): a bare number is SI already.
fn quantity(
    attributes: &BTreeMap<String, String>,
    key: &str,
    wanted: Dimension,
    decimal: Option<u8>,
) -> Option<f64> {
    let has_unit = |name: &str| unit_in_name(name, key).is_some();
    let by_name = || attributes.iter().find(|(name, _)| has_unit(name));
    let (name, text) = lookup(attributes, key).or_else(by_name)?;
    let (number, beside) = number_and_unit(text, decimal)?;
    let companion = ["unit", "units"]
        .iter()
        .find_map(|s| attributes.get(&format!("{name}_{s}")).map(String::as_str));
    let unit = Some(beside)
        .filter(|u| !u.is_empty())
        .or(companion)
        .or_else(|| unit_in_name(name, key));
    match unit {
        None => Some(number),
        Some(symbol) => {
            // a sentence may follow: `8000 Hz. Sample values on linear scale.`
            let first = symbol.split_whitespace().next().unwrap_or(symbol);
            let first = first.trim_end_matches(['.', ',', ';']);
            let factor = factor(symbol, wanted).or_else(|| factor(first, wanted))?;
            Some(number * factor)
        }
    }
}

/// The factor to SI of a unit of a dimension.
fn factor(symbol: &str, wanted: Dimension) -> Option<f64> {
    let rate = samples_per_second(symbol).filter(|_| wanted == Dimension::Frequency);
    // oscilloscopes print uS for microseconds
    let lower = symbol.to_lowercase();
    let capital = wanted == Dimension::Time && ["us", "ms", "ns", "s"].contains(&lower.as_str());
    let symbol = if capital { lower.as_str() } else { symbol };
    let unit = || parse_split_unit(symbol).filter(|u| u.dimension == wanted);
    rate.or_else(|| unit().map(|u| u.to_si))
}

/// Samples per second in a unit of rates as oscilloscopes print it: `kSa/s`, `MS/s`, `samples/s`.
fn samples_per_second(symbol: &str) -> Option<f64> {
    const RATES: [&str; 9] = [
        "Sa/s",
        "S/s",
        "samples/s",
        "Samples/s",
        "scans/s",
        "Scans/s",
        "sps",
        "SPS",
        "1/s",
    ];
    let of = |text: &str| RATES.contains(&text.trim());
    [("", 1.0), ("k", 1e3), ("K", 1e3), ("M", 1e6), ("G", 1e9)]
        .iter()
        .find(|(prefix, _)| symbol.trim().strip_prefix(prefix).is_some_and(of))
        .map(|(_, factor)| *factor)
}

/// `2000 Hz` as a number and a unit (empty where none is written). A mark before groups of three digits separates
/// thousands where it is not the decimal mark of the numbers beside it; where that mark is not known, a comma there may be
/// either.
fn number_and_unit(text: &str, decimal: Option<u8>) -> Option<(f64, &str)> {
    let text = text.trim();
    let is_number = |c: char| c.is_ascii_digit() || number::GROUP_MARKS.contains(&c);
    let (written, unit) = text.split_at(text.find(|c| !is_number(c)).unwrap_or(text.len()));
    let grouped = |mark: u8| {
        let plain = !unit.starts_with(['e', 'E']);
        plain.then(|| number::parse_grouped(written.trim().as_bytes(), mark))?
    };
    let both = [b'.', b',']
        .into_iter()
        .filter_map(grouped)
        .find(|(_, both)| *both);
    if let Some((number, _)) = both.or_else(|| grouped(decimal?)) {
        return Some((number, unit));
    }
    if decimal.is_none() && grouped(b'.').is_some() {
        return None;
    }
    let (number, taken) = number::parse_prefix(text.as_bytes(), b'.')
        .filter(|&(_, n)| text.as_bytes().get(n) != Some(&b','))
        .or_else(|| number::parse_prefix(text.as_bytes(), b','))?;
    Some((number, text[taken..].trim()))
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
            (&[("Sampling Rate", "2.5 kSa/s")], Some(2500.0)),
            (&[("Sample rate (kHz)", "2.5")], Some(2500.0)),
            (&[("Sample Interval [ms]", "0.4")], Some(2500.0)),
            (&[("Increment", "4e-4")], Some(2500.0)),
            (&[("dt", "0.5"), ("dt_units", "ms")], Some(2000.0)),
            (&[("dt_ms", "0.4")], Some(2500.0)),
            (&[("fs_kHz", "2.5")], Some(2500.0)),
            (&[("increment_mm", "0.4")], None),
            (&[("Sampling rate", "0.002 MHz")], Some(2000.0)),
            (&[("sample_rate_MHz", "0.002")], Some(2000.0)),
            (&[("sample_rate_mhz", "0.002")], None),
            (
                &[("sample_rate", "0.002"), ("sample_rate_unit", "MHz")],
                Some(2000.0),
            ),
            (&[("Sample rate", "2,000 Hz")], None),
            (&[("Sample rate", "2,000.00 Hz")], Some(2000.0)),
            (&[("Sample rate", "0,500 kHz")], Some(500.0)),
            (&[("Scan rate", "2000 scans/s")], Some(2000.0)),
            (&[("Time interval :", "0.50000mS")], Some(2000.0)),
            (
                &[("Sample Rate", "8000 Hz. Sample values on linear scale.")],
                Some(8000.0),
            ),
            (&[("fs", "0")], None),
            (&[("rate", "2000 mm")], None),
            (&[("clearance_m", "1")], None),
        ] {
            assert_eq!(sample_rate_hz(&map(pairs)), rate, "{pairs:?}");
        }
    }

    #[test]
    fn thousands_of_a_rate_are_separated_as_the_numbers_beside_it_are_written() {
        for (text, decimal, rate) in [
            ("2,000 Hz", b'.', 2000.0),
            ("2.000 Hz", b',', 2000.0),
            ("2,000 Hz", b',', 2.0),
            ("2.000 Hz", b'.', 2.0),
            ("51 200 Hz", b'.', 51_200.0),
            ("2'000", b'.', 2000.0),
            ("2.000,0 Hz", b',', 2000.0),
            ("0,500 kHz", b'.', 500.0),
        ] {
            let attributes = map(&[("Sample rate", text)]);
            let found = sample_rate_beside(&attributes, Some(decimal));
            assert_eq!(found, Some(rate), "{text}");
        }
    }

    #[test]
    fn lists_of_names() {
        assert_eq!(list("a, b,c"), ["a", "b", "c"]);
        assert_eq!(list("[\"a\", 'b']"), ["a", "b"]);
        assert_eq!(list("a; b"), ["a", "b"]);
    }
}
