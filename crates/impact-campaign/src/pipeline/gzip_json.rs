//! Values as gzip-compressed JSON.

use std::fs::File;
use std::io::{self, BufWriter, IntoInnerError, Read};
use std::path::Path;

use flate2::Compression;
use flate2::read::GzDecoder;
use flate2::write::GzEncoder;
use serde::Serialize;
use serde::de::DeserializeOwned;

use labfiles_write::output::{OutputError, write_whole};

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

/// Read a value that [`write`] wrote.
///
/// # Errors
/// If the file is missing, damaged or of another type.
pub(super) fn read<T: DeserializeOwned>(path: &Path) -> io::Result<T> {
    let mut text = String::new();
    GzDecoder::new(File::open(path)?).read_to_string(&mut text)?;
    Ok(serde_json::from_str(&text)?)
}
