//! HDF5 files through `rust-hdf5`, for layouts newer than `hdf5-pure` reads.
//!
//! Its handles stay on one thread, so that each read opens the file anew.

use std::path::{Path, PathBuf};

use rust_hdf5::{DatatypeMessage, H5Dataset, H5File, H5Group};

use crate::bytes::decode_text;
use crate::hdf5::element::Element;
use crate::hdf5::element::{boolean, compound};
use crate::hdf5::pure::PureStore;
use crate::hdf5::store::{Array, Attr, Attrs, DEEPEST, MOST_OBJECTS, Store, Target, Tree, join};

/// A file read by the second library.
pub struct SecondStore {
    path: PathBuf,
}

/// Whether the first library's words mean that it does not know a layout, rather than that the
/// file is damaged: only then the second one may do better.
pub fn is_unsupported(message: &str) -> bool {
    const WORDS: [&str; 7] = [
        "unsupported",
        "not supported",
        "version",
        "index type",
        "layout class",
        "datatype class",
        "filter",
    ];
    let message = message.to_lowercase();
    WORDS.iter().any(|w| message.contains(w))
}

/// The first library, and the second for arrays that it refuses.
pub struct WithFallback {
    first: PureStore,
    second: SecondStore,
}

impl WithFallback {
    /// A file whose structure the first library has read.
    pub fn new(first: PureStore, path: &Path) -> Self {
        Self {
            first,
            second: SecondStore {
                path: path.to_path_buf(),
            },
        }
    }

    fn either<T>(
        &self,
        first: Result<T, String>,
        second: impl FnOnce(&SecondStore) -> Result<T, String>,
    ) -> Result<T, String> {
        first.or_else(|e| match is_unsupported(&e) {
            true => second(&self.second).map_err(|f| format!("{e}; the second library says: {f}")),
            false => Err(e),
        })
    }
}

impl Store for WithFallback {
    fn raw(&self, array: &Array) -> Result<Vec<u8>, String> {
        self.either(self.first.raw(array), |s| s.raw(array))
    }

    fn rows(&self, array: &Array, start: u64, count: u64) -> Result<Vec<u8>, String> {
        self.either(self.first.rows(array, start, count), |s| {
            s.rows(array, start, count)
        })
    }

    fn texts(&self, array: &Array) -> Result<Vec<String>, String> {
        self.either(self.first.texts(array), |s| s.texts(array))
    }

    fn targets(&self, array: &Array) -> Result<Vec<Option<Target>>, String> {
        self.first.targets(array)
    }

    fn file_bytes(&self) -> u64 {
        self.first.file_bytes()
    }

    fn chunk_bytes(&self, array: &Array) -> u64 {
        self.first.chunk_bytes(array)
    }

    fn stored_bytes(&self, array: &Array) -> Option<u64> {
        self.first
            .stored_bytes(array)
            .or_else(|| self.second.stored_bytes(array))
    }
}

/// A file's reader, its tree, and a note where attributes are not read.
pub type Opened = (SecondStore, Tree, Option<String>);

/// Open a file and walk its tree.
pub fn open(path: &Path) -> Result<Opened, String> {
    let file = file(path)?;
    let mut walk = Walk {
        file: &file,
        objects: 0,
        lost: Vec::new(),
    };
    let mut tree = walk.group(&file.root_group(), String::new(), 0)?;
    tree.attributes = walk.attributes("", file.attr_names(), |n| text(file.attr_string(n)));
    let note = walk.note();
    let path = path.to_path_buf();
    Ok((SecondStore { path }, tree, note))
}

fn file(path: &Path) -> Result<H5File, String> {
    H5File::options()
        .no_locking()
        .open(path)
        .map_err(|e| e.to_string())
}

/// A walk through the tree of a file.
struct Walk<'a> {
    file: &'a H5File,
    /// Groups and arrays met.
    objects: usize,
    /// Attributes that the library does not read.
    lost: Vec<String>,
}

/// Attributes that are named in a note; of more their number is told.
const MOST_NAMED: usize = 12;

