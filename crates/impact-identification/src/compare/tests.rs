use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

use super::*;
use impact_fit::parameters::{Coordinate, Parameters};
use impact_fit::solver::normal::inverse;
use impact_fit::solver::{Fit, FitReport, Prior};
use impact_fit::statistics::distribution::student_tail;
use impact_fit::{Allowed, Estimate, GAIN_ROLES, JointFit, ParameterSet, Status, VerdictKind};
use impact_records::event::{FlightKind, RigKind};
use impact_records::record::calibrate::{ChannelKey, ChannelSetup};
use labfiles::units::Scale;

/// A linear measurement of R and some nuisances with unit noise: slopes, values.
#[derive(Debug)]
struct Measured {
    slopes: DMatrix<f64>,
    values: DVector<f64>,
}

/// The nuisances of the tests and the standard deviations of their priors; R has a wide one.
const FREE: [(Coordinate, f64); 4] = [
    (Coordinate::Restitution, 1.0),
    (Coordinate::Gain(0), 0.3),
    (Coordinate::Corner(0), 0.2),
    (Coordinate::ScrewZero, 0.5),
];

fn priors() -> Vec<Prior> {
    FREE.map(|(coordinate, deviation)| Prior {
        coordinate,
        centre: if coordinate == Coordinate::Restitution {
            0.5
        } else {
            0.0
        },
        deviation,
    })
    .to_vec()
}

/// A campaign on one rig that states to share all its errors.
fn campaign(number: usize, measured: &Measured) -> Campaign {
    let mut information = measured.slopes.transpose() * &measured.slopes;
    let mut vector = measured.slopes.transpose() * &measured.values;
    for (i, prior) in priors().iter().enumerate() {
        information[(i, i)] += prior.deviation.powi(-2);
        vector[i] += prior.centre * prior.deviation.powi(-2);
    }
    let covariance = inverse(&information).expect("regular");
    let found = &covariance * vector;
    let mut parameters = Parameters::symmetric(0.5, 10.0, 0.05, 1e-3);
    for ((coordinate, _), value) in FREE.iter().zip(found.iter()) {
        parameters = parameters.with(*coordinate, *value);
    }
    let error = covariance[(0, 0)].sqrt();
    let estimate = Estimate {
        value: Some(found[0]),
        standard_error: Some(error),
        interval95: Some([found[0] - 1.96 * error, found[0] + 1.96 * error]),
        status: Status::Identified,
        note: None,
    };
    Campaign {
        name: format!("campaign {number}"),
        measurement: number,
        machine: RigKind::Double,
        flight: FlightKind::Harmonic,
        measured: None,
        synthetic: false,
        verdict: VerdictKind::Identified,
        parameters: ParameterSet {
            restitution: Some(estimate),
            ..ParameterSet::default()
        },
        fit: Some(JointFit {
            fit: Fit {
                parameters,
                free: FREE.map(|f| f.0).to_vec(),
                covariance,
                cost: number as f64,
                residuals: measured.values.len(),
                report: FitReport::default(),
            },
            variance_factor: 1.0,
            weights: BTreeMap::new(),
            priors: priors(),
            gaps_m: Vec::new(),
            allowed: vec![Allowed {
                parameter: Coordinate::Restitution,
                standard_uncertainty: error,
                degrees_of_freedom: None,
            }],
        }),
        rig: None,
        shared: Common::ALL.to_vec(),
        channels: GAIN_ROLES
            .map(|role| ChannelSetup::plain(role, ChannelKey::Index(0)))
            .to_vec(),
    }
}

fn nothing_shared(mut campaign: Campaign) -> Campaign {
    campaign.shared.clear();
    campaign
}

/// y = R + 2 gain, once, with unit noise over a scale.
fn simple(number: usize, value: f64, noise: f64) -> Campaign {
    let row = [1.0, 2.0, 0.0, 0.0].map(|s| s / noise);
    campaign(
        number,
        &Measured {
            slopes: DMatrix::from_row_slice(1, 4, &row),
            values: DVector::from_element(1, value / noise),
        },
    )
}

