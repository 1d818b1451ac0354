//! Which reader opens a file: its first bytes decide, then its name, then its text.

use std::fs::File;
use std::path::Path;

use crate::bytes::{read_exact_at, to_usize};
use crate::csv;
use crate::excel;
use crate::hdf5;
use crate::lvm;
use crate::mat;
use crate::parquet;
use crate::source::{ReadError, Source};
use crate::tdms;
use crate::uff;
use crate::wav;

/// Bytes at the front of a file by which formats are recognised.
const FRONT_BYTES: usize = 4096;

/// Opens a file of one format.
type Reader = fn(&Path) -> Result<Box<dyn Source>, ReadError>;
/// Whether a file's first bytes are those of a format.
type Test = fn(&[u8]) -> bool;

/// Formats with a signature: its test and the format's reader, one line each.
#[rustfmt::skip]
const BY_BYTES: &[(Test, Reader)] = &[
    (is_hdf5, hdf5::open),
    (is_lvm, lvm::open),
    (|front| front.starts_with(&parquet::SIGNATURE), parquet::open),
    (tdms::recognises, tdms::open),
    (uff::recognises, uff::open),
    (wav::recognises, wav::open),
    (mat::recognises, mat::open),
    (excel::recognises, excel::open),
];

/// Documents that hold text in lines: their first bytes, and what they are.
const DOCUMENTS: [(&[u8], &str); 5] = [
    (b"%PDF-", "a PDF document"),
    (b"{\\rtf", "a document in rich text"),
    (b"<!DOCTYPE", "an HTML page"),
    (b"<html", "an HTML page"),
    (b"%!PS", "a PostScript document"),
];

/// Extensions of text tables, whatever their first bytes.
const TABLES: [&str; 6] = ["csv", "tsv", "txt", "dat", "asc", "prn"];

/// Open a file of any supported format, reading its metadata only.
///
/// ```
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("run.txt");
/// std::fs::write(&path, "t;x\n0;1,5\n1;2,5\n2;3,5\n")?;
/// let source = labfiles::open(&path)?;
/// assert_eq!(source.format(), "csv");
/// assert_eq!(source.datasets()[0].channels[1].samples, 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the file cannot be read, is empty, is of no supported format, or its reader refuses it.
pub fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let front = front(path)?;
    if front.is_empty() {
        return Err(ReadError::new(
            path,
            "a record file",
            "an empty file",
            "copy the file again, or leave it out",
        ));
    }
    if let Some((_, reader)) = BY_BYTES.iter().find(|(is, _)| is(&front)) {
        return reader(path);
    }
    if let Some((_, kind)) = DOCUMENTS.iter().find(|(first, _)| front.starts_with(first)) {
        let remedy =
            "name the file with the numbers that the document shows, or export them as CSV";
        return Err(ReadError::new(path, "a record file", *kind, remedy));
    }
    let extension = path.extension().unwrap_or_default();
    if TABLES.iter().any(|t| extension.eq_ignore_ascii_case(t)) || looks_like_text(&front) {
        csv::open(path)
    } else {
        Err(unknown(path, &front))
    }
}

/// HDF5's signature is at the front, or after a user block of 512, 1024 or 2048 bytes.
fn is_hdf5(front: &[u8]) -> bool {
    [0usize, 512, 1024, 2048].iter().any(|&at| {
        front
            .get(at..)
            .is_some_and(|b| b.starts_with(&hdf5::SIGNATURE))
    })
}

/// A `LabVIEW` measurement file begins with words of its own.
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
            "name a file, or a glob of files",
        ));
    }
    let mut bytes = vec![0; to_usize(metadata.len().min(FRONT_BYTES as u64))];
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
        "HDF5, Parquet, MATLAB, TDMS, UFF, WAV, LVM, Excel or a text table",
        format!("bytes {} of no known format", bytes.join(" ")),
        "convert the file with the program that wrote it, for example to CSV",
    )
    .at(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_are_no_tables_of_text() {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in [
            ("r.pdf", "%PDF-1.7\n1,2,3\n4,5,6\n"),
            ("p.csv", "<!DOCTYPE html>\n1,2\n3,4\n"),
        ] {
            let path = folder.path().join(name);
            std::fs::write(&path, text).unwrap();
            let error = open(&path).err().unwrap();
            assert!(
                error.found.starts_with("a") && error.remedy.contains("CSV"),
                "{error}"
            );
        }
    }
}
