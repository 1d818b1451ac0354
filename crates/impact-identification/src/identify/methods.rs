//! The methods, each alone: boundaries, trajectories, impacts, resonance.

use crate::identify::answer::MethodResult;
use crate::identify::estimate;
use crate::identify::evidence::impacts::FirstValueOnly;
use crate::identify::evidence::resonance::ResonanceBlock;
use crate::identify::evidence::{Blocks, Nominal};
use crate::identify::messages::{Note, Remark};
use crate::identify::method_fit::MethodFit;
use crate::identify::parameters::{Coordinate, Parameters};
use crate::identify::solver::{Block, FitError, Precision, Prior, Problem, mean_squares};
use crate::identify::statistics::scatter::Spread;

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

/// The fit, if there is one.
pub fn succeeded(attempt: &Option<FitResult>) -> Option<&MethodFit> {
    attempt.as_ref().and_then(|a| a.as_ref().ok())
}

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

/// What the impactless records tell.
pub(super) const RESONANCE: [Coordinate; 3] = [
    Coordinate::Frequency,
    Coordinate::Damping,
    Coordinate::Deflection,
];

/// f0, β and `x_st` from the impactless records; the gains' uncertainty enters `x_st`.
pub fn resonance(blocks: &Blocks, nominal: &Nominal) -> Option<FitResult> {
    if !enough(blocks) {
        return None;
    }
    let (few, ideal) = (blocks.resonance.few(MOST_FOR_A_START), nominal.ideal());
    let curve = |start| resonance_curve(&few, blocks, &ideal, (start, Precision::Start));
    let fits = starts(&few, nominal)
        .into_iter()
        .filter_map(|start| curve(start)?.ok());
    let best = fits.min_by(|a, b| a.fit.cost.total_cmp(&b.fit.cost));
    match best {
        Some(best) => resonance_from(blocks, nominal, best.fit.parameters),
        None => Some(Err(FitError::Singular)),
    }
}

/// The same from a start near the optimum.
pub fn resonance_from(blocks: &Blocks, nominal: &Nominal, start: Parameters) -> Option<FitResult> {
    let begin = (start, Precision::Result);
    resonance_curve(&blocks.resonance, blocks, nominal, begin)
}

fn resonance_curve(
    block: &ResonanceBlock,
    blocks: &Blocks,
    nominal: &Nominal,
    begin: (Parameters, Precision),
) -> Option<FitResult> {
    enough(blocks).then(|| alone(block, blocks, nominal, &RESONANCE, begin))
}

fn enough(blocks: &Blocks) -> bool {
    blocks.resonance.points.len() >= RESONANCE.len()
}

/// Impactless records from which the fit of all is started.
const MOST_FOR_A_START: usize = 64;

/// Starting values of the resonance curve: the stated ones, and a coarse grid whose deflection
/// follows from the greatest response.
fn starts(block: &ResonanceBlock, nominal: &Nominal) -> Vec<Parameters> {
    let frequencies: Vec<f64> = block.points.iter().map(|p| p.frequency_hz).collect();
    let low = frequencies.iter().copied().fold(f64::INFINITY, f64::min);
    let high = frequencies.iter().copied().fold(0.0, f64::max);
    let mut out = Vec::new();
    let mut grid: Vec<f64> = (0..7)
        .map(|i| low * 0.8 * (high * 1.25 / (low * 0.8)).powf(f64::from(i) / 6.0))
        .collect();
    grid.extend(nominal.natural_frequency_hz);
    for f0 in grid {
        for beta in [0.01, 0.05, 0.2] {
            let beta = nominal.damping_ratio.unwrap_or(beta);
            let unit = nominal.applied(Parameters::symmetric(0.8, f0, beta, 1.0));
            out.push(Parameters {
                static_deflection_m: deflection_guess(block, &unit),
                ..unit
            });
        }
    }
    let cost = |p: Parameters| {
        let mean_squares = mean_squares(block, &p);
        (mean_squares.into_iter().flatten().sum::<f64>(), p)
    };
    let mut costs: Vec<(f64, Parameters)> = out.into_iter().map(cost).collect();
    costs.sort_by(|a, b| a.0.total_cmp(&b.0));
    costs.into_iter().take(3).map(|(_, start)| start).collect()
}

