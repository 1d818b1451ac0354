//! One cause, one finding: what bends the fits is named; what follows from it is not, and no parameter that
//! it reaches is identified.
//!
//! Each finding has a cause of some kind ([`Finding::cause`]). Kinds that the model has no place for bend
//! the fits of the methods that they reach: misfits of these, effects, gains and gaps that such fits find are
//! its traces. Where several such kinds are found, the first one explains the others.

use std::collections::BTreeMap;

use impact_fit::estimate::Estimate;
use impact_fit::messages::cause::Cause;
use impact_fit::messages::{Finding, Note, Remark};
use impact_fit::method::Method;
use impact_fit::methods::answer::MethodResult;
use impact_fit::parameters::Coordinate;

/// Whether a finding is a trace of a cause, so that it is not named beside it.
pub fn explains(cause: Cause, finding: &Finding) -> bool {
    let later = finding.cause().is_some_and(|other| other > cause);
    if cause == Cause::Unsettled {
        // what is still dying away looks like friction, drag and a force against frequency, and its waveforms like late
        // channels, which bend the speeds at impacts
        return matches!(finding.cause(), Some(Cause::Effect | Cause::Contact));
    }
    let reached = match finding {
        Finding::Misfit { method, .. } => cause.reaches(*method),
        Finding::Disagreement { pair } => pair.methods.iter().any(|m| cause.reaches(*m)),
        // all others are read from the fit of all methods together
        _ => true,
    };
    cause.bends() && later && reached
}

/// The cause that explains the others, by the findings on the laboratory and the remarks of methods that do
/// not fit; the first of several.
pub fn leading(suspicions: &[Finding], methods: &BTreeMap<Method, MethodResult>) -> Option<Cause> {
    let misfits = methods.values().filter(|m| m.fits == Some(false));
    let remarks = misfits.flat_map(|m| &m.remarks);
    let named = suspicions.iter().filter_map(Finding::cause);
    let all = named.chain(remarks.filter_map(|remark| remark.cause()));
    all.filter(|cause| *cause <= Cause::Contact).min()
}

/// Withdraw from a joint result what a cause reaches: a parameter is that of the method, out of those
/// that the cause does not reach, that determines it best; without one it is weak. Gives the parameters that
/// another method's value replaces.
pub fn withdraw(
    cause: Cause,
    joint: &mut MethodResult,
    methods: &BTreeMap<Method, MethodResult>,
) -> Vec<Coordinate> {
    let mut replaced = Vec::new();
    for parameter in Coordinate::PHYSICAL {
        let Some(Some(estimate)) = joint.parameters.slot(parameter) else {
            continue;
        };
        let telling = |reached: bool| {
            let of = methods.iter();
            of.filter(move |(method, _)| cause.reaches(**method) == reached)
                .filter_map(move |(method, found)| {
                    let own = found.parameters.get(parameter)?;
                    let is_one = cause != Cause::Unsettled || !is_no_one_number(own);
                    Some((*method, own, half_width(own).filter(|_| is_one)?))
                })
        };
        let bent = cause == Cause::Unsettled && is_no_one_number(estimate);
        if telling(true).next().is_none() && !bent {
            continue;
        }
        let best = telling(false).min_by(|a, b| a.2.total_cmp(&b.2));
        if let Some((method, own, _)) = best {
            *estimate = Estimate {
                note: own.note.clone().or(Some(Note::ByMethodAlone { method })),
                ..own.clone()
            };
            replaced.push(parameter);
        } else if estimate.value.is_some() || estimate.note == Some(Note::NotOneNumber) {
            let note = estimate.note.take();
            let kept = note.filter(|n| *n == Note::NotOneNumber && cause == Cause::Contact);
            estimate.weaken(kept.unwrap_or(Note::Bent));
        }
    }
    replaced
}

/// What the resonance curve tells is not identified where it is not that of one degree of freedom: neither by the curve
/// nor by waveforms, whose model is the same.
pub fn doubt_without_one_degree_of_freedom(
    joint: &mut MethodResult,
    methods: &BTreeMap<Method, MethodResult>,
) {
    let says = |remark: &Remark| matches!(remark, Remark::NotOneDegreeOfFreedom { .. });
    if !methods.values().any(|m| m.remarks.iter().any(says)) {
        return;
    }
    for parameter in [
        Coordinate::Frequency,
        Coordinate::Damping,
        Coordinate::Deflection,
    ] {
        if let Some(Some(estimate)) = joint.parameters.slot(parameter) {
            estimate.doubt(Note::Bent);
        }
    }
}

