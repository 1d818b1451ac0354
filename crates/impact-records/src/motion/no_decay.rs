//! Why a record shows no free decay.

use crate::record::Problem;
use crate::signal::decay::{self, Watched};
use crate::signal::robust;
use crate::signal::swings::are_swings;

/// Size of an oscillation in the last third of a record over that in the first, from which it grows.
const GROWS: f64 = 1.5;
/// Turns of it, at least.
const TURNS: f64 = 3.0;

/// Why channels of motion show no free decay.
pub(super) fn cause(shown: &[Watched<'_>]) -> Problem {
    if shown.iter().any(decay::comes_to_rest) {
        return Problem::ComesToRest;
    }
    let values = || shown.iter().map(|channel| channel.values);
    let listed = || values().find(|v| are_swings(v));
    let listed = || listed().map(|all| Problem::SwingsListed { count: all.len() });
    let found = listed().or_else(|| values().find_map(grows));
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

#[cfg(test)]
mod tests {
    use super::*;

    fn cause_of(values: &[f64]) -> Problem {
        assert!(decay::fit(values, 100.0).is_none());
        cause(&[Watched::displacement(values)])
    }

    #[test]
    fn amplitudes_of_swings_and_growth_are_named() {
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
    }

    #[test]
    fn noise_does_not_grow() {
        let noise: Vec<f64> = (0..500u32)
            .map(|i| (2.399_963 * f64::from(i * i)).sin() * (1.0 + 0.004 * f64::from(i)))
            .collect();
        assert_eq!(grows(&noise), None);
    }
}
