//! What the files of a folder show.

use std::collections::BTreeMap;

use impact_records::event::RigKind;
use impact_records::record::calibrate::ChannelKey;
use impact_records::record::{ContactContent, Role};
use labfiles::DatasetInfo;
use labfiles::timing::AxisUnit;

/// What was found in a folder.
#[derive(Debug, Default)]
pub struct FolderContents {
    /// Globs of the record files, relative to the folder.
    pub globs: Vec<String>,
    /// A table that names files, relative to the folder.
    pub run_table: Option<String>,
    /// The text of that table where it is none of the folder's files, but what the names of the files state.
    pub table_of_names: Option<String>,
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
    /// Columns of a list that follow that of the contact's channel in the same row.
    pub then: Vec<String>,
    /// Whether the records leave open if one mass moves or two.
    pub asks_machine: bool,
    /// What else a user should know of the files.
    pub notes: Vec<String>,
    /// Whether the run table or the files' attributes state drive frequencies.
    pub states_drive: bool,
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
    /// Name in the file, without that of the run.
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
    /// How often it goes from one of them to the other, in the record in which it does so most.
    pub changes: usize,
    /// Of a contact on which a mass bounces: the level beyond which it is closed.
    pub closes_at: Option<f64>,
    /// The sign that its impacts show: 1 toward the other mass or the stop, -1 away from it.
    pub sign: i8,
    /// Of times whose unit the file does not state: the unit that their name or their numbers show.
    pub counted_in: Option<AxisUnit>,
}

impl InferredChannel {
    /// Index of the channel in a dataset, as campaign.toml finds it.
    pub(super) fn find(&self, dataset: &DatasetInfo) -> Option<usize> {
        ChannelKey::Name(self.name.clone()).find(dataset)
    }
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
