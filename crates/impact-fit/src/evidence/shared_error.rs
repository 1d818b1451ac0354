//! Errors that all residuals of a record share: phase and frequency of its drive as measured, and its
//! clearance where no other record has the same.
//!
//! With independent errors of unit size and shared ones along the columns of V, the covariance is
//! I + `VVᵀ` (13); residuals times its inverse root are independent again, and least squares on them is
//! the likelihood.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use impact_records::signal::columns::{dot, subtract};

/// The inverse root of I + `VVᵀ`, by its few directions: I − Σ kept·d dᵀ with orthonormal d.
#[derive(Debug, Clone, Default)]
pub struct Whitening {
    directions: Vec<(f64, Vec<f64>)>,
}

impl Whitening {
    /// Nothing is shared.
    pub fn none() -> Self {
        Self::default()
    }

    /// From the columns of V: each the change of all residuals by one standard error of what is
    /// shared.
    pub fn new(columns: &[Vec<f64>]) -> Self {
        let count = columns.len();
        if count == 0 {
            return Self::none();
        }
        let gram = DMatrix::from_fn(count, count, |i, k| dot(&columns[i], &columns[k]));
        let Some(axes) = SymmetricEigen::try_new(gram, f64::EPSILON, 1000) else {
            return Self::none();
        };
        let directions = axes.eigenvalues.iter().zip(axes.eigenvectors.column_iter());
        let directions = directions.filter(|(size, _)| **size > 1e-12);
        let directions = directions.map(|(size, axis)| {
            let mut direction = vec![0.0; columns[0].len()];
            for (column, share) in columns.iter().zip(axis.iter()) {
                let share = share / size.sqrt();
                let pairs = direction.iter_mut().zip(column);
                pairs.for_each(|(d, c)| *d += share * c);
            }
            (1.0 - 1.0 / (1.0 + size).sqrt(), direction)
        });
        Self {
            directions: directions.collect(),
        }
    }

    /// How much of the sum of squares of residuals shared errors along the columns of V explain:
    /// rᵀV(I + `VᵀV`)⁻¹Vᵀr.
    pub fn explained(columns: &[Vec<f64>], residuals: &[f64]) -> f64 {
        let count = columns.len();
        if count == 0 {
            return 0.0;
        }
        let along = DVector::from_iterator(count, columns.iter().map(|c| dot(c, residuals)));
        let unit = |i: usize, k: usize| if i == k { 1.0 } else { 0.0 };
        let gram = |i: usize, k: usize| unit(i, k) + dot(&columns[i], &columns[k]);
        let factor = DMatrix::from_fn(count, count, gram).cholesky();
        factor.map_or(0.0, |factor| along.dot(&factor.solve(&along)))
    }

    /// The directions that are shared.
    pub fn directions(&self) -> impl Iterator<Item = &Vec<f64>> {
        self.directions.iter().map(|(_, direction)| direction)
    }

    /// The same along other directions, one for each of these.
    #[must_use]
    pub fn along(&self, directions: Vec<Vec<f64>>) -> Self {
        let kept = self.directions.iter().map(|(kept, _)| *kept);
        Self {
            directions: kept.zip(directions).collect(),
        }
    }

    /// Make residuals independent, in place.
    pub fn apply(&self, residuals: &mut [f64]) {
        for (kept, direction) in &self.directions {
            let along = kept * dot(direction, residuals);
            subtract(residuals, along, direction);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_whitening_is_the_inverse_root_of_the_covariance() {
        let shared = [
            vec![0.5, -2.0, 1.0],
            vec![3.0, 0.1, 0.4],
            vec![0.3, 0.2, -1.5],
        ];
        let v = DMatrix::from_fn(3, 3, |i, k| shared[k][i]);
        let covariance = DMatrix::identity(3, 3) + &v * v.transpose();
        let r = vec![1.0, -0.7, 2.5];
        let mut white = r.clone();
        Whitening::new(&shared).apply(&mut white);
        let r = DVector::from_vec(r);
        let want = r.dot(&covariance.lu().solve(&r).unwrap_or_default());
        assert!((dot(&white, &white) - want).abs() < 1e-12);
        let left = r.norm_squared() - Whitening::explained(&shared, r.as_slice());
        assert!((left - want).abs() < 1e-12);
    }
}
