//! How effects act on a mass: as a small extra acceleration along an orbit, and, those that change impactless
//! motion at the drive's frequency, by equivalent linearisation (Krylov and Bogoliubov).

use crate::parameters::Parameters;
use crate::parameters::effect::Effect;
use impact_oscillator::model::params::Oscillator;
use impact_oscillator::model::path::C64;

/// Lengths that the strengths of effects refer to, m.
#[derive(Debug, Clone, Copy)]
pub struct Lengths {
    /// The record's own `x_st` at its drive: the model's unit.
    pub unit_m: f64,
    /// The campaign's `x_st`.
    pub deflection_m: f64,
    /// The displacement at which springs change and drag acts by the strength.
    pub reach_m: f64,
}

/// A mass at the nodes of a period of its orbit.
#[derive(Debug, Clone, Copy)]
pub struct MassCourse<'a> {
    /// The mass with its spring.
    pub oscillator: &'a Oscillator,
    /// Its displacements and velocities.
    pub states: &'a [[f64; 2]],
    /// e^{iθ} of the drive's phase θ.
    pub turns: &'a [C64],
}

/// The extra acceleration at the nodes per unit of an effect's strength; 0 of effects that are not of the masses.
pub fn acceleration(effect: Effect, mass: &MassCourse<'_>, lengths: &Lengths) -> Vec<f64> {
    let MassCourse {
        oscillator,
        states,
        turns,
    } = *mass;
    let Lengths {
        unit_m,
        deflection_m,
        reach_m,
    } = *lengths;
    let force = oscillator.drive_per_mass();
    let cosine = |order: u32| turns.iter().map(move |turn| force * turn.powu(order).re);
    let sine = |order: u32| turns.iter().map(move |turn| force * turn.powu(order).im);
    match effect {
        Effect::SecondHarmonicCos => cosine(2).collect(),
        Effect::SecondHarmonicSin => sine(2).collect(),
        Effect::ThirdHarmonicCos => cosine(3).collect(),
        Effect::ThirdHarmonicSin => sine(3).collect(),
        Effect::Hardening => {
            let share = oscillator.stiffness_per_mass() * (unit_m / reach_m).powi(2);
            states.iter().map(|s| -share * s[0].powi(3)).collect()
        }
        Effect::Friction => {
            let force = deflection_m / unit_m;
            friction(states).iter().map(|p| force * p).collect()
        }
        Effect::Drag => {
            let share = deflection_m * unit_m / reach_m.powi(2);
            let drag = |s: &[f64; 2]| -share * s[1] * s[1].abs();
            states.iter().map(drag).collect()
        }
        Effect::SpringAsymmetry => {
            let share = oscillator.stiffness_per_mass() * unit_m / reach_m;
            states.iter().map(|s| -share * s[0].powi(2)).collect()
        }
        _ => vec![0.0; states.len()],
    }
}

/// Coulomb friction of unit size, −sign X', at the nodes; where X' changes its sign, the mean over
/// the node's neighbourhood.
fn friction(states: &[[f64; 2]]) -> Vec<f64> {
    let change = |k: usize| {
        let (a, b) = (k.saturating_sub(1), (k + 1).min(states.len() - 1));
        0.5 * (states[b][1] - states[a][1]).abs()
    };
    let of =
        |(k, s): (usize, &[f64; 2])| -(s[1] / change(k).max(f64::MIN_POSITIVE)).clamp(-1.0, 1.0);
    states.iter().enumerate().map(of).collect()
}

/// The effects on a mass that change impactless motion at the drive's frequency, in the order of [`Resistance`].
const EXTRA: [Effect; 3] = [Effect::Hardening, Effect::Friction, Effect::Drag];

/// Complex forces, one of each effect on a mass that changes impactless motion.
pub type Forces = [C64; EXTRA.len()];

/// Place of an effect's force among [`Forces`]; `None` of one that does not change impactless motion.
pub fn place(effect: Effect) -> Option<usize> {
    EXTRA.iter().position(|e| *e == effect)
}

