//! A periodic orbit at the folded points of a record: means over the points' spread of phase, in
//! closed form, and their exact slopes.
//!
//! A mass is a sum of exponentials of time; the mean of e^{λt} over t ± δ is e^{λt}(1 + λ²δ²/2)
//! up to the fourth power of δ. What depends on the drive's phases alone is kept.

use crate::motion::FoldedPoint;
use impact_oscillator::model::path::C64;
use impact_oscillator::model::sensitivity::MassMotion;

/// The phases of a channel's points.
#[derive(Debug, Clone, PartialEq)]
pub struct Phases {
    /// Phase, rad in 0 … 2πn.
    phase: Vec<f64>,
    /// Mean of e^{iθ} over the point's phases θ.
    turn: Vec<C64>,
    /// Half the square of the spread, rad².
    half_square: Vec<f64>,
}

impl Phases {
    /// Phases of folded points.
    pub fn of(points: &[FoldedPoint]) -> Self {
        let half = |p: &FoldedPoint| 0.5 * p.spread_rad * p.spread_rad;
        Self {
            phase: points.iter().map(|p| p.phase_rad).collect(),
            turn: points
                .iter()
                .map(|p| C64::from_polar(1.0 - half(p), p.phase_rad))
                .collect(),
            half_square: points.iter().map(half).collect(),
        }
    }

    /// Whether points have these phases.
    pub fn fit(&self, points: &[FoldedPoint]) -> bool {
        self.phase.len() == points.len()
            && self
                .phase
                .iter()
                .zip(points)
                .all(|(a, p)| *a == p.phase_rad)
    }
}

/// When in an orbit of n drive periods its impact is, and how fast its time runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// η
    pub eta: f64,
    /// n
    pub periods_n: u32,
    /// Phase of the drive at the impact on the points' axis, rad.
    pub impact_phase: f64,
}

/// How a direction changes the timing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TimingSlope {
    /// Of η.
    pub eta: f64,
    /// Of the impact's phase.
    pub impact_phase: f64,
}

/// The free vibration of one mass at all points: t and the mean of e^{λt}.
#[derive(Debug, Clone, PartialEq)]
pub struct Vibration<'a> {
    phases: &'a Phases,
    timing: Timing,
    exponent: C64,
    time: Vec<f64>,
    /// e^{λt} at the points' middle.
    decay: Vec<C64>,
}

impl<'a> Vibration<'a> {
    /// Of a mass with an exponent.
    pub fn new(phases: &'a Phases, timing: Timing, exponent: C64) -> Self {
        let span = f64::from(timing.periods_n) * std::f64::consts::TAU;
        let time: Vec<f64> = phases
            .phase
            .iter()
            .map(|phase| (phase - timing.impact_phase).rem_euclid(span) / timing.eta)
            .collect();
        let decay = time.iter().map(|t| (exponent * t).exp()).collect();
        Self {
            phases,
            timing,
            exponent,
            time,
            decay,
        }
    }

    /// λ²/η²: what half the square of a spread of phase is multiplied by in a mean.
    fn curvature(&self) -> C64 {
        (self.exponent / self.timing.eta).powu(2)
    }

    /// Time since the impact at the points' middle.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// A motion with this vibration's exponent at all points, dimensionless.
    pub fn values(&self, motion: &MassMotion) -> Vec<f64> {
        let (force, mode) = (motion.force, motion.mode);
        let bent = mode * self.curvature();
        let points = self.phases.turn.iter().zip(&self.decay);
        points
            .zip(&self.phases.half_square)
            .map(|((turn, decay), half)| real(force, *turn) + real(mode + bent * *half, *decay))
            .collect()
    }

    /// Slopes of the values in a direction that changes motion and timing.
    pub fn slopes(
        &self,
        motion: &MassMotion,
        change: &MassMotion,
        timing: &TimingSlope,
    ) -> Vec<f64> {
        let eta = self.timing.eta;
        let mode = motion.mode;
        let curvature = self.curvature();
        let stretch = timing.eta / eta;
        let d_curvature =
            2.0 * self.exponent / (eta * eta) * (change.exponent - self.exponent * stretch);
        // d(λt) = t(dλ − λ dη/η) − λ dψ/η
        let constant = change.mode - mode * self.exponent * (timing.impact_phase / eta);
        let growing = mode * (change.exponent - self.exponent * stretch);
        let (bent, d_bent) = (
            constant * curvature + mode * d_curvature,
            growing * curvature,
        );
        let points = self.phases.turn.iter().zip(&self.decay);
        points
            .zip(self.time.iter().zip(&self.phases.half_square))
            .map(|((turn, decay), (t, half))| {
                let amplitude = constant + bent * *half + (growing + d_bent * *half) * *t;
                real(change.force, *turn) + real(amplitude, *decay)
            })
            .collect()
    }
}

/// Velocity of a motion Re(F e^{iθ}) + Re(A e^{λt}), θ' = η, as a motion of the same kind.
pub fn velocity(motion: &MassMotion, eta: f64) -> MassMotion {
    MassMotion {
        force: C64::new(0.0, eta) * motion.force,
        mode: motion.exponent * motion.mode,
        exponent: motion.exponent,
    }
}

/// Differential of [`velocity`].
pub fn velocity_slope(
    motion: &MassMotion,
    change: &MassMotion,
    [eta, d_eta]: [f64; 2],
) -> MassMotion {
    MassMotion {
        force: C64::new(0.0, eta) * change.force + C64::new(0.0, d_eta) * motion.force,
        mode: motion.exponent * change.mode + change.exponent * motion.mode,
        exponent: change.exponent,
    }
}

/// A motion seen later by a delay; of its jump, what lies within the delay is not shifted.
pub fn delayed(motion: &MassMotion, eta: f64, delay: f64) -> MassMotion {
    MassMotion {
        force: motion.force * C64::from_polar(1.0, -eta * delay),
        mode: motion.mode * (-motion.exponent * delay).exp(),
        exponent: motion.exponent,
    }
}

/// Differential of [`delayed`].
pub fn delayed_slope(
    motion: &MassMotion,
    change: &MassMotion,
    [eta, d_eta]: [f64; 2],
    [delay, d_delay]: [f64; 2],
) -> MassMotion {
    let turn = C64::from_polar(1.0, -eta * delay);
    let decay = (-motion.exponent * delay).exp();
    let d_turn = C64::new(0.0, -(d_eta * delay + eta * d_delay));
    let d_decay = -(change.exponent * delay + motion.exponent * d_delay);
    MassMotion {
        force: (change.force + motion.force * d_turn) * turn,
        mode: (change.mode + motion.mode * d_decay) * decay,
        exponent: change.exponent,
    }
}

/// Re(ab)
fn real(a: C64, b: C64) -> f64 {
    a.re * b.re - a.im * b.im
}
