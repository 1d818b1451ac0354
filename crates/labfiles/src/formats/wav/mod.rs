//! WAV files: PCM of 1 to 64 bits, floating point, extensible, RF64, RIFX.
//!
//! How a file maps to datasets and channels: the file is one dataset without a name, its channels
//! are `channel 1`, `channel 2`, …
//!
//! WAV has no units: PCM numbers are given as the file holds them, left-justified in the next
//! native integer, as the format has them within a sample's own bytes: 9 to 16 bits as 16-bit,
//! up to 32 as 32-bit, up to 64 as 64-bit numbers, so that full scale is the same for every width
//! of a class (property `full_scale`); up to 8 bits as unsigned 8-bit numbers around 128
//! (property `zero_level`). Texts (LIST INFO) are attributes; a broadcast chunk gives the start.
//! A file that was cut short within its samples is read as far as it goes, with a note.

mod chunks;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::path::Path;

use chunks::{Format, Wave};

use crate::bytes::FileBytes;
use crate::bytes::to_usize;
use crate::numbers::{self, ByteOrder, Number, Spacing};
use crate::source::{ChannelInfo, Clock, DatasetInfo, ReadError, Reader, Samples, Source, opened};

/// Whether a file's first bytes are those of a WAV file.
pub(crate) fn recognises(head: &[u8]) -> bool {
    chunks::byte_order(head).is_some()
}

/// Open a WAV file: its chunks are found, no samples are read.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let file = FileBytes::open(path)?;
    let wave = chunks::scan(&file)?;
    let channels = (1..=wave.format.channels)
        .map(|k| channel(&wave, k))
        .collect();
    let attributes = wave.attributes.clone();
    let dataset = DatasetInfo {
        name: String::new(),
        channels,
        time_axis: None,
        attributes,
    };
    opened(
        "wav",
        path,
        vec![dataset],
        wave.notes.clone(),
        WaveFile { file, wave },
    )
}

fn channel(wave: &Wave, k: u16) -> ChannelInfo {
    let format = &wave.format;
    let number = native(format);
    let full_scale = if format.float {
        1.0
    } else {
        2f64.powi(i32::from(number.bits()) - 1)
    };
    let mut properties = BTreeMap::from([
        ("bits_per_sample".to_owned(), format.bits.to_string()),
        ("full_scale".to_owned(), full_scale.to_string()),
    ]);
    if number == Number::U8 {
        properties.insert("zero_level".to_owned(), "128".to_owned());
    }
    ChannelInfo {
        name: format!("channel {k}"),
        unit: None,
        stored: number.stored(),
        samples: wave.samples,
        sample_rate_hz: Some(f64::from(format.rate)),
        start_time: wave.start_time.clone(),
        clock: Clock::Shared,
        start_s: None,
        properties,
    }
}

/// The type of the samples: the next wider one of integers of odd widths, left-justified.
fn native(format: &Format) -> Number {
    match (format.float, format.bytes) {
        (true, 4) => Number::F32,
        (true, _) => Number::F64,
        (false, 1) => Number::U8,
        (false, 2) => Number::I16,
        (false, 3 | 4) => Number::I32,
        (false, _) => Number::I64,
    }
}

struct WaveFile {
    file: FileBytes,
    wave: Wave,
}

impl WaveFile {
    fn channel(&self, channel: usize) -> Result<Samples, ReadError> {
        let Wave {
            format,
            at,
            samples,
            order,
            ..
        } = &self.wave;
        let bytes = usize::from(format.bytes);
        let stride = bytes * usize::from(format.channels);
        let data = self.file.slice(*at, samples * stride as u64, "samples")?;
        let count = to_usize(*samples);
        let spacing = Spacing {
            offset: channel * bytes,
            stride,
            count,
        };
        let number = native(format);
        if to_usize(number.bytes()) != bytes {
            let odd = odd(data, spacing, bytes, number.bits(), *order);
            return Ok(Samples::Real(odd));
        }
        let mut out = Vec::with_capacity(count);
        numbers::decode_spaced(number, *order, data, spacing, &mut out);
        Ok(Samples::Real(out))
    }
}

/// Integers of 3, 5, 6 or 7 bytes, left-justified in 32 or 64 bits.
fn odd(data: &[u8], spacing: Spacing, bytes: usize, bits: u8, order: ByteOrder) -> Vec<f64> {
    let sample = |row: &[u8]| {
        let mut word = [0; 8];
        let (low, field) = (8 - bytes, &row[spacing.offset..spacing.offset + bytes]);
        word[low..].copy_from_slice(field);
        if order == ByteOrder::Big {
            word[low..].reverse();
        }
        // The sample's sign is the word's; what is beyond the native integer is shifted out.
        (i64::from_le_bytes(word) >> (64 - bits)) as f64
    };
    data.chunks_exact(spacing.stride).map(sample).collect()
}

impl Reader for WaveFile {
    fn read(&self, _: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        self.file.still_whole()?;
        channels
            .iter()
            .map(|&channel| self.channel(channel))
            .collect()
    }
}
