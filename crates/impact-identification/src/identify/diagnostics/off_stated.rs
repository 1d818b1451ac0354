//! How far what is stated is off, by a fit that carries the errors of statements with priors.
//!
//! Statements of the standard uncertainties σ have the errors e in a fit of covariance C. If all are off along a direction
//! d, the centres of their priors are s d. The sum of squares is then least at s = u/I, by u²/I, with u = Σ d e/σ² and
//! I = Σ d²/σ² − Σ Σ d d′ C/(σσ′)², C being that of the two. One statement alone is off by e σ²/(σ² − C), with the statistic
//! e/√(σ² − C).
//!
//! Scatter between groups, by which the fit does not weigh, is variance of u besides.

use impact_fit::method_fit::MethodFit;
use impact_fit::solver::Prior;

/// Least share of what statements tell that the data tell too, for these to judge them.
const INFORMED: f64 = 0.1;

/// By how much statements are off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Off {
    /// In units of the direction.
    pub by: f64,
    /// Over its standard error where the statements hold.
    pub z_score: f64,
}

/// By how much statements are off along a direction, each with its share of it; `None` where the data hardly tell.
pub fn along(found: &MethodFit, direction: &[(Prior, f64)]) -> Option<Off> {
    let place = |prior: &Prior| found.fit.free.iter().position(|c| *c == prior.coordinate);
    let places = direction.iter().map(|(prior, _)| place(prior));
    let places: Vec<usize> = places.collect::<Option<_>>()?;
    // d/σ²
    let weights = direction
        .iter()
        .map(|(prior, share)| share / prior.deviation.powi(2));
    let weights: Vec<f64> = weights.collect();
    let (mut score, mut stated, mut between) = (0.0, 0.0, 0.0);
    for ((prior, share), weight) in direction.iter().zip(&weights) {
        let error = found.fit.parameters.coordinate(prior.coordinate) - prior.centre;
        score += weight * error;
        stated += weight * share;
        between += (weight * found.spread(prior.coordinate)?.between_groups).powi(2);
    }
    let of_fit = |i: usize, k: usize| found.fit.covariance[(places[i], places[k])] * found.factor;
    let pairs = (0..places.len()).flat_map(|i| (0..places.len()).map(move |k| (i, k)));
    let left: f64 = pairs
        .map(|(i, k)| weights[i] * weights[k] * of_fit(i, k))
        .sum();
    let information = stated - left;
    // not a number where nothing is uncertain
    (information > INFORMED * stated).then(|| Off {
        by: score / information,
        z_score: score / (information + between).sqrt(),
    })
}

/// By how much one statement is off.
pub fn alone(found: &MethodFit, stated: Prior) -> Option<Off> {
    along(found, &[(stated, 1.0)])
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;
    use impact_fit::fixture::fitted;
    use impact_fit::parameters::{Coordinate, Parameters};
    use impact_fit::statistics::scatter::{Excess, Scatter};

    /// What a fit finds of statements, each within σ, whose errors the data tell within 1.
    fn told(errors: &[f64], deviation: f64) -> (MethodFit, Vec<Prior>) {
        let (data, prior) = (1.0, deviation.powi(-2));
        let covariance = DMatrix::identity(errors.len(), errors.len()) / (data + prior);
        let solution = &covariance * DVector::from_row_slice(errors) * data;
        let free: Vec<Coordinate> = (0..errors.len()).map(Coordinate::Gap).collect();
        let mut parameters = Parameters::symmetric(0.8, 12.0, 0.05, 1e-3);
        for (coordinate, error) in free.iter().zip(&solution) {
            parameters = parameters.with(*coordinate, *error);
        }
        let priors = free
            .iter()
            .map(|c| Prior::new(*c, 0.0, deviation))
            .collect();
        (fitted(parameters, free, covariance), priors)
    }

    #[test]
    fn valid_what_all_statements_are_off_is_that_of_least_squares() {
        let shares = [0.4, 0.9, 1.8];
        let (found, priors) = told(&shares.map(|share| 50.0 * share), 10.0);
        let direction: Vec<(Prior, f64)> = priors.into_iter().zip(shares).collect();
        let off = along(&found, &direction).expect("told");
        assert!((off.by - 50.0).abs() < 1e-9, "{off:?}");
        // 50 times the norm of the shares over that of both deviations
        let expected = 50.0 * 4.21f64.sqrt() / 101f64.sqrt();
        assert!((off.z_score / expected - 1.0).abs() < 1e-9, "{off:?}");
    }

    #[test]
    fn what_the_data_hardly_tell_or_nobody_doubts_is_not_judged() {
        let (found, priors) = told(&[3.0], 0.3);
        assert_eq!(alone(&found, priors[0]), None);
        let certain = Prior {
            deviation: 0.0,
            ..priors[0]
        };
        assert_eq!(alone(&found, certain), None);
        let other = Prior::new(Coordinate::Gain(0), 0.0, 1.0);
        assert_eq!(alone(&found, other), None);
    }

    #[test]
    fn valid_scatter_between_groups_makes_a_statement_less_suspect() {
        // 6 off with a variance of 1, 8/9 of that of the statement known by the data
        let coordinate = Coordinate::Gap(0);
        let parameters = Parameters::symmetric(0.8, 12.0, 0.05, 1e-3).with(coordinate, 6.0);
        let of = |ratio: f64| {
            let excess = Excess {
                coordinate,
                ratio,
                freedom: 5.0,
                share: 1.0,
            };
            let found = MethodFit {
                scatter: Scatter {
                    groups: 6,
                    excess: vec![excess],
                },
                ..fitted(
                    parameters,
                    vec![coordinate],
                    DMatrix::from_element(1, 1, 1.0),
                )
            };
            alone(&found, Prior::new(coordinate, 0.0, 3.0)).expect("told")
        };
        // without the prior 6 · 9/8 = 6.75, of variance 9/8 beside the 9 that are stated
        let off = of(1.0);
        assert!((off.by - 6.75).abs() < 1e-12);
        assert!((off.z_score - 6.75 / (9.0f64 + 1.125).sqrt()).abs() < 1e-9);
        // scatter of 3 grows to 3 · (9/8)²
        let off = of(4.0);
        assert!((off.z_score - 6.75 / (10.125f64 + 3.0 * 1.265_625).sqrt()).abs() < 1e-9);
    }
}
