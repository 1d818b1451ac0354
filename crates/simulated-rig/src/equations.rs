//! Equations of motion of a rig with effects beyond the model, dimensionless by the campaign's
//! nominal Ω, `x_st` and F0:
//!
//! X'' + 2δ X' + κ X (1 + q X/A + h X²/A²) + μ sgn X' + d |X'|X'/A² = F p(φ) − P, the same for Y, with the drive
//! p(φ) = cos φ + a₂ cos(2φ + φ₂) + a₃ cos(3φ + φ₃) and the press force P of a contact.

use impact_oscillator::model::params::ModelError;

use super::effects::RigEffects;
use super::plan::Step;
use super::truth::Truth;

/// [X, X', Y, Y'].
pub(super) type Phase4 = [f64; 4];

/// A contact of finite duration: P = max(0, κu + cu') with the overlap u = X + Y − 2ρ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compliance {
    /// κ
    pub stiffness: f64,
    /// c
    pub damping: f64,
    /// How long an isolated impact lasts.
    pub duration: f64,
}

/// Greatest restitution of a spring and a damper at critical damping, e⁻².
const LEAST_RESTITUTION: f64 = 0.136;

impl Compliance {
    /// The contact of two unit masses in which an isolated impact has restitution R and lasts
    /// `duration`.
    ///
    /// u'' + 2ζω u' + ω² u = 0 with ω² = 2κ and ζω = c. The press κu + cu' ends at the angle
    /// φ = π − 2 arcsin ζ of the damped vibration, where u' = −v e^{−ζφ/√(1−ζ²)}.
    ///
    /// # Errors
    /// [`ModelError`] if R is below that of critical damping (e⁻² = 0.135) or above 1.
    pub fn new(restitution: f64, duration: f64) -> Result<Self, ModelError> {
        if !(LEAST_RESTITUTION..=1.0).contains(&restitution) {
            return Err(ModelError::OutOfRange {
                name: "restitution",
                value: restitution,
                expected: "0.136 ≤ R ≤ 1 for impacts of finite duration",
            });
        }
        let angle = |ratio: f64| std::f64::consts::PI - 2.0 * ratio.asin();
        let root = |ratio: f64| (1.0 - ratio * ratio).sqrt();
        let (mut low, mut high) = (0.0, 1.0 - 1e-12);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if (-middle * angle(middle) / root(middle)).exp() > restitution {
                low = middle;
            } else {
                high = middle;
            }
        }
        let ratio = low;
        let rate = angle(ratio) / (duration * root(ratio));
        Ok(Self {
            stiffness: 0.5 * rate * rate,
            damping: ratio * rate,
            duration,
        })
    }

    /// Press of an overlap and its rate, without the condition that it only presses.
    pub fn press(&self, overlap: f64, rate: f64) -> f64 {
        self.stiffness * overlap + self.damping * rate
    }
}

/// How the masses act on each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ContactModel {
    /// Newton's instantaneous impact with this R.
    Newton(f64),
    /// A spring and a damper.
    Compliant(Compliance),
}

impl ContactModel {
    /// The law of a rig.
    ///
    /// # Errors
    /// [`ModelError`] if a contact of finite duration cannot have the rig's R.
    pub fn new(truth: &Truth, effects: &RigEffects) -> Result<Self, ModelError> {
        let r = truth.restitution;
        if effects.contact_duration_s == 0.0 {
            return Ok(Self::Newton(r));
        }
        let duration = effects.contact_duration_s * truth.natural_rate();
        Compliance::new(r, duration).map(Self::Compliant)
    }
}

/// Coefficients of both masses at one setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equations {
    /// Drive frequency over the nominal natural frequency.
    pub eta: f64,
    /// Gap at X = Y = 0: 2ρ.
    pub gap: f64,
    /// How the masses act on each other.
    pub law: ContactModel,
    /// μ
    pub friction: f64,
    /// 2δ of each mass.
    damping: [f64; 2],
    /// κ of each mass.
    stiffness: [f64; 2],
    /// F of each mass.
    force: [f64; 2],
    /// Share of a change of the approach speed that each mass takes by what acts between them.
    pub mobility: [f64; 2],
    /// h/A²
    cubic: f64,
    /// q/A
    quadratic: f64,
    /// d/A²
    drag: f64,
    /// a cos p and a sin p of the second and third harmonic.
    harmonics: [[f64; 2]; 2],
}

