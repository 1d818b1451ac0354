//! Closure of a motion after n drive periods: of its waveform and of its impacts.

use nalgebra::{DMatrix, DVector};

use crate::event::Impact;
use crate::signal::columns::{dot, products, subtract, sum};
use crate::signal::interpolation::{later, noise_gain};
use crate::signal::robust;
use crate::signal::turns::Turns;
use crate::signal::whole;

/// How well a waveform closes after n drive periods.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WaveformClosure {
    /// Number of drive periods.
    pub periods_n: u32,
    /// Deviation of w(t + nT) − w(t) over √2 and over the waveform's root mean square.
    pub ratio: f64,
    /// The same in the first and in the second half of the record; `None` where either has few samples.
    pub halves: Option<[f64; 2]>,
}

/// Closure of a waveform for n = 1 … `most`, samples near impacts left out.
///
/// `period` in samples, `impacts` in samples; a sample is left out when it, or its partner nT
/// later, is within the samples of `guard` before or after an impact, where interpolation fails. A constant
/// difference (drift) does not count, nor do tones at the given frequencies, in cycles per sample:
/// mains hum repeats after periods of its own.
pub(super) fn waveform(
    values: &[f64],
    period: f64,
    impacts: &[f64],
    guard: [f64; 2],
    most: u32,
    hum: &[f64],
) -> Vec<WaveformClosure> {
    let open = open_samples(values.len(), impacts, guard);
    let scale = scale(values, &open);
    let hum = Hum::new(values.len(), hum);
    (1..=most)
        .filter_map(|n| {
            let lag = f64::from(n) * period;
            let partners = later(values, lag);
            let beside = open.get(whole::index(lag.round())..).unwrap_or_default();
            let weights = products(&open, &beside[..partners.len().min(beside.len())]);
            let samples = sum(&weights);
            if samples < 16.0 || !(scale > 0.0) {
                return None;
            }
            let pairs = partners.iter().zip(values).take(weights.len());
            let mut differences: Vec<f64> = pairs.map(|(later, now)| later - now).collect();
            hum.remove(&mut differences, &weights);
            weighted_mean_removed(&mut differences, &weights);
            // Interpolation smooths the noise of one of the two: make lags comparable.
            let gain = 2.0 / (1.0 + noise_gain(lag.fract()));
            let ratio = |[square, samples]: [f64; 2]| {
                (samples >= 16.0).then(|| (0.5 * gain * square / samples).sqrt() / scale)
            };
            let middle = differences.len() / 2;
            let (early, late) = differences.split_at(middle);
            let early = [dot(early, early), sum(&weights[..middle])];
            let late = [dot(late, late), sum(&weights[middle..])];
            Some(WaveformClosure {
                periods_n: n,
                ratio: ratio([early[0] + late[0], early[1] + late[1]])?,
                halves: ratio(early).zip(ratio(late)).map(Into::into),
            })
        })
        .collect()
}

/// Root mean square of a waveform about its mean, samples near impacts left out as for its closure: what its
/// noise and its closure are relative to. An acceleration's spikes do not count.
pub(super) fn size(values: &[f64], impacts: &[f64], guard: [f64; 2]) -> f64 {
    scale(values, &open_samples(values.len(), impacts, guard))
}

fn scale(values: &[f64], open: &[f64]) -> f64 {
    let mut centred = values.to_vec();
    weighted_mean_removed(&mut centred, open);
    (dot(&centred, &centred) / sum(open)).sqrt()
}

/// Values less their mean where the weight is 1, zero where it is 0.
fn weighted_mean_removed(values: &mut [f64], weights: &[f64]) {
    let mean = dot(values, weights) / sum(weights);
    let all = values.iter_mut().zip(weights);
    all.for_each(|(value, weight)| *value = (*value - mean) * weight);
}

/// A constant and tones at all samples.
struct Hum {
    /// 1, and the cosine and sine of each tone.
    columns: Vec<Vec<f64>>,
}

impl Hum {
    /// Tones in cycles per sample.
    fn new(samples: usize, tones: &[f64]) -> Self {
        let mut columns = vec![vec![1.0; samples]];
        for tone in tones {
            let turns = Turns::new(*tone, 0.0, samples);
            columns.extend([turns.cos, turns.sin]);
        }
        Self { columns }
    }

