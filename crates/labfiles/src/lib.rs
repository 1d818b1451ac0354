//! Readers and writers of the files that vibration laboratories keep: HDF5, MATLAB, TDMS, UFF 58,
//! LVM, WAV, CSV and other text tables, Parquet.
//!
//! [`open::open`] opens a file of any of them behind one trait, [`source::Source`].

pub mod attribute;
pub mod bytes;
pub mod convert;
pub mod csv;
pub mod hdf5;
pub mod hdf5_write;
pub mod inflate;
pub mod lvm;
pub mod mat;
pub mod numbers;
pub mod open;
pub mod output;
pub mod parquet;
pub mod rate;
pub mod source;
pub mod summary;
pub mod tdms;
pub mod text;
pub mod uff;
pub mod units;
pub mod wav;

#[cfg(test)]
mod conformance;
