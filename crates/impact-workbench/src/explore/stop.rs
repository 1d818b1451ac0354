//! Why an answer ends before it is whole.

use super::ExploreError;

/// Why an answer ends early.
#[derive(Debug)]
pub(super) enum Stop {
    /// Nobody waits for it.
    Stale,
    /// It is refused.
    Refused(ExploreError),
}

impl From<Stale> for Stop {
    fn from(_: Stale) -> Self {
        Self::Stale
    }
}

impl<E: Into<ExploreError>> From<E> for Stop {
    fn from(error: E) -> Self {
        Self::Refused(error.into())
    }
}

/// The page is gone, or asked for something newer: the job stops.
#[derive(Debug)]
pub(super) struct Stale;
