//! HDF5 files through `hdf5-pure`, read at offsets on demand.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use ::hdf5::{
    AttrValue, ChunkCacheConfig, Dataset, FileAccessProperties, FormatError, Group, Layout,
    MetadataCacheConfig, Object,
};

use rayon::prelude::*;

use crate::bytes::{read_exact_at, to_usize};
use crate::formats::hdf5::chunked;
use crate::formats::hdf5::datatype::element;
use crate::formats::hdf5::legacy::{self, Patch};
use crate::formats::hdf5::second;
use crate::formats::hdf5::store::{
    Array, Attr, Attrs, DEEPEST, MOST_OBJECTS, StoreError, Target, Tree, join, product,
};

/// Bytes of metadata that the library may keep.
const METADATA_CACHE_BYTES: usize = 4 << 20;

/// How many times larger than its whole file an unpacked array may be: signals pack a few times,
/// constant channels beside them far more.
const GREATEST_RATIO: u64 = 128;
/// Arrays and chunks up to this size are read whatever their packing.
const HARMLESS_BYTES: u64 = 1 << 16;

/// The registered number of h5py's LZF filter.
const FILTER_LZF: u16 = 32000;

/// A file read at offsets, shared by threads.
struct Positional {
    file: Arc<File>,
    length: u64,
    patches: Vec<Patch>,
}

impl ::hdf5::Source for Positional {
    fn len(&self) -> u64 {
        self.length
    }

    fn read_at(&self, offset: u64, into: &mut [u8]) -> Result<(), FormatError> {
        if offset
            .checked_add(into.len() as u64)
            .is_none_or(|end| end > self.length)
        {
            return Err(FormatError::UnexpectedEof {
                expected: usize::try_from(offset)
                    .unwrap_or(usize::MAX)
                    .saturating_add(into.len()),
                available: usize::try_from(self.length).unwrap_or(usize::MAX),
            });
        }
        read_exact_at(&self.file, into, offset).map_err(|e| FormatError::Source(e.to_string()))?;
        legacy::apply(&self.patches, offset, into);
        Ok(())
    }
}

/// An open file, of which arrays are read as far as the file can hold them.
pub(crate) struct Store {
    path: PathBuf,
    file: Arc<File>,
    length: u64,
}

/// Open a file and walk its tree.
///
/// # Errors
/// The library's error if it cannot read the structure.
pub(crate) fn open(path: &Path, file: File, length: u64) -> Result<(Store, Tree), StoreError> {
    let file = Arc::new(file);
    let source = |patches| Positional {
        file: Arc::clone(&file),
        length,
        patches,
    };
    let (mut tree, old) = walk(source(Vec::new()))?;
    if old {
        let patches = legacy::patches(&file, length).map_err(::hdf5::Error::Io)?;
        tree = walk(source(patches))?.0;
    }
    let path = path.to_path_buf();
    Ok((Store { path, file, length }, tree))
}

/// Walk a file; gives also whether it has data layouts older than the library reads.
fn walk(source: Positional) -> Result<(Tree, bool), StoreError> {
    let access = FileAccessProperties::new()
        .with_metadata_cache(MetadataCacheConfig::new(METADATA_CACHE_BYTES))
        .with_chunk_cache(ChunkCacheConfig::disabled());
    let file = ::hdf5::File::from_source_with_options(source, access)?;
    let walk = Walk::default();
    let tree = walk.group(&file.root(), String::new(), 0)?;
    Ok((tree, walk.old.load(Ordering::Relaxed)))
}

fn has_old_layout(dataset: &Dataset) -> bool {
    matches!(
        dataset.layout(),
        Err(::hdf5::Error::Format(FormatError::InvalidLayoutVersion(
            1 | 2
        )))
    )
}

#[derive(Default)]
struct Walk {
    objects: AtomicUsize,
    /// Whether a dataset has a layout older than the library reads.
    old: AtomicBool,
}

