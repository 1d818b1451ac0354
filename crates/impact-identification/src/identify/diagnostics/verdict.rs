//! Whether the model fits each method's data, and the verdict.

use std::collections::BTreeMap;

use crate::identify::diagnostics::cause::explains;
use impact_fit::estimate::{self, Estimate, Status};
use impact_fit::messages::cause::Cause;
use impact_fit::messages::{Finding, Note, Remark, Sentence, StatedValue};
use impact_fit::method::Method;
use impact_fit::methods::answer::{Agreement, MethodResult, Verdict, VerdictKind};
use impact_fit::parameters::Coordinate;

/// R from the impacts alone that is not one number makes the joint R no better.
pub fn carry_over(joint: &mut MethodResult, methods: &BTreeMap<Method, MethodResult>) {
    let of_impacts = Method::OF_SINGLE_IMPACTS
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
    let mut remarks = methods.values().flat_map(|method| &method.remarks);
    remarks.find_map(|remark| match remark {
        Remark::RestitutionChangesLittle { slower, faster } => {
            Some((slower.restitution - faster.restitution).abs() / 12f64.sqrt())
        }
        _ => None,
    })
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
    /// Whether one driven mass strikes something that is stated to be a stop.
    pub strikes_a_stop: bool,
}

/// The verdict: the model does not fit if it does not fit the data of any one method.
pub fn verdict(basis: &Basis<'_>) -> Verdict {
    let estimates: Vec<(Coordinate, &Estimate)> = Coordinate::PHYSICAL
        .into_iter()
        .filter_map(|c| Some((c, basis.joint.parameters.get(c)?)))
        .collect();
    let unknown = with_status(&estimates, Status::NotIdentifiable);
    let weak = with_status(&estimates, Status::Weak);
    let kind = if misfits(basis) {
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
        let fits = result.fits != Some(false);
        let noticed = result.remarks.iter();
        let noticed = noticed.filter(|r| is_to_be_mended(r) || fits && is_beside_damping(r));
        findings.extend(noticed.map(|remark| Finding::Noticed {
            method: *method,
            remark: remark.clone(),
        }));
        if !fits {
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
            note: estimate
                .note
                .clone()
                .or_else(|| wide(*parameter, estimate))?,
        })
    });
    findings.extend(noted);
    let disagreement = basis.agreement.disagreement().cloned();
    findings.extend(disagreement.map(|pair| Finding::Disagreement { pair }));
    if let Some(cause) = basis.cause {
        findings.retain(|finding| !explains(cause, finding));
    }
    let may_move = basis.strikes_a_stop && (misfits(basis) || findings.iter().any(seems_closer));
    findings.extend(may_move.then_some(Finding::StopMayMove));
    findings
}

/// Whether a finding is what a mass that moves makes of the clearances if it is taken for a stop.
fn seems_closer(finding: &Finding) -> bool {
    matches!(
        finding,
        Finding::GainOrClearances { .. }
            | Finding::GainsOrClearances { .. }
            | Finding::ClearancesOffAlike { .. }
    )
}

/// Whether the model does not describe the data.
fn misfits(basis: &Basis<'_>) -> bool {
    basis.methods.values().any(|m| m.fits == Some(false)) || basis.cause == Some(Cause::Change)
}

/// Why an estimate is weak of which nothing else says it.
fn wide(parameter: Coordinate, estimate: &Estimate) -> Option<Note> {
    let value = estimate.value.filter(|_| estimate.status == Status::Weak)?;
    let [low, high] = estimate.interval95?;
    let half = 0.5 * (high - low);
    if parameter == Coordinate::Damping && value == 0.0 {
        return Some(Note::Undamped { most: high });
    }
    let half_width = if parameter.is_logarithm() {
        half / value
    } else {
        half
    };
    let limit = estimate::limits(parameter).0;
    (half_width >= limit).then_some(Note::Wide {
        parameter,
        half_width,
        limit,
    })
}

