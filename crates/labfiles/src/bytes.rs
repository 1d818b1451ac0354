//! The bytes of an open instrument file: mapped, bounds-checked, in either byte order.
//!
//! Every reader of a binary format takes its bytes from here, so that no length a file claims
//! is used before the file is known to hold it.

use std::borrow::Cow;
use std::cell::Cell;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use memmap2::Mmap;

use super::source::ReadError;

/// The order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ByteOrder {
    /// Least significant byte first.
    Little,
    /// Most significant byte first.
    Big,
}

impl ByteOrder {
    /// The 32-bit number that four bytes hold.
    pub(crate) fn u32(self, bytes: [u8; 4]) -> u32 {
        match self {
            Self::Little => u32::from_le_bytes(bytes),
            Self::Big => u32::from_be_bytes(bytes),
        }
    }
}

const DAMAGED: &str = "the file is damaged or was cut short: copy or export it again";

thread_local! {
    /// Whether this thread reads files into memory instead of mapping them.
    static READS: Cell<bool> = const { Cell::new(false) };
}

/// The greatest file that is read into memory, bytes: a greater one is mapped, as it may have no room there.
const MOST_READ: u64 = 1 << 30;

/// Do what opens files; they are read into memory instead of mapped. A map keeps other programs from replacing a file on
/// Windows, and one that they cut short ends the program that has it mapped.
pub(crate) fn reading<T>(open: impl FnOnce() -> T) -> T {
    /// Ends the reading, after a panic too.
    struct Before(bool);
    impl Drop for Before {
        fn drop(&mut self) {
            READS.set(self.0);
        }
    }
    let _before = Before(READS.replace(true));
    open()
}

/// A file mapped into memory for reading, or read into it.
#[derive(Debug)]
pub(crate) struct FileBytes {
    path: PathBuf,
    file: File,
    map: Option<Mmap>,
    /// Bytes in memory: what its text says instead of the file's own, or those of a file that is read.
    held: Option<Vec<u8>>,
}

impl FileBytes {
    /// Map a file, or read it where [`reading`] asks for that. An empty file is a valid, empty sequence of bytes.
    ///
    /// # Errors
    /// If the system does not open or map it.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let fault = |error: std::io::Error| ReadError::io(path, &error);
        let mut file = File::open(path).map_err(fault)?;
        let length = file.metadata().map_err(fault)?.len();
        if READS.get() && length <= MOST_READ {
            let mut bytes = Vec::with_capacity(to_usize(length));
            file.read_to_end(&mut bytes).map_err(fault)?;
            return Ok(Self {
                path: path.to_path_buf(),
                file,
                map: None,
                held: Some(bytes),
            });
        }
        let map = match length {
            0 => None,
            // SAFETY: the map is only read, and readers ask `still_whole` before they do: a file
            // that another program cuts short in the very moment of reading ends this program
            // with a bus error, as with every mapped reader.
            _ => Some(unsafe { Mmap::map(&file) }.map_err(fault)?),
        };
        Ok(Self {
            path: path.to_path_buf(),
            file,
            map,
            held: None,
        })
    }

    /// The file with other bytes, into which its own were translated.
    pub(crate) fn holding(self, bytes: Vec<u8>) -> Self {
        Self {
            held: Some(bytes),
            ..self
        }
    }

    /// Make sure that the file was not cut short since it was opened; one that grew or was
    /// renamed is read as it was.
    ///
    /// # Errors
    /// If it was, with the byte at which it now ends.
    pub(crate) fn still_whole(&self) -> Result<(), ReadError> {
        let length = self
            .file
            .metadata()
            .map_err(|e| ReadError::io(&self.path, &e))?
            .len();
        if length >= self.mapped().len() as u64 {
            return Ok(());
        }
        Err(self.unsupported(
            length,
            format!("only {length}: it was cut short while it was read"),
            format!("the file's {} bytes", self.mapped().len()),
            "let no other program write the file while it is read, and run again",
        ))
    }

    /// The file's path.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// All bytes.
    pub(crate) fn all(&self) -> &[u8] {
        self.held.as_deref().unwrap_or_else(|| self.mapped())
    }

    fn mapped(&self) -> &[u8] {
        self.map.as_deref().unwrap_or(&[])
    }

    /// Number of bytes.
    pub(crate) fn size(&self) -> u64 {
        self.all().len() as u64
    }

    /// The bytes `at..at + length`, which are called `what` if the file does not hold them.
    pub(crate) fn slice(&self, at: u64, length: u64, what: &str) -> Result<&[u8], ReadError> {
        let end = at.checked_add(length).filter(|&end| end <= self.size());
        match end {
            Some(end) => Ok(&self.all()[to_usize(at)..to_usize(end)]),
            None => Err(self.refuse(
                at,
                format!("{length} bytes of {what}"),
                format!("only {} bytes left", self.size().saturating_sub(at)),
            )),
        }
    }

    /// An error at a byte: what was expected and what was found.
    pub(crate) fn refuse(
        &self,
        at: u64,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> ReadError {
        self.unsupported(at, found, expected, DAMAGED)
    }

    /// An error for something valid that this program does not read, with the remedy.
    pub(crate) fn unsupported(
        &self,
        at: u64,
        found: impl Into<String>,
        expected: impl Into<String>,
        remedy: impl Into<String>,
    ) -> ReadError {
        ReadError::new(&self.path, expected, found, remedy).at(at)
    }

    /// A cursor over the whole file.
    pub(crate) fn cursor(&self, order: ByteOrder) -> Cursor<'_> {
        Cursor {
            file: self,
            at: 0,
            end: self.size(),
            order,
        }
    }
}

