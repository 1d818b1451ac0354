//! Weighted means of measurements, with the greater of their own error and their scatter.

use super::scatter::Spread;

/// A measurement with its standard error, and the degrees of freedom of that.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measured {
    /// Value.
    pub value: f64,
    /// Standard error.
    pub error: f64,
    /// Degrees of freedom of the error.
    pub freedom: f64,
}

/// Mean by weights; its error is the greater of that by the measurements' own errors and that by their scatter.
pub fn mean(values: &[Measured], weights: &[f64]) -> (f64, Spread) {
    let all: f64 = weights.iter().sum();
    let pairs = || values.iter().zip(weights.iter().map(|w| w / all));
    let mean: f64 = pairs().map(|(m, w)| w * m.value).sum();
    let variance: f64 = pairs().map(|(m, w)| (w * m.error).powi(2)).sum();
    let inner = Spread {
        freedom: values.iter().map(|m| m.freedom).sum(),
        ..Spread::known(variance.sqrt())
    };
    if values.len() < 2 {
        return (mean, inner);
    }
    let freedom = (values.len() - 1) as f64;
    let chi: f64 = values
        .iter()
        .map(|m| ((m.value - mean) / m.error).powi(2))
        .sum();
    let outer = Spread {
        freedom,
        ..Spread::known(inner.error * (chi / freedom).sqrt())
    };
    let widest = if outer.error > inner.error {
        outer
    } else {
        inner
    };
    (mean, widest)
}

/// Weights of the least error.
pub fn by_errors(values: &[Measured]) -> Vec<f64> {
    values.iter().map(|m| m.error.powi(-2)).collect()
}
