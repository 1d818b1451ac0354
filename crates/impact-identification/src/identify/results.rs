//! What each method found, as plain results.

use std::collections::BTreeMap;

use crate::identify::diagnostics::{momentum, verdict};
use crate::identify::evidence::contact_law;
use crate::identify::evidence::contact_law::ContactLaw;
use crate::identify::evidence::impacts::{ImpactBlock, SpeedPair};
use crate::identify::evidence::{Blocks, Evidence, impact_bias, structure};
use crate::identify::methods::{self, FitResult};
use crate::identify::parameters::{Coordinate, Parameters};
use crate::identify::solver::Fit;
use crate::identify::statistics::quantile::NORMAL_975;
use crate::identify::uncertainty::posterior::Posterior;
use crate::identify::{Estimate, Item, Method, MethodResult, Remark, bracket_midpoints, estimate};

/// f0, β and `x_st` from the impactless records.
pub fn resonance(blocks: &Blocks, fitted: &FitResult) -> MethodResult {
    let block = &blocks.resonance;
    let observations = block.points.iter().map(|p| 2 * p.responses.len()).sum();
    let mut result = methods::result(
        fitted,
        &methods::RESONANCE,
        observations,
        block.points.len(),
    );
    if let Ok(fit) = fitted {
        verdict::judge_resonance(&mut result, block, &fit.fit.parameters);
    }
    result
}

/// R from the speeds at impacts; what their extrapolation leaves open widens it. The contact law is
/// judged with the corners of the velocities' high-pass as all data together have them.
pub fn impacts(
    blocks: &Blocks,
    fitted: &FitResult,
    evidence: &Evidence<'_>,
    together: Option<&Fit>,
) -> MethodResult {
    if blocks.impact.first_value_only.is_some() {
        return methods::result(fitted, &[Coordinate::Restitution], 0, 0);
    }
    let fit = together.or(fitted.as_ref().ok().map(|a| &a.fit));
    let block = &match fit {
        Some(fit) => blocks.impact.corrected(&fit.parameters),
        None => blocks.impact.clone(),
    };
    let mut records: Vec<usize> = block.pairs.iter().map(|p| p.observation).collect();
    records.dedup();
    let mut result = methods::result(
        fitted,
        &[Coordinate::Restitution],
        block.pairs.len(),
        records.len(),
    );
    if let Some(estimate) = &mut result.parameters.restitution {
        widen(
            estimate,
            fit.map_or(0.0, |fit| impact_bias(block, fit, evidence.nominal.effects))
                .hypot(block.common_error()),
        );
    }
    result.remarks.extend(outlying(blocks, evidence));
    result
        .remarks
        .extend(momentum::momentum(block, evidence).map(|m| m.0));
    let law = contact_law::contact_law(block);
    let gained = law.as_ref().and_then(ContactLaw::gained);
    result.contact_law = law.filter(|_| gained.is_none()).map(ContactLaw::within_one);
    let ratios = structure::ratios(block, evidence.observations);
    if !ratios.is_empty() {
        result.impact_groups = Some(structure::groups(&ratios, evidence.observations));
    }
    verdict::judge_impacts(&mut result, block, evidence, structure::structure(&ratios));
    if let Some(point) = gained {
        verdict::judge_gained(&mut result, point);
    }
    result
}

/// Outlying impacts that a remark names; `left_out` names all.
const NAMED: usize = 3;

/// The impacts that were left out.
fn outlying(blocks: &Blocks, evidence: &Evidence<'_>) -> Option<Remark> {
    let outlying = &blocks.impact_outliers;
    let first = outlying.iter().take(NAMED);
    (!outlying.is_empty()).then(|| Remark::OutlyingImpacts {
        count: outlying.len(),
        first: first.map(|pair| impact(pair, evidence)).collect(),
    })
}

/// An impact of a record.
pub fn impact(pair: &SpeedPair, evidence: &Evidence<'_>) -> Item {
    Item::Impact {
        index: pair.observation,
        record: evidence.observations[pair.observation].record.clone(),
        time_s: pair.time_s,
    }
}

/// All four parameters from the waveforms.
pub fn trajectories(blocks: &Blocks, fitted: &FitResult, evidence: &Evidence<'_>) -> MethodResult {
    let block = &blocks.trajectory;
    let observations = fitted.as_ref().map_or(0, |f| f.fit.residuals);
    let mut result = methods::result(
        fitted,
        &Coordinate::PHYSICAL,
        observations,
        block.records.len(),
    );
    if let Ok(fit) = fitted {
        verdict::judge_trajectories(&mut result, block, &fit.fit.parameters);
    }
    result.remarks.extend(thinned(evidence));
    result
}

