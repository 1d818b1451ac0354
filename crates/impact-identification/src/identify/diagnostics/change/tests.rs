//! Changes of a rig in the course of a campaign, and none.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::found::differs;
use super::moment::{furthest, without_lone_ones};
use super::rows::Whole;
use super::speeds::apart_at_one_speed;
use super::*;
use crate::identify::run::identify;
use impact_fit::VerdictKind;
use impact_fit::estimate::Status;
use impact_fit::fixture::{evidence, observed, recorded};
use impact_fit::messages::{Finding, Note, StatedValue};
use impact_fit::methods::answer::MethodResult;
use impact_fit::methods::impacts::block::{ImpactBlock, SpeedPair};
use impact_fit::solver::normal::Normal;
use impact_fit::solver::placed_rows::PlacedRows;
use impact_fit::statistics::scatter::Spread;
use impact_records::record::{Record, Sweep};

/// A measurement of the first of two numbers, or of their sum, with a unit error.
fn measured(value: f64, both: bool) -> PlacedRows {
    PlacedRows {
        places: vec![0, 1],
        slopes: DMatrix::from_row_slice(1, 2, &[-1.0, if both { -1.0 } else { 0.0 }]),
        residuals: DVector::from_element(1, value),
    }
}

#[test]
fn valid_the_gain_of_a_change_is_that_of_two_means() {
    // The first number is 0 in 8 measurements and 3 in 12 more; the second is known from as many, and
    // does not differ. At the mean of all, 1.8:
    let rows = |shift: f64, count: usize| {
        (0..count).flat_map(move |_| [measured(shift - 1.8, false), measured(shift - 1.8, true)])
    };
    let (mut all, mut after) = (Normal::zeros(2), Normal::zeros(2));
    rows(0.0, 8).for_each(|row| all.inform(&row));
    for row in rows(3.0, 12) {
        all.inform(&row);
        after.inform(&row);
    }
    // Two measurements in each of 8 and of 12, their difference 3: 9/(1/16 + 1/24).
    let whole = Whole::of(&all).expect("regular");
    let chi2 = whole.step(&after, &[0], 0).expect("regular").chi2;
    assert!(
        (chi2 - 9.0 / (1.0 / 16.0 + 1.0 / 24.0)).abs() < 1e-9,
        "{chi2}"
    );
}

#[test]
fn valid_the_moment_of_a_step_is_found_and_none_where_chance_explains_it() {
    let values = |step: f64| -> Vec<(usize, f64)> {
        let scatter = [0.3, -0.9, 1.1, -0.2, 0.6, -1.0];
        let value = |k: usize| scatter[k % 6] + if k >= 17 { step } else { 0.0 };
        (0..40).map(|k| (k, value(k))).collect()
    };
    assert_eq!(furthest(&mut values(3.0), 1.0, 0.0), Some(17));
    assert_eq!(furthest(&mut values(-3.0), 1.0, 0.0), Some(17));
    assert_eq!(furthest(&mut values(0.0), 1.0, 0.0), None);
}

#[test]
fn a_parameter_differs_where_its_change_is_beyond_chance_and_beyond_what_drifts() {
    let of = |parameter: Coordinate, apart: f64, error: f64| {
        differs(parameter, &[0.0, apart].map(|v| (v, Spread::known(error))))
    };
    assert!(of(Coordinate::Restitution, 0.02, 1e-3));
    assert!(!of(Coordinate::Restitution, 0.02, 6e-3));
    assert!(!of(Coordinate::Restitution, 0.004, 1e-4));
    // f0 may drift by 0.3 %
    assert!(of(Coordinate::Frequency, 0.01, 1e-4));
    assert!(!of(Coordinate::Frequency, 0.003, 1e-4));
}

