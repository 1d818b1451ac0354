//! All methods in one likelihood: each block with the weight that its noise gives.

use crate::identify::evidence::{Blocks, IMPACT_BIAS, Nominal};
use crate::identify::fit::parameters::{Coordinate, Parameters};
use crate::identify::fit::{Block, FitError, Prior, Problem};
use crate::identify::methods::{self, MethodFit};
use crate::identify::uncertainty::posterior::Posterior;

/// A method that the joint fit may rest on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// The resonance curve of the impactless records.
    Resonance,
    /// Waveforms of periodic records.
    Trajectories,
    /// Brackets of s2, s1 and grazing.
    Boundaries,
    /// Speeds at impacts.
    Impacts,
    /// Records followed from impact to impact.
    Flights,
}

impl Method {
    /// All, in the order of their weights.
    pub const ALL: [Self; 5] = [
        Self::Resonance,
        Self::Trajectories,
        Self::Boundaries,
        Self::Impacts,
        Self::Flights,
    ];

    /// Name in `identification.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Resonance => "resonance",
            Self::Trajectories => "trajectories",
            Self::Boundaries => "boundaries",
            Self::Impacts => "impacts",
            Self::Flights => "flights",
        }
    }

    /// What it fits.
    pub fn block(self, blocks: &Blocks) -> &dyn Block {
        match self {
            Self::Resonance => &blocks.resonance,
            Self::Trajectories => &blocks.trajectory,
            Self::Boundaries => &blocks.boundary,
            Self::Impacts => &blocks.impact,
            Self::Flights => &blocks.flight,
        }
    }
}

/// Weights of the methods, as [`Method::ALL`] has them; `None` leaves one out.
pub type Weights = [Option<f64>; 5];

/// Weight of the impacts among the other methods: what the extrapolation of speeds leaves open is
/// common to all impacts, so that all together tell no more than that.
pub fn impact_weight(found: &MethodFit) -> f64 {
    let square = found.fit.conditional_variance(Coordinate::Restitution);
    let square = square.unwrap_or(0.0) * found.factor;
    square / (square + IMPACT_BIAS * IMPACT_BIAS) / found.factor
}

/// The methods that a joint fit rests on, in its problem's order.
pub fn present(blocks: &Blocks, weights: &Weights) -> Vec<Method> {
    let weighted = Method::ALL.into_iter().zip(weights);
    weighted
        .filter(|(method, weight)| weight.is_some() && method.block(blocks).items() > 0)
        .map(|(method, _)| method)
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
    let list: Vec<(&'b dyn Block, f64)> = present(blocks, weights)
        .into_iter()
        .filter_map(|method| Some((method.block(blocks), weights[method as usize]?)))
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