impl Walk<'_> {
    fn group(&mut self, group: &H5Group, path: String, depth: usize) -> Result<Tree, String> {
        let words = |e: rust_hdf5::Hdf5Error| e.to_string();
        if depth > DEEPEST || self.objects > MOST_OBJECTS {
            return Err(format!("too many or too deeply nested groups at '{path}'"));
        }
        let attributes = match depth {
            // read from the file
            0 => Attrs::new(),
            _ => self.attributes(&path, group.attr_names(), |n| text(group.attr_string(n))),
        };
        let mut tree = Tree {
            path,
            attributes,
            ..Tree::default()
        };
        for name in group.dataset_names().map_err(words)? {
            self.objects += 1;
            let path = join(&tree.path, &name);
            let dataset = self.file.dataset(&path).map_err(words)?;
            tree.arrays.push(self.array(&dataset, path, name)?);
        }
        for name in group.group_names().map_err(words)? {
            self.objects += 1;
            let child = group.group(&name).map_err(words)?;
            let path = join(&tree.path, &name);
            tree.groups.push(self.group(&child, path, depth + 1)?);
        }
        Ok(tree)
    }

    fn array(&mut self, dataset: &H5Dataset, path: String, name: String) -> Result<Array, String> {
        let datatype = dataset.datatype().map_err(|e| e.to_string())?;
        Ok(Array {
            shape: dataset.shape().into_iter().map(|d| d as u64).collect(),
            element: element(&datatype),
            attributes: self.attributes(&path, dataset.attr_names(), |n| attr(dataset, n)),
            path,
            name,
            handle: 0,
        })
    }

    /// The attributes of an object; those that are not read are kept for the note.
    fn attributes(
        &mut self,
        path: &str,
        names: rust_hdf5::Result<Vec<String>>,
        value: impl Fn(&str) -> Option<Attr>,
    ) -> Attrs {
        let mut read = Attrs::new();
        match names {
            Err(_) => self.lost.push(format!("all of '/{path}'")),
            Ok(names) => {
                for name in names {
                    match value(&name) {
                        Some(value) => drop(read.insert(name, value)),
                        None => self.lost.push(format!("'{name}' of '/{path}'")),
                    }
                }
            }
        }
        read
    }

    /// What the user should know of the attributes that are not read.
    fn note(&self) -> Option<String> {
        let named = self.lost.iter().take(MOST_NAMED).cloned();
        let named = named.collect::<Vec<_>>().join(", ");
        let more = match self.lost.len().saturating_sub(MOST_NAMED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        (!self.lost.is_empty()).then(|| {
            format!(
                "attributes not read: {named}{more}; units, rates and settings in them are not \
                 known: state them in campaign.toml"
            )
        })
    }
}

/// A text as an attribute, where the library reads one.
fn text(read: rust_hdf5::Result<String>) -> Option<Attr> {
    read.ok().map(|t| Attr::Text(vec![t]))
}

/// Bytes by which a text of any length is referred to.
const TEXT_REFERENCE_BYTES: usize = 16;

/// An attribute as numbers or texts. Of several texts of any length the library tells the first
/// alone: they are not read.
fn attr(dataset: &H5Dataset, name: &str) -> Option<Attr> {
    let attribute = dataset.attr(name).ok()?;
    if let Ok(numbers) = attribute.read_numeric_as::<f64>() {
        return Some(Attr::Numbers(numbers));
    }
    let bytes = attribute.read_raw().ok()?;
    match attribute.datatype().ok()? {
        DatatypeMessage::FixedString { size, .. } if bytes.len() > size as usize => {
            let texts = bytes.chunks(size.max(1) as usize).map(|t| {
                let end = t.iter().position(|&b| b == 0).unwrap_or(t.len());
                decode_text(&t[..end]).trim_end().to_owned()
            });
            Some(Attr::Text(texts.collect()))
        }
        DatatypeMessage::VarLenString { .. } if bytes.len() > TEXT_REFERENCE_BYTES => None,
        DatatypeMessage::FixedString { .. } | DatatypeMessage::VarLenString { .. } => {
            text(attribute.read_string())
        }
        _ => None,
    }
}

