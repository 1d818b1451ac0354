//! Samples of a channel, gathered from the chunks of all segments.

use super::content::{Content, Object, Piece};
use super::layout::Entry;
use super::scale::Scaling;
use super::value::{Kind, Stamp};
use crate::bytes::{FileBytes, to_usize};
use crate::numbers::{self, ByteOrder, Number, Spacing};
use crate::source::{ReadError, Samples};

/// A run of samples in the file: where it begins, its spacing and its number of samples.
#[derive(Debug, Clone, Copy)]
struct Run {
    at: u64,
    stride: u64,
    count: u64,
}

/// Reads samples of an open file.
pub(super) struct Chunks<'a> {
    /// The file.
    pub file: &'a FileBytes,
    /// What opening it found.
    pub content: &'a Content,
}

impl<'a> Chunks<'a> {
    /// The pieces in which a channel has samples, in file order.
    fn pieces(&self, object: &Object) -> Vec<(&'a Piece, &'a Entry)> {
        let content = self.content;
        let mut all: Vec<(usize, &Entry)> = Vec::new();
        for &(layout, entry) in &object.places {
            let entry = &content.layouts[layout].entries[entry];
            all.extend(
                content.pieces_of[layout]
                    .iter()
                    .map(|&piece| (piece, entry)),
            );
        }
        all.sort_unstable_by_key(|(piece, _)| *piece);
        all.into_iter()
            .map(|(piece, entry)| (&content.pieces[piece], entry))
            .collect()
    }

    /// Call `visit` with each run of a channel's samples; `scaler` picks one of a `DAQmx` channel.
    fn runs(
        &self,
        object: &Object,
        scaler: usize,
        mut visit: impl FnMut(Run, ByteOrder) -> Result<(), ReadError>,
    ) -> Result<(), ReadError> {
        for (piece, entry) in self.pieces(object) {
            let layout = &self.content.layouts[piece.layout];
            let count = entry.share.count;
            let size = entry.share.kind.bytes().unwrap_or(0);
            let (offset, stride, count, step) = match &entry.share.device {
                Some(device) => {
                    let scaler = &device.scalers[scaler.min(device.scalers.len() - 1)];
                    let (offset, stride) = layout.run(scaler);
                    (offset, stride, count, layout.chunk)
                }
                None if piece.interleaved => (entry.column, layout.row, count * piece.chunks, 0),
                // chunks of one channel follow each other without a gap
                None if entry.share.bytes == layout.chunk && entry.share.kind != Kind::Text => {
                    (0, size, count * piece.chunks, 0)
                }
                None => (entry.offset, size, count, layout.chunk),
            };
            for chunk in 0..if step == 0 { 1 } else { piece.chunks } {
                let run = Run {
                    at: piece.at + offset + chunk * step,
                    stride,
                    count,
                };
                visit(run, piece.order)?;
            }
        }
        Ok(())
    }