/// The Gaussian of R of each campaign with all nuisances one unknown each, solved at once.
fn solved_at_once(all: &[Measured]) -> (DVector<f64>, DMatrix<f64>) {
    let nuisances = FREE.len() - 1;
    let count = all.len() + nuisances;
    let (mut information, mut vector) = (DMatrix::zeros(count, count), DVector::zeros(count));
    for (k, measured) in all.iter().enumerate() {
        let place = |i: usize| if i == 0 { k } else { all.len() + i - 1 };
        let own = measured.slopes.transpose() * &measured.slopes;
        let right = measured.slopes.transpose() * &measured.values;
        for i in 0..FREE.len() {
            vector[place(i)] += right[i];
            for j in 0..FREE.len() {
                information[(place(i), place(j))] += own[(i, j)];
            }
        }
        information[(k, k)] += 1.0;
        vector[k] += 0.5;
    }
    for i in 0..nuisances {
        information[(all.len() + i, all.len() + i)] += FREE[i + 1].1.powi(-2);
    }
    let covariance = information.cholesky().expect("regular").inverse();
    (&covariance * vector, covariance)
}

fn measured() -> impl Strategy<Value = Measured> {
    let rows = 6;
    let slopes = proptest::collection::vec(-3.0..3.0f64, rows * FREE.len());
    let values = proptest::collection::vec(-2.0..2.0f64, rows);
    (slopes, values).prop_map(move |(slopes, values)| Measured {
        slopes: DMatrix::from_row_slice(rows, FREE.len(), &slopes),
        values: DVector::from_vec(values),
    })
}

proptest! {
    #[test]
    fn prop_the_differences_are_those_of_one_fit_to_all_campaigns(
        all in proptest::collection::vec(measured(), 2..5)
    ) {
        let campaigns: Vec<Campaign> =
            all.iter().enumerate().map(|(k, m)| campaign(k, m)).collect();
        let found = compare(&campaigns).expect("comparable");
        let (mean, covariance) = solved_at_once(&all);
        for d in &found.differences {
            let k = d.campaign;
            let value = mean[k] - mean[0];
            let variance = covariance[(k, k)] + covariance[(0, 0)] - 2.0 * covariance[(0, k)];
            prop_assert!((d.value - value).abs() < 1e-9, "{} {value}", d.value);
            prop_assert!((d.standard_error - variance.sqrt()).abs() < 1e-9);
        }
        prop_assert_eq!(found.differences.len(), all.len() - 1);
        prop_assert_eq!(found.shared.len(), FREE.len() - 1);
    }

    #[test]
    fn prop_what_shares_nothing_differs_as_independent_results_do(
        a in measured(), b in measured()
    ) {
        let campaigns = [campaign(0, &a), campaign(1, &b)].map(nothing_shared);
        let found = compare(&campaigns).expect("comparable");
        let d = found.differences[0];
        for (own, alone) in d.interval95.iter().zip(d.independent_interval95) {
            prop_assert!((own - alone).abs() < 1e-9);
        }
        prop_assert_eq!(found.remarks, vec![ComparisonRemark::NothingShared]);
    }

    #[test]
    fn prop_the_other_way_round_a_difference_has_the_other_sign(a in measured(), b in measured()) {
        let there = compare(&[campaign(0, &a), campaign(1, &b)]).expect("comparable");
        let back = compare(&[campaign(1, &b), campaign(0, &a)]).expect("comparable");
        let (there, back) = (there.differences[0], back.differences[0]);
        prop_assert!((there.value + back.value).abs() < 1e-9);
        prop_assert!((there.p_value - back.p_value).abs() < 1e-9);
    }
}

