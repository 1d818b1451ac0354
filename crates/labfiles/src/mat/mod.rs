//! MATLAB files of level 4 and level 5 (v4, v5, v6, v7 with compression), in both byte orders.
//! Level 7.3 is HDF5 and not read here.
//!
//! How a file maps to datasets and channels:
//!
//! - Every numeric vector is a channel, every column of a matrix is one (`data(:,2)`), counted
//!   from 1 as in MATLAB. A matrix is taken by rows instead (`data(1,:)`, with a note) where the
//!   length of its rows is that of a vector beside it, or if it is at least 16 times wider
//!   than tall. Character arrays are channels of text, one string per row.
//! - Channels in structs and cells are named by their path: `rig.velocity`, `c{2}`, `s(3).x`;
//!   an index of a struct or cell of one element is left out.
//! - All variables form one dataset without a name, except a struct array or cell array whose
//!   every element looks like a record (a struct with numeric vectors, or a matrix): each
//!   element then is a dataset (`runs(2)`), whose channels carry the path inside the element. A
//!   time vector beside the array is added to each record that has its length.
//! - Single numbers and short texts are channels and also attributes of the dataset, so that
//!   clearance or frequency are attributes of the record; one called `fs`, `sample_rate` or `dt`
//!   gives the sample rate. A unit is read from a text `x_unit` or `Units.x` beside `x`.
//! - Sparse matrices and opaque objects are left out by name; a file that holds nothing else is
//!   refused.

pub(crate) mod arrange;
mod contents;
mod element;
mod inflate;
pub(crate) mod names;
mod samples;
#[cfg(test)]
mod tests;
pub(crate) mod text;
pub(crate) mod tree;
mod v4;
mod v5;

use std::path::Path;

use arrange::Arranged;
use tree::Tree;

use super::bytes::FileBytes;
use super::source::{Opened, ReadError, Reader, Samples, Source};

/// Whether a file's first bytes (128 or more) are those of a MATLAB file of level 4 or 5.
pub(crate) fn recognises(head: &[u8]) -> bool {
    v5::byte_order(head).is_some() || (!v5::is_hdf5(head) && v4::byte_order(head).is_some())
}

/// Open a MATLAB file of level 4 or 5: its variables are found, no samples are read.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let file = FileBytes::open(path)?;
    let tree = scan(&file)?;
    refuse_if_nothing_left(&file, &tree)?;
    let Arranged {
        datasets,
        origins,
        notes,
    } = arrange::arrange(&tree);
    let left_out = tree
        .refused
        .iter()
        .map(|(name, kind)| format!("{kind} '{name}' not read"));
    let notes = tree
        .notes
        .iter()
        .cloned()
        .chain(left_out)
        .chain(notes)
        .collect();
    Ok(Box::new(Opened {
        format: "mat",
        path: path.to_path_buf(),
        datasets,
        notes,
        reader: MatFile {
            store: samples::Store::new(file, tree),
            origins,
        },
    }))
}

fn scan(file: &FileBytes) -> Result<Tree, ReadError> {
    let head = file.all();
    if let Some(order) = v5::byte_order(head) {
        return v5::scan(file, order);
    }
    if v5::is_hdf5(head) {
        let remedy = "Open it as HDF5.";
        return Err(file.unsupported(124, "a v7.3 file", "a MATLAB file before v7.3", remedy));
    }
    match v4::byte_order(head) {
        Some(order) => v4::scan(file, order),
        None => {
            let found = format!("{} bytes that are neither", head.len());
            let expected = "the header of a MATLAB file of level 4 or 5";
            Err(file.refuse(0, expected, found))
        }
    }
}

fn refuse_if_nothing_left(file: &FileBytes, tree: &Tree) -> Result<(), ReadError> {
    match (tree.leaves.is_empty(), tree.refused.first()) {
        (true, Some((name, kind))) => Err(file.unsupported(
            0,
            format!("{kind} '{name}' and nothing else"),
            "arrays of numbers",
            "Save full arrays: full(x), or the object's numbers as a struct.",
        )),
        _ => Ok(()),
    }
}

struct MatFile {
    store: samples::Store,
    origins: Vec<Vec<arrange::Origin>>,
}

impl Reader for MatFile {
    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        let wanted: Vec<_> = channels.iter().map(|&c| self.origins[dataset][c]).collect();
        self.store.read(&wanted)
    }
}