#[test]
fn valid_a_campaign_of_two_rigs_is_named_where_the_rig_changes_and_one_of_one_is_not() {
    let one = |(restitution, f0), seed| recorded(restitution, f0, 36, seed);
    let half = one((0.8, 12.0), 11);
    let of = |other: Vec<Record>| {
        let observations = observed(&[half.clone(), other].concat());
        let found = identify(&evidence(&observations));
        let changed = found
            .suspicions
            .into_iter()
            .find_map(|finding| match finding {
                Finding::RigChanged {
                    number,
                    before,
                    after,
                    ..
                } => Some((number, before, after)),
                _ => None,
            });
        (found.verdict.kind, changed)
    };
    let (kind, changed) = of(one((0.8, 12.0), 12));
    // of one rig, though measured with other gains from the 37th record on, which leaves x_st open
    assert_eq!((kind, changed), (VerdictKind::Weak, None));
    let (kind, changed) = of(one((0.77, 12.1), 12));
    assert_eq!(kind, VerdictKind::DoesNotFit);
    let (number, before, after) = changed.expect("a change");
    assert!((35..=39).contains(&number), "{number}");
    for (values, truth) in [(before, [0.8, 12.0]), (after, [0.77, 12.1])] {
        let named: Vec<Coordinate> = values.iter().map(|v| v.parameter).collect();
        assert_eq!(named, [Coordinate::Restitution, Coordinate::Frequency]);
        for (value, truth) in values.iter().zip(truth) {
            let apart = (value.value - truth).abs();
            assert!(apart < 1.5 * value.half_width, "{values:?}");
        }
    }
}

#[test]
fn valid_f0_of_parts_is_not_compared_where_no_phase_is_measured() {
    let both = [(12.0, 11), (12.3, 12)].map(|(f0, seed)| recorded(0.8, f0, 36, seed));
    let mut observations = observed(&both.concat());
    for o in &mut observations {
        let Some(drive) = o.drive.take() else {
            continue;
        };
        o.setting.stated_frequency_hz = Some(drive.frequency_hz);
        o.motion_tone = Some(drive);
    }
    let found = identify(&evidence(&observations));
    let other_rig = |f: &Finding| matches!(f, Finding::RigChanged { .. });
    assert!(
        !found.suspicions.iter().any(other_rig),
        "{:?}",
        found.suspicions
    );
}

#[test]
fn valid_sweeps_down_on_another_rig_are_named() {
    let records = recorded(0.8, 12.0, 72, 11);
    let of = |down: &[Record]| {
        let mixed = records.iter().zip(down).enumerate().map(|(i, (up, down))| {
            let mut record = if i % 2 == 0 { up } else { down }.clone();
            record.setting.sweep = if i % 2 == 0 { Sweep::Up } else { Sweep::Down };
            record
        });
        let observations = observed(&mixed.collect::<Vec<_>>());
        let found = identify(&evidence(&observations));
        let named = found
            .suspicions
            .into_iter()
            .find_map(|finding| match finding {
                Finding::SweepsDownOnOtherRig { own, .. } => Some(own),
                _ => None,
            });
        (found.verdict.kind, named)
    };
    assert_eq!(of(&records), (VerdictKind::Identified, None));
    let (kind, named) = of(&recorded(0.76, 12.1, 72, 11));
    assert_eq!(kind, VerdictKind::DoesNotFit);
    let truth = [
        (Coordinate::Restitution, 0.76),
        (Coordinate::Frequency, 12.1),
    ];
    for (value, (parameter, truth)) in named.expect("a finding").iter().zip(truth) {
        assert_eq!(value.parameter, parameter);
        let apart = (value.value - truth).abs();
        assert!(apart < 1.5 * value.half_width, "{value:?}");
    }
}

#[test]
fn valid_records_of_two_rigs_in_no_order_are_named() {
    let rigs = [recorded(0.8, 12.0, 72, 11), recorded(0.76, 12.1, 72, 11)];
    let mixed = |other: usize| {
        let both = rigs[0].iter().zip(&rigs[other]).enumerate();
        // neither by turns nor by the clearances, which change from record to record
        let one = both.map(|(i, (own, other))| if i * i % 5 < 2 { own } else { other });
        let observations = observed(&one.cloned().collect::<Vec<_>>());
        identify(&evidence(&observations))
    };
    let is_named = |finding: &&Finding| matches!(finding, Finding::RigsMixed { .. });
    assert_eq!(mixed(0).suspicions.iter().find(is_named), None);
    let found = mixed(1);
    assert_eq!(found.verdict.kind, VerdictKind::DoesNotFit);
    let named = found.suspicions.iter().find(is_named);
    let Some(Finding::RigsMixed { own, others, .. }) = named else {
        panic!("{:?}", found.suspicions);
    };
    let of = |values: &[StatedValue], parameter| {
        let value = values.iter().find(|v| v.parameter == parameter);
        value.expect("a value").value
    };
    let r = [own, others].map(|values| of(values, Coordinate::Restitution));
    assert!(r[0].min(r[1]) < 0.77 && r[0].max(r[1]) > 0.79, "{r:?}");
}

