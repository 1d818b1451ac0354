//! One example of each kind of message, so that all kinds can be listed.

use super::*;
use crate::identify::fit::effect::Effect;
use crate::identify::method::Method;
use crate::motion::BoundaryKind;
use crate::record::{FlagCode, Role};

/// One example of each kind of message of an identification.
pub fn examples() -> Vec<Box<dyn Message>> {
    let methods = [
        Method::Boundaries,
        Method::Flights,
        Method::FlightTimes,
        Method::FreeDecay,
        Method::Impacts,
        Method::PublishedSpeeds,
        Method::Resonance,
        Method::Trajectories,
    ];
    let mut all: Vec<Box<dyn Message>> = Vec::new();
    all.extend(methods.map(|m| Box::new(m) as Box<dyn Message>));
    all.extend(notes().into_iter().map(|m| Box::new(m) as Box<dyn Message>));
    let remarks = remarks().into_iter();
    all.extend(remarks.map(|m| Box::new(m) as Box<dyn Message>));
    let reasons = reasons().into_iter();
    all.extend(reasons.map(|m| Box::new(m) as Box<dyn Message>));
    let findings = example_findings().into_iter();
    all.extend(findings.map(|m| Box::new(m) as Box<dyn Message>));
    for strength in [0.01, -0.01] {
        let effects = Effect::ALL.map(|effect| beyond(effect, strength));
        all.extend(effects.map(|m| Box::new(m) as Box<dyn Message>));
    }
    let undetermined = crate::motion::undetermined_examples().into_iter();
    all.extend(undetermined.map(|m| Box::new(m) as Box<dyn Message>));
    all.extend(FlagCode::ALL.map(|m| Box::new(m) as Box<dyn Message>));
    let sentences = sentences().into_iter();
    all.extend(sentences.map(|m| Box::new(m) as Box<dyn Message>));
    all.push(Box::new(pair()));
    all.extend(items().map(|m| Box::new(m) as Box<dyn Message>));
    all
}

fn pair() -> PairAgreement {
    PairAgreement {
        parameter: Coordinate::Restitution,
        methods: [Method::Boundaries, Method::Impacts],
        values: [0.9, 0.8],
        z_score: 5.0,
        p_value: 6e-7,
    }
}

fn beyond(effect: Effect, strength: f64) -> Finding {
    Finding::BeyondModel {
        effect,
        strength,
        standard_error: 0.002,
        z_score: strength / 0.002,
    }
}

fn items() -> [Item; 3] {
    [
        Item::Record {
            index: 0,
            record: "r1".into(),
        },
        Item::Bracket {
            index: 0,
            boundary: BoundaryKind::SaddleNode,
            frequency_low_hz: 12.0,
            frequency_high_hz: 12.5,
            clearance_m: 1e-3,
        },
        Item::Impact {
            index: 0,
            record: "r1".into(),
            time_s: 0.25,
        },
    ]
}

fn notes() -> Vec<Note> {
    let parameter = Coordinate::Restitution;
    vec![
        Note::Open {
            parameter,
            standard_error: 0.2,
        },
        Note::NotDetermined { parameter },
        Note::LeansOn {
            parameter,
            correlation: 0.9,
        },
        Note::NotOneNumber,
        Note::Drifts,
        Note::SeveralSpecimens,
        Note::NoPublishedMotion,
        Note::NoStart { observations: 3 },
        Note::NothingToFit,
        Note::SolverFailed,
        Note::MethodsDisagree,
        Note::NotSeparable,
    ]
}

fn group_points() -> Vec<GroupPoint> {
    let point = |group: &str, restitution| GroupPoint {
        group: group.to_owned(),
        restitution,
        half_width: 0.01,
    };
    vec![point("1", 0.41), point("2", 0.50)]
}

