//! The effects of one campaign with their sizes: what a rig's description drew.

use serde::{Deserialize, Serialize};

use super::plan::{Plan, Step};
use impact_records::record::Sweep;

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

/// A drive that starts again at every setting, at another phase.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Restarts {
    /// Greatest jump of the phase, turns.
    pub turns: f64,
    /// Where the sequence of jumps begins, 0 to 1.
    pub offset: f64,
}

impl Restarts {
    /// Jump of the phase at setting number `index`, rad: evenly spread by the golden ratio.
    pub(super) fn jump_rad(&self, index: usize) -> f64 {
        let place = (self.offset + index as f64 * GOLDEN).fract();
        std::f64::consts::TAU * self.turns * (2.0 * place - 1.0)
    }
}

/// Fractional part of the golden ratio.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The effects of one campaign with their drawn sizes, the truth that a fit may find.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RigEffects {
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
    /// Jumps of the drive's phase between settings; `None`: it goes on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restarts: Option<Restarts>,
}

impl RigEffects {
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
        sizes.iter().all(|s| *s == 0.0) && self.restarts.is_none()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_jumps_of_a_drive_stay_within_their_turns_and_are_spread_evenly() {
        let restarts = Restarts {
            turns: 0.5,
            offset: 0.3,
        };
        let jumps: Vec<f64> = (0..1000).map(|i| restarts.jump_rad(i)).collect();
        let most = std::f64::consts::PI;
        assert!(jumps.iter().all(|j| j.abs() <= most));
        // a uniform distribution: a quarter of them beyond ±3/4 of the range, the mean at zero
        let far = jumps.iter().filter(|j| j.abs() > 0.75 * most).count();
        assert!((245..=255).contains(&far), "{far}");
        assert!(jumps.iter().sum::<f64>().abs() / 1000.0 < 0.01);
    }
}
