//! What the speeds at impacts give, and whether they are those of instantaneous impacts with one R.

use std::collections::BTreeSet;

use crate::estimate::{Estimate, not_identifiable};
use crate::evidence::Evidence;
use crate::messages::{Item, Note, Remark, SpeedPoint};
use crate::methods::answer::MethodResult;
use crate::methods::blocks::Blocks;
use crate::methods::fit::{self, FitResult};
use crate::methods::impacts::bias::impact_bias;
use crate::methods::impacts::block::{ImpactBlock, SpeedPair, fast_from, tells_speeds};
use crate::methods::impacts::contact_law::{self, ContactLaw, CurvePoint};
use crate::methods::impacts::momentum;
use crate::methods::impacts::structure::{self, Grouping};
use crate::parameters::Coordinate;
use crate::solver::Fit;
use crate::statistics::quantile::NORMAL_975;
use impact_records::event::Impact;
use impact_records::motion::Observation;
use impact_records::signal::robust;

/// Change of R over the measured speeds from which a constant R does not fit.
const RESTITUTION_CHANGE: f64 = 0.02;

/// Share of the impacts with speeds whose speeds can be used from which they stand for all.
const USABLE: f64 = 0.25;

/// Impacts below which a share says nothing.
const FEWEST_IMPACTS: usize = 20;

/// Outlying impacts that a remark names; `left_out` names all.
const NAMED: usize = 3;

