//! One time axis for channels that have clocks of their own: each begins when its file states it.
//!
//! Channels of one rate are shifted by whole samples, and what is left of a sample by a cubic through the
//! four nearest ones (a contact, which has two levels, stays at its nearest sample). Channels of unlike rate are
//! refused by name.

use super::{Channel, Flag, Problem, Record, Role};
use crate::signal::columns::extremes;
use crate::signal::whole;

/// When the samples of a channel were taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Timing {
    /// Samples per second, Hz.
    pub rate_hz: f64,
    /// When the first was taken, s; `None`: not stated.
    pub start_s: Option<f64>,
}

/// Fewest samples that all channels must have in common.
const FEWEST_SAMPLES: usize = 16;

/// Part of a sample by which a channel may stay out of place: a tenth of the least standard error that an impact's time
/// has between two flights, which it widens by half a percent. What is shifted by whole samples stays as it was recorded.
const PLACE: f64 = 0.01;

/// Shift the channels of a record, each with its timing, to the start of the one that begins last; gives the
/// rate that they share. Samples without a value at a channel's ends must have been cut off.
pub(super) fn align(record: &mut Record, timings: &[Timing]) -> Option<f64> {
    let rate_hz = timings.first()?.rate_hz;
    if let Some(flag) = unlike_rates(record, timings) {
        record.flags.push(flag);
        return None;
    }
    let starts_s = starts_s(timings.iter().map(|t| t.start_s));
    let (first_s, last_s) = extremes(&starts_s);
    if !(last_s > first_s) {
        return Some(rate_hz);
    }
    if timings.iter().any(|t| t.start_s.is_none()) {
        record.flags.push(start_missing(record, timings));
    }
    let mut shifted = false;
    for (channel, start_s) in record.channels.iter_mut().zip(&starts_s) {
        let early = (last_s - start_s) * rate_hz;
        shifted |= early > PLACE;
        advance(channel, early);
    }
    let common = record
        .channels
        .iter()
        .map(|c| c.values.len())
        .min()
        .unwrap_or(0);
    if common < FEWEST_SAMPLES {
        record.flags.push(apart(record, timings, last_s - first_s));
        return None;
    }
    for channel in &mut record.channels {
        channel.values.truncate(common);
    }
    if shifted {
        record
            .flags
            .push(channels_shifted(record, timings, last_s - first_s));
    }
    Some(rate_hz)
}

/// When each channel begins, s, those too that do not state it.
pub(super) fn starts_s(stated: impl Iterator<Item = Option<f64>> + Clone) -> Vec<f64> {
    let not_stated_s = unstated_s(stated.clone());
    stated.map(|s| s.unwrap_or(not_stated_s)).collect()
}

/// Start from which on it is a date, and not a time after the start of the record, s.
const DATED_S: f64 = 1e6;

/// When channels begin that state no start, s: with the record where those of the others are times after that, else with the
/// first of them.
fn unstated_s(starts: impl Iterator<Item = Option<f64>>) -> f64 {
    let first_s = starts.flatten().fold(f64::INFINITY, f64::min);
    if first_s < DATED_S {
        first_s.min(0.0)
    } else {
        first_s
    }
}

/// Let a channel begin so many samples later, by leaving out the samples before.
fn advance(channel: &mut Channel, samples: f64) {
    let nearest = samples.round();
    let rest = samples - nearest;
    let count = whole::index(nearest).min(channel.values.len());
    if channel.role == Role::Contact || rest.abs() <= PLACE {
        channel.values.drain(..count);
        return;
    }
    let values = &channel.values;
    let below = if rest < 0.0 {
        count.saturating_sub(1)
    } else {
        count
    };
    let part = if rest < 0.0 { 1.0 + rest } else { rest };
    let between = |i: usize| cubic(values, i, part);
    let moved = (below..values.len().saturating_sub(1))
        .map(between)
        .collect();
    channel.values = moved;
}

/// The value at a part of the way from the sample `i` to the next, of the cubic through the four around it (at
/// the ends through the first or last four).
fn cubic(values: &[f64], i: usize, part: f64) -> f64 {
    let Some(last) = values.len().checked_sub(4) else {
        return values[i] + part * (values[i + 1] - values[i]);
    };
    let from = i.saturating_sub(1).min(last);
    let x = (i - from) as f64 + part;
    let weight = |k: usize| {
        let others = (0..4).filter(|j| *j != k);
        others
            .map(|j| (x - j as f64) / (k as f64 - j as f64))
            .product::<f64>()
    };
    (0..4).map(|k| weight(k) * values[from + k]).sum()
}

/// A rate that differs from the first channel's by more than half a sample over the record.
fn unlike_rates(record: &Record, timings: &[Timing]) -> Option<Flag> {
    let (first, rest) = timings.split_first()?;
    let (known, others) = record.channels.split_first()?;
    let unlike = |(channel, timing): &(&Channel, &Timing)| {
        (timing.rate_hz / first.rate_hz - 1.0).abs() * channel.values.len() as f64 > 0.5
    };
    let (channel, timing) = others.iter().zip(rest).find(unlike)?;
    let problem = Problem::RatesOfTwoDiffer {
        channel: channel.name.clone(),
        rate_hz: timing.rate_hz,
        other: known.name.clone(),
        other_hz: first.rate_hz,
    };
    Some(Flag::new(Some(&channel.name), problem))
}

