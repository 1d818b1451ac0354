//! The structure of a compound file (`.xls`), checked before the library follows it: chains of sectors that
//! end, and lengths that the file can hold.

use std::path::Path;

use crate::bytes::to_usize;
use crate::formats::excel::cells::damaged;
use crate::source::ReadError;

/// Numbers from here on are no sectors: free, end of a chain, tables.
const NO_SECTOR: u32 = 0xFFFF_FFFA;
/// Bytes of a directory's entry.
const ENTRY: usize = 128;
/// Streams below this number of bytes are kept in small sectors.
const SMALL: usize = 4096;

/// The unsigned number of four bytes at a place.
pub(super) fn number(bytes: &[u8], at: usize) -> Option<u32> {
    let field = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(field.try_into().ok()?))
}

/// A compound file whose chains of sectors end and whose streams fit into it.
pub(super) struct Compound<'a> {
    bytes: &'a [u8],
    /// Bytes of a sector.
    size: usize,
    /// The sector after each.
    next: Vec<u32>,
    /// The small sector after each.
    next_small: Vec<u32>,
}

impl<'a> Compound<'a> {
    /// The structure of a file.
    ///
    /// # Errors
    /// If its sectors form a loop, or its lengths exceed it.
    pub(super) fn new(path: &Path, bytes: &'a [u8]) -> Result<Self, ReadError> {
        Self::checked(bytes).map_err(|found| damaged(path, found))
    }

    fn checked(bytes: &'a [u8]) -> Result<Self, &'static str> {
        let size = match bytes.get(30..32) {
            Some([9, 0]) => 512,
            Some([12, 0]) => 4096,
            _ => return Err("sectors of an unknown size"),
        };
        let sectors = bytes.len() / size;
        let within = |at: usize| number(bytes, at).is_some_and(|n| to_usize(n.into()) <= sectors);
        if ![44, 64, 72].into_iter().all(within) {
            return Err("more tables than the file has sectors");
        }
        let mut found = Self {
            bytes,
            size,
            next: Vec::new(),
            next_small: Vec::new(),
        };
        let tables = (0..109).filter_map(|i| number(bytes, 76 + 4 * i));
        let tables = tables.take_while(|n| *n < NO_SECTOR);
        let next = tables.filter_map(|n| found.sector(n)).flat_map(numbers);
        found.next = next.take(sectors).collect();
        if loops(&found.next) {
            return Err("a chain of sectors that never ends");
        }
        found.next_small = found.sectors(60).flat_map(numbers).collect();
        if loops(&found.next_small) {
            return Err("a chain of small sectors that never ends");
        }
        let too_long = |e: &[u8]| number(e, 120).is_none_or(|n| to_usize(n.into()) > bytes.len());
        if found.entries().any(|e| e[66] != 0 && too_long(e)) {
            return Err("a stream longer than the file");
        }
        Ok(found)
    }

    fn sector(&self, n: u32) -> Option<&'a [u8]> {
        let from = to_usize(u64::from(n) + 1).checked_mul(self.size)?;
        let end = self.bytes.len().min(from.checked_add(self.size)?);
        self.bytes.get(from..end)
    }

    /// The sectors of the chain whose first one the header gives at a place.
    fn sectors(&self, header: usize) -> impl Iterator<Item = &'a [u8]> + '_ {
        let start = number(self.bytes, header).unwrap_or(NO_SECTOR);
        chain(&self.next, start).filter_map(|n| self.sector(n))
    }

    /// The entries of the directory.
    fn entries(&self) -> impl Iterator<Item = &'a [u8]> + '_ {
        self.sectors(48).flat_map(|s| s.chunks_exact(ENTRY))
    }

    /// A stream by the first of some names that the directory has.
    pub(super) fn stream(&self, names: &[&str]) -> Option<Vec<u8>> {
        let of = |name: &&str| {
            self.entries()
                .find(|e| self::name(e).eq_ignore_ascii_case(name))
        };
        let entry = names.iter().find_map(of)?;
        let (start, length) = (number(entry, 116)?, to_usize(number(entry, 120)?.into()));
        let mut stream = if length < SMALL {
            let root = number(self.entries().next()?, 116)?;
            let small: Vec<u8> = self.chained(root);
            let sectors: Vec<&[u8]> = small.chunks(64).collect();
            let places = chain(&self.next_small, start).map(|n| to_usize(n.into()));
            places
                .filter_map(|n| sectors.get(n))
                .copied()
                .flatten()
                .copied()
                .collect()
        } else {
            self.chained(start)
        };
        stream.truncate(length);
        Some(stream)
    }

    fn chained(&self, start: u32) -> Vec<u8> {
        let sectors = chain(&self.next, start).filter_map(|n| self.sector(n));
        sectors.flatten().copied().collect()
    }
}

/// The name of an entry.
fn name(entry: &[u8]) -> String {
    let units = entry[..64].chunks_exact(2);
    let units = units.map(|pair| u16::from_le_bytes([pair[0], pair[1]]));
    let units: Vec<u16> = units.take_while(|u| *u != 0).collect();
    String::from_utf16_lossy(&units)
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
        let stream = Compound::checked(&bytes).unwrap().stream(&["Workbook"]);
        // A workbook begins with a BOF record.
        assert_eq!(stream.unwrap()[..2], [0x09, 0x08]);
        let mut damaged = bytes.clone();
        damaged[44..48].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(Compound::checked(&damaged).is_err());
    }
}
