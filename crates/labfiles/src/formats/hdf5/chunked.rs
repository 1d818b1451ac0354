//! Chunks packed by shuffling and deflating, unpacked whole and laid in their places.
//!
//! This is the fast way for the packing that nearly all files have. Whatever else a dataset has
//! (other filters, chunks that are not stored, an index that cannot be listed), and every fault,
//! is left to the library, which reports it.

use std::fs::File;
use std::ops::Range;

use ::hdf5::{Chunk, Dataset};

use crate::bytes::{read_exact_at, to_usize};
use crate::formats::hdf5::store::product;
use crate::inflate::zlib_into;

const DEFLATE: u16 = 1;
const SHUFFLE: u16 = 2;

/// How a dataset is laid out in chunks.
struct Grid {
    shape: Vec<u64>,
    chunk: Vec<u64>,
    element: usize,
    shuffled: bool,
}

/// The unpacked bytes of `rows` entries along the first dimension; `None`: the library must read
/// them. `element` is the length of an element, bytes.
pub(crate) fn rows(
    file: &File,
    dataset: &Dataset,
    element: usize,
    rows: Option<Range<u64>>,
) -> Option<Vec<u8>> {
    let grid = Grid::of(dataset, element)?;
    let rows = rows.unwrap_or(0..*grid.shape.first()?);
    if rows.start >= rows.end || rows.end > grid.shape[0] {
        return None;
    }
    let chunks: Vec<Chunk> = dataset.chunks().ok()?;
    let chunks: Vec<&Chunk> = chunks.iter().filter(|c| grid.meets(c, &rows)).collect();
    if !grid.complete(&chunks, &rows) {
        return None;
    }
    let length = grid.row_bytes()?.checked_mul(rows.end - rows.start)?;
    let mut out = vec![0; usize::try_from(length).ok()?];
    let mut unpacked = vec![0; grid.chunk_bytes()?];
    let (mut packed, mut plain) = (Vec::new(), Vec::new());
    for chunk in chunks {
        packed.resize(usize::try_from(chunk.storage_size).ok()?, 0);
        read_exact_at(file, &mut packed, chunk.address).ok()?;
        if !zlib_into(&packed, &mut unpacked) {
            return None;
        }
        let bytes = if grid.shuffled {
            plain.resize(unpacked.len(), 0);
            unshuffle(&unpacked, element, &mut plain);
            &plain
        } else {
            &unpacked
        };
        grid.lay(chunk, bytes, &rows, &mut out);
    }
    Some(out)
}

impl Grid {
    fn of(dataset: &Dataset, element: usize) -> Option<Self> {
        let filters = dataset.filter_pipeline();
        let shuffled = match filters.iter().map(|f| f.id).collect::<Vec<_>>()[..] {
            [DEFLATE] => false,
            [SHUFFLE, DEFLATE] => true,
            _ => return None,
        };
        // Shuffling by another length than the element's is legal and rare.
        if shuffled && filters[0].client_data.first() != Some(&u32::try_from(element).ok()?) {
            return None;
        }
        let (shape, chunk) = (dataset.shape().ok()?, dataset.chunk_shape().ok()??);
        let fits = shape.len() == chunk.len() && !chunk.contains(&0) && element > 0;
        (fits && !shape.is_empty()).then_some(Self {
            shape,
            chunk,
            element,
            shuffled,
        })
    }

    fn chunk_bytes(&self) -> Option<usize> {
        usize::try_from(product(self.element as u64, &self.chunk)?).ok()
    }

    fn row_bytes(&self) -> Option<u64> {
        product(self.element as u64, &self.shape[1..])
    }

    fn meets(&self, chunk: &Chunk, rows: &Range<u64>) -> bool {
        let first = chunk.offset.first().copied().unwrap_or(0);
        first < rows.end && first.saturating_add(self.chunk[0]) > rows.start
    }

    /// Whether every cell of the grid that the rows touch has one plain chunk of its own.
    fn complete(&self, chunks: &[&Chunk], rows: &Range<u64>) -> bool {
        let on_grid = |c: &&Chunk| {
            let mut axes = c.offset.iter().zip(&self.chunk).zip(&self.shape);
            c.filter_mask == 0
                && c.offset.len() == self.shape.len()
                && axes.all(|((at, step), size)| at % step == 0 && at < size)
        };
        let bands = rows.end.div_ceil(self.chunk[0]) - rows.start / self.chunk[0];
        let inner = self.shape[1..].iter().zip(&self.chunk[1..]);
        let cells = inner.fold(bands, |n, (size, step)| {
            n.saturating_mul(size.div_ceil(*step))
        });
        if chunks.len() as u64 != cells || !chunks.iter().all(on_grid) {
            return false;
        }
        let mut places: Vec<&[u64]> = chunks.iter().map(|c| &c.offset[..]).collect();
        places.sort_unstable();
        places.windows(2).all(|pair| pair[0] != pair[1])
    }

    /// Copy the part of an unpacked chunk that is in the rows to its place.
    fn lay(&self, chunk: &Chunk, bytes: &[u8], rows: &Range<u64>, out: &mut [u8]) {
        let mut window = self.shape.clone();
        window[0] = rows.end - rows.start;
        let mut axes: Vec<Axis> = Vec::with_capacity(window.len());
        let (mut from_step, mut to_step) = (self.element, self.element);
        for axis in (0..window.len()).rev() {
            let first = if axis == 0 { rows.start } else { 0 };
            let begin = chunk.offset[axis].max(first);
            let end = (chunk.offset[axis] + self.chunk[axis]).min(first + window[axis]);
            axes.push(Axis {
                count: to_usize(end - begin),
                from: to_usize(begin - chunk.offset[axis]) * from_step,
                to: to_usize(begin - first) * to_step,
                from_step,
                to_step,
            });
            from_step *= to_usize(self.chunk[axis]);
            to_step *= to_usize(window[axis]);
        }
        let from = axes.iter().map(|a| a.from).sum();
        let to = axes.iter().map(|a| a.to).sum();
        copy(&axes, &bytes[from..], &mut out[to..]);
    }
}

