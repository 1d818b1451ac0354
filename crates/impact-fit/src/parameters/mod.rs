//! The parameters that are fitted, as physical values and as the coordinates of a solver.

#[cfg(test)]
mod contact_laws;
pub mod coordinate;
pub mod effect;
pub mod gap_errors;
pub mod own;

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

pub use self::coordinate::{CHANNELS, Coordinate};
use self::effect::Effect;
use self::gap_errors::GapErrors;
use impact_oscillator::model::params::{
    Contact, Flight, Machine, Oscillator, Restitution, Setting,
};
use impact_records::event::{CornerShift, RigKind};
use impact_records::record::Role;

/// Logarithm of the ratio of both drives beyond which the lesser is none: what it moves is less than any converter resolves
/// (e^−16 is 2^−23).
pub const MOST_UNLIKE_DRIVES: f64 = 16.0;

/// Parameters of rig and instruments.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Parameters {
    /// Coefficient of restitution R.
    pub restitution: f64,
    /// Natural frequency f0, Hz; of two masses the geometric mean √(`f_x` `f_y`).
    pub natural_frequency_hz: f64,
    /// Damping ratio β; of two masses the mean.
    pub damping_ratio: f64,
    /// Static deflection `x_st`, m; of two masses the mean.
    pub static_deflection_m: f64,
    /// ln(`F_x`/`F_y`), forces per unit of mass.
    pub drive_asymmetry: f64,
    /// ln(`k_x`/`k_y`), stiffnesses per unit of mass.
    pub stiffness_asymmetry: f64,
    /// ln(`b_x`/`b_y`), coefficients of damping per unit of mass.
    #[serde(default)]
    pub damping_asymmetry: f64,
    /// ln(`m_x`/`m_y`).
    #[serde(default)]
    pub mass_asymmetry: f64,
    /// Gain of the channels over the stated one, in the order of [`GAIN_ROLES`].
    pub gains: [f64; CHANNELS],
    /// Corner of the channels' high-pass over the stated one, in the same order.
    pub corners: [f64; CHANNELS],
    /// Delay of the channels against the drive's, s, in the same order.
    #[serde(default)]
    pub delays_s: [f64; CHANNELS],
    /// Strengths of the effects beyond the model, by their places; zero of those that results of earlier versions lack.
    #[serde(default = "no_effects", deserialize_with = "effects")]
    pub effects: [f64; Effect::COUNT],
    /// Common error of all clearances (the zero of the screw that sets them), m.
    #[serde(default)]
    pub screw_zero_m: f64,
    /// Error of each stated clearance beside it, m, in the order of the stated ones.
    #[serde(default)]
    pub gap_errors_m: GapErrors,
}

fn no_effects() -> [f64; Effect::COUNT] {
    [0.0; Effect::COUNT]
}

