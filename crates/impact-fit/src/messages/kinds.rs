//! One message of each kind, its values at their defaults, so that all kinds can be listed.

use strum::IntoEnumIterator;

use super::{
    Finding, HeightsCause, Item, Note, PairAgreement, Reason, Remark, Sentence, SpeedPoint,
};
use crate::method::Method;
use crate::parameters::Coordinate;
use crate::parameters::effect::{Effect, EffectKind};
use impact_records::message::{Message, boxed};
use impact_records::motion::{BoundaryKind, Undetermined};
use impact_records::record::{FlagCode, Problem, Remedy, Role, problem};
use impact_records::signal::decay::DampingLaw;

/// One message of each kind of an identification.
pub fn kinds() -> Vec<Box<dyn Message>> {
    let beyond = [1.0, -1.0].into_iter().flat_map(|strength| {
        Effect::ALL.iter().map(move |effect| Finding::BeyondModel {
            effect: *effect,
            strength,
            standard_error: 0.0,
            z_score: 0.0,
            speed_m_s: 0.0,
        })
    });
    // and R that rises with the speed
    let faster = SpeedPoint {
        restitution: 1.0,
        ..SpeedPoint::default()
    };
    let rising = [
        Remark::RestitutionChanges {
            slower: SpeedPoint::default(),
            faster,
        },
        Remark::LongContact {
            slower: SpeedPoint::default(),
            faster,
            samples: 3.0,
        },
    ];
    let findings = Finding::iter().filter(|f| !matches!(f, Finding::BeyondModel { .. }));
    boxed(Method::iter())
        .chain(boxed(Note::iter()))
        .chain(boxed(Remark::iter()))
        .chain(boxed(rising.into_iter()))
        .chain(boxed(Reason::iter()))
        .chain(boxed(findings))
        .chain(boxed(with_own_texts()))
        .chain(boxed(beyond))
        .chain(boxed(Undetermined::iter()))
        .chain(boxed(FlagCode::ALL.into_iter()))
        .chain(boxed(Problem::iter()))
        .chain(boxed(Problem::iter().map(Remedy)))
        .chain(boxed(Sentence::iter()))
        .chain(boxed([PairAgreement::default()].into_iter()))
        .chain(boxed(Item::iter()))
        .chain(boxed(HeightsCause::iter()))
        .chain(boxed(BoundaryKind::iter()))
        .chain(boxed(DampingLaw::iter()))
        .collect()
}

/// Findings of one kind whose text goes with what they contain.
fn with_own_texts() -> impl Iterator<Item = Finding> {
    // an early channel has a text of its own, and so has the drive
    let late = [
        (Role::VelocityX, 1.0),
        (Role::VelocityX, -1.0),
        (Role::Drive, 1.0),
    ];
    let late = late.map(|(channel, later_ms)| Finding::LateChannel {
        channel,
        later_ms,
        z_score: 0.0,
    });
    // a channel of the motion at another time in each record too
    let unsteady = Finding::UnsteadyChannel {
        channel: Role::VelocityX,
        scatter_ms: 1.0,
    };
    // a gain that fell too
    let fallen = [
        Finding::GainChanged {
            channel: Role::default(),
            record: String::new(),
            number: 1,
            of: 2,
            deviation: -1.0,
        },
        Finding::GainsPart {
            channel: Role::default(),
            other: Role::default(),
            record: String::new(),
            number: 1,
            of: 2,
            deviation: -1.0,
        },
    ];
    // as has a low-pass whose order is known
    let filters = [1, 2].map(|order| Finding::UndeclaredLowPass {
        channel: Role::default(),
        corner_hz: 1.0,
        one_pole_hz: 0.5,
        order: Some(order),
    });
    let all = late.into_iter().chain(fallen).chain(filters);
    all.chain([unsteady])
}

