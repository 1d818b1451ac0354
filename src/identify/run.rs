//! The whole identification: each method alone, all together, and what to make of it.

use std::collections::BTreeMap;

use crate::identify::evidence::{Blocks, Evidence};
use crate::identify::fit::parameters::{Coordinate, Parameters};
use crate::identify::fit::{Fit, Problem};
use crate::identify::joint::{self, Method, Weights};
use crate::identify::judgement::agreement::agreement;
use crate::identify::judgement::interchange;
use crate::identify::judgement::suspicion::{self, OddGap, Suspicion};
use crate::identify::judgement::verdict::{self, Findings};
use crate::identify::methods::{self, Attempt, succeeded};
use crate::identify::selection::Selection;
use crate::identify::uncertainty::posterior::{self, Posterior};
use crate::identify::uncertainty::{self, Uncertainty};
use crate::identify::{Agreement, MethodResult, Verdict, decay, results};

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
    let mut work = Work {
        evidence,
        selection: Selection::new(evidence),
        posterior: None,
    };
    let resonance = work.selection.resonance();
    let start = start(evidence, &resonance);
    let impacts = methods::impacts(&work.selection.blocks, &evidence.nominal, start);
    let start = with_restitution(start, &impacts);
    let mut fits = work.fits(start, resonance, impacts);
    let mut suspicions = Vec::new();
    while let Some(odd) = work.odd_gap(&fits, suspicions.len()) {
        suspicions.push(odd.suspicion());
        if !work.selection.leave_out_gap(odd.stated_m) {
            break;
        }
        fits = work.fits(start, fits.resonance, fits.impacts);
    }
    fits = work.without_pulling(fits);
    suspicions.extend(work.other_suspicions(&fits));
    let uncertainty = work.uncertainty(&fits);
    let found = work.results(&fits);
    let (joint_result, fit, factor) = results::joint(evidence, fits.joint, &found);
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
        left_out: work.selection.left_out,
        suspicions,
        uncertainty,
    }
}

/// Every method's fit, and all together.
struct Fits {
    resonance: Attempt,
    impacts: Attempt,
    trajectories: Attempt,
    boundaries: Attempt,
    flights: Attempt,
    joint: Attempt,
    /// Where the joint fit started, and the weights of its blocks.
    start: Parameters,
    weights: Weights,
}

/// Gaps that may be found wrong before the campaign as a whole is at fault.
const MOST_ODD_GAPS: usize = 2;

/// Rounds of leaving out records that pull the fit.
const MOST_PULLING: usize = 8;

/// R as the impacts tell it.
fn with_restitution(start: Parameters, impacts: &Attempt) -> Parameters {
    match succeeded(impacts) {
        Some(found) => Parameters {
            restitution: found.fit.parameters.restitution.clamp(0.0, 1.0),
            ..start
        },
        None => start,
    }
}

/// Starting values: the resonance curve's, else the stated ones, else guesses of scale.
fn start(evidence: &Evidence, resonance: &Attempt) -> Parameters {
    if let Some(found) = succeeded(resonance) {
        return found.fit.parameters;
    }
    let nominal = &evidence.nominal;
    let frequencies: Vec<f64> = evidence
        .observations
        .iter()
        .filter_map(|o| o.frequency_hz())
        .collect();
    let clearances: Vec<f64> = evidence
        .observations
        .iter()
        .filter_map(|o| o.setting.clearance_m)
        .collect();
    let median = |v: &[f64], default: f64| crate::signal::robust::median(v).unwrap_or(default);
    nominal.applied(Parameters::symmetric(
        nominal.restitution.unwrap_or(0.8),
        nominal
            .natural_frequency_hz
            .unwrap_or_else(|| median(&frequencies, 10.0) / 1.2),
        nominal.damping_ratio.unwrap_or(0.05),
        nominal
            .static_deflection_m
            .unwrap_or_else(|| median(&clearances, 1e-3).abs() / 2.0),
    ))
}

struct Work<'a> {
    evidence: &'a Evidence<'a>,
    selection: Selection<'a>,
    /// What the brackets say of R where the resonance curve tells the rest.
    posterior: Option<Posterior>,
}