/// How a chunk's part runs along one dimension: where it begins and its steps, bytes, in the
/// chunk and in its dataset.
struct Axis {
    count: usize,
    from: usize,
    to: usize,
    from_step: usize,
    to_step: usize,
}

/// Copy a block whose dimensions are given from the fastest on.
fn copy(axes: &[Axis], from: &[u8], to: &mut [u8]) {
    match axes {
        [run] => {
            let length = run.count * run.from_step;
            to[..length].copy_from_slice(&from[..length]);
        }
        [inner @ .., outer] => {
            for i in 0..outer.count {
                copy(
                    inner,
                    &from[i * outer.from_step..],
                    &mut to[i * outer.to_step..],
                );
            }
        }
        [] => {}
    }
}

/// Undo the shuffling of bytes: the first bytes of all elements, then their second ones, and so on.
fn unshuffle(shuffled: &[u8], element: usize, out: &mut [u8]) {
    let count = shuffled.len() / element.max(1);
    let whole = match element {
        8 => eights(shuffled, count, out),
        _ => 0,
    };
    for byte in 0..element {
        let plane = &shuffled[byte * count + whole..(byte + 1) * count];
        let places = out[whole * element..]
            .iter_mut()
            .skip(byte)
            .step_by(element);
        for (place, value) in places.zip(plane) {
            *place = *value;
        }
    }
}

/// Elements of eight bytes, eight at a time; how many were done.
fn eights(shuffled: &[u8], count: usize, out: &mut [u8]) -> usize {
    let planes: [&[[u8; 8]]; 8] =
        std::array::from_fn(|byte| shuffled[byte * count..(byte + 1) * count].as_chunks().0);
    let (blocks, _) = out[..8 * count].as_chunks_mut::<64>();
    for (i, block) in blocks.iter_mut().enumerate() {
        let columns = transposed(std::array::from_fn(|b| u64::from_le_bytes(planes[b][i])));
        for (place, column) in block.as_chunks_mut::<8>().0.iter_mut().zip(columns) {
            *place = column.to_le_bytes();
        }
    }
    blocks.len() * 8
}

/// Eight rows of eight bytes to their columns, by exchanging ever smaller blocks.
#[inline]
fn transposed(mut rows: [u64; 8]) -> [u64; 8] {
    for (step, mask) in [
        (4, 0x0000_0000_ffff_ffff_u64),
        (2, 0x0000_ffff_0000_ffff),
        (1, 0x00ff_00ff_00ff_00ff),
    ] {
        for i in (0..8).filter(|i| i & step == 0) {
            let moved = ((rows[i] >> (8 * step)) ^ rows[i + step]) & mask;
            rows[i] ^= moved << (8 * step);
            rows[i + step] ^= moved;
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::hdf5::FileBuilder;
    use proptest::prelude::*;
    use std::io::Write;

    /// A file with one packed dataset `d` of counted numbers.
    fn packed(shape: &[u64], chunk: &[u64], shuffled: bool) -> tempfile::NamedTempFile {
        let count = shape.iter().product::<u64>() as i32;
        let mut builder = FileBuilder::new();
        let dataset = builder.create_dataset("d");
        let values: Vec<f64> = (0..count).map(|i| f64::from(i).sqrt()).collect();
        dataset.with_f64_data(&values).with_shape(shape);
        dataset.with_chunks(chunk).with_deflate(4);
        if shuffled {
            dataset.with_shuffle();
        }
        let mut file = tempfile::NamedTempFile::new().unwrap();
        file.write_all(&builder.finish().unwrap()).unwrap();
        file
    }

    #[test]
    fn chunks_land_where_the_library_puts_them() {
        for (shape, chunk) in [
            (vec![37], vec![8]),
            (vec![5], vec![50]),
            (vec![10, 7], vec![4, 3]),
            (vec![9, 4], vec![9, 4]),
            (vec![3, 5, 7], vec![2, 2, 4]),
        ] {
            for shuffled in [false, true] {
                let temporary = packed(&shape, &chunk, shuffled);
                let dataset = ::hdf5::File::open(temporary.path()).unwrap();
                let dataset = dataset.dataset("d").unwrap();
                let all = rows(temporary.as_file(), &dataset, 8, None);
                assert_eq!(all, Some(dataset.read_raw().unwrap()), "{shape:?}");
                for start in 0..shape[0] {
                    let count = (shape[0] - start).min(3);
                    let some = start..start + count;
                    let some = rows(temporary.as_file(), &dataset, 8, Some(some));
                    let expected = dataset.read_raw_rows(start, count).unwrap();
                    assert_eq!(some, Some(expected), "{shape:?} from {start}");
                }
                let after = Some(shape[0]..shape[0] + 1);
                assert_eq!(rows(temporary.as_file(), &dataset, 8, after), None);
            }
        }
    }

    proptest! {
        #[test]
        fn prop_unshuffled_bytes_are_the_shuffled_ones_again(element in 1usize..17, count in 0usize..70, seed: u8) {
            let plain: Vec<u8> = (0..element * count).map(|i| (i * 31) as u8 ^ seed).collect();
            let shuffled: Vec<u8> = (0..element * count).map(|i| plain[i % count * element + i / count]).collect();
            let mut out = vec![0; plain.len()];
            unshuffle(&shuffled, element, &mut out);
            prop_assert_eq!(out, plain);
        }
    }
}
