//! A fit of blocks of residuals, and what is made of it.

use crate::estimate;
use crate::evidence::Nominal;
use crate::messages::{Note, Remark};
use crate::method_fit::MethodFit;
use crate::methods::answer::MethodResult;
use crate::methods::blocks::Blocks;
use crate::parameters::{Coordinate, Parameters};
use crate::solver::{Block, FitError, Precision, Prior, Problem};
use crate::statistics::scatter::Spread;

/// Very wide priors that keep the equations regular where the data say nothing.
pub fn wide_priors(start: &Parameters, free: &[Coordinate]) -> Vec<Prior> {
    free.iter()
        .filter_map(|coordinate| {
            let deviation = match coordinate {
                Coordinate::Restitution => 1.0,
                Coordinate::Frequency => 0.5,
                Coordinate::Damping | Coordinate::Deflection => 2.0,
                _ => return None,
            };
            let centre = start.coordinate(*coordinate);
            Some(Prior::new(*coordinate, centre, deviation))
        })
        .collect()
}

/// A method's fit, or why there is none; `None` in its place if there was nothing to fit.
pub type FitResult = Result<MethodFit, FitError>;

/// Fit a problem and find the variance factor.
///
/// # Errors
/// Those of [`Problem::fit`].
pub fn fit_blocks(problem: Problem<'_>, start: Parameters) -> FitResult {
    let fit = problem.fit_from_both_ends(start)?;
    let informed = problem.free.len().saturating_sub(problem.priors.len());
    let freedom = fit.residuals.saturating_sub(informed);
    Ok(MethodFit::of(&problem, fit, freedom))
}

/// What one block tells alone, with the nuisances beside it.
pub(super) fn alone(
    block: &dyn Block,
    blocks: &Blocks,
    nominal: &Nominal,
    tells: &[Coordinate],
    start: Parameters,
    precision: Precision,
) -> FitResult {
    let mut free = tells.to_vec();
    let mut priors = wide_priors(&start, &free);
    let list = vec![(block, 1.0)];
    blocks.add_nuisances(nominal, &list, &mut free, &mut priors);
    let problem = Problem {
        precision,
        ..blocks.problem(list, free, priors)
    };
    fit_blocks(problem, start)
}

/// A method's result from its fit.
pub fn result(
    fitted: &FitResult,
    tells: &[Coordinate],
    observations: usize,
    records: usize,
) -> MethodResult {
    match fitted {
        Ok(found) => {
            let mut result = MethodResult {
                parameters: estimate::parameter_set(found, tells),
                observations,
                records,
                reduced_residual: Some(found.reduced.sqrt()),
                fit_report: Some(found.fit.report.clone()),
                ..MethodResult::default()
            };
            for coordinate in &found.fit.free {
                if Coordinate::PHYSICAL.contains(coordinate) {
                    continue;
                }
                let unknown = Spread::known(f64::INFINITY);
                let spread = found.spread(*coordinate).unwrap_or(unknown);
                let value = found.fit.parameters.coordinate(*coordinate);
                let estimate = estimate::estimate_within(*coordinate, value, spread, None);
                result.further.insert(*coordinate, estimate);
            }
            result
        }
        Err(error) => {
            let mut result = MethodResult {
                observations,
                records,
                ..MethodResult::default()
            };
            for coordinate in tells {
                if let Some(slot) = result.parameters.slot(*coordinate) {
                    *slot = Some(estimate::not_identifiable(Note::from(error)));
                }
            }
            let why = Note::from(error);
            result.remarks.push(Remark::NoResult { why });
            result
        }
    }
}
