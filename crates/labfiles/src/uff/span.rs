//! The time that a function covers, by which functions are channels of one record.

/// The time that a function covers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    /// Of its first sample, s.
    pub(crate) start_s: f64,
    /// From it to the end, s.
    pub(crate) length_s: f64,
}

impl Span {
    /// Whether two have half of the time of the shorter in common: they then belong to one record, even where one
    /// begins later or has another rate.
    pub(crate) fn overlaps(self, other: Self) -> bool {
        let end = |span: Self| span.start_s + span.length_s;
        let common = end(self).min(end(other)) - self.start_s.max(other.start_s);
        common >= 0.5 * self.length_s.min(other.length_s) && common > 0.0
    }
}
