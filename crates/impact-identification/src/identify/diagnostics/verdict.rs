//! Whether the model fits each method's data, and the verdict.

use std::collections::{BTreeMap, BTreeSet};

use crate::identify::answer::{Agreement, MethodResult, Verdict, VerdictKind};
use crate::identify::estimate::{Estimate, Status, not_identifiable};
use crate::identify::evidence::Evidence;
use crate::identify::evidence::contact_law::CurvePoint;
use crate::identify::evidence::impacts::ImpactBlock;
use crate::identify::evidence::resonance::{self, ResonanceBlock};
use crate::identify::evidence::structure::Grouping;
use crate::identify::evidence::trajectory::TrajectoryBlock;
use crate::identify::messages::cause::Cause;
use crate::identify::messages::{Finding, Note, Remark, Sentence, SpeedPoint, StatedValue};
use crate::identify::method::Method;
use crate::identify::parameters::{Coordinate, Parameters};
use crate::identify::solver::Block;
use crate::identify::statistics::quantile::NORMAL_975;
use impact_records::motion::Observation;
use impact_records::signal::robust;

/// Relative deviation of responses from which one degree of freedom does not fit.
const RESONANCE_DEVIATION: f64 = 0.15;
/// Relative deviation of waveforms from which the orbit does not fit.
const WAVEFORM_DEVIATION: f64 = 0.08;
/// Change of R over the measured speeds from which a constant R does not fit.
const RESTITUTION_CHANGE: f64 = 0.02;

/// Judge whether the impactless records are those of one degree of freedom for each mass.
pub fn judge_resonance(result: &mut MethodResult, block: &ResonanceBlock, fitted: &Parameters) {
    let mut deviations = Vec::new();
    for point in &block.points {
        for r in &point.responses {
            let model = resonance::predicted(
                fitted,
                block.rig,
                r.role,
                point.frequency_hz,
                point.drive_amplitude,
            );
            let apart = match point.phase_error_rad {
                Some(_) => (r.real - model.re).hypot(r.imaginary - model.im),
                None => (r.amplitude() - model.norm()).abs(),
            };
            deviations.push(apart / model.norm().max(r.amplitude()));
        }
    }
    let deviation = robust::rms(&deviations);
    result.fits = Some(deviation < RESONANCE_DEVIATION);
    result.remarks.push(if deviation < RESONANCE_DEVIATION {
        Remark::OneDegreeOfFreedom { deviation }
    } else {
        Remark::NotOneDegreeOfFreedom { deviation }
    });
}

/// Judge whether the waveforms are those of the closed-form orbits.
pub fn judge_trajectories(result: &mut MethodResult, block: &TrajectoryBlock, fitted: &Parameters) {
    let mut ratios = Vec::new();
    for item in 0..block.items() {
        let Some(residuals) = block.residuals(item, fitted) else {
            continue;
        };
        let channels = &block.records[item].folded.channels;
        let (mut apart, mut whole, mut k) = (0.0, 0.0, 0);
        for channel in channels {
            let mean = robust::mean(&channel.points.iter().map(|p| p.value).collect::<Vec<_>>());
            for p in &channel.points {
                let weight = f64::from(p.samples) / channel.noise.powi(2);
                apart += residuals[k].powi(2);
                whole += weight * (p.value - mean).powi(2);
                k += 1;
            }
        }
        ratios.push((apart / whole.max(f64::MIN_POSITIVE)).sqrt());
    }
    let Some(deviation) = robust::median(&ratios) else {
        return;
    };
    result.fits = Some(deviation < WAVEFORM_DEVIATION);
    let share = deviation;
    result.remarks.push(Remark::WaveformsUnexplained { share });
}

