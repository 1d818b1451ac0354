//! Arrays through `rust-hdf5`, for data layouts newer than `hdf5-pure` reads (version 5, that of
//! HDF5 2.0) and for filters that it lacks.
//!
//! Its handles stay on one thread, so each read opens the file again.

use std::path::Path;

use ::hdf5::{Error, FormatError};
use rust_hdf5::{H5Dataset, H5File};

use crate::formats::hdf5::store::Array;

/// Whether an error of the first library means that it lacks a feature, rather than that the file
/// is damaged: only then may the second one do better.
pub(super) fn may_read(error: &Error) -> bool {
    match error {
        Error::Format(
            FormatError::InvalidLayoutVersion(_)
            | FormatError::InvalidLayoutClass(_)
            | FormatError::InvalidChunkIndexType(_)
            | FormatError::UnsupportedFilter(_)
            | FormatError::UnsupportedVirtualLayout,
        ) => true,
        // the index of two unlimited dimensions, for which there is no variant
        Error::Format(FormatError::ChunkedReadError(words)) => words.contains("version 2 B-tree"),
        _ => false,
    }
}

/// The unpacked bytes of an array, row by row.
///
/// # Errors
/// The library's own.
pub(super) fn raw(path: &Path, array: &Array) -> rust_hdf5::Result<Vec<u8>> {
    with(path, array, H5Dataset::read_raw_bytes)
}

/// The texts of an array of texts.
///
/// # Errors
/// The library's own.
pub(super) fn texts(path: &Path, array: &Array) -> rust_hdf5::Result<Vec<String>> {
    with(path, array, H5Dataset::read_strings_lossy)
}

fn with<T>(
    path: &Path,
    array: &Array,
    read: impl FnOnce(&H5Dataset) -> rust_hdf5::Result<T>,
) -> rust_hdf5::Result<T> {
    let file = H5File::options().no_locking().open(path)?;
    read(&file.dataset(&array.path)?)
}