#[test]
fn speeds_that_go_with_the_part_are_told_from_a_change_of_the_rig() {
    // the second part hits at half the speed; R falls with the logarithm of the speed, or is another there
    let pairs = |by_speed: f64, changed: f64| -> ImpactBlock {
        let impact = |i: usize| {
            let second = i % 2 == 1;
            let before = (0.2 + 0.01 * i as f64) / if second { 2.0 } else { 1.0 };
            let ratio = 0.8 - by_speed * before.ln() + if second { changed } else { 0.0 };
            SpeedPair {
                observation: i % 2,
                before_m_s: before,
                after_m_s: ratio * before,
                in_record: 1.0,
                ..SpeedPair::default()
            }
        };
        ImpactBlock::of_pairs((0..40).map(impact).collect(), 1e-3)
    };
    let second = [false, true];
    let alone =
        |by_speed: f64, changed: f64| apart_at_one_speed(&pairs(by_speed, changed), &second);
    assert!(alone(0.03, 0.0).expect("both parts").abs() < 1e-12);
    assert!((alone(0.03, -0.02).expect("both parts") + 0.02).abs() < 1e-12);
    assert_eq!(apart_at_one_speed(&pairs(0.03, 0.0), &[false; 2]), None);
    let change = |[a, b]: [f64; 2]| Change {
        of: Other::SweepsDown,
        parts: BTreeMap::from([(
            Coordinate::Restitution,
            [a, b].map(|r| (r, Spread::known(1e-3))),
        )]),
    };
    assert!(change([0.84, 0.86]).is_of_speed(&pairs(0.03, 0.0), &second));
    assert!(!change([0.84, 0.82]).is_of_speed(&pairs(0.0, -0.02), &second));
}

#[test]
fn one_record_of_few_impacts_is_no_change() {
    let with = |odd: &[usize]| -> Vec<(usize, f64)> {
        let all = (0..40).map(|i| (i, if odd.contains(&i) { 0.7 } else { 0.9 }));
        all.collect()
    };
    assert!(furthest(&mut with(&[30]), 2.5e-3, 0.0).is_some());
    assert!(furthest(&mut without_lone_ones(&with(&[30])), 2.5e-3, 0.0).is_none());
    let changed: Vec<usize> = (20..40).collect();
    let found = furthest(&mut without_lone_ones(&with(&changed)), 2.5e-3, 2.5e-3);
    assert_eq!(found, Some(20));
}

#[test]
fn both_values_stand_in_the_result_and_in_the_finding() {
    let known = |value: f64| (value, Spread::known(1e-3));
    let f0 = 12f64.ln();
    let change = Change {
        of: Other::From {
            rank: 36,
            record: "r37".into(),
        },
        parts: BTreeMap::from([
            (Coordinate::Restitution, [known(0.8), known(0.76)]),
            (Coordinate::Frequency, [known(f0), known(f0 + 1e-4)]),
        ]),
    };
    let mut joint = MethodResult::default();
    assert_eq!(change.tell(&mut joint).len(), 2);
    let r = joint.parameters.restitution.expect("R");
    assert_eq!((r.status, r.note), (Status::Weak, Some(Note::Changes)));
    let [low, high] = r.interval95.expect("an interval");
    assert!((low - 0.758_04).abs() < 1e-5 && (high - 0.801_96).abs() < 1e-5);
    let f0 = joint.parameters.natural_frequency_hz.expect("f0");
    assert_eq!(f0.status, Status::Identified);
    assert_eq!(
        change.finding(72).to_string(),
        "the records are not of one rig: before r37 (number 37 of 72) they have R = 0.8000 ± \
         0.0020, from it on R = 0.7600 ± 0.0020: look for what was changed there (masses, \
         springs, clamps, bumpers, amplifier, sensors), and identify both parts by themselves"
    );
}
