//! Bounces under a constant force: velocity climbs steadily in flight, against friction of either
//! sign, and falls while the body touches the stop, for any number of samples.

use crate::event::impact::DetectionSource;
use crate::event::jumps::Jump;
use crate::event::kinematics::Series;
use crate::event::refine::Candidate;
use crate::signal::local_fit::LocalFit;
use crate::signal::robust;

/// Fewest samples of flight on either side of a bounce.
const FEWEST: usize = 5;
/// Drop of velocity that makes a fall a bounce, in steps of the flight and in noise deviations.
const IN_STEPS: f64 = 2.5;
const IN_NOISE: f64 = 6.0;

/// All bounces: falls of the velocity from toward the stop to away from it.
///
/// A positive velocity is toward the stop. The jump spans from the last sample before the fall to
/// the first one after it. Samples next to the fall, which a differentiated position smears, are
/// counted as part of the fall if the flights are long enough.
pub(super) fn find(velocity: &Series) -> Vec<Candidate> {
    let values = &velocity.values;
    let steps: Vec<f64> = values.windows(2).map(|w| w[1] - w[0]).collect();
    let rises: Vec<f64> = steps.iter().copied().filter(|s| *s > 0.0).collect();
    let Some(step) = robust::median(&rises) else {
        return Vec::new();
    };
    let least = (IN_STEPS * step).max(IN_NOISE * velocity.noise);
    let falls: Vec<(usize, usize)> = falls(&steps)
        .into_iter()
        .filter(|(first, last)| {
            let (before, after) = (values[*first], values[*last]);
            before > 0.0 && after < 0.0 && before - after > least
        })
        .collect();
    (0..falls.len())
        .filter_map(|i| candidate(velocity, &falls, i))
        .collect()
}

/// Runs of falling samples: (last sample before, first sample after).
fn falls(steps: &[f64]) -> Vec<(usize, usize)> {
    let mut out: Vec<(usize, usize)> = Vec::new();
    for (i, step) in steps.iter().enumerate() {
        if *step >= 0.0 {
            continue;
        }
        match out.last_mut() {
            Some(last) if last.1 == i => last.1 = i + 1,
            _ => out.push((i, i + 1)),
        }
    }
    out
}

fn candidate(velocity: &Series, falls: &[(usize, usize)], index: usize) -> Option<Candidate> {
    let count = velocity.values.len();
    let (mut left, mut right) = falls[index];
    let low = index.checked_sub(1).map_or(0, |i| falls[i].1);
    let high = falls.get(index + 1).map_or(count, |f| f.0 + 1);
    if left > low + FEWEST {
        left -= 1;
    }
    if right + FEWEST + 1 < high {
        right += 1;
    }
    if left + 1 < low + FEWEST || right + FEWEST > high {
        return None;
    }
    let middle = 0.5 * (left + right) as f64;
    let before = LocalFit::new(
        &velocity.values,
        low.max(left.saturating_sub(5)),
        left + 1,
        1,
    )?;
    let after = LocalFit::new(&velocity.values, right, high.min(right + 6), 1)?;
    let spread = before
        .error_factor(middle)
        .hypot(after.error_factor(middle));
    let jump = Jump {
        left,
        gap: right - left,
        height: after.value(middle) - before.value(middle),
        error: (velocity.noise * spread).max(f64::MIN_POSITIVE),
    };
    Some(Candidate {
        jump,
        source: DetectionSource::Velocity,
        dead_samples: 0.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_bounces_of_two_samples_are_found_between_straight_flights() {
        // Flights of 40 samples from −0.4 by 0.02 per sample, one sample of contact at 0 between.
        let value = |i: usize| match i % 41 {
            40 => 0.0,
            k => -0.4 + 0.02 * k as f64,
        };
        let velocity = Series::clean((0..164).map(value).collect());
        let found = find(&velocity);
        assert_eq!(found.len(), 3);
        // Falls from sample 39 to 41; the neighbours 38 and 42 bound the jump.
        let jump = found[0].jump;
        assert_eq!((jump.left, jump.gap), (38, 4));
        // At sample 40 the flight before reaches 0.4, the one after starts at −0.42.
        assert!((jump.height + 0.82).abs() < 1e-9, "{}", jump.height);
        assert_eq!(found[2].jump.left, 120);
    }

    #[test]
    fn flights_without_a_fall_hold_no_bounce() {
        let climbing = Series::clean((0..80).map(|i| 0.02 * f64::from(i) - 0.4).collect());
        assert!(find(&climbing).is_empty());
    }
}
