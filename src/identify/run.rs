//! The whole identification: each method alone, all together, and what to make of it.

use std::collections::BTreeMap;

use crate::identify::agreement::agreement;
use crate::identify::interval::{self, Posterior};
use crate::identify::methods::{self, Blocks, Evidence, IMPACT_BIAS, MethodFit};
use crate::identify::parameters::{Coordinate, Parameters};
use crate::identify::solver::{Block, Fit, FitError, Prior, Problem, mean_squares};
use crate::identify::suspicion::{self, OddGap, Suspicion};
use crate::identify::trajectory::TrajectoryRecord;
use crate::identify::uncertainty::{self, Uncertainty};
use crate::identify::verdict::{self, Findings};
use crate::identify::weighing::Bulk;
use crate::identify::{Agreement, Estimate, MethodResult, Verdict, contact_law, decay, estimate};

/// What an identification leads to; settings, versions and hashes are the caller's to add.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// The verdict.
    pub verdict: Verdict,
    /// All methods together.
    pub joint: MethodResult,
    /// Each method alone.
    pub methods: BTreeMap<String, MethodResult>,
    /// Whether they agree.
    pub agreement: Agreement,
    /// The joint fit, for simulation beside the measurement; `None` without one.
    pub fit: Option<Fit>,
    /// Factor on the joint fit's covariance.
    pub factor: f64,
    /// Records or impacts that were left out of a fit, each with the reason.
    pub left_out: Vec<(String, String)>,
    /// Mistakes of the laboratory that the data give away.
    pub suspicions: Vec<Suspicion>,
    /// What each method contributed, profiles and bootstrap.
    pub uncertainty: Uncertainty,
}

/// Identify from observations and brackets.
pub fn identify(evidence: &Evidence) -> Outcome {
    let mut work = Work::new(evidence);
    let resonance = work.resonance();
    let start = work.start(resonance.as_ref());
    let impacts = methods::impacts(&work.blocks, start);
    let start = with_restitution(start, impacts.as_ref());
    let first = [resonance.as_ref(), impacts.as_ref()];
    let mut fits = work.fits(start, first);
    let mut suspicions = Vec::new();
    while let Some(odd) = work.odd_gap(&fits, suspicions.len()) {
        suspicions.push(odd.suspicion());
        if !work.leave_out_gap(odd.stated_m) {
            break;
        }
        fits = work.fits(start, first);
    }
    suspicions.extend(work.other_suspicions(&fits));
    let uncertainty = work.uncertainty(&fits);
    let Fits {
        trajectories,
        boundaries,
        joint,
        ..
    } = fits;
    let mut found = BTreeMap::new();
    work.store_resonance(&mut found, resonance.as_ref());
    work.store_impacts(&mut found, impacts.as_ref());
    work.store_trajectories(&mut found, trajectories.as_ref());
    work.store_boundaries(&mut found, boundaries.as_ref());
    if let Some(result) = decay::pooled(evidence.observations) {
        found.insert("free_decay".into(), result);
    }
    let (joint_result, fit, factor) = work.joint_result(joint, &found);
    let agreement = agreement(&found);
    let verdict = verdict::verdict(&Findings {
        joint: &joint_result,
        methods: &found,
        agreement: &agreement,
        suspicions: &suspicions,
    });
    Outcome {
        verdict,
        joint: joint_result,
        methods: found,
        agreement,
        fit,
        factor,
        left_out: work.left_out,
        suspicions,
        uncertainty,
    }
}

/// The fits that rest on the records of single gaps, and all together.
struct Fits {
    trajectories: Attempt,
    boundaries: Attempt,
    joint: Attempt,
    /// Where the joint fit started, and the weights of its blocks.
    start: Parameters,
    weights: Weights,
}

/// Weights of resonance curve, trajectories, boundaries and impacts; `None` leaves one out.
type Weights = [Option<f64>; 4];

/// The blocks' names in the order of their weights.
const METHODS: [&str; 4] = ["resonance", "trajectories", "boundaries", "impacts"];