fn remarks() -> Vec<Remark> {
    let point = |speed_m_s, restitution| SpeedPoint {
        speed_m_s,
        restitution,
    };
    let (slower, faster) = (point(0.1, 0.9), point(0.5, 0.8));
    vec![
        Remark::OneDegreeOfFreedom { deviation: 0.01 },
        Remark::NotOneDegreeOfFreedom { deviation: 0.3 },
        Remark::WaveformsUnexplained { share: 0.01 },
        Remark::WaveformsThinned {
            fitted: 100,
            periodic: 1000,
        },
        Remark::IdealRig,
        Remark::StatesDeviate { ratio: 1.5 },
        Remark::EarlyJumps { distance: 0.08 },
        Remark::BracketMidpoints {
            restitution: 0.9,
            half_width: 0.02,
        },
        Remark::RestitutionConstant {
            slow_m_s: 0.1,
            fast_m_s: 0.5,
            within: 0.001,
        },
        Remark::RestitutionChanges { slower, faster },
        Remark::LongContact {
            slower,
            faster,
            samples: 5.0,
        },
        Remark::RestitutionByBounce {
            points: group_points(),
        },
        Remark::RecordsDiffer {
            points: group_points(),
        },
        Remark::MassRatio {
            ratio: 2.0,
            half_width: 0.02,
        },
        Remark::TimesScatter { error_s: 2e-3 },
        Remark::FlightsLeftOut { count: 2 },
        Remark::OutlyingImpacts {
            count: 4,
            first: items().into_iter().skip(2).collect(),
        },
        Remark::DecaysUnexplained {
            share: 0.01,
            structure: 0.004,
        },
        Remark::DecaysHaveStructure {
            share: 0.3,
            structure: 0.2,
        },
        Remark::DecaysDrift {
            count: 1,
            first_hz: 2.0,
            last_hz: 2.01,
            intervals: 20.0,
        },
        Remark::DecaysDiffer { spread: 0.1 },
        Remark::NoResult {
            why: Note::NotSeparable,
        },
        Remark::PublishedSpeedsMet {
            damping_ratio: 0.005,
            deviation: 0.004,
        },
    ]
}

fn reasons() -> Vec<Reason> {
    vec![
        Reason::ResponseUnlikeOthers { times_worse: 30.0 },
        Reason::WaveformUnlikeOthers { times_worse: 7.5 },
        Reason::NoSuchMotion,
        Reason::FarFromBoundary,
        Reason::GapNotAsStated,
        Reason::ImpactsDoNotFollow,
        Reason::Influential {
            method: Method::Resonance,
        },
        Reason::OutlyingImpact {
            before_m_s: 0.25,
            after_m_s: 0.1,
        },
        Reason::Misfiled {
            specimen: "a".into(),
            specimen_hz: 10.0,
            frequency_hz: 12.0,
        },
        Reason::MisfiledLike {
            specimen: "a".into(),
            specimen_hz: 10.0,
            frequency_hz: 12.0,
            like: "b".into(),
            like_hz: 12.1,
        },
    ]
}

/// One example of each kind of finding.
pub fn example_findings() -> Vec<Finding> {
    let (deviation, z_score) = (-0.05, -9.0);
    vec![
        Finding::WrongClearance {
            stated_m: 1e-3,
            fitting_m: 1.1e-3,
            z_score: 9.0,
        },
        Finding::WrongGain {
            channel: Role::VelocityX,
            deviation,
            z_score,
        },
        Finding::WrongCorner {
            channel: Role::VelocityX,
            deviation,
            z_score,
        },
        Finding::SwappedChannels { z_score: 9.0 },
        Finding::MomentumNotConserved {
            measured: 2.2,
            stated: 2.0,
            z_score: 8.0,
        },
        Finding::Noticed {
            method: Method::Boundaries,
            remark: Remark::EarlyJumps { distance: 0.08 },
        },
        Finding::Misfit {
            method: Method::Impacts,
            remark: Remark::DecaysDiffer { spread: 0.1 },
        },
        Finding::Parameter {
            parameter: Coordinate::Damping,
            note: Note::NotSeparable,
        },
        Finding::Disagreement { pair: pair() },
        Finding::Specimen {
            specimen: "a".into(),
            verdict: sentences(),
        },
        Finding::MisfiledRecord {
            record: "r1".into(),
            reason: Reason::Misfiled {
                specimen: "a".into(),
                specimen_hz: 10.0,
                frequency_hz: 12.0,
            },
        },
        Finding::PrintedDampingFits { printed: 0.005 },
        Finding::PrintedDampingDoesNotFit {
            printed: 0.02,
            deviation: 0.1,
        },
        Finding::PrintedDampingWithoutMotion {
            printed: 0.02,
            deviation: None,
            settings: vec![PublishedSetting {
                restitution: 0.9,
                frequency_ratio: 1.5,
            }],
        },
    ]
}

