//! MATLAB files of level 4 and level 5 (v4, v5, v6, v7 with compression), in both byte orders, and Octave's text.
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
//!   gives the sample rate. A unit is read from a text `x_unit` or `Units.x` beside `x`, or from `unit` beside the only
//!   signal of a struct.
//! - Sparse matrices and opaque objects are left out by name; a file that holds nothing else is
//!   refused.

pub(crate) mod arrange;
mod contents;
mod element;
mod inflate;
pub(crate) mod names;
mod octave;
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

use crate::bytes::FileBytes;
use crate::source::{ReadError, Source, opened};

/// Whether a file's first bytes (128 or more) are those of a MATLAB file of level 4 or 5.
pub(crate) fn recognises(head: &[u8]) -> bool {
    v5::byte_order(head).or(v4::byte_order(head)).is_some() || octave::recognises(head)
}

/// Open a MATLAB file of level 4 or 5: its variables are found, no samples are read.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let mut file = FileBytes::open(path)?;
    if octave::recognises(file.all()) {
        let (tree, bytes) = octave::scan(&file)?;
        file = file.holding(bytes);
        return arranged(file, tree);
    }
    let head = file.all();
    let tree = match (v5::byte_order(head), v4::byte_order(head)) {
        (Some(order), _) => v5::scan(&file, order)?,
        (None, Some(order)) => v4::scan(&file, order)?,
        (None, None) => {
            let found = format!("{} bytes that are neither", head.len());
            let expected = "the header of a MATLAB file of level 4 or 5";
            return Err(file.refuse(0, expected, found));
        }
    };
    arranged(file, tree)
}

/// The variables found in a file as a source of records.
fn arranged(file: FileBytes, tree: Tree) -> Result<Box<dyn Source>, ReadError> {
    refuse_if_nothing_left(&file, &tree)?;
    let Arranged {
        mut datasets,
        origins,
        mut notes,
    } = arrange::arrange(&tree);
    let path = file.path().to_path_buf();
    let reader = samples::MatFile::new(file, tree, origins);
    notes.extend(reader.take_unnamed_times(&mut datasets));
    opened("mat", &path, datasets, notes, reader)
}

fn refuse_if_nothing_left(file: &FileBytes, tree: &Tree) -> Result<(), ReadError> {
    match tree.nothing_read() {
        Some((found, remedy)) => Err(file.unsupported(0, found, "arrays of numbers", remedy)),
        None => Ok(()),
    }
}