    /// The bytes of a run of samples of `size` bytes.
    fn bytes(&self, run: Run, size: u64) -> Result<&'a [u8], ReadError> {
        let length = run
            .count
            .saturating_sub(1)
            .saturating_mul(run.stride)
            .saturating_add(size);
        self.file
            .slice(run.at, if run.count == 0 { 0 } else { length }, "samples")
    }

    fn numbers(
        &self,
        object: &Object,
        number: Number,
        scaler: usize,
        shift: u64,
    ) -> Result<Vec<f64>, ReadError> {
        let mut out = Vec::new();
        out.reserve_exact(to_usize(object.samples));
        self.runs(object, scaler, |run, order| {
            let run = Run {
                at: run.at + shift,
                ..run
            };
            let bytes = self.bytes(run, number.bytes())?;
            let spacing = Spacing {
                offset: 0,
                stride: to_usize(run.stride),
                count: to_usize(run.count),
            };
            numbers::decode_spaced(number, order, bytes, spacing, &mut out);
            Ok(())
        })?;
        Ok(out)
    }

    /// All samples of a channel, after its scaling.
    pub(super) fn samples(&self, object: &Object, scaling: &Scaling) -> Result<Samples, ReadError> {
        let device = self.device(object, scaling)?;
        let Some(kind) = object.kind else {
            return Ok(Samples::Real(Vec::new()));
        };
        if let Some((index, number, bit)) = device {
            let mut values = self.numbers(object, number, index, 0)?;
            if let Some(bit) = bit {
                values
                    .iter_mut()
                    .for_each(|v| *v = f64::from(u8::from(has_bit(*v, bit))));
            }
            scaling.apply(&mut values);
            return Ok(Samples::Real(values));
        }
        Ok(match kind {
            Kind::Number(number) => {
                let mut values = self.numbers(object, number, 0, 0)?;
                scaling.apply(&mut values);
                Samples::Real(values)
            }
            Kind::Bool => {
                let mut values = self.numbers(object, Number::U8, 0, 0)?;
                values
                    .iter_mut()
                    .for_each(|v| *v = f64::from(u8::from(*v != 0.0)));
                Samples::Real(values)
            }
            Kind::Complex(part) => {
                let real = self.numbers(object, part, 0, 0)?;
                let imaginary = self.numbers(object, part, 0, part.bytes())?;
                Samples::Complex(numbers::pair(real, imaginary))
            }
            Kind::Time => Samples::Real(self.times(object)?),
            Kind::Text => Samples::Text(self.texts(object)?),
            Kind::Device => Samples::Real(Vec::new()),
        })
    }

    /// The scaler of a `DAQmx` channel that its scaling starts from: index, number, bit.
    fn device(
        &self,
        object: &Object,
        scaling: &Scaling,
    ) -> Result<Option<(usize, Number, Option<u32>)>, ReadError> {
        let Some(device) = self.first_device(object) else {
            return Ok(None);
        };
        let index = match scaling.scaler {
            Some(scale) => device.scalers.iter().position(|s| s.scale == scale),
            None => Some(0).filter(|_| device.scalers.len() == 1),
        };
        let Some(index) = index else {
            let count = device.scalers.len();
            let found = match scaling.scaler {
                Some(scale) => format!("{count} scalers, none of which is scale {scale}"),
                None => format!("{count} scalers, and no scaling that names one"),
            };
            return Err(ReadError {
                byte: None,
                ..self.file.refuse(
                    0,
                    "the DAQmx scaler that the channel's scaling names",
                    found,
                )
            });
        };
        let scaler = &device.scalers[index];
        Ok(Some((index, scaler.number, scaler.bit)))
    }

    /// The `DAQmx` description of a channel, if it is one.
    pub(super) fn first_device(&self, object: &Object) -> Option<&'a super::layout::Device> {
        let &(layout, entry) = object.places.first()?;
        self.content.layouts[layout].entries[entry]
            .share
            .device
            .as_deref()
    }

    /// The stamps of a time channel.
    fn stamps(&self, object: &Object, most: usize) -> Result<Vec<Stamp>, ReadError> {
        let mut all = Vec::new();
        self.runs(object, 0, |run, order| {
            for sample in 0..run.count.min((most - all.len()) as u64) {
                let at = run.at + sample * run.stride;
                let bytes = self.file.slice(at, 16, "a time stamp")?;
                all.push(Stamp::of(bytes, order));
            }
            Ok(())
        })?;
        Ok(all)
    }

    /// The first stamp of a time channel.
    pub(super) fn first_stamp(&self, object: &Object) -> Result<Option<Stamp>, ReadError> {
        Ok(self.stamps(object, 1)?.pop())
    }

    /// Seconds since a time channel's first stamp.
    fn times(&self, object: &Object) -> Result<Vec<f64>, ReadError> {
        let stamps = self.stamps(object, usize::MAX)?;
        let first = stamps.first().copied();
        Ok(stamps
            .iter()
            .map(|s| first.map_or(0.0, |first| s.seconds_since(first)))
            .collect())
    }

    /// Texts: the ends of all, then their bytes.
    fn texts(&self, object: &Object) -> Result<Vec<String>, ReadError> {
        let mut all = Vec::new();
        for (piece, entry) in self.pieces(object) {
            let layout = &self.content.layouts[piece.layout];
            for chunk in 0..piece.chunks {
                let at = piece.at + chunk * layout.chunk + entry.offset;
                self.text_chunk(at, entry, piece.order, &mut all)?;
            }
        }
        Ok(all)
    }

    fn text_chunk(
        &self,
        at: u64,
        entry: &Entry,
        order: ByteOrder,
        all: &mut Vec<String>,
    ) -> Result<(), ReadError> {
        let bytes = self.file.slice(at, entry.share.bytes, "texts")?;
        let (ends, texts) = bytes.split_at(4 * to_usize(entry.share.count));
        let mut start = 0;
        for &end in ends.as_chunks().0 {
            let end = order.u32(end) as usize;
            let Some(text) = texts.get(start..end) else {
                let expected = format!("the end of a text between {start} and {}", texts.len());
                return Err(self.file.refuse(at, expected, end.to_string()));
            };
            all.push(crate::bytes::decode_text(text).into_owned());
            start = end;
        }
        Ok(())
    }
}

/// Whether a bit is set in a sample of digital lines.
#[expect(clippy::cast_possible_truncation, reason = "the samples are integers")]
fn has_bit(sample: f64, bit: u32) -> bool {
    (sample as i64).cast_unsigned() & (1 << bit) != 0
}
