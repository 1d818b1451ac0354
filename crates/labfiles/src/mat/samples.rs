//! Samples of arrays: decoded from the mapped file, or from a variable inflated once.

use std::sync::{Arc, Mutex, PoisonError};

use super::arrange::{Origin, Slice};
use super::inflate;
use super::text;
use super::tree::{Content, Leaf, Part, Place, Tree};
use crate::bytes::{FileBytes, to_usize};
use crate::numbers::{self, ByteOrder};
use crate::source::{ReadError, Samples};

/// An inflated variable is kept for the next request up to this multiple of the file's size.
const KEPT_MULTIPLE: u64 = 8;
/// And up to this size in any case, bytes.
const KEPT_SIZE: u64 = 64 << 20;

/// The variable that was inflated last.
type Kept = Option<(usize, Arc<Vec<u8>>)>;

/// The open file, its arrays and the variable inflated last.
pub(super) struct Store {
    file: FileBytes,
    tree: Tree,
    leaves_of: Vec<usize>,
    kept: Mutex<Kept>,
}

impl Store {
    /// Take over an open file and what was found in it.
    pub(super) fn new(file: FileBytes, tree: Tree) -> Self {
        let mut leaves_of = vec![0; tree.variables.len()];
        for leaf in &tree.leaves {
            leaves_of[leaf.variable] += 1;
        }
        Self {
            file,
            tree,
            leaves_of,
            kept: Mutex::new(None),
        }
    }

    /// The samples of some channels, in the order asked for; each variable is inflated once.
    pub(super) fn read(&self, wanted: &[Origin]) -> Result<Vec<Samples>, ReadError> {
        self.file.still_whole()?;
        let variable_of = |slot: usize| self.tree.leaves[wanted[slot].leaf].variable;
        let mut all: Vec<Option<Samples>> = vec![None; wanted.len()];
        let mut order: Vec<usize> = (0..wanted.len()).collect();
        order.sort_by_key(|&slot| variable_of(slot));
        for slots in order.chunk_by(|&a, &b| variable_of(a) == variable_of(b)) {
            let bytes = self.bytes(variable_of(slots[0]), slots.len())?;
            for &slot in slots {
                let leaf = &self.tree.leaves[wanted[slot].leaf];
                let samples = self.samples(leaf, wanted[slot].slice, &bytes);
                let named = |e| ReadError {
                    channel: Some(leaf.name.clone()),
                    ..e
                };
                all[slot] = Some(samples.map_err(named)?);
            }
        }
        Ok(all.into_iter().flatten().collect())
    }

    /// The bytes to which the offsets of a variable refer.
    fn bytes(&self, variable: usize, parts: usize) -> Result<Bytes<'_>, ReadError> {
        let place = self.tree.variables[variable].place;
        let Place::Packed { inflated, .. } = place else {
            return Ok(Bytes::File(self.file.all()));
        };
        let all_at_once = self.leaves_of[variable] == 1 && parts > 1;
        let keep = inflated
            <= self
                .file
                .size()
                .saturating_mul(KEPT_MULTIPLE)
                .max(KEPT_SIZE);
        if all_at_once || !keep {
            return Ok(Bytes::Inflated(Arc::new(inflate::inflate(
                &self.file, place,
            )?)));
        }
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((index, bytes)) = kept.as_ref()
            && *index == variable
        {
            return Ok(Bytes::Inflated(Arc::clone(bytes)));
        }
        *kept = None;
        let bytes = Arc::new(inflate::inflate(&self.file, place)?);
        *kept = Some((variable, Arc::clone(&bytes)));
        Ok(Bytes::Inflated(bytes))
    }

    fn samples(&self, leaf: &Leaf, slice: Slice, bytes: &Bytes<'_>) -> Result<Samples, ReadError> {
        let order = self.tree.variables[leaf.variable].order;
        match leaf.content {
            Content::Real(part) => Ok(Samples::Real(take(
                leaf,
                slice,
                self.part(part, bytes)?,
                part,
                order,
            ))),
            Content::Complex(real, imaginary, _) => {
                let re = take(leaf, slice, self.part(real, bytes)?, real, order);
                let im = take(leaf, slice, self.part(imaginary, bytes)?, imaginary, order);
                Ok(Samples::Complex(numbers::pair(re, im)))
            }
            Content::Text(part, _) => Ok(Samples::Text(text::rows(
                leaf,
                self.part(part, bytes)?,
                order,
            ))),
        }
    }

    fn part<'b>(&self, part: Part, bytes: &'b Bytes<'_>) -> Result<&'b [u8], ReadError> {
        let all = bytes.all();
        let end = part.at.saturating_add(part.bytes).min(all.len() as u64);
        match all.get(to_usize(part.at)..to_usize(end)) {
            Some(found) if found.len() as u64 == part.bytes => Ok(found),
            _ => Err(self
                .file
                .refuse(part.at, format!("{} bytes of array", part.bytes), "fewer")),
        }
    }
}

enum Bytes<'a> {
    File(&'a [u8]),
    Inflated(Arc<Vec<u8>>),
}

impl Bytes<'_> {
    fn all(&self) -> &[u8] {
        match self {
            Self::File(bytes) => bytes,
            Self::Inflated(bytes) => bytes,
        }
    }
}

/// Decode a slice of a column-major array.
fn take(leaf: &Leaf, slice: Slice, bytes: &[u8], part: Part, order: ByteOrder) -> Vec<f64> {
    let spacing = slice.spacing(leaf, to_usize(part.number.bytes()));
    let mut out = Vec::with_capacity(spacing.count);
    numbers::decode_spaced(part.number, order, bytes, spacing, &mut out);
    out
}