#[test]
fn valid_a_gain_that_both_share_cancels() {
    // y = R + 2 g + noise of 0.01 in both, the same g ± 0.3: the difference of R is that of y, ± 0.01 √2;
    // independent: ± √2 √(0.01² + 0.6²). The wide prior of R (± 1 about 0.5) draws by 1e-4 at most.
    let campaigns = [simple(0, 0.8, 0.01), simple(1, 0.7, 0.01)];
    let d = compare(&campaigns).expect("comparable").differences[0];
    assert!((d.value + 0.1).abs() < 1e-4, "{d:?}");
    assert!(
        (d.standard_error - 0.01 * 2f64.sqrt()).abs() < 1e-5,
        "{d:?}"
    );
    let alone = d.independent_interval95;
    assert!(
        alone[1] - alone[0] > 40.0 * (d.interval95[1] - d.interval95[0]),
        "{d:?}"
    );
    assert!(d.p_value < 1e-6);
}

/// A static deflection of 1 mm times eˡ, measured as l + 2 gain with noise.
fn deflection(number: usize, logarithm: f64, noise: f64) -> Campaign {
    let mut campaign = simple(number, logarithm, noise);
    let at = logarithm + 1e-3_f64.ln();
    let fit = campaign.fit.as_mut().expect("a fit");
    let wide = 1e3;
    let mut information = inverse(&fit.fit.covariance).expect("regular");
    information[(0, 0)] += f64::powi(wide, -2) - FREE[0].1.powi(-2);
    fit.fit.covariance = inverse(&information).expect("regular");
    fit.fit.free[0] = Coordinate::Deflection;
    let parameters = fit.fit.parameters.with(Coordinate::Deflection, at);
    fit.fit.parameters = parameters.with(Coordinate::Gain(0), 0.0);
    fit.priors[0] = Prior {
        coordinate: Coordinate::Deflection,
        centre: at,
        deviation: wide,
    };
    let error = fit.fit.covariance[(0, 0)].sqrt();
    fit.allowed[0] = Allowed {
        parameter: Coordinate::Deflection,
        standard_uncertainty: error,
        degrees_of_freedom: None,
    };
    let estimate = campaign.parameters.restitution.take();
    campaign.parameters.static_deflection_m = estimate.map(|e| Estimate {
        value: Some(at.exp()),
        standard_error: Some(at.exp() * error),
        ..e
    });
    campaign
}

#[test]
fn valid_a_shared_gain_leaves_its_share_of_a_difference_in_metres() {
    // A gain that may be off by 60 % leaves the ratio of two deflections as it is, and 60 % of what lies
    // between them.
    let campaigns = [deflection(0, 0.0, 1e-4), deflection(1, 0.1, 1e-4)];
    let d = compare(&campaigns).expect("comparable").differences[0];
    let between = 1e-3 * (0.1_f64.exp() - 1.0);
    assert!((d.value - between).abs() < 1e-8, "{d:?}");
    assert!(
        (d.standard_error - 0.6 * between).abs() < 1e-3 * between,
        "{d:?}"
    );
    let [ratio, low, high] = d.relative;
    assert!((ratio - 1e3 * between).abs() < 1e-6, "{d:?}");
    assert!(high - low < 1e-3, "{d:?}");
}

#[test]
fn valid_the_test_of_one_difference_is_that_of_its_interval() {
    // a difference of 1.96 standard errors is one in twenty
    let step = 1.959_963_985 * 0.01 * 2f64.sqrt();
    let campaigns = [simple(0, 0.7, 0.01), simple(1, 0.7 + step, 0.01)];
    let found = compare(&campaigns).expect("comparable");
    let test = found.unchanged.expect("a test");
    assert!((test.p_value - 0.05).abs() < 1e-3, "{test:?}");
    assert!((test.p_value - found.differences[0].p_value).abs() < 1e-6);
    let far = [simple(0, 0.7, 0.01), simple(1, 0.8, 0.01)];
    let found = compare(&far).expect("comparable");
    let parameters = vec![Coordinate::Restitution];
    assert_eq!(found.outcome(), ComparisonOutcome::Changed { parameters });
}

