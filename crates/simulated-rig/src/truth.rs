//! The truth behind a synthetic campaign and the faults of its rig.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

use impact_oscillator::model::params::{Contact, Flight, Machine, Oscillator, Restitution};

/// One mass of the rig with its springs, its dashpot and its drive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TrueMass {
    /// m, kg.
    pub mass_kg: f64,
    /// k, N/m.
    pub stiffness_n_m: f64,
    /// b, N s/m.
    pub dashpot_n_s_m: f64,
    /// Amplitude of the drive's force, N.
    pub force_n: f64,
}

impl TrueMass {
    /// √(k/m)/2π, Hz.
    pub fn natural_frequency_hz(&self) -> f64 {
        (self.stiffness_n_m / self.mass_kg).sqrt() / std::f64::consts::TAU
    }

    /// b/(2√(k m)).
    pub fn damping_ratio(&self) -> f64 {
        0.5 * self.dashpot_n_s_m / (self.stiffness_n_m * self.mass_kg).sqrt()
    }

    /// F/k, m.
    pub fn static_deflection_m(&self) -> f64 {
        self.force_n / self.stiffness_n_m
    }
}

/// Differences of the first mass from the second, relative to their mean.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Differences {
    /// Of the driving forces.
    pub force: f64,
    /// Of the springs.
    pub stiffness: f64,
    /// Of the dashpots.
    pub dashpot: f64,
    /// Of the masses.
    pub mass: f64,
}

/// The rig as it is: R and both masses. What a campaign should find follows from them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// Coefficient of restitution R.
    pub restitution: f64,
    /// Mass x and mass y.
    pub masses: [TrueMass; 2],
}

impl Truth {
    /// Two equal masses: R, f0 in Hz, β, `x_st` in m.
    pub fn symmetric(
        restitution: f64,
        natural_frequency_hz: f64,
        damping_ratio: f64,
        static_deflection_m: f64,
    ) -> Self {
        let mass = TrueMass {
            mass_kg: 1.0,
            stiffness_n_m: 1.0,
            dashpot_n_s_m: 1.0,
            force_n: 1.0,
        };
        let any = Self {
            restitution,
            masses: [mass; 2],
        };
        any.with_means(natural_frequency_hz, damping_ratio, static_deflection_m)
    }

    /// Natural frequency f0, Hz: the geometric mean of both masses'.
    pub fn natural_frequency_hz(&self) -> f64 {
        let [x, y] = self.masses.map(|m| m.natural_frequency_hz());
        (x * y).sqrt()
    }

    /// Damping ratio β: the mean of both masses'.
    pub fn damping_ratio(&self) -> f64 {
        let [x, y] = self.masses.map(|m| m.damping_ratio());
        0.5 * (x + y)
    }

    /// Static deflection `x_st` = F0/k, m: the mean of both masses'.
    pub fn static_deflection_m(&self) -> f64 {
        let [x, y] = self.masses.map(|m| m.static_deflection_m());
        0.5 * (x + y)
    }

    /// Springs, dashpots and forces of both masses times common factors, so that f0, β and `x_st`
    /// are the given ones.
    #[must_use]
    pub fn with_means(
        &self,
        natural_frequency_hz: f64,
        damping_ratio: f64,
        static_deflection_m: f64,
    ) -> Self {
        let faster = natural_frequency_hz / self.natural_frequency_hz();
        let damped = damping_ratio / self.damping_ratio();
        let deflected = static_deflection_m / self.static_deflection_m();
        let masses = self.masses.map(|m| TrueMass {
            stiffness_n_m: m.stiffness_n_m * faster * faster,
            dashpot_n_s_m: m.dashpot_n_s_m * faster * damped,
            force_n: m.force_n * faster * faster * deflected,
            ..m
        });
        Self { masses, ..*self }
    }

    /// The same f0, β and `x_st` with masses that differ by so much beside what they do.
    #[must_use]
    pub fn with_differences(&self, differences: &Differences) -> Self {
        let [x, y] = self.masses;
        let apart = |m: TrueMass, sign: f64| TrueMass {
            mass_kg: m.mass_kg * (1.0 + 0.5 * sign * differences.mass),
            stiffness_n_m: m.stiffness_n_m * (1.0 + 0.5 * sign * differences.stiffness),
            dashpot_n_s_m: m.dashpot_n_s_m * (1.0 + 0.5 * sign * differences.dashpot),
            force_n: m.force_n * (1.0 + 0.5 * sign * differences.force),
        };
        let unlike = Self {
            masses: [apart(x, 1.0), apart(y, -1.0)],
            ..*self
        };
        unlike.with_means(
            self.natural_frequency_hz(),
            self.damping_ratio(),
            self.static_deflection_m(),
        )
    }

