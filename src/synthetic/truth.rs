//! The truth behind a synthetic campaign and the faults of its rig.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

use impact_oscillator::model::params::{Contact, Flight, Machine, Oscillator, Restitution};

/// True parameters of the rig.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Coefficient of restitution R.
    pub restitution: f64,
    /// Natural frequency f0, Hz: the geometric mean of both masses'.
    pub natural_frequency_hz: f64,
    /// Damping ratio β: the mean of both masses'.
    pub damping_ratio: f64,
    /// Static deflection `x_st` = F0/k, m: the mean of both masses'.
    pub static_deflection_m: f64,
    /// (`F_x` − `F_y)/F0`, relative.
    pub drive_asymmetry: f64,
    /// (`k_x` − `k_y)/k`, relative.
    pub stiffness_asymmetry: f64,
    /// (`β_x` − `β_y)/β`, relative; each `β_i` = `b_i/(2√(k_i` m)) with the mass's own spring.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub damping_asymmetry: f64,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl Truth {
    /// Two equal masses: R, f0 in Hz, β, `x_st` in m.
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
        }
    }

    /// The machine, dimensionless: both masses about the nominal one.
    pub fn machine(&self) -> Machine {
        let mass = |sign: f64| Oscillator {
            mass: 1.0,
            natural_frequency_ratio: (1.0 + 0.5 * sign * self.stiffness_asymmetry).sqrt(),
            damping_ratio: self.damping_ratio * (1.0 + 0.5 * sign * self.damping_asymmetry),
            drive_amplitude: 1.0 + 0.5 * sign * self.drive_asymmetry,
        };
        Machine {
            x: mass(1.0),
            y: Some(mass(-1.0)),
            contact: Contact::Rigid(Restitution::Constant(self.restitution)),
            flight: Flight::Harmonic,
        }
    }

    /// Natural angular frequency Ω, rad/s.
    pub fn natural_rate(&self) -> f64 {
        std::f64::consts::TAU * self.natural_frequency_hz
    }
}

/// One impact in truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrueImpact {
    /// First touch, since the record's first sample, s.
    pub time_s: f64,
    /// Approach speed at first touch, m/s.
    pub approach_m_s: f64,
    /// Separation speed at the end of contact, m/s.
    pub separation_m_s: f64,
    /// How long the contact lasts, s; zero for an instantaneous one.
    pub duration_s: f64,
    /// How long the masses stay together in a dead zone, s; zero without one.
    pub dead_zone_s: f64,
}

/// Faults of the rig; [`Faults::none`] is an ideal one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Faults {
    /// Bits of the converter; `None`: no rounding.
    pub converter_bits: Option<u32>,
    /// Noise of every channel, V.
    pub noise_v: f64,
    /// Standard deviation of the channels' gain errors, relative.
    pub gain_deviation: f64,
    /// Corner of the integrators' high-pass, Hz; `None`: none.
    pub high_pass_hz: Option<f64>,
    /// Standard deviation of those corners about the stated one, relative.
    pub corner_deviation: f64,
    /// Length of a contact pulse, s.
    pub contact_pulse_s: f64,
    /// Probability that a contact bounces (a second pulse 0.7 to 1.5 ms later).
    pub bounce_probability: f64,
    /// Probability that the contact misses an impact altogether (dirt on the contact).
    pub missed_probability: f64,
    /// Largest asymmetry of drive and of stiffness, relative; each is drawn with either sign.
    pub asymmetry: f64,
}

impl Default for Faults {
    fn default() -> Self {
        Self {
            converter_bits: Some(12),
            noise_v: 2.5e-3,
            gain_deviation: 5e-3,
            high_pass_hz: Some(0.5),
            corner_deviation: 2e-2,
            contact_pulse_s: 0.3e-3,
            bounce_probability: 0.25,
            missed_probability: 0.05,
            asymmetry: 0.02,
        }
    }
}

impl Faults {
    /// An ideal rig: nothing rounded, nothing noisy, nothing filtered.
    pub fn none() -> Self {
        Self {
            converter_bits: None,
            noise_v: 0.0,
            gain_deviation: 0.0,
            high_pass_hz: None,
            corner_deviation: 0.0,
            contact_pulse_s: 0.3e-3,
            bounce_probability: 0.0,
            missed_probability: 0.0,
            asymmetry: 0.0,
        }
    }
}

/// Draw the asymmetries of a rig within ± the faults' bound.
pub fn draw_asymmetry(faults: &Faults, seed: u64) -> (f64, f64) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 0xA5A5);
    let mut draw = || faults.asymmetry * rng.random_range(-1.0..=1.0f64);
    (draw(), draw())
}

/// Draw the gain error of every channel of a campaign.
pub fn draw_gains(faults: &Faults, channels: usize, seed: u64) -> Vec<f64> {
    about_one(faults.gain_deviation, channels, seed ^ 0x5EED)
}

/// Draw the corners of the integrators of a campaign, over the stated one.
pub fn draw_corners(faults: &Faults, seed: u64) -> [f64; 3] {
    let drawn = about_one(faults.corner_deviation, 3, seed ^ 0xC0FE);
    std::array::from_fn(|i| drawn[i])
}

fn about_one(deviation: f64, count: usize, seed: u64) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..count)
        .map(|_| {
            let normal: f64 = StandardNormal.sample(&mut rng);
            1.0 + deviation * normal
        })
        .collect()
}
