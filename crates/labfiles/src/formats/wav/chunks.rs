//! The chunks of a RIFF file: format, data, and the texts around them.

use std::collections::BTreeMap;

use crate::bytes::{Cursor, FileBytes, decode_text};
use crate::numbers::ByteOrder;
use crate::source::ReadError;

const PCM: u16 = 1;
const FLOAT: u16 = 3;
const EXTENSIBLE: u16 = 0xfffe;
/// The end of an extensible format's identifier, which all wave formats share.
const WAVE_GUID: [u8; 8] = *b"\x80\0\0\xaa\0\x38\x9b\x71";
/// Longest text that is kept as an attribute, bytes.
const LONGEST_TEXT: u64 = 4096;

/// How samples are stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Format {
    /// Whether they are floating point.
    pub float: bool,
    /// Number of channels.
    pub channels: u16,
    /// Samples per second of each channel.
    pub rate: u32,
    /// Bytes that a sample takes.
    pub bytes: u16,
    /// Bits of it that count; the others are 0.
    pub bits: u16,
}

/// What opening a file finds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Wave {
    /// Byte order of all numbers.
    pub order: ByteOrder,
    /// The format of the samples.
    pub format: Format,
    /// Offset of the samples.
    pub at: u64,
    /// Samples of each channel.
    pub samples: u64,
    /// Texts of the file.
    pub attributes: BTreeMap<String, String>,
    /// Start of the recording, where a broadcast chunk states it.
    pub start_time: Option<String>,
    /// What was skipped or assumed.
    pub notes: Vec<String>,
}

/// Byte order of a wave file, from its first 12 bytes; `None`: it is none.
pub(super) fn byte_order(head: &[u8]) -> Option<ByteOrder> {
    if head.get(8..12)? != b"WAVE" {
        return None;
    }
    match &head[..4] {
        b"RIFF" | b"RF64" | b"BW64" => Some(ByteOrder::Little),
        b"RIFX" => Some(ByteOrder::Big),
        _ => None,
    }
}

struct Scanner<'a> {
    file: &'a FileBytes,
    order: ByteOrder,
    format: Option<Format>,
    data: Option<(u64, u64)>,
    /// Length of the data in a file beyond 4 GiB.
    long: Option<u64>,
    attributes: BTreeMap<String, String>,
    start_time: Option<String>,
    notes: Vec<String>,
}

/// Find the chunks of a file.
pub(super) fn scan(file: &FileBytes) -> Result<Wave, ReadError> {
    let Some(order) = byte_order(file.all()) else {
        let found = format!("{:?}", decode_text(&file.all()[..file.all().len().min(12)]));
        return Err(file.refuse(0, "RIFF, RIFX or RF64 and WAVE", found));
    };
    let mut scanner = Scanner {
        file,
        order,
        format: None,
        data: None,
        long: None,
        attributes: BTreeMap::new(),
        start_time: None,
        notes: Vec::new(),
    };
    let mut cursor = file.cursor(order);
    cursor.seek(12);
    while cursor.left() > 0 {
        if cursor.left() < 8 && scanner.data.is_some() {
            scanner.notes.push(format!(
                "{} bytes after the last chunk: not read",
                cursor.left()
            ));
            break;
        }
        scanner.chunk(&mut cursor)?;
    }
    scanner.finish()
}

