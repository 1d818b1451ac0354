//! The records among which a folder's experiment is inferred.

use labfiles::{DatasetInfo, Samples, Source};

/// A record: a dataset of a file.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub(super) source: &'a dyn Source,
    pub(super) dataset: usize,
}

impl<'a> Place<'a> {
    pub(super) fn set(self) -> &'a DatasetInfo {
        &self.source.datasets()[self.dataset]
    }

    /// A channel's numbers; none if it cannot be read or holds others.
    pub(super) fn numbers(self, channel: usize) -> Vec<f64> {
        let samples = self.source.read(self.dataset, &[channel]).ok();
        let samples = samples.and_then(|mut s| s.pop());
        samples.and_then(Samples::into_real).unwrap_or_default()
    }
}

/// At most so many of a list, evenly spread over it from the first on.
pub(super) fn spread<T: Copy>(all: &[T], most: usize) -> Vec<T> {
    let count = all.len().min(most);
    (0..count).map(|k| all[k * all.len() / count]).collect()
}
