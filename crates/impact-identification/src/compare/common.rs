//! What campaigns on one rig may have in common.

use serde::{Deserialize, Serialize};

use impact_fit::parameters::coordinate::Coordinate;
use impact_fit::parameters::effect::EffectKind;

/// A kind of error or asymmetry that stays the same from campaign to campaign on a rig.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
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
pub enum Common {
    /// Errors of the channels' scales.
    Gains,
    /// Errors of the corners of the channels' high-pass.
    Corners,
    /// Delays of the channels.
    Delays,
    /// The common error of all clearances: the zero of the screw.
    ClearanceZero,
    /// That one, and the error of each stated clearance.
    Clearances,
    /// How drive, springs, dampers and masses differ between x and y.
    Asymmetries,
    /// Second and third harmonic of the drive.
    Harmonics,
    /// The force against frequency.
    ForceFrequency,
}

impl Common {
    /// All of them.
    pub const ALL: &'static [Self] = <Self as strum::VariantArray>::VARIANTS;

    /// Name in `campaign.toml`.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The kind that a coordinate of a fit belongs to; `None` of what each campaign has of its own: the
    /// parameters, drifts, friction, hardening, contacts.
    pub fn of(coordinate: Coordinate) -> Option<Self> {
        match coordinate {
            Coordinate::Gain(_) => Some(Self::Gains),
            Coordinate::Corner(_) => Some(Self::Corners),
            Coordinate::Delay(_) => Some(Self::Delays),
            Coordinate::ScrewZero => Some(Self::ClearanceZero),
            Coordinate::Gap(_) => Some(Self::Clearances),
            Coordinate::DriveAsymmetry
            | Coordinate::StiffnessAsymmetry
            | Coordinate::DampingAsymmetry
            | Coordinate::MassAsymmetry => Some(Self::Asymmetries),
            Coordinate::Effect(effect) => match effect.kind() {
                EffectKind::Harmonics => Some(Self::Harmonics),
                EffectKind::ForceFrequency => Some(Self::ForceFrequency),
                _ => None,
            },
            Coordinate::Restitution
            | Coordinate::Frequency
            | Coordinate::Damping
            | Coordinate::Deflection => None,
        }
    }

    /// Whether stating some kinds states this one.
    pub fn is_stated_in(self, stated: &[Self]) -> bool {
        let zero_too = self == Self::ClearanceZero && stated.contains(&Self::Clearances);
        zero_too || stated.contains(&self)
    }
}