/// Gaps that may be found wrong before the campaign as a whole is at fault.
const MOST_ODD_GAPS: usize = 2;

/// Reduced sum of squares, and allowance beside the noise, from which an interchange of channels
/// is looked for.
const POOR_FIT: f64 = 1.5;
const POOR_ALLOWANCE: f64 = 3e-4;

/// Weight of the impacts among the other methods: what the extrapolation of speeds leaves open is
/// common to all impacts, so that all together tell no more than that.
fn impact_weight(found: &MethodFit) -> f64 {
    let error = found.fit.error(Coordinate::Restitution).unwrap_or(0.0);
    let square = error * error * found.factor;
    square / (square + IMPACT_BIAS * IMPACT_BIAS) / found.factor
}

/// Rounds of leaving outlying records out and fitting again.
const ROUNDS: usize = 2;

type Attempt = Option<Result<MethodFit, FitError>>;

fn succeeded(attempt: Option<&Result<MethodFit, FitError>>) -> Option<&MethodFit> {
    attempt.and_then(|a| a.as_ref().ok())
}

fn with_restitution(
    start: Parameters,
    impacts: Option<&Result<MethodFit, FitError>>,
) -> Parameters {
    match succeeded(impacts) {
        Some(found) => Parameters {
            restitution: found.fit.parameters.restitution.clamp(0.0, 1.0),
            ..start
        },
        None => start,
    }
}

fn best_start(start: Parameters, trajectories: Option<&Result<MethodFit, FitError>>) -> Parameters {
    succeeded(trajectories).map_or(start, |found| found.fit.parameters)
}

struct Work<'a> {
    evidence: &'a Evidence<'a>,
    blocks: Blocks,
    left_out: Vec<(String, String)>,
    /// Periodic records that the trajectories' fit lost, and the typical mean square of the others.
    lost: Vec<TrajectoryRecord>,
    typical: f64,
    /// What the brackets say of R where the resonance curve tells the rest.
    posterior: Option<Posterior>,
}

impl<'a> Work<'a> {
    fn new(evidence: &'a Evidence<'a>) -> Self {
        Self {
            evidence,
            blocks: Blocks::new(evidence),
            left_out: Vec::new(),
            lost: Vec::new(),
            typical: 1.0,
            posterior: None,
        }
    }

    /// Trajectories, boundaries and all together, beside the resonance curve and the impacts.
    fn fits(
        &mut self,
        start: Parameters,
        [resonance, impacts]: [Option<&Result<MethodFit, FitError>>; 2],
    ) -> Fits {
        let trajectories = self.trajectories(start);
        let start = best_start(start, trajectories.as_ref());
        let boundaries = self.boundaries(start);
        self.posterior = succeeded(resonance).and_then(|found| {
            let error = found.fit.error(Coordinate::Deflection)? * found.factor.sqrt();
            let about = found.fit.parameters;
            interval::posterior(&self.blocks.boundary, &about, error.min(0.3))
        });
        let mut weights = [
            resonance,
            trajectories.as_ref(),
            boundaries.as_ref().filter(|_| self.posterior.is_none()),
            impacts,
        ]
        .map(|attempt| succeeded(attempt).map(|f| 1.0 / f.factor));
        weights[3] = succeeded(impacts).map(impact_weight);
        let joint = self.joint(&self.blocks, start, weights);
        Fits {
            trajectories,
            boundaries,
            joint,
            start,
            weights,
        }
    }

