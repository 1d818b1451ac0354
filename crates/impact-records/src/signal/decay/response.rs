//! The response q of an oscillator to dry friction: how a motion under it differs from the viscous one.

use nalgebra::Complex;

use super::shape::Rates;
use super::watched::MotionSignal;
use crate::signal::whole;

/// Rate λ = −σ + i`ω_d` of a fit.
pub(super) fn rate(rates: &Rates) -> Complex<f64> {
    Complex::new(-rates[1], rates[0])
}

/// Complex amplitude at the first sample of the displacement whose derivative the amplitudes of cosine and sine describe.
pub(super) fn displacement(
    [a, b]: [f64; 2],
    rates: &Rates,
    quantity: MotionSignal,
) -> Complex<f64> {
    Complex::new(a, -b) * rate(rates).powi(-(quantity as i32))
}

/// Time of a turning point near the first sample, after which the velocity is negative.
pub(super) fn turning(amplitudes: [f64; 2], rates: &Rates, quantity: MotionSignal) -> f64 {
    let velocity = displacement(amplitudes, rates, quantity) * rate(rates);
    let phase = std::f64::consts::FRAC_PI_2 - velocity.arg();
    let turn = std::f64::consts::TAU;
    (phase - turn * (phase / turn).round()) / rates[0]
}

/// The response q to friction of the displacement one, at rest at its turning points.
pub(super) struct Response {
    rates: Rates,
    quantity: MotionSignal,
    /// Displacement at turning points; the one at the time that the rates name has the number `named`.
    pub(super) turns: Vec<f64>,
    named: usize,
    /// The first swing in which there is friction.
    begins: usize,
}

impl Response {
    /// From a sample before the first one to a last time, in samples, to friction that acts all the time.
    pub(super) fn of(rates: Rates, quantity: MotionSignal, last: f64) -> Self {
        Self::from(0, rates, quantity, last)
    }

    /// The same to friction from a number of swings after the named turning point on; all the time from none.
    fn from(swings: usize, rates: Rates, quantity: MotionSignal, last: f64) -> Self {
        let [omega, sigma, _, begin] = rates;
        let half = std::f64::consts::PI / omega;
        let left = (-sigma * half).exp();
        let named = whole::index(((1.0 + begin) / half).ceil().max(0.0));
        let later = whole::index(((last - begin) / half).ceil().max(0.0));
        let mut own = Self {
            rates,
            quantity,
            turns: vec![0.0; named + later + 1],
            named,
            begins: if swings == 0 { 0 } else { named + swings },
        };
        for k in (own.begins..named).rev() {
            let about = own.about(k);
            own.turns[k] = about + (about - own.turns[k + 1]) / left;
        }
        for k in named.max(own.begins)..named + later {
            let about = own.about(k);
            own.turns[k + 1] = about - (own.turns[k] - about) * left;
        }
        own
    }

    /// Equilibrium of a swing: against a velocity that is negative after the named turning point.
    fn about(&self, swing: usize) -> f64 {
        if swing.abs_diff(self.named).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        }
    }

    /// Time of a turning point, in samples.
    pub(super) fn turn(&self, swing: usize) -> f64 {
        let [omega, _, _, begin] = self.rates;
        begin + (swing as f64 - self.named as f64) * std::f64::consts::PI / omega
    }

    /// The swing to which a time belongs.
    fn swing(&self, t: f64) -> usize {
        let [omega, _, _, begin] = self.rates;
        let number = (t - begin) * omega / std::f64::consts::PI + self.named as f64;
        whole::index(number.floor().max(0.0)).min(self.turns.len() - 1)
    }

    /// The part of a swing that decays, Re(z e^{λt}): z and what is added to it.
    fn swung(&self, swing: usize) -> (Complex<f64>, f64) {
        if swing < self.begins {
            return (Complex::ZERO, 0.0);
        }
        let [omega, sigma, ..] = self.rates;
        let about = self.about(swing);
        let size = self.turns[swing] - about;
        let squared = omega * omega + sigma * sigma;
        match self.quantity {
            MotionSignal::Displacement => (size * Complex::new(1.0, -sigma / omega), about),
            MotionSignal::Velocity => (Complex::new(0.0, size * squared / omega), 0.0),
            MotionSignal::Acceleration => (-size * squared * Complex::new(1.0, sigma / omega), 0.0),
        }
    }

    /// e^{λt} at a time of a swing, in samples.
    fn grown(&self, t: f64, swing: usize) -> Complex<f64> {
        (rate(&self.rates) * (t - self.turn(swing))).exp()
    }

    /// At a time of a swing, in samples.
    fn at(&self, t: f64, swing: usize) -> f64 {
        let (size, added) = self.swung(swing);
        added + (size * self.grown(t, swing)).re
    }

    /// Means over as many samples as those of a series, whose swings are those of a response of near rates. Within a swing
    /// the mean over a sample's parts is the value in its middle but for a factor.
    fn means(&self, swings: &Self, series: &Means) -> Vec<f64> {
        let parts = series.factor.clamp(1, MOST_PARTS);
        let middle = 0.5 * (parts as f64 - 1.0);
        let offsets: Vec<f64> = (0..parts)
            .map(|k| (k as f64 - middle) / parts as f64)
            .collect();
        let reach = middle / parts as f64;
        let lambda = rate(&self.rates);
        let of_parts: Complex<f64> = offsets.iter().map(|by| (lambda * by).exp()).sum();
        let of_parts = of_parts / parts as f64;
        let mean = |i: usize| {
            let t = i as f64;
            let [swing, last] = [t - reach, t + reach].map(|t| swings.swing(t));
            if swing != last {
                let parts_of = offsets
                    .iter()
                    .map(|by| self.at(t + by, swings.swing(t + by)));
                return parts_of.sum::<f64>() / parts as f64;
            }
            let grown = self.grown(t, swing);
            let (size, added) = self.swung(swing);
            added + (size * of_parts * grown).re
        };
        (0..series.count).map(mean).collect()
    }
}

