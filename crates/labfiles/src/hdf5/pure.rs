//! HDF5 files through `hdf5-pure`, read at offsets on demand.

use std::fs::File;
use std::sync::{Arc, Mutex};

use ::hdf5::{
    AttrValue, ChunkCacheConfig, Dataset, FileAccessProperties, FormatError, Group,
    MetadataCacheConfig, Object,
};

use crate::bytes::read_exact_at;
use crate::hdf5::chunked;
use crate::hdf5::datatype::element;
use crate::hdf5::legacy::{self, Patch};
use crate::hdf5::store::{Array, Attr, Attrs, DEEPEST, MOST_OBJECTS, Store, Target, Tree, join};

/// Bytes of metadata that the library may keep.
const METADATA_CACHE_BYTES: usize = 4 << 20;

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

/// An open file.
pub struct PureStore {
    file: Arc<File>,
    datasets: Mutex<Vec<Dataset>>,
    length: u64,
}

/// Open a file and walk its tree.
///
/// # Errors
/// The library's words where it cannot read the structure.
pub fn open(file: File, length: u64) -> Result<(PureStore, Tree), String> {
    let file = Arc::new(file);
    let (store, tree, old) = walk(Positional {
        file: Arc::clone(&file),
        length,
        patches: Vec::new(),
    })?;
    if !old {
        return Ok((store, tree));
    }
    let patches = legacy::patches(&file, length).map_err(|e| e.to_string())?;
    let (store, tree, _) = walk(Positional {
        file,
        length,
        patches,
    })?;
    Ok((store, tree))
}

/// Walk a file; tells also whether it has data layouts older than the library reads.
fn walk(source: Positional) -> Result<(PureStore, Tree, bool), String> {
    let access = FileAccessProperties::new()
        .with_metadata_cache(MetadataCacheConfig::new(METADATA_CACHE_BYTES))
        .with_chunk_cache(ChunkCacheConfig::disabled());
    let (length, shared) = (source.length, Arc::clone(&source.file));
    let file = ::hdf5::File::from_source_with_options(source, access).map_err(|e| e.to_string())?;
    let mut walk = Walk {
        datasets: Vec::new(),
        objects: 0,
    };
    let tree = walk.group(&file.root(), String::new(), 0)?;
    let old = walk.datasets.iter().any(has_old_layout);
    Ok((
        PureStore {
            file: shared,
            datasets: Mutex::new(walk.datasets),
            length,
        },
        tree,
        old,
    ))
}

fn has_old_layout(dataset: &Dataset) -> bool {
    matches!(
        dataset.layout(),
        Err(::hdf5::Error::Format(FormatError::InvalidLayoutVersion(
            1 | 2
        )))
    )
}

struct Walk {
    datasets: Vec<Dataset>,
    objects: usize,
}

impl Walk {
    fn group(&mut self, group: &Group, path: String, depth: usize) -> Result<Tree, String> {
        if depth > DEEPEST {
            return Err(format!("groups nested deeper than {DEEPEST} at '{path}'"));
        }
        let mut tree = Tree {
            attributes: attributes(group.attrs()),
            path,
            ..Tree::default()
        };
        for (name, dataset) in group.iter_datasets().map_err(|e| e.to_string())? {
            self.count()?;
            let array = self.array(dataset, join(&tree.path, &name), name)?;
            tree.arrays.push(array);
        }
        for (name, child) in group.iter_groups().map_err(|e| e.to_string())? {
            self.count()?;
            let path = join(&tree.path, &name);
            tree.groups.push(self.group(&child, path, depth + 1)?);
        }
        Ok(tree)
    }

    fn count(&mut self) -> Result<(), String> {
        self.objects += 1;
        if self.objects > MOST_OBJECTS {
            return Err(format!("more than {MOST_OBJECTS} groups and datasets"));
        }
        Ok(())
    }

    fn array(&mut self, dataset: Dataset, path: String, name: String) -> Result<Array, String> {
        let handle = self.datasets.len();
        let array = describe(&dataset, path, name, handle)?;
        self.datasets.push(dataset);
        Ok(array)
    }
}

