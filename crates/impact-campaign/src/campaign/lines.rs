//! The lines of campaign.toml.

use toml::Spanned;

/// The text of campaign.toml with the lines' places.
#[derive(Debug)]
pub(super) struct Text<'a> {
    text: &'a str,
}

impl<'a> Text<'a> {
    /// Wrap a text.
    pub(super) fn new(text: &'a str) -> Self {
        Self { text }
    }

    /// Line, counted from 1, of a byte offset.
    pub(super) fn line(&self, offset: usize) -> usize {
        let end = offset.min(self.text.len());
        1 + self.text.as_bytes()[..end]
            .iter()
            .filter(|b| **b == b'\n')
            .count()
    }

    /// Line of a placed value.
    pub(super) fn line_of<T>(&self, placed: &Spanned<T>) -> Option<usize> {
        Some(self.line(placed.span().start))
    }
}
