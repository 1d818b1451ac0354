//! What opening a TDMS file finds: its objects and the places of their raw data.

use std::collections::BTreeMap;

use super::layout::{Layout, Share};
use super::value::{Kind, Value};
use crate::numbers::ByteOrder;

/// A file, group or channel.
#[derive(Debug, Default)]
pub(super) struct Object {
    /// Empty for the file, one part for a group, two for a channel.
    pub path: Vec<String>,
    /// Its properties, of which later segments may change some.
    pub properties: BTreeMap<String, Value>,
    /// Kind of its samples, once it has some.
    pub kind: Option<Kind>,
    /// Number of its samples.
    pub samples: u64,
    /// Layouts in which it has samples, and its entry in each.
    pub places: Vec<(usize, usize)>,
    /// The latest raw data index.
    pub share: Option<Share>,
    /// Whether it belongs to the present segment.
    pub listed: bool,
    /// Whether it has data there.
    pub active: bool,
}

/// Chunks of one layout that follow each other in the file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    /// Offset of the first chunk.
    pub at: u64,
    /// Number of chunks.
    pub chunks: u64,
    /// Their layout.
    pub layout: usize,
    /// Byte order of the numbers.
    pub order: ByteOrder,
    /// Whether the channels are interleaved row by row.
    pub interleaved: bool,
}

/// All that opening a file finds.
#[derive(Debug, Default)]
pub(super) struct Content {
    /// File, groups and channels in order of appearance.
    pub objects: Vec<Object>,
    /// The layouts of the chunks.
    pub layouts: Vec<Layout>,
    /// The raw data in file order.
    pub pieces: Vec<Piece>,
    /// For each layout its pieces.
    pub pieces_of: Vec<Vec<usize>>,
    /// What was skipped or assumed.
    pub notes: Vec<String>,
}
