//! Samples of arrays: decoded from the mapped file, or from a variable inflated once.

use std::sync::{Arc, Mutex, PoisonError};

use super::arrange::{self, Origin, Slice};
use super::inflate;
use super::text;
use super::tree::{Content, Leaf, Part, Tree};
use crate::bytes::{FileBytes, to_usize};
use crate::numbers::{self, ByteOrder};
use crate::source::{DatasetInfo, ReadError, Reader, Samples};

/// An inflated variable is kept for the next request up to this multiple of the file's size.
const KEPT_MULTIPLE: u64 = 8;
/// And up to this size in any case, bytes.
const KEPT_SIZE: u64 = 64 << 20;

/// The variable that was inflated last.
type Kept = Option<(usize, Arc<Vec<u8>>)>;

/// The open file, its arrays, the origin of each channel and the variable inflated last.
pub(super) struct MatFile {
    file: FileBytes,
    tree: Tree,
    origins: Vec<Vec<Origin>>,
    leaves_of: Vec<usize>,
    kept: Mutex<Kept>,
}

impl Reader for MatFile {
    /// The samples of some channels, in the order asked for; each variable is inflated once.
    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        self.file.still_whole()?;
        let origins = &self.origins[dataset];
        let leaf_of = |slot: usize| &self.tree.leaves[origins[channels[slot]].leaf];
        let mut all: Vec<Option<Samples>> = vec![None; channels.len()];
        let mut order: Vec<usize> = (0..channels.len()).collect();
        order.sort_by_key(|&slot| leaf_of(slot).variable);
        for slots in order.chunk_by(|&a, &b| leaf_of(a).variable == leaf_of(b).variable) {
            let inflated = self.inflated(leaf_of(slots[0]).variable, slots.len())?;
            let bytes = inflated.as_ref().map_or(self.file.all(), |all| all);
            for &slot in slots {
                let samples = self.samples(leaf_of(slot), origins[channels[slot]].slice, bytes);
                all[slot] = Some(samples.map_err(|e| e.channel(&leaf_of(slot).name))?);
            }
        }
        Ok(all.into_iter().flatten().collect())
    }
}

impl MatFile {
    /// Take over an open file and what was found in it.
    pub(super) fn new(file: FileBytes, tree: Tree, origins: Vec<Vec<Origin>>) -> Self {
        let mut leaves_of = vec![0; tree.variables.len()];
        for leaf in &tree.leaves {
            leaves_of[leaf.variable] += 1;
        }
        Self {
            file,
            tree,
            origins,
            leaves_of,
            kept: Mutex::new(None),
        }
    }

    /// Take unnamed columns that climb evenly for times; gives what was assumed.
    pub(super) fn take_unnamed_times(&self, datasets: &mut [DatasetInfo]) -> Vec<String> {
        let values = |dataset: usize, channel: usize| {
            let mut read = self.read(dataset, &[channel]).ok()?;
            read.pop()?.into_real()
        };
        arrange::take_unnamed_times(&self.tree, &self.origins, datasets, values)
    }

    /// A variable's inflated bytes; `None` if it is not compressed.
    fn inflated(&self, variable: usize, parts: usize) -> Result<Option<Arc<Vec<u8>>>, ReadError> {
        let Some(place) = self.tree.variables[variable].packed else {
            return Ok(None);
        };
        let all_at_once = self.leaves_of[variable] == 1 && parts > 1;
        let most = self.file.size().saturating_mul(KEPT_MULTIPLE);
        if all_at_once || place.inflated > most.max(KEPT_SIZE) {
            return Ok(Some(Arc::new(inflate::inflate(&self.file, place)?)));
        }
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, bytes)) = kept.as_ref().filter(|(index, _)| *index == variable) {
            return Ok(Some(Arc::clone(bytes)));
        }
        *kept = None;
        let bytes = Arc::new(inflate::inflate(&self.file, place)?);
        *kept = Some((variable, Arc::clone(&bytes)));
        Ok(Some(bytes))
    }

    fn samples(&self, leaf: &Leaf, slice: Slice, bytes: &[u8]) -> Result<Samples, ReadError> {
        let order = self.tree.variables[leaf.variable].order;
        let numbers = |part: Part| Ok(take(leaf, slice, self.part(part, bytes)?, part, order));
        Ok(match leaf.content {
            Content::Real(part) => Samples::Real(numbers(part)?),
            Content::Complex(real, imaginary, _) => {
                Samples::Complex(numbers::pair(numbers(real)?, numbers(imaginary)?))
            }
            Content::Text(part, _) => {
                Samples::Text(text::rows(leaf, self.part(part, bytes)?, order))
            }
        })
    }

    fn part<'b>(&self, part: Part, bytes: &'b [u8]) -> Result<&'b [u8], ReadError> {
        let found = bytes.get(to_usize(part.at)..to_usize(part.at.saturating_add(part.bytes)));
        found.ok_or_else(|| {
            let expected = format!("{} bytes of array", part.bytes);
            self.file.refuse(part.at, expected, "fewer")
        })
    }
}

/// Decode a slice of a column-major array.
fn take(leaf: &Leaf, slice: Slice, bytes: &[u8], part: Part, order: ByteOrder) -> Vec<f64> {
    let spacing = slice.spacing(leaf, to_usize(part.number.bytes()));
    let mut out = Vec::with_capacity(spacing.count);
    numbers::decode_spaced(part.number, order, bytes, spacing, &mut out);
    out
}
