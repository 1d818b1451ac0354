//! An HDF5 file as a tree of groups and arrays.

use std::collections::BTreeMap;

use crate::attribute;
use crate::formats::hdf5::element::Element;

/// The most objects a file may hold.
pub(crate) const MOST_OBJECTS: usize = 200_000;
/// The deepest nesting of groups.
pub(crate) const DEEPEST: usize = 32;

/// An attribute's value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Attr {
    /// One text or several.
    Text(Vec<String>),
    /// One number or several.
    Numbers(Vec<f64>),
}

impl Attr {
    /// As one text; parts are joined by commas.
    pub(crate) fn text(&self) -> String {
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
    pub(crate) fn list(&self) -> Vec<String> {
        match self {
            Self::Text(parts) if parts.len() == 1 => attribute::list(&parts[0]),
            Self::Text(parts) => parts.clone(),
            Self::Numbers(parts) => parts.iter().map(f64::to_string).collect(),
        }
    }

    /// As numbers, if it holds numbers.
    pub(crate) fn numbers(&self) -> Option<&[f64]> {
        match self {
            Self::Numbers(parts) => Some(parts),
            Self::Text(_) => None,
        }
    }
}

/// Attributes by name.
pub(crate) type Attrs = BTreeMap<String, Attr>;

/// An array of the file.
#[derive(Debug, Clone)]
pub(crate) struct Array {
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
    /// The library's handle of it.
    pub dataset: ::hdf5::Dataset,
}

impl Array {
    /// Number of elements; `None` if it exceeds 64 bits.
    pub(crate) fn count(&self) -> Option<u64> {
        product(1, &self.shape)
    }

    /// Unpacked bytes that it claims to have, of texts their number.
    pub(super) fn claimed(&self) -> u64 {
        let element = self.element.bytes().max(1) as u64;
        let bytes = self.count().and_then(|n| n.checked_mul(element));
        bytes.unwrap_or(u64::MAX)
    }
}

/// A number times all dimensions; `None` if it exceeds 64 bits.
pub(super) fn product(first: u64, dimensions: &[u64]) -> Option<u64> {
    let mut dimensions = dimensions.iter().copied();
    dimensions.try_fold(first, u64::checked_mul)
}

/// A group of the file.
#[derive(Debug, Clone, Default)]
pub(crate) struct Tree {
    /// Path from the root, without the first slash; empty for the root.
    pub path: String,
    /// Its attributes.
    pub attributes: Attrs,
    /// Its arrays.
    pub arrays: Vec<Array>,
    /// Its groups.
    pub groups: Vec<Self>,
    /// Datasets that cannot be described, with the reason.
    pub unreadable: Vec<String>,
}

impl Tree {
    /// Datasets of this group and those in it that cannot be described.
    pub(super) fn unreadable(&self) -> Box<dyn Iterator<Item = &String> + '_> {
        let inner = self.groups.iter().flat_map(Self::unreadable);
        Box::new(self.unreadable.iter().chain(inner))
    }
}

/// Why an array or the tree of a file is not read.
#[derive(Debug, thiserror::Error)]
pub(super) enum StoreError {
    #[error(transparent)]
    Library(#[from] ::hdf5::Error),
    #[error("{first}; the second library states: {second}")]
    Both {
        first: ::hdf5::Error,
        second: rust_hdf5::Hdf5Error,
    },
    #[error("dataset '{path}': {error}")]
    Dataset { path: String, error: ::hdf5::Error },
    #[error("groups nested deeper than {DEEPEST} at '{0}'")]
    TooDeep(String),
    #[error("more than {MOST_OBJECTS} groups and datasets")]
    TooMany,
    #[error("'{0}': more values, or deeper nested ones, than are accepted")]
    TooManyValues(String),
    #[error("chunks of {0} bytes, far more than the file")]
    Chunks(u64),
    #[error("{0} stored bytes, more than the file has")]
    Stored(u64),
    #[error("a shape of {shape:?} for which the file stores {stored} bytes")]
    Shape { shape: Vec<u64>, stored: u64 },
}

impl StoreError {
    /// The filter that neither library has, by its name.
    pub(super) fn unsupported_filter(&self) -> Option<String> {
        let (Self::Library(error) | Self::Dataset { error, .. } | Self::Both { first: error, .. }) =
            self
        else {
            return None;
        };
        match error {
            ::hdf5::Error::Format(::hdf5::FormatError::UnsupportedFilter(id)) => {
                Some(filter_name(*id))
            }
            _ => None,
        }
    }

    /// Whether the file ends too early.
    pub(super) fn is_cut_off(&self) -> bool {
        let (Self::Library(error) | Self::Dataset { error, .. }) = self else {
            return false;
        };
        matches!(
            error,
            ::hdf5::Error::Format(::hdf5::FormatError::UnexpectedEof { .. })
        )
    }
}

/// Name of a filter by the number that The HDF Group registered for it.
fn filter_name(id: u16) -> String {
    let name = match id {
        4 => "SZIP",
        5 => "N-bit",
        6 => "scale-offset",
        307 => "bzip2",
        32000 => "LZF",
        32001 => "Blosc",
        32004 => "LZ4",
        32008 => "bitshuffle",
        32013 => "ZFP",
        32014 => "FPZIP",
        32015 => "Zstandard",
        32017 | 32024 => "SZ",
        32026 => "Blosc2",
        _ => return format!("number {id}"),
    };
    format!("{name} (number {id})")
}

/// What a reference points at.
pub(crate) enum Target {
    /// An array.
    Array(Array),
    /// A group.
    Group(Tree),
}

/// Join a path and a name.
pub(crate) fn join(path: &str, name: &str) -> String {
    if path.is_empty() {
        name.to_owned()
    } else {
        format!("{path}/{name}")
    }
}
