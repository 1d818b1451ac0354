//! Whether the methods agree: pair by pair, a test of the difference.

use std::collections::BTreeMap;

use crate::identify::fit::parameters::Coordinate;
use crate::identify::{Agreement, Estimate, MethodResult, PairAgreement, Status};

/// Level of the whole test; divided by the number of pairs.
const LEVEL: f64 = 0.01;

/// Compare all methods that tell a common parameter. `boundaries` borrows f0, β and x_st from the
/// resonance curve, so these two are not compared on them.
pub fn agreement(methods: &BTreeMap<String, MethodResult>) -> Agreement {
    let names: Vec<&String> = methods.keys().collect();
    let mut pairs = Vec::new();
    for coordinate in Coordinate::PHYSICAL {
        for (i, a) in names.iter().enumerate() {
            for b in &names[i + 1..] {
                if shares(a, b, coordinate) {
                    continue;
                }
                pairs.extend(pair(methods, [a.as_str(), b.as_str()], coordinate));
            }
        }
    }
    let limit = LEVEL / pairs.len().max(1) as f64;
    let apart: Vec<&PairAgreement> = pairs.iter().filter(|p| p.p_value < limit).collect();
    let (agree, summary) = match (pairs.len(), apart.len()) {
        (0, _) => (
            None,
            "Only one method tells each parameter, so there is nothing to compare.".into(),
        ),
        (n, 0) => (
            Some(true),
            format!(
                "The methods agree: none of the {n} comparisons differs by more than its uncertainty allows."
            ),
        ),
        _ => (Some(false), disagreement(methods, &apart)),
    };
    Agreement {
        agree,
        summary,
        pairs,
    }
}

fn shares(a: &str, b: &str, coordinate: Coordinate) -> bool {
    coordinate != Coordinate::Restitution
        && [a, b].contains(&"boundaries")
        && [a, b].contains(&"resonance")
}

fn known(estimate: &Estimate) -> Option<(f64, f64)> {
    (estimate.status != Status::NotIdentifiable)
        .then_some((estimate.value?, estimate.standard_error?))
}

fn pair(
    methods: &BTreeMap<String, MethodResult>,
    names: [&str; 2],
    coordinate: Coordinate,
) -> Option<PairAgreement> {
    let of = |name: &str| known(methods.get(name)?.parameters.get(coordinate)?);
    let ((a, ea), (b, eb)) = (of(names[0])?, of(names[1])?);
    let z_score = (a - b) / ea.hypot(eb).max(f64::MIN_POSITIVE);
    Some(PairAgreement {
        parameter: coordinate.name().into(),
        methods: names.map(String::from),
        z_score,
        p_value: two_sided(z_score),
    })
}

fn disagreement(methods: &BTreeMap<String, MethodResult>, apart: &[&PairAgreement]) -> String {
    let worst = apart
        .iter()
        .max_by(|a, b| a.z_score.abs().total_cmp(&b.z_score.abs()));
    let Some(worst) = worst else {
        return String::new();
    };
    let coordinate = Coordinate::PHYSICAL
        .into_iter()
        .find(|c| c.name() == worst.parameter);
    let value = |name: &String| {
        let estimate = methods.get(name)?.parameters.get(coordinate?)?;
        Some(format!("{:.5}", estimate.value?))
    };
    format!(
        "The methods do not agree on {}: {} finds {}, {} finds {}, {:.1} standard errors apart. \
         Trust the interval of neither until the cause is found.",
        coordinate.map_or("?", Coordinate::symbol),
        worst.methods[0],
        value(&worst.methods[0]).unwrap_or_default(),
        worst.methods[1],
        value(&worst.methods[1]).unwrap_or_default(),
        worst.z_score.abs()
    )
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
