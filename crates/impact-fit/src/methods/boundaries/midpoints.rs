//! R by plain least squares on the midpoints of the brackets of s2, as a paper would do it by hand:
//! printed beside the posterior, which takes the brackets as the intervals that they are.

use crate::methods::boundaries::block::{BoundaryBlock, predicted_hz};
use crate::methods::fit::fit_blocks;
use crate::parameters::{Coordinate, Parameters};
use crate::solver::{Block, Problem};
use crate::{Estimate, estimate};
use impact_records::event::RigKind;
use impact_records::motion::{BoundaryKind, Bracket};

/// The brackets of s2 that the model reaches, their midpoints as measured values.
struct Midpoints {
    rig: RigKind,
    brackets: Vec<Bracket>,
}

impl Block for Midpoints {
    fn items(&self) -> usize {
        self.brackets.len()
    }

    fn residuals(&self, item: usize, parameters: &Parameters) -> Option<Vec<f64>> {
        let bracket = &self.brackets[item];
        let frequency = predicted_hz(bracket, parameters, self.rig)?;
        let deviation = bracket.width_hz() / 12f64.sqrt();
        (deviation > 0.0).then(|| vec![(frequency - bracket.middle_hz()) / deviation])
    }

    fn touches(&self, coordinate: Coordinate) -> bool {
        coordinate == Coordinate::Restitution
    }
}

/// R alone, all else as given; `None` where no bracket of s2 lies in the model's reach.
pub fn restitution(block: &BoundaryBlock, at: &Parameters) -> Option<Estimate> {
    let brackets = block.brackets.iter();
    let midpoints = Midpoints {
        rig: block.rig,
        brackets: brackets
            .filter(|b| b.kind == BoundaryKind::SaddleNode && b.width_hz() > 0.0)
            .filter(|b| predicted_hz(b, at, block.rig).is_some())
            .cloned()
            .collect(),
    };
    let problem = Problem {
        blocks: vec![(&midpoints, 1.0)],
        free: vec![Coordinate::Restitution],
        ..Problem::default()
    };
    let found = fit_blocks(problem, *at).ok()?;
    let error = found.fit.error(Coordinate::Restitution)? * found.factor.sqrt();
    let value = found.fit.parameters.restitution;
    Some(estimate::estimate(Coordinate::Restitution, value, error))
}
