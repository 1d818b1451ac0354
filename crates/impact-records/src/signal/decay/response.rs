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

    /// At a time of a swing, in samples.
    fn at(&self, t: f64, swing: usize) -> f64 {
        if swing < self.begins {
            return 0.0;
        }
        let [omega, sigma, ..] = self.rates;
        let about = self.about(swing);
        let own = t - self.turn(swing);
        let swung = (self.turns[swing] - about) * (-sigma * own).exp();
        let (sin, cos) = (omega * own).sin_cos();
        let squared = omega * omega + sigma * sigma;
        match self.quantity {
            MotionSignal::Displacement => about + swung * (cos + sigma / omega * sin),
            MotionSignal::Velocity => -swung * squared / omega * sin,
            MotionSignal::Acceleration => -swung * squared * (cos - sigma / omega * sin),
        }
    }

    /// Means over as many samples as those of a series, whose swings are those of a response of near rates.
    fn means(&self, swings: &Self, series: &Means) -> Vec<f64> {
        let parts = series.factor.clamp(1, MOST_PARTS);
        let middle = 0.5 * (parts as f64 - 1.0);
        let mean = |i: usize| {
            let of = |k: usize| {
                let t = i as f64 + (k as f64 - middle) / parts as f64;
                self.at(t, swings.swing(t))
            };
            (0..parts).map(of).sum::<f64>() / parts as f64
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
