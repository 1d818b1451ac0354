//! Statistics of a channel: length, ends, sum and range.

use serde::{Serialize, Serializer};

use crate::source::{ChannelInfo, Samples};

/// A number of a channel: real, complex, or none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Number {
    /// A real number.
    Real(f64),
    /// Real and imaginary part.
    Complex(f64, f64),
    /// There is none: no samples, or text.
    None,
}

impl Serialize for Number {
    /// A number, a pair, or null; NaN is null, an infinity a text.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match *self {
            Self::Real(v) if v.is_infinite() => {
                serializer.serialize_str(if v > 0.0 { "inf" } else { "-inf" })
            }
            Self::Real(v) if v.is_nan() => serializer.serialize_none(),
            Self::Real(v) => serializer.serialize_f64(v),
            Self::Complex(re, im) => [Self::Real(re), Self::Real(im)].serialize(serializer),
            Self::None => serializer.serialize_none(),
        }
    }
}

impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match *self {
            Self::Real(v) => f.write_str(&short(v)),
            Self::Complex(re, im) => write!(
                f,
                "{}{}{}i",
                short(re),
                if im < 0.0 { "" } else { "+" },
                short(im)
            ),
            Self::None => f.write_str("-"),
        }
    }
}

/// A number with six decimals, one less for each digit before them beyond two; with a power of ten where that hides it or
/// is long.
fn short(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    if !(1e-4..1e6).contains(&size) {
        return format!("{value:.4e}");
    }
    let decimals = [1e2, 1e3, 1e4, 1e5].iter().filter(|power| size >= **power);
    let decimals = 6 - decimals.count();
    let text = format!("{value:.decimals$}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// A channel's description and statistics. Sum and range leave NaN out; `missing` counts them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Its name in the file.
    pub name: String,
    /// Its unit as the file spells it.
    pub unit: Option<String>,
    /// How it is stored: `int16`, `float64`, `complex128`, `bool`, `text`, `time`.
    #[serde(rename = "type")]
    pub stored: String,
    /// Number of samples.
    pub samples: u64,
    /// Samples per second, Hz.
    pub sample_rate_hz: Option<f64>,
    /// The first sample.
    pub first: Number,
    /// The last sample.
    pub last: Number,
    /// The sum.
    pub sum: Number,
    /// The least (of complex numbers the least real part).
    pub min: Number,
    /// The greatest (of complex numbers the greatest real part).
    pub max: Number,
    /// How many samples are not a number.
    #[serde(skip_serializing_if = "is_zero")]
    pub missing: u64,
    /// Start of the acquisition, if the file states it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_time: Option<String>,
    /// First and last text of a channel of texts, shortened.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub texts: Option<[String; 2]>,
}

fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// Describe a channel and its samples.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("run.csv");
/// # std::fs::write(&path, "t [s],x [mm]\n0,1\n0.5,\n1,5\n")?;
/// use labfiles::summary::{Number, summarise};
/// let source = labfiles::open(&path)?;
/// let x = summarise(&source.datasets()[0].channels[1], &source.read(0, &[1])?[0]);
/// assert_eq!((x.samples, x.missing, x.sum), (3, 1, Number::Real(6.0)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn summarise(info: &ChannelInfo, samples: &Samples) -> Summary {
    let mut summary = Summary {
        name: info.name.clone(),
        unit: info.unit.clone(),
        stored: info.stored.name(),
        samples: samples.len() as u64,
        sample_rate_hz: info.sample_rate_hz,
        first: Number::None,
        last: Number::None,
        sum: Number::None,
        min: Number::None,
        max: Number::None,
        missing: 0,
        start_time: info.start_time.clone(),
        texts: None,
    };
    match samples {
        Samples::Real(values) => real(&mut summary, values),
        Samples::Complex(values) => complex(&mut summary, values),
        Samples::Text(values) => {
            let ends = values.first().zip(values.last());
            summary.texts = ends.map(|(first, last)| [first, last].map(|t| shortened(t)));
        }
    }
    summary
}

/// Characters of a text that a summary shows.
const SHOWN: usize = 40;