/// One message of each name that a figure, a table or another message prints: effects and kinds of effects, channels,
/// parameters without a symbol, and quantities and units.
pub fn labels() -> Vec<Box<dyn Message>> {
    let named = Coordinate::all().filter(|c| c.symbol().is_none());
    boxed(Effect::ALL.iter().copied())
        .chain(boxed(EffectKind::ALL.iter().copied()))
        .chain(boxed(Role::ALL.iter().copied()))
        .chain(boxed(named))
        .chain(problem::parts())
        .collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::messages::direction::Direction;
    use crate::messages::{DampingPoint, GroupPoint, PublishedSetting, StatedValue};
    use crate::methods::answer::Agreement;
    use impact_records::message::{faults, plain};

    /// The messages of an identification that are part of others or of no result.
    fn parts() -> Vec<Box<dyn Message>> {
        let point = GroupPoint {
            group: "r1".into(),
            restitution: 0.8,
            half_width: 0.1,
        };
        let damping = DampingPoint {
            amplitude_ratio: 1.0,
            damping_ratio: 0.01,
            half_width: 0.001,
        };
        let setting = PublishedSetting {
            restitution: 0.5,
            frequency_ratio: 0.6,
        };
        let stated = StatedValue {
            parameter: Coordinate::Deflection,
            value: 1e-3,
            half_width: 1e-5,
        };
        let agreements = [None, Some(true)].map(|agree| Agreement {
            agree,
            pairs: Vec::new(),
        });
        boxed([point].into_iter())
            .chain(boxed([damping].into_iter()))
            .chain(boxed([setting].into_iter()))
            .chain(boxed([stated].into_iter()))
            .chain(boxed(agreements.into_iter()))
            .chain(boxed(Direction::iter()))
            .collect()
    }

    #[test]
    fn every_kind_has_its_own_name_and_its_texts() {
        let mut keys = BTreeSet::new();
        for message in kinds() {
            let kind = message.key();
            assert!(!kind.is_empty() && keys.insert(kind.clone()), "{kind}");
            assert!(!plain(message.as_ref()).contains(['{', '}', '$']), "{kind}");
        }
        let all: Vec<_> = kinds().into_iter().chain(labels()).chain(parts()).collect();
        assert_eq!(faults(&all), Vec::<String>::new());
    }

    #[test]
    fn every_parameter_has_a_name_of_its_own_that_is_no_identifier() {
        let mut names = BTreeSet::new();
        for coordinate in Coordinate::all() {
            let name = plain(&coordinate);
            let is_symbol = coordinate.symbol().is_some();
            assert!(is_symbol || !name.contains('_'), "{name}");
            assert!(names.insert(name.clone()), "{name}");
        }
    }

    #[test]
    fn json_has_kind_numbers_and_text_and_reads_back() {
        for finding in Finding::iter() {
            let json = serde_json::to_value(&finding).expect("JSON");
            assert_eq!(json["kind"], Message::kind(&finding));
            assert_eq!(json["text"], finding.to_string());
            let back: Finding = serde_json::from_value(json).expect("a finding");
            assert_eq!(back, finding);
        }
    }

    #[test]
    fn values_are_printed_at_their_places() {
        let clearance = Finding::WrongClearance {
            stated_m: 1e-3,
            fitting_m: 1.1e-3,
            z_score: 9.0,
        };
        assert_eq!(
            clearance.to_string(),
            "the gap stated with a clearance of 1.000 mm moves like one of 1.100 mm: measure it \
             again and correct the run table; its records stay out of the fit"
        );
        let json = serde_json::to_value(&clearance).expect("JSON");
        assert_eq!(json["stated_m"], 1e-3);
        let gain = Finding::WrongGain {
            channel: Role::VelocityX,
            deviation: -0.05,
            z_score: -9.0,
        };
        let text = gain.to_string();
        assert!(text.starts_with("velocity x reads 5.0 % too low: "));
        assert!(text.contains("correct scale in [channels.velocity_x]"));
        let leans = Note::LeansOn {
            parameter: Coordinate::Gain(4),
            correlation: -1.0,
        };
        let says = "depends on gain of acceleration x (correlation \u{2212}1.00)";
        assert_eq!(leans.to_string(), says);
        let deflection = StatedValue {
            parameter: Coordinate::Deflection,
            value: 1e-3,
            half_width: 1e-5,
        };
        let weak = Sentence::Weak {
            values: vec![deflection],
            parameters: vec![Coordinate::Restitution, Coordinate::Damping],
        };
        assert_eq!(
            weak.to_string(),
            "The rig has x_st = 1.000 ± 0.010 mm (95 %); R, β only weakly."
        );
        let impact = Item::Impact {
            index: 0,
            record: "r1".into(),
            time_s: 0.25,
        };
        let outlying = Remark::OutlyingImpacts {
            count: 4,
            first: vec![impact],
        };
        assert_eq!(
            outlying.to_string(),
            "impacts with speeds more than five robust deviations from those of the others, left out: 4 (r1 at \
             0.250 s, …)"
        );
    }
}
