//! Undriven records whose samples are at uneven times: their values at even times.

use super::{Flag, FlagCode, Problem, Record, time_axis};
use crate::signal::{interpolation, robust, whole};

/// Steps between two samples, over the usual one, from which on others are missing between them.
const MISSING: f64 = 1.5;
/// Even times over samples at most: a time axis that lacks more than it holds has another fault.
const MOST_PLACES: f64 = 2.0;
/// Part of a step within which a place is that of a sample: the rounding of printed times.
const AT_A_SAMPLE: f64 = 1e-6;
/// Steps between two samples between which one is missing, at most: it is as far from its neighbours as those are by
/// which the motion is tested.
const BRIDGED: f64 = 2.5;
/// Root mean square by which a cubic of twice the steps may miss the samples, over the motion's: of what is neither
/// noise nor the jump of a blow the cubic between neighbours misses a sixteenth.
const MISSED: f64 = 0.2;
/// What samples at even times are missed by, over those at the recorded times, from which on the recorded times scatter
/// and the samples do not: noise of both is the same, so that less is missed only where the times add some of their own.
const EVENLY: f64 = 0.9;

/// Put a record on even times, if all its channels are of motion and that motion is slow beside the steps between
/// samples. Places between which several samples are missing have no value.
pub(super) fn resample(record: &mut Record, times: &mut Vec<f64>) -> Option<Flag> {
    let mut wrong = Vec::new();
    time_axis::inspect(times, &mut wrong)?;
    let codes = [FlagCode::DroppedSamples, FlagCode::TimeNotUniform];
    let usable = wrong.iter().all(|flag| codes.contains(&flag.code));
    let motion = record.channels.iter().all(|c| c.role.is_motion());
    let rises = times.windows(2).all(|w| w[1] > w[0]);
    if !(usable && motion && rises) {
        return None;
    }
    let nearly_even = wrong.is_empty();
    if nearly_even && !time_axis::strays_unrounded(times) {
        return None;
    }
    let uneven = Uneven::of(times)?;
    // times that are taken late scatter, though the samples do not
    let shows_times = |values: &[f64]| {
        uneven.foretells(values) && !(nearly_even && uneven.evenly_foretold(values))
    };
    if !record.channels.iter().all(|c| shows_times(&c.values)) {
        return None;
    }
    let even: Vec<f64> = (0..uneven.count)
        .map(|k| times[0] + k as f64 * uneven.step_s)
        .collect();
    for channel in &mut record.channels {
        let values = even.iter().map(|t| uneven.value(&channel.values, *t));
        channel.values = values.collect();
    }
    let problem = Problem::PutOnEvenTimes {
        lost: uneven.lost,
        spread_s: uneven.spread_s,
        step_s: uneven.step_s,
    };
    *times = even;
    Some(Flag::new(None, problem).excluding(false))
}

/// Uneven times that rise.
struct Uneven<'a> {
    times: &'a [f64],
    /// The mean step between samples between which none is missing, s.
    step_s: f64,
    /// Standard deviation of those steps, s.
    spread_s: f64,
    /// How many samples are missing.
    lost: usize,
    /// How many even times there are.
    count: usize,
}

impl<'a> Uneven<'a> {
    fn of(times: &'a [f64]) -> Option<Self> {
        let usual = time_axis::usual_step(times)?;
        let steps = times.windows(2).map(|w| w[1] - w[0]);
        let (whole_steps, longer): (Vec<f64>, Vec<f64>) =
            steps.partition(|s| *s <= MISSING * usual);
        let step_s = whole_steps.iter().sum::<f64>() / whole_steps.len() as f64;
        let lost = longer.iter().map(|s| (s / step_s).round() - 1.0);
        let length = times[times.len() - 1] - times[0];
        let even = step_s.is_finite() && step_s > 0.0;
        let mostly_there = length / step_s < MOST_PLACES * times.len() as f64;
        (even && mostly_there).then(|| Self {
            times,
            step_s,
            spread_s: robust::rms_about_mean(&whole_steps),
            lost: whole::index(lost.sum()),
            count: whole::index((length / step_s + 1e-9).floor()) + 1,
        })
    }

    /// The value at a time, by a cubic through the four samples around it; none where several samples are missing.
    fn value(&self, values: &[f64], time: f64) -> f64 {
        let times = self.times;
        let after = times.partition_point(|t| *t < time);
        let near = |i: &usize| (times[*i] - time).abs() <= AT_A_SAMPLE * self.step_s;
        let beside = [after, after.saturating_sub(1)];
        if let Some(i) = beside.iter().find(|i| **i < times.len() && near(i)) {
            return values[*i];
        }
        let Some(before) = after.checked_sub(1).filter(|_| after < times.len()) else {
            return f64::NAN;
        };
        if times[after] - times[before] > BRIDGED * self.step_s {
            return f64::NAN;
        }
        let first = before.saturating_sub(1).min(times.len().saturating_sub(4));
        let around: Vec<usize> = (first..times.len().min(first + 4)).collect();
        interpolation::at(times, values, &around, time)
    }