    /// What is asked for of the joint fit's uncertainty.
    fn uncertainty(&self, fits: &Fits) -> Uncertainty {
        let problem = self.joint_problem(&self.blocks, fits.start, fits.weights);
        let Some((problem, joint)) = problem.zip(succeeded(fits.joint.as_ref())) else {
            return Uncertainty::default();
        };
        let counts = [
            self.blocks.resonance.items(),
            self.blocks.trajectory.items(),
            self.blocks.boundary.items(),
            self.blocks.impact.items(),
        ];
        let names: Vec<&str> = METHODS
            .into_iter()
            .zip(fits.weights.iter().zip(counts))
            .filter(|(_, (weight, count))| weight.is_some() && *count > 0)
            .map(|(name, _)| name)
            .collect();
        let asked = &self.evidence.uncertainty;
        uncertainty::uncertainty(&problem, &names, &joint.fit, joint.factor, asked)
    }

    /// The gap that deviates most from what the others say, if one does.
    fn odd_gap(&self, fits: &Fits, found: usize) -> Option<OddGap> {
        if found >= MOST_ODD_GAPS {
            return None;
        }
        let joint = succeeded(fits.joint.as_ref())?;
        let block = &self.blocks.trajectory;
        let weight = 1.0 / succeeded(fits.trajectories.as_ref())?.factor;
        suspicion::lost_gap(block, &self.lost, &joint.fit.parameters, self.typical)
            .or_else(|| suspicion::odd_gap(block, weight, &joint.fit, joint.factor))
    }

    /// Leave the records and brackets of one gap out; false where nothing would remain.
    fn leave_out_gap(&mut self, clearance_m: f64) -> bool {
        let records = &mut self.blocks.trajectory.records;
        if records.iter().all(|r| r.clearance_m == clearance_m) {
            return false;
        }
        let reason = "its gap is not as stated: left out of trajectories and boundaries";
        let observations = self.evidence.observations;
        self.left_out.extend(
            records
                .iter()
                .filter(|r| r.clearance_m == clearance_m)
                .map(|r| {
                    (
                        observations[r.observation].record.clone(),
                        reason.to_owned(),
                    )
                }),
        );
        records.retain(|r| r.clearance_m != clearance_m);
        self.lost.retain(|r| r.clearance_m != clearance_m);
        let brackets = &mut self.blocks.boundary.brackets;
        brackets.retain(|b| b.clearance_m != clearance_m);
        true
    }

    /// Gains far off and interchanged channels.
    fn other_suspicions(&self, fits: &Fits) -> Vec<Suspicion> {
        let Some(joint) = succeeded(fits.joint.as_ref()) else {
            return Vec::new();
        };
        let nominal = &self.evidence.nominal;
        let allowance = self.blocks.resonance.relative_error;
        let allowance = allowance.max(self.blocks.trajectory.relative_error);
        let lost = self.lost.len() > self.blocks.trajectory.records.len();
        if joint.reduced > POOR_FIT || allowance > POOR_ALLOWANCE || lost {
            let start = joint.fit.parameters;
            let unit = [Some(1.0), Some(1.0), None, None];
            let cost = |blocks: &Blocks| {
                let attempt = self.joint(blocks, start, unit);
                let found = succeeded(attempt.as_ref())?;
                Some((found.fit.cost, found.fit.residuals))
            };
            if let Some(found) = suspicion::swapped(&self.blocks, &cost) {
                return vec![found];
            }
        }
        suspicion::gains(&joint.fit, joint.factor, nominal)
    }

    /// Starting values: the resonance curve's, else the stated ones, else guesses of scale.
    fn start(&self, resonance: Option<&Result<MethodFit, FitError>>) -> Parameters {
        if let Some(found) = succeeded(resonance) {
            return found.fit.parameters;
        }
        let nominal = &self.evidence.nominal;
        let frequencies: Vec<f64> = self
            .evidence
            .observations
            .iter()
            .filter_map(|o| o.frequency_hz())
            .collect();
        let clearances: Vec<f64> = self
            .evidence
            .observations
            .iter()
            .filter_map(|o| o.setting.clearance_m)
            .collect();
        let median = |v: &[f64], default: f64| crate::signal::robust::median(v).unwrap_or(default);
        Parameters::symmetric(
            nominal.restitution.unwrap_or(0.8),
            nominal
                .natural_frequency_hz
                .unwrap_or_else(|| median(&frequencies, 10.0) / 1.2),
            nominal.damping_ratio.unwrap_or(0.05),
            nominal
                .static_deflection_m
                .unwrap_or_else(|| median(&clearances, 1e-3).abs() / 2.0),
        )
    }

