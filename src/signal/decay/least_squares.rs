//! Separable least squares of a free decay: two rates common to all channels, an offset and two
//! amplitudes of each.

use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2, Vector3};

use super::Decay;
use super::structure;

/// The channels from the first fitted sample on, each with its weight, the inverse of its variance.
pub(super) type Signals<'a> = [(&'a [f64], f64)];

/// State of the search: `ω_d` and σ per sample with the best linear part of each channel.
#[derive(Debug, Clone)]
pub(super) struct Point {
    /// `ω_d` and σ, per sample.
    pub(super) rates: Vector2<f64>,
    linear: Vec<Vector3<f64>>,
    /// Weighted sum of squared residuals.
    pub(super) squares: f64,
}

fn basis(rates: Vector2<f64>, i: usize) -> Vector3<f64> {
    let t = i as f64;
    let envelope = (-rates[1] * t).exp();
    let (sin, cos) = (rates[0] * t).sin_cos();
    Vector3::new(1.0, envelope * cos, envelope * sin)
}

/// Slopes of the decay over `ω_d` and σ at a sample.
fn slopes(linear: &Vector3<f64>, row: &Vector3<f64>, i: usize) -> Vector2<f64> {
    let t = i as f64;
    Vector2::new(
        t * (linear[2] * row[1] - linear[1] * row[2]),
        -t * (linear[1] * row[1] + linear[2] * row[2]),
    )
}

/// Best offset and amplitudes of each channel at given rates (the linear part is projected out).
fn project(signals: &Signals<'_>, rates: Vector2<f64>) -> Option<Point> {
    let longest = signals.iter().map(|(tail, _)| tail.len()).max()?;
    let rows: Vec<Vector3<f64>> = (0..longest).map(|i| basis(rates, i)).collect();
    let mut squares = 0.0;
    let mut linear = Vec::with_capacity(signals.len());
    for (tail, weight) in signals {
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for (row, v) in rows.iter().zip(*tail) {
            normal += row * row.transpose();
            right += row * *v;
        }
        let own = normal.cholesky()?.solve(&right);
        let residual = |(row, v): (&Vector3<f64>, &f64)| (v - own.dot(row)).powi(2);
        squares += weight * rows.iter().zip(*tail).map(residual).sum::<f64>();
        linear.push(own);
    }
    Some(Point {
        rates,
        linear,
        squares,
    })
}

impl Point {
    /// Gauss–Newton equations of the rates.
    fn equations(&self, signals: &Signals<'_>) -> (Matrix2<f64>, Vector2<f64>) {
        let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
        for ((tail, weight), linear) in signals.iter().zip(&self.linear) {
            for (i, v) in tail.iter().enumerate() {
                let row = basis(self.rates, i);
                let slope = slopes(linear, &row, i);
                normal += slope * slope.transpose() * *weight;
                right += slope * ((v - linear.dot(&row)) * weight);
            }
        }
        (normal, right)
    }

    /// Residuals of a channel.
    pub(super) fn residuals(&self, channel: usize, tail: &[f64]) -> Vec<f64> {
        let linear = self.linear[channel];
        let of = |(i, v): (usize, &f64)| v - linear.dot(&basis(self.rates, i));
        tail.iter().enumerate().map(of).collect()
    }

    /// Natural frequency, Hz, and damping ratio.
    pub(super) fn natural(&self, rate_hz: f64) -> [f64; 2] {
        let (omega, sigma) = (self.rates[0], self.rates[1]);
        let natural = omega.hypot(sigma);
        [natural * rate_hz / std::f64::consts::TAU, sigma / natural]
    }

    /// Standard errors of natural frequency, Hz, and damping ratio from the rates' covariance.
    pub(super) fn errors(&self, covariance: &Matrix2<f64>, rate_hz: f64) -> [f64; 2] {
        let (omega, sigma) = (self.rates[0], self.rates[1]);
        let natural = omega.hypot(sigma);
        let to_natural = Vector2::new(omega, sigma) / natural;
        let to_beta = Vector2::new(-sigma * omega, omega * omega) / natural.powi(3);
        let error = |g: Vector2<f64>| (g.transpose() * covariance * g)[(0, 0)].max(0.0).sqrt();
        let to_hz = rate_hz / std::f64::consts::TAU;
        [error(to_natural) * to_hz, error(to_beta)]
    }

    /// The decay with the amplitudes of one of its channels; `None` if nothing decays.
    pub(super) fn decay(&self, tail: &[f64], rate_hz: f64) -> Option<Decay> {
        if self.rates[1] <= 0.0 {
            return None;
        }
        let own = project(&[(tail, 1.0)], self.rates)?;
        let linear = own.linear.first()?;
        let residuals = own.residuals(0, tail);
        let level = crate::signal::robust::rms(tail);
        let [natural_frequency_hz, damping_ratio] = self.natural(rate_hz);
        Some(Decay {
            natural_frequency_hz,
            natural_frequency_error_hz: 0.0,
            damping_ratio,
            damping_ratio_error: 0.0,
            amplitude: linear[1].hypot(linear[2]),
            phase_rad: (-linear[2]).atan2(linear[1]),
            offset: linear[0],
            residual_ratio: crate::signal::robust::rms(&residuals) / level,
            structured_ratio: structure::structured(&residuals) / level,
            drift: None,
            channel: 0,
            first: 0,
            samples: tail.len(),
        })
    }

    /// Covariance of the rates with every channel's own linear part free.
    pub(super) fn covariance(&self, signals: &Signals<'_>) -> Option<Matrix2<f64>> {
        let mut information = Matrix2::zeros();
        for ((tail, weight), linear) in signals.iter().zip(&self.linear) {
            let mut normal = SMatrix::<f64, 5, 5>::zeros();
            for i in 0..tail.len() {
                let row = basis(self.rates, i);
                let slope = slopes(linear, &row, i);
                let full = SVector::from([row[0], row[1], row[2], slope[0], slope[1]]);
                normal += full * full.transpose();
            }
            let own = normal.try_inverse()?;
            let of_rates: Matrix2<f64> = own.fixed_view::<2, 2>(3, 3).into_owned();
            information += of_rates.try_inverse()? * *weight;
        }
        information.try_inverse()
    }
}

/// The rates with the least weighted squares, by Levenberg and Marquardt.
pub(super) fn descend(signals: &Signals<'_>, start: Vector2<f64>) -> Option<Point> {
    let mut point = project(signals, start)?;
    let mut damping = 1e-3;
    for _ in 0..60 {
        let (normal, right) = point.equations(signals);
        let damped = normal + Matrix2::from_diagonal(&normal.diagonal()) * damping;
        let step = damped.try_inverse()? * right;
        match project(signals, point.rates + step) {
            Some(next) if next.squares <= point.squares && next.rates[0] > 0.0 => {
                let small = step.norm() < 1e-12 * point.rates[0];
                point = next;
                damping *= 0.2;
                if small {
                    break;
                }
            }
            _ if damping > 1e8 => break,
            _ => damping = (damping * 10.0).max(1e-6),
        }
    }
    Some(point)
}
