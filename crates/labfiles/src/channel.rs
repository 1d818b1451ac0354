//! A channel as its file describes it.

use std::collections::BTreeMap;

/// How a file stores the numbers of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StoredType {
    /// Signed integers of that many bits.
    Int(u8),
    /// Unsigned integers of that many bits.
    UInt(u8),
    /// Floating point of that many bits.
    Float(u8),
    /// Complex numbers, each part of that many bits.
    Complex(u8),
    /// True or false.
    Bool,
    /// Text.
    Text,
    /// Points in time.
    Time,
}

impl StoredType {
    /// The usual name: `int16`, `float64`, `complex128`, `bool`, `text`, `time`.
    pub(crate) fn name(self) -> String {
        match self {
            Self::Int(bits) => format!("int{bits}"),
            Self::UInt(bits) => format!("uint{bits}"),
            Self::Float(bits) => format!("float{bits}"),
            Self::Complex(bits) => format!("complex{}", 2 * u16::from(bits)),
            Self::Bool => "bool".to_owned(),
            Self::Text => "text".to_owned(),
            Self::Time => "time".to_owned(),
        }
    }
}

/// Where the times of a channel's samples are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Clock {
    /// In the time axis of its dataset, or in the rate that all of its channels share.
    #[default]
    Shared,
    /// In a time axis of its own: the channel of this index in its dataset.
    Axis(usize),
    /// In its own rate, though its dataset has a time axis.
    Rate,
}

/// A channel as its file describes it, before its samples are read.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelInfo {
    /// Name in the file, with its group where the format has groups (`group/channel`).
    pub name: String,
    /// Unit as the file spells it.
    pub unit: Option<String>,
    /// How the numbers are stored.
    pub stored: StoredType,
    /// Number of samples.
    pub samples: u64,
    /// Samples per second, Hz, if the file states it.
    pub sample_rate_hz: Option<f64>,
    /// Start of the acquisition as ISO 8601 text, if the file states it.
    pub start_time: Option<String>,
    /// Where the times of its samples are.
    pub clock: Clock,
    /// When its clock begins, s after an origin that the channels of its dataset share: of a time axis its
    /// zero, of a rate the first sample. `None`: the file does not state it.
    pub start_s: Option<f64>,
    /// All other properties the file gives, as text.
    pub properties: BTreeMap<String, String>,
}