#[test]
fn valid_interval_and_p_value_are_of_one_distribution_with_few_degrees_of_freedom() {
    let uncertain = |number, value| {
        let mut campaign = nothing_shared(simple(number, value, 0.01));
        if let Some(fit) = &mut campaign.fit {
            fit.allowed[0].degrees_of_freedom = Some(0.6);
        }
        campaign
    };
    let found = compare(&[uncertain(0, 0.7), uncertain(1, 0.75)]).expect("comparable");
    let difference = found.differences[0];
    // two equal variances with 0.6 degrees of freedom each
    let freedom = difference.degrees_of_freedom.expect("a number");
    assert!((freedom - 1.2).abs() < 1e-6, "{freedom}");
    // scipy.stats.t.ppf(0.975, 1.2)
    let [low, high] = difference.interval95;
    let quantile = 0.5 * (high - low) / difference.standard_error;
    assert!((quantile / 8.648_826_51 - 1.0).abs() < 1e-5, "{quantile}");
    // at the end of the interval p is 5 %
    let [value, error] = [difference.value, difference.standard_error];
    let at_end = student_tail(quantile, freedom);
    assert!((at_end - 0.05).abs() < 1e-10, "{at_end}");
    let p = student_tail(value / error, freedom);
    assert!((difference.p_value - p).abs() < 1e-6, "{difference:?}");
}

#[test]
fn a_difference_that_is_clear_alone_decides_against_a_test_of_all_without_power() {
    let far = [simple(0, 0.7, 0.01), simple(1, 0.8, 0.01)];
    let mut found = compare(&far).expect("comparable");
    let first = found.differences[0];
    let of = |parameter, p_value| Difference {
        parameter,
        p_value,
        ..first
    };
    found.differences = vec![
        of(Coordinate::Restitution, 0.0003),
        of(Coordinate::Frequency, 0.94),
        of(Coordinate::Damping, 0.60),
        of(Coordinate::Deflection, 0.98),
    ];
    found.unchanged = found.unchanged.map(|test| EqualityTest {
        p_value: 0.37,
        ..test
    });
    let p = found.p_value().expect("a probability");
    assert!((p - 0.0024).abs() < 1e-15, "{p}");
    let parameters = vec![Coordinate::Restitution];
    assert_eq!(found.outcome(), ComparisonOutcome::Changed { parameters });
    found.differences[0].p_value = 0.02;
    assert_eq!(found.outcome(), ComparisonOutcome::NothingChanged);
}

#[test]
fn only_those_share_that_have_one_instrument_and_one_scale() {
    let with = |number, instrument: &str, scale: f64| {
        let mut campaign = nothing_shared(simple(number, 0.7, 0.01));
        campaign.channels[0].instrument = Some(instrument.to_owned());
        campaign.channels[0].scale = Scale::Factor(scale);
        campaign
    };
    let shared = |a: Campaign, b: Campaign| {
        let found = compare(&[a, b]).expect("comparable");
        (found.shared, found.separate)
    };
    let instrument = "S/N 12".to_owned();
    let (both, _) = shared(with(0, "S/N 12", 1.0), with(1, "S/N 12 ", 1.0));
    let why = WhyShared::SameInstrument { instrument };
    assert!(both.iter().all(|s| s.why == why), "{both:?}");
    let coordinates: Vec<Coordinate> = both.iter().map(|s| s.coordinate).collect();
    assert_eq!(coordinates, [Coordinate::Gain(0), Coordinate::Corner(0)]);
    let (other, _) = shared(with(0, "S/N 12", 1.0), with(1, "S/N 13", 1.0));
    assert!(other.is_empty());
    let (recalibrated, separate) = shared(with(0, "S/N 12", 1.0), with(1, "S/N 12", 1.01));
    assert_eq!(recalibrated.len(), 1, "the corner alone");
    assert_eq!(separate[0].why, NotShared::StatedOtherwise);
    let stated = |mut c: Campaign| {
        c.shared = vec![Common::Gains];
        c
    };
    let (none, separate) = shared(
        stated(with(0, "S/N 12", 1.0)),
        stated(with(1, "S/N 13", 1.0)),
    );
    assert!(none.is_empty());
    assert!(matches!(separate[0].why, NotShared::OtherInstrument { .. }));
}

