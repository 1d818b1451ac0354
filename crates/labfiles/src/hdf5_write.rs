//! Writing records to HDF5: one table a record, self-describing, packed.
//!
//! The layout is described in `docs/formats.md` and is what [`crate::hdf5`] reads back:
//! a two-dimensional dataset samples × channels for each record, with the attributes `channels`,
//! `units`, `sample_rate_hz` and whatever the record states besides. Tables of converter counts
//! are kept as 16-bit integers with `scale` and `offset`: value = count · scale + offset.

mod layout;

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use ::hdf5::{AttrValue, FileBuilder};

use crate::output::write_whole_or;

/// Version of the layout, written as `impactid_layout` into the file.
const LAYOUT_VERSION: i64 = 1;

/// Why a campaign could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The file system refused.
    #[error("{} could not be written: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The record cannot be laid out.
    #[error("record '{record}': {reason}")]
    Record {
        /// The record's name.
        record: String,
        /// What is wrong with it and what to do.
        reason: String,
    },
    /// The HDF5 library refused.
    #[error("{}: {reason}", path.display())]
    Library {
        /// The file.
        path: PathBuf,
        /// What the library said.
        reason: String,
    },
}

impl WriteError {
    /// What the user can do.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Io { source, .. } => crate::output::remedy_for(source.kind()),
            Self::Record { .. } => "mend the record or leave it out",
            Self::Library { .. } => "this should not happen: please report it with the command",
        }
    }
}

/// An attribute's value.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

/// The samples of a channel as they are to be stored.
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
    fn len(&self) -> usize {
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
    /// Samples per second, Hz; `None` where it is unknown or the channels differ in it.
    pub sample_rate_hz: Option<f64>,
    /// Its channels.
    pub channels: Vec<ColumnToWrite>,
    /// Further attributes with their unit in the name: `clearance_m`, `drive_frequency_hz`, …
    pub attributes: Vec<(String, Value)>,
}

/// Collects records; nothing is at the path before [`CampaignWriter::finish`].
pub struct CampaignWriter {
    path: PathBuf,
    attributes: Vec<(String, Value)>,
    root: Folder,
    single_precision: bool,
}

/// A group to be: records and further groups.
#[derive(Default)]
struct Folder {
    names: BTreeSet<String>,
    records: Vec<RecordTable>,
    folders: BTreeMap<String, Folder>,
}

impl CampaignWriter {
    /// Begin a file. Numbers are kept in double precision; see
    /// [`CampaignWriter::single_precision`].
    pub fn create(path: &Path) -> Self {
        Self {
            path: path.to_path_buf(),
            attributes: Vec::new(),
            root: Folder::default(),
            single_precision: false,
        }
    }

    /// Keep numbers in single precision.
    #[must_use]
    pub fn single_precision(mut self) -> Self {
        self.single_precision = true;
        self
    }

    /// An attribute of the whole file, inherited by all records.
    pub fn attribute(&mut self, name: &str, value: impl Into<Value>) -> &mut Self {
        self.attributes.push((name.to_owned(), value.into()));
        self
    }

    /// Add a record.
    ///
    /// Channels of one length, all numbers or all counts, become a table; others a group of
    /// arrays.
    ///
    /// # Errors
    /// Where the name is empty or taken, or there is no channel.
    pub fn add(&mut self, mut record: RecordTable) -> Result<(), WriteError> {
        let wrong = |reason: &str, record: &RecordTable| WriteError::Record {
            record: record.name.clone(),
            reason: reason.into(),
        };
        let parts: Vec<String> = record.name.split('/').map(str::to_owned).collect();
        if parts.iter().any(|p| p.is_empty() || p == ".") {
            return Err(wrong("a part of its name is empty; give it one", &record));
        }
        if record.channels.is_empty() {
            return Err(wrong("it has no channels; leave it out", &record));
        }
        let (leaf, folders) = parts
            .split_last()
            .ok_or_else(|| wrong("it has no name", &record))?;
        let folder = folders.iter().fold(&mut self.root, |folder, name| {
            folder.folders.entry(name.clone()).or_default()
        });
        let taken = folder.folders.contains_key(leaf) || folder.names.contains(leaf);
        if taken {
            return Err(wrong(
                "the file already holds one of this name; name it otherwise",
                &record,
            ));
        }
        folder.names.insert(leaf.clone());
        record.name.clone_from(leaf);
        folder.records.push(record);
        Ok(())
    }