    fn name(&self, observation: usize) -> String {
        self.evidence.observations[observation].record.clone()
    }

    /// Fit the impactless records; those that fit far worse than the bulk are named and left out.
    fn resonance(&mut self) -> Attempt {
        let first = match methods::resonance(&self.blocks, &self.evidence.nominal)? {
            Ok(first) => first,
            failed => return Some(failed),
        };
        let parameters = first.fit.parameters;
        self.blocks.weigh_resonance(&parameters);
        let scores: Vec<f64> = mean_squares(&self.blocks.resonance, &parameters)
            .into_iter()
            .map(|s| s.unwrap_or(0.0))
            .collect();
        let bulk = Bulk::of(&scores);
        let points = std::mem::take(&mut self.blocks.resonance.points);
        for (point, score) in points.into_iter().zip(scores) {
            if score <= bulk.limit {
                self.blocks.resonance.points.push(point);
            } else {
                let reason = format!(
                    "its response fits {:.0} times worse than the others (still settling?): left \
                     out of the resonance curve",
                    bulk.times_worse(score)
                );
                self.left_out.push((self.name(point.observation), reason));
            }
        }
        methods::resonance(&self.blocks, &self.evidence.nominal)
    }

    /// Fit the folded records; those without an orbit at the start are tried again at the end,
    /// and those that fit far worse than the bulk are left out and named.
    fn trajectories(&mut self, start: Parameters) -> Attempt {
        let all = self.blocks.trajectory.records.clone();
        let at_start = mean_squares(&self.blocks.trajectory, &start);
        let mut has_orbit = at_start.iter().map(Option::is_some);
        let records = &mut self.blocks.trajectory.records;
        records.retain(|_| has_orbit.next().unwrap_or(false));
        let mut found = match methods::trajectories(&self.blocks, &self.evidence.nominal, start)? {
            Ok(first) => first,
            failed => return Some(failed),
        };
        self.blocks.trajectory.records = all;
        for _ in 0..ROUNDS {
            let parameters = found.fit.parameters;
            self.keep_fitting(&parameters);
            found = match methods::trajectories(&self.blocks, &self.evidence.nominal, parameters)? {
                Ok(found) => found,
                failed => return Some(failed),
            };
        }
        Some(Ok(found))
    }

    /// Keep the records that fit like the bulk, name the others, and find again what is allowed
    /// beside the noise.
    fn keep_fitting(&mut self, parameters: &Parameters) {
        let scores = mean_squares(&self.blocks.trajectory, parameters);
        let known: Vec<f64> = scores.iter().flatten().copied().collect();
        let bulk = Bulk::of(&known);
        self.typical = bulk.typical;
        let records = std::mem::take(&mut self.blocks.trajectory.records);
        for (record, score) in records.into_iter().zip(scores) {
            let reason = match score {
                Some(s) if s <= bulk.limit => {
                    self.blocks.trajectory.records.push(record);
                    continue;
                }
                Some(s) => format!(
                    "its waveform fits {:.1} times worse than the others: left out of the \
                     trajectories",
                    bulk.times_worse(s)
                ),
                None => "the model has no such periodic motion at the fitted parameters: left \
                         out of the trajectories"
                    .to_owned(),
            };
            self.left_out.push((self.name(record.observation), reason));
            self.lost.push(record);
        }
        self.blocks.weigh_trajectories(parameters);
    }

