//! Writers of laboratory files: records of any format to HDF5, Parquet, CSV and UFF 58, each file complete under its
//! name or absent.
//!
//! [`convert`] writes what [`labfiles::open`] reads; [`hdf5::CampaignWriter`] writes records that a program makes. Both
//! rest on [`output`]: files are written under another name, flushed to the disk, then renamed. What the files state
//! beyond their formats is in [`labfiles::conventions`], so that `labfiles` gives the records back as they were.
//!
//! ```
//! use labfiles_write::convert::{Options, Target, convert};
//! use labfiles_write::output::write_bytes;
//!
//! let folder = tempfile::tempdir()?;
//! let table = folder.path().join("run.csv");
//! write_bytes(&table, b"t [s],x [mm]\n0,1.5\n0.5,2.5\n1,-3\n")?;
//!
//! let sources = [labfiles::open(&table)?];
//! let out = folder.path().join("run.h5");
//! convert(&sources, Target::Hdf5, &out, &Options::default())?;
//! let written = labfiles::open(&out)?;
//! assert_eq!(written.datasets()[0].sample_rate_hz(), Some(2.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

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

pub mod convert;
pub mod hdf5;
pub mod output;

/// A number in the single precision that was asked for.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding is what the caller asks for"
)]
fn to_f32(value: f64) -> f32 {
    value as f32
}

/// The examples of the README, checked as the others are.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
