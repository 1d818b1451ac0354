//! Compressed variables: a zlib stream read forward, never trusted beyond what it can hold.

use std::io::{BufReader, Read};

use flate2::bufread::ZlibDecoder;

use super::tree::Packed;
use crate::bytes::{FileBytes, to_usize};
use crate::inflate::zlib_into;
use crate::source::ReadError;

/// Deflate cannot expand a byte into more than this many.
const MOST_EXPANSION: u64 = 1032;
/// Expansion beyond which a stream of more than [`LARGE`] bytes is taken for an attack.
const SUSPICIOUS_EXPANSION: u64 = 100;
/// Inflated size up to which any expansion is accepted, bytes.
const LARGE: u64 = 64 << 20;

/// A zlib stream of the file, read forward.
pub(super) struct Stream<'a> {
    file: &'a FileBytes,
    pub(super) at: u64,
    packed: u64,
    decoder: BufReader<ZlibDecoder<&'a [u8]>>,
    position: u64,
}

impl<'a> Stream<'a> {
    /// Start at the stream's first byte.
    pub(super) fn open(file: &'a FileBytes, at: u64, packed: u64) -> Result<Self, ReadError> {
        let bytes = file.slice(at, packed, "a compressed variable")?;
        let decoder = BufReader::with_capacity(4096, ZlibDecoder::new(bytes));
        Ok(Self {
            file,
            at,
            packed,
            decoder,
            position: 0,
        })
    }

    /// Check the size that the stream's first element claims against what it can hold.
    pub(super) fn check_claim(&self, inflated: u64) -> Result<(), ReadError> {
        if inflated
            > self
                .packed
                .saturating_mul(MOST_EXPANSION)
                .saturating_add(64)
        {
            let found = format!("{} compressed bytes, which cannot hold them", self.packed);
            return Err(self
                .file
                .refuse(self.at, format!("{inflated} bytes of variable"), found));
        }
        if inflated > LARGE && inflated > self.packed.saturating_mul(SUSPICIOUS_EXPANSION) {
            return Err(self.file.unsupported(
                self.at,
                format!(
                    "{} compressed bytes that claim to hold {inflated}",
                    self.packed
                ),
                format!("an expansion below {SUSPICIOUS_EXPANSION}"),
                "save the file uncompressed (save -v6) if it really is so uniform",
            ));
        }
        Ok(())
    }

    /// Fill `buffer` with the bytes at `position`, which must not be before the present one.
    pub(super) fn read_at(
        &mut self,
        position: u64,
        buffer: &mut [u8],
        what: &str,
    ) -> Result<(), ReadError> {
        self.skip_to(position, what)?;
        let result = self.decoder.read_exact(buffer);
        result.map_err(|error| self.fault(what, error))?;
        self.position += buffer.len() as u64;
        Ok(())
    }

    fn skip_to(&mut self, position: u64, what: &str) -> Result<(), ReadError> {
        let gap = position.saturating_sub(self.position);
        let skipped = std::io::copy(&mut self.decoder.by_ref().take(gap), &mut std::io::sink());
        match skipped {
            Ok(n) if n == gap => self.position += gap,
            Ok(_) => return Err(self.fault(what, "the stream ends before")),
            Err(error) => return Err(self.fault(what, error)),
        }
        Ok(())
    }

    fn fault(&self, what: &str, error: impl std::fmt::Display) -> ReadError {
        let expected = format!("{what} at byte {} of an inflated variable", self.position);
        self.file.refuse(
            self.at,
            expected,
            format!("a compressed stream that fails ({error})"),
        )
    }

    fn finish(mut self) -> Result<(), ReadError> {
        match self.decoder.read(&mut [0]) {
            Ok(0) => {}
            Ok(_) => return Err(self.fault("the end", "more data than its header states")),
            Err(error) => return Err(self.fault("the end", error)),
        }
        let used = self.decoder.get_ref().total_in();
        if used == self.packed {
            Ok(())
        } else {
            Err(self.fault("the end", format!("{} bytes too many", self.packed - used)))
        }
    }
}

/// Inflate a whole variable and check its length and checksum.
pub(super) fn inflate(file: &FileBytes, place: Packed) -> Result<Vec<u8>, ReadError> {
    let Packed {
        at,
        packed,
        inflated,
    } = place;
    let mut stream = Stream::open(file, at, packed)?;
    stream.check_claim(inflated)?;
    let mut bytes = vec![0; to_usize(inflated)];
    if zlib_into(file.slice(at, packed, "a compressed variable")?, &mut bytes) {
        return Ok(bytes);
    }
    // Reading forward gives the place of the fault.
    stream.read_at(0, &mut bytes, "the variable")?;
    stream.finish()?;
    Ok(bytes)
}
