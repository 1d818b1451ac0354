//! Errors that all residuals of a record share: phase and frequency of its drive, as measured.
//!
//! With independent errors of unit size and shared ones along the columns of V, the covariance is
//! I + VVᵀ (13); residuals times its inverse root are independent again, and least squares on them is
//! the likelihood.

use crate::identify::fit::factor::dot;

/// The inverse root of I + VVᵀ, by its few directions: I − Σ kept·d dᵀ with orthonormal d.
#[derive(Debug, Clone, Default)]
pub struct Whitening {
    directions: Vec<(f64, Vec<f64>)>,
}

impl Whitening {
    /// Nothing is shared.
    pub fn none() -> Self {
        Self::default()
    }

    /// From the columns of V, at most two: each the change of all residuals by one standard error
    /// of what is shared.
    pub fn new(columns: Vec<Vec<f64>>) -> Self {
        let mut columns = columns;
        if let [a, b] = columns.as_mut_slice() {
            turn_orthogonal(a, b);
        }
        let directions = columns
            .into_iter()
            .filter_map(|mut column| {
                let size = dot(&column, &column);
                let length = size.sqrt();
                column.iter_mut().for_each(|c| *c /= length);
                (size > 1e-12).then(|| (1.0 - 1.0 / (1.0 + size).sqrt(), column))
            })
            .collect();
        Self { directions }
    }

    /// Make residuals independent, in place.
    pub fn apply(&self, residuals: &mut [f64]) {
        for (kept, direction) in &self.directions {
            let along = kept * dot(direction, residuals);
            for (r, d) in residuals.iter_mut().zip(direction) {
                *r -= along * d;
            }
        }
    }
}

/// Turn two columns into orthogonal ones with the same VVᵀ (one Jacobi rotation).
fn turn_orthogonal(a: &mut [f64], b: &mut [f64]) {
    let angle = 0.5 * (2.0 * dot(a, b)).atan2(dot(a, a) - dot(b, b));
    let (sin, cos) = angle.sin_cos();
    for (x, y) in a.iter_mut().zip(b) {
        (*x, *y) = (cos * *x + sin * *y, cos * *y - sin * *x);
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    #[test]
    fn valid_whitening_is_the_inverse_root_of_the_covariance() {
        let shared = vec![vec![0.5, -2.0, 1.0], vec![3.0, 0.1, 0.4]];
        let v = DMatrix::from_fn(3, 2, |i, k| shared[k][i]);
        let covariance = DMatrix::identity(3, 3) + &v * v.transpose();
        let r = vec![1.0, -0.7, 2.5];
        let mut white = r.clone();
        Whitening::new(shared).apply(&mut white);
        let r = DVector::from_vec(r);
        let want = r.dot(&covariance.lu().solve(&r).unwrap_or_default());
        assert!((dot(&white, &white) - want).abs() < 1e-12);
    }
}
