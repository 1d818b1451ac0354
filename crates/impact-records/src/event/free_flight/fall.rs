//! Falls of the approach velocity: where it drops faster than any flight changes it.
//!
//! The velocity goes down from a turning point to the next one; the fall is the part of that leg which is
//! steep beside its steepest quarter, however many samples a contact takes, whatever noise is on it.

use crate::event::contact_profile::ContactProfile;
use crate::event::kinematics::Series;
use crate::signal::{robust, whole};

/// Drop that makes a fall, in changes that are usual over as many samples.
const IN_USUAL: f64 = 2.5;
/// Drop that makes a fall, in standard deviations of its noise.
const IN_NOISE: f64 = 6.0;
/// Drop that makes a fall, as a share of the greatest speed.
const OF_GREATEST: f64 = 0.04;
/// Longest lag over which the usual changes are looked for, samples.
const LONGEST_LAG: usize = 64;
/// Part of a drop by which its steepest part is told.
const STEEPEST: f64 = 0.25;
/// Rate, over that of the steepest part, which still belongs to a fall: a contact as a half-sine of force is
/// above it but for 3 % of its duration.
const STEEP: f64 = 0.1;

/// Parts of a fall, in none of which it stands still.
const PARTS: f64 = 4.0;

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
/// A positive velocity is an approach. `greatest_m_s`: the greatest speed, but for faults.
pub(super) fn find(velocity: &Series, greatest_m_s: f64) -> Vec<Fall> {
    let values = &velocity.values;
    let least = (IN_NOISE * velocity.noise * std::f64::consts::SQRT_2)
        .max(OF_GREATEST * greatest_m_s)
        .max(f64::MIN_POSITIVE);
    let usual = usual(values);
    let mut falls: Vec<Fall> = Vec::new();
    let mut parts = legs(values, least);
    while let Some(part) = parts.pop() {
        let Some(fall) = steep(values, part) else {
            continue;
        };
        let drop = values[fall.first] - values[fall.last];
        if drop <= least {
            continue;
        }
        if let Some(middle) = flat(values, fall).filter(|_| drop > PARTS * least) {
            parts.extend([(part.0, middle), (middle, part.1)]);
            continue;
        }
        if drop > usual_over(&usual, fall.last - fall.first) && values[fall.first] > 0.0 {
            falls.push(fall);
        }
        let beside = [(part.0, fall.first), (fall.last, part.1)];
        parts.extend(
            beside
                .iter()
                .filter(|(a, b)| values[*a] - values[*b] > least),
        );
    }
    falls.sort_by_key(|fall| fall.first);
    falls
}

/// Legs that go down, from a turning point to the next: between them the velocity rises by more than a least
/// change.
fn legs(values: &[f64], least: f64) -> Vec<(usize, usize)> {
    let mut out = Vec::new();
    let (mut top, mut bottom, mut falling) = (0, 0, false);
    for (i, value) in values.iter().enumerate() {
        if falling {
            if *value < values[bottom] {
                bottom = i;
            } else if value - values[bottom] > least {
                out.push((top, bottom));
                (top, falling) = (i, false);
            }
        } else if *value >= values[top] {
            top = i;
        } else if values[top] - value > least {
            (bottom, falling) = (i, true);
        }
    }
    if falling {
        out.push((top, bottom));
    }
    out
}

/// The part of a leg whose drop, less what a slow change takes in as many samples, is the greatest.
fn steep(values: &[f64], (top, bottom): (usize, usize)) -> Option<Fall> {
    let own = values.get(top..=bottom)?;
    let drop = own.first()? - own.last()?;
    let mut lags = std::iter::successors(Some(1), |lag| Some(lag + lag / 4 + 1));
    let shortest = lags.find(|lag| {
        let mut drops = own.windows(lag + 1).map(|w| w[0] - w[*lag]);
        *lag >= own.len() || drops.any(|d| d >= STEEPEST * drop)
    })?;
    let slow = STEEP * STEEPEST * drop / shortest as f64;
    let (mut begin, mut highest) = (0, own[0]);
    let (mut best, mut found) = (0.0, None);
    for (i, value) in own.iter().enumerate() {
        let level = value + slow * i as f64;
        if level >= highest {
            (begin, highest) = (i, level);
        } else if highest - level > best {
            best = highest - level;
            found = Some((begin, i));
        }
    }
    found.map(|(first, last)| Fall {
        first: top + first,
        last: top + last,
    })
}

/// Differences of displacements, summed over bodies, m per sample.
pub(super) fn differences(bodies: &[&[f64]], i: usize) -> f64 {
    let of = |body: &&[f64]| 0.5 * (body[i + 1] - body[i - 1]);
    bodies.iter().map(of).sum()
}