    /// Fit the brackets; those that no boundary reaches, or that lie far from it, are named.
    fn boundaries(&mut self, start: Parameters) -> Attempt {
        let rig = self.evidence.rig;
        let mut kept = Vec::new();
        for bracket in std::mem::take(&mut self.blocks.boundary.brackets) {
            let predicted = crate::identify::boundary::predicted_hz(&bracket, &start, rig);
            let near = predicted.is_some_and(|f| {
                (f - bracket.middle_hz()).abs() <= 3.0 * bracket.width_hz() + 0.02 * f
            });
            if near {
                kept.push(bracket);
            } else {
                let place = format!(
                    "bracket {} {:.2}–{:.2} Hz at {:.3} mm",
                    bracket.kind.name(),
                    bracket.frequency_low_hz,
                    bracket.frequency_high_hz,
                    bracket.clearance_m * 1e3
                );
                let reason = "the motion changed far from the simulated boundary: a disturbance, \
                              or another boundary";
                self.left_out.push((place, reason.into()));
            }
        }
        self.blocks.boundary.brackets = kept;
        self.blocks.boundary.fit_early_scale(&start);
        methods::boundaries(&self.blocks, &self.evidence.nominal, start)
    }

    /// All blocks in one fit, each with its weight; those without one stay out.
    fn joint(&self, blocks: &Blocks, start: Parameters, weights: Weights) -> Attempt {
        let problem = self.joint_problem(blocks, start, weights)?;
        Some(fit_joint(&problem, start))
    }