/// The values of a series: means over a number of samples each.
#[derive(Debug, Clone, Copy)]
pub(super) struct Means {
    pub(super) count: usize,
    pub(super) factor: usize,
    pub(super) quantity: MotionSignal,
}

/// Most points of a mean: a step of q is then where it is within a twentieth of a mean.
const MOST_PARTS: usize = 20;

/// Step of a difference over a rate, relative.
const STEP: f64 = 1e-6;

/// q at the samples of a series, to friction from a number of swings after the named turning point on; all the time from none.
pub(super) fn column(series: &Means, rates: Rates, swings: usize) -> Vec<f64> {
    let response = Response::from(swings, rates, series.quantity, series.count as f64);
    response.means(&response, series)
}

/// Slopes of the same over `ω_d` and σ, the named turning point where it is.
pub(super) fn slopes(series: &Means, rates: Rates, swings: usize) -> [Vec<f64>; 2] {
    let last = series.count as f64;
    let response = |rates: Rates, last: f64| Response::from(swings, rates, series.quantity, last);
    let here = response(rates, last);
    let step = STEP * rates[0];
    [0, 1].map(|k| {
        let moved = |by: f64| {
            let mut rates = rates;
            rates[k] += by;
            response(rates, last + 1.0).means(&here, series)
        };
        let (after, before) = (moved(step), moved(-step));
        let pairs = after.iter().zip(&before);
        pairs.map(|(a, b)| (a - b) / (2.0 * step)).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_means_are_those_of_a_response_at_the_times_of_their_parts() {
        for quantity in [
            MotionSignal::Displacement,
            MotionSignal::Velocity,
            MotionSignal::Acceleration,
        ] {
            for (factor, swings) in [(1, 0), (7, 0), (10, 3)] {
                let rates = [0.137, 0.004, 0.0, 5.3];
                let count = 300;
                let series = Means {
                    count,
                    factor,
                    quantity,
                };
                let response = Response::from(swings, rates, quantity, count as f64);
                for (i, mean) in column(&series, rates, swings).into_iter().enumerate() {
                    let times =
                        (0..factor).map(|k| i as f64 + (k as f64 + 0.5) / factor as f64 - 0.5);
                    let sum: f64 = times.map(|t| response.at(t, response.swing(t))).sum();
                    let apart = mean - sum / factor as f64;
                    assert!(apart.abs() < 1e-12, "{quantity:?} {factor} {i}: {apart}");
                }
            }
        }
    }

    #[test]
    fn valid_a_swing_obeys_the_equation_of_motion_beside_friction() {
        // q'' + 2σq' + ω0²q = ω0² about, at rest at its turning points
        let [omega, sigma] = [0.137, 0.004];
        let rates = [omega, sigma, 0.0, 5.3];
        let of = |quantity| Response::of(rates, quantity, 300.0);
        let all = [
            MotionSignal::Displacement,
            MotionSignal::Velocity,
            MotionSignal::Acceleration,
        ]
        .map(of);
        let squared = omega * omega + sigma * sigma;
        for swing in 1..8 {
            for share in [0.0, 0.3, 0.8] {
                let t = all[0].turn(swing) + share * std::f64::consts::PI / omega;
                let [q, velocity, acceleration] = [0, 1, 2].map(|k| all[k].at(t, swing));
                let force = squared * all[0].about(swing);
                let left = acceleration + 2.0 * sigma * velocity + squared * q - force;
                assert!(left.abs() < 1e-12, "{swing} {share}: {left}");
                assert!(share > 0.0 || velocity.abs() < 1e-12, "{velocity}");
            }
        }
    }
}
