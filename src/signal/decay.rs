//! A free decay: offset + e^{−σt}(a cos `ω_d` t + b sin `ω_d` t), fitted by least squares.

use super::whole;
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

/// A fitted free decay.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Decay {
    /// Natural frequency f0 = √(σ² + `ω_d²)/2π`, Hz.
    pub natural_frequency_hz: f64,
    /// Its standard error, Hz.
    pub natural_frequency_error_hz: f64,
    /// Damping ratio β = σ/√(σ² + `ω_d²`).
    pub damping_ratio: f64,
    /// Its standard error.
    pub damping_ratio_error: f64,
    /// Amplitude at the first fitted sample, the samples' unit.
    pub amplitude: f64,
    /// Phase of the cosine there, rad.
    pub phase_rad: f64,
    /// Constant part, the samples' unit.
    pub offset: f64,
    /// Root mean square of the residual over that of the signal.
    pub residual_ratio: f64,
    /// First fitted sample.
    pub first: usize,
    /// Number of fitted samples.
    pub samples: usize,
}

impl Decay {
    /// The fitted decay at each of its samples, from the first fitted one on.
    pub fn values(&self, rate_hz: f64) -> Vec<f64> {
        let natural = std::f64::consts::TAU * self.natural_frequency_hz / rate_hz;
        let sigma = self.damping_ratio * natural;
        let omega = natural * (1.0 - self.damping_ratio.powi(2)).max(0.0).sqrt();
        let at = |i: usize| {
            let t = i as f64;
            let envelope = self.amplitude * (-sigma * t).exp();
            self.offset + envelope * (omega * t + self.phase_rad).cos()
        };
        (0..self.samples).map(at).collect()
    }
}

/// Earliest start of a fit, s from the first sample: records of a blow are triggered by it.
const FROM_S: f64 = 0.1;
/// Least time between the blow and the start of a fit, s.
const WAIT_S: f64 = 0.05;
/// Further starts within one period that show how far the answer depends on the start.
const OTHER_STARTS: usize = 4;

/// Fit the free decay that follows the greatest excursion of the samples.
///
/// The fit begins 0.1 s into the record, and at least 0.05 s after the blow. Fits from later
/// starts within one period show how much another mode or a drift changes the result; their spread
/// is part of the standard errors. `None` with fewer than three periods to fit, or if nothing
/// decays.
///
/// ```
/// use impactid::signal::decay;
///
/// // f0 = 14 Hz, β = 0.02, released at t = 0.
/// let natural = std::f64::consts::TAU * 14.0;
/// let damped = natural * f64::sqrt(1.0 - 0.02 * 0.02);
/// let value = |t: f64| (-0.02 * natural * t).exp() * (damped * t).cos();
/// let samples: Vec<f64> = (0..2000).map(|i| value(f64::from(i) / 1000.0)).collect();
/// let found = decay::fit(&samples, 1000.0).unwrap();
/// assert!((found.natural_frequency_hz - 14.0).abs() < 1e-6);
/// assert!((found.damping_ratio - 0.02).abs() < 1e-6);
/// ```
pub fn fit(samples: &[f64], rate_hz: f64) -> Option<Decay> {
    let centre = super::robust::median(samples)?;
    let peak = samples
        .iter()
        .enumerate()
        .max_by(|a, b| (a.1 - centre).abs().total_cmp(&(b.1 - centre).abs()))?
        .0;
    let wait = whole::index((WAIT_S * rate_hz).ceil());
    let first = (peak + wait).max(whole::index((FROM_S * rate_hz).ceil()));
    let tail = samples.get(first..)?;
    let frequency_hz = super::spectrum::peak_frequency(tail)? * rate_hz;
    let period = rate_hz / frequency_hz;
    let others = (1..=OTHER_STARTS)
        .map(|k| whole::index((period * k as f64 / OTHER_STARTS as f64).round()))
        .filter_map(|skip| fit_tail(tail.get(skip..)?, rate_hz, frequency_hz));
    let mut decay = fit_tail(tail, rate_hz, frequency_hz)?;
    let (mut of_frequency, mut of_damping, mut count) = (0.0, 0.0, 0.0);
    for other in others {
        of_frequency += (other.natural_frequency_hz - decay.natural_frequency_hz).powi(2);
        of_damping += (other.damping_ratio - decay.damping_ratio).powi(2);
        count += 1.0;
    }
    let spread = |squares: f64| (squares / f64::max(count, 1.0)).sqrt();
    decay.natural_frequency_error_hz = decay.natural_frequency_error_hz.hypot(spread(of_frequency));
    decay.damping_ratio_error = decay.damping_ratio_error.hypot(spread(of_damping));
    decay.first = first;
    Some(decay)
}

fn fit_tail(tail: &[f64], rate_hz: f64, frequency_hz: f64) -> Option<Decay> {
    if (tail.len() as f64) < 3.0 * rate_hz / frequency_hz {
        return None;
    }
    let omega = frequency_hz * std::f64::consts::TAU / rate_hz;
    [0.005, 0.02, 0.08]
        .into_iter()
        .filter_map(|beta| descend(tail, Vector2::new(omega, beta * omega)))
        .min_by(|a, b| a.squares.total_cmp(&b.squares))?
        .finish(tail, rate_hz)
}

/// State of the search: `ω_d` and σ per sample with the best linear part.
struct Point {
    rates: Vector2<f64>,
    linear: Vector3<f64>,
    squares: f64,
}

fn basis(rates: Vector2<f64>, i: usize) -> Vector3<f64> {
    let t = i as f64;
    let envelope = (-rates[1] * t).exp();
    let (sin, cos) = (rates[0] * t).sin_cos();
    Vector3::new(1.0, envelope * cos, envelope * sin)
}

