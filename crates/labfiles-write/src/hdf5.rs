//! Writing records to HDF5: one table per record, self-describing, compressed.
//!
//! Each record is a two-dimensional dataset samples × channels with the attributes `channels`,
//! `units`, `sample_rate_hz` and those of the record. Tables of converter counts are stored as
//! 16-bit integers with `scale` and `offset`: value = count · scale + offset. [`labfiles::open`] reads
//! the layout back, as h5py and MATLAB do.
//!
//! ```
//! use labfiles_write::hdf5::{CampaignWriter, ColumnToWrite, RecordTable};
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("campaign.h5");
//! let mut writer = CampaignWriter::create(&path);
//! writer.attribute("operator", "A").add(RecordTable {
//!     name: "run1".to_owned(),
//!     sample_rate_hz: Some(2000.0),
//!     channels: vec![
//!         ColumnToWrite::numbers("x", "mm", vec![0.5, 1.5]),
//!         ColumnToWrite::numbers("y", "mm", vec![2.0, 3.0]),
//!     ],
//!     attributes: vec![("clearance_m".to_owned(), 0.001.into())],
//! })?;
//! writer.finish()?;
//!
//! let source = labfiles::open(&path)?;
//! let record = &source.datasets()[0];
//! assert_eq!((record.name.as_str(), record.sample_rate_hz()), ("run1", Some(2000.0)));
//! assert_eq!(record.attributes["clearance_m"], "0.001");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod layout;
mod record;

use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use ::hdf5::{AttrValue, FileBuilder};

use crate::hdf5::record::Folder;
use crate::output::write_whole_or;
use labfiles::said;

pub use crate::hdf5::record::{AttributeValue, ColumnToWrite, RecordTable, Stored};

/// Version of the layout, written as `impactid_layout` into the file.
const LAYOUT_VERSION: i64 = 1;

/// Why a campaign could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The file system refused.
    #[error("{} could not be written: {}", path.display(), said(source))]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// The record cannot be written.
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
        /// The library's message.
        reason: String,
    },
}

impl WriteError {
    /// What the user can do.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Io { source, .. } => crate::output::remedy_for(source.kind()),
            Self::Record { .. } => "correct the record or leave it out",
            Self::Library { .. } => "this should not happen: please report it with the command",
        }
    }
}

/// Collects records; the file appears with [`CampaignWriter::finish`].
pub struct CampaignWriter {
    path: PathBuf,
    attributes: Vec<(String, AttributeValue)>,
    root: Folder,
    single_precision: bool,
}

impl CampaignWriter {
    /// Begin a file. Numbers are stored in double precision; see
    /// [`CampaignWriter::single_precision`].
    pub fn create(path: &Path) -> Self {
        Self {
            path: path.to_path_buf(),
            attributes: Vec::new(),
            root: Folder::default(),
            single_precision: false,
        }
    }

    /// Store numbers in single precision.
    #[must_use]
    pub fn single_precision(mut self) -> Self {
        self.single_precision = true;
        self
    }

    /// An attribute of the whole file, inherited by all records.
    pub fn attribute(&mut self, name: &str, value: impl Into<AttributeValue>) -> &mut Self {
        self.attributes.push((name.to_owned(), value.into()));
        self
    }

    /// Add a record.
    ///
    /// Channels of one length, all numbers or all counts, become a table; others a group of
    /// arrays.
    ///
    /// # Errors
    /// If the name is empty or taken, or there is no channel.
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
                "the file already holds one of this name; give it another",
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
    /// If the file system or the library refuses; nothing is left then.
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
    use labfiles::Samples;

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
    fn what_is_written_comes_back() {
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
        let source = labfiles::open(&path).unwrap();
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
    fn a_folder_that_is_absent_is_named() {
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
