//! Reading text files in blocks of whole lines: what CSV and LVM share.
//!
//! A file is never held whole, except one in UTF-16, one with lines ended by carriage returns alone, be
//! they all or some, and one that is no table of cells, which are transcoded once.

pub(crate) mod cells;
pub(crate) mod clock;
pub(crate) mod decimal;
pub(crate) mod digits;
pub(crate) mod number;
pub(crate) mod table;

use std::fs::File;
use std::path::{Path, PathBuf};

use crate::bytes::{decode_text, read_exact_at, to_usize};
use crate::source::ReadError;

/// Bytes read at a time.
const BLOCK_BYTES: usize = 1 << 17;
/// The longest line that is taken for text.
const LONGEST_LINE_BYTES: usize = 1 << 24;

/// A text file that is read at any offset, by any number of threads.
pub(crate) struct TextFile {
    path: PathBuf,
    backing: Backing,
    length: u64,
    start: u64,
}

enum Backing {
    Disk(File),
    Memory(Vec<u8>),
}

impl TextFile {
    /// Open a file: look at its byte-order mark, transcode UTF-16.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let file = File::open(path).map_err(|e| ReadError::io(path, &e))?;
        let length = file.metadata().map_err(|e| ReadError::io(path, &e))?.len();
        let mut text = Self {
            path: path.to_path_buf(),
            backing: Backing::Disk(file),
            length,
            start: 0,
        };
        let head = text.range(0, 4)?;
        if let Some(encoding) = utf16_of(&head) {
            let bytes = text.range(0, to_usize(length))?;
            let (decoded, _) = encoding.decode_with_bom_removal(&bytes);
            text.length = decoded.len() as u64;
            text.backing = Backing::Memory(decoded.into_owned().into_bytes());
        } else if head.starts_with(&[0xEF, 0xBB, 0xBF]) {
            text.start = 3;
        }
        if text.ends_lines_by_returns()? {
            let mut bytes = text.range(0, to_usize(text.length))?;
            end_lines_alike(&mut bytes);
            text.backing = Backing::Memory(bytes);
        }
        Ok(text)
    }

    /// A text that is held whole, as if it were in a file.
    pub(crate) fn of_bytes(path: &Path, bytes: Vec<u8>) -> Self {
        Self {
            path: path.to_path_buf(),
            length: bytes.len() as u64,
            backing: Backing::Memory(bytes),
            start: 0,
        }
    }

    /// Whether a line at the front ends by a carriage return alone, as old Macintosh programs and some
    /// instruments write them; [`table::count_rows`] refuses a later one.
    fn ends_lines_by_returns(&self) -> Result<bool, ReadError> {
        let front = self.range(0, BLOCK_BYTES)?;
        Ok(lone_return(&front).is_some())
    }

    /// The file's path.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Offset of the first character after a byte-order mark.
    pub(crate) fn start(&self) -> u64 {
        self.start
    }

    /// Number of bytes, after transcoding.
    pub(crate) fn length(&self) -> u64 {
        self.length
    }

    /// The bytes `[offset, offset + count)`, fewer at the end of the file.
    pub(crate) fn range(&self, offset: u64, count: usize) -> Result<Vec<u8>, ReadError> {
        let count = to_usize(self.length.saturating_sub(offset).min(count as u64));
        let mut bytes = vec![0; count];
        self.fill(offset, &mut bytes)?;
        Ok(bytes)
    }

    /// The file's first whole lines, about `count` bytes of them.
    pub(crate) fn head(&self, count: usize) -> Result<Vec<u8>, ReadError> {
        let mut bytes = self.range(self.start, count)?;
        if self.start + (bytes.len() as u64) < self.length {
            let end = memchr::memrchr(b'\n', &bytes).map_or(bytes.len(), |i| i + 1);
            bytes.truncate(end);
        }
        Ok(bytes)
    }

    fn fill(&self, offset: u64, into: &mut [u8]) -> Result<(), ReadError> {
        match &self.backing {
            Backing::Disk(file) => {
                read_exact_at(file, into, offset).map_err(|e| ReadError::io(&self.path, &e))
            }
            Backing::Memory(bytes) => {
                let from = to_usize(offset);
                into.copy_from_slice(&bytes[from..from + into.len()]);
                Ok(())
            }
        }
    }

    /// Give `visit` blocks of whole lines from `offset` to the end, each with its offset.
    ///
    /// Only the last block may end without a line feed. With `quotes`, a line feed between
    /// double quotes does not end a line.
    pub(crate) fn blocks(
        &self,
        offset: u64,
        quotes: bool,
        mut visit: impl FnMut(u64, &[u8]) -> Result<(), ReadError>,
    ) -> Result<(), ReadError> {
        let left = self.length.saturating_sub(offset);
        let mut buffer = vec![0; to_usize(left.min(BLOCK_BYTES as u64))];
        let (mut filled, mut at, mut next) = (0, offset, offset);
        while next < self.length {
            if filled == buffer.len() {
                buffer.resize(2 * filled, 0);
            }
            let more = to_usize(self.length - next).min(buffer.len() - filled);
            self.fill(next, &mut buffer[filled..filled + more])?;
            next += more as u64;
            filled += more;
            let whole = if next == self.length {
                filled
            } else {
                whole_lines(&buffer[..filled], quotes)
            };
            if whole == 0 && filled > LONGEST_LINE_BYTES {
                return Err(self.endless_line(at));
            }
            if whole > 0 {
                visit(at, &buffer[..whole])?;
                buffer.copy_within(whole..filled, 0);
                filled -= whole;
                at += whole as u64;
            }
        }
        Ok(())
    }

    fn endless_line(&self, at: u64) -> ReadError {
        ReadError::new(
            &self.path,
            format!("lines of text of at most {LONGEST_LINE_BYTES} bytes"),
            "a line that does not end",
            "check that the file is a text table and that its quotes are closed",
        )
        .at(at)
    }
}

