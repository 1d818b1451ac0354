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
/// # Errors
/// What is wrong, without a place: the library does not tell it.
pub fn zlib_into(packed: &[u8], out: &mut [u8]) -> Result<(), &'static str> {
    let length = Decompressor::new()
        .zlib_decompress(packed, out)
        .map_err(|_| "a damaged stream, or one that unpacks to more than it should")?;
    if length != out.len() {
        return Err("a stream that unpacks to less than it should");
    }
    match packed.last_chunk::<CHECKSUM>() {
        Some(&last) if u32::from_be_bytes(last) == adler32(out) => Ok(()),
        _ => Err("more bytes behind the stream's end"),
    }
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
    fn valid_only_a_whole_stream_of_that_length_is_taken() {
        let bytes: Vec<u8> = (0..5000u32).flat_map(|i| (i * i).to_le_bytes()).collect();
        let packed = pack(&bytes);
        let mut out = vec![0; bytes.len()];
        assert_eq!(zlib_into(&packed, &mut out), Ok(()));
        assert_eq!(out, bytes);
        let more = [&packed[..], &[0]].concat();
        assert!(zlib_into(&more, &mut out).is_err());
        assert!(zlib_into(&packed[..packed.len() - 1], &mut out).is_err());
        assert!(zlib_into(&packed, &mut out[1..]).is_err());
        let mut longer = vec![0; bytes.len() + 1];
        assert!(zlib_into(&packed, &mut longer).is_err());
        assert!(zlib_into(&[], &mut out).is_err());
        assert_eq!(zlib_into(&pack(&[]), &mut []), Ok(()));
    }
}