impl Scanner<'_> {
    fn chunk(&mut self, cursor: &mut Cursor<'_>) -> Result<(), ReadError> {
        let at = cursor.at();
        let name: [u8; 4] = cursor
            .take(4, "a chunk's name")?
            .try_into()
            .unwrap_or_default();
        let stated = u64::from(cursor.u32("a chunk's length")?);
        let length = match (&name, self.long) {
            (b"data", Some(long)) if stated == u64::from(u32::MAX) => long,
            _ => stated,
        };
        let start = cursor.at();
        let left = self.file.size() - start;
        let end = start.saturating_add(length);
        let mut inner = cursor.part(start, end);
        match &name {
            b"data" => self.data(start, length, left),
            _ if length > left && self.data.is_none() => {
                let found = format!("only {left} bytes left");
                let name = decode_text(&name).into_owned();
                return Err(self.file.refuse(
                    at,
                    format!("{length} bytes of chunk {name:?}"),
                    found,
                ));
            }
            _ if length > left => self
                .notes
                .push(format!("the chunk at byte {at} was cut short")),
            b"fmt " => self.format = Some(self.read_format(&mut inner)?),
            b"ds64" => {
                inner.u64("the length of the file")?;
                self.long = Some(inner.u64("the length of the data")?);
            }
            b"LIST" => self.texts(&mut inner)?,
            b"bext" => self.broadcast(&mut inner),
            _ => {}
        }
        // Chunks begin at even offsets.
        cursor.seek(end.saturating_add(length % 2).min(self.file.size()));
        Ok(())
    }

    fn data(&mut self, start: u64, length: u64, left: u64) {
        if self.data.is_some() {
            self.notes.push(format!(
                "a second data chunk at byte {}: not read",
                start - 8
            ));
            return;
        }
        if length > left {
            let note = format!(
                "{length} bytes of samples stated, {left} are there: the file was cut short"
            );
            self.notes.push(note);
        }
        self.data = Some((start, length.min(left)));
    }

    fn read_format(&self, cursor: &mut Cursor<'_>) -> Result<Format, ReadError> {
        let at = cursor.at();
        let mut tag = cursor.u16("a format tag")?;
        let channels = cursor.u16("the number of channels")?;
        let rate = cursor.u32("the sample rate")?;
        let per_second = cursor.u32("bytes per second")?;
        let block = cursor.u16("bytes per sample of all channels")?;
        let bits = cursor.u16("bits per sample")?;
        if tag == EXTENSIBLE {
            tag = self.extension(cursor)?;
        }
        let fault = |expected: &str, found: String| Err(self.file.refuse(at, expected, found));
        if !matches!(tag, PCM | FLOAT) {
            let remedy = "save the file as PCM or floating point";
            let found = format!("{} samples", codec(tag));
            return Err(self
                .file
                .unsupported(at, found, "PCM or floating point samples", remedy));
        }
        if channels == 0 || rate == 0 || block == 0 || block % channels != 0 {
            let found = format!("{channels} channels, {rate} Hz, {block} bytes");
            return fault("channels, a sample rate and whole bytes per sample", found);
        }
        let bytes = block / channels;
        if tag == PCM && u64::from(per_second) != u64::from(rate) * u64::from(block) {
            let expected = format!("{} bytes per second", u64::from(rate) * u64::from(block));
            return fault(&expected, per_second.to_string());
        }
        let fits = match tag {
            FLOAT => matches!((bytes, bits), (4, 32) | (8, 64)),
            _ => (1..=8).contains(&bytes) && (1..=8 * bytes).contains(&bits),
        };
        if !fits {
            let found = format!("{bits} bits in {bytes} bytes");
            return fault("1 to 64 bits of PCM, or 32 or 64 of floating point", found);
        }
        Ok(Format {
            float: tag == FLOAT,
            channels,
            rate,
            bytes,
            bits,
        })
    }

    /// The format tag in the identifier of an extensible format.
    fn extension(&self, cursor: &mut Cursor<'_>) -> Result<u16, ReadError> {
        cursor.take(8, "the extension of a format")?;
        let at = cursor.at();
        let tag = cursor.u32("a format's identifier")?;
        let middle = [
            cursor.u16("a format's identifier")?,
            cursor.u16("a format's identifier")?,
        ];
        let rest = cursor.take(8, "a format's identifier")?;
        match u16::try_from(tag) {
            Ok(tag) if middle == [0, 0x10] && rest == WAVE_GUID => Ok(tag),
            _ => {
                let found = format!("{tag:#x} {middle:?} {rest:02x?}");
                Err(self
                    .file
                    .refuse(at, "the identifier of a wave format", found))
            }
        }
    }

    /// Texts of a LIST INFO chunk.
    fn texts(&mut self, cursor: &mut Cursor<'_>) -> Result<(), ReadError> {
        if cursor.left() < 4 || cursor.take(4, "a list's kind")? != b"INFO" {
            return Ok(());
        }
        while cursor.left() >= 8 {
            let name = decode_text(cursor.take(4, "a text's name")?).into_owned();
            let length = u64::from(cursor.u32("a text's length")?).min(cursor.left());
            let text = cursor.take(length, "a text")?;
            if length <= LONGEST_TEXT {
                let text = decode_text(text).trim_end_matches('\0').trim().to_owned();
                self.attributes.insert(name, text);
            }
            cursor.seek(cursor.at() + length % 2);
        }
        Ok(())
    }

    /// Date and time of a broadcast chunk.
    fn broadcast(&mut self, cursor: &mut Cursor<'_>) {
        let Ok(bytes) = cursor.take(338, "a broadcast chunk") else {
            return;
        };
        let [date, time] = [&bytes[320..330], &bytes[330..338]];
        let digits = |text: &[u8], separator: usize| {
            text.iter()
                .enumerate()
                .all(|(k, b)| (k % 3 == separator) != b.is_ascii_digit())
        };
        if digits(&date[2..], 2) && date[..2].iter().all(u8::is_ascii_digit) && digits(time, 2) {
            let [year, month, day] = [&date[..4], &date[5..7], &date[8..]].map(decode_text);
            let [hour, minute, second] = [&time[..2], &time[3..5], &time[6..]].map(decode_text);
            self.start_time = Some(format!("{year}-{month}-{day}T{hour}:{minute}:{second}"));
        }
    }

    fn finish(mut self) -> Result<Wave, ReadError> {
        let end = self.file.size();
        let Some(format) = self.format else {
            return Err(self
                .file
                .refuse(end, "a format chunk (fmt)", "the end of the file"));
        };
        let Some((at, length)) = self.data else {
            return Err(self.file.refuse(end, "a data chunk", "the end of the file"));
        };
        let block = u64::from(format.bytes) * u64::from(format.channels);
        if length % block != 0 {
            self.notes.push(format!(
                "{} bytes of an incomplete last sample: not read",
                length % block
            ));
        }
        Ok(Wave {
            order: self.order,
            format,
            at,
            samples: length / block,
            attributes: self.attributes,
            start_time: self.start_time,
            notes: self.notes,
        })
    }
}

/// The name of a format that is not read.
fn codec(tag: u16) -> String {
    match tag {
        2 => "ADPCM".into(),
        6 => "A-law".into(),
        7 => "mu-law".into(),
        0x11 => "IMA ADPCM".into(),
        0x55 => "MP3".into(),
        other => format!("format {other:#06x}"),
    }
}
