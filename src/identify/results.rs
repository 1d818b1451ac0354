//! What each method found, as plain results.

use std::collections::BTreeMap;

use crate::identify::evidence::{Blocks, Evidence, IMPACT_BIAS};
use crate::identify::fit::Fit;
use crate::identify::fit::parameters::{Coordinate, Parameters};
use crate::identify::judgement::{contact_law, verdict};
use crate::identify::methods::{self, Attempt, Tried};
use crate::identify::uncertainty::posterior::Posterior;
use crate::identify::{Estimate, MethodResult, OutlyingImpact, estimate, middles};

/// f0, β and x_st from the impactless records.
pub fn resonance(blocks: &Blocks, tried: &Tried) -> MethodResult {
    let tells = [
        Coordinate::Frequency,
        Coordinate::Damping,
        Coordinate::Deflection,
    ];
    let block = &blocks.resonance;
    let observations = block.points.iter().map(|p| 2 * p.responses.len()).sum();
    let mut result = methods::result(tried, &tells, observations, block.points.len());
    if let Ok(fit) = tried {
        verdict::judge_resonance(&mut result, block, &fit.fit.parameters);
    }
    result
}

/// R from the speeds at impacts; what their extrapolation leaves open widens it. The contact law is
/// judged with the corners of the velocities' high-pass as all data together have them.
pub fn impacts(
    blocks: &Blocks,
    tried: &Tried,
    evidence: &Evidence,
    together: Option<&Fit>,
) -> MethodResult {
    let fit = together.or(tried.as_ref().ok().map(|a| &a.fit));
    let block = &match fit {
        Some(fit) => blocks.impact.corrected(&fit.parameters),
        None => blocks.impact.clone(),
    };
    let mut records: Vec<usize> = block.pairs.iter().map(|p| p.observation).collect();
    records.dedup();
    let mut result = methods::result(
        tried,
        &[Coordinate::Restitution],
        block.pairs.len(),
        records.len(),
    );
    if let Some(estimate) = &mut result.parameters.restitution {
        widen(estimate, IMPACT_BIAS);
    }
    result.outlying_impacts = outlying(blocks, evidence);
    result.remarks.extend(told(&result.outlying_impacts));
    result.contact_law = contact_law::contact_law(block);
    verdict::judge_impacts(&mut result, block, evidence);
    result
}

/// Impacts that were left out, by their records' names.
fn outlying(blocks: &Blocks, evidence: &Evidence) -> Vec<OutlyingImpact> {
    let pairs = blocks.impact_outliers.iter();
    pairs
        .map(|pair| OutlyingImpact {
            record: evidence.observations[pair.observation].record.clone(),
            time_s: pair.time_s,
            before_m_s: pair.before_m_s,
            after_m_s: pair.after_m_s,
        })
        .collect()
}

/// Outlying impacts that a remark names; `identification.json` names all.
const NAMED: usize = 3;

fn told(outlying: &[OutlyingImpact]) -> Option<String> {
    let named: Vec<String> = outlying
        .iter()
        .take(NAMED)
        .map(|i| format!("{} at {:.3} s", i.record, i.time_s))
        .collect();
    let count = outlying.len();
    if count == 0 {
        return None;
    }
    let more = if count > NAMED {
        ", … (all in identification.json)"
    } else {
        ""
    };
    let which = named.join(", ");
    let lie = match count {
        1 => "1 impact lies far from the bulk and was left out".to_owned(),
        _ => format!("{count} impacts lie far from the bulk and were left out"),
    };
    Some(format!("{lie}: {which}{more}"))
}

/// All four parameters from the waveforms.
pub fn trajectories(blocks: &Blocks, tried: &Tried, evidence: &Evidence) -> MethodResult {
    let block = &blocks.trajectory;
    let observations = tried.as_ref().map_or(0, |f| f.fit.residuals);
    let mut result = methods::result(
        tried,
        &Coordinate::PHYSICAL,
        observations,
        block.records.len(),
    );
    if let Ok(fit) = tried {
        verdict::judge_trajectories(&mut result, block, &fit.fit.parameters);
    }
    result.remarks.extend(thinned(evidence));
    result
}

