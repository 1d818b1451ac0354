//! Gains of two sensors of one mass that were calibrated together.
//!
//! Stated gains count as independent, so that two sensors of one mass would tell `x_st` √2 times as well as one.
//! A vibrometer with two outputs, or a displacement by an integrator, has one error in both. The sensors
//! themselves show how far they have: gains of uncertainties σ that are correlated by ρ differ by d with
//! E[d²] = σ²(1 − ρ) + σ²(1 − ρ), so that ρ is estimated as 1 − (d² + its variance)/2σ². To the variance of a
//! parameter the correlation adds 2ρ cc'σ² with its sensitivities c, c' to both.

use crate::parameters::{Coordinate, GAIN_ROLES};
use crate::solver::{Fit, Prior, Problem};

/// A gain of a fit: its place among the free coordinates, what it is off the stated one, and its prior's deviation.
#[derive(Clone, Copy)]
struct Gain {
    place: usize,
    off: f64,
    deviation: f64,
}

/// What gains that may have been calibrated together leave open in R, f0, β and `x_st`, of R absolute, of the
/// others relative.
pub fn shared_gains(problem: &Problem<'_>, fit: &Fit, factor: f64) -> Vec<(Coordinate, f64)> {
    let gain = |i: usize| {
        let coordinate = Coordinate::Gain(i);
        let of = |p: &&Prior| p.coordinate == coordinate;
        let prior = problem.priors.iter().find(of)?;
        Some(Gain {
            place: fit.free.iter().position(|c| *c == coordinate)?,
            off: fit.parameters.coordinate(coordinate) - prior.centre,
            deviation: prior.deviation,
        })
    };
    let mut pairs = Vec::new();
    for (i, role) in GAIN_ROLES.iter().enumerate() {
        for (k, other) in GAIN_ROLES.iter().enumerate().skip(i + 1) {
            let same = role.is_of_y() == other.is_of_y();
            pairs.extend(gain(i).zip(gain(k)).filter(|_| same));
        }
    }
    let of = |(row, parameter): (usize, Coordinate)| {
        let added = pairs.iter().map(|(a, b)| {
            let [s, t] = [a, b].map(|g| fit.covariance[(row, g.place)] / g.deviation);
            2.0 * correlation(fit, a, b) * s * t * factor
        });
        (parameter, added.sum::<f64>().max(0.0).sqrt())
    };
    let estimated = fit.estimated().into_iter();
    estimated.map(of).filter(|(_, open)| *open > 0.0).collect()
}

/// How far two gains share their error, by how little they differ.
fn correlation(fit: &Fit, a: &Gain, b: &Gain) -> f64 {
    let c = &fit.covariance;
    let unknown = c[(a.place, a.place)] + c[(b.place, b.place)] - 2.0 * c[(a.place, b.place)];
    let expected = a.deviation.powi(2) + b.deviation.powi(2);
    (1.0 - ((a.off - b.off).powi(2) + unknown) / expected).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::parameters::Parameters;
    use crate::solver::FitReport;

    /// A fit of `x_st` that follows the mean of the gains of a velocity and a displacement of x exactly, where
    /// the data tell the difference of the gains exactly.
    fn fitted(off: f64, sigma: f64) -> Fit {
        let free = vec![
            Coordinate::Deflection,
            Coordinate::Gain(0),
            Coordinate::Gain(2),
        ];
        let half = 0.5 * sigma * sigma;
        let parameters = Parameters::symmetric(0.8, 12.0, 0.05, 1e-3);
        let parameters = parameters.with(Coordinate::Gain(0), 0.5 * off);
        Fit {
            parameters: parameters.with(Coordinate::Gain(2), -0.5 * off),
            covariance: DMatrix::from_element(3, 3, half),
            free,
            cost: 0.0,
            residuals: 0,
            report: FitReport::default(),
        }
    }

    #[test]
    fn valid_sensors_that_agree_tell_no_more_than_one_of_them() {
        let sigma = 5e-3;
        let priors = [0, 2].map(|i| Prior::new(Coordinate::Gain(i), 0.0, sigma));
        let problem = Problem {
            priors: priors.to_vec(),
            ..Problem::default()
        };
        let open = |off: f64| shared_gains(&problem, &fitted(off, sigma), 1.0);
        // σ²/2 by both, to which the correlation adds another half
        let [(parameter, by)] = open(0.0)[..] else {
            panic!("x_st alone is estimated");
        };
        assert_eq!(parameter, Coordinate::Deflection);
        assert!((by * by - 0.5 * sigma * sigma).abs() < 1e-15);
        // gains that differ as two calibrations do
        assert_eq!(open(2f64.sqrt() * sigma), []);
    }
}
