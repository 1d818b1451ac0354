//! The parameters that are fitted, as physical values and as the coordinates of a solver.

use serde::{Deserialize, Serialize};

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
    /// Static deflection x_st, m; of two masses the mean.
    pub static_deflection_m: f64,
    /// (F_x − F_y)/F0.
    pub drive_asymmetry: f64,
    /// (k_x − k_y)/k, per unit of mass.
    pub stiffness_asymmetry: f64,
    /// (b_x − b_y)/b, per unit of mass.
    #[serde(default)]
    pub damping_asymmetry: f64,
    /// (m_x − m_y)/m.
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

/// Most stated clearances that carry an error of their own.
pub const MOST_GAPS: usize = 48;

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

/// Errors of the stated clearances, m.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(from = "Vec<f64>", into = "Vec<f64>")]
pub struct GapErrors([f64; MOST_GAPS]);

impl Default for GapErrors {
    fn default() -> Self {
        Self([0.0; MOST_GAPS])
    }
}

impl From<Vec<f64>> for GapErrors {
    fn from(errors: Vec<f64>) -> Self {
        let mut all = Self::default();
        for (place, error) in all.0.iter_mut().zip(errors) {
            *place = error;
        }
        all
    }
}

impl From<GapErrors> for Vec<f64> {
    fn from(errors: GapErrors) -> Self {
        let used = errors.0.iter().rposition(|e| *e != 0.0);
        errors.0[..used.map_or(0, |last| last + 1)].to_vec()
    }
}

/// Where and when a record was taken, as far as effects depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Circumstances {
    /// Drive frequency, Hz.
    pub frequency_hz: f64,
    /// Half the gap as stated, m (against a stop: the whole gap).
    pub clearance_m: f64,
    /// Place of the clearance among the stated ones that carry an error of their own.
    pub gap: Option<usize>,
    /// Place in the campaign: −½ (first record) to ½ (last).
    pub place: f64,
    /// Approach speed at the impacts, m/s; zero without impacts.
    pub approach_m_s: f64,
    /// Acceleration of the masses toward each other at the impacts over the approach speed, 1/s.
    pub press_per_s: f64,
    /// Displacements that close the gap together: 2, or 1 against a stop.
    pub masses: f64,
}

