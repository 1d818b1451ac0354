//! An HDF5 file as a tree of groups and arrays, whichever library reads it.

use std::collections::BTreeMap;

use crate::attribute;
use crate::hdf5::element::Element;

/// The most objects a file may hold.
pub const MOST_OBJECTS: usize = 200_000;
/// The deepest nesting of groups.
pub const DEEPEST: usize = 32;

/// An attribute's value.
#[derive(Debug, Clone, PartialEq)]
pub enum Attr {
    /// One text or several.
    Text(Vec<String>),
    /// One number or several.
    Numbers(Vec<f64>),
}

impl Attr {
    /// As one text; parts are joined by commas.
    pub fn text(&self) -> String {
        match self {
            Self::Text(parts) => parts.join(", "),
            Self::Numbers(parts) => parts
                .iter()
                .map(f64::to_string)
                .collect::<Vec<_>>()
                .join(", "),
        }
    }

    /// As a list of texts; one text is split at its commas.
    pub fn list(&self) -> Vec<String> {
        match self {
            Self::Text(parts) if parts.len() == 1 => attribute::list(&parts[0]),
            Self::Text(parts) => parts.clone(),
            Self::Numbers(parts) => parts.iter().map(f64::to_string).collect(),
        }
    }

    /// As numbers, where it holds numbers.
    pub fn numbers(&self) -> Option<&[f64]> {
        match self {
            Self::Numbers(parts) => Some(parts),
            Self::Text(_) => None,
        }
    }
}

/// Attributes by name.
pub type Attrs = BTreeMap<String, Attr>;

/// An array of the file.
#[derive(Debug, Clone, PartialEq)]
pub struct Array {
    /// Path from the root, without the first slash.
    pub path: String,
    /// Last part of the path.
    pub name: String,
    /// Number of elements along each dimension.
    pub shape: Vec<u64>,
    /// What its elements are.
    pub element: Element,
    /// Its attributes.
    pub attributes: Attrs,
    /// The library's own number of it.
    pub handle: usize,
}

impl Array {
    /// Number of elements; `None` where it exceeds 64 bits.
    pub fn count(&self) -> Option<u64> {
        self.shape.iter().try_fold(1u64, |n, &d| n.checked_mul(d))
    }
}

/// A group of the file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tree {
    /// Path from the root, without the first slash; empty for the root.
    pub path: String,
    /// Its attributes.
    pub attributes: Attrs,
    /// Its arrays.
    pub arrays: Vec<Array>,
    /// Its groups.
    pub groups: Vec<Tree>,
}

/// A library that reads HDF5 files. Errors are its own words.
pub trait Store: Send + Sync {
    /// The unpacked bytes of an array, row by row.
    fn raw(&self, array: &Array) -> Result<Vec<u8>, String>;

    /// The unpacked bytes of `count` entries along the first dimension from `start`.
    fn rows(&self, array: &Array, start: u64, count: u64) -> Result<Vec<u8>, String>;

    /// The texts of an array of texts.
    fn texts(&self, array: &Array) -> Result<Vec<String>, String>;

    /// The paths that an array of references points at; empty for a null reference.
    fn targets(&self, array: &Array) -> Result<Vec<Option<Target>>, String>;

    /// Bytes that an array takes in the file, where the library tells.
    fn stored_bytes(&self, array: &Array) -> Option<u64>;

    /// Bytes that one unpacked chunk of an array takes; zero where it has no chunks.
    fn chunk_bytes(&self, array: &Array) -> u64;

    /// Length of the file.
    fn file_bytes(&self) -> u64;
}

/// What a reference points at.
pub enum Target {
    /// An array.
    Array(Array),
    /// A group.
    Group(Tree),
}

/// Join a path and a name.
pub fn join(path: &str, name: &str) -> String {
    if path.is_empty() {
        name.to_owned()
    } else {
        format!("{path}/{name}")
    }
}
