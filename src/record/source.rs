//! The door of every file format: one trait, one file per format behind it.
//!
//! A [`Source`] is opened by reading metadata only; samples are read a dataset at a time. A
//! *dataset* is a table of channels: one record of the campaign (a CSV or LVM file holds one, an
//! HDF5 or TDMS file may hold hundreds).

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

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

/// What is known of a channel before its samples are read.
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
    /// Samples per second, Hz, where the file tells.
    pub sample_rate_hz: Option<f64>,
    /// Start of the acquisition as ISO 8601 text, where the file tells.
    pub start_time: Option<String>,
    /// All other properties the file gives, as text.
    pub properties: BTreeMap<String, String>,
}

/// What is known of a dataset (one record) before its samples are read.
#[derive(Debug, Clone, PartialEq)]
pub struct DatasetInfo {
    /// Name in the file; empty where the file is the dataset.
    pub name: String,
    /// The channels, in file order. A time axis is a channel too; see [`DatasetInfo::time_axis`].
    pub channels: Vec<ChannelInfo>,
    /// Index of the channel that holds the time axis, where there is one.
    pub time_axis: Option<usize>,
    /// Attributes of the dataset (in HDF5: clearance, drive frequency and so on), as text.
    pub attributes: BTreeMap<String, String>,
}

/// The samples of one channel, after the file's own scaling.
#[derive(Debug, Clone, PartialEq)]
pub enum Samples {
    /// Real numbers; integers are converted.
    Real(Vec<f64>),
    /// Complex numbers as (real, imaginary).
    Complex(Vec<(f64, f64)>),
    /// Text.
    Text(Vec<String>),
}

/// Why a file could not be read: what was expected, what was found, where, and the remedy.
#[derive(Debug, Clone, thiserror::Error, PartialEq)]
#[error("{}{}: {found}; expected {expected}{}. {remedy}", path.display(), .channel.as_ref().map(|c| format!(", channel '{c}'")).unwrap_or_default(), .byte.map(|b| format!(" (at byte {b})")).unwrap_or_default())]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// The channel or dataset concerned.
    pub channel: Option<String>,
    /// What the reader needed there.
    pub expected: String,
    /// What it found.
    pub found: String,
    /// Offset in the file, where one can be named.
    pub byte: Option<u64>,
    /// What the user can do.
    pub remedy: String,
}

/// An open file of any supported format. Opening reads metadata only.
pub trait Source: Send + Sync {
    /// Short name of the format (`hdf5`, `csv`, `lvm`, `tdms`, `uff`, `mat`, `wav`, `parquet`).
    fn format(&self) -> &'static str;

    /// The file's path.
    fn path(&self) -> &Path;

    /// The datasets of the file, in file order.
    fn datasets(&self) -> &[DatasetInfo];

    /// Notes on what the reader skipped or assumed, for the user.
    fn notes(&self) -> &[String] {
        &[]
    }

    /// Read the named channels (indices into `datasets()[dataset].channels`) of one dataset.
    ///
    /// Shared by threads: the reader keeps no position. Each inner vector has the length that
    /// the channel's info states.
    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError>;
}