    /// Remove from values their least-squares fit of the constant and the tones where the weight is 1;
    /// nothing where the tones cannot be told apart.
    fn remove(&self, values: &mut [f64], weights: &[f64]) {
        let unknowns = self.columns.len();
        if unknowns == 1 || sum(weights) < 4.0 * unknowns as f64 {
            return;
        }
        let count = values.len();
        let columns: Vec<&[f64]> = self.columns.iter().map(|c| &c[..count]).collect();
        let weighted: Vec<Vec<f64>> = columns.iter().map(|c| products(c, weights)).collect();
        let normal = |i: usize, k: usize| dot(&weighted[i], columns[k]);
        let normal = DMatrix::from_fn(unknowns, unknowns, normal);
        let right = DVector::from_fn(unknowns, |i, _| dot(&weighted[i], values));
        if let Some(factor) = normal.cholesky() {
            let shares = factor.solve(&right);
            let all = shares.iter().zip(columns);
            all.for_each(|(share, column)| subtract(values, *share, column));
        }
    }
}

/// 1 for each sample that keeps clear of impacts, 0 beside one.
fn open_samples(count: usize, impacts: &[f64], [before, after]: [f64; 2]) -> Vec<f64> {
    let mut open = vec![1.0; count];
    for time in impacts {
        let first = whole::index((time - before).ceil().max(0.0));
        let last = whole::index((time + after).floor().max(-1.0) + 1.0);
        let last = last.min(count);
        open[first.min(last)..last].fill(0.0);
    }
    open
}

/// How many impacts fall into n drive periods, and how steadily so.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Count {
    /// Impacts in n drive periods, by majority of all windows within the record.
    pub impacts_p: u32,
    /// Fraction of windows that agree.
    pub agreement: f64,
}

/// Count impacts (times and period in one unit) in windows of n periods that are wholly within
/// the record and whose edges keep clear of impacts, so that the record's own edges never turn
/// 1 into 12/13. `None` if no window fits.
pub(super) fn count(times: &[f64], period: f64, duration: f64, periods_n: u32) -> Option<Count> {
    let length = f64::from(periods_n) * period;
    let clear = 0.02 * period;
    let step = 0.125 * period;
    let mut votes: std::collections::BTreeMap<u32, usize> = std::collections::BTreeMap::new();
    let mut start = 0.0;
    while start + length <= duration {
        let (low, high) = (start, start + length);
        let touches = times
            .iter()
            .any(|t| (t - low).abs() < clear || (t - high).abs() < clear);
        if !touches {
            let inside = u32::try_from(times.iter().filter(|t| (low..high).contains(*t)).count())
                .unwrap_or(u32::MAX);
            *votes.entry(inside).or_default() += 1;
        }
        start += step;
    }
    let windows: usize = votes.values().sum();
    let (&impacts_p, &most) = votes.iter().max_by_key(|(_, v)| **v)?;
    Some(Count {
        impacts_p,
        agreement: most as f64 / windows as f64,
    })
}

/// How well impacts close after p impacts in n drive periods.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ImpactClosure {
    /// Typical phase difference, rad (robust: 1.4826 times the median magnitude).
    pub phase_rad: f64,
    /// Typical difference of approach speeds over their mean (robust likewise); `None` without
    /// speeds.
    pub speed_ratio: Option<f64>,
    /// Pairs compared.
    pub pairs: usize,
}

/// Closure of (phase, speed) between impacts i and i + p; `None` with fewer than p + 1 impacts.
pub(super) fn impacts(impacts: &[Impact], period_s: f64, p: u32, n: u32) -> Option<ImpactClosure> {
    let lag = p as usize;
    let pairs: Vec<(&Impact, &Impact)> = impacts.iter().zip(impacts.iter().skip(lag)).collect();
    if pairs.is_empty() || lag == 0 {
        return None;
    }
    let to_phase = std::f64::consts::TAU / period_s;
    let phases: Vec<f64> = pairs
        .iter()
        .map(|(a, b)| (b.time_s - a.time_s - f64::from(n) * period_s) * to_phase)
        .collect();
    let speeds: Option<Vec<f64>> = pairs
        .iter()
        .map(|(a, b)| Some(b.approach_speed_before_m_s? - a.approach_speed_before_m_s?))
        .collect();
    let level: Vec<f64> = impacts
        .iter()
        .filter_map(|i| i.approach_speed_before_m_s)
        .collect();
    let level = robust::mean(&level).abs().max(f64::MIN_POSITIVE);
    Some(ImpactClosure {
        phase_rad: typical(&phases),
        speed_ratio: speeds.map(|s| typical(&s) / level),
        pairs: pairs.len(),
    })
}

