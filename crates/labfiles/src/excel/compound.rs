//! The structure of a compound file (`.xls`), checked before the library follows it: chains of sectors that
//! end, and lengths that the file can hold.

use std::path::Path;

use crate::bytes::to_usize;
use crate::source::ReadError;

/// Numbers from here on are no sectors: free, end of a chain, tables.
const NO_SECTOR: u32 = 0xFFFF_FFFA;
/// Bytes of a directory's entry.
const ENTRY: usize = 128;

fn number(bytes: &[u8], at: usize) -> Option<u32> {
    let field = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(field.try_into().ok()?))
}

/// Refuse a file whose sectors form a loop or whose lengths exceed it.
///
/// # Errors
/// With what is wrong.
pub(super) fn check(path: &Path, bytes: &[u8]) -> Result<(), ReadError> {
    match fault(bytes) {
        None => Ok(()),
        Some(found) => Err(super::damaged(path, found)),
    }
}

fn fault(bytes: &[u8]) -> Option<&'static str> {
    let size = match bytes.get(30..32) {
        Some([9, 0]) => 512,
        Some([12, 0]) => 4096,
        _ => return Some("sectors of an unknown size"),
    };
    let sectors = bytes.len() / size;
    let within = |at: usize| number(bytes, at).is_some_and(|n| to_usize(n.into()) <= sectors);
    if ![44, 64, 72].into_iter().all(within) {
        return Some("more tables than the file has sectors");
    }
    let sector = |n: u32| -> Option<&[u8]> {
        let from = to_usize(u64::from(n) + 1).checked_mul(size)?;
        bytes.get(from..bytes.len().min(from.checked_add(size)?))
    };
    let tables = (0..109).filter_map(|i| number(bytes, 76 + 4 * i));
    let tables = tables.take_while(|n| *n < NO_SECTOR).filter_map(sector);
    let next: Vec<u32> = tables.flat_map(numbers).take(sectors).collect();
    if loops(&next) {
        return Some("a chain of sectors that never ends");
    }
    let small = chain(&next, number(bytes, 60)?).filter_map(sector);
    if loops(&small.flat_map(numbers).collect::<Vec<u32>>()) {
        return Some("a chain of small sectors that never ends");
    }
    let directory = chain(&next, number(bytes, 48)?).filter_map(sector);
    let mut entries = directory.flat_map(|s| s.chunks_exact(ENTRY));
    let too_long = |e: &[u8]| number(e, 120).is_none_or(|n| to_usize(n.into()) > bytes.len());
    entries
        .any(|e| e[66] != 0 && too_long(e))
        .then_some("a stream longer than the file")
}

fn numbers(sector: &[u8]) -> impl Iterator<Item = u32> + '_ {
    (0..sector.len() / 4).filter_map(|i| number(sector, 4 * i))
}

/// The sectors of a chain in a table without loops.
fn chain(next: &[u32], start: u32) -> impl Iterator<Item = u32> + '_ {
    let follow = |n: &u32| next.get(to_usize((*n).into())).copied();
    let first = (start < NO_SECTOR).then_some(start);
    std::iter::successors(first, move |n| follow(n).filter(|n| *n < NO_SECTOR))
}

/// Whether following a table leads into a loop from anywhere.
fn loops(next: &[u32]) -> bool {
    let mut visited = vec![0_usize; next.len()];
    for start in 0..next.len() {
        let mut at = start;
        while at < next.len() && visited[at] == 0 {
            visited[at] = start + 1;
            at = to_usize(next[at].into());
        }
        if at < next.len() && visited[at] == start + 1 {
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::own;

    #[test]
    fn loops_and_lengths_beyond_the_file_are_refused() {
        assert!(loops(&[1, 2, 0]) && loops(&[0]));
        assert!(!loops(&[1, 2, NO_SECTOR + 4, 9]));
        let bytes = std::fs::read(own("one_run.xls")).unwrap();
        assert_eq!(fault(&bytes), None);
        let mut damaged = bytes.clone();
        damaged[44..48].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(fault(&damaged).is_some());
    }
}
