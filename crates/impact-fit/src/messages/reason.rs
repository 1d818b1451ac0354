//! What was left out of the fits, and why.

use serde::{Deserialize, Serialize};

use crate::method::Method;
use impact_records::message::Value;
use impact_records::motion::{BoundaryKind, Bracket};
use impact_records::{message_table, messages};

/// Something that a fit may leave out. Indices count from 0: records in the order of acquisition, the
/// rows of records.parquet; brackets in the order of boundaries.csv.
#[derive(
    Debug, Clone, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum Item {
    /// A record.
    Record {
        /// Index of the record.
        index: usize,
        /// Its name.
        record: String,
    },
    /// A bracket of a boundary.
    Bracket {
        /// Index of the bracket.
        index: usize,
        /// Which boundary.
        boundary: BoundaryKind,
        /// Lower drive frequency, Hz.
        frequency_low_hz: f64,
        /// Upper drive frequency, Hz.
        frequency_high_hz: f64,
        /// Half the gap, m.
        clearance_m: f64,
    },
    /// An impact of a record.
    Impact {
        /// Index of the record.
        index: usize,
        /// The record's name.
        record: String,
        /// Time since the record's first sample, s.
        time_s: f64,
    },
}

impl Item {
    /// A bracket by its index.
    pub fn bracket(index: usize, bracket: &Bracket) -> Self {
        Self::Bracket {
            index,
            boundary: bracket.kind,
            frequency_low_hz: bracket.frequency_low_hz,
            frequency_high_hz: bracket.frequency_high_hz,
            clearance_m: bracket.clearance_m,
        }
    }
}

/// Why something was left out.
#[derive(
    Debug, Default, Clone, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum Reason {
    /// The response of a record without impacts fits far worse than those of the others.
    ResponseUnlikeOthers {
        /// How many times worse.
        times_worse: f64,
    },
    /// A periodic record's waveform fits far worse than those of the others.
    WaveformUnlikeOthers {
        /// How many times worse.
        times_worse: f64,
    },
    /// The model has no such periodic motion at the fitted parameters.
    #[default]
    NoSuchMotion,
    /// The motion changed far from the simulated boundary.
    FarFromBoundary,
    /// The gap is not as stated.
    GapNotAsStated,
    /// The impacts of a record do not follow from each other.
    ImpactsDoNotFollow,
    /// The record draws the fit away from what all others state.
    Influential {
        /// The method that it was left out of.
        method: Method,
    },
    /// The speeds of an impact are far from those of the others.
    OutlyingImpact {
        /// Approach speed before, m/s.
        before_m_s: f64,
        /// Separation speed after, m/s.
        after_m_s: f64,
    },
    /// The natural frequency is not that of the stated specimen.
    Misfiled {
        /// The specimen as stated.
        specimen: String,
        /// Natural frequency of that specimen, Hz.
        specimen_hz: f64,
        /// Natural frequency of the record, Hz.
        frequency_hz: f64,
    },
    /// The natural frequency is that of another specimen.
    MisfiledLike {
        /// The specimen as stated.
        specimen: String,
        /// Natural frequency of that specimen, Hz.
        specimen_hz: f64,
        /// Natural frequency of the record, Hz.
        frequency_hz: f64,
        /// The other specimen.
        like: String,
        /// Natural frequency of the other specimen, Hz.
        like_hz: f64,
    },
}

/// Something that was left out, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// What.
    pub item: Item,
    /// Why.
    pub reason: Reason,
}

messages!(Item, Reason);

message_table! { "item": Item;
    Self::Record { record, .. } => record = Value::Name(record);
    Self::Bracket { boundary, frequency_low_hz, frequency_high_hz, clearance_m, .. } =>
        boundary = Value::Message(boundary),
        low = Value::Number(*frequency_low_hz, 2),
        high = Value::Number(*frequency_high_hz, 2),
        clearance = Value::Number(1e3 * clearance_m, 3);
    Self::Impact { record, time_s, .. } =>
        record = Value::Name(record),
        time = Value::Number(*time_s, 3);
}

message_table! { "reason": Reason;
    Self::ResponseUnlikeOthers { times_worse } => ratio = Value::Number(*times_worse, 0);
    Self::WaveformUnlikeOthers { times_worse } => ratio = Value::Number(*times_worse, 1);
    Self::Influential { method } => method = Value::Message(method);
    Self::OutlyingImpact { before_m_s, after_m_s } =>
        before = Value::Number(*before_m_s, 3),
        after = Value::Number(*after_m_s, 3);
    Self::Misfiled { specimen, specimen_hz, frequency_hz } =>
        specimen = Value::Name(specimen),
        own = Value::Number(*specimen_hz, 2),
        frequency = Value::Number(*frequency_hz, 2);
    Self::MisfiledLike { specimen, specimen_hz, frequency_hz, like, like_hz } =>
        specimen = Value::Name(specimen),
        own = Value::Number(*specimen_hz, 2),
        frequency = Value::Number(*frequency_hz, 2),
        like = Value::Name(like),
        other = Value::Number(*like_hz, 2);
}
