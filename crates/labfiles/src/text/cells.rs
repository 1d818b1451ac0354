//! Lines of a block and the cells of a line.

use crate::bytes::decode_text;

/// The separator between two cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Separator {
    /// One byte.
    Byte(u8),
    /// Any run of spaces and tabs.
    Blanks,
}

/// The cells of one line, without the blanks around them and without their quotes.
pub(crate) struct Cells<'a> {
    rest: Option<&'a [u8]>,
    separator: Separator,
}

impl<'a> Cells<'a> {
    /// The cells of a line that has no line end.
    pub(crate) fn new(line: &'a [u8], separator: Separator) -> Self {
        let rest = match separator {
            Separator::Blanks => line.trim_ascii(),
            Separator::Byte(_) => line,
        };
        Self {
            rest: Some(rest),
            separator,
        }
    }

    fn cut(&mut self, rest: &'a [u8], end: usize) -> &'a [u8] {
        self.rest = match self.separator {
            _ if end >= rest.len() => None,
            Separator::Byte(_) => Some(&rest[end + 1..]),
            Separator::Blanks => Some(rest[end..].trim_ascii_start()),
        };
        &rest[..end.min(rest.len())]
    }
}

impl<'a> Iterator for Cells<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest?;
        let is_separator = |b: u8| match self.separator {
            Separator::Byte(s) => b == s,
            Separator::Blanks => b == b' ' || b == b'\t',
        };
        // a run of tabs that separate empty cells is not looked through again for each of them
        let is_blank = |b: &&u8| b.is_ascii_whitespace() && !is_separator(**b);
        let skipped = rest.iter().take_while(is_blank).count();
        if rest.get(skipped) == Some(&b'"') {
            let close = closing_quote(&rest[skipped + 1..]).map_or(rest.len(), |i| skipped + 2 + i);
            let after = rest[close..].iter().position(|&b| is_separator(b));
            let cell = self.cut(rest, after.map_or(rest.len(), |i| close + i));
            let inner = cell.trim_ascii();
            return Some(inner[1..].strip_suffix(b"\"").unwrap_or(&inner[1..]));
        }
        let end = match self.separator {
            Separator::Byte(separator) => memchr::memchr(separator, rest),
            Separator::Blanks => memchr::memchr2(b' ', b'\t', rest),
        };
        let end = end.unwrap_or(rest.len());
        Some(self.cut(rest, end).trim_ascii())
    }
}

/// Text of a cell; two quotes in a row are one.
pub(crate) fn decode_cell(cell: &[u8]) -> String {
    decode_text(cell).replace("\"\"", "\"")
}

/// Position of the quote that closes a cell; two in a row are one quote in the cell.
fn closing_quote(bytes: &[u8]) -> Option<usize> {
    let mut i = 0;
    loop {
        i += memchr::memchr(b'"', bytes.get(i..)?)?;
        if bytes.get(i + 1) != Some(&b'"') {
            return Some(i);
        }
        i += 2;
    }
}

/// Lines of a block without their line ends, each with its offset in the block.
pub(crate) struct Lines<'a> {
    block: &'a [u8],
    at: usize,
    quotes: bool,
}

impl<'a> Lines<'a> {
    /// The lines of a block; with `quotes`, line feeds between quotes do not end a line.
    pub(crate) fn new(block: &'a [u8], quotes: bool) -> Self {
        Self {
            block,
            at: 0,
            quotes,
        }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<(usize, &'a [u8])> {
        if self.at >= self.block.len() {
            return None;
        }
        let at = self.at;
        let (line, next) = line_at(self.block, at, self.quotes);
        self.at = next;
        Some((at, line))
    }
}

/// The line that begins at `at` of a block, without its line end, and where the next begins.
pub(crate) fn line_at(block: &[u8], at: usize, quotes: bool) -> (&[u8], usize) {
    let rest = &block[at..];
    let end = if quotes {
        line_feed_outside_quotes(rest)
    } else {
        memchr::memchr(b'\n', rest)
    };
    let end = end.unwrap_or(rest.len());
    let line = &rest[..end];
    (line.strip_suffix(b"\r").unwrap_or(line), at + end + 1)
}

fn line_feed_outside_quotes(bytes: &[u8]) -> Option<usize> {
    let mut open = false;
    memchr::memchr2_iter(b'\n', b'"', bytes).find(|&i| {
        open ^= bytes[i] == b'"';
        bytes[i] == b'\n' && !open
    })
}

/// Whether a line is a row: not blank, not a comment.
#[inline]
pub(crate) fn is_row(line: &[u8], comments: &[u8]) -> bool {
    line.iter()
        .find(|b| !matches!(b, b' ' | b'\t' | b'\r'))
        .is_some_and(|first| !comments.contains(first))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blanks_before_a_quote_belong_to_its_cell_unless_they_separate() {
        let cells = |line: &'static str, separator: u8| -> Vec<&'static str> {
            let cells = Cells::new(line.as_bytes(), Separator::Byte(separator));
            cells.map(|c| std::str::from_utf8(c).unwrap()).collect()
        };
        let tabs = cells(" \"a\tb\" \t\t\t\"c\"", b'\t');
        assert_eq!(tabs, ["a\tb", "", "", "c"]);
        let commas = cells("1, \"a, b\",\t\"c\"", b',');
        assert_eq!(commas, ["1", "a, b", "c"]);
    }
}
