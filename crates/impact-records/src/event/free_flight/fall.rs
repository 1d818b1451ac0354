//! Falls of the approach velocity: where it drops faster than any flight changes it.

use crate::event::kinematics::Series;
use crate::signal::robust;

/// Drop that makes a fall, in changes that are usual over as many samples.
const IN_USUAL: f64 = 2.5;
/// Drop that makes a fall, in standard deviations of its noise.
const IN_NOISE: f64 = 6.0;
/// Drop that makes a fall, as a share of the greatest speed.
const OF_GREATEST: f64 = 0.04;
/// Longest lag over which drops are looked for, samples.
const LONGEST_LAG: usize = 64;

/// A fall of the approach velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Fall {
    /// Last sample before it.
    pub first: usize,
    /// First sample after it.
    pub last: usize,
}

/// All falls that begin while the bodies approach, in order of time.
///
/// A positive velocity is an approach. Drops are looked for over one sample, then over two, four …,
/// so that a contact of any duration is found, and one that noise hides between neighbours.
pub(super) fn find(velocity: &Series) -> Vec<Fall> {
    let values = &velocity.values;
    let greatest = values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let mut falling = vec![false; values.len().saturating_sub(1)];
    let mut lag = 1;
    while lag <= LONGEST_LAG && 8 * lag < values.len().max(9) {
        mark(values, lag, (velocity.noise, greatest), &mut falling);
        lag *= 2;
    }
    runs(&falling)
        .into_iter()
        .filter(|fall| values[fall.first] > 0.0)
        .collect()
}

/// Mark the steps of drops over a lag that touch none that is marked already.
fn mark(values: &[f64], lag: usize, (noise, greatest): (f64, f64), falling: &mut [bool]) {
    let drops: Vec<f64> = (lag..values.len())
        .map(|i| values[i - lag] - values[i])
        .collect();
    let sizes: Vec<f64> = drops.iter().map(|d| d.abs()).filter(|d| *d > 0.0).collect();
    let Some(usual) = robust::median(&sizes) else {
        return;
    };
    let least = (IN_USUAL * usual)
        .max(IN_NOISE * noise * std::f64::consts::SQRT_2)
        .max(OF_GREATEST * greatest);
    let known = falling.to_vec();
    for (i, drop) in drops.iter().enumerate() {
        let beside = i.saturating_sub(2)..(i + lag + 2).min(known.len());
        if *drop > least && !known[beside].contains(&true) {
            falling[i..i + lag].fill(true);
        }
    }
}

/// Runs of falling steps; one step between two of them belongs to both.
fn runs(falling: &[bool]) -> Vec<Fall> {
    let mut out: Vec<Fall> = Vec::new();
    for i in (0..falling.len()).filter(|i| falling[*i]) {
        match out.last_mut() {
            Some(fall) if i <= fall.last + 1 => fall.last = i + 1,
            _ => out.push(Fall {
                first: i,
                last: i + 1,
            }),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounces_are_found_between_straight_flights() {
        // Flights of 40 samples from −0.4 by 0.02 per sample, one sample of contact at 0 between.
        let value = |i: usize| match i % 41 {
            40 => 0.0,
            k => -0.4 + 0.02 * k as f64,
        };
        let found = find(&Series::clean((0..164).map(value).collect()));
        let ends: Vec<_> = found.iter().map(|f| (f.first, f.last)).collect();
        // The last sample is one of contact too.
        assert_eq!(ends, [(39, 41), (80, 82), (121, 123), (162, 163)]);
    }

    #[test]
    fn flights_without_a_fall_and_a_body_that_brakes_hold_none() {
        let climbing = Series::clean((0..80).map(|i| 0.02 * f64::from(i) - 0.4).collect());
        assert!(find(&climbing).is_empty());
        let rolling = Series::clean((0..80).map(|i| 0.5 - 1e-3 * f64::from(i)).collect());
        assert!(find(&rolling).is_empty());
    }

    #[test]
    fn a_fall_that_noise_hides_between_neighbours_is_found_over_a_longer_lag() {
        // ±0.02 of noise on a fall from 0.1 to −0.1 over eight samples.
        let scatter = |i: usize| 0.02 * (i as f64 * 2.399_963).sin() * std::f64::consts::SQRT_2;
        let value = |i: usize| 0.1 - 0.2 * ((i as f64 - 96.0) / 8.0).clamp(0.0, 1.0);
        let mut series = Series::clean((0..200).map(|i| value(i) + scatter(i)).collect());
        series.noise = 0.02;
        let found = find(&series);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].first.abs_diff(96) <= 8 && found[0].last.abs_diff(104) <= 8);
    }
}