impl Walk {
    fn group(&self, group: &Group, path: String, depth: usize) -> Result<Tree, StoreError> {
        if depth > DEEPEST {
            return Err(StoreError::TooDeep(path));
        }
        let mut tree = Tree {
            attributes: attributes(group.attrs()),
            path,
            ..Tree::default()
        };
        let datasets: Vec<(String, Dataset)> = group.iter_datasets()?.collect();
        let described = datasets.into_par_iter().map(|(name, dataset)| {
            self.count()?;
            self.old
                .fetch_or(has_old_layout(&dataset), Ordering::Relaxed);
            describe(dataset, join(&tree.path, &name), name)
        });
        // of several faults the first in the file is told
        for described in described.collect::<Vec<_>>() {
            match described {
                Ok(array) => tree.arrays.push(array),
                // One dataset that cannot be described does not hide the others.
                Err(fault @ StoreError::Dataset { .. }) if !fault.is_cut_off() => {
                    tree.unreadable.push(fault.to_string());
                }
                Err(fault) => return Err(fault),
            }
        }
        let children: Vec<(String, Group)> = group.iter_groups()?.collect();
        let below = |(name, child): &(String, Group)| {
            self.count()?;
            self.group(child, join(&tree.path, name), depth + 1)
        };
        let groups: Vec<Result<Tree, StoreError>> = children.par_iter().map(below).collect();
        tree.groups = groups.into_iter().collect::<Result<_, _>>()?;
        Ok(tree)
    }

    fn count(&self) -> Result<(), StoreError> {
        if self.objects.fetch_add(1, Ordering::Relaxed) >= MOST_OBJECTS {
            return Err(StoreError::TooMany);
        }
        Ok(())
    }
}

fn describe(dataset: Dataset, path: String, name: String) -> Result<Array, StoreError> {
    let described = dataset.shape().and_then(|s| Ok((s, dataset.datatype()?)));
    let (shape, datatype) = match described {
        Ok(described) => described,
        Err(error) => return Err(StoreError::Dataset { path, error }),
    };
    let element = element(&datatype);
    Ok(Array {
        shape,
        element,
        attributes: attributes(dataset.attrs()),
        name,
        path,
        dataset,
    })
}

/// Attributes as text and numbers; unreadable ones are left out.
fn attributes(read: Result<std::collections::HashMap<String, AttrValue>, ::hdf5::Error>) -> Attrs {
    let pairs = read.unwrap_or_default();
    pairs
        .into_iter()
        .filter_map(|(name, value)| Some((name, attr(&value)?)))
        .collect()
}

fn attr(value: &AttrValue) -> Option<Attr> {
    if let Some(texts) = value.as_strings() {
        return Some(Attr::Text(texts.to_vec()));
    }
    let floats = value.to_f64s();
    let integers = || Some(value.to_i64s()?.into_iter().map(|v| v as f64).collect());
    let naturals = || Some(value.to_u64s()?.into_iter().map(|v| v as f64).collect());
    floats
        .or_else(integers)
        .or_else(naturals)
        .map(Attr::Numbers)
}

