//! The parameters that are fitted, as physical values and as the coordinates of a solver.

use serde::{Deserialize, Serialize};

use crate::event::{CornerShift, RigKind};
use crate::record::Role;
use impact_oscillator::model::params::{
    Contact, Flight, Machine, Oscillator, Restitution, Setting,
};

/// Parameters of rig and instruments.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Parameters {
    /// Coefficient of restitution R.
    pub restitution: f64,
    /// Natural frequency f0, Hz; of two masses the geometric mean.
    pub natural_frequency_hz: f64,
    /// Damping ratio β.
    pub damping_ratio: f64,
    /// Static deflection x_st, m; of two masses the mean.
    pub static_deflection_m: f64,
    /// (F_x − F_y)/F0.
    pub drive_asymmetry: f64,
    /// (k_x − k_y)/k.
    pub stiffness_asymmetry: f64,
    /// Gain of the channels over the stated one: velocity x, y, displacement x, y.
    pub gains: [f64; 4],
    /// Corner of the channels' high-pass over the stated one, in the same order.
    pub corners: [f64; 4],
}

impl Parameters {
    /// Parameters without asymmetry and with exact gains.
    pub fn symmetric(
        restitution: f64,
        natural_frequency_hz: f64,
        damping_ratio: f64,
        static_deflection_m: f64,
    ) -> Self {
        Self {
            restitution,
            natural_frequency_hz,
            damping_ratio,
            static_deflection_m,
            drive_asymmetry: 0.0,
            stiffness_asymmetry: 0.0,
            gains: [1.0; 4],
            corners: [1.0; 4],
        }
    }

    /// The machine, dimensionless: masses about the nominal one.
    pub fn machine(&self, rig: RigKind) -> Machine {
        let mass = |sign: f64| Oscillator {
            mass: 1.0,
            natural_frequency_ratio: (1.0 + 0.5 * sign * self.stiffness_asymmetry)
                .max(0.01)
                .sqrt(),
            damping_ratio: self.damping_ratio,
            drive_amplitude: 1.0 + 0.5 * sign * self.drive_asymmetry,
        };
        let restitution = Restitution::Constant(self.restitution.clamp(0.0, 1.0));
        let (x, y) = match rig {
            RigKind::Double => (mass(1.0), Some(mass(-1.0))),
            RigKind::Single => (Oscillator::nominal(self.damping_ratio), None),
        };
        Machine {
            x,
            y,
            contact: Contact::Rigid(restitution),
            flight: Flight::Harmonic,
        }
    }

    /// Of a machine whose masses are alike.
    pub fn without_asymmetry(self) -> Self {
        Self {
            drive_asymmetry: 0.0,
            stiffness_asymmetry: 0.0,
            ..self
        }
    }

    /// η and ρ of a setting; the drive amplitude scales the static deflection.
    pub fn setting(&self, frequency_hz: f64, clearance_m: f64, drive_amplitude: f64) -> Setting {
        Setting::new(
            frequency_hz / self.natural_frequency_hz,
            clearance_m / (self.static_deflection_m * drive_amplitude),
        )
    }

    /// Natural angular frequency Ω, rad/s.
    pub fn natural_rate(&self) -> f64 {
        std::f64::consts::TAU * self.natural_frequency_hz
    }

    /// Gain of a channel; 1 for channels that carry none.
    pub fn gain(&self, role: Role) -> f64 {
        gain_index(role).map_or(1.0, |i| self.gains[i])
    }

    /// Corner of a channel's high-pass over the stated one; 1 for channels that have none.
    pub fn corner(&self, role: Role) -> f64 {
        gain_index(role).map_or(1.0, |i| self.corners[i])
    }

    /// What a corner other than the stated one changes of a speed at an impact, m/s.
    pub fn corner_shift_m_s(&self, shift: &CornerShift) -> f64 {
        self.corner(shift.role).ln() * shift.speed_m_s
    }

    /// Value of one coordinate.
    pub fn coordinate(&self, coordinate: Coordinate) -> f64 {
        match coordinate {
            Coordinate::Restitution => self.restitution,
            Coordinate::Frequency => self.natural_frequency_hz.ln(),
            Coordinate::Damping => self.damping_ratio.ln(),
            Coordinate::Deflection => self.static_deflection_m.ln(),
            Coordinate::DriveAsymmetry => self.drive_asymmetry,
            Coordinate::StiffnessAsymmetry => self.stiffness_asymmetry,
            Coordinate::Gain(i) => self.gains[i].ln(),
            Coordinate::Corner(i) => self.corners[i].ln(),
        }
    }

    /// The parameters with one coordinate set.
    pub fn with(mut self, coordinate: Coordinate, value: f64) -> Self {
        match coordinate {
            Coordinate::Restitution => self.restitution = value,
            Coordinate::Frequency => self.natural_frequency_hz = value.exp(),
            Coordinate::Damping => self.damping_ratio = value.exp(),
            Coordinate::Deflection => self.static_deflection_m = value.exp(),
            Coordinate::DriveAsymmetry => self.drive_asymmetry = value,
            Coordinate::StiffnessAsymmetry => self.stiffness_asymmetry = value,
            Coordinate::Gain(i) => self.gains[i] = value.exp(),
            Coordinate::Corner(i) => self.corners[i] = value.exp(),
        }
        self
    }

    /// Whether the model's range holds them.
    pub fn in_range(&self) -> bool {
        (0.0..=1.0).contains(&self.restitution)
            && self.damping_ratio < 0.95
            && self.drive_asymmetry.abs() < 1.0
            && self.stiffness_asymmetry.abs() < 1.0
            && self.natural_frequency_hz.is_finite()
            && self.static_deflection_m.is_finite()
    }
}

/// Position of a motion channel among the gains and among the corners.
pub fn gain_index(role: Role) -> Option<usize> {
    match role {
        Role::VelocityX => Some(0),
        Role::VelocityY => Some(1),
        Role::DisplacementX => Some(2),
        Role::DisplacementY => Some(3),
        _ => None,
    }
}

/// One coordinate of the fit: R itself, the logarithms of f0, β, x_st, the gains and the
/// corners, the asymmetries themselves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub enum Coordinate {
    /// R
    Restitution,
    /// ln f0
    Frequency,
    /// ln β
    Damping,
    /// ln x_st
    Deflection,
    /// (F_x − F_y)/F0
    DriveAsymmetry,
    /// (k_x − k_y)/k
    StiffnessAsymmetry,
    /// ln of a channel's gain, by its index in [`Parameters::gains`]
    Gain(usize),
    /// ln of a channel's corner, by its index in [`Parameters::corners`]
    Corner(usize),
}

impl Coordinate {
    /// The four parameters that the user asks for.
    pub const PHYSICAL: [Coordinate; 4] = [
        Coordinate::Restitution,
        Coordinate::Frequency,
        Coordinate::Damping,
        Coordinate::Deflection,
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
    pub fn all() -> impl Iterator<Item = Coordinate> {
        let asymmetries = [Self::DriveAsymmetry, Self::StiffnessAsymmetry];
        let channels = (0..4).map(Self::Gain).chain((0..4).map(Self::Corner));
        Self::PHYSICAL
            .into_iter()
            .chain(asymmetries)
            .chain(channels)
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
        !matches!(
            self,
            Self::Restitution | Self::DriveAsymmetry | Self::StiffnessAsymmetry
        )
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
