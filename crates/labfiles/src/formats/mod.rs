//! The formats, a module each, and which of them opens a file: its first bytes decide, then its name, then its text.

pub(crate) mod csv;
pub(crate) mod documents;
pub(crate) mod excel;
pub(crate) mod hdf5;
pub(crate) mod lvm;
pub(crate) mod mat;
pub(crate) mod parquet;
pub(crate) mod tdms;
pub(crate) mod uff;
pub(crate) mod wav;

use std::fs::File;
use std::path::Path;

use crate::bytes::{read_exact_at, reading, to_usize};
use crate::formats::documents::Document;
use crate::source::{ReadError, Source};

/// Bytes at the front of a file by which formats are recognised.
const FRONT_BYTES: usize = 4096;

/// A file format.
struct Format {
    /// In messages and documents.
    title: &'static str,
    /// Whether a file's first bytes are those of the format.
    is: fn(&[u8]) -> bool,
    /// Opens a file of the format.
    open: fn(&Path) -> Result<Box<dyn Source>, ReadError>,
}

/// The formats in the order in which they are tried; text tables are the last, as many texts are no tables.
#[rustfmt::skip]
static FORMATS: &[Format] = &[
    Format { title: "HDF5", is: hdf5::recognises, open: hdf5::open },
    Format { title: "LVM", is: lvm::recognises, open: lvm::open },
    Format { title: "Parquet", is: parquet::recognises, open: parquet::open },
    Format { title: "TDMS", is: tdms::recognises, open: tdms::open },
    Format { title: "UFF 58", is: uff::recognises, open: uff::open },
    Format { title: "WAV", is: wav::recognises, open: wav::open },
    Format { title: "MATLAB", is: mat::recognises, open: mat::open },
    Format { title: "Excel", is: excel::recognises, open: excel::open },
    Format { title: "CSV", is: csv::recognises, open: csv::open },
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
    if let Some(document) = Document::of(&front) {
        return Err(document.refused(path));
    }
    let by_bytes = FORMATS.iter().find(|format| (format.is)(&front));
    match by_bytes.or_else(|| by_name(path)) {
        Some(format) => (format.open)(path),
        None => Err(unknown(path, &front)),
    }
}

/// As [`open`], for a file that another program may be writing: it is not mapped, so that it may be replaced or cut short
/// meanwhile.
///
/// # Errors
/// Those of [`open`].
pub fn open_growing(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    reading(|| open(path))
}

/// Titles of the formats that [`open`] reads.
///
/// ```
/// assert!(labfiles::format_titles().contains(&"HDF5"));
/// ```
pub fn format_titles() -> Vec<&'static str> {
    FORMATS.iter().map(|format| format.title).collect()
}

/// Text tables, if a file's extension is one of theirs.
fn by_name(path: &Path) -> Option<&'static Format> {
    let extension = path.extension()?;
    let is_table = TABLES.iter().any(|t| extension.eq_ignore_ascii_case(t));
    FORMATS.last().filter(|_| is_table)
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

fn unknown(path: &Path, front: &[u8]) -> ReadError {
    let bytes: Vec<String> = front.iter().take(8).map(|b| format!("{b:02x}")).collect();
    ReadError::new(
        path,
        format!("{} or another text table", format_titles().join(", ")),
        format!("bytes {} of no known format", bytes.join(" ")),
        "convert the file with the program that wrote it, for example to CSV",
    )
    .at(0)
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};
    use std::ffi::OsString;
    use std::path::PathBuf;

    use super::*;
    use crate::conformance::{Random, mutate, mutate_text, own_files, survive_within};

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

    /// The most memory of a reader: a multiple of the file, and what its library takes whatever the file.
    fn most_memory(format: &Format) -> [usize; 2] {
        match format.title {
            "HDF5" => [1200, 8 << 20],
            // A panic of the library that is caught may print a trace, for which the debugging
            // information of the program is loaded.
            "Parquet" => [1200, 256 << 20],
            // A sheet is laid out with up to 64 cells for each that it holds.
            "Excel" => [2000, 64 << 20],
            _ => [64, 1 << 20],
        }
    }

    /// Change bytes at random, more often at the end than before it: some formats have their index there.
    fn mutate_end(random: &mut Random, bytes: &mut Vec<u8>) {
        bytes.reverse();
        mutate(random, bytes);
        bytes.reverse();
    }

    /// The format of one of the repository's own files; the programs that made them are none.
    fn format_of(path: &Path) -> Option<&'static Format> {
        let bytes = std::fs::read(path).unwrap();
        let is_program = path.extension().is_some_and(|ending| ending == "py");
        let mut recognising = FORMATS.iter().filter(|format| (format.is)(&bytes));
        recognising.next().filter(|_| !is_program)
    }

    /// The repository's own files of a format, by their endings.
    fn goldens(format: &Format) -> BTreeMap<OsString, Vec<Vec<u8>>> {
        let is_own = |path: &PathBuf| format_of(path).is_some_and(|f| f.title == format.title);
        let mut found: BTreeMap<OsString, Vec<_>> = BTreeMap::new();
        for path in own_files().filter(is_own) {
            let ending = path.extension().unwrap_or_default().to_owned();
            let of_ending = found.entry(ending).or_default();
            of_ending.push(std::fs::read(&path).unwrap());
        }
        found
    }

    /// No damaged file of a format makes a panic, takes long or much memory.
    fn survives(format: &Format, seeds: &[Vec<u8>]) {
        let memory = most_memory(format);
        if seeds.iter().all(|seed| std::str::from_utf8(seed).is_ok()) {
            return survive_within(seeds, format.open, mutate_text, memory);
        }
        survive_within(seeds, format.open, mutate, memory);
        survive_within(seeds, format.open, mutate_end, memory);
    }

    #[test]
    fn prop_mutated_files_of_every_format_are_read_or_refused() {
        std::thread::scope(|threads| {
            for format in FORMATS {
                let goldens = goldens(format);
                assert!(!goldens.is_empty(), "no golden of {}", format.title);
                threads.spawn(move || goldens.values().for_each(|seeds| survives(format, seeds)));
            }
        });
    }

    #[test]
    fn every_format_has_a_golden_that_is_read() {
        let read = |path: PathBuf| {
            let format = format_of(&path)?;
            (format.open)(&path).is_ok().then_some(format.title)
        };
        let titles: BTreeSet<&str> = own_files().filter_map(read).collect();
        assert_eq!(titles, format_titles().into_iter().collect());
    }
}
