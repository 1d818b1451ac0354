//! Whether the methods agree: pair by pair, a test of the difference.

use std::collections::{BTreeMap, BTreeSet};

use impact_fit::estimate::{Estimate, Status};
use impact_fit::messages::{PairAgreement, Remark};
use impact_fit::method::Method;
use impact_fit::methods::answer::{Agreement, MethodResult};
use impact_fit::parameters::Coordinate;
use impact_fit::solver::Fit;
use impact_fit::statistics::distribution::normal_tail;
use impact_fit::statistics::quantile::NORMAL_975;

/// Level of the whole test; divided by the number of pairs.
pub const LEVEL: f64 = 0.01;

/// Compare all methods that determine a common parameter. Brackets beside a resonance curve determine R alone, so
/// what the curve says of f0, β and `x_st` is one witness.
pub fn agreement(methods: &BTreeMap<Method, MethodResult>) -> Agreement {
    let names: Vec<Method> = methods.keys().copied().collect();
    let mut pairs = Vec::new();
    for coordinate in Coordinate::PHYSICAL {
        for (i, a) in names.iter().enumerate() {
            for b in &names[i + 1..] {
                pairs.extend(pair(methods, [*a, *b], coordinate));
            }
        }
    }
    let agree = !pairs.iter().any(|p| differs(p, pairs.len()));
    Agreement {
        agree: (!pairs.is_empty()).then_some(agree),
        pairs,
    }
}

/// Whether a pair of so many differs beyond its uncertainty.
fn differs(pair: &PairAgreement, pairs: usize) -> bool {
    pair.p_value < LEVEL / pairs.max(1) as f64
}

/// Which R is which, where the speeds at impacts tell another one than waveforms or boundaries: R of the contact,
/// and R of the whole bodies.
pub fn which_restitution(agreement: &Agreement) -> Option<Remark> {
    let of = |pair: &PairAgreement| {
        let impact = pair.methods.iter().position(|m| m.observes_contact())?;
        let other = 1 - impact;
        let method = pair.methods[other];
        let differs = pair.parameter == Coordinate::Restitution && pair.p_value < LEVEL;
        (differs && method.observes_whole_bodies()).then(|| Remark::WhichRestitution {
            at_impact: pair.values[impact],
            of_bodies: pair.values[other],
            method,
        })
    };
    agreement.pairs.iter().find_map(of)
}

/// What a disagreement of methods leaves open in the joint estimate of each parameter that they
/// disagree on: standard uncertainty of R absolute, of the others relative.
///
/// `DerSimonian` and Laird's random effects: with estimates y of variances v and weights 1/v, the
/// variance between methods is τ² = (Σ w(y − ȳ)² − (k − 1))/(Σw − Σw²/Σw), that of their mean
/// 1/Σ 1/(v + τ²); what the joint estimate is off that mean is added.
pub fn between_methods(
    results: &BTreeMap<Method, MethodResult>,
    agreement: &Agreement,
    joint: &MethodResult,
) -> Vec<(Coordinate, f64)> {
    let count = agreement.pairs.len();
    let apart = agreement.pairs.iter().filter(|p| differs(p, count));
    let parameters: BTreeSet<Coordinate> = apart.map(|p| p.parameter).collect();
    let of = |parameter: Coordinate| {
        let (value, error) = known(joint.parameters.get(parameter)?)?;
        let unit = parameter.slope(value);
        let paired = |method: &Method| {
            let mut pairs = agreement.pairs.iter();
            pairs.any(|p| p.parameter == parameter && p.methods.contains(method))
        };
        let found: Vec<(f64, f64)> = results
            .iter()
            .filter(|(method, _)| paired(method))
            .filter_map(|(_, result)| known(result.parameters.get(parameter)?))
            .map(|(y, e)| (y / unit, e / unit))
            .collect();
        Some((parameter, left_open(&found, value / unit, error / unit)))
    };
    parameters.into_iter().filter_map(of).collect()
}