/// R from the speeds at impacts; what their extrapolation leaves open widens it. The contact law is
/// judged with the corners of the velocities' high-pass as all data together have them.
pub(super) fn result(
    blocks: &Blocks,
    fitted: &FitResult,
    evidence: &Evidence<'_>,
    together: Option<&Fit>,
) -> MethodResult {
    if blocks.impact.first_value_only.is_some() {
        return fit::result(fitted, &[Coordinate::Restitution], 0, 0);
    }
    let fit = together.or(fitted.as_ref().ok().map(|a| &a.fit));
    let block = &match fit {
        Some(fit) => blocks.impact.corrected(&fit.parameters),
        None => blocks.impact.clone(),
    };
    let mut records: Vec<usize> = block.pairs.iter().map(|p| p.observation).collect();
    records.dedup();
    let mut result = fit::result(
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
    let gained = contact_law::gained(block, law.as_ref(), evidence.nominal.gain_uncertainty);
    result.contact_law = law.filter(|_| gained.is_none()).map(ContactLaw::within_one);
    let ratios = structure::ratios(block, evidence.observations);
    if !ratios.is_empty() {
        result.impact_groups = Some(structure::groups(&ratios, evidence.observations));
    }
    judge(&mut result, block, evidence, structure::structure(&ratios));
    if let Some(point) = gained {
        judge_gained(&mut result, point);
    }
    result
}

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

/// Judge whether impacts are instantaneous with one R: first by a structure over bounces and records,
/// then by the contact law; the records of the impacts that it rests on say how long a contact lasts. Then
/// whether they stand for all impacts.
fn judge(
    result: &mut MethodResult,
    block: &ImpactBlock,
    evidence: &Evidence<'_>,
    structure: Option<Grouping>,
) {
    judge_law(result, block, evidence);
    if let Some(grouping) = structure {
        result.judge_structure(grouping);
    }
    judge_contacts(result, evidence.observations);
}

/// Judge by the contact law.
fn judge_law(result: &mut MethodResult, block: &ImpactBlock, evidence: &Evidence<'_>) {
    let Some(law) = &result.contact_law else {
        return;
    };
    let (Some([a, b]), [Some(slow), Some(fast)]) =
        (law.extremes(), [law.curve.first(), law.curve.last()])
    else {
        return;
    };
    let change = (a.restitution - b.restitution).abs();
    let changes = law.is_not_constant() && change > RESTITUTION_CHANGE;
    result.fits = Some(!changes);
    let [slower, faster] = [a, b].map(|p| SpeedPoint {
        speed_m_s: p.speed_m_s,
        restitution: p.restitution,
    });
    if law.is_not_constant() && !changes {
        let little = Remark::RestitutionChangesLittle { slower, faster };
        result.remarks.push(little);
        return;
    }
    if !changes {
        result.remarks.push(Remark::RestitutionConstant {
            slow_m_s: slow.speed_m_s,
            fast_m_s: fast.speed_m_s,
            within: change.max(NORMAL_975 * a.standard_error).max(1e-3),
        });
        return;
    }
    let samples = contact_samples(block, evidence);
    result.remarks.push(if samples > 1.5 {
        Remark::LongContact {
            slower,
            faster,
            samples,
        }
    } else {
        Remark::RestitutionChanges { slower, faster }
    });
    let ends = [slower.restitution, faster.restitution];
    if let Some(estimate) = &mut result.parameters.restitution {
        estimate.is_not_one_number(&ends);
    }
}

/// Samples over which a velocity jumps at the impacts, in the median record.
fn contact_samples(block: &ImpactBlock, evidence: &Evidence<'_>) -> f64 {
    let used: BTreeSet<usize> = block.pairs.iter().map(|p| p.observation).collect();
    let samples: Vec<f64> = used
        .into_iter()
        .map(|i| evidence.observations[i].jump_samples as f64)
        .collect();
    robust::median(&samples).unwrap_or(1.0)
}

/// Judge whether the impacts that R rests on stand for all that are not too slow for the noise.
fn judge_contacts(result: &mut MethodResult, observations: &[Observation]) {
    let usable = observations.iter().filter(|o| tells_speeds(o));
    let (used, of) = (result.observations, usable.map(fast_impacts).sum());
    if of >= FEWEST_IMPACTS && (used as f64) < USABLE * of as f64 {
        result.fits = Some(false);
        result.remarks.push(Remark::FewUsable { used, of });
    }
}

/// Impacts of a record with speeds, of a driven one without those that noise alone makes too slow: the best known quarter
/// shows what noise leaves of a speed behind a long flight.
fn fast_impacts(o: &Observation) -> usize {
    let errors = o.impacts.iter().filter_map(Impact::speed_error_m_s);
    let mut errors: Vec<f64> = errors.collect();
    errors.sort_by(f64::total_cmp);
    let noise = errors.get(errors.len() / 4).filter(|_| o.drive.is_some());
    let measured = o.impacts.iter().filter(|i| {
        let before = i
            .approach_speed_before_m_s
            .filter(|_| i.approach_speed_after_m_s.is_some());
        before.is_some_and(|speed| speed > fast_from(o, i) * noise.unwrap_or(&0.0))
    });
    measured.count()
}

/// Speeds that impacts seem to gain are not those of impacts: they tell no R.
fn judge_gained(result: &mut MethodResult, point: CurvePoint) {
    result.fits = Some(false);
    result.remarks.push(Remark::SpeedsGained {
        speed_m_s: point.speed_m_s,
        ratio: point.restitution,
    });
    result.parameters.restitution = Some(not_identifiable(Note::NotOfImpacts));
}

/// Widen a joint R that rests on impacts between free flights by what their errors have in common.
pub(super) fn widen_common(joint: &mut MethodResult, block: &ImpactBlock) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::event::DriveTone;
    use impact_records::motion::Motion;

    /// A record of 20 impacts at 0.3 m/s with an error and five at 1 m/s that are known to 0.1 m/s.
    fn record(error_m_s: f64) -> Observation {
        let impact = |(i, speed, error): (u32, f64, f64)| Impact {
            approach_speed_after_m_s: Some(-0.8 * speed),
            speed_errors_m_s: Some([error; 2]),
            ..Impact::at(f64::from(i), speed)
        };
        let slow = (0..20).map(|i| (i, 0.3, error_m_s));
        let impacts = slow.chain((20..25).map(|i| (i, 1.0, 0.1)));
        Observation {
            drive: Some(DriveTone::at(10.0, 1.0)),
            impacts: impacts.map(impact).collect(),
            ..Observation::of("r", 10.0, Motion::Impactless)
        }
    }

    #[test]
    fn impacts_that_noise_makes_too_slow_are_not_those_of_masses_that_stay_together() {
        let noisy = record(0.1);
        assert_eq!(fast_impacts(&noisy), 5);
        // between free flights the errors are not those of noise alone
        let free = Observation {
            drive: None,
            ..noisy
        };
        assert_eq!(fast_impacts(&free), 25);
        // behind short flights the speeds are less sure than noise makes them elsewhere in the record
        let mut short = record(0.3);
        for impact in &mut short.impacts[18..] {
            impact.speed_errors_m_s = Some([0.01; 2]);
        }
        assert_eq!(fast_impacts(&short), 25);
    }
}