#[test]
fn what_one_states_alone_or_of_another_rig_is_not_shared() {
    let stated = |number, rig: &str| Campaign {
        shared: vec![Common::ClearanceZero],
        rig: Some(rig.to_owned()),
        ..simple(number, 0.7, 0.01)
    };
    let found = compare(&[stated(0, "A"), stated(1, "A")]).expect("comparable");
    assert_eq!(found.shared[0].coordinate, Coordinate::ScrewZero);
    let found = compare(&[stated(0, "A"), stated(1, "B")]).expect("comparable");
    assert!(found.shared.is_empty());
    assert!(matches!(found.separate[0].why, NotShared::OtherRig { .. }));
    let alone = nothing_shared(stated(1, "A"));
    let found = compare(&[stated(0, "A"), alone]).expect("comparable");
    assert_eq!(found.separate[0].why, NotShared::StatedByOne);
}

#[test]
fn clearances_are_shared_where_they_are_stated_alike() {
    let with_gaps = |number: usize, gaps_m: &[f64]| {
        let mut campaign = simple(number, 0.7, 0.01);
        let fit = campaign.fit.as_mut().expect("a fit");
        fit.fit.free[3] = Coordinate::Gap(gaps_m.len() - 1);
        fit.priors[3].coordinate = Coordinate::Gap(gaps_m.len() - 1);
        fit.gaps_m = gaps_m.to_vec();
        campaign
    };
    let of_gaps = |a, b| {
        let found = compare(&[a, b]).expect("comparable");
        let all = found.shared.into_iter();
        all.filter(|s| s.clearance_m.is_some()).collect::<Vec<_>>()
    };
    let same = of_gaps(with_gaps(0, &[1e-3, 2e-3]), with_gaps(1, &[2e-3]));
    assert_eq!(same[0].coordinate, Coordinate::Gap(1));
    assert_eq!(same[0].campaigns, [0, 1]);
    assert!(of_gaps(with_gaps(0, &[1e-3, 2e-3]), with_gaps(1, &[1e-3])).is_empty());
}

/// Static deflection over two clearances of 1 and 2 mm, each known within a relative noise, as it is `change`
/// above the half of each; the fit has all lengths off by a factor, which their stated values hardly contradict.
fn over_clearances(number: usize, change: f64, factor: f64, noise: f64) -> Campaign {
    let (stated_mm, deviation_mm) = ([1.0, 2.0], 0.1);
    let fitted_mm = stated_mm.map(|c| c * factor);
    let slopes = [
        [1.0, -1.0 / fitted_mm[0], 0.0],
        [1.0, 0.0, -1.0 / fitted_mm[1]],
    ];
    let slopes = DMatrix::from_fn(2, 3, |i, k| slopes[i][k] / noise);
    let mut information = slopes.transpose() * &slopes;
    for i in [1, 2] {
        information[(i, i)] += f64::powi(deviation_mm, -2);
    }
    let mut campaign = deflection(number, change, 1.0);
    let fit = campaign.fit.as_mut().expect("a fit");
    let covariance = inverse(&information).expect("regular");
    let value = 1e-3 * (factor * change.exp());
    let error = covariance[(0, 0)].sqrt();
    let mut parameters = fit.fit.parameters;
    parameters = parameters.with(Coordinate::Deflection, value.ln());
    for (i, (fitted, stated)) in fitted_mm.iter().zip(stated_mm).enumerate() {
        parameters = parameters.with(Coordinate::Gap(i), fitted - stated);
    }
    fit.fit.parameters = parameters;
    fit.fit.covariance = covariance;
    fit.fit.free = vec![
        Coordinate::Deflection,
        Coordinate::Gap(0),
        Coordinate::Gap(1),
    ];
    fit.priors = [0, 1]
        .map(|i| Prior {
            coordinate: Coordinate::Gap(i),
            centre: 0.0,
            deviation: deviation_mm,
        })
        .to_vec();
    fit.gaps_m = stated_mm.map(|c| 1e-3 * c).to_vec();
    fit.allowed[0].standard_uncertainty = error;
    let estimate = campaign.parameters.static_deflection_m.take();
    campaign.parameters.static_deflection_m = estimate.map(|e| Estimate {
        value: Some(value),
        standard_error: Some(value * error),
        ..e
    });
    campaign
}

