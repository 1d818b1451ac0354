//! What springs, drive and contact of a real rig add to the model: small effects, each a coordinate of
//! the fit whose prior is centred on zero and as wide as a good laboratory would accept.

use serde::{Deserialize, Serialize};
use strum::VariantArray;

/// One effect beyond the model.
#[derive(
    Debug,
    Default,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "snake_case")]
#[serde(rename_all = "snake_case")]
pub enum Effect {
    /// cos 2θ in the driving force, relative to F0
    #[default]
    #[strum(to_string = "drive_harmonic_2_cos")]
    SecondHarmonicCos,
    /// sin 2θ
    #[strum(to_string = "drive_harmonic_2_sin")]
    SecondHarmonicSin,
    /// cos 3θ
    #[strum(to_string = "drive_harmonic_3_cos")]
    ThirdHarmonicCos,
    /// sin 3θ
    #[strum(to_string = "drive_harmonic_3_sin")]
    ThirdHarmonicSin,
    /// Relative change of the force per unit of η, about η = 1
    ForceSlope,
    /// Relative change of the force per unit of (η − 1)²
    ForceCurve,
    /// Relative rise of the springs' secant stiffness at the greatest displacement measured
    Hardening,
    /// Coulomb friction relative to F0
    Friction,
    /// Relative change of f0 from the first record to the last
    FrequencyDrift,
    /// Relative change of f0 in the middle of the campaign against both ends
    #[strum(to_string = "frequency_drift_bend")]
    FrequencyBend,
    /// Relative change of β from the first record to the last
    DampingDrift,
    /// Relative change of `x_st` (the force) from the first record to the last
    DeflectionDrift,
    /// Length of a contact, ms
    #[strum(to_string = "contact_duration_ms")]
    ContactDuration,
    /// Relative departure of what a contact's length makes of R from that of a spring and a damper: as laws of
    /// contact depart from it
    ContactLaw,
    /// What the masses' acceleration during a contact adds to the distance that they press into each
    /// other: relative, per unit of acceleration × duration / approach speed
    ContactReach,
    /// How a contact's length falls with the approach speed: the exponent, 0 of a linear spring, 1/5 of round bodies
    /// (Hertz), over the campaign's typical speed
    ContactSpeed,
    /// Change of R per factor e of the approach speed, about the campaign's typical speed
    RestitutionSpeed,
    /// Drag that grows with the square of the velocity, relative to F0 at the velocity 2πf0 times the
    /// greatest displacement measured
    Drag,
    /// Relative rise of the springs' secant stiffness from rest to the greatest displacement measured
    /// toward the other mass, and fall as far on the other side
    SpringAsymmetry,
    /// Share of the damping at η = 1 that is hysteretic (structural): it falls with the frequency
    HystereticDamping,
    /// Change of every clearance from the first record to the last, relative to `x_st`
    ClearanceDrift,
    /// What the channel of mass x picks up from the drive, relative to its greatest amplitude
    PickupX,
    /// The same of mass y
    PickupY,
}

/// Effects that a campaign may restrict the fit to, by name.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    strum::IntoStaticStr,
    strum::EnumString,
    strum::VariantArray,
    strum::VariantNames,
)]
#[strum(serialize_all = "snake_case")]
#[serde(rename_all = "snake_case")]
pub enum EffectKind {
    /// Second and third harmonic of the drive
    Harmonics,
    /// The force against frequency
    ForceFrequency,
    /// Springs that harden or soften
    Hardening,
    /// Coulomb friction
    Friction,
    /// f0, β, `x_st` and the clearances over the campaign
    Drift,
    /// Contacts of finite duration
    ContactDuration,
    /// R over the approach speed
    RestitutionSpeed,
    /// Drag of the air
    Drag,
    /// Springs that are stiffer to one side
    SpringAsymmetry,
    /// Hysteretic damping beside the viscous one
    HystereticDamping,
    /// What channels pick up from the drive's generator
    Pickup,
}

impl EffectKind {
    /// All of them.
    pub const ALL: &'static [Self] = <Self as VariantArray>::VARIANTS;

    /// Name in `campaign.toml`.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

impl Effect {
    /// All of them, in the order of their places.
    pub const ALL: &'static [Self] = <Self as VariantArray>::VARIANTS;

