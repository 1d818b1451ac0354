//! Harmonics of a velocity: a periodic motion with impacts has many, one without impacts few.
//!
//! An impact makes the velocity jump, and the harmonics of a jump fall with their order alone. Without impacts a
//! drive that is distorted by the shares that rigs have, and a spring that hardens, leave a hundredth of the
//! fundamental; one harmonic more where it is near the resonance, and that one is left out.

use crate::event::Series;
use crate::signal::columns::dot;
use crate::signal::turns::Turns;
use crate::signal::whole;

/// The first and the last order that is looked at.
const ORDERS: [u32; 2] = [2, 6];
/// Fewest orders that tell.
const FEWEST: u32 = 3;
/// Root of the sum of their squares over the fundamental, without the greatest, from which impacts make them:
/// ten times what a distorted drive leaves.
const OF_IMPACTS: f64 = 0.1;
/// Standard errors by which they exceed it.
const SURE: f64 = 5.0;

/// Whether a velocity that repeats after `period` samples has the harmonics of a motion with impacts, beyond its
/// noise.
pub(super) fn are_of_impacts(velocity: &Series, period: f64) -> bool {
    let samples = velocity.values.len();
    let periods = (samples as f64 / period).floor();
    let count = whole::index((periods * period).round()).min(samples);
    // those that a period has samples enough for
    let [first, last] = ORDERS;
    let last = last.min(whole::count((0.5 * period).floor()).saturating_sub(1));
    if periods < 1.0 || last + 1 < first + FEWEST {
        return false;
    }
    let orders = first..=last;
    let values = &velocity.values[..count];
    let shown = |order: u32| velocity.shown_at(f64::from(order) / period);
    let amplitude = |order: u32| {
        let turns = Turns::new(f64::from(order) / period, 0.0, count);
        2.0 / count as f64 * dot(&turns.cos, values).hypot(dot(&turns.sin, values)) / shown(order).0
    };
    let squares: Vec<f64> = orders
        .clone()
        .map(|order| amplitude(order).powi(2))
        .collect();
    let greatest = squares.iter().copied().fold(0.0, f64::max);
    let others = (squares.iter().sum::<f64>() - greatest).max(0.0).sqrt();
    let noise = orders.map(|order| {
        let (part, noise) = shown(order);
        (noise / part).powi(2)
    });
    let error = (2.0 / count as f64 * noise.sum::<f64>()).sqrt();
    others > OF_IMPACTS * amplitude(1) + SURE * error
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Role;

    const PERIOD: f64 = 163.4;

    fn velocity(at: impl Fn(f64) -> f64) -> Series {
        let turn = |i: u32| std::f64::consts::TAU * f64::from(i) / PERIOD;
        Series::clean((0..2000).map(|i| at(turn(i))).collect())
    }

    #[test]
    fn a_jump_a_period_has_the_harmonics_of_impacts_and_a_distorted_tone_has_not() {
        // a jump of the velocity, from one impact a period
        let jumps = velocity(|turn| turn.cos() + ((turn / std::f64::consts::TAU).fract() - 0.5));
        assert!(are_of_impacts(&jumps, PERIOD));
        // one harmonic at the resonance, others as of a distorted drive
        let tone = velocity(|turn| {
            turn.cos()
                + 0.3 * (2.0 * turn).cos()
                + 0.02 * (3.0 * turn).sin()
                + 0.01 * (4.0 * turn).cos()
        });
        assert!(!are_of_impacts(&tone, PERIOD));
        // harmonics that are no larger than noise makes them
        let noisy = Series {
            noise: 0.3,
            ..jumps
        };
        assert!(!are_of_impacts(&noisy, PERIOD));
        // the same noise of a difference of displacements is at higher frequencies
        let differentiated = Series {
            role: Role::DisplacementX,
            ..noisy
        };
        assert!(are_of_impacts(&differentiated, PERIOD));
    }

    #[test]
    fn valid_differences_of_few_samples_in_a_period_show_the_harmonics_that_the_motion_has() {
        // over 18 samples in a period the fifth harmonic of a velocity is half shown
        let period = 18.3;
        let displacement = |t: f64| {
            let orders = (1..=6).map(f64::from);
            orders.map(|k| (k * t).sin() / (k * k * k)).sum::<f64>()
        };
        let turn = |i: i32| std::f64::consts::TAU * f64::from(i) / period;
        let difference = |i: i32| 0.5 * (displacement(turn(i + 1)) - displacement(turn(i - 1)));
        let velocity = Series {
            role: Role::DisplacementX,
            noise: 1e-6,
            ..Series::clean((0..2000).map(difference).collect())
        };
        let shown = |order: f64| velocity.shown_at(order / period).0;
        assert!((shown(5.0) - 0.577).abs() < 1e-3 && shown(1.0) > 0.98);
        // their squares without the greatest, that of order two, over the fundamental
        let others = (3..=6).map(|k| f64::from(k).powi(-4)).sum::<f64>().sqrt();
        assert!(others > OF_IMPACTS && are_of_impacts(&velocity, period));
    }
}
