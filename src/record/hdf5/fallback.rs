//! HDF5 files through `rust-hdf5`, for layouts newer than `hdf5-pure` reads.
//!
//! Its handles stay on one thread, so that each read opens the file anew.

use std::path::{Path, PathBuf};

use rust_hdf5::{DatatypeMessage, H5Dataset, H5File, H5Group};

use crate::record::hdf5::element::Element;
use crate::record::hdf5::element::{boolean, compound};
use crate::record::hdf5::pure::PureStore;
use crate::record::hdf5::store::{
    Array, Attr, Attrs, DEEPEST, MOST_OBJECTS, Store, Target, Tree, join,
};

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

/// Open a file and walk its tree.
pub fn open(path: &Path) -> Result<(SecondStore, Tree), String> {
    let file = file(path)?;
    let mut objects = 0;
    let mut tree = group(&file, &file.root_group(), String::new(), 0, &mut objects)?;
    tree.attributes = root_attributes(&file);
    Ok((
        SecondStore {
            path: path.to_path_buf(),
        },
        tree,
    ))
}

fn file(path: &Path) -> Result<H5File, String> {
    H5File::options()
        .no_locking()
        .open(path)
        .map_err(|e| e.to_string())
}

fn root_attributes(file: &H5File) -> Attrs {
    let names = file.attr_names().unwrap_or_default();
    names
        .into_iter()
        .filter_map(|n| file.attr_string(&n).ok().map(|v| (n, Attr::Text(vec![v]))))
        .collect()
}

fn group(
    file: &H5File,
    group_of_file: &H5Group,
    path: String,
    depth: usize,
    objects: &mut usize,
) -> Result<Tree, String> {
    let text = |e: rust_hdf5::Hdf5Error| e.to_string();
    if depth > DEEPEST || *objects > MOST_OBJECTS {
        return Err(format!("too many or too deeply nested groups at '{path}'"));
    }
    let mut tree = Tree {
        path,
        ..Tree::default()
    };
    for name in group_of_file.attr_names().unwrap_or_default() {
        if let Ok(value) = group_of_file.attr_string(&name) {
            tree.attributes.insert(name, Attr::Text(vec![value]));
        }
    }
    for name in group_of_file.dataset_names().map_err(text)? {
        *objects += 1;
        let path = join(&tree.path, &name);
        let dataset = file.dataset(&path).map_err(text)?;
        tree.arrays.push(array(&dataset, path, name)?);
    }
    for name in group_of_file.group_names().map_err(text)? {
        *objects += 1;
        let child = group_of_file.group(&name).map_err(text)?;
        let path = join(&tree.path, &name);
        tree.groups
            .push(group(file, &child, path, depth + 1, objects)?);
    }
    Ok(tree)
}

fn array(dataset: &H5Dataset, path: String, name: String) -> Result<Array, String> {
    let datatype = dataset.datatype().map_err(|e| e.to_string())?;
    Ok(Array {
        shape: dataset.shape().into_iter().map(|d| d as u64).collect(),
        element: element(&datatype),
        attributes: attributes(dataset),
        path,
        name,
        handle: 0,
    })
}

fn attributes(dataset: &H5Dataset) -> Attrs {
    let names = dataset.attr_names().unwrap_or_default();
    names
        .into_iter()
        .filter_map(|n| attr(dataset, &n).map(|v| (n, v)))
        .collect()
}

fn attr(dataset: &H5Dataset, name: &str) -> Option<Attr> {
    let attribute = dataset.attr(name).ok()?;
    if let Ok(numbers) = attribute.read_numeric_as::<f64>() {
        return Some(Attr::Numbers(numbers));
    }
    attribute.read_string().ok().map(|t| Attr::Text(vec![t]))
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
