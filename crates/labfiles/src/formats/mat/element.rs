//! Elements of a level 5 file: tags, and the short lists before an array's data.

use super::inflate::Stream;
use crate::bytes::{FileBytes, to_usize};
use crate::numbers::{ByteOrder, Number};
use crate::source::ReadError;

/// Longest list of dimensions or of names that is accepted, bytes.
const LONGEST_LIST: u64 = 1 << 20;

/// Reads the elements of one variable, forward.
pub(super) struct Elements<'a> {
    file: &'a FileBytes,
    /// The stream that holds the variable, if it is compressed.
    stream: Option<Box<Stream<'a>>>,
    order: ByteOrder,
    /// The last tag read and its offset: a small element's data are in it.
    last: (u64, [u8; 8]),
}

/// An element's kind and the place of its data.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tag {
    /// Kind of the data.
    pub kind: u32,
    /// Their length.
    pub bytes: u64,
    /// Their offset.
    pub at: u64,
    /// Offset of the next element.
    pub next: u64,
}

impl<'a> Elements<'a> {
    /// The elements of a variable.
    pub(super) fn new(
        file: &'a FileBytes,
        stream: Option<Box<Stream<'a>>>,
        order: ByteOrder,
    ) -> Self {
        Self {
            file,
            stream,
            order,
            last: (0, [0; 8]),
        }
    }

    /// The byte order of the numbers.
    pub(super) fn order(&self) -> ByteOrder {
        self.order
    }

    /// An error at an offset of the variable.
    pub(super) fn refuse(
        &self,
        at: u64,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> ReadError {
        match &self.stream {
            None => self.file.refuse(at, expected, found),
            Some(stream) => {
                let found = format!("{} (byte {at} of the inflated variable)", found.into());
                self.file.refuse(stream.at, expected, found)
            }
        }
    }

    fn fetch(&mut self, at: u64, length: u64, what: &str) -> Result<Vec<u8>, ReadError> {
        match &mut self.stream {
            None => Ok(self.file.slice(at, length, what)?.to_vec()),
            Some(stream) => {
                let mut buffer = vec![0; to_usize(length)];
                stream.read_at(at, &mut buffer, what)?;
                Ok(buffer)
            }
        }
    }

    /// The 32-bit number in four bytes.
    pub(super) fn word(&self, bytes: &[u8]) -> u32 {
        self.order.u32([bytes[0], bytes[1], bytes[2], bytes[3]])
    }

    /// The tag at an offset; its data end before `end`.
    pub(super) fn tag(&mut self, at: u64, end: u64, what: &str) -> Result<Tag, ReadError> {
        if at.saturating_add(8) > end {
            let found = format!("only {} bytes left", end.saturating_sub(at));
            return Err(self.refuse(at, format!("the tag of {what}"), found));
        }
        let head = self.fetch(at, 8, what)?;
        self.last.0 = at;
        self.last.1.copy_from_slice(&head);
        let first = self.word(&head[..4]);
        if first >> 16 != 0 {
            let (kind, bytes) = (first & 0xffff, u64::from(first >> 16));
            if bytes > 4 {
                return Err(self.refuse(
                    at,
                    "at most 4 bytes in a small element",
                    bytes.to_string(),
                ));
            }
            return Ok(Tag {
                kind,
                bytes,
                at: at + 4,
                next: at + 8,
            });
        }
        let bytes = u64::from(self.word(&head[4..]));
        let data = at + 8;
        if bytes > end - data {
            let found = format!("{bytes} bytes where {} are left", end - data);
            return Err(self.refuse(at, what, found));
        }
        Ok(Tag {
            kind: first,
            bytes,
            at: data,
            next: (data + bytes.next_multiple_of(8)).min(end),
        })
    }

    /// The data of a short element (a list of dimensions or names).
    pub(super) fn list(&mut self, tag: Tag, what: &str) -> Result<Vec<u8>, ReadError> {
        if tag.bytes > LONGEST_LIST {
            return Err(self.refuse(tag.at, what, format!("{} bytes", tag.bytes)));
        }
        self.data(tag.at, tag.bytes, what)
    }

    /// The data at an offset; those of a small element were part of the tag just read, and in a
    /// stream are behind the position.
    pub(super) fn data(&mut self, at: u64, bytes: u64, what: &str) -> Result<Vec<u8>, ReadError> {
        let (tag_at, tag) = self.last;
        if at == tag_at + 4 && bytes <= 4 {
            Ok(tag[4..4 + to_usize(bytes)].to_vec())
        } else {
            self.fetch(at, bytes, what)
        }
    }

    /// Whole numbers from 0 to 2^31 - 1.
    pub(super) fn integers(&mut self, tag: Tag, what: &str) -> Result<Vec<u64>, ReadError> {
        let bytes = self.list(tag, what)?;
        if !matches!(tag.kind, 5 | 6) {
            return Err(self.refuse(tag.at, format!("{what} as int32"), kind_name(tag.kind)));
        }
        let (words, _) = bytes.as_chunks();
        let values = words.iter().map(|&word| self.order.u32(word));
        if let Some(wild) = values.clone().find(|v| v.cast_signed() < 0) {
            let found = match tag.kind {
                5 => wild.cast_signed().to_string(),
                _ => wild.to_string(),
            };
            return Err(self.refuse(tag.at, format!("{what} between 0 and 2147483647"), found));
        }
        Ok(values.map(u64::from).collect())
    }

    /// A name in ASCII.
    pub(super) fn ascii(&mut self, tag: Tag, what: &str) -> Result<String, ReadError> {
        let bytes = self.list(tag, what)?;
        if !matches!(tag.kind, 1 | 2 | 16) {
            return Err(self.refuse(tag.at, format!("{what} as int8"), kind_name(tag.kind)));
        }
        if bytes.is_ascii() {
            Ok(String::from_utf8_lossy(&bytes)
                .trim_end_matches('\0')
                .to_owned())
        } else {
            Err(self.refuse(
                tag.at,
                format!("{what} in ASCII"),
                format!("{:?}", String::from_utf8_lossy(&bytes)),
            ))
        }
    }
}

/// The kind of numbers that an element of that kind holds.
pub(super) fn number_of(kind: u32) -> Option<Number> {
    Some(match kind {
        1 => Number::I8,
        2 => Number::U8,
        3 => Number::I16,
        4 => Number::U16,
        5 => Number::I32,
        6 => Number::U32,
        7 => Number::F32,
        9 => Number::F64,
        12 => Number::I64,
        13 => Number::U64,
        _ => return None,
    })
}

/// The kind of an element, for a message.
pub(super) fn kind_name(kind: u32) -> String {
    match (kind, number_of(kind)) {
        (_, Some(number)) => format!("an element of {}", number.stored().name()),
        (14, _) => "a matrix element".into(),
        (15, _) => "a compressed element".into(),
        (16..=18, _) => "an element of text".into(),
        _ => format!("an element of unknown kind {kind}"),
    }
}
