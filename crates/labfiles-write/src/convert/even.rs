//! When the samples of a record's channels were taken, as universal files state it: by start and step.

use crate::convert::item::{ConvertError, Item};
use labfiles::rate;
use labfiles::timing::AxisUnit;
use labfiles::{Clock, DatasetInfo, ReadError, Samples};

/// Even times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Even {
    /// Of the first sample, s after the earliest of the record.
    pub(super) start_s: f64,
    /// From one sample to the next, s.
    pub(super) step_s: f64,
}

/// The times of each channel; `None` of texts and of channels without a rate.
pub(super) fn of(item: &Item<'_>, samples: &[Samples]) -> Result<Vec<Option<Even>>, ConvertError> {
    let record = Record {
        set: &item.source.datasets()[item.dataset],
        samples,
        shared_hz: item.sample_rate_hz(),
    };
    let channels = 0..samples.len();
    let rates = channels.clone().map(|channel| {
        let rate = record.rate_hz(channel);
        rate.map_err(|found| refused(item, channel, found))
    });
    let rates: Vec<Option<f64>> = rates.collect::<Result<_, _>>()?;
    let timed = |channel: &usize| rates[*channel].is_some();
    let starts: Vec<Option<f64>> = channels.clone().map(|c| record.start_s(c)).collect();
    let known = channels.clone().filter(timed).filter_map(|c| starts[c]);
    let known: Vec<f64> = known.collect();
    let origin_s = known.iter().copied().reduce(f64::min);
    let unlike = known.iter().any(|s| Some(*s) != origin_s);
    let mut unknown = channels.clone().filter(timed);
    let unknown = unknown.find(|c| unlike && starts[*c].is_none());
    if let Some(channel) = unknown {
        return Err(refused(item, channel, NO_START).into());
    }
    let even = |channel: usize| {
        Some(Even {
            start_s: starts[channel]
                .zip(origin_s)
                .map_or(0.0, |(own, first)| own - first),
            step_s: rates[channel]?.recip(),
        })
    };
    Ok(channels.map(even).collect())
}

/// Found of a channel whose start cannot be written.
const NO_START: &str = "its start is not known beside that of other channels";
/// Found of a channel whose step cannot be written.
const UNEVEN: &str = "its times are not even, beside channels with others";

/// A record's channel that a universal file cannot hold.
pub(super) fn refused(item: &Item<'_>, channel: usize, found: &str) -> ReadError {
    let error = ReadError::new(
        item.source.path(),
        "a start and an even step, by which universal files state times",
        found,
        "convert to HDF5, Parquet or CSV, which keep the times of each channel",
    );
    error.channel(&item.channels()[channel].name)
}

/// Part of a step by which even times may be off: printers round them.
const OFF: f64 = 0.5;

struct Record<'a> {
    set: &'a DatasetInfo,
    samples: &'a [Samples],
    shared_hz: Option<f64>,
}

impl Record<'_> {
    /// The time axis of a channel.
    fn axis(&self, channel: usize) -> Option<usize> {
        match self.set.channels[channel].clock {
            Clock::Axis(axis) => Some(axis),
            Clock::Rate => None,
            Clock::Shared => self.set.time_axis,
        }
    }

    /// The values of a time axis and the seconds in their unit.
    fn times(&self, axis: usize) -> Option<(&[f64], f64)> {
        let Samples::Real(values) = self.samples.get(axis)? else {
            return None;
        };
        let info = &self.set.channels[axis];
        let unit = AxisUnit::of(info.unit.as_deref(), &info.name, values);
        Some((values.as_slice(), unit.seconds()?))
    }

    /// The rate of a channel; what was found where it has times of its own and they are not even.
    fn rate_hz(&self, channel: usize) -> Result<Option<f64>, &'static str> {
        if matches!(self.samples[channel], Samples::Text(_)) {
            return Ok(None);
        }
        let own_hz = self.set.channels[channel].sample_rate_hz;
        let mut all = self.set.channels.iter();
        if all.all(|c| c.clock == Clock::Shared) {
            return Ok(self.shared_hz.or(own_hz));
        }
        match self.set.channels[channel].clock {
            Clock::Axis(axis) => self.even_hz(axis, own_hz).map(Some).ok_or(UNEVEN),
            Clock::Rate => Ok(own_hz.or(self.shared_hz)),
            Clock::Shared if self.set.time_axis.is_some() => own_hz.map(Some).ok_or(UNEVEN),
            Clock::Shared => Ok(own_hz),
        }
    }

    /// The rate of a time axis whose values are even: the stated one, if they follow it, else their own.
    fn even_hz(&self, axis: usize, stated_hz: Option<f64>) -> Option<f64> {
        let (values, unit_s) = self.times(axis)?;
        let first = values.first()?;
        let even = |rate_hz: &f64| {
            let off =
                |(k, value): (usize, &f64)| ((value - first) * unit_s * rate_hz - k as f64).abs();
            // shorter columns end in empty cells
            let mut filled = values.iter().enumerate().filter(|(_, v)| v.is_finite());
            first.is_finite() && filled.all(|at| off(at) < OFF)
        };
        let own = || {
            let head = &values[..values.len().min(rate::HEAD_SAMPLES)];
            rate::from_axis(head, values.last().copied(), values.len() as u64, unit_s)
        };
        stated_hz.filter(even).or_else(|| own().filter(even))
    }

    /// When a channel's first sample was taken, s; `None` where the file does not state it. A time axis has the start
    /// of the first channel that uses it.
    fn start_s(&self, channel: usize) -> Option<f64> {
        let mut users = (0..self.samples.len()).filter(|c| *c != channel);
        let user = users.find(|c| self.axis(*c) == Some(channel));
        let channel = user.unwrap_or(channel);
        let start_s = self.set.channels[channel].start_s;
        let Some(axis) = self.axis(channel) else {
            return start_s;
        };
        let (values, unit_s) = self.times(axis)?;
        let first = values.first().filter(|v| v.is_finite())?;
        Some(first * unit_s + start_s.unwrap_or(0.0))
    }
}
