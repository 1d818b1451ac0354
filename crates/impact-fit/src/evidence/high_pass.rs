//! A periodic motion behind a first-order high-pass, in closed form: what an integrator's channel
//! shows of it, and the exact slopes.
//!
//! The filter takes x to y by y' + cy = x'. Of x = Re(F e^{iθ}) + Re(A e^{λt}) with θ' = η it makes
//! Re(F e^{iθ} iη/(iη + c)) + Re(A e^{λt} λ/(λ + c)) + K e^{−ct}; K follows as y must come back
//! after a period T, but for the jump that x makes at the impact, which passes whole:
//! K = Re(A (1 − e^{λT}) c/(λ + c)) / (1 − e^{−cT}), (17).

use crate::evidence::waveform::TimingSlope;
use impact_oscillator::model::path::C64;
use impact_oscillator::model::sensitivity::MassMotion;

/// A motion behind its filter: two terms of the same kind as before, and K. Of a change: the
/// differentials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passed {
    /// What was there before, as the filter leaves it.
    pub motion: MassMotion,
    /// K
    pub tail: f64,
}

/// A first-order high-pass that a periodic motion of one exponent passes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HighPass {
    corner: f64,
    eta: f64,
    period: f64,
    lambda: C64,
    /// What is kept of the drive's term and of the free vibration's.
    kept_rate: C64,
    kept: C64,
    /// e^{λT}
    returned: C64,
    /// 1 − e^{−cT}
    closing: f64,
}

/// A direction in which the filter changes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HighPassSlope {
    /// Of c.
    pub corner: f64,
    /// Of η.
    pub eta: f64,
}

impl HighPass {
    /// Of a corner c (over the natural frequency), for a motion of period T driven at η whose free
    /// vibration is e^{λt}.
    pub fn new(corner: f64, eta: f64, period: f64, lambda: C64) -> Self {
        let kept = |pole: C64| pole / (pole + corner);
        Self {
            corner,
            eta,
            period,
            lambda,
            kept_rate: kept(C64::new(0.0, eta)),
            kept: kept(lambda),
            returned: (lambda * period).exp(),
            closing: -(-corner * period).exp_m1(),
        }
    }

    /// c
    pub fn corner(&self) -> f64 {
        self.corner
    }

    fn kept_slope(&self, pole: C64, d_pole: C64, d_corner: f64) -> C64 {
        (d_pole * self.corner - pole * d_corner) / (pole + self.corner).powi(2)
    }

    /// Differential of K e^{−ct} where K (`tail`, with its change), filter and timing change: a constant and
    /// a part that grows with t, times e^{−ct}.
    pub fn tail_slopes(
        &self,
        [tail, d_tail]: [f64; 2],
        filter: &HighPassSlope,
        timing: &TimingSlope,
    ) -> [f64; 2] {
        let Self { corner, eta, .. } = *self;
        // d(ct) = t(dc − c dη/η) − c dψ/η
        [
            d_tail + tail * corner * timing.impact_phase / eta,
            tail * (corner * timing.eta / eta - filter.corner),
        ]
    }

    /// A motion behind the filter.
    pub fn pass(&self, motion: &MassMotion) -> Passed {
        let one = C64::new(1.0, 0.0);
        let jump = motion.mode * (one - self.returned);
        Passed {
            motion: MassMotion {
                force: motion.force * self.kept_rate,
                mode: motion.mode * self.kept,
                exponent: self.lambda,
            },
            tail: (jump * (one - self.kept)).re / self.closing,
        }
    }

    /// Its differential where the motion and the filter change; `tail` is K.
    pub fn pass_slope(
        &self,
        motion: &MassMotion,
        tail: f64,
        change: &MassMotion,
        filter: &HighPassSlope,
    ) -> Passed {
        let one = C64::new(1.0, 0.0);
        let d_period = -self.period * filter.eta / self.eta;
        let (rate, d_rate) = (C64::new(0.0, self.eta), C64::new(0.0, filter.eta));
        let (lambda, d_lambda) = (self.lambda, change.exponent);
        let d_kept = self.kept_slope(lambda, d_lambda, filter.corner);
        let d_returned = self.returned * (d_lambda * self.period + lambda * d_period);
        let jump = motion.mode * (one - self.returned);
        let d_jump = change.mode * (one - self.returned) - motion.mode * d_returned;
        let d_closing =
            (1.0 - self.closing) * (filter.corner * self.period + self.corner * d_period);
        let d_lost = (d_jump * (one - self.kept) - jump * d_kept).re;
        Passed {
            motion: MassMotion {
                force: change.force * self.kept_rate
                    + motion.force * self.kept_slope(rate, d_rate, filter.corner),
                mode: change.mode * self.kept + motion.mode * d_kept,
                exponent: d_lambda,
            },
            tail: (d_lost - tail * d_closing) / self.closing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_a_periodic_motion_comes_back_behind_the_filter() {
        let motion = MassMotion {
            force: C64::new(0.7, -1.3),
            mode: C64::new(-0.4, 0.9),
            exponent: C64::new(-0.07, 0.998),
        };
        let period = std::f64::consts::TAU / 1.2;
        let filter = HighPass::new(0.04, 1.2, period, motion.exponent);
        let psi = 0.3;
        let x = |t: f64| {
            (motion.force * C64::from_polar(1.0, psi + filter.eta * t)).re
                + (motion.mode * (motion.exponent * t).exp()).re
        };
        let passed = filter.pass(&motion);
        let y = |t: f64| {
            (passed.motion.force * C64::from_polar(1.0, psi + filter.eta * t)).re
                + (passed.motion.mode * (motion.exponent * t).exp()).re
                + passed.tail * (-filter.corner * t).exp()
        };
        // The jump passes whole, and y' + cy = x' between.
        let jump = |f: &dyn Fn(f64) -> f64| f(0.0) - f(filter.period);
        assert!((jump(&x) - jump(&y)).abs() < 1e-12);
        let slope = |f: &dyn Fn(f64) -> f64, t: f64| (f(t + 1e-5) - f(t - 1e-5)) / 2e-5;
        for t in [0.1, 1.7, 4.4] {
            let left = slope(&y, t) + filter.corner * y(t);
            assert!((left - slope(&x, t)).abs() < 1e-9, "{t}");
        }
    }
}
