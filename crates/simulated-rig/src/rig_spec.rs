//! What a real rig does beyond the model: each effect is a switch with a strength, and the
//! strengths are drawn for one campaign as [`RigEffects`].
//!
//! | effect | strength | what it does |
//! | --- | --- | --- |
//! | `gaps` | standard deviation / x_st | each stated gap is off by a draw of its own |
//! | `gap-offset` | standard deviation / x_st | all gaps are off by one draw (zero of the screw) |
//! | `damping-asymmetry` | (β_x − β_y)/β | unequal dashpots |
//! | `second-harmonic`, `third-harmonic` | amplitude / F0 | a distorted drive force, each at a phase of its own |
//! | `force-slope` | per unit of η | the force is F0 (1 + s (η − 1)) |
//! | `force-curvature` | per unit of η² | and + c (η − 1)² |
//! | `hardening` | relative stiffening at x_st/(2β) | spring force k x (1 + h x²/A²), A = x_st/(2β) |
//! | `friction` | friction / F0 | Coulomb friction on each mass |
//! | `frequency-drift` | relative, first to last record | √(k/m) drifts, F0, b and m stay |
//! | `damping-drift` | relative, first to last record | b drifts |
//! | `drag` | drag / F0 at the speed Ω x_st/(2β) | quadratic drag on each mass |
//! | `spring-asymmetry` | relative stiffening at x_st/(2β) | spring force k x (1 + q x/A), A = x_st/(2β) |
//! | `hysteretic-damping` | share | a share s of the dashpots is hysteretic: b ∝ 1 + s (1/η − 1) |
//! | `gap-drift` | share of x_st, first to last record | the gaps drift |
//! | `backlash` | share of x_st | gaps of upward sweeps are wider than those of downward ones; unknown to the fit |
//! | `compression` | relative at x_st/(2β) | motion channels show less of large signals; unknown to the fit |
//! | `restarts` | turns | the drive starts again at every setting, its phase off by up to this; unknown to the fit |
//! | `drive-asymmetry` | (F_x − F_y)/F | unequal forces; 2: one mass is driven alone |
//! | `contact` | ms | impacts last this long: a spring and a damper that only press |
//! | `delays` | samples | each channel lags the drive by a delay within ± the strength |
//! | `flicker` | V rms | 1/f noise on every channel beside the white one |
//! | `hum` | V amplitude | 50 Hz mains on every channel |

use std::fmt;
use std::str::FromStr;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};
use strum::VariantArray;
use thiserror::Error;

use super::acquisition::RATE_HZ;
use super::effects::{Harmonic, Restarts, RigEffects};
use super::plan::Plan;
use super::truth::{Differences, Truth};

/// One effect beyond the model.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    PartialOrd,
    Ord,
    Hash,
    Serialize,
    Deserialize,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
    strum::VariantNames,
)]
#[strum(serialize_all = "kebab-case")]
#[serde(rename_all = "kebab-case")]
pub enum Effect {
    /// Each stated gap is off by its own draw.
    Gaps,
    /// All stated gaps are off by the same draw.
    GapOffset,
    /// Unequal damping of the masses.
    DampingAsymmetry,
    /// Second harmonic of the drive force.
    SecondHarmonic,
    /// Third harmonic of the drive force.
    ThirdHarmonic,
    /// Linear change of the force with η.
    ForceSlope,
    /// Quadratic change of the force with η.
    ForceCurvature,
    /// Springs that harden with displacement (cubic stiffness).
    Hardening,
    /// Coulomb friction.
    Friction,
    /// f0 drifts over the campaign.
    FrequencyDrift,
    /// The dashpots drift over the campaign.
    DampingDrift,
    /// Impacts of finite duration.
    Contact,
    /// Delays of the channels against the drive's.
    Delays,
    /// 1/f noise.
    Flicker,
    /// Mains hum.
    Hum,
    /// Drag that grows with the square of the velocity.
    Drag,
    /// Springs that are stiffer to one side (quadratic stiffness).
    SpringAsymmetry,
    /// Damping of which a share is hysteretic.
    HystereticDamping,
    /// Gaps that drift over the campaign.
    GapDrift,
    /// Gaps that differ between upward and downward sweeps.
    Backlash,
    /// Sensors that show less of large signals.
    Compression,
    /// A drive that starts again at every setting: its phase jumps.
    Restarts,
    /// Unequal forces on the masses.
    DriveAsymmetry,
}

