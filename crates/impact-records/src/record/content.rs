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
    /// Heights: of the drop, and of the top after each impact; down the rows, or along each row.
    Heights,
    /// The height of a drop, and in each column beside it that of the top after it.
    Rebounds,
}

impl ContactContent {
    /// Whether the rows are impacts, so that there is no time axis.
    pub fn is_list(self) -> bool {
        matches!(self, Self::Times | Self::Intervals) || self.is_of_heights()
    }

    /// Whether the rows are heights.
    pub fn is_of_heights(self) -> bool {
        matches!(self, Self::Heights | Self::Rebounds)
    }
}
