//! What the files of a folder show.

use std::collections::BTreeMap;

use impact_records::event::RigKind;
use impact_records::record::{ContactContent, Role};

/// What was found in a folder.
#[derive(Debug, Default)]
pub struct FolderContents {
    /// Globs of the record files, relative to the folder.
    pub globs: Vec<String>,
    /// A table that names files, relative to the folder.
    pub run_table: Option<String>,
    /// Number of record files.
    pub files: usize,
    /// Number of datasets in the first record file.
    pub datasets: usize,
    /// Format of the first record file.
    pub format: &'static str,
    /// The first record file, relative to the folder.
    pub example: String,
    /// Number of records whose signals were looked at.
    pub looked_at: usize,
    /// Its channels.
    pub channels: Vec<InferredChannel>,
    /// Attributes of its first dataset.
    pub attributes: BTreeMap<String, String>,
    /// Files that no reader accepts.
    pub refused: Vec<RefusedFile>,
    /// Whether the file has a time axis or a sample rate.
    pub timed: bool,
    /// Whether it has neither but counts a camera's frames.
    pub counts_frames: bool,
    /// Number of records in all files.
    pub records: usize,
    /// Tables that are no records, as those of settings and notes: files, or sheets of them.
    pub others: Vec<String>,
    /// What was probably measured.
    pub experiment: Experiment,
}

/// A file that no reader accepts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RefusedFile {
    /// The file, relative to the folder.
    pub file: String,
    /// What the reader found.
    pub reason: String,
    /// What the user can do.
    pub remedy: String,
}

/// A channel and the role inferred for it.
#[derive(Debug, Clone, PartialEq)]
pub struct InferredChannel {
    /// Name in the file.
    pub name: String,
    /// What the file calls its signal beside its name, if it does.
    pub label: Option<String>,
    /// Unit in the file.
    pub unit: Option<String>,
    /// Number of samples.
    pub samples: u64,
    /// Least and greatest value in the records looked at.
    pub range: Option<[f64; 2]>,
    /// Whether it holds the time, or counts the rows.
    pub is_time: bool,
    /// The role inferred.
    pub role: Option<Role>,
    /// Levels of a signal that has only two.
    pub levels: Option<[f64; 2]>,
    /// The sign that its impacts show: 1 toward the other mass or the stop, -1 away from it.
    pub sign: i8,
}

/// What was probably measured.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Experiment {
    /// A driven rig, or nothing that the records show.
    #[default]
    Driven,
    /// Free decays.
    FreeDecay,
    /// Masses that fly freely between impacts.
    FreeFlight(RigKind),
    /// The times of impacts alone.
    Events(ContactContent),
}
