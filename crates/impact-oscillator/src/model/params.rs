//! Dimensionless parameters of the oscillator and their admissible ranges.

use serde::{Deserialize, Serialize};

pub use super::error::ModelError;
use super::error::range;
pub use super::restitution::Restitution;

/// One mass on its spring, relative to the nominal mass m, spring k and force amplitude F0 by
/// which the dimensionless quantities are formed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Oscillator {
    /// Mass over the nominal mass.
    pub mass: f64,
    /// Own natural frequency √(k/m) over the nominal one.
    pub natural_frequency_ratio: f64,
    /// Own damping ratio b/(2√(km)), with this mass's own k and m; 0 ≤ β < 1.
    pub damping_ratio: f64,
    /// Amplitude of the driving force over the nominal one.
    pub drive_amplitude: f64,
}

impl Oscillator {
    /// The nominal mass with damping ratio β: mass, frequency ratio and drive all 1.
    pub fn nominal(damping_ratio: f64) -> Self {
        Self {
            mass: 1.0,
            natural_frequency_ratio: 1.0,
            damping_ratio,
            drive_amplitude: 1.0,
        }
    }

    /// Coefficient of X' in X'' + 2δX' + Ω²X = …: δ = `β_i` `Ω_i`.
    pub fn decay_rate(&self) -> f64 {
        self.damping_ratio * self.natural_frequency_ratio
    }

    /// Coefficient of X: `Ω_i²`.
    pub fn stiffness_per_mass(&self) -> f64 {
        self.natural_frequency_ratio * self.natural_frequency_ratio
    }

    /// Driving force amplitude over mass.
    pub fn drive_per_mass(&self) -> f64 {
        self.drive_amplitude / self.mass
    }

    fn check(&self) -> Result<(), ModelError> {
        range("mass", self.mass, self.mass > 0.0, "positive")?;
        let w = self.natural_frequency_ratio;
        range("natural_frequency_ratio", w, w > 0.0, "positive")?;
        let b = self.damping_ratio;
        range(
            "damping_ratio",
            b,
            (0.0..1.0).contains(&b),
            "0 ≤ β < 1 (below critical damping)",
        )?;
        range("drive_amplitude", self.drive_amplitude, true, "finite")
    }
}

/// How the masses act on each other in contact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Contact {
    /// Instantaneous impact by Newton's law.
    Rigid(Restitution),
}

/// The law of motion between impacts.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Flight {
    /// Spring, dashpot and harmonic drive: eqs. (1), (2) of the paper.
    #[default]
    Harmonic,
    /// One mass under a constant force toward the stop, with dry (rolling) friction against
    /// its velocity; spring, dashpot and drive are absent. A cart on an incline against a stop.
    ConstantForce {
        /// Acceleration toward the stop.
        acceleration: f64,
        /// Deceleration by friction, not negative.
        friction: f64,
    },
}

/// The machine: one mass against a fixed stop, or two against each other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    /// The first mass.
    pub x: Oscillator,
    /// The second mass; `None`: a fixed stop at X = ρ.
    pub y: Option<Oscillator>,
    /// How they act on each other.
    pub contact: Contact,
    /// How they move between impacts.
    #[serde(default)]
    pub flight: Flight,
}

/// How the second mass differs from the first, as in eqs. (13)–(16) of the paper.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Asymmetry {
    /// Drive amplitude of Y over that of X (0.95 in eq. 13).
    pub drive_amplitude: f64,
    /// Spring stiffness of Y over that of X, dashpot unchanged (0.95 in eq. 15).
    pub stiffness: f64,
    /// Mass of Y over that of X, spring and dashpot unchanged.
    pub mass: f64,
}

impl Default for Asymmetry {
    fn default() -> Self {
        Self {
            drive_amplitude: 1.0,
            stiffness: 1.0,
            mass: 1.0,
        }
    }
}

impl Machine {
    /// The symmetric double oscillator with damping ratio β and constant R.
    pub fn symmetric(damping_ratio: f64, restitution: f64) -> Self {
        let mass = Oscillator::nominal(damping_ratio);
        Self {
            y: Some(mass),
            ..Self::single(damping_ratio, restitution)
        }
    }

    /// One mass against a fixed stop at ρ, damping ratio β and constant R.
    pub fn single(damping_ratio: f64, restitution: f64) -> Self {
        Self {
            x: Oscillator::nominal(damping_ratio),
            y: None,
            contact: Contact::Rigid(Restitution::Constant(restitution)),
            flight: Flight::Harmonic,
        }
    }

    /// The double oscillator whose second mass differs: X nominal with β, Y with the same
    /// dashpot b and the given ratios of drive, stiffness and mass. With another stiffness alone
    /// β = b/(2√(km)) becomes β/√stiffness, so that Y'' + 2βY' + stiffness·Y = … as in eq. (15) of
    /// the paper.
    pub fn asymmetric(damping_ratio: f64, restitution: f64, asymmetry: Asymmetry) -> Self {
        let Asymmetry {
            drive_amplitude,
            stiffness,
            mass,
        } = asymmetry;
        let y = Oscillator {
            mass,
            natural_frequency_ratio: (stiffness / mass).sqrt(),
            damping_ratio: damping_ratio / (stiffness * mass).sqrt(),
            drive_amplitude,
        };
        Self {
            y: Some(y),
            ..Self::single(damping_ratio, restitution)
        }
    }