    /// The problem of all blocks, each with its weight.
    fn joint_problem<'b>(
        &self,
        blocks: &'b Blocks,
        start: Parameters,
        [resonance, trajectories, boundaries, impacts]: Weights,
    ) -> Option<Problem<'b>> {
        let mut list: Vec<(&'b dyn Block, f64)> = Vec::new();
        let candidates: [(&'b dyn Block, Option<f64>); 4] = [
            (&blocks.resonance, resonance),
            (&blocks.trajectory, trajectories),
            (&blocks.boundary, boundaries),
            (&blocks.impact, impacts),
        ];
        for (block, weight) in candidates {
            if let (Some(weight), true) = (weight, block.items() > 0) {
                list.push((block, weight));
            }
        }
        if list.is_empty() {
            return None;
        }
        let mut free: Vec<Coordinate> = Coordinate::PHYSICAL
            .into_iter()
            .filter(|c| list.iter().any(|(block, _)| block.touches(*c)))
            .collect();
        let mut priors = methods::wide_priors(&start, &free);
        if let Some(found) = &self.posterior {
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
        let waveforms = resonance.is_some() || trajectories.is_some();
        if waveforms {
            let (nuisances, more) = blocks.nuisances(self.evidence.nominal.gain_uncertainty);
            free.extend(nuisances);
            priors.extend(more);
        }
        Some(Problem {
            blocks: list,
            priors,
            free,
        })
    }

    fn joint_result(
        &self,
        attempt: Attempt,
        methods: &BTreeMap<String, MethodResult>,
    ) -> (MethodResult, Option<Fit>, f64) {
        let Some(attempt) = attempt else {
            // Only decays, or nothing: the joint answer is the decays' own.
            let only = methods.get("free_decay").cloned().unwrap_or_default();
            return (only, None, 1.0);
        };
        let tells: Vec<Coordinate> = match &attempt {
            Ok(found) => found.fit.free.clone(),
            Err(_) => Coordinate::PHYSICAL.to_vec(),
        };
        let records = self
            .evidence
            .observations
            .iter()
            .filter(|o| !o.excluded())
            .count();
        let observations = attempt.as_ref().map_or(0, |f| f.fit.residuals);
        let result = methods::result(&attempt, &tells, observations, records);
        match attempt {
            Ok(found) => (result, Some(found.fit), found.factor),
            Err(_) => (result, None, 1.0),
        }
    }

    fn store_resonance(
        &self,
        found: &mut BTreeMap<String, MethodResult>,
        attempt: Option<&Result<MethodFit, FitError>>,
    ) {
        let Some(attempt) = attempt else { return };
        let tells = [
            Coordinate::Frequency,
            Coordinate::Damping,
            Coordinate::Deflection,
        ];
        let block = &self.blocks.resonance;
        let observations = block.points.iter().map(|p| 2 * p.responses.len()).sum();
        let mut result = methods::result(attempt, &tells, observations, block.points.len());
        if let Ok(fit) = attempt {
            verdict::judge_resonance(&mut result, block, &fit.fit.parameters);
        }
        found.insert("resonance".into(), result);
    }

    fn store_impacts(
        &self,
        found: &mut BTreeMap<String, MethodResult>,
        attempt: Option<&Result<MethodFit, FitError>>,
    ) {
        let Some(attempt) = attempt else { return };
        let block = &self.blocks.impact;
        let mut records: Vec<usize> = block.pairs.iter().map(|p| p.observation).collect();
        records.dedup();
        let mut result = methods::result(
            attempt,
            &[Coordinate::Restitution],
            block.pairs.len(),
            records.len(),
        );
        if let Some(estimate) = &mut result.parameters.restitution {
            widen(estimate, IMPACT_BIAS);
        }
        if self.blocks.impact_outliers > 0 {
            result.remarks.push(format!(
                "{} impacts lie far from the bulk and were left out",
                self.blocks.impact_outliers
            ));
        }
        result.contact_law = contact_law::contact_law(block);
        verdict::judge_impacts(&mut result, block, self.evidence);
        found.insert("impacts".into(), result);
    }

    fn store_trajectories(
        &self,
        found: &mut BTreeMap<String, MethodResult>,
        attempt: Option<&Result<MethodFit, FitError>>,
    ) {
        let Some(attempt) = attempt else { return };
        let block = &self.blocks.trajectory;
        let observations = attempt.as_ref().map_or(0, |f| f.fit.residuals);
        let mut result = methods::result(
            attempt,
            &Coordinate::PHYSICAL,
            observations,
            block.records.len(),
        );
        if let Ok(fit) = attempt {
            verdict::judge_trajectories(&mut result, block, &fit.fit.parameters);
        }
        found.insert("trajectories".into(), result);
    }

    fn store_boundaries(
        &self,
        found: &mut BTreeMap<String, MethodResult>,
        attempt: Option<&Result<MethodFit, FitError>>,
    ) {
        let Some(attempt) = attempt else { return };
        let brackets = self.blocks.boundary.brackets.len();
        let tells = match attempt {
            Ok(found) => found.fit.free.clone(),
            Err(_) => Coordinate::PHYSICAL.to_vec(),
        };
        let mut result = methods::result(attempt, &tells, brackets, 2 * brackets);
        if let Some(posterior) = &self.posterior {
            let (value, error) = posterior.restitution;
            let mut estimate = estimate::estimate(Coordinate::Restitution, value, error, None);
            estimate.interval95 = estimate.interval95.map(|_| posterior.interval95);
            result.parameters.restitution = Some(estimate);
            let (value, error) = posterior.ln_deflection;
            result.parameters.static_deflection_m = Some(estimate::estimate(
                Coordinate::Deflection,
                value,
                error,
                None,
            ));
        }
        found.insert("boundaries".into(), result);
    }
}

/// Add a systematic part to an estimate's standard error.
fn widen(estimate: &mut Estimate, systematic: f64) {
    if let (Some(value), Some(error)) = (estimate.value, estimate.standard_error) {
        let error = error.hypot(systematic);
        let half = crate::identify::estimate::NORMAL_975 * error;
        estimate.standard_error = Some(error);
        estimate.interval95 = Some([(value - half).max(0.0), (value + half).min(1.0)]);
    }
}

/// Fit all blocks together from a start that each of them accepts.
fn fit_joint(problem: &Problem<'_>, start: Parameters) -> Result<MethodFit, FitError> {
    let fit = problem.fit(start)?;
    let freedom = fit.residuals.saturating_sub(4).max(1) as f64;
    let reduced = fit.cost / freedom;
    Ok(MethodFit {
        factor: reduced.max(1.0),
        reduced,
        fit,
    })
}
