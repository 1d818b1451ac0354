//! Readers of the files that vibration laboratories keep, from HDF5, MATLAB and TDMS to text tables; each format is a
//! module of `formats`.
//!
//! [`open`] recognises a file by its first bytes and gives a [`Source`]: *datasets* (records), each
//! a table of *channels* with name, unit, sample rate and attributes. Opening reads metadata only;
//! [`Source::read`] reads the samples of the channels that are asked for, from any number of
//! threads.
//!
//! ```
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("run.csv");
//! std::fs::write(&path, "# clearance_m = 0.001\nt [s],x [mm]\n0,1.5\n0.5,2.5\n1,-3\n")?;
//!
//! let source = labfiles::open(&path)?;
//! let record = &source.datasets()[0];
//! assert_eq!(record.attributes["clearance_m"], "0.001");
//! assert_eq!(record.sample_rate_hz(), Some(2.0));
//! for channel in &record.channels {
//!     println!("{} in {:?}: {} samples", channel.name, channel.unit, channel.samples);
//! }
//!
//! let x = record.channel_index("x").ok_or("no channel x")?;
//! let samples = source.read(0, &[x])?.remove(0).into_real().ok_or("not real")?;
//! assert_eq!(samples, [1.5, 2.5, -3.0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Files are not trusted. Lengths and counts that a file states are compared with what it holds
//! before memory is taken for them, so that a damaged or hostile file gives a [`ReadError`] (what
//! was expected, what was found, at which byte, and the remedy), neither a panic nor an allocation
//! far beyond the file's own size.
//!
//! [`units`] converts to SI. Files are written by `labfiles-write`; what such files state beyond their formats is in
//! [`conventions`].

#![cfg_attr(
    test,
    allow(
        clippy::cast_lossless,
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        clippy::cast_sign_loss,
        reason = "tests make numbers of known range"
    )
)]

pub mod attribute;
mod bytes;
mod channel;
pub mod conventions;
mod formats;
mod inflate;
mod numbers;
mod plain;
pub mod rate;
mod source;
pub mod summary;
mod system;
mod text;
pub mod timing;
pub mod units;

pub use formats::csv::header::name_and_unit;
pub use formats::csv::parts::without_run;
pub use formats::documents::document;
pub use formats::excel::workbook_tables;
pub use formats::parquet::guard::is_caught as panic_is_caught;
pub use formats::{format_titles, open, open_growing};
pub use plain::read_text;
pub use source::{ChannelInfo, Clock, DatasetInfo, ReadError, Samples, Source, StoredType};
pub use system::said;

#[cfg(test)]
mod conformance;

/// The examples of the README, checked as the others are.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