fn describe(dataset: &Dataset, path: String, name: String, handle: usize) -> Result<Array, String> {
    let named = |e: ::hdf5::Error| format!("dataset '{path}': {e}");
    let shape = dataset.shape().map_err(named)?;
    let element = element(&dataset.datatype().map_err(named)?);
    Ok(Array {
        shape,
        element,
        attributes: attributes(dataset.attrs()),
        name,
        handle,
        path,
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

impl PureStore {
    fn dataset(&self, array: &Array) -> Result<Dataset, String> {
        let datasets = self.datasets.lock().map_err(|e| e.to_string())?;
        datasets
            .get(array.handle)
            .cloned()
            .ok_or_else(|| format!("no dataset '{}'", array.path))
    }

    fn keep(&self, dataset: Dataset) -> Result<usize, String> {
        let mut datasets = self.datasets.lock().map_err(|e| e.to_string())?;
        datasets.push(dataset);
        Ok(datasets.len() - 1)
    }

    /// Take over the arrays of a walk of its own.
    fn adopt(&self, mut tree: Tree, datasets: Vec<Dataset>) -> Result<Tree, String> {
        let first = {
            let mut all = self.datasets.lock().map_err(|e| e.to_string())?;
            let first = all.len();
            all.extend(datasets);
            first
        };
        fn shift(tree: &mut Tree, by: usize) {
            tree.arrays.iter_mut().for_each(|a| a.handle += by);
            tree.groups.iter_mut().for_each(|g| shift(g, by));
        }
        shift(&mut tree, first);
        Ok(tree)
    }
}

impl Store for PureStore {
    fn raw(&self, array: &Array) -> Result<Vec<u8>, String> {
        let dataset = self.dataset(array)?;
        match chunked::rows(&self.file, &dataset, array.element.bytes(), None) {
            Some(bytes) => Ok(bytes),
            None => dataset.read_raw().map_err(|e| e.to_string()),
        }
    }

    fn rows(&self, array: &Array, start: u64, count: u64) -> Result<Vec<u8>, String> {
        let dataset = self.dataset(array)?;
        let range = start..start.saturating_add(count);
        match chunked::rows(&self.file, &dataset, array.element.bytes(), Some(range)) {
            Some(bytes) => Ok(bytes),
            None => dataset
                .read_raw_rows(start, count)
                .map_err(|e| e.to_string()),
        }
    }

    fn texts(&self, array: &Array) -> Result<Vec<String>, String> {
        self.dataset(array)?
            .read_string()
            .map_err(|e| e.to_string())
    }

    fn targets(&self, array: &Array) -> Result<Vec<Option<Target>>, String> {
        let objects = self
            .dataset(array)?
            .dereference()
            .map_err(|e| e.to_string())?;
        let mut targets = Vec::with_capacity(objects.len());
        for (i, object) in objects.into_iter().enumerate() {
            let name = format!("{}{{{}}}", array.path, i + 1);
            targets.push(match object {
                Object::Dataset(dataset) => {
                    let mut array = describe(&dataset, name.clone(), name, 0)?;
                    array.handle = self.keep(*dataset)?;
                    Some(Target::Array(array))
                }
                Object::Group(group) => {
                    let mut walk = Walk {
                        datasets: Vec::new(),
                        objects: 0,
                    };
                    let tree = walk.group(&group, name, 0)?;
                    Some(Target::Group(self.adopt(tree, walk.datasets)?))
                }
                _ => None,
            });
        }
        Ok(targets)
    }

    fn file_bytes(&self) -> u64 {
        self.length
    }

    fn chunk_bytes(&self, array: &Array) -> u64 {
        let Ok(dataset) = self.dataset(array) else {
            return 0;
        };
        let shape = dataset.chunk_shape().ok().flatten().unwrap_or_default();
        if shape.is_empty() {
            return 0;
        }
        let bytes = array.element.bytes().max(1) as u64;
        let by_shape = shape
            .iter()
            .try_fold(bytes, |n, &d| n.checked_mul(d))
            .unwrap_or(u64::MAX);
        // LZF states the size of an unpacked chunk in its own parameters.
        let pipeline = dataset.filter_pipeline();
        let lzf = pipeline
            .iter()
            .filter(|f| f.id == FILTER_LZF)
            .flat_map(|f| f.client_data.get(2));
        by_shape.max(lzf.map(|&n| u64::from(n)).max().unwrap_or(0))
    }

    fn stored_bytes(&self, array: &Array) -> Option<u64> {
        let dataset = self.dataset(array).ok()?;
        match dataset.layout().ok()? {
            ::hdf5::Layout::Compact { size } => Some(size),
            ::hdf5::Layout::Contiguous {
                address: Some(_),
                size,
            } => Some(size),
            ::hdf5::Layout::Contiguous { address: None, .. } => Some(0),
            ::hdf5::Layout::Chunked { .. } => {
                Some(dataset.chunks().ok()?.iter().map(|c| c.storage_size).sum())
            }
            _ => None,
        }
    }
}
