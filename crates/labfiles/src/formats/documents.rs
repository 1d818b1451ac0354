//! Files that are no tables of numbers and might be taken for some: documents, JSON, and archives that are no workbooks.

use std::io::Read as _;
use std::path::Path;

use crate::source::ReadError;

/// Bytes at the front of a file by which it is recognised.
const FRONT_BYTES: u64 = 4096;

/// What a file is that no reader reads, and what to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Document {
    /// In words, after "it is".
    pub what: &'static str,
    remedy: &'static str,
}

const NUMBERS: &str =
    "name the file with the numbers that the document shows, or export them as CSV";
const JSON: Document = Document {
    what: "JSON",
    remedy: "write the numbers as CSV, one row for each sample below a heading of channel names",
};
const NUMPY: Document = Document {
    what: "arrays of NumPy",
    remedy: "save them as CSV with numpy.savetxt, one column for each channel, or as .mat with scipy.io.savemat",
};
const OPEN_DOCUMENT: Document = Document {
    what: "an OpenDocument spreadsheet",
    remedy: "save it as .xlsx or CSV in the spreadsheet program",
};
const ARCHIVE: Document = Document {
    what: "a ZIP archive of files",
    remedy: "unpack it, and name the files in it",
};

/// Documents that hold text in lines: their first bytes, and what they are.
const TEXTS: [(&[u8], &str); 5] = [
    (b"%PDF-", "a PDF document"),
    (b"{\\rtf", "a document in rich text"),
    (b"<!DOCTYPE", "an HTML page"),
    (b"<html", "an HTML page"),
    (b"%!PS", "a PostScript document"),
];

/// First bytes of a file of `NumPy`.
const NPY: &[u8] = b"\x93NUMPY";
/// First bytes of a ZIP archive, and where the name of its first file and the length of that are.
const ZIP: &[u8] = b"PK\x03\x04";
const NAME_LENGTH_AT: usize = 26;
const NAME_AT: usize = 30;
/// How names of records end that may be in an archive.
const RECORDS: [&str; 8] = [
    ".csv", ".txt", ".dat", ".tsv", ".mat", ".lvm", ".tdms", ".h5",
];

impl Document {
    /// What a file with these first bytes is; `None` of one that a reader may read.
    pub(crate) fn of(front: &[u8]) -> Option<Self> {
        let text = TEXTS.iter().find(|(first, _)| front.starts_with(first));
        let text = text.map(|(_, what)| Self {
            what,
            remedy: NUMBERS,
        });
        text.or_else(|| is_json(front).then_some(JSON))
            .or_else(|| front.starts_with(NPY).then_some(NUMPY))
            .or_else(|| archive(front))
    }

    /// That a file is one.
    pub(crate) fn refused(self, path: &Path) -> ReadError {
        ReadError::new(path, "a record file", self.what, self.remedy)
    }
}

/// What a file is where it is a document, JSON or an archive, of which no reader makes a record.
///
/// ```
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("report.pdf");
/// std::fs::write(&path, "%PDF-1.7\n")?;
/// assert_eq!(labfiles::document(&path), Some("a PDF document"));
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn document(path: &Path) -> Option<&'static str> {
    let mut front = Vec::new();
    let file = std::fs::File::open(path).ok()?;
    file.take(FRONT_BYTES).read_to_end(&mut front).ok()?;
    Document::of(&front).map(|document| document.what)
}

/// Whether a text begins as JSON does: an object with its first key, or an array of objects, arrays, numbers or texts.
fn is_json(front: &[u8]) -> bool {
    let front = front.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(front);
    let front = front.trim_ascii_start();
    let after = |mark: u8| {
        let rest = front.strip_prefix(&[mark])?.trim_ascii_start();
        Some(rest)
    };
    let key = |rest: &[u8]| {
        let end = rest
            .strip_prefix(b"\"")
            .and_then(|r| Some(&r[memchr::memchr(b'"', r)? + 1..]));
        end.is_some_and(|rest| rest.trim_ascii_start().starts_with(b":"))
    };
    let element = |rest: &[u8]| {
        let end = rest.iter().position(|b| matches!(b, b',' | b'\n'));
        let number = end.and_then(|end| std::str::from_utf8(&rest[..end]).ok());
        let is_number = number.is_some_and(|n| n.trim().parse::<f64>().is_ok());
        rest.starts_with(b"{") || rest.starts_with(b"[") || is_number
    };
    after(b'{').is_some_and(key) || after(b'[').is_some_and(element)
}

/// What a ZIP archive is by its first file; `None` of a workbook.
fn archive(front: &[u8]) -> Option<Document> {
    let header = front.strip_prefix(ZIP).map(|_| front)?;
    let length: [u8; 2] = header
        .get(NAME_LENGTH_AT..NAME_LENGTH_AT + 2)?
        .try_into()
        .ok()?;
    let end = NAME_AT + usize::from(u16::from_le_bytes(length));
    let name = String::from_utf8_lossy(header.get(NAME_AT..end)?).to_lowercase();
    let content = header.get(end..)?;
    if name.ends_with(".npy") {
        return Some(NUMPY);
    }
    if name == "mimetype" {
        let kind = b"opendocument.spreadsheet";
        return memchr::memmem::find(content, kind).map(|_| OPEN_DOCUMENT);
    }
    RECORDS
        .iter()
        .any(|end| name.ends_with(end))
        .then_some(ARCHIVE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn documents_json_and_archives_are_named_with_the_remedy() {
        let zip = |name: &str, content: &str| {
            let mut bytes = vec![0; NAME_AT];
            bytes[..4].copy_from_slice(ZIP);
            bytes[NAME_LENGTH_AT] = u8::try_from(name.len()).unwrap();
            bytes.extend(name.bytes().chain(content.bytes()));
            bytes
        };
        let spreadsheet = "application/vnd.oasis.opendocument.spreadsheet";
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("r");
        for (bytes, what, remedy) in [
            (b"{\"fs\": 1000, \"x\": [0.1, 0.2]}".to_vec(), "JSON", "CSV"),
            (b"[\n  {\"t\": 0}\n]".to_vec(), "JSON", "CSV"),
            (b"[[0, 1], [1, 2]]".to_vec(), "JSON", "CSV"),
            (b"[0.5, 1, 2]".to_vec(), "JSON", "CSV"),
            (
                b"{\"t\":0,\"x\":1}\n{\"t\":1,\"x\":2}\n".to_vec(),
                "JSON",
                "CSV",
            ),
            (zip("t.npy", ""), "arrays of NumPy", "numpy.savetxt"),
            (NPY.to_vec(), "arrays of NumPy", "scipy.io.savemat"),
            (
                zip("mimetype", spreadsheet),
                "an OpenDocument spreadsheet",
                ".xlsx",
            ),
            (zip("Run 1.CSV", ""), "a ZIP archive of files", "unpack"),
            (b"%PDF-1.7\n".to_vec(), "a PDF document", "CSV"),
        ] {
            std::fs::write(&path, &bytes).unwrap();
            let error = crate::open(&path).err().unwrap();
            assert_eq!(error.found, what);
            assert!(error.remedy.contains(remedy), "{error}");
            assert_eq!(document(&path), Some(what));
        }
        for front in [
            &b"[Header]\nrate=1000\n"[..],
            b"[V]\n1\n2\n",
            b"{x}\n1\n",
            b"[1]\n0.5\n",
            &zip("[Content_Types].xml", ""),
            &zip("mimetype", "text"),
            b"PK\x03\x04",
        ] {
            assert_eq!(Document::of(front), None, "{front:?}");
        }
    }
}
