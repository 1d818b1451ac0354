//! One pass through a `LabVIEW` measurement file: its headers and the places of its tables.

use std::collections::BTreeMap;

use crate::source::ReadError;
use crate::text::cells::{Cells, Lines, Separator};
use crate::text::{TextFile, decode, number};

/// The first words of a `LabVIEW` measurement file.
pub(crate) const FIRST_WORDS: &str = "LabVIEW Measurement";
const END_OF_HEADER: &[u8] = b"***End_of_Header***";
const START_SPECIAL: &[u8] = b"***Start_Special***";
const END_SPECIAL: &[u8] = b"***End_Special***";

/// Keys of a header with their values, one for each channel or one for all.
pub(crate) type Keys = BTreeMap<String, Vec<String>>;

/// One table of the file with the header above it.
#[derive(Debug, Default, Clone)]
pub(crate) struct Segment {
    /// The segment's own header.
    pub keys: Keys,
    /// Headings of the columns.
    pub headings: Vec<String>,
    /// Offset of the first row.
    pub start: u64,
    /// Offset after the last row.
    pub end: u64,
    /// Number of rows.
    pub rows: u64,
    /// Offset of the last row.
    pub last: u64,
}

/// What a pass through the file found.
pub(crate) struct Scan {
    /// The file's header.
    pub keys: Keys,
    /// The separator between two cells.
    pub separator: Separator,
    /// The tables.
    pub segments: Vec<Segment>,
    /// What was left out.
    pub notes: Vec<String>,
}

/// Go through the file.
///
/// # Errors
/// If a header does not end, or there is no table.
pub(crate) fn scan(text: &TextFile) -> Result<Scan, ReadError> {
    let mut pass = Pass {
        scan: Scan {
            keys: Keys::new(),
            separator: separator(&text.head(4096)?),
            segments: Vec::new(),
            notes: Vec::new(),
        },
        state: State::FileHeader,
        segment: Segment::default(),
        header_at: text.start(),
    };
    text.blocks(text.start(), false, |offset, block| {
        for (at, line) in Lines::new(block, false) {
            pass.line(line, offset + at as u64);
        }
        Ok(())
    })?;
    pass.finish(text)
}

/// The separator that the header announces by using it: `Separator<here>Tab`.
fn separator(head: &[u8]) -> Separator {
    for (_, line) in Lines::new(head, false).take(40) {
        let word = line.strip_prefix(b"Separator").unwrap_or_default();
        if let [mark, ..] = word {
            return Separator::Byte(*mark);
        }
    }
    Separator::Byte(b'\t')
}

enum State {
    /// Before the file's header ends.
    FileHeader,
    /// Before a segment's header ends.
    SegmentHeader,
    /// On the line of headings.
    Headings,
    /// Among the rows.
    Rows,
    /// In a special block, and what follows it.
    Special(Box<Self>),
}

struct Pass {
    scan: Scan,
    state: State,
    segment: Segment,
    header_at: u64,
}

impl Pass {
    fn line(&mut self, line: &[u8], at: u64) {
        let blank = line.trim_ascii().is_empty();
        match &mut self.state {
            State::Special(after) => {
                if line.starts_with(END_SPECIAL) {
                    self.state = std::mem::replace(&mut **after, State::Rows);
                }
            }
            _ if line.starts_with(START_SPECIAL) => self.special(),
            State::Rows => self.row(line, at, blank),
            State::Headings if !blank => self.headings(line, at),
            State::Headings => {}
            State::FileHeader if line.starts_with(END_OF_HEADER) => {
                self.state = State::SegmentHeader;
                self.header_at = at;
            }
            State::SegmentHeader if line.starts_with(END_OF_HEADER) => self.state = State::Headings,
            State::FileHeader => key(line, self.scan.separator, &mut self.scan.keys),
            State::SegmentHeader => key(line, self.scan.separator, &mut self.segment.keys),
        }
    }

    fn special(&mut self) {
        let note = "special segments are left out";
        if self.scan.notes.iter().all(|n| n != note) {
            self.scan.notes.push(note.to_owned());
        }
        let state = std::mem::replace(&mut self.state, State::Rows);
        self.state = State::Special(Box::new(state));
    }

    fn headings(&mut self, line: &[u8], at: u64) {
        self.segment.start = at + line.len() as u64;
        self.segment.end = self.segment.start;
        if is_row(line) {
            // No headings: the rows begin at once.
            self.segment.start = at;
            self.state = State::Rows;
            return self.row(line, at, false);
        }
        self.segment.headings = Cells::new(line, self.scan.separator).map(decode).collect();
        self.state = State::Rows;
    }

    fn row(&mut self, line: &[u8], at: u64, blank: bool) {
        if blank {
            return;
        }
        if is_row(line) {
            self.segment.rows += 1;
            self.segment.last = at;
            self.segment.end = at + line.len() as u64 + 1;
            return;
        }
        let done = std::mem::take(&mut self.segment);
        self.scan.segments.push(done);
        self.header_at = at;
        self.state = State::SegmentHeader;
        if line.starts_with(END_OF_HEADER) {
            self.state = State::Headings;
        } else {
            key(line, self.scan.separator, &mut self.segment.keys);
        }
    }

    fn finish(mut self, text: &TextFile) -> Result<Scan, ReadError> {
        match self.state {
            State::Rows => self.scan.segments.push(self.segment),
            State::Special(_) => {
                self.scan.segments.push(self.segment);
                self.scan
                    .notes
                    .push("the last special segment does not end".to_owned());
            }
            // An empty header after the last table is the end of the file.
            State::SegmentHeader
                if !self.scan.segments.is_empty() && self.segment.keys.is_empty() => {}
            _ => return Err(self.unfinished(text)),
        }
        self.scan.segments.retain(|s| s.rows > 0);
        if self.scan.segments.is_empty() {
            return Err(no_rows(text));
        }
        Ok(self.scan)
    }

    fn unfinished(&self, text: &TextFile) -> ReadError {
        ReadError::new(
            text.path(),
            "***End_of_Header*** and rows of numbers after the header",
            "the end of the file",
            "copy the file again from the instrument: it is cut off",
        )
        .at(self.header_at)
    }
}

fn no_rows(text: &TextFile) -> ReadError {
    ReadError::new(
        text.path(),
        "rows of numbers after ***End_of_Header***",
        "none",
        "check that the measurement was saved into this file",
    )
    .at(text.length())
}

/// Whether a line is a row of the table: it begins with a number or with an empty X cell. A
/// header begins with a word.
fn is_row(line: &[u8]) -> bool {
    match line.first() {
        None => false,
        Some(b) if b.is_ascii_alphabetic() || *b == b'*' => {
            let word: &[u8] = line
                .split(|b| matches!(b, b'\t' | b',' | b';'))
                .next()
                .unwrap_or_default();
            number::parse_cell(word, b'.').is_some()
        }
        Some(_) => true,
    }
}

/// Take over a line of a header.
fn key(line: &[u8], separator: Separator, keys: &mut Keys) {
    let mut cells = Cells::new(line, separator).map(decode);
    let Some(name) = cells.next().filter(|n| !n.is_empty()) else {
        return;
    };
    keys.insert(name, cells.collect());
}