    /// Number of effects.
    pub const COUNT: usize = Self::ALL.len();

    /// Place among all.
    pub fn place(self) -> usize {
        self as usize
    }

    /// Its kind, the standard deviation of its prior, and whether it perturbs the values.
    fn properties(self) -> (EffectKind, f64, bool) {
        match self {
            Self::SecondHarmonicCos
            | Self::SecondHarmonicSin
            | Self::ThirdHarmonicCos
            | Self::ThirdHarmonicSin => (EffectKind::Harmonics, 5e-3, true),
            Self::ForceSlope => (EffectKind::ForceFrequency, 2e-2, false),
            Self::ForceCurve => (EffectKind::ForceFrequency, 1e-2, false),
            Self::Hardening => (EffectKind::Hardening, 5e-3, true),
            Self::Friction => (EffectKind::Friction, 5e-3, true),
            Self::FrequencyDrift => (EffectKind::Drift, 3e-3, false),
            Self::FrequencyBend => (EffectKind::Drift, 1e-3, false),
            Self::DampingDrift => (EffectKind::Drift, 2e-2, false),
            Self::DeflectionDrift => (EffectKind::Drift, 5e-3, false),
            Self::ContactDuration => (EffectKind::ContactDuration, 0.6, false),
            Self::ContactLaw => (EffectKind::ContactDuration, 0.45, false),
            Self::ContactReach => (EffectKind::ContactDuration, 0.3, false),
            Self::ContactSpeed => (EffectKind::ContactDuration, 0.2, false),
            Self::RestitutionSpeed => (EffectKind::RestitutionSpeed, 2e-2, false),
            Self::Drag => (EffectKind::Drag, 1e-2, true),
            Self::SpringAsymmetry => (EffectKind::SpringAsymmetry, 5e-3, true),
            Self::HystereticDamping => (EffectKind::HystereticDamping, 0.1, false),
            Self::ClearanceDrift => (EffectKind::Drift, 1e-2, false),
            Self::PickupX | Self::PickupY => (EffectKind::Pickup, 1e-3, true),
        }
    }

    /// The kind it belongs to.
    pub fn kind(self) -> EffectKind {
        self.properties().0
    }

    /// Standard deviation of its prior: what a good laboratory would accept.
    pub fn accepted(self) -> f64 {
        self.properties().1
    }

    /// Whether it perturbs the values of an orbit, by a small extra acceleration or at the channel, so that
    /// its slopes are those of a perturbation; the others change the parameters of a record.
    pub fn is_perturbation(self) -> bool {
        self.properties().2
    }

    /// Name in `identification.json`.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// The kinds of effects that a fit allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effects {
    allowed: [bool; EffectKind::ALL.len()],
}

impl Default for Effects {
    fn default() -> Self {
        Self::all()
    }
}

impl Effects {
    /// Every kind.
    pub fn all() -> Self {
        Self::of(EffectKind::ALL)
    }

    /// No kind.
    pub fn none() -> Self {
        Self::of(&[])
    }

    /// Given kinds.
    pub fn of(kinds: &[EffectKind]) -> Self {
        Self {
            allowed: std::array::from_fn(|i| kinds.contains(&EffectKind::ALL[i])),
        }
    }

    /// The same but for one kind.
    #[must_use]
    pub fn without(mut self, kind: EffectKind) -> Self {
        self.allowed[kind as usize] = false;
        self
    }

    /// The effects allowed, in their order.
    pub fn iter(self) -> impl Iterator<Item = Effect> {
        let allowed = move |e: &Effect| self.allowed[e.kind() as usize];
        Effect::ALL.iter().copied().filter(allowed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_places_and_names_are_those_of_the_lists() {
        for (i, effect) in Effect::ALL.iter().enumerate() {
            assert_eq!(effect.place(), i);
        }
        for kind in EffectKind::ALL {
            assert_eq!(kind.name().parse(), Ok(*kind));
        }
        assert!("gravity".parse::<EffectKind>().is_err());
        assert_eq!(Effects::all().iter().count(), Effect::COUNT);
        let one = Effects::of(&[EffectKind::Friction]);
        assert_eq!(one.iter().collect::<Vec<_>>(), vec![Effect::Friction]);
    }
}