/// 1.4826 times the median magnitude; of three or fewer, the greatest.
fn typical(differences: &[f64]) -> f64 {
    let sizes: Vec<f64> = differences.iter().map(|d| d.abs()).collect();
    if sizes.len() <= 3 {
        return sizes.iter().copied().fold(0.0, f64::max);
    }
    robust::median(&sizes).map_or(0.0, |m| 1.4826 * m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_do_not_turn_one_into_twelve_thirteenths() {
        // 12.6 periods of one impact each, at any start phase.
        for k in 0..20 {
            let shift = f64::from(k) / 20.0;
            let times: Vec<f64> = (0..13)
                .map(|i| f64::from(i) + shift)
                .filter(|t| *t < 12.6)
                .collect();
            let found = count(&times, 1.0, 12.6, 1).unwrap();
            assert_eq!(
                (found.impacts_p, found.agreement),
                (1, 1.0),
                "shift {shift}"
            );
        }
    }

    #[test]
    fn valid_a_subharmonic_closes_only_after_two_periods() {
        let values: Vec<f64> = (0..2000)
            .map(|i| f64::from(i) * std::f64::consts::TAU / 157.3)
            .map(|a| a.cos() + 0.1 * (0.5 * a).sin())
            .collect();
        let found = waveform(&values, 157.3, &[], [2.0; 2], 4, &[]);
        assert!(found[0].ratio > 0.05);
        assert!(found[1].ratio < 1e-5);
        assert!(found[3].ratio < 1e-5);
    }

    #[test]
    fn hum_does_not_look_like_a_longer_period() {
        // A drive at 14.2 Hz with hum at 50 Hz, which repeats after two drive periods by nearly a whole
        // number of its own.
        let (rate_hz, drive_hz, hum_hz) = (2000.0, 14.2, 50.0);
        let values: Vec<f64> = (0..2000)
            .map(|i| std::f64::consts::TAU * f64::from(i) / rate_hz)
            .map(|t| (drive_hz * t).cos() + 0.02 * (hum_hz * t + 1.0).cos())
            .collect();
        let period = rate_hz / drive_hz;
        let with = waveform(&values, period, &[], [2.0; 2], 2, &[]);
        assert!(with[0].ratio > 3.0 * with[1].ratio);
        let without = waveform(&values, period, &[], [2.0; 2], 2, &[hum_hz / rate_hz]);
        assert!(without.iter().all(|c| c.ratio < 1e-5), "{without:?}");
    }

    #[test]
    fn a_subharmonic_is_left_beside_hum() {
        let values: Vec<f64> = (0..2000)
            .map(|i| f64::from(i) * std::f64::consts::TAU / 157.3)
            .map(|a| a.cos() + 0.1 * (0.5 * a).sin())
            .collect();
        let found = waveform(&values, 157.3, &[], [2.0; 2], 2, &[0.025, 0.03]);
        assert!(found[0].ratio > 0.05 && found[1].ratio < 1e-5);
    }

    #[test]
    fn valid_two_unequal_impacts_close_after_their_own_number() {
        // Impacts at 0.2 and 0.7 of every period of 0.1 s with speeds 1 and 0.5.
        let list: Vec<Impact> = (0..8)
            .flat_map(|k| {
                let begin = 0.1 * f64::from(k);
                [Impact::at(begin + 0.02, 1.0), Impact::at(begin + 0.07, 0.5)]
            })
            .collect();
        let closed = impacts(&list, 0.1, 2, 1).unwrap();
        assert_eq!(closed.pairs, 14);
        assert!(closed.phase_rad < 1e-9 && closed.speed_ratio.unwrap() < 1e-9);
        // Taken as one impact in one period, phases miss by π and speeds by 0.5 of a mean of 0.75;
        // the scale for normal errors is 1.4826.
        let open = impacts(&list, 0.1, 1, 1).unwrap();
        assert!((open.phase_rad - 1.4826 * std::f64::consts::PI).abs() < 1e-6);
        assert!((open.speed_ratio.unwrap() - 1.4826 * 0.5 / 0.75).abs() < 1e-6);
        assert_eq!(impacts(&list[..1], 0.1, 1, 1), None);
    }

    #[test]
    fn valid_spikes_at_impacts_do_not_count_in_the_size_of_a_waveform() {
        // A cosine over whole periods with a spike in each: its root mean square is 1/√2.
        let value = |i: usize| match i % 100 {
            40 => -50.0,
            _ => (i as f64 * std::f64::consts::TAU / 100.0).cos(),
        };
        let values: Vec<f64> = (0..2000).map(value).collect();
        let impacts: Vec<f64> = (0..20).map(|k| 100.0 * f64::from(k) + 40.0).collect();
        let size = size(&values, &impacts, [2.5; 2]);
        assert!((size - 0.5f64.sqrt()).abs() < 0.01, "{size}");
    }

    #[test]
    fn samples_beside_impacts_are_not_open() {
        // 4.5 ± 1 closes samples 4 and 5, the first and the last impact reach over the edges.
        let open = open_samples(10, &[4.5, 0.2, 9.6], [1.0; 2]);
        let list: Vec<usize> = (0..10).filter(|i| open[*i] == 0.0).collect();
        assert_eq!(list, [0, 1, 4, 5, 9]);
    }
}
