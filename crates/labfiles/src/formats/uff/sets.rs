//! The sets of a universal file: where each begins and ends, and the functions among them.

use super::ascii::Numbers;
use super::header::{Fault, Header, System};
use crate::bytes::{FileBytes, decode_text, to_usize};
use crate::numbers::{ByteOrder, Number};
use crate::source::ReadError;

/// Lines of a function's header.
const HEADER_LINES: usize = 11;
/// Most lines of a short set (151, 164) that are looked at.
const SHORT_SET: usize = 16;

/// How the numbers of a function are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Form {
    /// As text.
    Ascii,
    /// Binary; abscissa and ordinate may be of different width.
    Binary {
        /// Byte order of the numbers.
        order: ByteOrder,
        /// Numbers of an uneven abscissa.
        abscissa: Number,
        /// Numbers of the ordinate.
        ordinate: Number,
    },
}

/// A function: set 58 or 58b.
#[derive(Debug, Clone)]
pub(super) struct Function {
    /// Its header.
    pub header: Header,
    /// How its numbers are written.
    pub form: Form,
    /// Offset of its numbers in the file.
    pub at: u64,
    /// Their length, bytes.
    pub bytes: u64,
    /// Points that are there.
    pub samples: u64,
    /// The unit system before it: an index into [`Sets::systems`].
    pub system: Option<usize>,
}

/// All that opening a file finds.
#[derive(Debug, Default)]
pub(super) struct Sets {
    /// Functions in file order.
    pub functions: Vec<Function>,
    /// Names of the model, from sets 151.
    pub model: Vec<(String, String)>,
    /// Unit systems, from sets 164.
    pub systems: Vec<System>,
    /// Numbers of the sets that are not read, and how many of each.
    pub skipped: Vec<(String, usize)>,
    /// What was assumed.
    pub notes: Vec<String>,
}

/// Whether a line begins or ends a set: `-1` in the first six columns and nothing else.
pub(super) fn is_mark(line: &[u8]) -> bool {
    line.starts_with(b"    -1") && line[6..].iter().all(u8::is_ascii_whitespace)
}

/// Walks through a file line by line.
struct Scanner<'a> {
    file: &'a FileBytes,
    at: usize,
    sets: Sets,
}

/// Find all sets of a file.
pub(super) fn scan(file: &FileBytes) -> Result<Sets, ReadError> {
    let mut scanner = Scanner {
        file,
        at: 0,
        sets: Sets::default(),
    };
    let mut stray = false;
    while let Some((at, line)) = scanner.line() {
        if is_mark(line) {
            scanner.set()?;
        } else if !line.iter().all(u8::is_ascii_whitespace) && !stray {
            stray = true;
            scanner
                .sets
                .notes
                .push(format!("text outside of sets at byte {at}: not read"));
        }
    }
    Ok(scanner.sets)
}

impl<'a> Scanner<'a> {
    /// The next line without its end, and its offset.
    fn line(&mut self) -> Option<(usize, &'a [u8])> {
        let (at, rest) = (self.at, &self.file.all()[self.at..]);
        if rest.is_empty() {
            return None;
        }
        let end = memchr::memchr2(b'\n', b'\r', rest);
        let end = end.unwrap_or(rest.len());
        let both = rest[end..].starts_with(b"\r\n");
        self.at = (at + end + 1 + usize::from(both)).min(self.file.all().len());
        Some((at, &rest[..end]))
    }

    /// A set, after the mark that begins it.
    fn set(&mut self) -> Result<(), ReadError> {
        let (at, line) = loop {
            match self.line() {
                None => return Ok(()),
                // The mark before ended a set of which the beginning is lost; this begins one.
                Some((_, line)) if is_mark(line) => {}
                Some(found) => break found,
            }
        };
        let text = decode_text(line);
        let name = text.split_whitespace().next().unwrap_or("");
        match name {
            "58" => self.ascii(at)?,
            "58b" => self.binary(at, &text)?,
            "151" => self.sets.model = super::header::model(&self.short_set()),
            "164" => {
                let lines = self.short_set();
                self.sets.systems.extend(System::read(&lines));
            }
            _ => self.skip_set(name),
        }
        Ok(())
    }

