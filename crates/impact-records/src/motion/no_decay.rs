//! Why a record shows no free decay.

use crate::record::Problem;
use crate::signal::decay::{self, Watched};
use crate::signal::swings::are_swings;
use crate::signal::{columns, robust};

/// Size of an oscillation in the last third of a record over that in the first, from which it grows.
const GROWS: f64 = 1.5;
/// Turns of it, at least.
const TURNS: f64 = 3.0;
/// Share of the range by which readings jump that begin again at its other end, by which they move at most in some steps before and
/// after, and how many those are: of a motion with few samples a period some are as far.
const JUMPS: f64 = 0.7;
const MOVES: f64 = 0.2;
const BESIDE: usize = 3;

/// Why channels of motion show no free decay.
pub(super) fn cause(shown: &[Watched<'_>]) -> Problem {
    if shown.iter().any(decay::comes_to_rest) {
        return Problem::ComesToRest;
    }
    let values = || shown.iter().map(|channel| channel.values);
    let listed = || values().find(|v| are_swings(v));
    let listed = || listed().map(|all| Problem::SwingsListed { count: all.len() });
    let found = values().find_map(wraps).or_else(listed);
    let found = found.or_else(|| values().find_map(grows));
    found.unwrap_or(Problem::NoDecayFound)
}

/// An oscillation that grows from third to third of a record.
fn grows(values: &[f64]) -> Option<Problem> {
    let third = values.len() / 3;
    let sizes = values.chunks_exact(third.max(1)).take(3);
    let sizes: Vec<f64> = sizes.map(robust::rms_about_mean).collect();
    let [first, middle, last] = sizes[..] else {
        return None;
    };
    let rest = robust::median(values)?;
    let crosses = |w: &&[f64]| (w[0] - rest) * (w[1] - rest) < 0.0;
    let crossings = values.windows(2).filter(crosses).count();
    // noise crosses rest at every other sample
    let turns = (TURNS..values.len() as f64 / 8.0).contains(&(0.5 * crossings as f64));
    let grows = first < middle && middle < last && last > GROWS * first && turns;
    let times = last / first;
    grows.then_some(Problem::MotionGrows { times })
}

/// Readings that begin again at the other end of their range: they jump against the way that they go before and after.
fn wraps(values: &[f64]) -> Option<Problem> {
    let (low, high) = columns::extremes(values);
    let range = high - low;
    let steps: Vec<f64> = values.windows(2).map(|w| w[1] - w[0]).collect();
    let jumps = |steps: &&[f64]| {
        let (before, after) = (&steps[..BESIDE], &steps[BESIDE + 1..]);
        let jump = steps[BESIDE];
        let slow = before.iter().chain(after).all(|s| s.abs() < MOVES * range);
        let back = before[BESIDE - 1] * jump < 0.0 && after[0] * jump < 0.0;
        jump.abs() > JUMPS * range && slow && back
    };
    let around = || steps.windows(2 * BESIDE + 1);
    let sample = around().position(|w| jumps(&w))? + BESIDE;
    let count = around().filter(jumps).count();
    Some(Problem::ReadingsWrap { count, sample })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cause_of(values: &[f64]) -> Problem {
        assert!(decay::fit(values, 100.0).is_none());
        cause(&[Watched::displacement(values)])
    }

    #[test]
    fn amplitudes_of_swings_growth_and_wraps_are_named() {
        let fall = |k: i32| 42.0 * 0.924_f64.powi(k);
        let listed: Vec<f64> = (0..25).map(fall).collect();
        let swings = cause_of(&listed);
        assert!(matches!(swings, Problem::SwingsListed { count: 25 }));
        let in_turn: Vec<f64> = (0..25)
            .map(|k| fall(k) * f64::from(1 - 2 * (k % 2)))
            .collect();
        assert!(are_swings(&in_turn) && !are_swings(&[1.0, 2.0, 3.0, 4.0]));
        let turn = |i: u32| std::f64::consts::TAU * 0.01 * f64::from(i);
        let grows: Vec<f64> = (0..2000)
            .map(|i| (0.01 * turn(i)).exp() * turn(i).cos())
            .collect();
        assert!(matches!(cause_of(&grows), Problem::MotionGrows { .. }));
        let angle = |i: u32| 500.0 * (-0.03 * turn(i) / 8.0).exp() * (turn(i) / 8.0).cos();
        let wrapped: Vec<f64> = (0..4000).map(|i| angle(i).rem_euclid(360.0)).collect();
        assert!(matches!(
            wraps(&wrapped),
            Some(Problem::ReadingsWrap { .. })
        ));
    }

    #[test]
    fn noise_spikes_and_levels_are_neither_growth_nor_wraps() {
        let noise: Vec<f64> = (0..500u32)
            .map(|i| (2.399_963 * f64::from(i * i)).sin() * (1.0 + 0.004 * f64::from(i)))
            .collect();
        assert_eq!(grows(&noise), None);
        let quiet = |i: usize| 0.01 * noise[i % 500];
        let spike: Vec<f64> = (0..800)
            .map(|i| if i % 300 == 200 { 5.0 } else { quiet(i) })
            .collect();
        assert_eq!(wraps(&spike), None);
        let levels: Vec<f64> = (0..800).map(|i| f64::from(i / 100 % 2 * 5)).collect();
        assert_eq!(wraps(&levels), None);
        // from three to five samples a period
        for k in 60..100 {
            let fast = |i: usize| (std::f64::consts::TAU * i as f64 / (0.05 * f64::from(k))).cos();
            let decay: Vec<f64> = (0..400)
                .map(|i| fast(i) * (-0.01 * i as f64).exp())
                .collect();
            assert_eq!(wraps(&decay), None, "{k}");
        }
    }
}