impl Effect {
    /// Name on the command line and in truth.json.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Strength that a good laboratory would accept, in the effect's own unit.
    pub fn typical_strength(self) -> f64 {
        match self {
            Self::Gaps | Self::GapOffset | Self::ThirdHarmonic | Self::SpringAsymmetry => 0.003,
            Self::DampingAsymmetry | Self::DriveAsymmetry => 0.05,
            Self::SecondHarmonic
            | Self::ForceCurvature
            | Self::Friction
            | Self::Drag
            | Self::Backlash
            | Self::Compression => 0.005,
            Self::ForceSlope | Self::GapDrift => 0.01,
            Self::Hardening => 0.004,
            Self::FrequencyDrift => 0.002,
            Self::DampingDrift => 0.02,
            Self::HystereticDamping => 0.05,
            Self::Contact => 0.64,
            Self::Delays | Self::Restarts => 0.5,
            Self::Flicker | Self::Hum => 1e-3,
        }
    }

    /// Whether the realistic rig has it. Of the others the fit knows the drift of the gaps, and unequal forces, of which every
    /// rig has some; the rest break its assumptions.
    fn is_realistic(self) -> bool {
        !matches!(
            self,
            Self::GapDrift
                | Self::Backlash
                | Self::Compression
                | Self::Restarts
                | Self::DriveAsymmetry
        )
    }

    /// Greatest strength that the simulation takes.
    fn greatest_strength(self) -> f64 {
        match self {
            Self::Contact => 10.0,
            Self::Delays => 20.0,
            Self::DriveAsymmetry => 2.0,
            _ => 0.5,
        }
    }
}

/// Why a description of a rig cannot be used.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RigError {
    /// No effect has this name.
    #[error("no effect is called {0:?}; known: exact, realistic, {list}", list = names())]
    Unknown(String),
    /// A strength is no number.
    #[error("{effect}={text}: the strength is not a number (effects: {list})", effect = effect.name(), list = names())]
    NotANumber {
        /// The effect.
        effect: Effect,
        /// What was given as its strength.
        text: String,
    },
    /// A strength is out of range.
    #[error("{effect}={strength}: the strength must be between 0 and {greatest} (effects: {list})", effect = effect.name(), list = names())]
    OutOfRange {
        /// The effect.
        effect: Effect,
        /// The strength given.
        strength: f64,
        /// The greatest strength.
        greatest: f64,
    },
}

fn names() -> String {
    <Effect as strum::VariantNames>::VARIANTS.join(", ")
}

/// One effect of a rig and its strength.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Switch {
    /// The effect.
    pub effect: Effect,
    /// Its strength, in the effect's own unit.
    pub strength: f64,
    /// Whether a campaign draws its size at random from half to one and a half times the
    /// strength; otherwise it has exactly this size. Signs and phases are always random.
    pub spread: bool,
}