    fn skip_set(&mut self, name: &str) {
        let name = name.chars().take(12).collect::<String>();
        let skipped = &mut self.sets.skipped;
        match skipped.iter().position(|(known, _)| *known == name) {
            Some(index) => skipped[index].1 += 1,
            None if skipped.len() < 100 => skipped.push((name, 1)),
            None => {}
        }
        self.seek_mark();
    }

    /// Go past the next mark; gives its offset, how many lines came before it,
    /// and whether there is one at all.
    fn seek_mark(&mut self) -> (usize, u64, bool) {
        let mut lines = 0;
        while let Some((at, line)) = self.line() {
            if is_mark(line) {
                return (at, lines, true);
            }
            lines += 1;
        }
        (self.file.all().len(), lines, false)
    }

    fn short_set(&mut self) -> Vec<&'a [u8]> {
        let mut lines = Vec::new();
        while let Some((_, line)) = self.line() {
            if is_mark(line) {
                break;
            }
            if lines.len() < SHORT_SET {
                lines.push(line);
            }
        }
        lines
    }

    fn header(&mut self, at: usize) -> Result<Header, ReadError> {
        let mut lines: [&[u8]; HEADER_LINES] = [&[]; HEADER_LINES];
        let mut starts = [0; HEADER_LINES];
        for (line, start) in lines.iter_mut().zip(&mut starts) {
            let Some((at, found)) = self.line() else {
                let expected = format!("{HEADER_LINES} lines of header");
                return Err(self.file.refuse(at as u64, expected, "the end of the file"));
            };
            (*line, *start) = (found.strip_suffix(b"\r").unwrap_or(found), at);
        }
        Header::read(&lines).map_err(
            |Fault {
                 line,
                 expected,
                 found,
             }| {
                let remedy = "export the function again as set 58";
                self.file
                    .unsupported(starts[line] as u64, found, expected, remedy)
            },
        )
    }

    fn system(&self) -> Option<usize> {
        self.sets.systems.len().checked_sub(1)
    }

    fn ascii(&mut self, at: usize) -> Result<(), ReadError> {
        let header = self.header(at)?;
        let start = self.at;
        let (end, lines, marked) = self.seek_mark();
        let body = &self.file.all()[start..end];
        let samples = self.count_ascii(&header, start, body, lines)?;
        if samples < header.points || !marked {
            self.sets.notes.push(format!(
                "function {} (byte {at}) states {} points and holds {samples}{}",
                self.sets.functions.len() + 1,
                header.points,
                if marked {
                    ""
                } else {
                    ", and its end is missing"
                },
            ));
        }
        self.sets.functions.push(Function {
            header,
            form: Form::Ascii,
            at: start as u64,
            bytes: body.len() as u64,
            samples,
            system: self.system(),
        });
        Ok(())
    }

    /// Points that a body of text holds: as stated if it has lines enough, else counted.
    fn count_ascii(
        &self,
        header: &Header,
        start: usize,
        body: &[u8],
        lines: u64,
    ) -> Result<u64, ReadError> {
        let per_line = match (header.double(), header.even, header.complex()) {
            (true, true, _) | (true, false, false) => 4,
            (true, false, true) => 3,
            (false, ..) => 6,
        };
        let needed = header.points.saturating_mul(header.per_point());
        if lines >= needed.div_ceil(per_line) && needed / 2 <= body.len() as u64 {
            return Ok(header.points);
        }
        let counted = Numbers::new(body).count().map_err(|fault| {
            let found = format!("{:?}", snippet(body, fault.at));
            self.file
                .refuse((start + fault.at) as u64, "a number", found)
        })?;
        Ok(header.points.min(counted / header.per_point()))
    }

    fn binary(&mut self, at: usize, text: &str) -> Result<(), ReadError> {
        let words: Vec<u64> = text
            .split_whitespace()
            .skip(1)
            .map_while(|w| w.parse().ok())
            .collect();
        let order = match words.first() {
            Some(1) => ByteOrder::Little,
            Some(2) => ByteOrder::Big,
            _ => {
                return Err(self
                    .file
                    .refuse(at as u64, "byte order 1 or 2", format!("{text:?}")));
            }
        };
        if words.get(1) != Some(&2) {
            let found = match words.get(1) {
                Some(1) => "DEC VMS numbers".to_owned(),
                Some(3) => "IBM 5/370 numbers".to_owned(),
                Some(other) => format!("numbers of the unknown format {other}"),
                None => "no format of the numbers".to_owned(),
            };
            let remedy = "export the file again with IEEE numbers or as text (58)";
            return Err(self
                .file
                .unsupported(at as u64, found, "IEEE 754 numbers", remedy));
        }
        let header = self.header(at)?;
        let start = self.at as u64;
        let stated = words.get(3).copied().unwrap_or(0);
        let function = self.binary_body(header, order, start, stated)?;
        self.at = to_usize(function.at + function.bytes);
        self.end_of_binary();
        self.sets.functions.push(function);
        Ok(())
    }

    /// Find the layout of a binary body: the one that the mark follows.
    fn binary_body(
        &mut self,
        header: Header,
        order: ByteOrder,
        at: u64,
        stated: u64,
    ) -> Result<Function, ReadError> {
        let ordinate = if header.double() {
            Number::F64
        } else {
            Number::F32
        };
        let parts = (1 + u64::from(header.complex())) * ordinate.bytes();
        // An uneven abscissa is single precision, or that of the ordinate.
        let uneven = [Number::F32, ordinate].map(|w| (w, parts + w.bytes()));
        let forms: &[(Number, u64)] = if header.even {
            &[(ordinate, parts)]
        } else {
            &uneven
        };
        let length = |per_point: u64| header.points.checked_mul(per_point);
        let fits = |&&(_, per_point): &&(Number, u64)| {
            length(per_point).is_some_and(|bytes| self.mark_at(at.saturating_add(bytes)))
        };
        let found = forms.iter().find(fits).copied();
        let left = self.file.size() - at;
        let (abscissa, per_point) = match found {
            Some(form) => form,
            None => {
                let as_stated = forms.iter().find(|(_, per)| length(*per) == Some(stated));
                let form = as_stated
                    .or(forms.last())
                    .copied()
                    .unwrap_or((ordinate, parts));
                if length(form.1).is_some_and(|bytes| bytes <= left) {
                    let expected = format!("the end of a set after {} points", header.points);
                    return Err(self.file.refuse(at, expected, "other bytes"));
                }
                form
            }
        };
        let samples = header.points.min(left / per_point);
        if samples < header.points {
            self.sets.notes.push(format!(
                "function {} states {} points and holds {samples}: the file was cut short",
                self.sets.functions.len() + 1,
                header.points,
            ));
        }
        let form = Form::Binary {
            order,
            abscissa,
            ordinate,
        };
        let bytes = if found.is_some() {
            samples * per_point
        } else {
            left
        };
        Ok(Function {
            header,
            form,
            at,
            bytes,
            samples,
            system: self.system(),
        })
    }

    /// Whether there is a mark at an offset, perhaps after a line end.
    fn mark_at(&self, at: u64) -> bool {
        let Some(rest) = self.file.all().get(to_usize(at)..) else {
            return false;
        };
        let rest = &rest[..rest.len().min(96)];
        let rest = rest.strip_prefix(b"\r").unwrap_or(rest);
        let rest = rest.strip_prefix(b"\n").unwrap_or(rest);
        is_mark(&rest[..memchr::memchr(b'\n', rest).unwrap_or(rest.len())])
    }

    /// Go past the mark that ends a binary set.
    fn end_of_binary(&mut self) {
        let before = self.at;
        while let Some((_, line)) = self.line() {
            if is_mark(line) {
                return;
            }
            if !line.iter().all(u8::is_ascii_whitespace) {
                self.at = before;
                return;
            }
        }
    }
}

/// A few characters of a text, for a message.
pub(super) fn snippet(text: &[u8], at: usize) -> String {
    let end = text.len().min(at + 16);
    decode_text(text.get(at..end).unwrap_or(&[])).into_owned()
}
