//! Harmonics of a velocity: a periodic motion with impacts has many, one without impacts few.
//!
//! An impact makes the velocity jump, and the harmonics of a jump fall with their order alone. Without impacts a
//! drive that is distorted by the shares that rigs have, and a spring that hardens, leave a hundredth of the
//! fundamental; one harmonic more where it is near the resonance, and that one is left out.

use crate::event::Series;
use crate::signal::columns::dot;
use crate::signal::turns::Turns;
use crate::signal::whole;

/// Orders that are looked at.
const ORDERS: std::ops::RangeInclusive<u32> = 2..=6;
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
    if periods < 1.0 || period < f64::from(2 * ORDERS.end() + 2) {
        return false;
    }
    let values = &velocity.values[..count];
    let amplitude = |order: u32| {
        let turns = Turns::new(f64::from(order) / period, 0.0, count);
        2.0 / count as f64 * dot(&turns.cos, values).hypot(dot(&turns.sin, values))
    };
    let squares: Vec<f64> = ORDERS.map(|order| amplitude(order).powi(2)).collect();
    let greatest = squares.iter().copied().fold(0.0, f64::max);
    let others = (squares.iter().sum::<f64>() - greatest).max(0.0).sqrt();
    let noise = ORDERS.map(|order| velocity.noise_at(f64::from(order) / period).powi(2));
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
}
