//! HDF5 files: groups of one-dimensional arrays, or one table a record.
//!
//! `hdf5-pure` reads them at offsets on demand; what it refuses `rust-hdf5` reads.

pub mod chunked;
mod datatype;
pub mod element;
pub mod fallback;
pub mod guard;
pub mod legacy;
pub mod matlab;
pub mod matlab_file;
pub mod naming;
pub mod plan;
pub mod pure;
pub mod store;

use std::fs::File;
use std::path::{Path, PathBuf};

use rayon::prelude::*;

use crate::hdf5::element::{Element, Stride};
use crate::hdf5::guard::Guarded;
use crate::hdf5::plan::{Locator, Part, Plan, Plans};
use crate::hdf5::store::{Array, Store, Tree};
use crate::rate;
use crate::source::{self, DatasetInfo, ReadError, Samples, Source};
use crate::units::parse_unit;

/// The first bytes of an HDF5 file.
pub const SIGNATURE: [u8; 8] = [0x89, b'H', b'D', b'F', b'\r', b'\n', 0x1A, b'\n'];

struct Hdf5Source {
    path: PathBuf,
    store: Box<dyn Store>,
    plans: Plans,
}

/// Open an HDF5 file.
///
/// # Errors
/// Where neither library can read its structure, or it holds no numbers.
pub fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let (store, tree, notes) = open_store(path)?;
    if matlab::is_matlab(&tree) {
        return matlab_file::open(path, store, &tree, notes);
    }
    let mut plans = plan::plan(&*store, &tree);
    plans.notes.extend(notes);
    if plans.datasets.is_empty() {
        return Err(ReadError::new(
            path,
            "arrays of numbers in the HDF5 file",
            format!("none ({})", plans.notes.join("; ")),
            "Check that the measurement was saved into this file.",
        ));
    }
    let mut source = Hdf5Source {
        path: path.to_path_buf(),
        store,
        plans,
    };
    source.measure_rates();
    Ok(Box::new(source))
}

/// A file's reader, its tree, and notes where the second library reads it.
type Opened = (Box<dyn Store>, Tree, Vec<String>);

/// Open a file with the first library that reads its structure.
fn open_store(path: &Path) -> Result<Opened, ReadError> {
    let io = |e: std::io::Error| ReadError::io(path, &e);
    let file = File::open(path).map_err(io)?;
    let length = file.metadata().map_err(io)?.len();
    match pure::open(file, length) {
        Ok((store, tree)) => Ok((
            Box::new(Guarded(fallback::WithFallback::new(store, path))),
            tree,
            Vec::new(),
        )),
        Err(first) => match second(path, &first) {
            Ok((store, tree, lost)) => {
                let mut notes = vec![format!(
                    "read by the second HDF5 library, because the first says: {first}"
                )];
                notes.extend(lost);
                Ok((Box::new(Guarded(store)), tree, notes))
            }
            Err(both) => Err(ReadError::new(
                path,
                "a complete HDF5 file",
                both,
                "Copy the file anew from the instrument, or write it with an older file layout.",
            )
            .at(byte_of(&first, length))),
        },
    }
}

/// Open a file with the second library, where the first does not know its layout; else, and where
/// both refuse, their words.
fn second(path: &Path, first: &str) -> Result<fallback::Opened, String> {
    if !fallback::is_unsupported(first) {
        return Err(first.to_owned());
    }
    fallback::open(path).map_err(|e| format!("{first}; the second library says: {e}"))
}

/// Where a library's message points: behind the end for a file cut off, else its beginning.
fn byte_of(message: &str, length: u64) -> u64 {
    if message.to_lowercase().contains("eof") {
        length
    } else {
        0
    }
}

impl Hdf5Source {
    fn error(&self, array: &Array, found: impl Into<String>) -> ReadError {
        ReadError::new(
            &self.path,
            "a readable HDF5 dataset",
            found,
            "Copy the file anew from the instrument, or take this record out of the campaign.",
        )
        .channel(&array.path)
    }

    /// The bytes of an array, or of its entry where the record is one of many in it.
    fn bytes(&self, plan: &Plan, array: &Array) -> Result<Vec<u8>, ReadError> {
        match plan.slab {
            Some(slab) => self.store.rows(array, slab, 1),
            None => self.store.raw(array),
        }
        .map_err(|e| self.error(array, e))
    }

    /// Read those of the wanted channels that lie in one array.
    fn read_array(
        &self,
        plan: &Plan,
        number: usize,
        wanted: &[usize],
        out: &mut [Option<Samples>],
    ) -> Result<(), ReadError> {
        let array = &plan.arrays[number];
        if array.element == Element::Text {
            let texts = self.store.texts(array).map_err(|e| self.error(array, e))?;
            for (slot, _) in slots(plan, number, wanted) {
                out[slot] = Some(Samples::Text(texts.clone()));
            }
            return Ok(());
        }
        let raw = self.bytes(plan, array)?;
        for (slot, locator) in slots(plan, number, wanted) {
            let samples = extract(&raw, array, locator, plan.slab.is_some());
            out[slot] = Some(samples.ok_or_else(|| {
                self.error(
                    array,
                    format!("{} bytes, too few for {:?}", raw.len(), array.shape),
                )
            })?);
        }
        Ok(())
    }