/// Whether a remark is on what the laboratory can mend although the model fits.
fn is_to_be_mended(remark: &Remark) -> bool {
    matches!(
        remark,
        Remark::EarlyJumps { .. }
            | Remark::OddRecord { .. }
            | Remark::ImpactsMissed { .. }
            | Remark::TopsMissed { .. }
            | Remark::DecaysHum { .. }
            | Remark::DecaysMode { .. }
            | Remark::DecaysHarmonic { .. }
            | Remark::DecaysStopped { .. }
            | Remark::DecaysRubbedLater { .. }
            | Remark::DecaysBackground { .. }
            | Remark::DecaysSlowNoise { .. }
            | Remark::FlightTimesOpen { .. }
            | Remark::HeightsOpen { .. }
    )
}

/// Whether a remark is on damping that β does not hold.
fn is_beside_damping(remark: &Remark) -> bool {
    matches!(
        remark,
        Remark::DecaysRubbed { .. } | Remark::DecaysDamping { .. }
    )
}

/// Whether a remark only describes the data, so that it is no reason for a misfit.
fn is_plain(remark: &Remark) -> bool {
    matches!(
        remark,
        Remark::TimesScatter { .. }
            | Remark::RestitutionScatters { .. }
            | Remark::HeightsScatter { .. }
            | Remark::MassRatio { .. }
            | Remark::FlightsLeftOut { .. }
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
    use impact_fit::estimate::{estimate, estimate_within};
    use impact_fit::messages::PairAgreement;
    use impact_fit::statistics::quantile::NORMAL_975;
    use impact_fit::statistics::scatter::Spread;

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
                strikes_a_stop: false,
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
            strikes_a_stop: true,
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
    fn what_is_weak_for_its_interval_alone_says_so() {
        let mut weak = joint(0.04, 0.001);
        weak.parameters.restitution.as_mut().unwrap().note = None;
        let found = judged(&weak, &[], true);
        assert_eq!(
            found.findings[0].to_string(),
            "R: its 95 % interval is ± 0.08 wide, and a parameter is weak from ± 0.05 on: more or longer records \
             make it narrower"
        );
        assert_eq!(judged(&joint(0.001, 0.001), &[], true).findings, []);
    }

    #[test]
    fn a_damping_ratio_of_zero_has_an_upper_limit() {
        let weak = Estimate {
            value: Some(0.0),
            standard_error: Some(0.002),
            interval95: Some([0.0, 0.004]),
            status: Status::Weak,
            note: None,
        };
        let found = wide(Coordinate::Damping, &weak);
        assert_eq!(found, Some(Note::Undamped { most: 0.004 }));
    }

    #[test]
    fn what_decides_an_interval_is_a_finding() {
        let remark = Remark::HeightsOpen { half_width: 0.09 };
        let drops = MethodResult {
            fits: Some(true),
            remarks: vec![remark.clone()],
            ..MethodResult::default()
        };
        let found = judged(&joint(0.001, 0.001), &[(Method::FlightTimes, drops)], true);
        let method = Method::FlightTimes;
        assert_eq!(found.findings, [Finding::Noticed { method, remark }]);
    }

    #[test]
    fn friction_that_beta_is_without_is_a_finding_though_the_model_fits() {
        let rubbed = Remark::DecaysRubbed {
            share: 0.41,
            half: 0.01,
        };
        let decays = MethodResult {
            fits: Some(true),
            remarks: vec![rubbed.clone()],
            ..MethodResult::default()
        };
        let method = Method::FreeDecay;
        let found = judged(&joint(0.001, 0.001), &[(method, decays)], true);
        let remark = rubbed;
        assert_eq!(found.findings, [Finding::Noticed { method, remark }]);
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
        // the stop that the mass strikes may be a mass that moves
        assert_eq!(found.findings[2..], [Finding::StopMayMove]);
    }
}
