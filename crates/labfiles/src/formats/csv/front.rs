//! The lines before a text table, and the beginning of the table.

use crate::conventions::TEXTS_KEY;
use crate::formats::csv::columns::{self, HeadRows};
use crate::formats::csv::commas;
use crate::formats::csv::dialect::{self, Dialect};
use crate::formats::csv::header::{self, Header};
use crate::source::ReadError;
use crate::text::TextFile;
use crate::text::cells::{Lines, Separator, is_row};
use crate::text::table::{Kind, Layout};

/// The lines before the table, and the beginning of the table.
pub(super) struct Front {
    pub header: Header,
    dialect: Dialect,
    /// Offset of the table in the head.
    offset: usize,
    /// The columns of texts, counted from 1, if the file states them.
    texts: Option<Vec<usize>>,
    /// The lines with letters before the table.
    headings: Vec<Vec<u8>>,
}

impl Front {
    pub(super) fn read(text: &TextFile, head: &[u8], quotes: bool) -> Result<Self, ReadError> {
        if memchr::memchr(0, head).is_some() {
            return Err(no_table(text, "bytes that are no text"));
        }
        let lines = Lines::new(head, quotes);
        let (offsets, lines): (Vec<usize>, Vec<&[u8]>) =
            lines.filter(|(_, l)| !l.trim_ascii().is_empty()).unzip();
        let places = (0..lines.len()).filter(|&i| is_row(lines[i], dialect::COMMENTS));
        let places: Vec<usize> = places.collect();
        let plain: Vec<&[u8]> = places.iter().map(|&i| lines[i]).collect();
        let Some(top) = plain.first() else {
            let empty = lines.is_empty();
            let found = if empty {
                "an empty file"
            } else {
                "comments only"
            };
            return Err(no_table(text, found));
        };
        let texts = stated_texts(&lines[..places[0]]);
        let (dialect, first) = match texts {
            Some(_) => (Dialect::own(top), Some(1)),
            None => {
                let dialect = dialect::detect(&plain);
                let dialect = dialect.ok_or_else(|| no_table(text, "no column of numbers"))?;
                (dialect, dialect::first_row(&plain, &dialect))
            }
        };
        if let Some(at) = first.filter(|_| dialect.separator == Separator::Byte(b',')) {
            refuse_decimal_commas(text, &plain, at)?;
        }
        let first = first.and_then(|i| places.get(i));
        let first = *first.ok_or_else(|| no_table(text, "no row of numbers"))?;
        let offset = offsets[first];
        let headings = headings(&lines[..first]);
        let rows = head_rows(&head[offset..], quotes, dialect.separator, &headings);
        let filled = match texts {
            Some(_) => 0..dialect.columns,
            None => columns::filled(&rows),
        };
        let (mut header, columns) = header::read(&lines[..first], &dialect, filled);
        header.attributes.remove(TEXTS_KEY);
        Ok(Self {
            header,
            dialect: Dialect { columns, ..dialect },
            offset,
            texts,
            headings,
        })
    }

    /// Whether this program wrote the table.
    pub(super) fn is_own(&self) -> bool {
        self.texts.is_some()
    }

    /// The rows of the head.
    pub(super) fn rows<'a>(&self, head: &'a [u8], quotes: bool) -> HeadRows<'a> {
        let table = &head[self.offset..];
        head_rows(table, quotes, self.dialect.separator, &self.headings)
    }

    /// How the table is written; its columns have no names yet.
    pub(super) fn layout(&self, text: &TextFile, rows: &HeadRows<'_>, quotes: bool) -> Layout {
        let kinds = match &self.texts {
            Some(texts) => stated_kinds(texts, self.dialect.columns),
            None => columns::kinds(rows, &self.dialect),
        };
        Layout {
            separator: self.dialect.separator,
            notation: self.dialect.notation,
            names: Vec::new(),
            start: text.start() + self.offset as u64,
            end: text.length(),
            quotes,
            month_first: kinds.contains(&Kind::Time) && columns::month_first(rows),
            fraction: None,
            kinds,
            comments: dialect::COMMENTS,
            headings: self.headings.clone(),
        }
    }
}

/// The lines among some before a table that may come again among its rows: those with a letter, no comments.
fn headings(before: &[&[u8]]) -> Vec<Vec<u8>> {
    let letter = |line: &&&[u8]| line.iter().any(u8::is_ascii_alphabetic);
    let plain = before.iter().filter(letter);
    let plain = plain.filter(|line| is_row(line, dialect::COMMENTS));
    plain.map(|line| line.trim_ascii().to_vec()).collect()
}

/// Rows at the front of a table by which its decimal marks are judged.
const JUDGED_ROWS: usize = 8;

/// Refuse a table of numbers with decimal commas between commas; `at` is its first row.
fn refuse_decimal_commas(text: &TextFile, lines: &[&[u8]], at: usize) -> Result<(), ReadError> {
    let (above, rows) = lines.split_at(at.min(lines.len()));
    let Some(heading) = above.last() else {
        return Ok(());
    };
    let mut rows = rows.iter().take(JUDGED_ROWS);
    let Some(row) = rows.find(|row| commas::are_decimals(heading, row)) else {
        return Ok(());
    };
    Err(ReadError::new(
        text.path(),
        "cells between commas, or numbers with a decimal comma",
        format!(
            "'{}' below '{}', where commas are both",
            crate::text::decode(row),
            crate::text::decode(heading)
        ),
        "export the table with decimal points, or with semicolons or tabs between the cells",
    ))
}

/// The rows at the front of a table, without headings that come again.
fn head_rows<'a>(
    table: &'a [u8],
    quotes: bool,
    separator: Separator,
    headings: &[Vec<u8>],
) -> HeadRows<'a> {
    let lines = Lines::new(table, quotes);
    let again = |line: &[u8]| headings.iter().any(|h| h == line.trim_ascii());
    let rows = lines.filter(|(_, l)| is_row(l, dialect::COMMENTS) && !again(l));
    HeadRows {
        lines: rows.map(|(_, l)| l).collect(),
        separator,
    }
}

/// The columns of texts that a remark before the table numbers.
fn stated_texts(before: &[&[u8]]) -> Option<Vec<usize>> {
    let stated = before.iter().find_map(|line| {
        let remark = line.strip_prefix(b"#")?.trim_ascii();
        let numbers = remark
            .strip_prefix(TEXTS_KEY.as_bytes())?
            .trim_ascii_start();
        std::str::from_utf8(numbers.strip_prefix(b"=")?).ok()
    })?;
    stated.split_whitespace().map(|n| n.parse().ok()).collect()
}

fn stated_kinds(texts: &[usize], columns: usize) -> Vec<Kind> {
    let kind = |number| {
        if texts.contains(&number) {
            Kind::Text
        } else {
            Kind::Number
        }
    };
    (1..=columns).map(kind).collect()
}

fn no_table(text: &TextFile, found: &str) -> ReadError {
    ReadError::new(
        text.path(),
        "a table of numbers separated by commas, semicolons, tabs or blanks",
        found,
        "export the record as CSV with one row per sample and a header of channel names",
    )
}