/// Forces per mass of hardening springs, friction and drag by their describing functions: a force εX³ acts at
/// the drive's frequency like ¾ε|F|²F, one of sign X' like (4/π)iF/|F|, one of |X'|X' like (8/3π)iη²|F|F.
#[derive(Debug, Clone, Copy, Default)]
pub struct Resistance {
    /// ¾ε, (4/π) of the friction, (8/3π)η² of the drag, each for an effect of strength 1.
    coefficients: [f64; EXTRA.len()],
    /// Strengths of the effects.
    strengths: [f64; EXTRA.len()],
}

impl Resistance {
    /// Of a mass that is driven at η.
    pub fn new(
        oscillator: &Oscillator,
        parameters: &Parameters,
        lengths: &Lengths,
        eta: f64,
    ) -> Self {
        use std::f64::consts::PI;
        let hardening = (lengths.unit_m / lengths.reach_m).powi(2);
        let friction = lengths.deflection_m / lengths.unit_m;
        let drag = friction * hardening;
        let coefficients = [
            0.75 * (oscillator.stiffness_per_mass() * hardening),
            4.0 / PI * friction,
            8.0 / (3.0 * PI) * eta * eta * drag,
        ];
        Self {
            coefficients,
            strengths: EXTRA.map(|e| parameters.effect(e)),
        }
    }

    /// The forces at amplitude F for effects of strength 1.
    pub fn forces(&self, amplitude: C64) -> Forces {
        let size = amplitude.norm();
        let [hardening, friction, drag] = self.coefficients;
        [
            amplitude * (hardening * size * size),
            amplitude * C64::new(0.0, friction / size),
            amplitude * C64::new(0.0, drag * size),
        ]
    }

    /// Their sum at amplitude F.
    pub fn force(&self, amplitude: C64) -> C64 {
        let forces = self.forces(amplitude).into_iter().zip(self.strengths);
        forces.map(|(force, strength)| force * strength).sum()
    }

    /// a and b of the force's differential a dF + b dF*.
    pub fn slope(&self, amplitude: C64) -> [C64; 2] {
        let size = amplitude.norm();
        let [hardening, friction, drag] =
            [0, 1, 2].map(|i| self.coefficients[i] * self.strengths[i]);
        let along = C64::new(
            2.0 * hardening * size * size,
            0.5 * friction / size + 1.5 * drag * size,
        );
        let across = C64::new(hardening, 0.5 * drag / size - 0.5 * friction / size.powi(3));
        [along, across * amplitude * amplitude]
    }

    /// What the sum changes, at one amplitude, where stiffness per mass, η and the unit of length change by shares.
    /// `friction_over_length`: power of the inverse of that unit that friction and drag go with, which are stated over
    /// the campaign's unit: 1 where that of the record alone changes, 0 where both do.
    pub fn growth(
        &self,
        forces: &Forces,
        [stiffness, eta, length]: [f64; 3],
        friction_over_length: f64,
    ) -> C64 {
        let relative = [
            stiffness + 2.0 * length,
            -length * friction_over_length,
            2.0 * eta + length * (2.0 - friction_over_length),
        ];
        let forces = forces.iter().zip(self.strengths).zip(relative);
        forces.map(|((force, s), slope)| force * s * slope).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::effect::Acts;
    use impact_records::event::RigKind;

    #[test]
    fn prop_the_effects_on_masses_accelerate_them_and_no_others() {
        let machine = Parameters::symmetric(0.8, 12.6, 0.07, 1e-3).machine(RigKind::Single);
        let mass = MassCourse {
            oscillator: &machine.x,
            states: &[[0.3, 0.5], [0.7, -0.4]],
            turns: &[C64::from_polar(1.0, 0.3), C64::from_polar(1.0, 1.4)],
        };
        let lengths = Lengths {
            unit_m: 1e-3,
            deflection_m: 1.1e-3,
            reach_m: 3e-3,
        };
        for effect in Effect::ALL {
            let found = acceleration(*effect, &mass, &lengths);
            let of_masses = effect.acts() == Acts::Masses;
            assert!(found.iter().all(|p| (*p != 0.0) == of_masses), "{effect:?}");
            assert!(of_masses || place(*effect).is_none(), "{effect:?}");
        }
    }
}
