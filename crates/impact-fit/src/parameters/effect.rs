//! What springs, drive and contact of a real rig add to the model: small effects, each a coordinate of
//! the fit whose prior is centred on zero and as wide as a good laboratory would accept.

use serde::{Deserialize, Serialize};
use strum::VariantArray;

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

/// Unit in which the strength of an effect is stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StrengthUnit {
    /// Of a relative strength.
    Percent,
    /// Of a length in milliseconds.
    Milliseconds,
    /// Of a change of R.
    One,
}

impl StrengthUnit {
    /// Symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Percent => "%",
            Self::Milliseconds => "ms",
            Self::One => "",
        }
    }

    /// The strength in this unit over the coordinate of the fit.
    pub fn factor(self) -> f64 {
        match self {
            Self::Percent => 100.0,
            Self::Milliseconds | Self::One => 1.0,
        }
    }
}

/// What an effect acts on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Acts {
    /// The masses, by a small extra acceleration along an orbit ([`crate::evidence::forces`]).
    Masses,
    /// What a channel shows of a mass ([`crate::evidence::pickup`]).
    Channel,
    /// f0, β or `x_st` that a record has of its own ([`super::own`]).
    Oscillator,
    /// R and the clearance that a record has of its own, so that it has no effect without impacts ([`super::own`]).
    Impacts,
}

/// What is known of an effect.
struct Row {
    kind: EffectKind,
    accepted: f64,
    unit: StrengthUnit,
    acts: Acts,
}

/// Defines [`Effect`], a row each: what it is, its name in `identification.json`, which is also the key of its texts,
/// its kind, the standard deviation of its prior (centred on zero), the unit of its strength, and what it changes.
macro_rules! effects {
    ($(
        $(#[$attribute:meta])*
        $effect:ident = $name:literal: $kind:ident, $accepted:literal, $unit:ident, $acts:ident;
    )+) => {
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
        #[serde(rename_all = "snake_case")]
        pub enum Effect {
            $(
                $(#[$attribute])*
                #[strum(to_string = $name)]
                $effect,
            )+
        }

        /// The rows in the order of the effects.
        const ROWS: [Row; Effect::COUNT] = [
            $(Row {
                kind: EffectKind::$kind,
                accepted: $accepted,
                unit: StrengthUnit::$unit,
                acts: Acts::$acts,
            }),+
        ];
    };
}

effects! {
    #[default]
    /// cos 2θ in the driving force, relative to F0
    SecondHarmonicCos = "drive_harmonic_2_cos": Harmonics, 5e-3, Percent, Masses;
    /// sin 2θ
    SecondHarmonicSin = "drive_harmonic_2_sin": Harmonics, 5e-3, Percent, Masses;
    /// cos 3θ
    ThirdHarmonicCos = "drive_harmonic_3_cos": Harmonics, 5e-3, Percent, Masses;
    /// sin 3θ
    ThirdHarmonicSin = "drive_harmonic_3_sin": Harmonics, 5e-3, Percent, Masses;
    /// Relative change of the force per unit of η, about η = 1
    ForceSlope = "force_slope": ForceFrequency, 2e-2, Percent, Oscillator;
    /// Relative change of the force per unit of (η − 1)²
    ForceCurve = "force_curve": ForceFrequency, 1e-2, Percent, Oscillator;
    /// Relative rise of the springs' secant stiffness at the greatest displacement measured
    Hardening = "hardening": Hardening, 5e-3, Percent, Masses;
    /// Coulomb friction relative to F0
    Friction = "friction": Friction, 5e-3, Percent, Masses;
    /// Relative change of f0 from the first record to the last
    FrequencyDrift = "frequency_drift": Drift, 3e-3, Percent, Oscillator;
    /// Relative change of f0 in the middle of the campaign against both ends
    FrequencyBend = "frequency_drift_bend": Drift, 1e-3, Percent, Oscillator;
    /// Relative change of β from the first record to the last
    DampingDrift = "damping_drift": Drift, 2e-2, Percent, Oscillator;
    /// Relative change of `x_st` (the force) from the first record to the last
    DeflectionDrift = "deflection_drift": Drift, 5e-3, Percent, Oscillator;
    /// Length of a contact, ms
    ContactDuration = "contact_duration_ms": ContactDuration, 0.6, Milliseconds, Impacts;
    /// Relative departure of what a contact's length makes of R from that of a spring and a damper: as laws of
    /// contact depart from it
    ContactLaw = "contact_law": ContactDuration, 0.45, Percent, Impacts;
    /// What the masses' acceleration during a contact adds to the distance that they press into each
    /// other: relative, per unit of acceleration × duration / approach speed
    ContactReach = "contact_reach": ContactDuration, 0.3, Percent, Impacts;
    /// How a contact's length falls with the approach speed: the exponent, 0 of a linear spring, 1/5 of round bodies
    /// (Hertz), over the campaign's typical speed
    ContactSpeed = "contact_speed": ContactDuration, 0.2, Percent, Impacts;
    /// Change of R per factor e of the approach speed, about the median speed of the impacts
    RestitutionSpeed = "restitution_speed": RestitutionSpeed, 2e-2, One, Impacts;
    /// Drag that grows with the square of the velocity, relative to F0 at the velocity 2πf0 times the
    /// greatest displacement measured
    Drag = "drag": Drag, 1e-2, Percent, Masses;
    /// Relative rise of the springs' secant stiffness from rest to the greatest displacement measured
    /// toward the other mass, and fall as far on the other side
    SpringAsymmetry = "spring_asymmetry": SpringAsymmetry, 5e-3, Percent, Masses;
    /// Share of the damping at η = 1 that is hysteretic (structural): it falls with the frequency
    HystereticDamping = "hysteretic_damping": HystereticDamping, 0.1, Percent, Oscillator;
    /// Change of every clearance from the first record to the last, relative to `x_st`
    ClearanceDrift = "clearance_drift": Drift, 1e-2, Percent, Impacts;
    /// What the channel of mass x picks up from the drive, relative to its greatest amplitude
    PickupX = "pickup_x": Pickup, 1e-3, Percent, Channel;
    /// The same of mass y
    PickupY = "pickup_y": Pickup, 1e-3, Percent, Channel;
    /// Change of R from the first record to the last
    RestitutionDrift = "restitution_drift": Drift, 1e-2, One, Impacts;
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

    fn row(self) -> &'static Row {
        &ROWS[self as usize]
    }

    /// The kind it belongs to.
    pub fn kind(self) -> EffectKind {
        self.row().kind
    }

    /// Standard deviation of its prior: what a good laboratory would accept.
    pub fn accepted(self) -> f64 {
        self.row().accepted
    }

    /// Unit in which its strength is stated.
    pub fn unit(self) -> StrengthUnit {
        self.row().unit
    }

    /// What it acts on.
    pub fn acts(self) -> Acts {
        self.row().acts
    }

    /// Whether it changes the values of an orbit; the others change the parameters of a record.
    pub fn is_perturbation(self) -> bool {
        matches!(self.acts(), Acts::Masses | Acts::Channel)
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