    /// The same with dashpots by which the damping ratios differ by so much over their mean.
    #[must_use]
    pub fn with_damping_ratios_apart(&self, difference: f64) -> Self {
        let mean = self.damping_ratio();
        let mut masses = self.masses;
        for (mass, sign) in masses.iter_mut().zip([1.0, -1.0]) {
            let own = mean * (1.0 + 0.5 * sign * difference);
            mass.dashpot_n_s_m *= own / mass.damping_ratio();
        }
        Self { masses, ..*self }
    }

    /// The machine, dimensionless: both masses over the nominal one.
    pub fn machine(&self) -> Machine {
        let nominal_kg = 0.5 * (self.masses[0].mass_kg + self.masses[1].mass_kg);
        let nominal_n = nominal_kg * self.natural_rate().powi(2) * self.static_deflection_m();
        let [x, y] = self.masses.map(|m| Oscillator {
            mass: m.mass_kg / nominal_kg,
            natural_frequency_ratio: m.natural_frequency_hz() / self.natural_frequency_hz(),
            damping_ratio: m.damping_ratio(),
            drive_amplitude: m.force_n / nominal_n,
        });
        Machine {
            x,
            y: Some(y),
            contact: Contact::Rigid(Restitution::Constant(self.restitution)),
            flight: Flight::Harmonic,
        }
    }

    /// Natural angular frequency Ω, rad/s.
    pub fn natural_rate(&self) -> f64 {
        std::f64::consts::TAU * self.natural_frequency_hz()
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
    /// Largest difference of the forces and of the springs, and twice that of the masses, relative;
    /// each is drawn with either sign.
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

/// Draw how unlike the masses of a rig are, within ± the faults' bound.
pub fn draw_differences(faults: &Faults, seed: u64) -> Differences {
    let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 0xA5A5);
    let mut draw = || faults.asymmetry * rng.random_range(-1.0..=1.0f64);
    Differences {
        force: draw(),
        stiffness: draw(),
        dashpot: 0.0,
        mass: 0.5 * draw(),
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Complex;

    #[test]
    fn valid_the_truth_of_unlike_masses_follows_from_their_own_equations() {
        let unlike = Differences {
            force: 0.1,
            stiffness: -0.06,
            dashpot: 0.2,
            mass: 0.1,
        };
        let truth = Truth::symmetric(0.8, 12.0, 0.06, 1e-3).with_differences(&unlike);
        // Roots of m s² + b s + k.
        let root = |m: &TrueMass| {
            let (half, k) = (
                0.5 * m.dashpot_n_s_m / m.mass_kg,
                m.stiffness_n_m / m.mass_kg,
            );
            Complex::new(-half, (k - half * half).sqrt())
        };
        let [x, y] = truth.masses.each_ref().map(root);
        let f0_hz = (x.norm() * y.norm()).sqrt() / std::f64::consts::TAU;
        assert!((f0_hz - 12.0).abs() < 1e-12);
        let damping = 0.5 * (-x.re / x.norm() - y.re / y.norm());
        assert!((damping - 0.06).abs() < 1e-14);
        let deflections = truth.masses.map(|m| m.force_n / m.stiffness_n_m);
        assert!((0.5 * deflections.iter().sum::<f64>() - 1e-3).abs() < 1e-15);
        let [a, b] = truth.masses;
        let apart = |x: f64, y: f64| 2.0 * (x - y) / (x + y);
        assert!((apart(a.force_n, b.force_n) - 0.1).abs() < 1e-12);
        assert!((apart(a.stiffness_n_m, b.stiffness_n_m) + 0.06).abs() < 1e-12);
        assert!((apart(a.dashpot_n_s_m, b.dashpot_n_s_m) - 0.2).abs() < 1e-12);
        assert!((apart(a.mass_kg, b.mass_kg) - 0.1).abs() < 1e-12);
    }

    #[test]
    fn damping_ratios_are_set_apart_about_their_mean_however_often() {
        let unlike = Differences {
            stiffness: 0.1,
            ..Differences::default()
        };
        let truth = Truth::symmetric(0.8, 12.0, 0.06, 1e-3).with_differences(&unlike);
        let once = truth.with_damping_ratios_apart(0.1);
        let [x, y] = once.masses.map(|m| m.damping_ratio());
        assert!((x - 0.063).abs() < 1e-15 && (y - 0.057).abs() < 1e-15);
        let twice = once.with_damping_ratios_apart(0.1);
        assert!((twice.masses[0].dashpot_n_s_m / once.masses[0].dashpot_n_s_m - 1.0).abs() < 1e-14);
    }
}
