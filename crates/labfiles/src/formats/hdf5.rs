//! HDF5 files: groups of one-dimensional arrays, or one table per record.
//!
//! `hdf5-pure` reads them at offsets on demand; arrays of newer layouts `rust-hdf5` reads.

mod chunked;
mod datatype;
mod element;
mod legacy;
mod library;
mod matlab;
mod matlab_file;
mod naming;
mod plan;
mod second;
mod store;

use std::fs::File;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::bytes::to_usize;
use crate::formats::hdf5::element::Element;
use crate::formats::hdf5::library::Store;
use crate::formats::hdf5::plan::{Locator, Plan, Plans};
use crate::formats::hdf5::store::{Array, StoreError, Tree};
use crate::numbers::Spacing;
use crate::rate;
use crate::source::{ChannelInfo, DatasetInfo, ReadError, Reader, Samples, Source, opened};
use crate::timing::{self, AxisUnit};

/// The first bytes of an HDF5 file.
const SIGNATURE: [u8; 8] = [0x89, b'H', b'D', b'F', b'\r', b'\n', 0x1A, b'\n'];

struct Hdf5Reader {
    path: PathBuf,
    store: Store,
    plans: Vec<Plan>,
}

/// HDF5's signature is at the front, or after a user block of 512, 1024 or 2048 bytes.
pub(crate) fn recognises(front: &[u8]) -> bool {
    [0usize, 512, 1024, 2048]
        .iter()
        .any(|&at| front.get(at..).is_some_and(|b| b.starts_with(&SIGNATURE)))
}

/// Open an HDF5 file.
///
/// # Errors
/// If its structure cannot be read, or it holds no numbers.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let (store, tree) = open_store(path)?;
    if matlab::is_matlab(&tree) {
        return matlab_file::open(path, store, &tree);
    }
    let Plans {
        mut datasets,
        plans,
        mut notes,
    } = plan::plan(&store, &tree);
    notes.extend(tree.unreadable().map(|fault| format!("left out: {fault}")));
    if datasets.is_empty() {
        return Err(ReadError::new(
            path,
            "arrays of numbers in the HDF5 file",
            format!("none ({})", notes.join("; ")),
            "check that the measurement was saved into this file",
        ));
    }
    let path = path.to_path_buf();
    let reader = Hdf5Reader {
        path: path.clone(),
        store,
        plans,
    };
    notes.extend(reader.take_unnamed_times(&mut datasets));
    reader.measure_rates(&mut datasets);
    opened("hdf5", &path, datasets, notes, reader)
}

/// Open a file and walk its tree.
fn open_store(path: &Path) -> Result<(Store, Tree), ReadError> {
    let io = |e: std::io::Error| ReadError::io(path, &e);
    let file = File::open(path).map_err(io)?;
    let length = file.metadata().map_err(io)?.len();
    library::open(path, file, length).map_err(|fault| {
        let remedy =
            "copy the file again from the instrument, or write it with an older file layout";
        let byte = if fault.is_cut_off() { length } else { 0 };
        ReadError::new(path, "a complete HDF5 file", fault.to_string(), remedy).at(byte)
    })
}

impl Hdf5Reader {
    fn refused(&self, array: &Array, fault: &StoreError) -> ReadError {
        let Some(filter) = fault.unsupported_filter() else {
            return self.error(array, fault.to_string());
        };
        ReadError::new(
            &self.path,
            "a dataset that is packed by a filter that this program has",
            format!("the filter {filter}"),
            "write it again without this filter, for example by `h5repack -f GZIP=4 IN OUT`",
        )
        .channel(&array.path)
    }

    fn error(&self, array: &Array, found: String) -> ReadError {
        ReadError::new(
            &self.path,
            "a readable HDF5 dataset",
            found,
            "copy the file again from the instrument, or leave this record out",
        )
        .channel(&array.path)
    }

    /// The bytes of an array, or of its entry where the record is one of many in it.
    fn bytes(&self, plan: &Plan, array: &Array) -> Result<Vec<u8>, ReadError> {
        match plan.slab {
            Some(slab) => self.store.rows(array, slab, 1),
            None => self.store.raw(array),
        }
        .map_err(|e| self.refused(array, &e))
    }

    /// Read those of the wanted channels that are in one array.
    fn read_array(
        &self,
        plan: &Plan,
        number: usize,
        wanted: &[usize],
        out: &mut [Option<Samples>],
    ) -> Result<(), ReadError> {
        let array = &plan.arrays[number];
        if array.element == Element::Text {
            let texts = self
                .store
                .texts(array)
                .map_err(|e| self.refused(array, &e))?;
            for (slot, _) in slots(plan, number, wanted) {
                out[slot] = Some(Samples::Text(texts.clone()));
            }
            return Ok(());
        }
        let raw = self.bytes(plan, array)?;
        for (slot, locator) in slots(plan, number, wanted) {
            let samples = extract(&raw, locator, locator.spacing);
            out[slot] = Some(samples.ok_or_else(|| {
                self.error(
                    array,
                    format!("{} bytes, too few for {:?}", raw.len(), array.shape),
                )
            })?);
        }
        Ok(())
    }

