//! Values as gzip-compressed JSON.

use std::io::{self, BufWriter, IntoInnerError};
use std::path::Path;

use flate2::Compression;
use flate2::write::GzEncoder;
use libdeflater::Decompressor;
use serde::Serialize;
use serde::de::DeserializeOwned;

use labfiles::output::{OutputError, write_whole};

/// Bytes that are compressed together.
const BUFFER_BYTES: usize = 1 << 16;

/// Write a value atomically.
///
/// # Errors
/// If it cannot be written.
pub(super) fn write<T: Serialize>(path: &Path, value: &T) -> Result<(), OutputError> {
    write_whole(path, |writer| {
        let gzip = GzEncoder::new(writer, Compression::fast());
        // a value is written token by token, of which each would cost the compressor a pass
        let mut buffered = BufWriter::with_capacity(BUFFER_BYTES, gzip);
        serde_json::to_writer(&mut buffered, value)?;
        buffered
            .into_inner()
            .map_err(IntoInnerError::into_error)?
            .finish()?;
        Ok(())
    })
}

/// Most that gzip packs into one byte.
const GREATEST_RATIO: usize = 1032;

/// Read a value that [`write`] wrote.
///
/// # Errors
/// If the file is missing, damaged or of another type.
pub(super) fn read<T: DeserializeOwned>(path: &Path) -> io::Result<T> {
    Ok(serde_json::from_slice(&unpacked(&std::fs::read(path)?)?)?)
}

/// The one member of a gzip file, which ends with its length.
fn unpacked(packed: &[u8]) -> io::Result<Vec<u8>> {
    let damaged = |why: &str| io::Error::new(io::ErrorKind::InvalidData, why.to_owned());
    let length = packed.last_chunk().map_or(0, |b| u32::from_le_bytes(*b));
    let length = usize::try_from(length).unwrap_or(usize::MAX);
    if length > GREATEST_RATIO * packed.len() {
        return Err(damaged("the length at its end is not that of its content"));
    }
    let mut text = vec![0; length];
    let used = Decompressor::new()
        .gzip_decompress(packed, &mut text)
        .map_err(|e| damaged(&e.to_string()))?;
    text.truncate(used);
    Ok(text)
}
