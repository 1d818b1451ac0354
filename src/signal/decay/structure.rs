//! What the residuals of a free decay have beside noise, and whether its frequency drifts.

use serde::{Deserialize, Serialize};

use super::least_squares::{Point, Signals, descend};

/// Parts of a decay whose frequencies are compared.
const PARTS: usize = 4;
/// Fewest periods of a part.
const PERIODS_OF_A_PART: f64 = 2.0;

/// Frequency at the beginning and at the end of a decay.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Drift {
    /// Natural frequency in the first quarter, Hz, on a line through those of all quarters.
    pub first_hz: f64,
    /// The same in the last quarter, Hz.
    pub last_hz: f64,
    /// Standard error of their difference, Hz.
    pub error_hz: f64,
}

impl Drift {
    /// The change over its standard error.
    pub fn z_score(&self) -> f64 {
        (self.last_hz - self.first_hz) / self.error_hz.max(f64::MIN_POSITIVE)
    }
}

/// The drift of a decay over its quarters; `None` if these are too short.
pub(super) fn drift(signals: &Signals<'_>, whole: &Point, rate_hz: f64) -> Option<Drift> {
    let samples = signals.iter().map(|(tail, _)| tail.len()).min()?;
    let length = samples / PARTS;
    let period = std::f64::consts::TAU / whole.rates[0];
    if (length as f64) < PERIODS_OF_A_PART * period {
        return None;
    }
    let mut parts = Vec::with_capacity(PARTS);
    for k in 0..PARTS {
        let part: Vec<(&[f64], f64)> = signals
            .iter()
            .map(|(tail, weight)| (&tail[k * length..(k + 1) * length], *weight))
            .collect();
        let found = descend(&part, whole.rates)?;
        let covariance = found.covariance(&part)?;
        let [frequency_hz, _] = found.natural(rate_hz);
        let [error_hz, _] = found.errors(&covariance, rate_hz);
        parts.push((k as f64, frequency_hz, error_hz.max(f64::MIN_POSITIVE)));
    }
    Some(line(&parts))
}

/// A weighted line through the parts; its standard error is widened by what it does not explain.
fn line(parts: &[(f64, f64, f64)]) -> Drift {
    let sum = |of: &dyn Fn(&(f64, f64, f64)) -> f64| -> f64 { parts.iter().map(of).sum() };
    let weight = |p: &(f64, f64, f64)| p.2.powi(-2);
    let all = sum(&weight);
    let centre = sum(&|p| weight(p) * p.0) / all;
    let mean = sum(&|p| weight(p) * p.1) / all;
    let spread = sum(&|p| weight(p) * (p.0 - centre).powi(2));
    let slope = sum(&|p| weight(p) * (p.0 - centre) * (p.1 - mean)) / spread;
    let off = sum(&|p| weight(p) * (p.1 - mean - slope * (p.0 - centre)).powi(2));
    let freedom = parts.len().saturating_sub(2).max(1) as f64;
    let (first, last) = (0.0, parts.len().saturating_sub(1) as f64);
    Drift {
        first_hz: mean + slope * (first - centre),
        last_hz: mean + slope * (last - centre),
        error_hz: (last - first) * ((off / freedom).max(1.0) / spread).sqrt(),
    }
}

/// Root mean square of the part of residuals that neighbours share. White noise has a mean squared
/// difference of neighbours of twice its variance (von Neumann's ratio); what is above that is structure.
pub(super) fn structured(residuals: &[f64]) -> f64 {
    let count = residuals.len().max(2) as f64;
    let all = residuals.iter().map(|r| r * r).sum::<f64>() / count;
    let steps: f64 = residuals.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum();
    (all - 0.5 * steps / (count - 1.0)).max(0.0).sqrt()
}

/// Factor on a variance for residuals with autocorrelation: 1 + 2 Σ `r_k` until `r_k` falls to zero.
pub(super) fn correlation_factor(residuals: &[f64]) -> f64 {
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