/// Best offset and amplitudes at given rates (the linear part is projected out).
fn project(tail: &[f64], rates: Vector2<f64>) -> Option<Point> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (i, v) in tail.iter().enumerate() {
        let row = basis(rates, i);
        normal += row * row.transpose();
        right += row * *v;
    }
    let linear = normal.cholesky()?.solve(&right);
    let squares = tail
        .iter()
        .enumerate()
        .map(|(i, v)| (v - linear.dot(&basis(rates, i))).powi(2))
        .sum();
    Some(Point {
        rates,
        linear,
        squares,
    })
}

impl Point {
    /// Gauss–Newton equations of the rates.
    fn equations(&self, tail: &[f64]) -> (Matrix2<f64>, Vector2<f64>) {
        let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
        for (i, v) in tail.iter().enumerate() {
            let row = basis(self.rates, i);
            let t = i as f64;
            let slope = Vector2::new(
                t * (self.linear[2] * row[1] - self.linear[1] * row[2]),
                -t * (self.linear[1] * row[1] + self.linear[2] * row[2]),
            );
            normal += slope * slope.transpose();
            right += slope * (v - self.linear.dot(&row));
        }
        (normal, right)
    }

    fn finish(&self, tail: &[f64], rate_hz: f64) -> Option<Decay> {
        let (omega, sigma) = (self.rates[0], self.rates[1]);
        let natural = omega.hypot(sigma);
        let covariance = self.covariance(tail)?;
        let to_natural = Vector2::new(omega, sigma) / natural;
        let to_beta = Vector2::new(-sigma * omega, omega * omega) / natural.powi(3);
        let error = |g: Vector2<f64>| (g.transpose() * covariance * g)[(0, 0)].max(0.0).sqrt();
        let to_hz = rate_hz / std::f64::consts::TAU;
        let level = super::robust::rms(tail);
        (sigma > 0.0).then(|| Decay {
            natural_frequency_hz: natural * to_hz,
            natural_frequency_error_hz: error(to_natural) * to_hz,
            damping_ratio: sigma / natural,
            damping_ratio_error: error(to_beta),
            amplitude: self.linear[1].hypot(self.linear[2]),
            phase_rad: (-self.linear[2]).atan2(self.linear[1]),
            offset: self.linear[0],
            residual_ratio: (self.squares / tail.len() as f64).sqrt() / level,
            first: 0,
            samples: tail.len(),
        })
    }

    /// Covariance of the rates from the full five-parameter Jacobian, widened for the
    /// autocorrelation of the residuals.
    fn covariance(&self, tail: &[f64]) -> Option<Matrix2<f64>> {
        let mut normal = nalgebra::SMatrix::<f64, 5, 5>::zeros();
        let mut residuals = Vec::with_capacity(tail.len());
        for (i, v) in tail.iter().enumerate() {
            let row = basis(self.rates, i);
            let t = i as f64;
            let full = nalgebra::SVector::<f64, 5>::from([
                row[0],
                row[1],
                row[2],
                t * (self.linear[2] * row[1] - self.linear[1] * row[2]),
                -t * (self.linear[1] * row[1] + self.linear[2] * row[2]),
            ]);
            normal += full * full.transpose();
            residuals.push(v - self.linear.dot(&row));
        }
        let variance = self.squares / (tail.len() - 5) as f64;
        let inverse = normal.try_inverse()? * (variance * correlation_factor(&residuals));
        Some(inverse.fixed_view::<2, 2>(3, 3).into_owned())
    }
}

/// Factor on a variance for residuals with autocorrelation: 1 + 2 Σ `r_k` until `r_k` falls to zero.
fn correlation_factor(residuals: &[f64]) -> f64 {
    let total: f64 = residuals.iter().map(|r| r * r).sum();
    let mut factor = 1.0;
    for lag in 1..residuals.len() / 4 {
        let product: f64 = residuals
            .iter()
            .zip(&residuals[lag..])
            .map(|(a, b)| a * b)
            .sum();
        if product <= 0.0 {
            break;
        }
        factor += 2.0 * product / total;
    }
    factor
}

fn descend(tail: &[f64], start: Vector2<f64>) -> Option<Point> {
    let mut point = project(tail, start)?;
    let mut damping = 1e-3;
    for _ in 0..60 {
        let (normal, right) = point.equations(tail);
        let damped = normal + Matrix2::from_diagonal(&normal.diagonal()) * damping;
        let step = damped.try_inverse()? * right;
        match project(tail, point.rates + step) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_a_noise_free_decay_is_recovered() {
        let (rate, f0, beta) = (1652.9, 14.3, 0.0183);
        let natural = std::f64::consts::TAU * f0;
        let damped = natural * f64::sqrt(1.0 - beta * beta);
        let samples: Vec<f64> = (0..2048)
            .map(|i| (f64::from(i) - 10.0) / rate)
            .map(|t| {
                if t < 0.0 {
                    0.2
                } else {
                    0.2 + 3.0 * (-beta * natural * t).exp() * (damped * t).cos()
                }
            })
            .collect();
        let decay = fit(&samples, rate).unwrap();
        assert!((decay.natural_frequency_hz / f0 - 1.0).abs() < 1e-8);
        assert!((decay.damping_ratio / beta - 1.0).abs() < 1e-6);
        assert!((decay.offset - 0.2).abs() < 1e-8);
        let fitted = decay.values(rate);
        assert_eq!(fitted.len(), decay.samples);
        let measured = samples[decay.first..].iter().zip(&fitted);
        assert!(measured.clone().all(|(m, f)| (m - f).abs() < 1e-7));
    }
}
