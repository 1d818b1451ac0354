//! f0 and β of the rates of a fit.

use nalgebra::DMatrix;

use super::shape::Rates;

/// Growth, in standard errors of the rate, that no decay has.
pub(super) const GROWS: f64 = 3.5;

/// f0, per sample, and β of a fit, with their standard errors.
pub(super) struct Natural {
    pub(super) frequency: f64,
    pub(super) frequency_error: f64,
    pub(super) damping_ratio: f64,
    pub(super) damping_ratio_error: f64,
}

impl Natural {
    /// Of rates with their covariance.
    pub(super) fn of(rates: &Rates, covariance: &DMatrix<f64>) -> Self {
        let [omega, sigma, ..] = *rates;
        let natural = omega.hypot(sigma);
        let error = |to: [f64; 2]| {
            let variance = to[0] * to[0] * covariance[(0, 0)]
                + 2.0 * to[0] * to[1] * covariance[(0, 1)]
                + to[1] * to[1] * covariance[(1, 1)];
            variance.max(0.0).sqrt()
        };
        let turn = std::f64::consts::TAU;
        Self {
            frequency: natural / turn,
            frequency_error: error([omega / natural, sigma / natural]) / turn,
            damping_ratio: sigma / natural,
            damping_ratio_error: error(damping_slopes(rates)),
        }
    }
}

/// Slopes of β = σ/√(σ² + `ω_d²`) over `ω_d` and σ.
pub(super) fn damping_slopes(rates: &Rates) -> [f64; 2] {
    let [omega, sigma, ..] = *rates;
    let cubed = omega.hypot(sigma).powi(3);
    [-sigma * omega / cubed, omega * omega / cubed]
}