/// A position in a file that moves forward by checked reads.
#[derive(Debug, Clone)]
pub(crate) struct Cursor<'a> {
    file: &'a FileBytes,
    at: u64,
    end: u64,
    order: ByteOrder,
}

impl<'a> Cursor<'a> {
    /// Offset of the next byte in the file.
    pub(crate) fn at(&self) -> u64 {
        self.at
    }

    /// Bytes left before the cursor's end.
    pub(crate) fn left(&self) -> u64 {
        self.end.saturating_sub(self.at)
    }

    /// The byte order of the numbers that follow.
    pub(crate) fn set_order(&mut self, order: ByteOrder) {
        self.order = order;
    }

    /// Move to an offset of the file.
    pub(crate) fn seek(&mut self, at: u64) {
        self.at = at;
    }

    /// A cursor over `at..end` of the same file.
    pub(crate) fn part(&self, at: u64, end: u64) -> Self {
        Cursor {
            file: self.file,
            at,
            end: end.min(self.file.size()),
            order: self.order,
        }
    }

    /// The next bytes, called `what` in an error.
    pub(crate) fn take(&mut self, length: u64, what: &str) -> Result<&'a [u8], ReadError> {
        if length > self.left() {
            let found = format!("only {} bytes left", self.left());
            return Err(self
                .file
                .refuse(self.at, format!("{length} bytes of {what}"), found));
        }
        let bytes = self.file.slice(self.at, length, what)?;
        self.at += length;
        Ok(bytes)
    }

    fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], ReadError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N as u64, what)?);
        if self.order == ByteOrder::Big {
            array.reverse();
        }
        Ok(array)
    }

    /// The next unsigned byte.
    pub(crate) fn u8(&mut self, what: &str) -> Result<u8, ReadError> {
        Ok(self.array::<1>(what)?[0])
    }

    /// The next 16-bit unsigned integer.
    pub(crate) fn u16(&mut self, what: &str) -> Result<u16, ReadError> {
        Ok(u16::from_le_bytes(self.array(what)?))
    }

    /// The next 32-bit unsigned integer.
    pub(crate) fn u32(&mut self, what: &str) -> Result<u32, ReadError> {
        Ok(u32::from_le_bytes(self.array(what)?))
    }

    /// The next 64-bit unsigned integer.
    pub(crate) fn u64(&mut self, what: &str) -> Result<u64, ReadError> {
        Ok(u64::from_le_bytes(self.array(what)?))
    }

    /// An error at the cursor's position.
    pub(crate) fn refuse(
        &self,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> ReadError {
        self.file.refuse(self.at, expected, found)
    }
}

/// A length or an offset in memory. One beyond what memory can address, on a machine of 32 bits,
/// becomes the greatest, so that the slice it asks for does not exist.
pub(crate) fn to_usize(length: u64) -> usize {
    usize::try_from(length).unwrap_or(usize::MAX)
}

/// Read at an offset without moving a position that threads would share.
#[cfg(unix)]
pub(crate) fn read_exact_at(file: &File, into: &mut [u8], offset: u64) -> std::io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, into, offset)
}

/// Read at an offset without relying on a position that threads share.
#[cfg(windows)]
pub(crate) fn read_exact_at(
    file: &File,
    mut into: &mut [u8],
    mut offset: u64,
) -> std::io::Result<()> {
    while !into.is_empty() {
        let n = std::os::windows::fs::FileExt::seek_read(file, into, offset)?;
        if n == 0 {
            return Err(std::io::ErrorKind::UnexpectedEof.into());
        }
        into = &mut into[n..];
        offset += n as u64;
    }
    Ok(())
}

/// Text of unknown encoding: UTF-8 if it is valid, else Windows-1252 (of which every byte
/// sequence is valid), so that `m/s²` of an older instrument survives.
pub(crate) fn decode_text(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => {
            encoding_rs::WINDOWS_1252
                .decode_without_bom_handling(bytes)
                .0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(content: &[u8]) -> (tempfile::NamedTempFile, FileBytes) {
        let temp = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(temp.path(), content).unwrap();
        let bytes = FileBytes::open(temp.path()).unwrap();
        (temp, bytes)
    }

    #[test]
    fn cursor_reads_both_orders_and_refuses_the_end() {
        let (_keep, bytes) = file(&[1, 0, 0, 0, 0, 0, 0, 1, 9]);
        let mut cursor = bytes.cursor(ByteOrder::Little);
        assert_eq!(cursor.u32("a number").unwrap(), 1);
        cursor.set_order(ByteOrder::Big);
        assert_eq!(cursor.u32("a number").unwrap(), 1);
        let error = cursor.u16("a length").unwrap_err();
        assert_eq!(error.byte, Some(8));
        assert!(error.to_string().contains("2 bytes of a length"), "{error}");
        assert!(bytes.slice(u64::MAX, 2, "data").is_err());
    }

    #[test]
    fn a_file_that_is_read_stays_as_it_was() {
        let (temp, mapped) = file(b"abc");
        let read = reading(|| FileBytes::open(temp.path())).unwrap();
        assert!(mapped.map.is_some() && read.map.is_none());
        std::fs::write(temp.path(), b"x").unwrap();
        assert_eq!(read.all(), b"abc");
        assert!(read.still_whole().is_ok() && mapped.still_whole().is_err());
        assert!(FileBytes::open(temp.path()).unwrap().map.is_some());
    }

    #[test]
    fn empty_and_missing_files() {
        let (_keep, bytes) = file(&[]);
        assert_eq!(bytes.size(), 0);
        assert!(FileBytes::open(Path::new("/nonexistent/x.tdms")).is_err());
    }

    #[test]
    fn text_in_old_code_page() {
        assert_eq!(decode_text(b"m/s\xb2"), "m/s²");
        assert_eq!(decode_text("m/s²".as_bytes()), "m/s²");
    }
}