/// The channel that begins last.
fn latest<'a>(record: &'a Record, timings: &[Timing]) -> &'a str {
    let start = |t: &Timing| t.start_s.unwrap_or(f64::NEG_INFINITY);
    let of_last = record.channels.iter().zip(timings);
    let of_last = of_last.max_by(|(_, a), (_, b)| start(a).total_cmp(&start(b)));
    of_last.map_or("", |(channel, _)| channel.name.as_str())
}

fn channels_shifted(record: &Record, timings: &[Timing], by_s: f64) -> Flag {
    let name = latest(record, timings);
    let channel = name.to_owned();
    Flag::new(Some(name), Problem::LaterChannel { channel, by_s }).excluding(false)
}

fn apart(record: &Record, timings: &[Timing], by_s: f64) -> Flag {
    let name = latest(record, timings);
    let channel = name.to_owned();
    Flag::new(Some(name), Problem::TooLateChannel { channel, by_s })
}

fn start_missing(record: &Record, timings: &[Timing]) -> Flag {
    let mut all = record.channels.iter().zip(timings);
    let name = all
        .find(|(_, t)| t.start_s.is_none())
        .map_or("", |(c, _)| c.name.as_str());
    let channel = name.to_owned();
    Flag::new(Some(name), Problem::StartNotStated { channel }).excluding(false)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::record::FlagCode;

    fn record(values: [&[f64]; 2]) -> Record {
        Record::of(
            1000.0,
            &[(Role::VelocityX, values[0]), (Role::VelocityY, values[1])],
        )
    }

    fn timing(rate_hz: f64, start_s: f64) -> Timing {
        Timing {
            rate_hz,
            start_s: Some(start_s),
        }
    }

    #[test]
    fn a_channel_that_begins_later_belongs_later() {
        let count: Vec<f64> = (0..100).map(f64::from).collect();
        let mut apart = record([&count, &count[40..]]);
        let rate = align(&mut apart, &[timing(1000.0, 0.0), timing(1000.0, 0.04)]);
        assert_eq!(rate, Some(1000.0));
        assert_eq!(apart.channels[0].values, apart.channels[1].values);
        assert_eq!(apart.channels[0].values.len(), 60);
        assert!(!apart.excluded());
        assert_eq!(
            apart.flags[0].message(),
            "channel 'velocity_y' begins 0.040000 s after the first: all are put in place"
        );
    }

    #[test]
    fn a_channel_without_a_start_begins_with_the_record_beside_one_that_begins_later() {
        let count: Vec<f64> = (0..100).map(f64::from).collect();
        let mut apart = record([&count, &count[40..]]);
        let unstated = Timing {
            rate_hz: 1000.0,
            start_s: None,
        };
        align(&mut apart, &[unstated, timing(1000.0, 0.04)]);
        assert_eq!(apart.channels[0].values, apart.channels[1].values);
        assert_eq!(apart.channels[0].values.len(), 60);
        let starts = [None, Some(1.7e9), Some(1.7e9 + 0.04)];
        assert_eq!(unstated_s(starts.into_iter()), 1.7e9);
    }

    #[test]
    fn channels_of_unlike_rate_or_at_unlike_times_are_refused_by_name() {
        let count: Vec<f64> = (0..100).map(f64::from).collect();
        let mut unlike = record([&count, &count]);
        assert_eq!(
            align(&mut unlike, &[timing(1000.0, 0.0), timing(500.0, 0.0)]),
            None
        );
        assert_eq!(
            unlike.flags[0].message(),
            "channel 'velocity_y' has 500 samples a second, 'velocity_x' 1000"
        );
        let mut later = record([&count, &count]);
        assert_eq!(
            align(&mut later, &[timing(1000.0, 0.0), timing(1000.0, 5.0)]),
            None
        );
        assert_eq!(later.flags[0].code, FlagCode::ChannelsApart);
    }

    proptest! {
        #[test]
        fn prop_two_views_of_one_motion_agree_after_the_shift(start in 0.0..0.1f64, cycles in 0.5..12.0f64) {
            let at = |t: f64| (std::f64::consts::TAU * cycles * t).sin();
            let early: Vec<f64> = (0..400).map(|i| at(f64::from(i) / 1000.0)).collect();
            let late: Vec<f64> = (0..400).map(|i| at(start + f64::from(i) / 1000.0)).collect();
            let mut both = record([&early, &late]);
            align(&mut both, &[timing(1000.0, 0.0), timing(1000.0, start)]);
            let [x, y] = [0, 1].map(|i| both.channels[i].values.clone());
            // a hundredth of a sample, and the cubic's error
            let most = 0.011 * std::f64::consts::TAU * cycles / 1000.0 + 1e-4;
            prop_assert!(x.len() >= 290 && x.len() == y.len());
            prop_assert!(x.iter().zip(&y).all(|(x, y)| (x - y).abs() < most));
        }
    }
}
