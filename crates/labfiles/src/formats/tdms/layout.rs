//! How the raw data of a chunk are laid out: the places of each channel's samples.

use std::sync::Arc;

use crate::numbers::Number;

use super::value::Kind;

/// One scaler of a `DAQmx` channel: the places of its raw samples in the device's buffer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Scaler {
    /// Number of the scale that represents it.
    pub scale: u32,
    /// How a sample is stored.
    pub number: Number,
    /// Which buffer of the chunk.
    pub buffer: u32,
    /// Byte of the sample within a row of the buffer.
    pub byte: u64,
    /// For a digital line: which bit of the sample.
    pub bit: Option<u32>,
}

/// Raw data of a `DAQmx` channel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Device {
    /// Its scalers, at least one.
    pub scalers: Vec<Scaler>,
    /// Bytes of a row of each buffer of the chunk.
    pub widths: Vec<u64>,
}

/// A channel's share of every chunk.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Share {
    /// What the samples are.
    pub kind: Kind,
    /// Samples per chunk.
    pub count: u64,
    /// Bytes per chunk (of a `DAQmx` channel: 0, see the buffers).
    pub bytes: u64,
    /// Of a `DAQmx` channel.
    pub device: Option<Arc<Device>>,
}

/// A channel in a layout.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Entry {
    /// The channel.
    pub object: usize,
    /// Its share.
    pub share: Share,
    /// Byte of its first sample in a chunk where channels follow each other.
    pub offset: u64,
    /// Byte of its sample in a row where channels are interleaved.
    pub column: u64,
}

/// Why the data of channels do not fit together in a chunk.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(super) enum LayoutFault {
    #[error("a chunk beyond 2^64 bytes")]
    TooLong,
    #[error("DAQmx channels beside channels of another kind")]
    OtherKinds,
    #[error("DAQmx channels with different raw data widths")]
    Widths,
    #[error("a DAQmx scaler in buffer {buffer} of {buffers}")]
    NoBuffer { buffer: usize, buffers: usize },
    #[error("a DAQmx scaler at byte {byte} of {width}")]
    Outside { byte: u64, width: u64 },
    #[error("DAQmx scalers that overlap in buffer {0}")]
    Overlap(usize),
}

/// The layout of the chunks of a segment.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Layout {
    /// The channels that have data, in the order of their data.
    pub entries: Vec<Entry>,
    /// Bytes of a chunk.
    pub chunk: u64,
    /// Bytes of a row of interleaved samples.
    pub row: u64,
    /// Rows and width of every `DAQmx` buffer.
    buffers: Vec<(u64, u64)>,
}

impl Layout {
    /// Lay out the shares of channels one after the other.
    pub(super) fn new(shares: Vec<(usize, Share)>) -> Result<Self, LayoutFault> {
        let mut layout = Self::default();
        let devices = shares
            .iter()
            .filter(|(_, share)| share.device.is_some())
            .count();
        if devices > 0 {
            return layout.devices(shares, devices);
        }
        for (object, share) in shares {
            let (offset, column) = (layout.chunk, layout.row);
            layout.chunk = layout
                .chunk
                .checked_add(share.bytes)
                .ok_or(LayoutFault::TooLong)?;
            layout.row += share.kind.bytes().unwrap_or(0);
            layout.entries.push(Entry {
                object,
                share,
                offset,
                column,
            });
        }
        Ok(layout)
    }

    fn devices(mut self, shares: Vec<(usize, Share)>, devices: usize) -> Result<Self, LayoutFault> {
        if devices != shares.len() {
            return Err(LayoutFault::OtherKinds);
        }
        let mut used = Vec::new();
        for (object, share) in shares {
            let Some(device) = &share.device else {
                continue;
            };
            if self.entries.is_empty() {
                self.buffers = device.widths.iter().map(|&width| (0, width)).collect();
                used = vec![0u64; device.widths.len()];
            }
            if !self.buffers.iter().map(|b| &b.1).eq(&device.widths) {
                return Err(LayoutFault::Widths);
            }
            for scaler in &device.scalers {
                self.place(scaler, share.count, &mut used)?;
            }
            self.entries.push(Entry {
                object,
                share,
                offset: 0,
                column: 0,
            });
        }
        let bytes = self
            .buffers
            .iter()
            .map(|(rows, width)| rows.checked_mul(*width));
        let total = bytes
            .into_iter()
            .try_fold(0u64, |all, bytes| all.checked_add(bytes?));
        self.chunk = total.ok_or(LayoutFault::TooLong)?;
        Ok(self)
    }

