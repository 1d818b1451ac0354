//! A periodic orbit at the folded points of a record: means over the points' spread of phase, in
//! closed form, and their exact slopes.
//!
//! A mass is a sum of exponentials of time; the mean of e^{λt} over t ± δ is e^{λt}(1 + λ²δ²/2)
//! up to the fourth power of δ. What depends on the drive's phases alone is kept.

use impact_oscillator::model::path::C64;
use impact_oscillator::model::sensitivity::MassMotion;
use impact_records::motion::FoldedPoint;

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

    /// Phase of each point since an impact, in a motion of a span of phase, rad.
    pub fn since(&self, impact_phase: f64, span: f64) -> impl Iterator<Item = f64> {
        let phases = self.phase.iter();
        phases.map(move |phase| (phase - impact_phase).rem_euclid(span))
    }

    /// Of each point the mean of e^{iθ} over its phases θ, and half the square of its spread, rad².
    pub fn turns(&self) -> impl Iterator<Item = (C64, f64)> {
        let turns = self.turn.iter().zip(&self.half_square);
        turns.map(|(turn, half)| (*turn, *half))
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

impl Timing {
    /// Phase of the drive in one period of the motion, rad.
    pub fn span(&self) -> f64 {
        f64::from(self.periods_n) * std::f64::consts::TAU
    }
}

/// How fast the terms of a motion change with the phase of its drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Rates {
    /// When its impact is.
    pub timing: Timing,
    /// Of each channel λ/η of its mass and c/η of its high-pass, per rad.
    pub channels: Vec<ChannelRates>,
}

/// λ/η and c/η.
pub type ChannelRates = (C64, Option<f64>);

/// How a direction changes the timing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TimingSlope {
    /// Of η.
    pub eta: f64,
    /// Of the impact's phase.
    pub impact_phase: f64,
}

/// What a channel shows, as a sum of terms at the points.
///
/// It is Re(F e^{iθ}) + Re((a + bt + (c + dt) s²/2) e^{λt}) + (k + lt) e^{−ct} with s the spread of a
/// point's phase, λ the exponent of its mass and c the corner of its high-pass.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Terms {
    /// F
    pub force: C64,
    /// a and b
    pub free: [C64; 2],
    /// c and d
    pub bent: [C64; 2],
    /// k and l
    pub tail: [f64; 2],
}

impl Terms {
    /// Times a number.
    #[must_use]
    pub fn scaled(self, by: f64) -> Self {
        Self {
            force: by * self.force,
            free: self.free.map(|c| by * c),
            bent: self.bent.map(|c| by * c),
            tail: self.tail.map(|c| by * c),
        }
    }

    /// With a multiple of others.
    #[must_use]
    pub fn plus(self, share: f64, other: &Self) -> Self {
        let sum = |own: [C64; 2], other: [C64; 2]| [0, 1].map(|i| own[i] + share * other[i]);
        Self {
            force: self.force + share * other.force,
            free: sum(self.free, other.free),
            bent: sum(self.bent, other.bent),
            tail: [0, 1].map(|i| self.tail[i] + share * other.tail[i]),
        }
    }
}

/// The free vibration of one mass: when its impact is, and λ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vibration {
    timing: Timing,
    exponent: C64,
}

impl Vibration {
    /// Of a mass with an exponent.
    pub fn new(timing: Timing, exponent: C64) -> Self {
        Self { timing, exponent }
    }

    /// λ/η, per rad of the drive's phase.
    pub fn rate(&self) -> C64 {
        self.exponent / self.timing.eta
    }

    /// λ²/η²: what half the square of a spread of phase is multiplied by in a mean.
    fn curvature(&self) -> C64 {
        self.rate().powu(2)
    }

    /// A motion with this vibration's exponent, dimensionless.
    pub fn values(&self, motion: &MassMotion) -> Terms {
        let mode = motion.mode;
        Terms {
            force: motion.force,
            free: [mode, C64::default()],
            bent: [mode * self.curvature(), C64::default()],
            tail: [0.0; 2],
        }
    }

    /// Slopes of the values in a direction that changes motion and timing.
    pub fn slopes(&self, motion: &MassMotion, change: &MassMotion, timing: &TimingSlope) -> Terms {
        let eta = self.timing.eta;
        let mode = motion.mode;
        let curvature = self.curvature();
        let stretch = timing.eta / eta;
        let d_curvature =
            2.0 * self.exponent / (eta * eta) * (change.exponent - self.exponent * stretch);
        // d(λt) = t(dλ − λ dη/η) − λ dψ/η
        let constant = change.mode - mode * self.exponent * (timing.impact_phase / eta);
        let growing = mode * (change.exponent - self.exponent * stretch);
        Terms {
            force: change.force,
            free: [constant, growing],
            bent: [
                constant * curvature + mode * d_curvature,
                growing * curvature,
            ],
            tail: [0.0; 2],
        }
    }
}

/// The free vibration of one mass at the points of a set of phases.
#[derive(Debug, Clone, PartialEq)]
pub struct VibrationPoints<'a> {
    phases: &'a Phases,
    time: Vec<f64>,
    /// e^{λt} at the points' middle.
    decay: Vec<C64>,
}

impl<'a> VibrationPoints<'a> {
    /// Of a vibration.
    pub fn new(phases: &'a Phases, vibration: &Vibration) -> Self {
        let Vibration { timing, exponent } = *vibration;
        let since = phases.since(timing.impact_phase, timing.span());
        let time: Vec<f64> = since.map(|phase| phase / timing.eta).collect();
        let decay = time.iter().map(|t| (exponent * t).exp()).collect();
        Self {
            phases,
            time,
            decay,
        }
    }

    /// Time since the impact at the points' middle.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// A sum of terms at all points; `tail`: e^{−ct} at the points of a channel behind a high-pass.
    pub fn values(&self, terms: &Terms, tail: Option<&[f64]>) -> Vec<f64> {
        let Terms {
            force, free, bent, ..
        } = *terms;
        let points = self.phases.turn.iter().zip(&self.decay);
        let mut values: Vec<f64> = points
            .zip(self.time.iter().zip(&self.phases.half_square))
            .map(|((turn, decay), (t, half))| {
                let amplitude = free[0] + bent[0] * *half + (free[1] + bent[1] * *half) * *t;
                real(force, *turn) + real(amplitude, *decay)
            })
            .collect();
        let [constant, growing] = terms.tail;
        if let Some(tail) = tail {
            let tail = tail.iter().zip(&self.time);
            let values = values.iter_mut().zip(tail);
            values.for_each(|(value, (decay, t))| *value += (constant + growing * t) * decay);
        }
        values
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