impl Switch {
    /// Switch it on in the effects of a campaign.
    fn draw(&self, effects: &mut RigEffects, truth: &mut Truth, plan: &Plan, rng: &mut ChaCha8Rng) {
        let spread = rng.random_range(0.5..1.5);
        let size = self.strength * if self.spread { spread } else { 1.0 };
        let sign = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
        let phase_rad = rng.random_range(0.0..std::f64::consts::TAU);
        let harmonic = Harmonic {
            amplitude: size,
            phase_rad,
        };
        match self.effect {
            Effect::Gaps => {
                let deviation_m = self.strength * truth.static_deflection_m();
                effects.shift_gaps(plan, || deviation_m * normal(rng));
            }
            Effect::GapOffset => {
                let offset_m = self.strength * truth.static_deflection_m() * normal(rng);
                effects.shift_gaps(plan, || offset_m);
            }
            Effect::DampingAsymmetry => *truth = truth.with_damping_ratios_apart(sign * size),
            Effect::DriveAsymmetry => {
                *truth = truth.with_differences(&Differences {
                    force: sign * size,
                    ..Differences::default()
                });
            }
            Effect::SecondHarmonic => effects.second_harmonic = harmonic,
            Effect::ThirdHarmonic => effects.third_harmonic = harmonic,
            Effect::ForceSlope => effects.force_slope = sign * size,
            Effect::ForceCurvature => effects.force_curvature = sign * size,
            Effect::Hardening => effects.hardening = size,
            Effect::Drag => effects.drag = size,
            Effect::SpringAsymmetry => effects.spring_asymmetry = sign * size,
            Effect::HystereticDamping => effects.hysteretic_damping = sign * size,
            Effect::GapDrift => effects.gap_drift_m = sign * size * truth.static_deflection_m(),
            Effect::Backlash => effects.backlash_m = sign * size * truth.static_deflection_m(),
            Effect::Compression => effects.compression = sign * size,
            Effect::Restarts => {
                effects.restarts = Some(Restarts {
                    turns: self.strength,
                    offset: spread.fract(),
                });
            }
            Effect::Friction => effects.friction = size,
            Effect::FrequencyDrift => effects.frequency_drift = sign * size,
            Effect::DampingDrift => effects.damping_drift = sign * size,
            Effect::Contact => effects.contact_duration_s = 1e-3 * size,
            Effect::Delays => {
                for delay in &mut effects.delays_s[1..] {
                    *delay = self.strength * rng.random_range(-1.0..1.0) / RATE_HZ;
                }
            }
            Effect::Flicker => effects.flicker_v = size,
            Effect::Hum => effects.hum_v = size,
        }
    }
}

/// Which effects a simulated rig has; [`RigSpec::exact`] has none.
///
/// ```
/// use simulated_rig::RigSpec;
/// let rig: RigSpec = "contact=0.3,friction".parse().unwrap();
/// assert_eq!(rig.to_string(), "contact=0.3,friction=0.005");
/// assert!("fricton".parse::<RigSpec>().is_err());
/// ```
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RigSpec {
    /// The effects that are on, each once.
    pub switches: Vec<Switch>,
}

impl RigSpec {
    /// A rig that satisfies the assumptions of the fit.
    pub fn exact() -> Self {
        Self::default()
    }

    /// A rig with the effects that every real one has at typical strengths, their sizes drawn for each
    /// campaign.
    pub fn realistic() -> Self {
        let known = Effect::VARIANTS
            .iter()
            .copied()
            .filter(|e| e.is_realistic());
        let switches = known.map(|effect| Switch {
            effect,
            strength: effect.typical_strength(),
            spread: true,
        });
        Self {
            switches: switches.collect(),
        }
    }

    /// The same rig with one effect set to a strength.
    ///
    /// # Errors
    /// [`RigError::OutOfRange`] if the strength is negative, not finite or too great.
    pub fn with(mut self, effect: Effect, strength: f64) -> Result<Self, RigError> {
        let greatest = effect.greatest_strength();
        if !(0.0..=greatest).contains(&strength) {
            return Err(RigError::OutOfRange {
                effect,
                strength,
                greatest,
            });
        }
        self.switches.retain(|s| s.effect != effect);
        if strength > 0.0 {
            self.switches.push(Switch {
                effect,
                strength,
                spread: false,
            });
        }
        Ok(self)
    }

    /// Strength of an effect; zero if it is off.
    pub fn strength(&self, effect: Effect) -> f64 {
        let switch = self.switches.iter().find(|s| s.effect == effect);
        switch.map_or(0.0, |s| s.strength)
    }

    /// Whether no effect is on.
    pub fn is_exact(&self) -> bool {
        self.switches.is_empty()
    }