    /// Take the first column of tables without names that climbs evenly for their time; gives what was assumed.
    fn take_unnamed_times(&self, datasets: &mut [DatasetInfo]) -> Vec<String> {
        let mut notes = Vec::new();
        for (number, set) in datasets.iter_mut().enumerate() {
            let unnamed = set.channels.len() > 1 && set.channels[0].name == "column_1";
            let timed = set.time_axis.is_some() || set.sample_rate_hz().is_some();
            if timed || !unnamed {
                continue;
            }
            let first = self.read(number, &[0]).ok().and_then(|mut r| r.pop());
            let first = first.and_then(Samples::into_real);
            if first.is_some_and(|values| timing::climbs_evenly(&values)) {
                set.time_axis = Some(0);
                notes.push(format!(
                    "the first column of {} climbs evenly and has no name: taken as time in seconds",
                    set.name
                ));
            }
        }
        notes
    }

    /// Take the rates that no attribute states from the ends of the time axes.
    fn measure_rates(&self, datasets: &mut [DatasetInfo]) {
        let planned = datasets.par_iter_mut().zip(&self.plans);
        planned.for_each(|(info, plan)| {
            let axis = info.time_axis.filter(|_| info.sample_rate_hz().is_none());
            let rate = axis.and_then(|axis| self.axis_rate(&info.channels[axis], plan, axis));
            for channel in &mut info.channels {
                channel.sample_rate_hz = channel.sample_rate_hz.or(rate);
            }
        });
    }

    /// The rate of a time axis by its first samples and its last.
    fn axis_rate(&self, info: &ChannelInfo, plan: &Plan, axis: usize) -> Option<f64> {
        let locator = &plan.channels[axis];
        let array = &plan.arrays[locator.array];
        let (&length, inner) = array.shape.split_first()?;
        let row = array.element.bytes() as u64;
        let row = inner.iter().fold(row, |n, &d| n.saturating_mul(d));
        if plan.slab.is_some() || length != info.samples || locator.spacing.stride as u64 != row {
            return None;
        }
        let head = info.samples.min(rate::HEAD_SAMPLES as u64);
        let head = self.axis_values(array, locator, 0, head)?;
        let end = self.axis_values(array, locator, info.samples.checked_sub(1)?, 1)?;
        let end = end.first().copied();
        let unit = AxisUnit::of(info.unit.as_deref(), &info.name, &head).seconds()?;
        rate::from_axis(&head, end, info.samples, unit)
    }

    fn axis_values(
        &self,
        array: &Array,
        locator: &Locator,
        from: u64,
        count: u64,
    ) -> Option<Vec<f64>> {
        let raw = self.store.rows(array, from, count).ok()?;
        let count = to_usize(count);
        let spacing = Spacing {
            count,
            ..locator.spacing
        };
        extract(&raw, locator, spacing)?.into_real()
    }
}

/// Which of the wanted channels are in an array: their place in the answer and their locator.
fn slots<'a>(
    plan: &'a Plan,
    number: usize,
    wanted: &'a [usize],
) -> impl Iterator<Item = (usize, &'a Locator)> {
    wanted
        .iter()
        .map(|&c| &plan.channels[c])
        .enumerate()
        .filter(move |(_, l)| l.array == number)
}

/// The samples of one channel from its array's bytes.
fn extract(raw: &[u8], locator: &Locator, spacing: Spacing) -> Option<Samples> {
    let mut samples = locator.element.decode(raw, spacing)?;
    let (scale, offset) = locator.scaling;
    if let Samples::Real(values) = &mut samples
        && (scale, offset) != (1.0, 0.0)
    {
        values.iter_mut().for_each(|v| *v = *v * scale + offset);
    }
    Some(samples)
}

impl Reader for Hdf5Reader {
    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        let plan = &self.plans[dataset];
        let mut out: Vec<Option<Samples>> = vec![None; channels.len()];
        for number in 0..plan.arrays.len() {
            if channels.iter().any(|&c| plan.channels[c].array == number) {
                self.read_array(plan, number, channels, &mut out)?;
            }
        }
        // every channel is in one of the plan's arrays
        Ok(out.into_iter().flatten().collect())
    }
}

#[cfg(test)]
mod tests;