impl Store {
    /// An array's dataset, if the file can hold what it claims: no chunk and no shape far larger
    /// than the file, and something stored of a large array.
    fn checked<'a>(&self, array: &'a Array) -> Result<&'a Dataset, StoreError> {
        let claimed = array.claimed();
        let chunk = chunk_bytes(&array.dataset, array);
        let stored = stored_bytes(&array.dataset).unwrap_or_else(|| claimed.min(self.length));
        let within = |bytes: u64| bytes <= HARMLESS_BYTES || bytes / GREATEST_RATIO <= self.length;
        if !within(chunk) {
            Err(StoreError::Chunks(chunk))
        } else if stored > self.length {
            Err(StoreError::Stored(stored))
        } else if claimed <= HARMLESS_BYTES || (within(claimed) && stored > 0) {
            Ok(&array.dataset)
        } else {
            let shape = array.shape.clone();
            Err(StoreError::Shape { shape, stored })
        }
    }

    /// The unpacked bytes of an array, row by row.
    pub(super) fn raw(&self, array: &Array) -> Result<Vec<u8>, StoreError> {
        let dataset = self.checked(array)?;
        match chunked::rows(&self.file, dataset, array.element.bytes(), None) {
            Some(bytes) => Ok(bytes),
            None => self.either(dataset.read_raw(), |path| second::raw(path, array)),
        }
    }

    /// The unpacked bytes of `count` entries along the first dimension from `start`.
    pub(super) fn rows(
        &self,
        array: &Array,
        start: u64,
        count: u64,
    ) -> Result<Vec<u8>, StoreError> {
        let dataset = self.checked(array)?;
        let range = start..start.saturating_add(count);
        if let Some(bytes) = chunked::rows(
            &self.file,
            dataset,
            array.element.bytes(),
            Some(range.clone()),
        ) {
            return Ok(bytes);
        }
        self.either(dataset.read_raw_rows(start, count), |path| {
            let row: u64 = array.shape.iter().skip(1).product();
            let bytes = row.saturating_mul(array.element.bytes() as u64);
            let at = |row: u64| to_usize(row.saturating_mul(bytes));
            let all = second::raw(path, array)?;
            Ok(all
                .get(at(range.start)..at(range.end))
                .unwrap_or(&[])
                .to_vec())
        })
    }

    /// The texts of an array of texts.
    pub(super) fn texts(&self, array: &Array) -> Result<Vec<String>, StoreError> {
        let dataset = self.checked(array)?;
        self.either(dataset.read_string(), |path| second::texts(path, array))
    }

    /// What the library reads, or else the second one if the first lacks a feature.
    fn either<T>(
        &self,
        first: Result<T, ::hdf5::Error>,
        second: impl FnOnce(&Path) -> rust_hdf5::Result<T>,
    ) -> Result<T, StoreError> {
        match first {
            Err(first) if second::may_read(&first) => {
                second(&self.path).map_err(|second| StoreError::Both { first, second })
            }
            first => Ok(first?),
        }
    }

    /// The objects that an array of references points at; `None` for a null reference.
    pub(super) fn targets(&self, array: &Array) -> Result<Vec<Option<Target>>, StoreError> {
        let objects = self.checked(array)?.dereference()?;
        let mut targets = Vec::with_capacity(objects.len());
        for (i, object) in objects.into_iter().enumerate() {
            let name = format!("{}{{{}}}", array.path, i + 1);
            targets.push(match object {
                Object::Dataset(dataset) => {
                    Some(Target::Array(describe(*dataset, name.clone(), name)?))
                }
                Object::Group(group) => {
                    Some(Target::Group(Walk::default().group(&group, name, 0)?))
                }
                _ => None,
            });
        }
        Ok(targets)
    }
}

/// Bytes that one unpacked chunk of an array takes; zero if it has no chunks.
fn chunk_bytes(dataset: &Dataset, array: &Array) -> u64 {
    let shape = dataset.chunk_shape().ok().flatten().unwrap_or_default();
    if shape.is_empty() {
        return 0;
    }
    let bytes = array.element.bytes().max(1) as u64;
    let by_shape = product(bytes, &shape).unwrap_or(u64::MAX);
    // LZF states the size of an unpacked chunk in its own parameters.
    let pipeline = dataset.filter_pipeline();
    let lzf = pipeline
        .iter()
        .filter(|f| f.id == FILTER_LZF)
        .flat_map(|f| f.client_data.get(2));
    by_shape.max(lzf.map(|&n| u64::from(n)).max().unwrap_or(0))
}

/// Bytes that an array takes in the file, if the library states it.
fn stored_bytes(dataset: &Dataset) -> Option<u64> {
    match dataset.layout().ok()? {
        Layout::Compact { size } => Some(size),
        Layout::Contiguous {
            address: Some(_),
            size,
        } => Some(size),
        Layout::Contiguous { address: None, .. } => Some(0),
        Layout::Chunked { .. } => Some(dataset.chunks().ok()?.iter().map(|c| c.storage_size).sum()),
        _ => None,
    }
}
