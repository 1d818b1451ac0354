//! Where the boundaries of all brackets lie over R, for the many R of a posterior.
//!
//! How far each deviate moves a boundary changes little with R, and takes far longer to find than where the boundary
//! lies: it is found at even steps of R and taken as linear between them, but for the last step, near R = 1, where what a
//! contact's length makes of R changes fast.

use nalgebra::DVector;
use rayon::prelude::*;

use crate::methods::boundaries::block::BoundaryBlock;
use crate::methods::boundaries::surroundings::{SimulatedBoundary, Surroundings};

/// Steps of R from 0 to 1.
const STEPS: u32 = 40;

/// Hz per unit of each deviate of the boundaries of all brackets; `None` of one that does not reach its clearance.
type Directions = Vec<Option<DVector<f64>>>;

/// The boundaries of a block amid what else acts on them.
#[derive(Debug, Clone)]
pub struct BoundaryCurves<'a> {
    /// The brackets.
    pub block: &'a BoundaryBlock,
    surroundings: Surroundings,
    /// At each step of R.
    directions: Vec<Directions>,
}

impl<'a> BoundaryCurves<'a> {
    /// The directions at all steps of R.
    pub fn new(block: &'a BoundaryBlock, surroundings: &Surroundings) -> Self {
        let at = |step: u32| {
            let found = surroundings.boundaries(block, f64::from(step) / f64::from(STEPS));
            let directions = found.into_iter().map(|place| Some(place?.direction));
            directions.collect()
        };
        Self {
            block,
            surroundings: surroundings.clone(),
            directions: (0..STEPS).into_par_iter().map(at).collect(),
        }
    }

    /// The same with contacts without length.
    #[must_use]
    pub fn of_instants(&self) -> Self {
        let mut instants = self.clone();
        instants.surroundings = self.surroundings.of_instants();
        if let Some(length) = self.surroundings.length() {
            let directions = instants.directions.iter_mut().flatten();
            for direction in directions.filter_map(Option::as_mut) {
                *direction = direction.clone().remove_row(length);
            }
        }
        instants
    }

    /// The direction of the deviate that must be positive, if there is one.
    pub fn positive(&self) -> Option<DVector<f64>> {
        self.surroundings.positive()
    }

    /// Where they lie at R; `None` of one that does not reach its clearance.
    pub fn at(&self, restitution: f64) -> Vec<Option<SimulatedBoundary>> {
        let steps = restitution * f64::from(STEPS);
        let below = (1..STEPS)
            .take_while(|step| f64::from(*step) <= steps)
            .count();
        let share = steps - below as f64;
        if below + 1 == self.directions.len() {
            return self.surroundings.boundaries(self.block, restitution);
        }
        let [low, high] = [0, 1].map(|beyond| &self.directions[below + beyond]);
        let brackets = self.block.brackets.iter().zip(low.iter().zip(high));
        brackets
            .map(|(bracket, both)| match both {
                (Some(low), Some(high)) => {
                    let direction = low * (1.0 - share) + high * share;
                    let (block, surroundings) = (self.block, &self.surroundings);
                    surroundings.boundary_along(block, bracket, restitution, direction)
                }
                _ => self.surroundings.boundary(self.block, bracket, restitution),
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::bracket;
    use crate::parameters::effect::Effect;
    use crate::parameters::{Coordinate, Parameters};
    use crate::solver::Prior;
    use impact_records::event::RigKind;
    use impact_records::motion::BoundaryKind;

    #[test]
    fn prop_directions_between_the_steps_are_those_of_the_model() {
        let p = Parameters::symmetric(0.7, 12.6, 0.05, 1e-3);
        let brackets = [1.1, 1.25, 1.5].map(|eta| bracket(BoundaryKind::SaddleNode, eta, &p, 0.0));
        let block = BoundaryBlock::new(RigKind::Double, &brackets);
        let priors = [
            Coordinate::Effect(Effect::ContactDuration),
            Coordinate::Effect(Effect::ForceSlope),
            Coordinate::DriveAsymmetry,
        ];
        let priors = priors.map(|coordinate| Prior::new(coordinate, 0.0, 0.02));
        let surroundings = Surroundings::known(&p, &priors);
        let curves = BoundaryCurves::new(&block, &surroundings);
        for r in [0.0, 0.437, 0.55, 0.688, 0.8123, 0.913, 0.962, 0.999, 1.0] {
            for instants in [false, true] {
                let (curves, exact) = if instants {
                    (curves.of_instants(), surroundings.of_instants())
                } else {
                    (curves.clone(), surroundings.clone())
                };
                for (found, exact) in curves.at(r).iter().zip(exact.boundaries(&block, r)) {
                    let (Some(found), Some(exact)) = (found, &exact) else {
                        assert!(found.is_none() && exact.is_none(), "{r}");
                        continue;
                    };
                    let off_hz = found.frequency_hz - exact.frequency_hz;
                    let off = &found.direction - &exact.direction;
                    // of what all deviates together move it
                    let moved_hz = exact.direction.norm();
                    assert!(off.norm() < 5e-3 * moved_hz, "{r}: {off} {exact:?}");
                    assert!(off_hz.abs() < 5e-3 * moved_hz, "{r}: {off_hz}");
                }
            }
        }
    }
}
