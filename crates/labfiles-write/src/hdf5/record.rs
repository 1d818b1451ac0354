//! Records to be written, and the groups of a file.

use std::collections::{BTreeMap, BTreeSet};

/// An attribute's value.
#[derive(Debug, Clone, PartialEq)]
pub enum AttributeValue {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
}

impl From<f64> for AttributeValue {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<&str> for AttributeValue {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for AttributeValue {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

/// The samples of a channel to be written.
#[derive(Debug, Clone, PartialEq)]
pub enum Stored {
    /// Numbers in the channel's unit.
    Numbers(Vec<f64>),
    /// Converter counts: value = count · scale + offset in the channel's unit.
    Counts {
        /// The counts.
        counts: Vec<i16>,
        /// Unit per count.
        scale: f64,
        /// Value of count zero.
        offset: f64,
    },
}

impl Stored {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Numbers(v) => v.len(),
            Self::Counts { counts, .. } => counts.len(),
        }
    }
}

/// A channel to be written.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnToWrite {
    /// Its name.
    pub name: String,
    /// Its unit; empty for none.
    pub unit: String,
    /// Its samples.
    pub samples: Stored,
}

impl ColumnToWrite {
    /// A channel of numbers.
    pub fn numbers(name: impl Into<String>, unit: impl Into<String>, values: Vec<f64>) -> Self {
        Self {
            name: name.into(),
            unit: unit.into(),
            samples: Stored::Numbers(values),
        }
    }
}

/// A record to be written.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordTable {
    /// Name, unique in the file; slashes make groups.
    pub name: String,
    /// Samples per second, Hz; `None` if it is unknown or the channels differ in it.
    pub sample_rate_hz: Option<f64>,
    /// Its channels.
    pub channels: Vec<ColumnToWrite>,
    /// Further attributes with their unit in the name: `clearance_m`, `drive_frequency_hz`, …
    pub attributes: Vec<(String, AttributeValue)>,
}

/// A group of the file: records and further groups.
#[derive(Default)]
pub(super) struct Folder {
    pub(super) names: BTreeSet<String>,
    pub(super) records: Vec<RecordTable>,
    pub(super) folders: BTreeMap<String, Self>,
}