/// Judge whether impacts are instantaneous with one R: first by a structure over bounces and records,
/// then by the contact law; the records of the impacts that it rests on say how long a contact lasts. Then
/// whether they stand for all impacts.
pub fn judge_impacts(
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

/// Share of the impacts with speeds whose speeds can be used from which they stand for all.
const USABLE: f64 = 0.25;
/// Impacts below which a share says nothing.
const FEWEST_IMPACTS: usize = 20;

/// Judge whether the impacts that R rests on stand for all.
fn judge_contacts(result: &mut MethodResult, observations: &[Observation]) {
    let usable = observations.iter().filter(|o| !o.excluded());
    let impacts = usable.flat_map(|o| &o.impacts);
    let with_speeds = impacts.filter(|i| {
        i.approach_speed_before_m_s
            .and(i.approach_speed_after_m_s)
            .is_some()
    });
    let (used, of) = (result.observations, with_speeds.count());
    if of >= FEWEST_IMPACTS && (used as f64) < USABLE * of as f64 {
        result.fits = Some(false);
        result.remarks.push(Remark::FewUsable { used, of });
    }
}

/// Speeds that impacts seem to gain are not those of impacts: they tell no R.
pub fn judge_gained(result: &mut MethodResult, point: CurvePoint) {
    result.fits = Some(false);
    result.remarks.push(Remark::SpeedsGained {
        speed_m_s: point.speed_m_s,
        ratio: point.restitution,
    });
    result.parameters.restitution = Some(not_identifiable(Note::NotOfImpacts));
}

/// R from the impacts alone that is not one number makes the joint R no better.
pub fn carry_over(joint: &mut MethodResult, methods: &BTreeMap<Method, MethodResult>) {
    let of_impacts = [Method::Impacts, Method::FlightTimes]
        .into_iter()
        .filter_map(|m| methods.get(&m)?.parameters.restitution.as_ref())
        .find(|r| r.note == Some(Note::NotOneNumber));
    let (Some(impacts), Some(estimate)) = (of_impacts, &mut joint.parameters.restitution) else {
        return;
    };
    estimate.is_not_one_number(&impacts.interval95.unwrap_or_default());
}

/// What a small change of R with the speed leaves open in one R: the standard deviation of values spread evenly
/// over its range. Where a motion's impacts have one speed, waveforms tell R there.
pub fn open_by_speed(methods: &BTreeMap<Method, MethodResult>) -> Option<f64> {
    let remarks = &methods.get(&Method::Impacts)?.remarks;
    remarks.iter().find_map(|remark| match remark {
        Remark::RestitutionChangesLittle { slower, faster } => {
            Some((slower.restitution - faster.restitution).abs() / 12f64.sqrt())
        }
        _ => None,
    })
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

/// What a verdict is made from.
pub struct Basis<'a> {
    /// Significant effects beyond the model.
    pub beyond: &'a [Finding],
    /// The joint result.
    pub joint: &'a MethodResult,
    /// Each method.
    pub methods: &'a BTreeMap<Method, MethodResult>,
    /// Their agreement.
    pub agreement: &'a Agreement,
    /// Mistakes of the laboratory that the data give away.
    pub suspicions: &'a [Finding],
    /// The cause that explains other findings.
    pub cause: Option<Cause>,
}

/// The verdict: the model does not fit if it does not fit the data of any one method.
pub fn verdict(basis: &Basis<'_>) -> Verdict {
    let estimates: Vec<(Coordinate, &Estimate)> = Coordinate::PHYSICAL
        .into_iter()
        .filter_map(|c| Some((c, basis.joint.parameters.get(c)?)))
        .collect();
    let unknown = with_status(&estimates, Status::NotIdentifiable);
    let weak = with_status(&estimates, Status::Weak);
    let misfit =
        basis.methods.values().any(|m| m.fits == Some(false)) || basis.cause == Some(Cause::Change);
    let kind = if misfit {
        VerdictKind::DoesNotFit
    } else if estimates.is_empty() || !unknown.is_empty() {
        VerdictKind::NotIdentifiable
    } else if !weak.is_empty() {
        VerdictKind::Weak
    } else {
        VerdictKind::Identified
    };
    let values: Vec<StatedValue> = estimates.iter().filter_map(stated_value).collect();
    // x_st, which scales the lengths, is no answer by itself
    let answers = |v: &StatedValue| v.parameter != Coordinate::Deflection;
    let says_something = basis.agreement.agree.is_some() || values.iter().any(answers);
    // that methods which one cause bends agree says nothing
    let bent = basis.cause.is_some_and(Cause::bends);
    let second = (says_something && !bent).then(|| Sentence::on_agreement(basis.agreement.agree));
    let first = match kind {
        VerdictKind::DoesNotFit => Sentence::DoesNotFit,
        VerdictKind::NotIdentifiable if estimates.is_empty() => Sentence::NothingUsable,
        VerdictKind::NotIdentifiable if values.is_empty() => Sentence::NotIdentifiable {
            parameters: unknown,
        },
        VerdictKind::NotIdentifiable => Sentence::PartlyIdentifiable {
            values,
            parameters: unknown,
        },
        VerdictKind::Weak => Sentence::Weak {
            values,
            parameters: weak,
        },
        VerdictKind::Identified => Sentence::Identified { values },
    };
    Verdict {
        kind,
        sentences: std::iter::once(first).chain(second).collect(),
        findings: findings(basis, &estimates),
    }
}

/// Suspicions, remarks of methods that do not fit, notes of the parameters, disagreement.
fn findings(basis: &Basis<'_>, estimates: &[(Coordinate, &Estimate)]) -> Vec<Finding> {
    let mut findings = basis.suspicions.to_vec();
    findings.extend(basis.beyond.iter().cloned());
    for (method, result) in basis.methods {
        let noticed = result.remarks.iter().filter(|r| is_to_be_mended(r));
        findings.extend(noticed.map(|remark| Finding::Noticed {
            method: *method,
            remark: remark.clone(),
        }));
        if result.fits == Some(false) {
            let misfit = |remark: &Remark| Finding::Misfit {
                method: *method,
                remark: remark.clone(),
            };
            let telling = result.remarks.iter();
            let telling = telling.filter(|r| !is_plain(r) && !is_to_be_mended(r));
            findings.extend(telling.map(misfit));
        }
    }
    let noted = estimates.iter().filter_map(|(parameter, estimate)| {
        Some(Finding::Parameter {
            parameter: *parameter,
            note: estimate.note.clone()?,
        })
    });
    findings.extend(noted);
    let disagreement = basis.agreement.disagreement().cloned();
    findings.extend(disagreement.map(|pair| Finding::Disagreement { pair }));
    if let Some(cause) = basis.cause {
        findings.retain(|finding| !cause.explains(finding));
    }
    findings
}

/// Whether a remark is on what the laboratory can mend although the model fits.
fn is_to_be_mended(remark: &Remark) -> bool {
    matches!(
        remark,
        Remark::EarlyJumps { .. }
            | Remark::OddRecord { .. }
            | Remark::ImpactsMissed { .. }
            | Remark::DecaysHum { .. }
            | Remark::DecaysMode { .. }
            | Remark::DecaysBackground { .. }
            | Remark::DecaysSlowNoise { .. }
    )
}

/// Whether a remark only describes the data, so that it is no reason for a misfit.
fn is_plain(remark: &Remark) -> bool {
    matches!(
        remark,
        Remark::TimesScatter { .. } | Remark::MassRatio { .. } | Remark::FlightsLeftOut { .. }
    )
}

fn with_status(estimates: &[(Coordinate, &Estimate)], status: Status) -> Vec<Coordinate> {
    let with = estimates.iter().filter(|(_, e)| e.status == status);
    with.map(|(c, _)| *c).collect()
}

/// A parameter with its value; `None` without a value or an interval.
fn stated_value((parameter, estimate): &(Coordinate, &Estimate)) -> Option<StatedValue> {
    let [low, high] = estimate.interval95?;
    Some(StatedValue {
        parameter: *parameter,
        value: estimate.value?,
        half_width: 0.5 * (high - low),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::estimate::{estimate, estimate_within};
    use crate::identify::messages::PairAgreement;
    use crate::identify::statistics::scatter::Spread;

    /// A joint result with standard errors of R and ln f0.
    fn joint(restitution: f64, frequency: f64) -> MethodResult {
        let of = |c: Coordinate, value: f64, error| {
            let note = Some(Note::NotSeparable);
            Some(estimate_within(c, value, Spread::known(error), note))
        };
        let mut result = MethodResult::default();
        result.parameters.restitution = of(Coordinate::Restitution, 0.8, restitution);
        result.parameters.natural_frequency_hz = of(Coordinate::Frequency, 12f64.ln(), frequency);
        result
    }

    #[test]
    fn that_one_method_determines_each_parameter_is_said_of_parameters_alone() {
        let alone = |joint: &MethodResult| {
            verdict(&Basis {
                beyond: &[],
                joint,
                methods: &BTreeMap::new(),
                agreement: &Agreement::default(),
                suspicions: &[],
                cause: None,
            })
        };
        assert_eq!(
            alone(&MethodResult::default()).sentences,
            [Sentence::NothingUsable]
        );
        // no parameter is identifiable with these errors, and one is with the others
        let mut unknown = joint(0.2, 0.09);
        assert_eq!(alone(&unknown).sentences.len(), 1);
        let deflection = estimate(Coordinate::Deflection, -7.0, 0.01);
        unknown.parameters.static_deflection_m = Some(deflection);
        assert_eq!(alone(&unknown).sentences.len(), 1);
        assert_eq!(alone(&joint(0.2, 0.001)).sentences[1], Sentence::OneMethod);
    }

    fn judged(joint: &MethodResult, methods: &[(Method, MethodResult)], agree: bool) -> Verdict {
        let pair = PairAgreement {
            parameter: Coordinate::Restitution,
            methods: [Method::Impacts, Method::Trajectories],
            values: [0.8, 0.9],
            z_score: if agree { 0.1 } else { 9.0 },
            p_value: if agree { 0.9 } else { 1e-19 },
        };
        verdict(&Basis {
            beyond: &[],
            joint,
            methods: &methods.iter().cloned().collect(),
            agreement: &Agreement {
                agree: Some(agree),
                pairs: vec![pair],
            },
            suspicions: &[],
            cause: None,
        })
    }

    #[test]
    fn the_verdict_is_that_of_the_worst_parameter() {
        // as half widths R is weak from 0.05 on and not identifiable from 0.3, f0 from 2 and 16 %
        let kind = |r, f| judged(&joint(r, f), &[], true).kind;
        assert_eq!(kind(0.001, 0.001), VerdictKind::Identified);
        assert_eq!(kind(0.04, 0.001), VerdictKind::Weak);
        assert_eq!(kind(0.04, 0.09), VerdictKind::NotIdentifiable);
        let nothing = judged(&MethodResult::default(), &[], true);
        assert_eq!(nothing.kind, VerdictKind::NotIdentifiable);
        assert_eq!(nothing.sentences[0], Sentence::NothingUsable);
    }

    #[test]
    fn the_sentences_state_values_and_what_is_missing() {
        let found = judged(&joint(0.2, 0.001), &[], true);
        let unknown = vec![Coordinate::Restitution];
        let Sentence::PartlyIdentifiable { values, parameters } = &found.sentences[0] else {
            panic!("{found:?}");
        };
        assert_eq!((values.len(), parameters), (1, &unknown));
        assert_eq!(found.sentences[1], Sentence::MethodsAgree);
        // half of [12·e^−a, 12·e^a] with a = 1.959964·0.001
        let a = NORMAL_975 * 1e-3;
        let half = 0.5 * 12.0 * (a.exp() - (-a).exp());
        assert!((values[0].half_width - half).abs() < 1e-12);
        assert_eq!(
            found.to_string(),
            "The rig has f0 = 12.000 ± 0.024 Hz (95 %), but these data do not determine R. The methods \
             agree."
        );
        let note = found.findings.iter().find_map(|f| match f {
            Finding::Parameter { parameter, note } => Some((*parameter, note)),
            _ => None,
        });
        let (parameter, note) = note.expect("a note");
        assert_eq!(parameter, Coordinate::Restitution);
        assert!(matches!(note, Note::Open { standard_error, .. } if *standard_error == 0.2));
    }

    #[test]
    fn one_method_that_does_not_fit_decides_and_its_remarks_are_findings() {
        let remark = Remark::NotOneDegreeOfFreedom { deviation: 0.4 };
        let misfit = MethodResult {
            fits: Some(false),
            remarks: vec![remark.clone()],
            ..MethodResult::default()
        };
        let fitting = MethodResult {
            fits: Some(true),
            remarks: vec![Remark::StatesDeviate { ratio: 1.0 }],
            ..MethodResult::default()
        };
        let methods = [(Method::Resonance, misfit), (Method::Flights, fitting)];
        let found = judged(&joint(0.001, 0.001), &methods, false);
        assert_eq!(found.kind, VerdictKind::DoesNotFit);
        assert_eq!(
            found.findings[0],
            Finding::Misfit {
                method: Method::Resonance,
                remark
            }
        );
        assert!(matches!(found.findings[1], Finding::Disagreement { .. }));
        assert_eq!(found.findings.len(), 2);
    }
}