/// Deflection that best scales the unit response to the measured amplitudes.
pub(super) fn deflection_guess(block: &ResonanceBlock, unit: &Parameters) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for point in &block.points {
        for r in &point.responses {
            let model = crate::identify::evidence::resonance::predicted(
                unit,
                block.rig,
                r.role,
                point.frequency_hz,
                point.drive_amplitude,
            );
            let weight = r.error.hypot(1e-2 * r.amplitude()).powi(-2);
            product += weight * model.norm() * r.amplitude();
            square += weight * model.norm_sqr();
        }
    }
    if square > 0.0 { product / square } else { 1e-3 }
}

/// R alone from the speeds at impacts, with the corners of the velocities' high-pass as nuisances. The
/// speeds of one of two masses do not tell it: an unlike drive of the other one moves their ratio by
/// (1 + R)/2 times its share, which waveforms take into account. Nor do differentiated displacements.
pub fn impacts(blocks: &Blocks, nominal: &Nominal, start: Parameters) -> Option<FitResult> {
    if blocks.impact.pairs.len() < blocks.impact.fewest() {
        return None;
    }
    match blocks.impact.first_value_only {
        Some(FirstValueOnly::OneOfTwo) => return Some(Err(FitError::OneOfTwo)),
        Some(FirstValueOnly::Differentiated) => return Some(Err(FitError::Differentiated)),
        None => {}
    }
    let list: Vec<(&dyn Block, f64)> = vec![(&blocks.impact, 1.0)];
    let (mut free, mut priors) = (vec![Coordinate::Restitution], Vec::new());
    blocks.add_nuisances(nominal, &list, (&mut free, &mut priors));
    Some(fit_blocks(blocks.problem(list, free, priors), start))
}

/// s2, s1 and grazing brackets, with f0, β and `x_st` from the impactless records beside them.
pub fn boundaries(blocks: &Blocks, nominal: &Nominal, start: Parameters) -> Option<FitResult> {
    if blocks.boundary.brackets.is_empty() {
        return None;
    }
    let mut free = Coordinate::PHYSICAL.to_vec();
    if !blocks.boundary.determines_restitution() {
        free.retain(|c| *c != Coordinate::Restitution);
    }
    let mut priors = wide_priors(&start, &free);
    let mut list: Vec<(&dyn Block, f64)> = vec![(&blocks.boundary, 1.0)];
    if !blocks.resonance.points.is_empty() {
        list.push((&blocks.resonance, 1.0));
        blocks.add_nuisances(nominal, &list, (&mut free, &mut priors));
    }
    Some(fit_blocks(blocks.problem(list, free, priors), start))
}

/// All four parameters from the folded waveforms.
pub fn trajectories(
    blocks: &Blocks,
    nominal: &Nominal,
    start: Parameters,
    precision: Precision,
) -> Option<FitResult> {
    if blocks.trajectory.records.is_empty() {
        return None;
    }
    let (block, tells) = (&blocks.trajectory, &Coordinate::PHYSICAL);
    Some(alone(block, blocks, nominal, tells, (start, precision)))
}

/// What one block tells alone, with the nuisances beside it.
fn alone(
    block: &dyn Block,
    blocks: &Blocks,
    nominal: &Nominal,
    tells: &[Coordinate],
    (start, precision): (Parameters, Precision),
) -> FitResult {
    let mut free = tells.to_vec();
    let mut priors = wide_priors(&start, &free);
    let list = vec![(block, 1.0)];
    blocks.add_nuisances(nominal, &list, (&mut free, &mut priors));
    let problem = Problem {
        precision,
        ..blocks.problem(list, free, priors)
    };
    fit_blocks(problem, start)
}

/// Variance of what flights tell over that of independent innovations: an impact's errors of time
/// and extrapolation act on several of them. Over forty simulated campaigns the errors of R and β
/// came out 1.4 times as large as independence has it.
const SHARED_IN_FLIGHTS: f64 = 2.0;

/// All four parameters from the states at the impacts of records without a closed-form orbit.
pub fn flights(blocks: &Blocks, nominal: &Nominal, start: Parameters) -> Option<FitResult> {
    if blocks.flight.records.is_empty() {
        return None;
    }
    let begin = (start, Precision::Result);
    let tells = &Coordinate::PHYSICAL;
    let found = alone(&blocks.flight, blocks, nominal, tells, begin);
    Some(found.map(|found| MethodFit {
        factor: found.factor * SHARED_IN_FLIGHTS,
        ..found
    }))
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