    /// One mass under a constant force against a stop: see [`Flight::ConstantForce`].
    pub fn on_incline(acceleration: f64, friction: f64, restitution: f64) -> Self {
        Self {
            flight: Flight::ConstantForce {
                acceleration,
                friction,
            },
            ..Self::single(0.0, restitution)
        }
    }

    /// The same machine with another law of restitution.
    #[must_use]
    pub fn with_restitution(mut self, restitution: Restitution) -> Self {
        self.contact = Contact::Rigid(restitution);
        self
    }

    /// The gap at X = Y = 0: 2ρ for two masses, ρ for one against a stop.
    pub fn gap(&self, clearance: f64) -> f64 {
        if self.y.is_some() {
            2.0 * clearance
        } else {
            clearance
        }
    }

    /// Whether both masses are equal in everything.
    pub fn is_symmetric(&self) -> bool {
        self.y == Some(self.x)
    }

    /// Shares of the approach speed's change that each mass takes: (1/m₁, 1/m₂)/(1/m₁ + 1/m₂),
    /// from the conservation of momentum m₁X' − m₂Y'; (1, 0) against a fixed stop.
    pub fn mobility(&self) -> (f64, f64) {
        match self.y {
            None => (1.0, 0.0),
            Some(y) => {
                let sum = self.x.mass + y.mass;
                (y.mass / sum, self.x.mass / sum)
            }
        }
    }

    /// The law of restitution.
    pub fn restitution(&self) -> &Restitution {
        let Contact::Rigid(r) = &self.contact;
        r
    }

    /// Check every parameter's range.
    ///
    /// # Errors
    /// [`ModelError::OutOfRange`] with the first parameter outside its range.
    pub fn check(&self) -> Result<(), ModelError> {
        self.restitution().check()?;
        self.x.check()?;
        if let Some(y) = &self.y {
            y.check()?;
        }
        if let Flight::ConstantForce {
            acceleration,
            friction,
        } = self.flight
        {
            range("acceleration", acceleration, true, "finite")?;
            range("friction", friction, friction >= 0.0, "not negative")?;
            if self.y.is_some() {
                return Err(ModelError::Unsupported(
                    "a flight under constant force has one mass against a stop: leave y out",
                ));
            }
        }
        Ok(())
    }
}

/// Where the machine is run: the drive's frequency, the clearance, the drive's phase at τ = 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Setting {
    /// η = ω/Ω, positive.
    pub frequency_ratio: f64,
    /// ρ = `r/x_st`; negative: preload.
    pub clearance: f64,
    /// φ: the drive is cos(ητ + φ).
    #[serde(default)]
    pub phase: f64,
}

impl Setting {
    /// η and ρ, with phase 0.
    pub fn new(frequency_ratio: f64, clearance: f64) -> Self {
        Self {
            frequency_ratio,
            clearance,
            phase: 0.0,
        }
    }

    /// The same with another phase of the drive at τ = 0, rad.
    #[must_use]
    pub fn at_phase(self, phase: f64) -> Self {
        Self { phase, ..self }
    }

    /// Drive period 2π/η.
    pub fn period(&self) -> f64 {
        std::f64::consts::TAU / self.frequency_ratio
    }

    /// Check the ranges.
    ///
    /// # Errors
    /// [`ModelError::OutOfRange`] where η is not positive or a number is not finite.
    pub fn check(&self) -> Result<(), ModelError> {
        let eta = self.frequency_ratio;
        range("frequency_ratio", eta, eta > 0.0, "positive")?;
        range("clearance", self.clearance, true, "finite")?;
        range("phase", self.phase, true, "finite")
    }
}

/// Initial displacements and velocities of both masses (y is ignored against a stop).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Initial {
    /// X(0)
    pub x: f64,
    /// X'(0)
    pub vx: f64,
    /// Y(0)
    pub y: f64,
    /// Y'(0)
    pub vy: f64,
}

impl Initial {
    /// Both masses at rest at zero displacement.
    pub fn rest() -> Self {
        Self::default()
    }

    /// Both masses with the same displacement and velocity.
    pub fn both(x: f64, vx: f64) -> Self {
        Self {
            x,
            vx,
            y: x,
            vy: vx,
        }
    }

    /// Check that all four are finite.
    ///
    /// # Errors
    /// [`ModelError::OutOfRange`] otherwise.
    pub fn check(&self) -> Result<(), ModelError> {
        range("X(0)", self.x, true, "finite")?;
        range("X'(0)", self.vx, true, "finite")?;
        range("Y(0)", self.y, true, "finite")?;
        range("Y'(0)", self.vy, true, "finite")
    }
}
