//! One trait for every file format, and what it describes.
//!
//! A [`Source`] is opened by reading metadata only; samples are read a dataset at a time. A
//! *dataset* is a table of channels: one record (a CSV or LVM file holds one, an HDF5 or TDMS file
//! may hold hundreds).

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

pub use crate::channel::{ChannelInfo, Clock, StoredType};
use crate::conventions;
use crate::system::said;

/// A dataset (one record) as its file describes it, before its samples are read.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DatasetInfo {
    /// Name in the file; empty if the file is the dataset.
    pub name: String,
    /// The channels, in file order. A time axis is a channel too; see [`DatasetInfo::time_axis`].
    pub channels: Vec<ChannelInfo>,
    /// Index of the channel that holds the time axis, if there is one.
    pub time_axis: Option<usize>,
    /// Attributes of the dataset, as text.
    pub attributes: BTreeMap<String, String>,
}

/// The samples of one channel, after the file's own scaling.
///
/// All numbers are `f64`: integers of 64 bits beyond 2^53 are rounded.
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
///
/// ```
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("cut.wav");
/// std::fs::write(&path, b"RIFF\x24\0\0\0WAVEfmt ")?;
/// let error = labfiles::open(&path).err().ok_or("a file without samples was read")?;
/// assert_eq!(error.byte, Some(16));
/// assert!(error.to_string().contains("only 0 bytes left; expected 4 bytes of a chunk's length"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, thiserror::Error, PartialEq)]
#[error("{}. {remedy}", self.fault())]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// The channel or dataset concerned.
    pub channel: Option<String>,
    /// What the reader needed there; empty where the system did not open or read the file.
    pub expected: String,
    /// What it found.
    pub found: String,
    /// Offset in the file, if there is one to name.
    pub byte: Option<u64>,
    /// What the user can do.
    pub remedy: String,
}

/// An open file of any supported format. Opening reads metadata only.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("run.csv");
/// # std::fs::write(&path, "t [s],x [mm],y [mm]\n0,1,4\n0.5,2,5\n1,3,6\n")?;
/// let source = labfiles::open(&path)?;
/// for (number, record) in source.datasets().iter().enumerate() {
///     let all: Vec<usize> = (0..record.channels.len()).collect();
///     for (channel, samples) in record.channels.iter().zip(source.read(number, &all)?) {
///         assert_eq!(samples.len() as u64, channel.samples);
///     }
/// }
/// assert!(source.read(0, &[7]).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Source: Send + Sync {
    /// Short name of the format, such as `hdf5` or `csv`.
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
    /// Threads may share a source: it keeps no position. Each of the samples has the length that
    /// the channel's info states.
    ///
    /// # Errors
    /// If the dataset or a channel does not exist, or the file cannot be read or is damaged.
    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError>;
}

impl ReadError {
    /// An error about a file as a whole; see [`ReadError::at`] and [`ReadError::channel`].
    pub fn new(
        path: &Path,
        expected: impl Into<String>,
        found: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            path: path.to_path_buf(),
            channel: None,
            expected: expected.into(),
            found: found.into(),
            byte: None,
            remedy: remedy.into(),
        }
    }

    /// What is wrong and where, without the remedy.
    pub fn fault(&self) -> String {
        let channel = self.channel.as_ref();
        let channel = channel.map(|c| format!(", channel '{c}'"));
        format!(
            "{}{}: {}",
            self.path.display(),
            channel.unwrap_or_default(),
            self.what()
        )
    }

    /// What was found, what was expected and at which offset, without file and channel.
    pub fn what(&self) -> String {
        let expected = match self.expected.as_str() {
            "" => String::new(),
            expected => format!("; expected {expected}"),
        };
        let byte = self.byte.map(|b| format!(" (at byte {b})"));
        format!("{}{expected}{}", self.found, byte.unwrap_or_default())
    }

    /// The same error with the offset in the file at which it was found.
    #[must_use]
    pub fn at(mut self, byte: u64) -> Self {
        self.byte = Some(byte);
        self
    }

    /// The same error with the channel or dataset concerned.
    #[must_use]
    pub fn channel(mut self, name: impl Into<String>) -> Self {
        self.channel = Some(name.into());
        self
    }

    /// A file that the operating system would not open or read.
    pub fn io(path: &Path, error: &std::io::Error) -> Self {
        let remedy = match error.kind() {
            std::io::ErrorKind::NotFound => "check the path and its spelling",
            std::io::ErrorKind::PermissionDenied => "allow reading the file",
            _ => "check the disk and copy the file again",
        };
        Self::new(path, "", said(error), remedy)
    }
}

impl DatasetInfo {
    /// Index of the channel of that name, the first if names repeat.
    pub fn channel_index(&self, name: &str) -> Option<usize> {
        self.channels.iter().position(|c| c.name == name)
    }

    /// The rate that the channels share, Hz; `None` if the file states none or several.
    pub fn sample_rate_hz(&self) -> Option<f64> {
        let mut rates = self.channels.iter().filter_map(|c| c.sample_rate_hz);
        let first = rates.next()?;
        rates
            .all(|r| (r - first).abs() <= 1e-9 * first.abs())
            .then_some(first)
    }
}

impl Samples {
    /// Number of samples.
    pub fn len(&self) -> usize {
        match self {
            Self::Real(v) => v.len(),
            Self::Complex(v) => v.len(),
            Self::Text(v) => v.len(),
        }
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The real numbers; `None` for complex numbers and text.
    pub fn into_real(self) -> Option<Vec<f64>> {
        match self {
            Self::Real(v) => Some(v),
            _ => None,
        }
    }
}

/// The samples of an open file.
pub(crate) trait Reader: Send + Sync {
    /// As [`Source::read`], for a dataset and channels that exist.
    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError>;
}

/// An open file: what was found when it was opened, and the reader of its samples.
struct Opened<R> {
    format: &'static str,
    path: PathBuf,
    datasets: Vec<DatasetInfo>,
    notes: Vec<String>,
    reader: R,
}

/// An open file: what it holds, notes for the user, and who reads it.
pub(crate) fn opened<R: Reader + 'static>(
    format: &'static str,
    path: &Path,
    mut datasets: Vec<DatasetInfo>,
    notes: Vec<String>,
    reader: R,
) -> Result<Box<dyn Source>, ReadError> {
    for dataset in &mut datasets {
        conventions::apply_clocks(&mut dataset.channels, &dataset.attributes);
    }
    Ok(Box::new(Opened {
        format,
        path: path.to_path_buf(),
        datasets,
        notes,
        reader,
    }))
}

impl<R> Opened<R> {
    fn missing(&self, what: String, below: usize) -> ReadError {
        ReadError::new(
            &self.path,
            format!("an index below {below}"),
            format!("{what}, which the file does not have"),
            "use an index of `datasets()` and of its channels",
        )
    }
}

impl<R: Reader> Source for Opened<R> {
    fn format(&self) -> &'static str {
        self.format
    }

    fn path(&self) -> &Path {
        &self.path
    }

    fn datasets(&self) -> &[DatasetInfo] {
        &self.datasets
    }

    fn notes(&self) -> &[String] {
        &self.notes
    }

    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        let absent = || self.missing(format!("dataset {dataset}"), self.datasets.len());
        let info = self.datasets.get(dataset).ok_or_else(absent)?;
        match channels.iter().find(|&&c| c >= info.channels.len()) {
            Some(c) => Err(self
                .missing(format!("channel {c}"), info.channels.len())
                .channel(&info.name)),
            None => self.reader.read(dataset, channels),
        }
    }
}
