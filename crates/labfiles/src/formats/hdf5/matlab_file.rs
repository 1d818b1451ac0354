//! A MATLAB 7.3 file as a source of records.

use std::path::{Path, PathBuf};

use crate::bytes::to_usize;
use crate::formats::hdf5::library::Store;
use crate::formats::hdf5::matlab::{self, Found};
use crate::formats::hdf5::store::{Array, Tree};
use crate::formats::mat::arrange::{self, Arranged, Origin};
use crate::formats::mat::tree::Leaf;
use crate::source::{ReadError, Reader, Samples, Source, opened};

struct MatlabReader {
    path: PathBuf,
    store: Store,
    found: Found,
    origins: Vec<Vec<Origin>>,
}

/// Open a file whose tree follows MATLAB's conventions.
///
/// # Errors
/// If references lead nowhere, or nothing is left that is read.
pub(crate) fn open(path: &Path, store: Store, tree: &Tree) -> Result<Box<dyn Source>, ReadError> {
    let found = matlab::find(&store, tree).map_err(|e| {
        ReadError::new(
            path,
            "a complete MATLAB 7.3 file",
            e.to_string(),
            "save the variables again",
        )
    })?;
    if found.variables.leaves.is_empty() {
        let none = || {
            (
                "no variables".to_owned(),
                "save arrays of numbers".to_owned(),
            )
        };
        let (left, remedy) = found.variables.nothing_read().unwrap_or_else(none);
        return Err(ReadError::new(path, "arrays of numbers", left, remedy));
    }
    let Arranged {
        mut datasets,
        origins,
        mut notes,
    } = arrange::arrange(&found.variables);
    let reader = MatlabReader {
        path: path.to_path_buf(),
        store,
        found,
        origins,
    };
    let values = |dataset: usize, channel: usize| {
        let mut read = reader.read(dataset, &[channel]).ok()?;
        read.pop()?.into_real()
    };
    let tree = &reader.found.variables;
    let more = arrange::take_unnamed_times(tree, &reader.origins, &mut datasets, values);
    notes.extend(more);
    opened("mat", path, datasets, notes, reader)
}

impl MatlabReader {
    fn array(&self, leaf: &Leaf) -> &Array {
        &self.found.arrays[to_usize(leaf.part().at)]
    }

    fn error(&self, leaf: &Leaf, found: impl Into<String>) -> ReadError {
        let remedy = "save the variable again, or leave it out";
        ReadError::new(&self.path, "a readable MATLAB variable", found, remedy).channel(&leaf.name)
    }

    fn raw(&self, leaf: &Leaf) -> Result<Vec<u8>, ReadError> {
        self.store
            .raw(self.array(leaf))
            .map_err(|e| self.error(leaf, e.to_string()))
    }
}

impl Reader for MatlabReader {
    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        let mut last: Option<(usize, Vec<u8>)> = None;
        let mut all = Vec::with_capacity(channels.len());
        for &channel in channels {
            let origin = self.origins[dataset][channel];
            let leaf = &self.found.variables.leaves[origin.leaf];
            // The columns of a matrix follow each other: it is read once for all of them.
            let raw = match last.take() {
                Some((leaf, raw)) if leaf == origin.leaf => raw,
                _ => self.raw(leaf)?,
            };
            let samples = matlab::values::extract(leaf, self.array(leaf), origin, &raw);
            all.push(
                samples.ok_or_else(|| self.error(leaf, format!("{} bytes, too few", raw.len())))?,
            );
            last = Some((origin.leaf, raw));
        }
        Ok(all)
    }
}