/// What a disagreement on some parameters leaves open in those that the methods agree on: where a joint fit is
/// off by δ in p, the others follow by δ `C_qp`/`C_pp`.
pub fn carried_on(joint: &Fit, apart: &[(Coordinate, f64)]) -> Vec<(Coordinate, f64)> {
    let others = Coordinate::PHYSICAL.into_iter();
    let others = others.filter(|q| apart.iter().all(|(p, _)| p != q));
    let of = |q: Coordinate| {
        let carried = apart.iter().filter_map(|(p, by)| {
            let ratio = joint.error(q)? / joint.error(*p)?;
            Some((joint.correlation(q, *p)? * ratio * by).powi(2))
        });
        (q, carried.sum::<f64>().sqrt())
    };
    others.map(of).filter(|(_, by)| *by > 0.0).collect()
}

fn left_open(found: &[(f64, f64)], value: f64, error: f64) -> f64 {
    let sum = |of: &dyn Fn(&(f64, f64)) -> f64| found.iter().map(of).sum::<f64>();
    let weight = |e: f64| e.powi(-2);
    let (all, squares) = (sum(&|(_, e)| weight(*e)), sum(&|(_, e)| weight(*e).powi(2)));
    let mean = sum(&|(y, e)| weight(*e) * y) / all;
    let apart = sum(&|(y, e)| weight(*e) * (y - mean).powi(2));
    let freedom = found.len().saturating_sub(1) as f64;
    let between = ((apart - freedom) / (all - squares / all)).max(0.0);
    let random = |e: f64| (e * e + between).recip();
    let all = sum(&|(_, e)| random(*e));
    let mean = sum(&|(y, e)| random(*e) * y) / all;
    let variance = (all.recip() - error * error).max(0.0) + (mean - value).powi(2);
    variance.sqrt()
}

/// Value and standard error; where few degrees of freedom widen the interval, the error of a normal
/// distribution with that interval.
fn known(estimate: &Estimate) -> Option<(f64, f64)> {
    let [low, high] = estimate.interval95?;
    let error = estimate
        .standard_error?
        .max(0.5 * (high - low) / NORMAL_975);
    (estimate.status != Status::NotIdentifiable).then_some((estimate.value?, error))
}