/// All four parameters from records that are shot from impact to impact.
pub fn flights(blocks: &Blocks, fitted: &FitResult) -> MethodResult {
    let records = &blocks.flight.records;
    let impacts = records.iter().map(|r| r.nodes.len()).sum();
    let mut result = methods::result(fitted, &Coordinate::PHYSICAL, impacts, records.len());
    if let Some(reduced) = result.reduced_residual {
        result
            .remarks
            .push(Remark::StatesDeviate { ratio: reduced });
    }
    result
}

/// How many waveforms the trajectories rest on where not all were kept.
fn thinned(evidence: &Evidence<'_>) -> Option<Remark> {
    let periodic = evidence.observations.iter().filter(|o| {
        let pair = o.classification.impacts_and_periods();
        !o.excluded() && pair.is_some_and(|(impacts_p, _)| impacts_p == 1)
    });
    let (kept, let_go): (Vec<_>, Vec<_>) = periodic.partition(|o| o.folded.is_some());
    (3 * let_go.len() > kept.len()).then(|| Remark::WaveformsThinned {
        fitted: kept.len(),
        periodic: kept.len() + let_go.len(),
    })
}

/// All four parameters from the brackets, where no resonance curve is beside them.
pub fn boundaries(blocks: &Blocks, fitted: &FitResult) -> MethodResult {
    let brackets = blocks.boundary.brackets.len();
    let tells = match fitted {
        Ok(found) => found.fit.free.clone(),
        Err(_) => Coordinate::PHYSICAL.to_vec(),
    };
    methods::result(fitted, &tells, brackets, 2 * brackets)
}

/// R from the brackets by its posterior, the rest as the resonance curve has it: that is the curve's to say.
pub fn posterior(blocks: &Blocks, posterior: &Posterior, curve: &Parameters) -> MethodResult {
    let brackets = blocks.boundary.brackets.len();
    let (value, error) = posterior.restitution;
    let mut estimate = estimate::estimate(Coordinate::Restitution, value, error);
    estimate.interval95 = estimate.interval95.map(|_| posterior.interval95);
    let about = Parameters {
        restitution: value,
        ..*curve
    };
    let midpoints = bracket_midpoints::restitution(&blocks.boundary, &about);
    let early = posterior.early;
    let mut result = MethodResult {
        observations: brackets,
        records: 2 * brackets,
        ..MethodResult::default()
    };
    result.parameters.restitution = Some(estimate);
    result
        .remarks
        .extend(midpoints.as_ref().and_then(by_midpoints));
    result
        .remarks
        .extend(early.map(|distance| Remark::EarlyJumps { distance }));
    result.restitution_by_midpoints = midpoints;
    result
}

fn by_midpoints(estimate: &Estimate) -> Option<Remark> {
    Some(Remark::BracketMidpoints {
        restitution: estimate.value?,
        half_width: NORMAL_975 * estimate.standard_error?,
    })
}

/// The joint result; without a joint fit, what the free decays or the flight times determine.
pub fn joint(
    evidence: &Evidence<'_>,
    attempt: Option<&FitResult>,
    methods: &BTreeMap<Method, MethodResult>,
) -> MethodResult {
    let Some(attempt) = attempt else {
        let of = |method| methods.get(&method).cloned();
        let only = of(Method::FreeDecay).or_else(|| of(Method::FlightTimes));
        return only.unwrap_or_default();
    };
    let tells: Vec<Coordinate> = match attempt {
        Ok(found) => found.fit.free.clone(),
        Err(_) => Coordinate::PHYSICAL.to_vec(),
    };
    let observations = evidence.observations.iter();
    let records = observations.filter(|o| !o.excluded()).count();
    let observations = attempt.as_ref().map_or(0, |f| f.fit.residuals);
    methods::result(attempt, &tells, observations, records)
}

/// Widen a joint R that rests on impacts between free flights by what their errors have in common.
pub fn widen_common(joint: &mut MethodResult, block: &ImpactBlock) {
    if let Some(estimate) = &mut joint.parameters.restitution {
        widen(estimate, block.common_error());
    }
}

/// Add a systematic part to the standard error of R; an interval that ends at 0 or 1 has its width on the
/// other side.
fn widen(restitution: &mut Estimate, systematic: f64) {
    let (Some(value), Some(error), Some([low, high])) = (
        restitution.value,
        restitution.standard_error,
        restitution.interval95,
    ) else {
        return;
    };
    if systematic > 0.0 {
        let half = (value - low)
            .max(high - value)
            .hypot(NORMAL_975 * systematic);
        restitution.standard_error = Some(error.hypot(systematic));
        restitution.interval95 = Some([(value - half).max(0.0), (value + half).min(1.0)]);
    }
}