/// Derivative of a record's own parameters over one coordinate of the fit: of R, ln f0, ln β,
/// ln x_st, and of the clearance in m.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OwnSlope {
    /// Of R, ln f0, ln β and ln x_st.
    pub physical: [f64; 4],
    /// Of the clearance, m.
    pub clearance_m: f64,
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

    /// Force over its value at η = 1, and its derivative over η.
    fn lean(&self, eta: f64) -> [f64; 2] {
        let (slope, curve) = (
            self.effect(Effect::ForceSlope),
            self.effect(Effect::ForceCurve),
        );
        let off = eta - 1.0;
        [1.0 + off * (slope + curve * off), slope + 2.0 * curve * off]
    }

    /// The parameters that a record has of its own, and its clearance, m: where drift, the force
    /// against frequency, errors of the clearances and the length of contacts have been applied.
    ///
    /// A contact that lasts a time acts outside of it like an impact where both flights meet.
    pub fn own(&self, at: &Circumstances) -> (Self, f64) {
        let drift = |effect| self.effect(effect) * at.place;
        let bend = self.effect(Effect::FrequencyBend) * bend(at.place);
        let [lean, _] = self.lean(at.frequency_hz / self.natural_frequency_hz);
        let contact_s = 1e-3 * self.effect(Effect::ContactDuration);
        let contact = short_contact(self.restitution);
        let beyond = contact.press * at.press_per_s + contact.drag * self.decay_per_s();
        let restitution = self.restitution + contact_s * beyond;
        let own = Self {
            restitution: restitution.clamp(0.0, 1.0),
            natural_frequency_hz: self.natural_frequency_hz
                * (drift(Effect::FrequencyDrift) + bend).exp(),
            damping_ratio: self.damping_ratio * drift(Effect::DampingDrift).exp(),
            static_deflection_m: self.static_deflection_m
                * lean.max(0.01)
                * drift(Effect::DeflectionDrift).exp(),
            ..*self
        };
        let error = at.gap.map_or(0.0, |i| self.gap_errors_m.0[i]);
        let reach_m = at.approach_m_s * contact_s * contact.reach / at.masses.max(1.0);
        (own, at.clearance_m + self.screw_zero_m + error + reach_m)
    }

    /// How the parameters of [`Parameters::own`] change per unit of a coordinate; `None` where they
    /// do not.
    pub fn own_slope(&self, at: &Circumstances, coordinate: Coordinate) -> Option<OwnSlope> {
        let none = OwnSlope::default();
        let only = |i: usize, slope: f64| {
            let mut physical = [0.0; 4];
            physical[i] = slope;
            Some(OwnSlope { physical, ..none })
        };
        let clearance = |clearance_m: f64| {
            Some(OwnSlope {
                clearance_m,
                ..none
            })
        };
        let eta = at.frequency_hz / self.natural_frequency_hz;
        let [lean, over_eta] = self.lean(eta);
        let contact = short_contact(self.restitution);
        let contact_s = 1e-3 * self.effect(Effect::ContactDuration);
        let speed = at.approach_m_s / at.masses.max(1.0);
        let decay = self.decay_per_s();
        let drag = contact_s * contact.drag * decay;
        match coordinate {
            Coordinate::Restitution => Some(OwnSlope {
                physical: [
                    1.0 + contact_s
                        * (contact.press_slope * at.press_per_s + contact.drag_slope * decay),
                    0.0,
                    0.0,
                    0.0,
                ],
                clearance_m: contact_s * speed * contact.reach_slope,
            }),
            Coordinate::Frequency => Some(OwnSlope {
                physical: [drag, 1.0, 0.0, -eta * over_eta / lean],
                ..none
            }),
            Coordinate::Damping => Some(OwnSlope {
                physical: [drag, 0.0, 1.0, 0.0],
                ..none
            }),
            Coordinate::Deflection => only(3, 1.0),
            Coordinate::ScrewZero => clearance(1e-3),
            Coordinate::Gap(i) if at.gap == Some(i) => clearance(1e-3),
            Coordinate::Effect(effect) => match effect {
                Effect::ForceSlope => only(3, (eta - 1.0) / lean),
                Effect::ForceCurve => only(3, (eta - 1.0).powi(2) / lean),
                Effect::FrequencyDrift => only(1, at.place),
                Effect::FrequencyBend => only(1, bend(at.place)),
                Effect::DampingDrift => only(2, at.place),
                Effect::DeflectionDrift => only(3, at.place),
                Effect::ContactDuration => Some(OwnSlope {
                    physical: [
                        1e-3 * (contact.press * at.press_per_s + contact.drag * decay),
                        0.0,
                        0.0,
                        0.0,
                    ],
                    clearance_m: 1e-3 * speed * contact.reach,
                }),
                _ => None,
            },
            _ => None,
        }
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

    /// βΩ, 1/s.
    fn decay_per_s(&self) -> f64 {
        self.damping_ratio * self.natural_rate()
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
            Coordinate::Gap(i) => 1e3 * self.gap_errors_m.0[i],
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
            Coordinate::DampingAsymmetry => self.damping_asymmetry = value,
            Coordinate::MassAsymmetry => self.mass_asymmetry = value,
            Coordinate::Gain(i) => self.gains[i] = value.exp(),
            Coordinate::Corner(i) => self.corners[i] = value.exp(),
            Coordinate::Delay(i) => self.delays_s[i] = 1e-3 * value,
            Coordinate::Effect(effect) => self.effects[effect.place()] = value,
            Coordinate::ScrewZero => self.screw_zero_m = 1e-3 * value,
            Coordinate::Gap(i) => self.gap_errors_m.0[i] = 1e-3 * value,
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

/// What a short contact of unit duration, a spring and a damper that only press, makes of the impact
/// outside of it, and the slopes over R.
struct ShortContact {
    /// Where both flights meet, beyond the gap, over the approach speed.
    reach: f64,
    reach_slope: f64,
    /// What the ratio of the speeds there is above R, over a/w.
    press: f64,
    press_slope: f64,
    /// The same over βΩ: the flights' damping acts on a contact less than on flights of its length.
    drag: f64,
    drag_slope: f64,
}

/// Least R for which a contact's effect is taken.
const LEAST_RESTITUTION: f64 = 0.05;

/// With a contact of duration t, both flights meet at ½R^{1/3} w t beyond the gap, where their speeds
/// are in the ratio R + t (0.635 (1 − R) a/w + (1.03 + 0.3 (1 − R)) βΩ), a being the masses'
/// acceleration toward each other before the impact: a fit to the exact contact, within 2 % of each
/// term for R of 0.4 to 1.
fn short_contact(restitution: f64) -> ShortContact {
    let r = restitution.max(LEAST_RESTITUTION);
    let reach = 0.5 * r.cbrt();
    ShortContact {
        reach,
        reach_slope: reach / (3.0 * r),
        press: 0.635 * (1.0 - r),
        press_slope: -0.635,
        drag: 1.03 + 0.3 * (1.0 - r),
        drag_slope: -0.3,
    }
}

/// What a drift that bends adds at a place −½ … ½ in the campaign: 1 in the middle of it, −1 at both
/// ends.
fn bend(place: f64) -> f64 {
    1.0 - 8.0 * place * place
}

/// One coordinate of the fit: R itself, the logarithms of f0, β, x_st, the gains and the
/// corners, the asymmetries and effects themselves, delays in ms, errors of clearances in mm.
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
    /// (b_x − b_y)/b
    DampingAsymmetry,
    /// (m_x − m_y)/m
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
    pub fn all() -> impl Iterator<Item = Coordinate> {
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
