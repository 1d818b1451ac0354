//! A tone that goes through several frequencies, as the drive of a stepped sweep: where it keeps each of them.

use super::columns;
use super::robust;
use super::whole;

/// Fewest cycles that a frequency is kept.
const FEWEST_CYCLES: usize = 12;
/// Cycles over which the frequency of one is the median.
const MEDIAN_CYCLES: usize = 5;
/// Cycles at each end of a part that are left out of it.
const EDGE: usize = 1 + MEDIAN_CYCLES / 2;
/// Least change of the frequency that is a step, relative; noise of the cycles' lengths raises it.
const LEAST_STEP: f64 = 1e-3;
/// Deviations of the noise of a cycle's length that are no step.
const OF_NOISE: f64 = 4.0;
/// Part of the amplitude below the middle from which a crossing counts: noise crosses the middle more than once.
const HYSTERESIS: f64 = 0.3;
/// Part of a step by which the halves of what is kept may differ: a frequency that glides is not kept.
const GLIDE: f64 = 0.5;

/// A part of a signal with one frequency.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveStep {
    /// The first sample.
    pub from: usize,
    /// The sample after the last.
    pub to: usize,
    /// The frequency, Hz.
    pub frequency_hz: f64,
}

/// The parts of a signal in which its tone keeps a frequency, in their order; the cycles about a change are in none. None where
/// no frequency is kept for twelve cycles, as in a glide.
///
/// ```
/// use impact_records::signal::steps::steps;
/// // 40 cycles of 10 Hz, then 40 of 10.5 Hz, at 1 kHz
/// let mut turns = 0.0;
/// let drive: Vec<f64> = (0..7800).map(|i| {
///     turns += if i < 4000 { 10e-3 } else { 10.5e-3 };
///     (std::f64::consts::TAU * turns).sin()
/// }).collect();
/// let found: Vec<f64> = steps(&drive, 1000.0).iter().map(|s| s.frequency_hz).collect();
/// assert!(found.len() == 2 && (found[0] - 10.0).abs() < 1e-3 && (found[1] - 10.5).abs() < 1e-3);
/// ```
pub fn steps(values: &[f64], rate_hz: f64) -> Vec<DriveStep> {
    let crossings = crossings(values);
    let lengths: Vec<f64> = crossings.windows(2).map(|w| w[1] - w[0]).collect();
    if lengths.len() < FEWEST_CYCLES {
        return Vec::new();
    }
    let smooth = running_median(&lengths);
    let scatter = lengths
        .iter()
        .zip(&smooth)
        .map(|(l, s)| (l / s - 1.0).abs());
    let noise = 1.48 * robust::median(&scatter.collect::<Vec<_>>()).unwrap_or(0.0);
    let least = LEAST_STEP.max(OF_NOISE * noise);
    let mut found = Vec::new();
    let mut first = 0;
    while first + FEWEST_CYCLES <= smooth.len() {
        let last = kept_until(&smooth, first, least);
        if last - first < FEWEST_CYCLES || glides(&smooth[first..last], least) {
            first += 1;
            continue;
        }
        // the running median hides a cycle in which frequency or phase jumps among those at the ends
        let (begin, end) = (crossings[first + EDGE], crossings[last - EDGE]);
        let cycles = (last - first - 2 * EDGE) as f64;
        found.push(DriveStep {
            from: whole::index(begin.ceil()),
            to: whole::index(end.floor()),
            frequency_hz: cycles * rate_hz / (end - begin),
        });
        first = last;
    }
    found
}

/// Where a signal rises through its middle, in samples.
fn crossings(values: &[f64]) -> Vec<f64> {
    let (low, high) = columns::extremes(values);
    let (middle, amplitude) = (0.5 * (low + high), 0.5 * (high - low));
    let mut below = false;
    let mut found = Vec::new();
    for (i, pair) in values.windows(2).enumerate() {
        below |= pair[0] < middle - HYSTERESIS * amplitude;
        if below && pair[0] < middle && pair[1] >= middle {
            found.push(i as f64 + (middle - pair[0]) / (pair[1] - pair[0]));
            below = false;
        }
    }
    found
}

fn running_median(lengths: &[f64]) -> Vec<f64> {
    let half = MEDIAN_CYCLES / 2;
    let around = |i: usize| {
        let to = (i + half + 1).min(lengths.len());
        robust::median(&lengths[i.saturating_sub(half)..to]).unwrap_or(lengths[i])
    };
    (0..lengths.len()).map(around).collect()
}

/// The first cycle after `first` whose length is not that of the cycles before it.
fn kept_until(lengths: &[f64], first: usize, least: f64) -> usize {
    let mut sum = lengths[first];
    for (count, length) in lengths[first + 1..].iter().enumerate() {
        let mean = sum / (count + 1) as f64;
        if (length / mean - 1.0).abs() > least {
            return first + 1 + count;
        }
        sum += length;
    }
    lengths.len()
}

/// Whether lengths of cycles go one way all along.
fn glides(lengths: &[f64], least: f64) -> bool {
    let (before, after) = lengths.split_at(lengths.len() / 2);
    let median = |part: &[f64]| robust::median(part).unwrap_or(f64::NAN);
    (median(after) / median(before) - 1.0).abs() > GLIDE * least
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A tone at 4 kHz that keeps each frequency for a time, with noise of a part of its amplitude.
    fn tone(frequencies: &[f64], seconds: f64, noise: f64) -> Vec<f64> {
        let count = whole::integer(seconds * 4000.0);
        let mut turns = 0.0;
        let each = frequencies.iter().flat_map(|f| (0..count).map(move |_| *f));
        let every = frequencies.len().max(1);
        let each = each.collect::<Vec<_>>();
        let part = each.len() / every;
        let value = |(i, f): (usize, f64)| {
            // the phase jumps where the frequency changes
            turns += f / 4000.0 + if i > 0 && i % part == 0 { 0.3 } else { 0.0 };
            1.5 * (TAU * turns).cos() + noise * (i as f64 * 2.399_963).sin() * 2f64.sqrt()
        };
        each.into_iter().enumerate().map(value).collect()
    }

    #[test]
    fn valid_each_frequency_of_a_stepped_sweep_is_found_with_its_samples() {
        let frequencies = [8.0, 8.1, 8.25, 9.0, 8.5];
        let found = steps(&tone(&frequencies, 4.0, 5e-3), 4000.0);
        assert_eq!(found.len(), frequencies.len());
        for (k, (step, f)) in found.iter().zip(frequencies).enumerate() {
            assert!((step.frequency_hz / f - 1.0).abs() < 5e-4, "{step:?}");
            assert!(
                step.from >= 16_000 * k && step.to <= 16_000 * (k + 1),
                "{step:?}"
            );
            assert!(step.to - step.from > 12_000, "{step:?}");
        }
    }

    #[test]
    fn one_tone_is_one_step_and_a_glide_none() {
        assert_eq!(steps(&tone(&[8.0], 4.0, 5e-3), 4000.0).len(), 1);
        let mut turns = 0.0;
        let glide: Vec<f64> = (0..80_000)
            .map(|i| {
                turns += (8.0 + f64::from(i) * 5e-5) / 4000.0;
                (TAU * turns).cos()
            })
            .collect();
        assert_eq!(steps(&glide, 4000.0), []);
        assert_eq!(steps(&[], 4000.0), []);
        assert_eq!(steps(&vec![1.0; 4000], 4000.0), []);
    }
}
