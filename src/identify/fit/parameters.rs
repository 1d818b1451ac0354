//! The parameters that are fitted, as physical values and as the coordinates of a solver.

use serde::{Deserialize, Serialize};

pub use super::coordinate::Coordinate;
use super::gap_errors::GapErrors;
use crate::event::{CornerShift, RigKind};
use crate::identify::fit::effect::Effect;
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
    /// Static deflection `x_st`, m; of two masses the mean.
    pub static_deflection_m: f64,
    /// (`F_x` − `F_y)/F0`.
    pub drive_asymmetry: f64,
    /// (`k_x` − `k_y)/k`, per unit of mass.
    pub stiffness_asymmetry: f64,
    /// (`b_x` − `b_y)/b`, per unit of mass.
    #[serde(default)]
    pub damping_asymmetry: f64,
    /// (`m_x` − `m_y)/m`.
    #[serde(default)]
    pub mass_asymmetry: f64,
    /// Gain of the channels over the stated one: velocity x, y, displacement x, y.
    pub gains: [f64; 4],
    /// Corner of the channels' high-pass over the stated one, in the same order.
    pub corners: [f64; 4],
    /// Delay of the channels against the drive's, s, in the same order.
    #[serde(default)]
    pub delays_s: [f64; 4],
    /// Strengths of the effects beyond the model, by their places.
    #[serde(default)]
    pub effects: [f64; Effect::COUNT],
    /// Common error of all clearances (the zero of the screw that sets them), m.
    #[serde(default)]
    pub screw_zero_m: f64,
    /// Error of each stated clearance beside it, m, in the order of the stated ones.
    #[serde(default)]
    pub gap_errors_m: GapErrors,
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
            damping_asymmetry: 0.0,
            mass_asymmetry: 0.0,
            gains: [1.0; 4],
            corners: [1.0; 4],
            delays_s: [0.0; 4],
            effects: [0.0; Effect::COUNT],
            screw_zero_m: 0.0,
            gap_errors_m: GapErrors::default(),
        }
    }

    /// The machine, dimensionless: masses about the nominal one. The coefficients of damping are
    /// alike where stiffnesses differ (the paper's eq. 15); asymmetries are per unit of mass, so
    /// that unlike masses change the impact alone.
    pub fn machine(&self, rig: RigKind) -> Machine {
        let mass = |sign: f64| {
            let of = |asymmetry: f64| (1.0 + 0.5 * sign * asymmetry).max(0.01);
            let natural_frequency_ratio = of(self.stiffness_asymmetry).sqrt();
            let decay_rate = self.damping_ratio * of(self.damping_asymmetry);
            let mass = of(self.mass_asymmetry);
            Oscillator {
                mass,
                natural_frequency_ratio,
                damping_ratio: decay_rate / natural_frequency_ratio,
                drive_amplitude: mass * of(self.drive_asymmetry),
            }
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
    #[must_use]
    pub fn without_asymmetry(self) -> Self {
        Self {
            drive_asymmetry: 0.0,
            stiffness_asymmetry: 0.0,
            damping_asymmetry: 0.0,
            mass_asymmetry: 0.0,
            ..self
        }
    }

    /// Strength of an effect beyond the model.
    pub fn effect(&self, effect: Effect) -> f64 {
        self.effects[effect.place()]
    }

    /// Delay of a channel against the drive's, s; 0 for channels that carry none.
    pub fn delay_s(&self, role: Role) -> f64 {
        gain_index(role).map_or(0.0, |i| self.delays_s[i])
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
            Coordinate::DampingAsymmetry => self.damping_asymmetry,
            Coordinate::MassAsymmetry => self.mass_asymmetry,
            Coordinate::Gain(i) => self.gains[i].ln(),
            Coordinate::Corner(i) => self.corners[i].ln(),
            Coordinate::Delay(i) => 1e3 * self.delays_s[i],
            Coordinate::Effect(effect) => self.effect(effect),
            Coordinate::ScrewZero => 1e3 * self.screw_zero_m,
            Coordinate::Gap(i) => 1e3 * self.gap_errors_m.of(i),
        }
    }

    /// The parameters with one coordinate set.
    #[must_use]
    pub fn with(mut self, coordinate: Coordinate, value: f64) -> Self {
        match coordinate {
            Coordinate::Restitution => self.restitution = value,
            Coordinate::Frequency => self.natural_frequency_hz = value.exp(),
            Coordinate::Damping => self.damping_ratio = value.exp(),
            Coordinate::Deflection => self.static_deflection_m = value.exp(),
            Coordinate::DriveAsymmetry => self.drive_asymmetry = value,
            Coordinate::StiffnessAsymmetry => self.stiffness_asymmetry = value,
            Coordinate::DampingAsymmetry => self.damping_asymmetry = value,
            Coordinate::MassAsymmetry => self.mass_asymmetry = value,
            Coordinate::Gain(i) => self.gains[i] = value.exp(),
            Coordinate::Corner(i) => self.corners[i] = value.exp(),
            Coordinate::Delay(i) => self.delays_s[i] = 1e-3 * value,
            Coordinate::Effect(effect) => self.effects[effect.place()] = value,
            Coordinate::ScrewZero => self.screw_zero_m = 1e-3 * value,
            Coordinate::Gap(i) => self.gap_errors_m.set(i, 1e-3 * value),
        }
        self
    }

    /// Whether the model's range holds them.
    pub fn in_range(&self) -> bool {
        (0.0..=1.0).contains(&self.restitution)
            && self.damping_ratio < 0.95
            && self.drive_asymmetry.abs() < 1.0
            && self.stiffness_asymmetry.abs() < 1.0
            && self.damping_asymmetry.abs() < 1.0
            && self.mass_asymmetry.abs() < 1.0
            && self.effects.iter().all(|e| e.abs() < 10.0)
            && self.natural_frequency_hz.is_finite()
            && self.static_deflection_m.is_finite()
    }
}

/// The motion channels in the order of the gains, the corners and the delays.
pub const GAIN_ROLES: [Role; 4] = [
    Role::VelocityX,
    Role::VelocityY,
    Role::DisplacementX,
    Role::DisplacementY,
];

/// Position of a motion channel among the gains and among the corners.
pub fn gain_index(role: Role) -> Option<usize> {
    GAIN_ROLES.iter().position(|r| *r == role)
}
