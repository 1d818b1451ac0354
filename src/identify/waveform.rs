//! A periodic orbit at the folded points of a record: means over the points' spread of phase, in
//! closed form.
//!
//! An orbit is a sum of exponentials of time; the mean of e^{λt} over t ± δ is e^{λt}(1 + λ²δ²/2)
//! up to the fourth power of δ. What depends on the drive's phases alone is kept.

use crate::model::orbit::Orbit;
use crate::model::path::{C64, Path};
use crate::motion::fold::FoldedPoint;

/// The phases of a channel's points.
#[derive(Debug, Clone, PartialEq)]
pub struct Phases {
    /// Phase, rad in 0 … 2πn.
    phase: Vec<f64>,
    /// e^{i·phase}.
    turn: Vec<C64>,
    /// Half the square of the spread, rad².
    half_square: Vec<f64>,
}

impl Phases {
    /// Phases of folded points.
    pub fn of(points: &[FoldedPoint]) -> Self {
        Self {
            phase: points.iter().map(|p| p.phase_rad).collect(),
            turn: points
                .iter()
                .map(|p| C64::from_polar(1.0, p.phase_rad))
                .collect(),
            half_square: points
                .iter()
                .map(|p| 0.5 * p.spread_rad * p.spread_rad)
                .collect(),
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

/// Displacement and velocity of one mass at all points, dimensionless.
#[derive(Debug, Clone, PartialEq)]
pub struct Waveform {
    /// Displacement.
    pub displacement: Vec<f64>,
    /// Velocity.
    pub velocity: Vec<f64>,
}

impl Waveform {
    /// One mass's path on an orbit; `impact_phase` is the orbit's on the points' axis.
    pub fn new(orbit: &Orbit, path: &Path, phases: &Phases, impact_phase: f64) -> Self {
        let eta = orbit.setting.frequency_ratio;
        let span = f64::from(orbit.n) * std::f64::consts::TAU;
        // The path's harmonic starts at the impact.
        let force = path.force * C64::from_polar(1.0, -impact_phase);
        let count = phases.phase.len();
        let (mut displacement, mut velocity) =
            (Vec::with_capacity(count), Vec::with_capacity(count));
        let [c0, c1, c2] = path.polynomial;
        for i in 0..count {
            let t = (phases.phase[i] - impact_phase).rem_euclid(span) / eta;
            let half = phases.half_square[i];
            let forced = force * phases.turn[i] * (1.0 - half);
            let mut x = c0 + t * (c1 + t * c2) + forced.re;
            let mut v = c1 + 2.0 * c2 * t - eta * forced.im;
            for mode in path.modes() {
                let spread = half / (eta * eta);
                let mean = C64::new(1.0, 0.0) + mode.exponent * mode.exponent * spread;
                let z = mode.amplitude * (mode.exponent * t).exp() * mean;
                x += z.re;
                v += (mode.exponent * z).re;
            }
            displacement.push(x);
            velocity.push(v);
        }
        Self {
            displacement,
            velocity,
        }
    }
}