#[test]
fn valid_shared_clearances_cancel_wherever_each_fit_puts_them() {
    // The ratio of the deflections is known to the noise: √2 for the campaigns, 1/√2 for the two clearances.
    for (factor, noise) in [(1.0, 1e-5), (1.03, 1e-5), (0.95, 1e-5), (1.03, 1e-6)] {
        let campaigns = [
            over_clearances(0, 0.0, 1.0, noise),
            over_clearances(1, 0.01, factor, noise),
        ];
        let d = compare(&campaigns).expect("comparable").differences[0];
        let [ratio, low, high] = d.relative;
        assert!(
            (ratio - 0.01_f64.exp_m1()).abs() < 0.1 * noise,
            "{factor}: {d:?}"
        );
        let width = 2.0 * 1.96 * noise * 0.01_f64.exp();
        assert!(((high - low) / width - 1.0).abs() < 0.01, "{factor}: {d:?}");
    }
}

#[test]
fn what_cannot_be_compared_is_refused_with_the_remedy() {
    let one = || simple(0, 0.7, 0.01);
    let refused = |campaigns: &[Campaign]| compare(campaigns).expect_err("refused");
    assert_eq!(refused(&[]), ComparisonError::TooFew(0));
    assert_eq!(refused(&[one()]), ComparisonError::TooFew(1));
    assert!(matches!(refused(&[one(), one()]), ComparisonError::Same(_)));
    let stop = Campaign {
        machine: RigKind::Single,
        ..simple(1, 0.7, 0.01)
    };
    let error = refused(&[one(), stop]);
    assert!(error.to_string().contains("two masses"), "{error}");
    assert!(error.remedy().contains("machine"));
    let falling = Campaign {
        flight: FlightKind::ConstantForce,
        ..simple(1, 0.7, 0.01)
    };
    assert!(
        refused(&[one(), falling])
            .to_string()
            .contains("constant force")
    );
    let unknown = Campaign {
        parameters: ParameterSet::default(),
        ..simple(1, 0.7, 0.01)
    };
    assert!(matches!(
        refused(&[one(), unknown]),
        ComparisonError::NothingCommon(_)
    ));
}

#[test]
fn scatter_between_groups_widens_a_difference_as_it_widens_each_result() {
    let scattered = |number| {
        let mut campaign = simple(number, 0.7, 0.01);
        let allowed = &mut campaign.fit.as_mut().expect("a fit").allowed[0];
        allowed.standard_uncertainty = allowed.standard_uncertainty.hypot(0.02);
        allowed.degrees_of_freedom = Some(5.0);
        campaign
    };
    let d = compare(&[scattered(0), scattered(1)])
        .expect("comparable")
        .differences[0];
    // √2 √(0.01² + 0.02²)
    assert!((d.standard_error - 0.001f64.sqrt()).abs() < 1e-4, "{d:?}");
    assert!(d.degrees_of_freedom.is_some());
}

#[test]
fn a_result_without_a_joint_fit_enters_by_its_interval() {
    let alone = Campaign {
        fit: None,
        ..simple(1, 0.75, 0.01)
    };
    let fitted = simple(0, 0.7, 0.01);
    let found = compare(&[fitted, alone]).expect("comparable");
    let d = found.differences[0];
    assert!((d.interval95[0] - d.independent_interval95[0]).abs() < 1e-6);
    assert!(matches!(
        found.remarks[..],
        [ComparisonRemark::NoJointFit { .. }]
    ));
}