    /// Whether the two samples on either side of each foretell it: the cubic between neighbours then is far nearer.
    fn foretells(&self, values: &[f64]) -> bool {
        let known: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        let missed = self.missed(values, self.times);
        missed.is_some_and(|missed| missed < MISSED * robust::rms_about_mean(&known))
    }

    /// Whether samples are foretold better as if they were at even times.
    fn evenly_foretold(&self, values: &[f64]) -> bool {
        let even: Vec<f64> = (0..values.len()).map(|k| k as f64 * self.step_s).collect();
        let missed = [self.times, &even].map(|times| self.missed(values, times));
        matches!(missed, [Some(stamped), Some(even)] if even < EVENLY * stamped)
    }

    /// Root mean square of what the cubic through the two samples on either side of each misses, with the samples at
    /// some times; `None` where no sample has two on either side.
    fn missed(&self, values: &[f64], times: &[f64]) -> Option<f64> {
        let missed = (2..values.len().saturating_sub(2)).filter_map(|i| {
            let span = self.times[i + 2] - self.times[i - 2];
            let around = [i - 2, i - 1, i + 1, i + 2];
            let close = span <= 4.0 * MISSING * self.step_s;
            close.then(|| values[i] - interpolation::at(times, values, &around, times[i]))
        });
        let missed: Vec<f64> = missed.filter(|m| m.is_finite()).collect();
        (!missed.is_empty()).then(|| robust::rms(&missed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Role;

    /// A swing of 0.8 Hz at times.
    fn swing(times: &[f64]) -> Vec<f64> {
        times.iter().map(|t| (5.0 * t).sin()).collect()
    }

    fn resampled(times: &[f64], role: Role) -> (Record, Vec<f64>, Option<Flag>) {
        let mut record = Record::of(100.0, &[(role, &swing(times))]);
        let mut times = times.to_vec();
        let flag = resample(&mut record, &mut times);
        (record, times, flag)
    }

    /// Times of steps of 9 to 11 ms, without some samples.
    fn uneven(missing: &[usize]) -> Vec<f64> {
        let step = |i: usize| 0.01 + 1e-3 * (i as f64 * 2.399_963).sin();
        let mut time = 0.0;
        let all = (0..1000).map(|i| {
            time += step(i * i);
            (i, time)
        });
        all.filter(|(i, _)| !missing.contains(i))
            .map(|(_, t)| t)
            .collect()
    }

    #[test]
    fn valid_values_at_even_times_are_those_of_the_motion() {
        let (record, even, flag) = resampled(&uneven(&[300, 500, 501, 502]), Role::AccelerationX);
        let flag = flag.expect("a note");
        assert!(
            !flag.excludes && flag.message().contains("uneven times"),
            "{}",
            flag.message()
        );
        let mut flags = Vec::new();
        assert!(time_axis::inspect(&even, &mut flags).is_some() && flags.is_empty());
        let values = &record.channels[0].values;
        let off = values.iter().zip(swing(&even)).map(|(v, w)| (v - w).abs());
        let off: Vec<f64> = off.filter(|o| o.is_finite()).collect();
        let most = off.iter().copied().fold(0.0, f64::max);
        assert!(most < 1e-5, "{most}");
        let without = values.len() - off.len();
        assert!((2..=4).contains(&without), "{without}");
    }

    /// Times with steps that grow by a thousandth along the record, or that are taken late by up to a tenth of a step.
    #[test]
    fn valid_a_rate_that_drifts_is_undone_and_late_stamps_of_even_samples_are_not() {
        let drifting: Vec<f64> = (0..1000_i32)
            .map(|i| f64::from(i) * 0.01 * (1.0 + 1e-6 * f64::from(i)))
            .collect();
        let (record, even, flag) = resampled(&drifting, Role::AccelerationX);
        assert!(flag.is_some_and(|f| !f.excludes));
        let values = &record.channels[0].values;
        let off = values.iter().zip(swing(&even)).map(|(v, w)| (v - w).abs());
        assert!(off.fold(0.0, f64::max) < 1e-5);
        let even: Vec<f64> = (0..1000_i32).map(|i| f64::from(i) * 0.01).collect();
        let late: Vec<f64> = even
            .iter()
            .enumerate()
            .map(|(i, t)| t + 1e-3 * (i as f64 * 2.399_963).sin().abs())
            .collect();
        let mut record = Record::of(100.0, &[(Role::AccelerationX, &swing(&even))]);
        assert_eq!(resample(&mut record, &mut late.clone()), None);
        let printed: Vec<f64> = drifting
            .iter()
            .map(|t| (t * 100.0).round() / 100.0)
            .collect();
        assert_eq!(resampled(&printed[..500], Role::AccelerationX).2, None);
    }

    #[test]
    fn fast_motions_and_contacts_stay_as_they_are() {
        let fast: Vec<f64> = uneven(&[300]).iter().map(|t| 30.0 * t).collect();
        assert_eq!(resampled(&fast, Role::VelocityX).2, None);
        assert_eq!(resampled(&uneven(&[300]), Role::Contact).2, None);
        let even: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.01).collect();
        assert_eq!(resampled(&even, Role::VelocityX).2, None);
    }
}