    /// Standard uncertainty of each stated gap that a laboratory with this rig would state, m:
    /// that of the wider of its two draws, the gap's own and the common one.
    pub fn clearance_uncertainty_m(&self, truth: &Truth) -> Option<f64> {
        let strength = self
            .strength(Effect::Gaps)
            .max(self.strength(Effect::GapOffset));
        (strength > 0.0).then_some(strength * truth.static_deflection_m())
    }

    /// The effects of one campaign: sizes, signs and phases drawn from a seed. Each effect has a
    /// random stream of its own, so switching one on does not change the others.
    /// The asymmetry of damping is put into the truth.
    pub fn draw(&self, truth: &mut Truth, plan: &Plan, seed: u64) -> RigEffects {
        let mut effects = RigEffects {
            resonance_amplitude_m: truth.static_deflection_m() / (2.0 * truth.damping_ratio()),
            ..RigEffects::default()
        };
        for switch in &self.switches {
            let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 0x00EF_FEC7);
            rng.set_stream(switch.effect as u64);
            switch.draw(&mut effects, truth, plan, &mut rng);
        }
        effects
    }
}

impl FromStr for RigSpec {
    type Err = RigError;

    /// `exact`, `realistic` or `EFFECT[=strength]`, several with commas; later ones win.
    fn from_str(text: &str) -> Result<Self, RigError> {
        let mut rig = Self::exact();
        for item in text.split(',').map(str::trim) {
            let (name, strength) = match item.split_once('=') {
                Some((name, strength)) => (name.trim(), Some(strength.trim())),
                None => (item, None),
            };
            match (name, strength) {
                ("exact", None) => rig = Self::exact(),
                ("realistic", None) => rig = Self::realistic(),
                _ => {
                    let unknown = |_| RigError::Unknown(name.to_owned());
                    let effect = Effect::from_str(name).map_err(unknown)?;
                    let strength = match strength {
                        None => effect.typical_strength(),
                        Some(text) => text.parse().map_err(|_| RigError::NotANumber {
                            effect,
                            text: text.to_owned(),
                        })?,
                    };
                    rig = rig.with(effect, strength)?;
                }
            }
        }
        Ok(rig)
    }
}

impl fmt::Display for RigSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_exact() {
            return f.write_str("exact");
        }
        if *self == Self::realistic() {
            return f.write_str("realistic");
        }
        for (i, switch) in self.switches.iter().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            write!(f, "{comma}{}={}", switch.effect.name(), switch.strength)?;
        }
        Ok(())
    }
}

fn normal(rng: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(rng)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rig_is_written_and_read_alike() {
        for text in ["exact", "realistic", "contact=0.3,friction=0.01"] {
            assert_eq!(text.parse::<RigSpec>().unwrap().to_string(), text);
        }
        let rig: RigSpec = "realistic,contact=0".parse().unwrap();
        assert_eq!(rig.strength(Effect::Contact), 0.0);
        assert_eq!(rig.strength(Effect::Hum), 1e-3);
    }

    #[test]
    fn bad_rigs_are_refused_with_the_list_of_effects() {
        for text in [
            "",
            "wobble",
            "friction=-0.1",
            "friction=much",
            "contact=NaN",
            "exact=1",
        ] {
            let error = text.parse::<RigSpec>().unwrap_err().to_string();
            assert!(error.contains("second-harmonic"), "{text}: {error}");
        }
    }

    #[test]
    fn prop_effects_are_the_same_for_a_seed_and_independent_of_each_other() {
        let mut truth = Truth::symmetric(0.8, 12.0, 0.05, 1e-3);
        let plan = Plan::for_rig(12.0, 0.05, 1e-3, 120);
        let all = RigSpec::realistic().draw(&mut truth, &plan, 7);
        assert_eq!(all, RigSpec::realistic().draw(&mut truth, &plan, 7));
        assert_ne!(all, RigSpec::realistic().draw(&mut truth, &plan, 8));
        let alone: RigSpec = "delays".parse().unwrap();
        assert_eq!(alone.draw(&mut truth, &plan, 7).delays_s, all.delays_s);
        assert!(
            RigSpec::exact()
                .draw(&mut truth, &plan, 7)
                .motion_is_exact()
        );
    }
}
