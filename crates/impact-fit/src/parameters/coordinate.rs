//! The coordinates of a fit.

use std::sync::LazyLock;

use serde::{Deserialize, Serialize};

use super::effect::Effect;
use super::gap_errors::MOST_GAPS;

/// Motion channels that carry a gain, a corner and a delay.
pub const CHANNELS: usize = 6;

/// Names of the errors of single clearances.
static GAP_NAMES: LazyLock<[String; MOST_GAPS]> =
    LazyLock::new(|| std::array::from_fn(|i| format!("clearance_error_{}_mm", i + 1)));

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
    /// ln(`F_x`/`F_y`), per unit of mass
    DriveAsymmetry,
    /// ln(`k_x`/`k_y`), per unit of mass
    StiffnessAsymmetry,
    /// ln(`b_x`/`b_y`), per unit of mass
    DampingAsymmetry,
    /// ln(`m_x`/`m_y`)
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
            Self::Delay(3) => "delay_displacement_y_ms",
            Self::Delay(4) => "delay_acceleration_x_ms",
            Self::Delay(_) => "delay_acceleration_y_ms",
            Self::Effect(effect) => effect.name(),
            Self::ScrewZero => "screw_zero_mm",
            Self::Gap(i) => GAP_NAMES
                .get(i)
                .map_or("clearance_error_mm", String::as_str),
            Self::Gain(0) => "gain_velocity_x",
            Self::Gain(1) => "gain_velocity_y",
            Self::Gain(2) => "gain_displacement_x",
            Self::Gain(3) => "gain_displacement_y",
            Self::Gain(4) => "gain_acceleration_x",
            Self::Gain(_) => "gain_acceleration_y",
            Self::Corner(0) => "corner_velocity_x",
            Self::Corner(1) => "corner_velocity_y",
            Self::Corner(2) => "corner_displacement_x",
            Self::Corner(3) => "corner_displacement_y",
            Self::Corner(4) => "corner_acceleration_x",
            Self::Corner(_) => "corner_acceleration_y",
        }
    }

    /// Symbol between dollars of what has one.
    pub fn symbol(self) -> Option<&'static str> {
        match self {
            Self::Restitution => Some("$R$"),
            Self::Frequency => Some("$f_0$"),
            Self::Damping => Some("$β$"),
            Self::Deflection => Some("$x_st$"),
            _ => None,
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
        let channels = (0..CHANNELS).map(Self::Gain);
        let channels = channels.chain((0..CHANNELS).map(Self::Corner));
        Self::PHYSICAL
            .into_iter()
            .chain(single)
            .chain(channels.chain((0..CHANNELS).map(Self::Delay)))
            .chain(Effect::ALL.iter().copied().map(Self::Effect))
            .chain((0..MOST_GAPS).map(Self::Gap))
    }

    /// The index of the channel whose gain it is.
    pub fn gain(self) -> Option<usize> {
        match self {
            Self::Gain(index) => Some(index),
            _ => None,
        }
    }

    /// Whether it is about what the laboratory states of its rig and instruments, if only as usual.
    pub fn is_stated(self) -> bool {
        match self {
            Self::DriveAsymmetry
            | Self::StiffnessAsymmetry
            | Self::DampingAsymmetry
            | Self::MassAsymmetry
            | Self::Gain(_)
            | Self::Corner(_)
            | Self::ScrewZero
            | Self::Gap(_) => true,
            Self::Restitution | Self::Frequency | Self::Damping | Self::Deflection => false,
            Self::Delay(_) | Self::Effect(_) => false,
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

    /// This coordinate's value of a physical one.
    pub fn of_physical(self, value: f64) -> f64 {
        if self.is_logarithm() {
            value.ln()
        } else {
            value
        }
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