    /// Write the file under a temporary name beside the path, then rename it.
    ///
    /// # Errors
    /// Where the file system or the library refuses; nothing is left then.
    pub fn finish(self) -> Result<(), WriteError> {
        let io = |source| WriteError::Io {
            path: self.path.clone(),
            source,
        };
        let mut builder = FileBuilder::new();
        builder.set_attr("impactid_layout", AttrValue::I64(LAYOUT_VERSION));
        for (name, value) in &self.attributes {
            builder.set_attr(name, layout::attr(value));
        }
        for record in self.root.records {
            if layout::is_table(&record) {
                layout::table(
                    builder.create_dataset(&record.name),
                    &record,
                    self.single_precision,
                );
            } else {
                let group = layout::arrays(
                    builder.create_group(&record.name),
                    &record,
                    self.single_precision,
                );
                builder.add_group(group);
            }
        }
        for (name, folder) in self.root.folders {
            let group = builder.create_group(&name);
            builder.add_group(layout::fill(group, folder, self.single_precision));
        }
        let library = |e| match e {
            ::hdf5::Error::Io(source) => io(source),
            other => WriteError::Library {
                path: self.path.clone(),
                reason: other.to_string(),
            },
        };
        let fill = |file: &mut BufWriter<File>| builder.finish_to(file).map(drop).map_err(library);
        write_whole_or(&self.path, fill, io)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hdf5;
    use crate::source::Samples;

    fn counts(name: &str, counts: Vec<i16>) -> ColumnToWrite {
        let samples = Stored::Counts {
            counts,
            scale: 0.25,
            offset: -1.0,
        };
        ColumnToWrite {
            name: name.into(),
            unit: "mm/s".into(),
            samples,
        }
    }

    fn record(name: &str, channels: Vec<ColumnToWrite>) -> RecordTable {
        let attributes = vec![
            ("clearance_m".into(), 1e-3.into()),
            ("sweep".into(), "up".into()),
        ];
        RecordTable {
            name: name.into(),
            sample_rate_hz: Some(2000.0),
            channels,
            attributes,
        }
    }

    #[test]
    fn valid_what_is_written_comes_back() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("campaign.h5");
        let mut writer = CampaignWriter::create(&path);
        writer.attribute("rig", "synthetic");
        let ramp: Vec<i16> = (0..5000).map(|i| (i % 4096 - 2048) as i16).collect();
        writer
            .add(record(
                "up/run1",
                vec![counts("x", ramp.clone()), counts("y", ramp.clone())],
            ))
            .unwrap();
        let v: Vec<f64> = (0..50).map(|i| f64::from(i) / 3.0).collect();
        let numbers = |n: &str| ColumnToWrite::numbers(n, "m/s", v.clone());
        writer
            .add(record("run2", vec![numbers("x"), numbers("y")]))
            .unwrap();
        writer
            .add(record(
                "run3",
                vec![numbers("x"), counts("y", ramp.clone())],
            ))
            .unwrap();
        assert!(writer.add(record("run2", vec![numbers("x")])).is_err());
        assert!(writer.add(record("a//b", vec![numbers("x")])).is_err());
        assert!(!path.exists());
        writer.finish().unwrap();
        let source = hdf5::open(&path).unwrap();
        let names: Vec<&str> = source.datasets().iter().map(|d| d.name.as_str()).collect();
        assert_eq!(names, ["run2", "run3", "up/run1"]);
        for info in source.datasets() {
            assert_eq!(info.sample_rate_hz(), Some(2000.0));
            assert_eq!(info.attributes["clearance_m"], "0.001");
            assert_eq!(info.attributes["rig"], "synthetic");
            assert_eq!(info.channels[1].name, "y");
        }
        assert_eq!(
            source.datasets()[2].channels[0].unit.as_deref(),
            Some("mm/s")
        );
        let scaled = ramp.iter().map(|c| f64::from(*c) * 0.25 - 1.0).collect();
        assert_eq!(source.read(2, &[1]).unwrap()[0], Samples::Real(scaled));
        assert_eq!(source.read(0, &[0]).unwrap()[0], Samples::Real(v.clone()));
        assert_eq!(source.read(1, &[0]).unwrap()[0], Samples::Real(v));
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[test]
    fn valid_a_folder_that_is_absent_is_named() {
        let mut writer = CampaignWriter::create(Path::new("/nowhere/at/all.h5"));
        writer
            .add(record("r", vec![counts("x", vec![1, 2])]))
            .unwrap();
        assert!(
            writer
                .finish()
                .unwrap_err()
                .to_string()
                .contains("/nowhere/at/all.h5")
        );
    }
}
