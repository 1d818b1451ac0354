//! Lone samples of a motion channel that are far off those around them: electrical interference, or errors of the
//! converter or of the transmission.

use super::{Channel, Flag, Problem, Role};
use crate::signal::{columns, robust};

/// How far off the middle of its neighbours a sample is, over what is usual (1.5 times the median), from which it is
/// no motion and no noise.
const UNUSUAL: f64 = 10.0;
/// The same over the channel's deviation from its mean: what is less does no harm.
const HARMFUL: f64 = 0.2;
/// Part of that by which the neighbours differ at most, and by which the samples next to them are off: a velocity that
/// jumps stays on the other side, and what rings is off there as well.
const LONE: f64 = 0.25;
/// Part of the samples from which on this is no interference but the signal.
const MOST: f64 = 0.02;

/// Replace lone samples that are far off by the middle of those beside them. An acceleration has such at impacts.
pub(super) fn without_spikes(channel: &mut Channel) -> Option<Flag> {
    let moves = matches!(
        channel.role,
        Role::VelocityX | Role::VelocityY | Role::DisplacementX | Role::DisplacementY
    );
    let found = if moves {
        spikes(&channel.values)
    } else {
        Vec::new()
    };
    let first = *found.first()?;
    for i in &found {
        channel.values[*i] = f64::midpoint(channel.values[i - 1], channel.values[i + 1]);
    }
    let problem = Problem::LoneSpikes {
        channel: channel.name.clone(),
        count: found.len(),
        first,
    };
    Some(Flag::new(Some(&channel.name), problem).excluding(false))
}

/// The samples that are spikes; none where they are too many.
fn spikes(values: &[f64]) -> Vec<usize> {
    let harmful = HARMFUL * robust::rms_about_mean(values);
    let off = |i: usize| (values[i] - f64::midpoint(values[i - 1], values[i + 1])).abs();
    let lone = |i: &usize| {
        let size = off(*i);
        let beside = (values[i + 1] - values[i - 1]).abs();
        size > harmful && beside.max(off(i - 2)).max(off(i + 2)) < LONE * size
    };
    let mut found: Vec<usize> = (3..values.len().saturating_sub(3)).filter(lone).collect();
    if found.is_empty() {
        return found;
    }
    let all: Vec<f64> = (1..values.len() - 1).map(off).collect();
    let (low, high) = columns::extremes(values);
    let step = columns::least_step(values, 1e-12 * (high - low));
    let usual = (1.5 * robust::median(&all).unwrap_or(0.0)).max(step);
    found.retain(|i| off(*i) > UNUSUAL * usual);
    if found.len() as f64 > MOST * values.len() as f64 {
        found.clear();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Record;

    /// A velocity that oscillates, jumps by 2 every 40 samples, rings behind each jump by a part and is noisy.
    fn velocity(ringing: f64) -> Vec<f64> {
        let noise = |i: i32| 0.01 * (f64::from(i * i % 37) / 18.0 - 1.0);
        let one = |i: i32| {
            let since = f64::from(i % 40);
            let rings = ringing * (1.0 - 2.0 * f64::from(i % 2)) * (-0.3 * since).exp();
            1.0 - 0.05 * (40.0 - since) + rings + noise(i)
        };
        (0..400).map(one).collect()
    }

    #[test]
    fn lone_samples_far_off_are_replaced_and_jumps_and_ringing_are_not() {
        for ringing in [0.0, 0.3, 1.0] {
            assert!(spikes(&velocity(ringing)).is_empty(), "{ringing}");
        }
        let mut values = velocity(0.0);
        let whole = values.clone();
        values[57] += 3.0;
        values[218] -= 2.0;
        let channel = |role| {
            Record::of(2000.0, &[(role, &values)])
                .channels
                .swap_remove(0)
        };
        let mut velocity = channel(Role::VelocityX);
        let flag = without_spikes(&mut velocity).expect("a flag");
        assert!(!flag.excludes);
        let left = velocity.values.iter().zip(&whole);
        assert!(left.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 0.03);
        // an acceleration may
        assert_eq!(without_spikes(&mut channel(Role::AccelerationX)), None);
    }

    #[test]
    fn a_coarse_converter_makes_no_spikes() {
        let values: Vec<f64> = (0..400).map(|i| f64::from(i * 7 % 50 / 25)).collect();
        assert!(spikes(&values).is_empty());
        let still: Vec<f64> = (0..400).map(|i| f64::from(u8::from(i % 9 == 0))).collect();
        assert!(spikes(&still).is_empty());
    }
}