fn element(datatype: &DatatypeMessage) -> Element {
    use rust_hdf5::ByteOrder;
    match datatype {
        DatatypeMessage::FixedPoint {
            size,
            byte_order,
            signed,
            bit_offset: 0,
            bit_precision,
        } if matches!(size, 1 | 2 | 4 | 8)
            && size.checked_mul(8) == Some(u32::from(*bit_precision)) =>
        {
            let big = matches!(byte_order, ByteOrder::BigEndian);
            Element::Int {
                bytes: *size as usize,
                signed: *signed,
                big,
            }
        }
        DatatypeMessage::FloatingPoint {
            size,
            byte_order,
            exponent_size,
            mantissa_size,
            ..
        } if matches!(
            (size, exponent_size, mantissa_size),
            (2, 5, 10) | (4, 8, 23) | (8, 11, 52)
        ) =>
        {
            let big = matches!(byte_order, ByteOrder::BigEndian);
            Element::Float {
                bytes: *size as usize,
                big,
            }
        }
        DatatypeMessage::Compound { size, members } => {
            let fields = members
                .iter()
                .map(|m| (m.name.clone(), m.offset as usize, element(&m.datatype)));
            compound(fields.collect(), *size as usize)
        }
        DatatypeMessage::Enum { base, members } => {
            boolean(element(base), members.iter().map(|m| m.name.as_str()))
        }
        DatatypeMessage::FixedString { .. } | DatatypeMessage::VarLenString { .. } => Element::Text,
        other => Element::Other(other.to_string()),
    }
}

impl SecondStore {
    fn with<T>(
        &self,
        array: &Array,
        read: impl FnOnce(&H5Dataset) -> rust_hdf5::Result<T>,
    ) -> Result<T, String> {
        let file = file(&self.path)?;
        let dataset = file.dataset(&array.path).map_err(|e| e.to_string())?;
        read(&dataset).map_err(|e| e.to_string())
    }
}

impl Store for SecondStore {
    fn raw(&self, array: &Array) -> Result<Vec<u8>, String> {
        self.with(array, H5Dataset::read_raw_bytes)
    }

    fn rows(&self, array: &Array, start: u64, count: u64) -> Result<Vec<u8>, String> {
        let row: u64 = array.shape.iter().skip(1).product();
        let bytes = row as usize * array.element.bytes();
        let all = self.raw(array)?;
        let (from, to) = (start as usize * bytes, (start + count) as usize * bytes);
        all.get(from..to.min(all.len()))
            .map(<[u8]>::to_vec)
            .ok_or_else(|| format!("rows from {start} lie behind the end"))
    }

    fn texts(&self, array: &Array) -> Result<Vec<String>, String> {
        self.with(array, H5Dataset::read_strings_lossy)
    }

    fn targets(&self, array: &Array) -> Result<Vec<Option<Target>>, String> {
        Err(format!(
            "references of '{}' are not followed by the second library",
            array.path
        ))
    }

    fn chunk_bytes(&self, array: &Array) -> u64 {
        let chunk = self
            .with(array, |d| Ok(d.chunk_dims()))
            .ok()
            .flatten()
            .unwrap_or_default();
        if chunk.is_empty() {
            return 0;
        }
        let bytes = array.element.bytes().max(1) as u64;
        chunk
            .iter()
            .try_fold(bytes, |n, &d| n.checked_mul(d as u64))
            .unwrap_or(u64::MAX)
    }

    fn file_bytes(&self) -> u64 {
        std::fs::metadata(&self.path).map_or(0, |m| m.len())
    }

    fn stored_bytes(&self, array: &Array) -> Option<u64> {
        // The library does not tell; the file's length bounds it.
        let claimed = array.count()?.checked_mul(array.element.bytes() as u64)?;
        Some(claimed.min(self.file_bytes()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::own;

    #[test]
    fn valid_attributes_that_are_not_read_are_named() {
        let (_, tree, note) = open(&own("latest_attributes.h5")).unwrap();
        let attributes = &tree.arrays[0].attributes;
        assert_eq!(attributes["units"].list(), ["mm/s", "V"]);
        assert_eq!(attributes["sample_rate_hz"].numbers(), Some(&[2000.0][..]));
        assert_eq!(tree.attributes["rig"].text(), "A");
        let note = note.unwrap();
        assert!(note.contains("'calibration' of '/run'"), "{note}");
        // of several texts the library tells the first alone
        assert!(note.contains("'channels' of '/run'"), "{note}");
        assert!(!attributes.contains_key("channels"));
        assert!(open(&own("latest_two_unlimited.h5")).unwrap().2.is_none());
    }
}