/// The strengths of the first effects, up to all of them.
fn effects<'de, D: Deserializer<'de>>(from: D) -> Result<[f64; Effect::COUNT], D::Error> {
    let known = Vec::<f64>::deserialize(from)?;
    let mut all = no_effects();
    let first = all.get_mut(..known.len());
    first
        .ok_or_else(|| D::Error::invalid_length(known.len(), &"the strengths of known effects"))?
        .copy_from_slice(&known);
    Ok(all)
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
            gains: [1.0; CHANNELS],
            corners: [1.0; CHANNELS],
            delays_s: [0.0; CHANNELS],
            effects: [0.0; Effect::COUNT],
            screw_zero_m: 0.0,
            gap_errors_m: GapErrors::default(),
        }
    }

    /// The machine, dimensionless: masses about the nominal one, so that √(`f_x` `f_y`) is f0 and
    /// the means of both masses' damping ratios and static deflections are β and `x_st`, whatever
    /// the asymmetries. Stiffness, damping and drive are per unit of mass, so that unlike masses
    /// change the impact alone; coefficients of damping are alike where stiffnesses differ (the
    /// paper's eq. 15).
    pub fn machine(&self, rig: RigKind) -> Machine {
        // (e^u + e^−u)/2 = cosh u: what the mean of two values in the ratio e^2u is over
        // their geometric mean.
        let ratio = 0.25 * self.stiffness_asymmetry;
        let damping = 0.5 * self.damping_asymmetry - ratio;
        let deflection = 0.5 * self.drive_asymmetry - 2.0 * ratio;
        let mass = |sign: f64| {
            let natural_frequency_ratio = (sign * ratio).exp();
            let mass = (0.5 * sign * self.mass_asymmetry).exp();
            let drive_per_mass = (0.5 * sign * self.drive_asymmetry).exp() / deflection.cosh();
            Oscillator {
                mass,
                natural_frequency_ratio,
                damping_ratio: self.damping_ratio * (sign * damping).exp() / damping.cosh(),
                drive_amplitude: mass * drive_per_mass,
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

    /// R, f0, β and `x_st` of these, of an ideal rig with ideal instruments.
    #[must_use]
    pub fn ideal(&self) -> Self {
        Self::symmetric(
            self.restitution,
            self.natural_frequency_hz,
            self.damping_ratio,
            self.static_deflection_m,
        )
    }

    /// Whether the model's range holds them.
    pub fn in_range(&self) -> bool {
        (0.0..=1.0).contains(&self.restitution)
            && self.damping_ratio < 0.95
            && self.drive_asymmetry.abs() < MOST_UNLIKE_DRIVES
            && self.stiffness_asymmetry.abs() < 1.0
            && self.damping_asymmetry.abs() < 1.0
            && self.mass_asymmetry.abs() < 1.0
            && self.effects.iter().all(|e| e.abs() < 10.0)
            && self.natural_frequency_hz.is_finite()
            && self.static_deflection_m.is_finite()
    }
}

/// The motion channels in the order of the gains, the corners and the delays.
pub const GAIN_ROLES: [Role; CHANNELS] = [
    Role::VelocityX,
    Role::VelocityY,
    Role::DisplacementX,
    Role::DisplacementY,
    Role::AccelerationX,
    Role::AccelerationY,
];

/// Position of a motion channel among the gains and among the corners.
pub fn gain_index(role: Role) -> Option<usize> {
    GAIN_ROLES.iter().position(|r| *r == role)
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, Matrix2, Vector2};

    use super::*;

    #[test]
    fn strengths_of_effects_that_earlier_results_lack_are_zero() {
        let mut whole = Parameters::symmetric(0.8, 12.0, 0.05, 1e-3);
        whole.effects = [0.25; Effect::COUNT];
        let mut written = serde_json::to_value(whole).expect("JSON");
        let strengths = written["effects"].as_array_mut().expect("a list");
        strengths.pop();
        let read: Parameters = serde_json::from_value(written.clone()).expect("parameters");
        assert_eq!(read.effects[Effect::COUNT - 2..], [0.25, 0.0]);
        let strengths = written["effects"].as_array_mut().expect("a list");
        strengths.extend([0.0.into(), 0.0.into()]);
        assert!(serde_json::from_value::<Parameters>(written).is_err());
    }

    /// f0, β and `x_st` of two uncoupled masses over the nominal ones, from the eigenvalues of their
    /// state matrix and the solution of their static equations; frequencies are assigned to masses by
    /// nothing: both means take them all.
    fn means(masses: [&Oscillator; 2]) -> [f64; 3] {
        let diagonal = |of: fn(&Oscillator) -> f64| {
            Matrix2::from_diagonal(&Vector2::new(of(masses[0]), of(masses[1])))
        };
        let mass = diagonal(|o| o.mass);
        let stiffness = diagonal(|o| o.mass * o.natural_frequency_ratio.powi(2));
        let dashpots = diagonal(|o| 2.0 * o.damping_ratio * o.mass * o.natural_frequency_ratio);
        let inverse = mass.try_inverse().expect("masses");
        let mut state = DMatrix::zeros(4, 4);
        state.view_mut((0, 2), (2, 2)).fill_with_identity();
        state
            .view_mut((2, 0), (2, 2))
            .copy_from(&(-inverse * stiffness));
        state
            .view_mut((2, 2), (2, 2))
            .copy_from(&(-inverse * dashpots));
        let eigenvalues = state.complex_eigenvalues();
        let rates = eigenvalues.iter().map(|l| l.norm());
        let ratios = eigenvalues.iter().map(|l| -l.re / l.norm());
        let forces = Vector2::new(masses[0].drive_amplitude, masses[1].drive_amplitude);
        let deflections = stiffness.lu().solve(&forces).expect("springs");
        [
            rates.product::<f64>().powf(0.25),
            0.25 * ratios.sum::<f64>(),
            deflections.mean(),
        ]
    }

    #[test]
    fn valid_f0_beta_and_x_st_are_the_means_of_the_masses_eigenvalues() {
        let at = |i: usize| [-0.4, -0.1, 0.0, 0.2][i % 4];
        for i in 0..64 {
            let [drive_asymmetry, stiffness_asymmetry] = [at(i), at(i / 4)];
            let damping_asymmetry = at(i / 16);
            for mass_asymmetry in [0.0, 0.3] {
                let parameters = Parameters {
                    drive_asymmetry,
                    stiffness_asymmetry,
                    damping_asymmetry,
                    mass_asymmetry,
                    ..Parameters::symmetric(0.8, 12.0, 0.06, 1e-3)
                };
                let machine = parameters.machine(RigKind::Double);
                let y = machine.y.expect("two masses");
                let [rate, damping, deflection] = means([&machine.x, &y]);
                assert!((rate - 1.0).abs() < 1e-12, "{rate}");
                assert!((damping - 0.06).abs() < 1e-12, "{damping}");
                assert!((deflection - 1.0).abs() < 1e-12, "{deflection}");
                let ratio = machine.x.stiffness_per_mass() / y.stiffness_per_mass();
                assert!((ratio.ln() - stiffness_asymmetry).abs() < 1e-12);
                let ratio = machine.x.drive_per_mass() / y.drive_per_mass();
                assert!((ratio.ln() - drive_asymmetry).abs() < 1e-12);
                let ratio = machine.x.decay_rate() / y.decay_rate();
                assert!((ratio.ln() - damping_asymmetry).abs() < 1e-12);
                assert!(((machine.x.mass / y.mass).ln() - mass_asymmetry).abs() < 1e-12);
            }
        }
    }
}