/// All four parameters from records that are shot from impact to impact.
pub fn flights(blocks: &Blocks, tried: &Tried) -> MethodResult {
    let records = &blocks.flight.records;
    let impacts = records.iter().map(|r| r.nodes.len()).sum();
    let mut result = methods::result(tried, &Coordinate::PHYSICAL, impacts, records.len());
    if let Some(reduced) = result.reduced_residual {
        result.remarks.push(format!(
            "from impact to impact, the states deviate {reduced:.1} times their errors"
        ));
    }
    result
}

/// How many waveforms the trajectories rest on where not all were kept.
fn thinned(evidence: &Evidence) -> Option<String> {
    let periodic = evidence.observations.iter().filter(|o| {
        let pair = o.classification.impacts_and_periods();
        !o.excluded() && pair.is_some_and(|(impacts_p, _)| impacts_p == 1)
    });
    let (kept, let_go): (Vec<_>, Vec<_>) = periodic.partition(|o| o.folded.is_some());
    (3 * let_go.len() > kept.len()).then(|| {
        let all = kept.len() + let_go.len();
        format!(
            "waveforms of {} of {all} periodic records are fitted, evenly chosen",
            kept.len()
        )
    })
}

/// R from the brackets, by its posterior where the resonance curve tells the rest.
pub fn boundaries(blocks: &Blocks, tried: &Tried, posterior: Option<&Posterior>) -> MethodResult {
    let brackets = blocks.boundary.brackets.len();
    let tells = match tried {
        Ok(found) => found.fit.free.clone(),
        Err(_) => Coordinate::PHYSICAL.to_vec(),
    };
    let mut result = methods::result(tried, &tells, brackets, 2 * brackets);
    if let Some(posterior) = posterior {
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
        let about = tried.as_ref().ok().map(|found| Parameters {
            restitution: posterior.restitution.0,
            ..found.fit.parameters
        });
        let middles = about.and_then(|at| middles::restitution(&blocks.boundary, &at));
        result.remarks.extend(middles.as_ref().and_then(in_words));
        let named = middles.map(|estimate| ("restitution_by_middles".to_owned(), estimate));
        result.further.extend(named);
    }
    result
}

fn in_words(middles: &Estimate) -> Option<String> {
    let (value, error) = (middles.value?, middles.standard_error?);
    Some(format!(
        "plain least squares on the middles of the s2 brackets: R = {value:.3} ± {:.3}",
        estimate::NORMAL_975 * error
    ))
}

/// The joint result with its fit and the factor on its covariance; without one, what the free
/// decays tell.
pub fn joint(
    evidence: &Evidence,
    attempt: Attempt,
    methods: &BTreeMap<String, MethodResult>,
) -> (MethodResult, Option<Fit>, f64) {
    let Some(attempt) = attempt else {
        let only = methods.get("free_decay").cloned().unwrap_or_default();
        return (only, None, 1.0);
    };
    let tells: Vec<Coordinate> = match &attempt {
        Ok(found) => found.fit.free.clone(),
        Err(_) => Coordinate::PHYSICAL.to_vec(),
    };
    let observations = evidence.observations.iter();
    let records = observations.filter(|o| !o.excluded()).count();
    let observations = attempt.as_ref().map_or(0, |f| f.fit.residuals);
    let result = methods::result(&attempt, &tells, observations, records);
    match attempt {
        Ok(found) => (result, Some(found.fit), found.factor),
        Err(_) => (result, None, 1.0),
    }
}

/// Add a systematic part to the standard error of R.
fn widen(restitution: &mut Estimate, systematic: f64) {
    if let (Some(value), Some(error)) = (restitution.value, restitution.standard_error) {
        let error = error.hypot(systematic);
        let half = estimate::NORMAL_975 * error;
        restitution.standard_error = Some(error);
        restitution.interval95 = Some([(value - half).max(0.0), (value + half).min(1.0)]);
    }
}
