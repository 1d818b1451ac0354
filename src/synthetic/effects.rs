//! The effects of one campaign with their sizes: what a rig's description drew.

use serde::{Deserialize, Serialize};

use super::plan::{Plan, Step};
use crate::record::Sweep;

/// A gap as stated and as it is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TrueGap {
    /// Clearance stated, m.
    pub stated_m: f64,
    /// Clearance in truth, m.
    pub true_m: f64,
}

/// A harmonic of the drive force: amplitude · cos(n φ + phase), φ the phase of the fundamental.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Harmonic {
    /// Amplitude over that of the fundamental.
    pub amplitude: f64,
    /// Phase, rad.
    pub phase_rad: f64,
}

/// The effects of one campaign with their drawn sizes, the truth that a fit may find.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Effects {
    /// Gaps that are not what is stated.
    pub gaps: Vec<TrueGap>,
    /// Second harmonic of the force.
    pub second_harmonic: Harmonic,
    /// Third harmonic of the force.
    pub third_harmonic: Harmonic,
    /// Force: F0 (1 + slope (η − 1) + curvature (η − 1)²).
    pub force_slope: f64,
    /// See `force_slope`.
    pub force_curvature: f64,
    /// h of the spring force k x (1 + h x²/A²).
    pub hardening: f64,
    /// A of `hardening`, `spring_asymmetry` and `drag`, m: the amplitude at resonance `x_st/(2β)`.
    pub resonance_amplitude_m: f64,
    /// Coulomb friction of each mass over F0.
    pub friction: f64,
    /// Relative change of f0 from the first to the last record; it is the stiffness that changes.
    pub frequency_drift: f64,
    /// Relative change of the dashpots from the first to the last record.
    pub damping_drift: f64,
    /// Duration of an impact, s; zero: instantaneous.
    pub contact_duration_s: f64,
    /// Delay of each channel in the order of [`ROLES`](super::rig::ROLES), s: its sample at t
    /// shows the signal of t − delay.
    pub delays_s: [f64; 7],
    /// 1/f noise, V rms.
    pub flicker_v: f64,
    /// Mains hum, V amplitude.
    pub hum_v: f64,
    /// Quadratic drag of each mass over F0 at the speed ΩA.
    pub drag: f64,
    /// q of the spring force k x (1 + q x/A).
    pub spring_asymmetry: f64,
    /// Change of every gap from the first to the last record, m.
    pub gap_drift_m: f64,
    /// What gaps of upward sweeps are wider than those of downward ones, m.
    pub backlash_m: f64,
    /// Relative loss of the motion channels at A and ΩA, growing with the square of the signal.
    pub compression: f64,
    /// Hysteretic share s of the damping: b ∝ 1 + s (1/η − 1).
    pub hysteretic_damping: f64,
}

impl Effects {
    /// True clearance of a stated one, m.
    pub fn true_clearance_m(&self, stated_m: f64) -> f64 {
        let gap = self.gaps.iter().find(|g| g.stated_m == stated_m);
        gap.map_or(stated_m, |g| g.true_m)
    }

    /// True clearance of a step, m, when a share `elapsed` (0 to 1) of the campaign has gone by.
    pub(super) fn clearance_m(&self, step: &Step, elapsed: f64) -> f64 {
        let lag = match step.sweep {
            Sweep::Up => 0.5,
            Sweep::Down => -0.5,
            Sweep::Unknown => 0.0,
        };
        self.true_clearance_m(step.clearance_m)
            + self.gap_drift_m * (elapsed - 0.5)
            + self.backlash_m * lag
    }

    /// Whether the motion is that of the model: exact flights and Newton's impacts.
    pub fn motion_is_exact(&self) -> bool {
        let sizes = [
            self.second_harmonic.amplitude,
            self.third_harmonic.amplitude,
            self.force_slope,
            self.force_curvature,
            self.hardening,
            self.friction,
            self.frequency_drift,
            self.damping_drift,
            self.contact_duration_s,
            self.drag,
            self.spring_asymmetry,
            self.hysteretic_damping,
            self.gap_drift_m,
            self.backlash_m,
        ];
        sizes.iter().all(|s| *s == 0.0)
    }

    /// Shift the true gaps of a plan, each by what `draw` gives.
    pub(super) fn shift_gaps(&mut self, plan: &Plan, mut draw: impl FnMut() -> f64) {
        if self.gaps.is_empty() {
            for step in &plan.steps {
                let stated_m = step.clearance_m;
                if self.gaps.iter().all(|g| g.stated_m != stated_m) {
                    self.gaps.push(TrueGap {
                        stated_m,
                        true_m: stated_m,
                    });
                }
            }
        }
        for gap in &mut self.gaps {
            gap.true_m += draw();
        }
    }
}
