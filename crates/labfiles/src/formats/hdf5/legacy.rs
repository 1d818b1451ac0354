//! Files of HDF5 before 1.6.3, whose data layout messages (version 1 and 2) neither library
//! reads: the messages are shown to the library rewritten as version 3.
//!
//! Both versions mean the same (HDF5 file format specification, "Data Layout Message"); the newer
//! is shorter, so that it fits in the older one's place. The file itself is not touched.

use std::fs::File;

use crate::bytes::{read_exact_at, to_usize};

/// Bytes that replace those of the file at an offset.
pub(crate) type Patch = (u64, Vec<u8>);

/// Bytes of a header message before its body: type, size, flags, three zeros.
const PREFIX: usize = 8;
/// Bytes read at a time.
const BLOCK: usize = 1 << 20;
/// No header message is longer.
const OVERLAP: usize = 1 << 16;
/// The type number of a data layout message, and its bytes in a header.
const DATA_LAYOUT: [u8; 2] = [8, 0];

/// Rewrite all data layout messages of version 1 and 2 in a file.
///
/// # Errors
/// If the file cannot be read.
pub(crate) fn patches(file: &File, length: u64) -> std::io::Result<Vec<Patch>> {
    let mut found = Vec::new();
    let mut start = 0;
    while start < length {
        let count = to_usize((length - start).min((BLOCK + OVERLAP) as u64));
        let mut block = vec![0; count];
        read_exact_at(file, &mut block, start)?;
        for at in (0..count.min(BLOCK)).step_by(8) {
            if let Some(body) = rewritten(&block[at..]) {
                found.push((start + (at + PREFIX) as u64, body));
            }
        }
        start += BLOCK as u64;
    }
    Ok(found)
}

/// The body of version 3 for a message of version 1 or 2 that begins here.
fn rewritten(bytes: &[u8]) -> Option<Vec<u8>> {
    let prefix = bytes.get(..PREFIX)?;
    let size = usize::from(u16::from_le_bytes([prefix[2], prefix[3]]));
    let body = bytes.get(PREFIX..PREFIX + size)?;
    if prefix[..2] != DATA_LAYOUT || prefix[5..8] != [0; 3] || size < 20 {
        return None;
    }
    let (version, rank, class) = (body[0], body[1], body[2]);
    if !matches!(version, 1 | 2) || !(1..=33).contains(&rank) || body[3..8] != [0; 5] {
        return None;
    }
    let sizes_bytes = 4 * usize::from(rank);
    let sizes = |at: usize| body.get(at..at + sizes_bytes);
    let mut new = vec![3, class];
    match class {
        0 => {
            let sizes_end = 8 + sizes_bytes;
            let count = u32::from_le_bytes(body.get(sizes_end..sizes_end + 4)?.try_into().ok()?);
            new.extend(u16::try_from(count).ok()?.to_le_bytes());
            new.extend(body.get(sizes_end + 4..sizes_end + 4 + count as usize)?);
        }
        1 => {
            let mut words = sizes(16)?
                .chunks_exact(4)
                .map(|w| u64::from(u32::from_le_bytes([w[0], w[1], w[2], w[3]])));
            let count = words.try_fold(1u64, u64::checked_mul)?;
            new.extend(&body[8..16]);
            new.extend(count.to_le_bytes());
        }
        2 => {
            new.push(rank);
            new.extend(&body[8..16]);
            new.extend(sizes(16)?);
        }
        _ => return None,
    }
    (new.len() <= size).then_some(new)
}

/// Lay patches over bytes that were read at an offset.
pub(crate) fn apply(patches: &[Patch], offset: u64, bytes: &mut [u8]) {
    let end = offset + bytes.len() as u64;
    for (at, new) in patches {
        let (from, to) = ((*at).max(offset), (at + new.len() as u64).min(end));
        if from < to {
            let own = &new[to_usize(from - at)..to_usize(to - at)];
            bytes[to_usize(from - offset)..to_usize(to - offset)].copy_from_slice(own);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contiguous_message_becomes_version_3() {
        let mut message = vec![8, 0, 32, 0, 1, 0, 0, 0, 2, 3, 1, 0, 0, 0, 0, 0];
        message.extend(0x0e00u64.to_le_bytes());
        for size in [9u32, 1, 8] {
            message.extend(size.to_le_bytes());
        }
        message.extend([0; 4]);
        let body = rewritten(&message).unwrap();
        let mut expected = vec![3, 1];
        expected.extend(0x0e00u64.to_le_bytes());
        expected.extend(72u64.to_le_bytes());
        assert_eq!(body, expected);
        message[8] = 3;
        assert_eq!(rewritten(&message), None);
    }

    #[test]
    fn patches_overlap_reads_in_part() {
        let mut bytes = [0u8; 4];
        apply(&[(8, vec![1, 2, 3, 4])], 10, &mut bytes);
        assert_eq!(bytes, [3, 4, 0, 0]);
        apply(&[(8, vec![1, 2, 3, 4])], 5, &mut bytes);
        assert_eq!(bytes, [3, 4, 0, 1]);
    }
}