impl Work<'_> {
    /// Trajectories, boundaries and all together, beside the resonance curve and the impacts.
    fn fits(&mut self, start: Parameters, resonance: Attempt, impacts: Attempt) -> Fits {
        let trajectories = self.selection.trajectories(start);
        let start = succeeded(&trajectories).map_or(start, |f| f.fit.parameters);
        let boundaries = self.selection.boundaries(start);
        self.posterior = succeeded(&resonance).and_then(|found| {
            let error = found.fit.error(Coordinate::Deflection)? * found.factor.sqrt();
            let about = found.fit.parameters;
            posterior::of_brackets(&self.selection.blocks.boundary, &about, error.min(0.3))
        });
        let flights = self.selection.flights(start);
        let weight = |attempt: &Attempt| succeeded(attempt).map(|f| 1.0 / f.factor);
        // Flights rest on the speeds at impacts; waveforms tell the same better than either.
        let flown = weight(&flights).filter(|_| succeeded(&trajectories).is_none());
        let weights = [
            weight(&resonance),
            weight(&trajectories),
            weight(&boundaries).filter(|_| self.posterior.is_none()),
            succeeded(&impacts)
                .map(joint::impact_weight)
                .filter(|_| flown.is_none()),
            flown,
        ];
        let joint = self.joint(&self.selection.blocks, start, &weights);
        Fits {
            resonance,
            impacts,
            trajectories,
            boundaries,
            flights,
            joint,
            start,
            weights,
        }
    }

    /// The fits without the records that pull them away from what all others say.
    fn without_pulling(&mut self, mut fits: Fits) -> Fits {
        for _ in 0..MOST_PULLING {
            let Some(joint) = succeeded(&fits.joint) else {
                break;
            };
            let start = joint.fit.parameters;
            let blocks = &self.selection.blocks;
            let present = joint::present(blocks, &fits.weights);
            let pulling = self
                .problem(blocks, fits.start, &fits.weights)
                .map(|problem| self.selection.pulling(&problem, &present, &start));
            let Some(pulling) = pulling.filter(|p| !p.is_empty()) else {
                break;
            };
            self.selection.leave_out(&pulling);
            let resonance = if pulling.resonance.is_empty() {
                fits.resonance
            } else {
                methods::resonance(&self.selection.blocks, &self.evidence.nominal)
            };
            fits = self.fits(start, resonance, fits.impacts);
        }
        fits
    }

    /// All blocks in one fit, each with its weight; those without one stay out.
    fn joint(&self, blocks: &Blocks, start: Parameters, weights: &Weights) -> Attempt {
        let problem = self.problem(blocks, start, weights)?;
        Some(joint::fit(&problem, start))
    }

    fn problem<'b>(
        &self,
        blocks: &'b Blocks,
        start: Parameters,
        weights: &Weights,
    ) -> Option<Problem<'b>> {
        let posterior = self.posterior.as_ref();
        joint::problem(blocks, start, weights, &self.evidence.nominal, posterior)
    }

    /// What is asked for of the joint fit's uncertainty.
    fn uncertainty(&self, fits: &Fits) -> Uncertainty {
        let blocks = &self.selection.blocks;
        let problem = self.problem(blocks, fits.start, &fits.weights);
        let Some((problem, joint)) = problem.zip(succeeded(&fits.joint)) else {
            return Uncertainty::default();
        };
        let present = joint::present(blocks, &fits.weights);
        let names: Vec<&str> = present.into_iter().map(Method::name).collect();
        let asked = &self.evidence.uncertainty;
        uncertainty::uncertainty(&problem, &names, &joint.fit, joint.factor, asked)
    }

    /// The gap that deviates most from what the others say, if one does.
    fn odd_gap(&self, fits: &Fits, found: usize) -> Option<OddGap> {
        if found >= MOST_ODD_GAPS {
            return None;
        }
        let joint = succeeded(&fits.joint)?;
        let Selection {
            blocks,
            lost,
            typical,
            ..
        } = &self.selection;
        let weight = 1.0 / succeeded(&fits.trajectories)?.factor;
        suspicion::lost_gap(&blocks.trajectory, lost, &joint.fit.parameters, *typical)
            .or_else(|| suspicion::odd_gap(&blocks.trajectory, weight, &joint.fit, joint.factor))
    }

    /// Gains and corners far off, and interchanged channels.
    fn other_suspicions(&self, fits: &Fits) -> Vec<Suspicion> {
        let Some(joint) = succeeded(&fits.joint) else {
            return Vec::new();
        };
        let start = joint.fit.parameters;
        let cost = |blocks: &Blocks, weights: &Weights| {
            let attempt = self.joint(blocks, start, weights);
            let found = succeeded(&attempt)?;
            Some((found.fit.cost, found.fit.residuals))
        };
        if let Some(found) = interchange::swapped(&self.selection.blocks, &cost) {
            return vec![found];
        }
        let nominal = &self.evidence.nominal;
        suspicion::channels(&joint.fit, joint.factor, nominal)
    }

    /// What each method found.
    fn results(&self, fits: &Fits) -> BTreeMap<String, MethodResult> {
        let blocks = &self.selection.blocks;
        let posterior = self.posterior.as_ref();
        let together = succeeded(&fits.joint).map(|j| &j.fit);
        let found = [
            fits.resonance
                .as_ref()
                .map(|a| results::resonance(blocks, a)),
            fits.trajectories
                .as_ref()
                .map(|a| results::trajectories(blocks, a, self.evidence)),
            fits.boundaries
                .as_ref()
                .map(|a| results::boundaries(blocks, a, posterior)),
            fits.impacts
                .as_ref()
                .map(|a| results::impacts(blocks, a, self.evidence, together)),
            fits.flights.as_ref().map(|a| results::flights(blocks, a)),
        ];
        let mut named: BTreeMap<String, MethodResult> = Method::ALL
            .into_iter()
            .zip(found)
            .filter_map(|(method, result)| Some((method.name().to_owned(), result?)))
            .collect();
        if let Some(result) = decay::pooled(self.evidence.observations) {
            named.insert("free_decay".into(), result);
        }
        named
    }
}
