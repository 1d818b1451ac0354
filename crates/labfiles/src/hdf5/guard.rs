//! Refusing arrays that claim far more than their file can hold, before memory is taken for them.

use crate::hdf5::store::{Array, StoreError};

/// How many times larger than its whole file an unpacked array may be: signals pack a few times,
/// constant channels beside them far more.
const GREATEST_RATIO: u64 = 128;
/// Arrays and chunks up to this size are read whatever their packing.
const HARMLESS_BYTES: u64 = 1 << 16;

/// Lengths that bear on what an array may claim, bytes.
pub(super) struct Lengths {
    /// The file.
    pub(super) file: u64,
    /// One unpacked chunk of the array; zero if it has no chunks.
    pub(super) chunk: u64,
    /// What the file stores of the array.
    pub(super) stored: u64,
}

/// Refuse a chunk or a shape far larger than the file, or a large array that is not stored.
///
/// # Errors
/// [`StoreError`] with the claim.
pub(super) fn check(array: &Array, lengths: &Lengths) -> Result<(), StoreError> {
    let &Lengths {
        file,
        chunk,
        stored,
    } = lengths;
    let within = |bytes: u64| bytes <= HARMLESS_BYTES || bytes / GREATEST_RATIO <= file;
    if !within(chunk) {
        return Err(StoreError::Chunks(chunk));
    }
    let claimed = array.claimed();
    if stored > file {
        return Err(StoreError::Stored(stored));
    }
    if claimed <= HARMLESS_BYTES || (within(claimed) && stored > 0) {
        return Ok(());
    }
    Err(StoreError::Shape {
        shape: array.shape.clone(),
        stored,
    })
}