/// The fall of the differences of displacements beside a fall of the velocities that were measured with them.
pub(super) fn of_displacements(bodies: &[&[f64]], fall: Fall) -> Option<Fall> {
    let beside = fall.last - fall.first;
    let from = fall.first.saturating_sub(beside).max(1);
    let ends = bodies.iter().map(|body| body.len()).min()?;
    let to = (fall.last + beside + 1).min(ends.checked_sub(1)?);
    let own: Vec<f64> = (from..to).map(|i| differences(bodies, i)).collect();
    let found = steep(&own, (0, own.len().checked_sub(1)?))?;
    Some(Fall {
        first: from + found.first,
        last: from + found.last,
    })
}

/// Places at which the profile of a contact is asked for what a fall shows of it.
const PLACES: usize = 100;

/// Share of a contact that its fall shows: where it is steep beside its steepest part, and further from either end than what
/// noise hides of the drop.
pub(super) fn seen(profile: &ContactProfile, hidden: f64) -> f64 {
    let places = 0..=PLACES;
    let left: Vec<f64> = places
        .map(|i| 1.0 - profile.done(i as f64 / PLACES as f64))
        .collect();
    let apart = left.iter().filter(|l| **l > hidden && **l < 1.0 - hidden);
    let apart = (apart.count() + 1).min(PLACES);
    let fall = steep(&left, (0, PLACES)).map_or(PLACES, |fall| fall.last - fall.first);
    fall.min(apart) as f64 / PLACES as f64
}

/// Where a fall hardly falls over a part of its samples: it is two, one after the other.
fn flat(values: &[f64], fall: Fall) -> Option<usize> {
    let part = (fall.last - fall.first) / whole::index(PARTS);
    let own = values.get(fall.first..=fall.last).filter(|_| part > 1)?;
    let usual = (own.first()? - own.last()?) / PARTS;
    let drops = own.windows(part + 1).map(|w| w[0] - w[part]);
    let (at, least) = drops.enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
    (least < STEEP * usual).then_some(fall.first + at + part / 2)
}

/// Drops that are no falls over lags of 1, 2, 4 … samples: by the changes usual over them, and by their noise.
fn usual(values: &[f64]) -> Vec<f64> {
    let lags = std::iter::successors(Some(1), |lag| Some(2 * lag));
    let lags = lags.take_while(|lag| *lag <= LONGEST_LAG && 8 * lag < values.len().max(9));
    let of = |lag: usize| {
        let drops: Vec<f64> = values.windows(lag + 1).map(|w| w[0] - w[lag]).collect();
        let sizes: Vec<f64> = drops.iter().map(|d| d.abs()).collect();
        let usual = IN_USUAL * robust::median(&sizes).unwrap_or(0.0);
        usual.max(IN_NOISE * robust::robust_deviation(&drops).unwrap_or(0.0))
    };
    lags.map(of).collect()
}

/// The same over any number of samples: beyond the longest lag in proportion.
fn usual_over(usual: &[f64], samples: usize) -> f64 {
    let place = whole::index((samples.max(1) as f64).log2().floor());
    let place = place.min(usual.len().saturating_sub(1));
    let longer = samples as f64 / (1usize << place) as f64;
    usual.get(place).map_or(0.0, |u| u * longer.max(1.0))
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
        let found = find(&Series::clean((0..164).map(value).collect()), 0.4);
        let ends: Vec<_> = found.iter().map(|f| (f.first, f.last)).collect();
        // The last sample is one of contact too.
        assert_eq!(ends, [(39, 41), (80, 82), (121, 123), (162, 163)]);
    }

    #[test]
    fn flights_without_a_fall_and_a_body_that_brakes_hold_none() {
        let climbing = Series::clean((0..80).map(|i| 0.02 * f64::from(i) - 0.4).collect());
        assert!(find(&climbing, 1.2).is_empty());
        let rolling = Series::clean((0..80).map(|i| 0.5 - 1e-3 * f64::from(i)).collect());
        assert!(find(&rolling, 0.5).is_empty());
    }

    #[test]
    fn a_fall_that_noise_hides_between_neighbours_is_found_over_a_longer_lag() {
        // ±0.02 of noise on a fall from 0.1 to −0.1 over eight samples.
        let scatter = |i: usize| 0.02 * (i as f64 * 2.399_963).sin() * std::f64::consts::SQRT_2;
        let value = |i: usize| 0.1 - 0.2 * ((i as f64 - 96.0) / 8.0).clamp(0.0, 1.0);
        let mut series = Series::clean((0..200).map(|i| value(i) + scatter(i)).collect());
        series.noise = 0.02;
        let found = find(&series, 0.1);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].first.abs_diff(96) <= 8 && found[0].last.abs_diff(104) <= 8);
    }
}
