//! Expectation propagation: the probability that several normally distributed numbers of mean zero fall where each of
//! them is likely, and their distribution then.
//!
//! A factor that depends on one number is replaced by the normal one with the same mass, mean and variance beside
//! all others, in turn until none changes (Minka 2001; of truncated normal distributions Cunningham, Hennig and
//! Lacoste-Julien 2011).

use nalgebra::{DMatrix, DVector};

use crate::methods::boundaries::jump::Tilt;
use impact_records::signal::columns::subtract_outer;

/// Most rounds over all factors.
const MOST_ROUNDS: usize = 40;
/// Greatest change of a mean, in its deviations, and of a relative variance in one round below which all has settled.
const SETTLED: f64 = 1e-4;

/// Factors that each depend on one of several normally distributed numbers.
pub struct Factors<'a, F> {
    /// Covariance of the numbers before any factor.
    pub covariance: &'a DMatrix<f64>,
    /// Logarithm of a factor's mean over its number, of a normal one with this mean and variance, over the mean.
    pub tilt: F,
}

/// What the factors were replaced by, and the normal distribution that they leave.
#[derive(Debug, Clone)]
pub struct Propagation {
    /// Of each factor the precision and the precision times the mean of what replaces it.
    sites: Vec<[f64; 2]>,
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
    /// Logarithm of the determinant of the covariance over what it was before any factor.
    log_determinant: f64,
    /// Logarithm of the mass of the product of all factors.
    pub log: f64,
}

impl Propagation {
    /// Before any factor.
    fn new(covariance: &DMatrix<f64>) -> Self {
        let factors = covariance.nrows();
        Self {
            sites: vec![[0.0; 2]; factors],
            mean: DVector::zeros(factors),
            covariance: covariance.clone(),
            log_determinant: 0.0,
            log: f64::NEG_INFINITY,
        }
    }

    /// Of all factors, from an earlier result of as many.
    pub fn of<F: Fn(usize, f64, f64) -> Tilt>(
        factors: &Factors<'_, F>,
        from: Option<&Self>,
    ) -> Self {
        let mut found = match from {
            Some(from) => from.clone(),
            None => Self::new(factors.covariance),
        };
        for _ in 0..MOST_ROUNDS {
            let changes = (0..found.sites.len()).map(|k| found.replace(k, factors));
            if changes.fold(0.0, f64::max) < SETTLED {
                break;
            }
        }
        found.log = found.mass(factors);
        found
    }

    /// Mean and variance of a number without its factor: `None` where nothing of it is open.
    fn without(&self, k: usize) -> Option<Cavity> {
        let (variance, mean) = (self.covariance[(k, k)], self.mean[k]);
        let [precision, shift] = self.sites[k];
        let left = variance.recip() - precision;
        (variance > f64::MIN_POSITIVE && left.is_finite() && left > 0.0).then(|| Cavity {
            mean: (mean / variance - shift) / left,
            variance: left.recip(),
        })
    }

    /// Replace one factor by what has its mass, mean and variance beside all others; gives how much that changes.
    fn replace<F: Fn(usize, f64, f64) -> Tilt>(
        &mut self,
        k: usize,
        factors: &Factors<'_, F>,
    ) -> f64 {
        let Some(cavity) = self.without(k) else {
            return 0.0;
        };
        let tilt = (factors.tilt)(k, cavity.mean, cavity.variance);
        // A factor that would widen what is known is taken to say nothing of the width.
        let kept = (1.0 + cavity.variance * tilt.curvature).clamp(1e-9, 1.0);
        let variance = cavity.variance * kept;
        let mean = cavity.mean + cavity.variance * tilt.slope;
        let site = [
            variance.recip() - cavity.variance.recip(),
            mean / variance - cavity.mean / cavity.variance,
        ];
        let [more, shift] = [0, 1].map(|i| site[i] - self.sites[k][i]);
        let (own_mean, own_variance) = (self.mean[k], self.covariance[(k, k)]);
        let grown = 1.0 + more * own_variance;
        if !(grown > 0.0 && grown.is_finite() && shift.is_finite()) {
            return 0.0;
        }
        self.sites[k] = site;
        let moved = (shift - more * own_mean) / grown;
        let spread = self.covariance.column(k).clone_owned();
        self.mean.axpy(moved, &spread, 1.0);
        subtract_outer(
            self.covariance.as_mut_slice(),
            more / grown,
            spread.as_slice(),
        );
        self.log_determinant -= grown.ln();
        (moved * own_variance.sqrt())
            .abs()
            .max((more * own_variance).abs())
    }

    /// Logarithm of the mass of the product of what the factors are.
    fn mass<F: Fn(usize, f64, f64) -> Tilt>(&self, factors: &Factors<'_, F>) -> f64 {
        let mut log = 0.5 * self.log_determinant;
        for (k, [precision, shift]) in self.sites.iter().enumerate() {
            log += 0.5 * shift * self.mean[k];
            let Some(c) = self.without(k) else {
                log += (factors.tilt)(k, self.mean[k], 0.0).log;
                continue;
            };
            let own = c.mean / c.variance;
            log += (factors.tilt)(k, c.mean, c.variance).log
                + 0.5 * (1.0 + precision * c.variance).ln()
                + 0.5 * (c.mean * own - (own + shift).powi(2) / (c.variance.recip() + precision));
        }
        log
    }
}

/// A number beside all factors but its own.
struct Cavity {
    mean: f64,
    variance: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::boundaries::jump::{density, normal};

    /// The sum is positive.
    fn positive(mean: f64, variance: f64) -> Tilt {
        let s = variance.max(1e-30).sqrt();
        let (p, d) = (normal(mean / s), density(mean / s) / s);
        Tilt::of([p, d, -d * mean / variance.max(1e-30)])
    }

    #[test]
    fn valid_the_orthant_of_two_normal_deviates() {
        // P(x > 0, y > 0) = 1/4 + arcsin(ρ)/(2π)
        for correlation in [-0.6, 0.0, 0.5, 0.9f64] {
            let covariance = DMatrix::from_row_slice(2, 2, &[1.0, correlation, correlation, 1.0]);
            let factors = Factors {
                covariance: &covariance,
                tilt: |_, mean, variance| positive(mean, variance),
            };
            let exact = 0.25 + correlation.asin() / std::f64::consts::TAU;
            let found = Propagation::of(&factors, None).log.exp();
            assert!(
                (found / exact - 1.0).abs() < 0.04,
                "{correlation}: {found} {exact}"
            );
        }
    }

    #[test]
    fn valid_normal_factors_give_the_normal_integral() {
        // x = 1 ± 1 of a standard deviate x: mass of N(0, 2) at 1, mean 1/2, variance 1/2
        let covariance = DMatrix::identity(1, 1);
        let factors = Factors {
            covariance: &covariance,
            tilt: |_, mean: f64, variance: f64| {
                let all = 1.0 + variance;
                Tilt {
                    log: -0.5 * (all.ln() + (mean - 1.0).powi(2) / all),
                    slope: (1.0 - mean) / all,
                    curvature: -all.recip(),
                }
            },
        };
        let found = Propagation::of(&factors, None);
        assert!((found.log + 0.5 * (2f64.ln() + 0.5)).abs() < 1e-9);
        assert!(
            (found.mean[0] - 0.5).abs() < 1e-9 && (found.covariance[(0, 0)] - 0.5).abs() < 1e-9
        );
        let again = Propagation::of(&factors, Some(&found));
        assert!((again.log - found.log).abs() < 1e-9);
    }
}
