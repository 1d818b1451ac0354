//! Refusing arrays that claim far more than their file can hold, before memory is taken for them.

use crate::hdf5::store::{Array, Store, Target};

/// How many times larger than its whole file an unpacked array may be: signals pack a few times,
/// constant channels beside them far more.
const GREATEST_RATIO: u64 = 128;
/// Arrays and chunks up to this size are read whatever their packing.
const HARMLESS_BYTES: u64 = 1 << 16;

/// A store whose arrays are believed only as far as their file bears them out.
pub struct Guarded<S>(pub S);

impl<S: Store> Guarded<S> {
    fn within(&self, bytes: u64) -> bool {
        bytes <= HARMLESS_BYTES || bytes / GREATEST_RATIO <= self.0.file_bytes()
    }

    /// Refuse a chunk or a shape far larger than the file, or a large array that is not stored.
    fn check(&self, array: &Array) -> Result<(), String> {
        let chunk = self.0.chunk_bytes(array);
        if !self.within(chunk) {
            return Err(format!("chunks of {chunk} bytes, far more than the file"));
        }
        let element = array.element.bytes().max(1) as u64;
        let claimed = array
            .count()
            .and_then(|n| n.checked_mul(element))
            .unwrap_or(u64::MAX);
        let stored = self.0.stored_bytes(array).unwrap_or(0);
        if stored > self.0.file_bytes() {
            return Err(format!("{stored} stored bytes, more than the file has"));
        }
        if claimed <= HARMLESS_BYTES || (self.within(claimed) && stored > 0) {
            return Ok(());
        }
        let shape = &array.shape;
        Err(format!(
            "a shape of {shape:?} for which the file stores {stored} bytes"
        ))
    }
}

impl<S: Store> Store for Guarded<S> {
    fn raw(&self, array: &Array) -> Result<Vec<u8>, String> {
        self.check(array)?;
        self.0.raw(array)
    }

    fn rows(&self, array: &Array, start: u64, count: u64) -> Result<Vec<u8>, String> {
        self.check(array)?;
        self.0.rows(array, start, count)
    }

    fn texts(&self, array: &Array) -> Result<Vec<String>, String> {
        self.check(array)?;
        self.0.texts(array)
    }

    fn targets(&self, array: &Array) -> Result<Vec<Option<Target>>, String> {
        self.check(array)?;
        self.0.targets(array)
    }

    fn stored_bytes(&self, array: &Array) -> Option<u64> {
        self.0.stored_bytes(array)
    }

    fn chunk_bytes(&self, array: &Array) -> u64 {
        self.0.chunk_bytes(array)
    }

    fn file_bytes(&self) -> u64 {
        self.0.file_bytes()
    }
}
