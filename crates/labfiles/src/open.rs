//! The door: which reader opens a file. Its first bytes decide, then its name, then its text.

use std::fs::File;
use std::path::Path;

use crate::bytes::read_exact_at;
use crate::csv;
use crate::hdf5;
use crate::lvm;
use crate::mat;
use crate::parquet;
use crate::source::{ReadError, Source};
use crate::tdms;
use crate::uff;
use crate::wav;

/// Bytes at the front of a file by which formats are told apart.
const FRONT_BYTES: usize = 4096;

/// A reader's way in.
type Reader = fn(&Path) -> Result<Box<dyn Source>, ReadError>;
/// Whether a file's first bytes are a format's.
type Test = fn(&[u8]) -> bool;

/// Formats with a mark of their own: how it is known and who reads it, one line each.
#[rustfmt::skip]
const BY_BYTES: &[(Test, Reader)] = &[
    (is_hdf5, hdf5::open),
    (is_lvm, lvm::open),
    (is_parquet, parquet::open),
    (tdms::recognises, tdms::open),
    (uff::recognises, uff::open),
    (wav::recognises, wav::open),
    (mat::recognises, mat::open),
];

/// Formats told by the file's extension where its bytes bear no mark, one line each.
#[rustfmt::skip]
const BY_EXTENSION: &[(&[&str], Reader)] = &[
    (&["csv", "tsv", "txt", "dat", "asc", "prn"], csv::open),
];

/// Open a record file of any supported format, reading its metadata only.
///
/// # Errors
/// Where the file cannot be read, is empty, is of no supported format, or its reader refuses it.
pub fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let front = front(path)?;
    if front.is_empty() {
        return Err(ReadError::new(
            path,
            "a record file",
            "an empty file",
            "Copy the file anew, or take it out of the campaign.",
        ));
    }
    if let Some((_, reader)) = BY_BYTES.iter().find(|(is, _)| is(&front)) {
        return reader(path);
    }
    let extension = path
        .extension()
        .and_then(|e| e.to_str())
        .map(str::to_ascii_lowercase)
        .unwrap_or_default();
    match BY_EXTENSION
        .iter()
        .find(|(names, _)| names.contains(&extension.as_str()))
    {
        Some((_, reader)) => reader(path),
        None if looks_like_text(&front) => csv::open(path),
        None => Err(unknown(path, &front)),
    }
}

/// HDF5's mark stands at the front, or behind a user block of 512, 1024 or 2048 bytes.
fn is_hdf5(front: &[u8]) -> bool {
    [0usize, 512, 1024, 2048].iter().any(|&at| {
        front
            .get(at..)
            .is_some_and(|b| b.starts_with(&hdf5::SIGNATURE))
    })
}

fn is_parquet(front: &[u8]) -> bool {
    front.starts_with(&parquet::SIGNATURE)
}

/// A LabVIEW measurement says so in its first words.
fn is_lvm(front: &[u8]) -> bool {
    let text = front.strip_prefix(&[0xEF, 0xBB, 0xBF]).unwrap_or(front);
    text.starts_with(lvm::scan::FIRST_WORDS.as_bytes())
}

/// The first bytes of a file.
fn front(path: &Path) -> Result<Vec<u8>, ReadError> {
    let io = |e: std::io::Error| ReadError::io(path, &e);
    let file = File::open(path).map_err(io)?;
    let metadata = file.metadata().map_err(io)?;
    if metadata.is_dir() {
        return Err(ReadError::new(
            path,
            "a file",
            "a directory",
            "Name a file, or a glob of files.",
        ));
    }
    let mut bytes = vec![0; metadata.len().min(FRONT_BYTES as u64) as usize];
    read_exact_at(&file, &mut bytes, 0).map_err(io)?;
    Ok(bytes)
}

/// Whether bytes are text: no control characters but blanks and line ends, or a UTF-16 mark.
fn looks_like_text(front: &[u8]) -> bool {
    let utf16 = front.starts_with(&[0xFF, 0xFE]) || front.starts_with(&[0xFE, 0xFF]);
    utf16
        || !front
            .iter()
            .any(|&b| b < b' ' && !matches!(b, b'\t' | b'\n' | b'\r' | 0x0C))
}

fn unknown(path: &Path, front: &[u8]) -> ReadError {
    let bytes: Vec<String> = front.iter().take(8).map(|b| format!("{b:02x}")).collect();
    ReadError::new(
        path,
        "HDF5, Parquet, MATLAB, TDMS, UFF, WAV, LVM or a text table",
        format!("bytes {} of no known format", bytes.join(" ")),
        "Convert the file with the program that wrote it, for example to CSV.",
    )
    .at(0)
}
