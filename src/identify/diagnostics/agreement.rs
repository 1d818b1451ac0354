//! Whether the methods agree: pair by pair, a test of the difference.

use std::collections::BTreeMap;

use crate::identify::estimate::{Estimate, Status};
use crate::identify::fit::parameters::Coordinate;
use crate::identify::identification::{Agreement, MethodResult};
use crate::identify::messages::PairAgreement;
use crate::identify::method::Method;

/// Level of the whole test; divided by the number of pairs.
const LEVEL: f64 = 0.01;

/// Compare all methods that determine a common parameter. `boundaries` takes f0, β and x_st from the
/// resonance curve, so these two are not compared on them.
pub fn agreement(methods: &BTreeMap<Method, MethodResult>) -> Agreement {
    let names: Vec<Method> = methods.keys().copied().collect();
    let mut pairs = Vec::new();
    for coordinate in Coordinate::PHYSICAL {
        for (i, a) in names.iter().enumerate() {
            for b in &names[i + 1..] {
                if !shares(*a, *b, coordinate) {
                    pairs.extend(pair(methods, [*a, *b], coordinate));
                }
            }
        }
    }
    let limit = LEVEL / pairs.len().max(1) as f64;
    let agree = pairs.iter().all(|p| p.p_value >= limit);
    Agreement {
        agree: (!pairs.is_empty()).then_some(agree),
        pairs,
    }
}

fn shares(a: Method, b: Method, coordinate: Coordinate) -> bool {
    coordinate != Coordinate::Restitution
        && [a, b].contains(&Method::Boundaries)
        && [a, b].contains(&Method::Resonance)
}

fn known(estimate: &Estimate) -> Option<(f64, f64)> {
    (estimate.status != Status::NotIdentifiable)
        .then_some((estimate.value?, estimate.standard_error?))
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
        p_value: two_sided(z_score),
    })
}

/// Two-sided p-value of a standard normal score.
pub fn two_sided(z: f64) -> f64 {
    libm::erfc(z.abs() / std::f64::consts::SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_p_values_of_the_normal_distribution() {
        assert!((two_sided(1.959_963_984_540_054) - 0.05).abs() < 1e-15);
        assert!((two_sided(0.0) - 1.0).abs() < 1e-15);
        assert!((two_sided(-3.290_526_731_491_895) - 0.001).abs() < 1e-15);
    }
}