/// Whether no single value of a parameter holds.
fn is_no_one_number(estimate: &Estimate) -> bool {
    estimate.note == Some(Note::NotOneNumber)
}

/// Half an estimate's interval, SI; `None` where it has none.
fn half_width(estimate: &Estimate) -> Option<f64> {
    estimate.interval95.map(|[low, high]| 0.5 * (high - low))
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_fit::estimate::Status;
    use impact_fit::estimate::estimate;
    use impact_fit::messages::PairAgreement;
    use impact_fit::parameters::effect::Effect;
    use impact_records::record::Role;

    fn changes() -> Remark {
        Remark::RestitutionChanges {
            slower: Default::default(),
            faster: Default::default(),
        }
    }

    /// Impacts whose R changes with the speed, and a resonance curve with β = 0.07.
    fn methods() -> BTreeMap<Method, MethodResult> {
        let mut impacts = MethodResult {
            fits: Some(false),
            remarks: vec![changes()],
            ..MethodResult::default()
        };
        impacts.parameters.restitution = Some(estimate(Coordinate::Restitution, 0.8, 0.001));
        let mut resonance = MethodResult::default();
        let damping = |value: f64, error| Some(estimate(Coordinate::Damping, value.ln(), error));
        resonance.parameters.damping_ratio = damping(0.07, 0.01);
        let mut trajectories = MethodResult::default();
        trajectories.parameters.damping_ratio = damping(0.062, 0.002);
        BTreeMap::from([
            (Method::Impacts, impacts),
            (Method::Resonance, resonance),
            (Method::Trajectories, trajectories),
        ])
    }

    #[test]
    fn a_law_of_the_contact_explains_what_waveforms_show_and_not_what_the_resonance_curve_does() {
        let cause = leading(&[], &methods());
        assert_eq!(cause, Some(Cause::Contact));
        let gain = Finding::WrongGain {
            channel: Role::VelocityX,
            deviation: 0.03,
            z_score: 9.0,
        };
        let drag = Finding::BeyondModel {
            effect: Effect::Drag,
            strength: 0.04,
            standard_error: 0.001,
            z_score: 40.0,
            speed_m_s: 0.3,
        };
        let misfit = |method, remark| Finding::Misfit { method, remark };
        let waveforms = misfit(
            Method::Trajectories,
            Remark::WaveformsUnexplained { share: 0.1 },
        );
        let between = |methods| Finding::Disagreement {
            pair: PairAgreement {
                methods,
                ..PairAgreement::default()
            },
        };
        let apart = between([Method::Resonance, Method::Trajectories]);
        for trace in [gain, drag, waveforms, apart] {
            assert!(explains(Cause::Contact, &trace), "{trace}");
        }
        let curve = misfit(
            Method::Resonance,
            Remark::NotOneDegreeOfFreedom { deviation: 0.3 },
        );
        let own = misfit(Method::Impacts, changes());
        let decays = between([Method::Resonance, Method::FreeDecay]);
        let clock = Finding::FrequenciesOffAlike {
            ratio: 1.001,
            records: 9,
            of: 9,
        };
        for other in [curve, own, decays, clock] {
            assert!(!explains(Cause::Contact, &other), "{other}");
        }
    }

    #[test]
    fn a_channel_explains_the_law_that_it_makes_of_the_contact() {
        let high_pass = Finding::UndeclaredHighPass {
            channel: Role::VelocityX,
            corner_hz: 1.0,
            z_score: 20.0,
        };
        assert_eq!(leading(&[high_pass], &methods()), Some(Cause::Channel));
        let law = Finding::Misfit {
            method: Method::Impacts,
            remark: changes(),
        };
        assert!(explains(Cause::Channel, &law));
    }

    #[test]
    fn records_that_have_not_settled_explain_effects_and_the_law_of_the_contact_alone() {
        let early = |records| Finding::RecordsNotSettled {
            records,
            of: 72,
            wait_s: 1.0,
        };
        let none = BTreeMap::new();
        assert_eq!(leading(&[early(57)], &none), Some(Cause::Unsettled));
        assert_eq!(leading(&[early(6)], &none), None);
        assert_eq!(leading(&[early(57)], &methods()), Some(Cause::Unsettled));
        let drag = Finding::BeyondModel {
            effect: Effect::Drag,
            strength: 0.04,
            standard_error: 0.001,
            z_score: 40.0,
            speed_m_s: 0.3,
        };
        let apart = Finding::Disagreement {
            pair: PairAgreement::default(),
        };
        assert!(explains(Cause::Unsettled, &drag) && !explains(Cause::Unsettled, &apart));
        assert!(!Cause::Unsettled.bends());
    }

    #[test]
    fn records_that_have_not_settled_leave_what_follows_each_impact() {
        let at = |value: f64, error: f64| Some(estimate(Coordinate::Damping, value.ln(), error));
        let mut joint = MethodResult::default();
        joint.parameters.damping_ratio = at(0.055, 2e-3);
        let mut methods = methods();
        let replaced = withdraw(Cause::Unsettled, &mut joint.clone(), &methods);
        assert_eq!(replaced, []);
        let mut flights = MethodResult::default();
        flights.parameters.damping_ratio = at(0.05, 1e-2);
        methods.insert(Method::Flights, flights);
        let replaced = withdraw(Cause::Unsettled, &mut joint, &methods);
        assert_eq!(replaced, [Coordinate::Damping]);
        let beta = joint.parameters.damping_ratio.expect("β");
        assert!((beta.value.expect("a value") - 0.05).abs() < 1e-12);
    }

    #[test]
    fn what_the_fit_carries_explains_nothing() {
        let gap = Finding::WrongClearance {
            stated_m: 1e-3,
            fitting_m: 1.1e-3,
            z_score: 9.0,
        };
        assert_eq!(leading(&[gap], &BTreeMap::new()), None);
        let apart = Finding::Disagreement {
            pair: PairAgreement::default(),
        };
        assert!(!explains(Cause::Statement, &apart));
    }

    #[test]
    fn a_curve_that_is_not_of_one_degree_of_freedom_identifies_nothing() {
        let mut joint = MethodResult::default();
        joint.parameters.restitution = Some(estimate(Coordinate::Restitution, 0.8, 1e-3));
        joint.parameters.damping_ratio = Some(estimate(Coordinate::Damping, 0.062f64.ln(), 2e-3));
        let mut methods = methods();
        let as_found = joint.clone();
        doubt_without_one_degree_of_freedom(&mut joint, &methods);
        assert_eq!(joint.parameters, as_found.parameters);
        let curve = methods.get_mut(&Method::Resonance).expect("a curve");
        curve
            .remarks
            .push(Remark::NotOneDegreeOfFreedom { deviation: 0.3 });
        doubt_without_one_degree_of_freedom(&mut joint, &methods);
        let beta = joint.parameters.damping_ratio.expect("β");
        assert_eq!((beta.status, beta.note), (Status::Weak, Some(Note::Bent)));
        assert_eq!(
            joint.parameters.restitution,
            as_found.parameters.restitution
        );
    }

    #[test]
    fn a_reached_parameter_is_that_of_a_method_out_of_reach_or_weak() {
        let mut joint = MethodResult::default();
        joint.parameters.restitution = Some(estimate(Coordinate::Restitution, 0.8, 1e-3));
        joint.parameters.damping_ratio = Some(estimate(Coordinate::Damping, 0.062f64.ln(), 2e-3));
        let replaced = withdraw(Cause::Contact, &mut joint, &methods());
        assert_eq!(replaced, [Coordinate::Damping]);
        let [r, beta] = [joint.parameters.restitution, joint.parameters.damping_ratio];
        let (r, beta) = (r.expect("R"), beta.expect("β"));
        assert_eq!((r.status, r.note), (Status::Weak, Some(Note::Bent)));
        assert!((beta.value.expect("a value") - 0.07).abs() < 1e-12);
        assert_eq!(beta.status, Status::Identified);
        let method = Method::Resonance;
        assert_eq!(beta.note, Some(Note::ByMethodAlone { method }));
    }
}