fn sentences() -> Vec<Sentence> {
    let values = vec![StatedValue {
        parameter: Coordinate::Deflection,
        value: 1e-3,
        half_width: 1e-5,
    }];
    let parameters = vec![Coordinate::Restitution, Coordinate::Damping];
    vec![
        Sentence::Identified {
            values: values.clone(),
        },
        Sentence::Weak {
            values: values.clone(),
            parameters: parameters.clone(),
        },
        Sentence::PartlyIdentifiable {
            values,
            parameters: parameters.clone(),
        },
        Sentence::NotIdentifiable { parameters },
        Sentence::SpecimensFit {
            fitting: 27,
            count: 28,
        },
        Sentence::SpecimensPoorlyKnown {
            parameter: Coordinate::Damping,
            count: 10,
        },
        Sentence::NothingUsable,
        Sentence::DoesNotFit,
        Sentence::MethodsAgree,
        Sentence::MethodsDoNotAgree,
        Sentence::OneMethod,
        Sentence::Specimens { count: 3 },
        Sentence::MisfiledRecords { count: 2 },
        Sentence::PublishedDamping {
            damping_ratio: 0.005,
        },
        Sentence::NoPublishedDamping,
    ]
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::message::{Language, plain};

    /// The names in braces of a template.
    fn names(template: &str) -> BTreeSet<&str> {
        let pieces = template.split('{').skip(1);
        pieces.filter_map(|p| Some(p.split_once('}')?.0)).collect()
    }

    #[test]
    fn every_kind_has_its_own_name_and_templates_of_the_same_values() {
        let mut keys = BTreeSet::new();
        for message in examples() {
            let kind = message.key();
            assert!(!kind.is_empty() && keys.insert(kind.clone()), "{kind}");
            let english = message.template(Language::English);
            let german = message.template(Language::German);
            assert_eq!(names(english), names(german), "{kind}");
            let values: BTreeSet<&str> = message.values().iter().map(|v| v.0).collect();
            assert_eq!(names(english), values, "{kind}");
            assert!(!plain(message.as_ref()).contains(['{', '}', '$']), "{kind}");
        }
    }

    #[test]
    fn json_has_kind_numbers_and_text_and_reads_back() {
        for finding in example_findings() {
            let json = serde_json::to_value(&finding).expect("JSON");
            assert_eq!(json["kind"], Message::kind(&finding));
            assert_eq!(json["text"], finding.to_string());
            let back: Finding = serde_json::from_value(json).expect("a finding");
            assert_eq!(back, finding);
        }
        let json = serde_json::to_value(&example_findings()[0]).expect("JSON");
        assert_eq!(json["stated_m"], 1e-3);
    }

    #[test]
    fn values_are_printed_at_their_places() {
        let texts: Vec<String> = example_findings().iter().map(ToString::to_string).collect();
        assert_eq!(
            texts[0],
            "the gap stated with a clearance of 1.0000 mm moves like one of 1.1000 mm: measure it \
             again and correct the run table; its records stay out of the fit"
        );
        assert!(texts[1].starts_with("velocity_x reads 5.0 % too low: "));
        assert_eq!(
            sentences()[1].to_string(),
            "The rig has x_st = 1.000 ± 0.010 mm; R, β only weakly."
        );
        let outlying = |r: &Remark| matches!(r, Remark::OutlyingImpacts { .. });
        let outlying = remarks().into_iter().find(outlying).expect("an example");
        assert_eq!(
            outlying.to_string(),
            "impacts with speeds far from those of the others, left out: 4 (r1 at 0.250 s, …)"
        );
    }
}