    /// Take the rates that no attribute states from the ends of the time axes.
    fn measure_rates(&mut self) {
        let open = |(d, info): (usize, &DatasetInfo)| {
            let axis = info.time_axis.filter(|_| info.sample_rate_hz().is_none())?;
            self.axis_rate(d, axis)
        };
        let rates: Vec<Option<f64>> = self
            .plans
            .datasets
            .par_iter()
            .enumerate()
            .map(open)
            .collect();
        for (info, rate) in self.plans.datasets.iter_mut().zip(rates) {
            for channel in &mut info.channels {
                channel.sample_rate_hz = channel.sample_rate_hz.or(rate);
            }
        }
    }

    /// The rate of a time axis by its first samples and its last.
    fn axis_rate(&self, dataset: usize, axis: usize) -> Option<f64> {
        let info = &self.plans.datasets[dataset].channels[axis];
        let plan = &self.plans.plans[dataset];
        let locator = &plan.channels[axis];
        let array = &plan.arrays[locator.array];
        let long = *array.shape.first()? == info.samples;
        if plan.slab.is_some() || !long || matches!(locator.part, Part::Row(_)) {
            return None;
        }
        let head = self.axis_values(
            array,
            locator,
            0,
            info.samples.min(rate::HEAD_SAMPLES as u64),
        )?;
        let end = self.axis_values(array, locator, info.samples.checked_sub(1)?, 1)?;
        let seconds = info
            .unit
            .as_deref()
            .and_then(parse_unit)
            .map_or(1.0, |u| u.to_si);
        rate::from_axis(&head, end.first().copied(), info.samples).map(|r| r / seconds)
    }

    fn axis_values(
        &self,
        array: &Array,
        locator: &Locator,
        from: u64,
        count: u64,
    ) -> Option<Vec<f64>> {
        let mut shape = array.shape.clone();
        *shape.first_mut()? = count;
        let window = Array {
            shape,
            ..array.clone()
        };
        let raw = self.store.rows(array, from, count).ok()?;
        extract(&raw, &window, locator, false)?.into_real()
    }
}

/// Which of the wanted channels lie in an array: their place in the answer and their locator.
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
fn extract(raw: &[u8], array: &Array, locator: &Locator, slab: bool) -> Option<Samples> {
    let shape: Vec<u64> = array
        .shape
        .iter()
        .copied()
        .skip(usize::from(slab))
        .collect();
    let dims: Vec<usize> = shape
        .iter()
        .filter(|&&d| d != 1)
        .map(|&d| d as usize)
        .collect();
    let (rows, columns) = match dims[..] {
        [rows, columns] => (rows, columns),
        _ => match shape[..] {
            [rows, columns] => (rows as usize, columns as usize),
            _ => (shape.iter().product::<u64>() as usize, 1),
        },
    };
    let size = array.element.bytes();
    let (element, stride) = match (&locator.part, &array.element) {
        (Part::Whole, e) => (
            e,
            Stride {
                first: 0,
                step: size,
                count: rows * columns,
            },
        ),
        (Part::Column(c), e) => (
            e,
            Stride {
                first: *c as usize * size,
                step: columns * size,
                count: rows,
            },
        ),
        (Part::Row(r), e) => (
            e,
            Stride {
                first: *r as usize * columns * size,
                step: size,
                count: columns,
            },
        ),
        (Part::Field(i), Element::Fields { fields, .. }) => {
            let (_, offset, element) = fields.get(*i)?;
            (
                element,
                Stride {
                    first: *offset,
                    step: size,
                    count: rows * columns,
                },
            )
        }
        (Part::Field(_), _) => return None,
    };
    let mut samples = element.decode(raw, stride)?;
    if let Samples::Real(values) = &mut samples
        && (locator.scale != 1.0 || locator.offset != 0.0)
    {
        values
            .iter_mut()
            .for_each(|v| *v = *v * locator.scale + locator.offset);
    }
    Some(samples)
}

impl Source for Hdf5Source {
    fn format(&self) -> &'static str {
        "hdf5"
    }

    fn path(&self) -> &Path {
        &self.path
    }

    fn datasets(&self) -> &[DatasetInfo] {
        &self.plans.datasets
    }

    fn notes(&self) -> &[String] {
        &self.plans.notes
    }

    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        source::requested(self, dataset, channels)?;
        let plan = &self.plans.plans[dataset];
        let mut out: Vec<Option<Samples>> = vec![None; channels.len()];
        for number in 0..plan.arrays.len() {
            if channels.iter().any(|&c| plan.channels[c].array == number) {
                self.read_array(plan, number, channels, &mut out)?;
            }
        }
        // every channel lies in one of the plan's arrays
        Ok(out.into_iter().flatten().collect())
    }
}

#[cfg(test)]
mod tests;