    /// Check that a scaler is inside its buffer and that channels do not claim the same bits again
    /// and again.
    fn place(&mut self, scaler: &Scaler, rows: u64, used: &mut [u64]) -> Result<(), LayoutFault> {
        let index = scaler.buffer as usize;
        let absent = LayoutFault::NoBuffer {
            buffer: index,
            buffers: used.len(),
        };
        let buffer = self.buffers.get_mut(index).zip(used.get_mut(index));
        let (buffer, used) = buffer.ok_or(absent)?;
        let (byte, width) = (scaler.byte, buffer.1);
        if byte.saturating_add(scaler.number.bytes()) > width {
            return Err(LayoutFault::Outside { byte, width });
        }
        *used += if scaler.bit.is_some() {
            1
        } else {
            8 * scaler.number.bytes()
        };
        if *used > 16 * buffer.1 {
            return Err(LayoutFault::Overlap(index));
        }
        buffer.0 = buffer.0.max(rows);
        Ok(())
    }

    /// Places of the samples of a scaler in a chunk: the first, and bytes from one to the next.
    pub(super) fn run(&self, scaler: &Scaler) -> (u64, u64) {
        let before = &self.buffers[..scaler.buffer as usize];
        let start: u64 = before.iter().map(|(rows, width)| rows * width).sum();
        let stride = self.buffers[scaler.buffer as usize].1;
        (start + scaler.byte, stride)
    }

    /// Whether all channels can be interleaved row by row.
    pub(super) fn can_interleave(&self) -> bool {
        let sized = self
            .entries
            .iter()
            .all(|entry| entry.share.kind.bytes().is_some());
        let mut counts = self.entries.iter().map(|entry| entry.share.count);
        let first = counts.next();
        sized && counts.all(|count| Some(count) == first)
    }

    /// The layout of the last chunk of a segment, of which only `rest` bytes are there.
    ///
    /// A segment that was cut short holds the first channels whole and later ones in part; a
    /// complete segment divides a short last chunk among the channels in proportion.
    pub(super) fn cut(&self, rest: u64, cut_short: bool, interleaved: bool) -> Self {
        let mut cut = self.clone();
        if !self.buffers.is_empty() {
            cut.cut_buffers(rest);
            return cut;
        }
        let mut offset = 0;
        for entry in &mut cut.entries {
            let Some(size) = entry.share.kind.bytes() else {
                entry.share.count = 0;
                continue;
            };
            let count = entry.share.count;
            let count = match cut_short && !interleaved {
                true => count.min(rest.saturating_sub(entry.offset) / size),
                // not more than `count`, as `rest` is below a chunk
                false => {
                    let share = u128::from(count) * u128::from(rest) / u128::from(self.chunk);
                    u64::try_from(share).unwrap_or(count)
                }
            };
            if !cut_short || interleaved {
                entry.offset = offset;
            }
            entry.share.count = count;
            entry.share.bytes = count * size;
            offset += count * size;
        }
        if self
            .entries
            .iter()
            .any(|entry| entry.share.kind.bytes().is_none())
        {
            // Lengths of texts are not known in part: nothing of such a chunk is read.
            cut.entries
                .iter_mut()
                .for_each(|entry| entry.share.count = 0);
        }
        cut.chunk = rest;
        cut
    }

    fn cut_buffers(&mut self, mut rest: u64) {
        for (rows, width) in &mut self.buffers {
            let there = (*rows).min(rest.checked_div(*width).unwrap_or(0));
            rest = if there < *rows {
                0
            } else {
                rest - there * *width
            };
            *rows = there;
        }
        for entry in &mut self.entries {
            let scalers = entry
                .share
                .device
                .iter()
                .flat_map(|device| device.scalers.iter());
            let rows = scalers
                .map(|scaler| self.buffers[scaler.buffer as usize].0)
                .min();
            entry.share.count = entry.share.count.min(rows.unwrap_or(0));
        }
        self.chunk = self.buffers.iter().map(|(rows, width)| rows * width).sum();
    }
}
