//! Values as gzip-compressed JSON.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use flate2::Compression;
use flate2::read::GzDecoder;
use flate2::write::GzEncoder;
use serde::Serialize;
use serde::de::DeserializeOwned;

use labfiles::output::{OutputError, write_whole};

/// Write a value atomically.
///
/// # Errors
/// If it cannot be written.
pub(super) fn write<T: Serialize>(path: &Path, value: &T) -> Result<(), OutputError> {
    write_whole(path, |writer| {
        let mut gzip = GzEncoder::new(writer, Compression::fast());
        serde_json::to_writer(&mut gzip, value)?;
        gzip.finish()?;
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