fn shortened(text: &str) -> String {
    let text = text.trim();
    if text.chars().count() <= SHOWN {
        return text.to_owned();
    }
    text.chars().take(SHOWN).chain(['…']).collect()
}

fn real(summary: &mut Summary, values: &[f64]) {
    let (Some(first), Some(last)) = (values.first(), values.last()) else {
        return;
    };
    let tally = Tally::of(values.iter().copied());
    summary.first = Number::Real(*first);
    summary.last = Number::Real(*last);
    summary.sum = Number::Real(tally.sum);
    summary.missing = values.len() as u64 - tally.count;
    if tally.count > 0 {
        summary.min = Number::Real(tally.min);
        summary.max = Number::Real(tally.max);
    }
}

fn complex(summary: &mut Summary, values: &[(f64, f64)]) {
    let (Some(first), Some(last)) = (values.first(), values.last()) else {
        return;
    };
    let re = Tally::of(values.iter().map(|v| v.0));
    let im = Tally::of(values.iter().map(|v| v.1));
    summary.first = Number::Complex(first.0, first.1);
    summary.last = Number::Complex(last.0, last.1);
    summary.sum = Number::Complex(re.sum, im.sum);
    summary.missing = values.len() as u64 - re.count.min(im.count);
    if re.count > 0 {
        summary.min = Number::Real(re.min);
        summary.max = Number::Real(re.max);
    }
}

/// Sum and range of the numbers that are numbers.
struct Tally {
    count: u64,
    sum: f64,
    min: f64,
    max: f64,
}

impl Tally {
    /// The sum carries its rounding along (Neumaier 1974).
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut all = Self {
            count: 0,
            sum: 0.0,
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
        };
        let mut lost = 0.0;
        for value in values.filter(|v| !v.is_nan()) {
            let sum = all.sum + value;
            lost += if all.sum.abs() >= value.abs() {
                (all.sum - sum) + value
            } else {
                (value - sum) + all.sum
            };
            all.sum = sum;
            all.count += 1;
            all.min = all.min.min(value);
            all.max = all.max.max(value);
        }
        if all.sum.is_finite() && lost.is_finite() {
            all.sum += lost;
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::StoredType;

    fn info(stored: StoredType) -> ChannelInfo {
        ChannelInfo {
            name: "x".into(),
            unit: None,
            stored,
            samples: 0,
            sample_rate_hz: None,
            start_time: None,
            clock: crate::source::Clock::Shared,
            start_s: None,
            properties: Default::default(),
        }
    }

    #[test]
    fn numbers_of_alike_sizes_are_written_alike() {
        for (value, text) in [
            (1_002.897_79, "1002.8978"),
            (-1_002.0, "-1002"),
            (-9e-4, "-0.0009"),
            (-0.0012, "-0.0012"),
            (0.1, "0.1"),
            (123_456.78, "123456.78"),
            (5e-5, "5.0000e-5"),
            (2e6, "2.0000e6"),
            (0.0, "0"),
        ] {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn statistics_leave_nan_out_and_keep_the_sum_exact() {
        let samples = Samples::Real(vec![1e16, 1.0, f64::NAN, -1e16]);
        let s = summarise(&info(StoredType::Float(64)), &samples);
        assert_eq!(
            (s.sum, s.min, s.max),
            (Number::Real(1.0), Number::Real(-1e16), Number::Real(1e16))
        );
        assert_eq!((s.samples, s.missing), (4, 1));
        let json = serde_json::to_value(&s).unwrap();
        assert_eq!(json["type"], "float64");
        assert_eq!(json["last"], -1e16);
    }

    #[test]
    fn complex_and_empty_channels() {
        let s = summarise(
            &info(StoredType::Complex(32)),
            &Samples::Complex(vec![(1.0, 2.0), (3.0, -4.0)]),
        );
        let json = serde_json::to_value(&s).unwrap();
        assert_eq!(json["type"], "complex64");
        assert_eq!(json["sum"], serde_json::json!([4.0, -2.0]));
        assert_eq!(s.last.to_string(), "3-4i");
        let s = summarise(&info(StoredType::Int(16)), &Samples::Real(Vec::new()));
        assert_eq!(
            serde_json::to_value(&s).unwrap()["first"],
            serde_json::Value::Null
        );
    }
}
