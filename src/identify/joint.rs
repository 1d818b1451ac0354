//! All methods in one likelihood: each block with the weight that its noise gives.

use crate::identify::blocks::{Blocks, IMPACT_BIAS, Nominal};
use crate::identify::interval::Posterior;
use crate::identify::methods::{self, MethodFit};
use crate::identify::parameters::{Coordinate, Parameters};
use crate::identify::solver::{Block, FitError, Prior, Problem};

/// Weights of resonance curve, trajectories, boundaries, impacts and flights; `None` leaves one out.
pub type Weights = [Option<f64>; 5];

/// The blocks' names in the order of their weights.
pub const METHODS: [&str; 5] = [
    "resonance",
    "trajectories",
    "boundaries",
    "impacts",
    "flights",
];

/// Weight of the impacts among the other methods: what the extrapolation of speeds leaves open is
/// common to all impacts, so that all together tell no more than that.
pub fn impact_weight(found: &MethodFit) -> f64 {
    let square = found.fit.conditional_variance(Coordinate::Restitution);
    let square = square.unwrap_or(0.0) * found.factor;
    square / (square + IMPACT_BIAS * IMPACT_BIAS) / found.factor
}

/// The places among [`METHODS`] of those that a joint fit rests on, in its problem's order.
pub fn present(blocks: &Blocks, weights: &Weights) -> Vec<usize> {
    let items = [
        blocks.resonance.items(),
        blocks.trajectory.items(),
        blocks.boundary.items(),
        blocks.impact.items(),
        blocks.flight.items(),
    ];
    (0..METHODS.len())
        .filter(|i| weights[*i].is_some() && items[*i] > 0)
        .collect()
}

/// The problem of all blocks, each with its weight; those without one stay out. What the brackets
/// say of R may enter as a posterior of its own.
pub fn problem<'b>(
    blocks: &'b Blocks,
    start: Parameters,
    weights: &Weights,
    nominal: &Nominal,
    posterior: Option<&Posterior>,
) -> Option<Problem<'b>> {
    let all: [&'b dyn Block; 5] = [
        &blocks.resonance,
        &blocks.trajectory,
        &blocks.boundary,
        &blocks.impact,
        &blocks.flight,
    ];
    let list: Vec<(&'b dyn Block, f64)> = present(blocks, weights)
        .into_iter()
        .filter_map(|i| Some((all[i], weights[i]?)))
        .collect();
    if list.is_empty() {
        return None;
    }
    let mut free: Vec<Coordinate> = Coordinate::PHYSICAL
        .into_iter()
        .filter(|c| list.iter().any(|(block, _)| block.touches(*c)))
        .collect();
    let mut priors = methods::wide_priors(&start, &free);
    if let Some(found) = posterior {
        let (centre, deviation) = found.restitution;
        let coordinate = Coordinate::Restitution;
        if !free.contains(&coordinate) {
            free.insert(0, coordinate);
        }
        priors.push(Prior {
            coordinate,
            centre,
            deviation,
        });
    }
    blocks.add_nuisances(nominal, &list, (&mut free, &mut priors));
    Some(Problem {
        blocks: list,
        priors,
        free,
    })
}

/// Fit all blocks together from a start that each of them accepts.
pub fn fit(problem: &Problem<'_>, start: Parameters) -> Result<MethodFit, FitError> {
    let fit = problem.fit(start)?;
    let freedom = fit.residuals.saturating_sub(4).max(1) as f64;
    let reduced = fit.cost / freedom;
    Ok(MethodFit {
        factor: reduced.max(1.0),
        reduced,
        fit,
    })
}