impl Equations {
    /// At a step of a plan, when a share `elapsed` (0 to 1) of the campaign has gone by.
    pub fn new(
        truth: &Truth,
        effects: &RigEffects,
        law: ContactModel,
        step: &Step,
        elapsed: f64,
    ) -> Self {
        let x_st = truth.static_deflection_m();
        let eta = step.frequency_hz / truth.natural_frequency_hz();
        let machine = truth.machine();
        let masses = [machine.x, machine.y.unwrap_or(machine.x)];
        let stiffening = (1.0 + effects.frequency_drift * (elapsed - 0.5)).powi(2);
        let damping = 2.0
            * (1.0 + effects.damping_drift * (elapsed - 0.5))
            * (1.0 + effects.hysteretic_damping * (1.0 / eta - 1.0));
        let beyond = eta - 1.0;
        let lean = 1.0 + beyond * (effects.force_slope + beyond * effects.force_curvature);
        let amplitude = effects.resonance_amplitude_m / x_st;
        let over_amplitude = |strength: f64, power: i32| {
            if strength == 0.0 {
                0.0
            } else {
                strength / amplitude.powi(power)
            }
        };
        let harmonic = |h: super::effects::Harmonic| {
            [h.phase_rad.cos(), h.phase_rad.sin()].map(|c| c * h.amplitude)
        };
        Self {
            eta,
            gap: 2.0 * effects.clearance_m(step, elapsed) / x_st,
            law,
            friction: effects.friction,
            damping: masses.map(|m| damping * m.decay_rate()),
            stiffness: masses.map(|m| stiffening * m.stiffness_per_mass()),
            force: masses.map(|m| lean * m.drive_per_mass()),
            mobility: machine.mobility().into(),
            cubic: over_amplitude(effects.hardening, 2),
            quadratic: over_amplitude(effects.spring_asymmetry, 1),
            drag: over_amplitude(effects.drag, 2),
            harmonics: [effects.second_harmonic, effects.third_harmonic].map(harmonic),
        }
    }

    /// Two free masses: springs of stiffness κ and cubic h/A², friction μ, no drive, no damping.
    #[cfg(test)]
    pub fn undriven(stiffness: f64, cubic: f64, friction: f64, law: ContactModel) -> Self {
        Self {
            eta: 1.0,
            gap: 1e3,
            law,
            friction,
            damping: [0.0; 2],
            stiffness: [stiffness; 2],
            force: [0.0; 2],
            mobility: [0.5; 2],
            cubic,
            quadratic: 0.0,
            drag: 0.0,
            harmonics: [[0.0; 2]; 2],
        }
    }

    /// The same with quadratic stiffness q/A and drag d/A².
    #[cfg(test)]
    pub fn with(self, quadratic: f64, drag: f64) -> Self {
        Self {
            quadratic,
            drag,
            ..self
        }
    }

    /// The drive p at a phase.
    pub fn drive(&self, phase: f64) -> f64 {
        let (s, c) = phase.sin_cos();
        let (c2, s2) = (2.0 * c * c - 1.0, 2.0 * s * c);
        let (c3, s3) = (c2 * c - s2 * s, s2 * c + c2 * s);
        let [second, third] = &self.harmonics;
        c + second[0] * c2 - second[1] * s2 + third[0] * c3 - third[1] * s3
    }

    /// Accelerations of both masses by drive, springs and dashpots: no friction, no contact.
    pub fn free(&self, drive: f64, s: &Phase4) -> [f64; 2] {
        [0, 1].map(|i| {
            let (x, v) = (s[2 * i], s[2 * i + 1]);
            self.force[i] * drive
                - self.damping[i] * v
                - self.drag * v * v.abs()
                - self.stiffness[i] * x * (1.0 + self.quadratic * x + self.cubic * x * x)
        })
    }

    /// Overlap X + Y − 2ρ, negative while apart.
    pub fn overlap(&self, s: &Phase4) -> f64 {
        s[0] + s[2] - self.gap
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::record::Sweep;

    #[test]
    fn prop_hysteretic_damping_halves_at_twice_the_frequency() {
        let truth = Truth::symmetric(0.8, 12.0, 0.05, 1e-3);
        let at_twice_f0 = |truth: &Truth, hysteretic_damping| {
            let effects = RigEffects {
                hysteretic_damping,
                ..RigEffects::default()
            };
            let step = Step {
                frequency_hz: 24.0,
                clearance_m: 1e-3,
                sweep: Sweep::Up,
                from_rest: true,
            };
            Equations::new(truth, &effects, ContactModel::Newton(0.8), &step, 0.5)
        };
        // b ∝ 1/η: half the dashpots, which is half the damping ratio
        let half = Truth::symmetric(0.8, 12.0, 0.025, 1e-3);
        assert_eq!(at_twice_f0(&truth, 1.0), at_twice_f0(&half, 0.0));
    }

    #[test]
    fn valid_an_elastic_contact_lasts_half_a_period_of_its_spring() {
        // two unit masses: m_eff = 1/2, duration π √(m_eff/κ)
        let contact = Compliance::new(1.0, 0.05).unwrap();
        let expected = std::f64::consts::PI * (0.5 / contact.stiffness).sqrt();
        assert!((expected - 0.05).abs() < 1e-6 && contact.damping < 1e-6 * contact.stiffness);
        assert!(Compliance::new(0.1, 0.05).is_err() && Compliance::new(1.1, 0.05).is_err());
    }
}
