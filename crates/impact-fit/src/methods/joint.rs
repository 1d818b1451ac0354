//! All methods in one likelihood: each block with the weight that its noise gives.

use std::collections::BTreeMap;

use crate::evidence::Nominal;
use crate::method::Method;
use crate::method_fit::MethodFit;
use crate::methods::blocks::Blocks;
use crate::methods::fit::wide_priors;
use crate::parameters::{Coordinate, Parameters};
use crate::solver::{Block, Fit, FitError, Precision, Prior, Problem};

/// Weights of the methods in a joint fit; a method without one stays out.
pub type Weights = BTreeMap<Method, f64>;

/// The methods that a joint fit uses, in its problem's order.
pub fn present(blocks: &Blocks, weights: &Weights) -> Vec<Method> {
    weighted(blocks, weights)
        .map(|(method, ..)| method)
        .collect()
}

fn weighted<'b>(
    blocks: &'b Blocks,
    weights: &Weights,
) -> impl Iterator<Item = (Method, &'b dyn Block, f64)> {
    Method::FITTED.into_iter().filter_map(|method| {
        let block = blocks.of(method).filter(|b| b.items() > 0)?;
        Some((method, block, *weights.get(&method)?))
    })
}

/// The problem of all blocks, each with its weight; those without one stay out. What the brackets
/// say of R may enter as a distribution of its own.
pub fn problem<'b>(
    blocks: &'b Blocks,
    start: Parameters,
    weights: &Weights,
    nominal: &Nominal,
    of_brackets: Option<Prior>,
) -> Option<Problem<'b>> {
    let list: Vec<(&'b dyn Block, f64)> = weighted(blocks, weights)
        .map(|(_, block, weight)| (block, weight))
        .collect();
    if list.is_empty() {
        return None;
    }
    let mut free: Vec<Coordinate> = Coordinate::PHYSICAL
        .into_iter()
        .filter(|c| list.iter().any(|(block, _)| block.touches(*c)))
        .collect();
    let mut priors = wide_priors(&start, &free);
    if let Some(restitution) = of_brackets {
        if !free.contains(&restitution.coordinate) {
            free.insert(0, restitution.coordinate);
        }
        priors.push(restitution);
    }
    blocks.add_nuisances(nominal, &list, &mut free, &mut priors);
    Some(blocks.problem(list, free, priors))
}

/// Fit all blocks together from a start that each of them accepts.
///
/// # Errors
/// Those of [`Problem::fit`].
pub fn fit(problem: &Problem<'_>, start: Parameters) -> Result<MethodFit, FitError> {
    let fit = problem.fit_from_both_ends(start)?;
    let freedom = fit.residuals.saturating_sub(4);
    Ok(MethodFit::of(problem, fit, freedom))
}

/// A fit of some methods that is close enough to tell which of two arrangements fits.
pub fn rough(
    blocks: &Blocks,
    start: Parameters,
    weights: &Weights,
    nominal: &Nominal,
) -> Option<Fit> {
    let problem = Problem {
        precision: Precision::Start,
        ..problem(blocks, start, weights, nominal, None)?
    };
    problem.fit(start).ok()
}

/// The weight of the resonance curve alone, by its noise.
pub fn curve() -> Weights {
    by_noise(Method::observes_response)
}

/// The weights of waveforms and resonance curve, each by its noise.
pub fn curve_and_waveforms() -> Weights {
    by_noise(|_| true)
}

/// The weights of some methods each item of which is a record, by its noise.
fn by_noise(of: impl Fn(Method) -> bool) -> Weights {
    let some = Method::BY_RECORD.into_iter().filter(|method| of(*method));
    some.map(|method| (method, 1.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::{evidence, observed, recorded};
    use crate::parameters::effect::Effects;

    #[test]
    fn prop_more_freedom_never_costs_likelihood() {
        for seed in [5, 6] {
            let observations = observed(&recorded(0.75, 12.0, 50, seed));
            let evidence = evidence(&observations);
            let truth = Parameters::symmetric(0.75, 12.0, 0.06, 1e-3);
            let mut blocks = Blocks::new(&evidence);
            let has_orbit = crate::solver::mean_squares(&blocks.trajectory, &truth);
            let mut has_orbit = has_orbit.iter().map(Option::is_some);
            blocks
                .trajectory
                .records
                .retain(|_| has_orbit.next().unwrap_or(false));
            blocks.weigh(&truth);
            let weights = curve_and_waveforms();
            let cost = |effects: Effects, start: Parameters| {
                let mut nominal = evidence.nominal;
                nominal.effects = effects;
                let problem = problem(&blocks, start, &weights, &nominal, None).expect("a problem");
                let found = fit(&problem, start).expect("a fit").fit;
                (found.cost, found.parameters)
            };
            let (without, at) = cost(Effects::none(), truth);
            // from where the fit without effects ends, and from the same start
            for start in [at, truth] {
                let (with, _) = cost(Effects::all(), start);
                assert!(with <= without + 1e-3, "{seed}: {with} {without}");
            }
        }
    }
}