/// Place of the first carriage return before something else than a line feed; the last byte is not judged.
pub(crate) fn lone_return(bytes: &[u8]) -> Option<usize> {
    memchr::memchr_iter(b'\r', bytes).find(|&i| bytes.get(i + 1).is_some_and(|next| *next != b'\n'))
}

/// Make a line feed of each carriage return that has none after it.
fn end_lines_alike(bytes: &mut [u8]) {
    let mut from = 0;
    while let Some(at) = memchr::memchr(b'\r', &bytes[from..]).map(|i| from + i) {
        if bytes.get(at + 1) != Some(&b'\n') {
            bytes[at] = b'\n';
        }
        from = at + 1;
    }
}

/// Length of the whole lines at the front of a buffer; zero where no line ends in it.
fn whole_lines(buffer: &[u8], quotes: bool) -> usize {
    if !quotes {
        return memchr::memrchr(b'\n', buffer).map_or(0, |i| i + 1);
    }
    let mut open = false;
    let mut end = 0;
    for i in memchr::memchr2_iter(b'\n', b'"', buffer) {
        match buffer[i] {
            b'"' => open = !open,
            _ if !open => end = i + 1,
            _ => {}
        }
    }
    end
}

/// The encoding of a UTF-16 text, by its mark or by the blank halves of ASCII letters.
fn utf16_of(head: &[u8]) -> Option<&'static encoding_rs::Encoding> {
    match head {
        [0xFF, 0xFE, ..] => Some(encoding_rs::UTF_16LE),
        [0xFE, 0xFF, ..] => Some(encoding_rs::UTF_16BE),
        &[a, 0, b, 0] if a.is_ascii_graphic() && b.is_ascii() => Some(encoding_rs::UTF_16LE),
        &[0, a, 0, b] if a.is_ascii_graphic() && b.is_ascii() => Some(encoding_rs::UTF_16BE),
        _ => None,
    }
}

/// Text of a cell; see [`decode_text`].
pub(crate) fn decode(bytes: &[u8]) -> String {
    decode_text(bytes).into_owned()
}
