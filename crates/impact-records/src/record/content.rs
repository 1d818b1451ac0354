//! What the contact's channel contains.

use serde::{Deserialize, Serialize};

/// What the contact's channel contains.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactContent {
    /// A signal that jumps while the bodies touch.
    #[default]
    Signal,
    /// The times of the impacts, one in each row.
    Times,
    /// The times between impacts, one in each row.
    Intervals,
    /// A microphone's signal.
    Sound,
}

impl ContactContent {
    /// Whether the rows are impacts, so that there is no time axis.
    pub fn is_list(self) -> bool {
        matches!(self, Self::Times | Self::Intervals)
    }
}
