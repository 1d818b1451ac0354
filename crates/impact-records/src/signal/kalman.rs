//! The update of a state's mean and covariance by a measurement (Kalman 1960).

use nalgebra::{SMatrix, SVector};

/// What a measurement had new.
#[derive(Debug, Clone, Copy)]
pub struct Innovation {
    /// Its deviation from what the state foretold, over its standard deviation.
    pub relative: f64,
    /// The variance of that deviation.
    pub spread: f64,
}

/// Take a measurement of `row`·state with a variance into the state's mean and covariance; gives its innovation.
///
/// ```
/// use nalgebra::{SMatrix, SVector};
/// let (mut mean, mut covariance) = (SVector::<f64, 1>::zeros(), SMatrix::<f64, 1, 1>::identity());
/// let new = impact_records::signal::kalman::update(&mut mean, &mut covariance, SVector::from([1.0]), 2.0, 1.0);
/// assert_eq!((mean[0], covariance[0], new.spread), (1.0, 0.5, 2.0));
/// ```
pub fn update<const N: usize>(
    mean: &mut SVector<f64, N>,
    covariance: &mut SMatrix<f64, N, N>,
    row: SVector<f64, N>,
    value: f64,
    variance: f64,
) -> Innovation {
    let along = *covariance * row;
    let spread = row.dot(&along) + variance;
    let apart = value - row.dot(mean);
    let gain = along / spread;
    *mean += gain * apart;
    // Joseph's form, (1 − g hᵀ) P (1 − g hᵀ)ᵀ + v g gᵀ, which rounding cannot make indefinite.
    let once = *covariance - gain * along.transpose();
    *covariance = once + (gain * variance - once * row) * gain.transpose();
    Innovation {
        relative: apart / spread.sqrt(),
        spread,
    }
}
