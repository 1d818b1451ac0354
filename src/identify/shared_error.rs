//! Errors that all residuals of a record share: phase and frequency of its drive, as measured.
//!
//! With independent errors of unit size and shared ones along the columns of V, the covariance is
//! I + VVᵀ; residuals times its inverse root are independent again, and least squares on them is
//! the likelihood.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Make residuals with shared errors independent: r ← (I + VVᵀ)^(−1/2) r. Each column of V is the
/// change of all residuals by one standard error of what is shared.
pub fn whiten(residuals: Vec<f64>, shared: &[Vec<f64>]) -> Vec<f64> {
    if shared.is_empty() || residuals.is_empty() {
        return residuals;
    }
    let mut r = DVector::from_vec(residuals);
    let v = DMatrix::from_fn(r.len(), shared.len(), |i, k| shared[k][i]);
    let eigen = SymmetricEigen::new(v.tr_mul(&v));
    for (k, size) in eigen.eigenvalues.iter().enumerate() {
        if !(*size > 1e-12) {
            continue;
        }
        let direction = &v * eigen.eigenvectors.column(k) / size.sqrt();
        let kept = 1.0 - 1.0 / (1.0 + size).sqrt();
        let along = kept * direction.dot(&r);
        r.axpy(-along, &direction, 1.0);
    }
    r.as_slice().to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_whitening_is_the_inverse_root_of_the_covariance() {
        let shared = vec![vec![0.5, -2.0, 1.0], vec![3.0, 0.1, 0.4]];
        let v = DMatrix::from_fn(3, 2, |i, k| shared[k][i]);
        let covariance = DMatrix::identity(3, 3) + &v * v.transpose();
        let r = vec![1.0, -0.7, 2.5];
        let white = DVector::from_vec(whiten(r.clone(), &shared));
        let r = DVector::from_vec(r);
        let want = r.dot(&covariance.lu().solve(&r).unwrap_or_default());
        assert!((white.norm_squared() - want).abs() < 1e-12);
    }
}
