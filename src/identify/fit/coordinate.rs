//! The coordinates of a fit.

use serde::{Deserialize, Serialize};

use super::effect::Effect;
use super::gap_errors::MOST_GAPS;

/// Names of those errors.
const GAP_NAMES: [&str; MOST_GAPS] = [
    "clearance_error_1_mm",
    "clearance_error_2_mm",
    "clearance_error_3_mm",
    "clearance_error_4_mm",
    "clearance_error_5_mm",
    "clearance_error_6_mm",
    "clearance_error_7_mm",
    "clearance_error_8_mm",
    "clearance_error_9_mm",
    "clearance_error_10_mm",
    "clearance_error_11_mm",
    "clearance_error_12_mm",
    "clearance_error_13_mm",
    "clearance_error_14_mm",
    "clearance_error_15_mm",
    "clearance_error_16_mm",
    "clearance_error_17_mm",
    "clearance_error_18_mm",
    "clearance_error_19_mm",
    "clearance_error_20_mm",
    "clearance_error_21_mm",
    "clearance_error_22_mm",
    "clearance_error_23_mm",
    "clearance_error_24_mm",
    "clearance_error_25_mm",
    "clearance_error_26_mm",
    "clearance_error_27_mm",
    "clearance_error_28_mm",
    "clearance_error_29_mm",
    "clearance_error_30_mm",
    "clearance_error_31_mm",
    "clearance_error_32_mm",
    "clearance_error_33_mm",
    "clearance_error_34_mm",
    "clearance_error_35_mm",
    "clearance_error_36_mm",
    "clearance_error_37_mm",
    "clearance_error_38_mm",
    "clearance_error_39_mm",
    "clearance_error_40_mm",
    "clearance_error_41_mm",
    "clearance_error_42_mm",
    "clearance_error_43_mm",
    "clearance_error_44_mm",
    "clearance_error_45_mm",
    "clearance_error_46_mm",
    "clearance_error_47_mm",
    "clearance_error_48_mm",
];

/// One coordinate of the fit: R itself, the logarithms of f0, β, `x_st`, the gains and the
/// corners, the asymmetries and effects themselves, delays in ms, errors of clearances in mm.
#[derive(
    Debug, Default, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize,
)]
#[serde(into = "String", try_from = "String")]
pub enum Coordinate {
    /// R
    #[default]
    Restitution,
    /// ln f0
    Frequency,
    /// ln β
    Damping,
    /// ln `x_st`
    Deflection,
    /// (`F_x` − `F_y)/F0`
    DriveAsymmetry,
    /// (`k_x` − `k_y)/k`
    StiffnessAsymmetry,
    /// (`b_x` − `b_y)/b`
    DampingAsymmetry,
    /// (`m_x` − `m_y)/m`
    MassAsymmetry,
    /// ln of a channel's gain, by its index in [`Parameters::gains`]
    Gain(usize),
    /// ln of a channel's corner, by its index in [`Parameters::corners`]
    Corner(usize),
    /// Delay of a channel, ms, by its index in [`Parameters::delays_s`]
    Delay(usize),
    /// Strength of an effect beyond the model
    Effect(Effect),
    /// Common error of all clearances, mm
    ScrewZero,
    /// Error of one stated clearance, mm, by its place among them
    Gap(usize),
}

impl Coordinate {
    /// The four parameters that the user asks for.
    pub const PHYSICAL: [Self; 4] = [
        Self::Restitution,
        Self::Frequency,
        Self::Damping,
        Self::Deflection,
    ];

    /// Name in `identification.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Restitution => "restitution",
            Self::Frequency => "natural_frequency_hz",
            Self::Damping => "damping_ratio",
            Self::Deflection => "static_deflection_m",
            Self::DriveAsymmetry => "drive_asymmetry",
            Self::StiffnessAsymmetry => "stiffness_asymmetry",
            Self::DampingAsymmetry => "damping_asymmetry",
            Self::MassAsymmetry => "mass_asymmetry",
            Self::Delay(0) => "delay_velocity_x_ms",
            Self::Delay(1) => "delay_velocity_y_ms",
            Self::Delay(2) => "delay_displacement_x_ms",
            Self::Delay(_) => "delay_displacement_y_ms",
            Self::Effect(effect) => effect.name(),
            Self::ScrewZero => "screw_zero_mm",
            Self::Gap(i) => GAP_NAMES.get(i).copied().unwrap_or("clearance_error_mm"),
            Self::Gain(0) => "gain_velocity_x",
            Self::Gain(1) => "gain_velocity_y",
            Self::Gain(2) => "gain_displacement_x",
            Self::Gain(_) => "gain_displacement_y",
            Self::Corner(0) => "corner_velocity_x",
            Self::Corner(1) => "corner_velocity_y",
            Self::Corner(2) => "corner_displacement_x",
            Self::Corner(_) => "corner_displacement_y",
        }
    }

    /// All coordinates.
    pub fn all() -> impl Iterator<Item = Self> {
        let single = [
            Self::DriveAsymmetry,
            Self::StiffnessAsymmetry,
            Self::DampingAsymmetry,
            Self::MassAsymmetry,
            Self::ScrewZero,
        ];
        let channels = (0..4).map(Self::Gain).chain((0..4).map(Self::Corner));
        Self::PHYSICAL
            .into_iter()
            .chain(single)
            .chain(channels.chain((0..4).map(Self::Delay)))
            .chain(Effect::ALL.map(Self::Effect))
            .chain((0..MOST_GAPS).map(Self::Gap))
    }

    /// Symbol in running text.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Restitution => "R",
            Self::Frequency => "f0",
            Self::Damping => "β",
            Self::Deflection => "x_st",
            other => other.name(),
        }
    }

    /// Whether the coordinate is a logarithm of the value.
    pub fn is_logarithm(self) -> bool {
        matches!(
            self,
            Self::Frequency | Self::Damping | Self::Deflection | Self::Gain(_) | Self::Corner(_)
        )
    }

    /// How much a physical value changes per unit of the coordinate: by itself where that is a logarithm.
    pub fn slope(self, value: f64) -> f64 {
        if self.is_logarithm() { value } else { 1.0 }
    }

    /// The physical value of one of this coordinate.
    pub fn physical(self, value: f64) -> f64 {
        if self.is_logarithm() {
            value.exp()
        } else {
            value
        }
    }
}

impl From<Coordinate> for String {
    fn from(coordinate: Coordinate) -> Self {
        coordinate.name().to_owned()
    }
}

/// A name that no coordinate has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no parameter is named '{0}'")]
pub struct UnknownCoordinate(String);

impl TryFrom<String> for Coordinate {
    type Error = UnknownCoordinate;

    fn try_from(name: String) -> Result<Self, UnknownCoordinate> {
        let found = Self::all().find(|c| c.name() == name);
        found.ok_or(UnknownCoordinate(name))
    }
}
