//! Zlib streams whose unpacked length is known, unpacked in one go.

use libdeflater::{Decompressor, adler32};

/// Bytes of the checksum that ends a zlib stream.
const CHECKSUM: usize = 4;

/// Unpack a zlib stream that fills `out` exactly and ends with `packed`.
///
/// The checksum is compared twice: the library does it where it finds the stream's end, and here
/// with the last bytes of `packed`, so that nothing can follow the stream unseen. No memory is
/// taken beyond some kilobytes of tables.
///
/// Gives whether it is such a stream.
pub(crate) fn zlib_into(packed: &[u8], out: &mut [u8]) -> bool {
    let whole = Decompressor::new().zlib_decompress(packed, out) == Ok(out.len());
    let checksum = packed.last_chunk::<CHECKSUM>();
    whole && checksum.is_some_and(|&last| u32::from_be_bytes(last) == adler32(out))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn pack(bytes: &[u8]) -> Vec<u8> {
        let mut encoder =
            flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn only_a_whole_stream_of_that_length_is_taken() {
        let bytes: Vec<u8> = (0..5000u32).flat_map(|i| (i * i).to_le_bytes()).collect();
        let packed = pack(&bytes);
        let mut out = vec![0; bytes.len()];
        assert!(zlib_into(&packed, &mut out));
        assert_eq!(out, bytes);
        let more = [&packed[..], &[0]].concat();
        assert!(!zlib_into(&more, &mut out));
        assert!(!zlib_into(&packed[..packed.len() - 1], &mut out));
        assert!(!zlib_into(&packed, &mut out[1..]));
        let mut longer = vec![0; bytes.len() + 1];
        assert!(!zlib_into(&packed, &mut longer));
        assert!(!zlib_into(&[], &mut out));
        assert!(zlib_into(&pack(&[]), &mut []));
    }
}