fn pair(
    results: &BTreeMap<Method, MethodResult>,
    methods: [Method; 2],
    parameter: Coordinate,
) -> Option<PairAgreement> {
    let of = |method: Method| known(results.get(&method)?.parameters.get(parameter)?);
    let ((a, ea), (b, eb)) = (of(methods[0])?, of(methods[1])?);
    let z_score = (a - b) / ea.hypot(eb).max(f64::MIN_POSITIVE);
    Some(PairAgreement {
        parameter,
        methods,
        values: [a, b],
        z_score,
        p_value: normal_tail(z_score),
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use impact_fit::estimate::{estimate, not_identifiable};
    use impact_fit::messages::Note;
    use impact_fit::parameters::Parameters;
    use impact_fit::solver::FitReport;

    /// A method with R and its standard error.
    fn with_restitution(value: f64, error: f64) -> MethodResult {
        let mut result = MethodResult::default();
        result.parameters.restitution = Some(estimate(Coordinate::Restitution, value, error));
        result
    }

    /// A method with f0 and its relative standard error.
    fn with_frequency(value: f64, error: f64) -> MethodResult {
        let mut result = MethodResult::default();
        result.parameters.natural_frequency_hz =
            Some(estimate(Coordinate::Frequency, value.ln(), error));
        result
    }

    #[test]
    fn valid_two_estimates_are_compared_over_the_error_of_their_difference() {
        // 0.90 ± 0.01 and 0.95 ± 0.01: z = 0.05/√(2·10⁻⁴) = 3.5355, p = erfc(2.5) = 4.0695e-4
        // (Python's math.erfc), below the level of 1 % of a single comparison.
        let methods = BTreeMap::from([
            (Method::Trajectories, with_restitution(0.95, 0.01)),
            (Method::Impacts, with_restitution(0.90, 0.01)),
        ]);
        let found = agreement(&methods);
        let [pair] = &found.pairs[..] else {
            panic!("{found:?}");
        };
        assert_eq!(pair.methods, [Method::Impacts, Method::Trajectories]);
        assert_eq!(pair.values, [0.90, 0.95]);
        assert!((pair.z_score + 0.05 / 2e-4f64.sqrt()).abs() < 1e-9);
        assert!((pair.p_value - 4.069_520_174_449_589e-4).abs() < 1e-9);
        assert_eq!(found.agree, Some(false));
        assert_eq!(found.disagreement(), Some(pair));
    }

    #[test]
    fn the_level_is_shared_by_all_comparisons() {
        // z = 2.6, p = 0.0093: below 1 %, but three comparisons share that level
        let off = 2.6 * 2e-4f64.sqrt();
        let two = BTreeMap::from([
            (Method::Impacts, with_restitution(0.8, 0.01)),
            (Method::Trajectories, with_restitution(0.8 + off, 0.01)),
        ]);
        assert_eq!(agreement(&two).agree, Some(false));
        let mut three = two;
        three.insert(Method::Flights, with_restitution(0.8 + 0.5 * off, 0.01));
        let found = agreement(&three);
        assert_eq!((found.pairs.len(), found.agree), (3, Some(true)));
        assert_eq!(found.disagreement(), None);
    }

    #[test]
    fn which_r_is_which_is_said_where_impacts_and_waveforms_differ() {
        let remark = |waveforms: f64| {
            let methods = BTreeMap::from([
                (Method::Impacts, with_restitution(0.8, 1e-3)),
                (Method::Trajectories, with_restitution(waveforms, 1e-3)),
            ]);
            which_restitution(&agreement(&methods))
        };
        assert_eq!(remark(0.802), None);
        let text = remark(0.79).expect("a remark").to_string();
        assert!(
            text.starts_with(
                "at the impacts R = 0.8000, of the whole bodies (method “Trajectories”) R = 0.7900"
            ),
            "{text}"
        );
    }

    #[test]
    fn nothing_is_compared_that_is_missing() {
        let shared = BTreeMap::from([
            (Method::Boundaries, with_restitution(0.8, 0.01)),
            (Method::Resonance, with_frequency(13.0, 1e-4)),
        ]);
        assert_eq!(agreement(&shared), Agreement::default());
        let mut missing = MethodResult::default();
        missing.parameters.restitution = Some(not_identifiable(Note::NotSeparable));
        let with_missing = BTreeMap::from([
            (Method::Impacts, with_restitution(0.8, 0.01)),
            (Method::Trajectories, missing),
        ]);
        assert_eq!(agreement(&with_missing).agree, None);
    }

    #[test]
    fn valid_what_methods_agree_on_follows_what_they_disagree_on() {
        // of a normal distribution with σ_R = 0.01, σ_f = 0.001 and a correlation of 0.6, f0 follows R by 0.06
        let joint = Fit {
            parameters: Parameters::symmetric(0.8, 12.0, 0.05, 1e-3),
            free: vec![Coordinate::Restitution, Coordinate::Frequency],
            covariance: DMatrix::from_row_slice(2, 2, &[1e-4, 6e-6, 6e-6, 1e-6]),
            cost: 0.0,
            residuals: 0,
            report: FitReport::default(),
        };
        let carried = carried_on(&joint, &[(Coordinate::Restitution, 0.02)]);
        let [(Coordinate::Frequency, by)] = carried[..] else {
            panic!("{carried:?}");
        };
        assert!((by - 0.06 * 0.02).abs() < 1e-15);
        assert_eq!(carried_on(&joint, &[]), []);
    }

    #[test]
    fn valid_what_two_methods_leave_open_is_half_their_distance() {
        // Two estimates of error 1, 20 apart: τ² = (200 − 1)/1 = 199, variance of the mean
        // (1 + 199)/2 = 100; the joint one in the middle had 1/2.
        let open = left_open(&[(-10.0, 1.0), (10.0, 1.0)], 0.0, 0.5f64.sqrt());
        assert!((open - 99.5f64.sqrt()).abs() < 1e-12);
        // Of methods that agree nothing is left open.
        assert!(left_open(&[(0.1, 1.0), (-0.1, 1.0)], 0.0, 0.5f64.sqrt()) < 1e-6);
    }
}
