//! The weighted residuals of each method at the fitted parameters, and how they hang together.

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use impact_fit::method::Method;
use impact_fit::methods::blocks::Blocks;
use impact_fit::parameters::Parameters;
use impact_records::signal::robust;
use impact_records::signal::thinning::thinned;

/// Lags of the autocorrelation.
const LAGS: usize = 20;
/// Fewer residuals tell nothing.
const FEWEST: usize = 5;
/// Most residuals of one method that are kept.
const MOST: usize = 4000;

/// The residuals of one method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MethodResiduals {
    /// The method: resonance, trajectories or impacts.
    pub method: Method,
    /// Each residual over its standard error, with the index of its observation; of more than 4000
    /// every second, third …
    pub residuals: Vec<(usize, f64)>,
    /// Number of residuals.
    pub total: usize,
    /// Their autocorrelation at lags 0, 1, 2 … up to twenty.
    pub autocorrelation: Vec<f64>,
}

impl MethodResiduals {
    /// Of a method's block at parameters; `None` of too few.
    fn of(method: Method, blocks: &Blocks, at: &Parameters) -> Option<Self> {
        let block = blocks.of(method)?;
        let items = blocks.owners(method).into_par_iter().enumerate();
        let of_items: Vec<(usize, Vec<f64>)> = items
            .filter_map(|(item, owner)| Some((owner, block.residuals(item, at)?)))
            .collect();
        let each = of_items.iter();
        let all: Vec<(usize, f64)> = each
            .flat_map(|(owner, list)| list.iter().map(|r| (*owner, *r)))
            .collect();
        let values: Vec<f64> = all.iter().map(|r| r.1).collect();
        (all.len() >= FEWEST).then(|| Self {
            method,
            residuals: thinned(&all, MOST).copied().collect(),
            total: all.len(),
            autocorrelation: autocorrelation(&values),
        })
    }
}

/// Residuals of the resonance curve, the trajectories and the impacts at the fitted parameters, with
/// the weights of the fit; without a method that has fewer than five.
pub(super) fn residuals(blocks: &Blocks, fitted: &Parameters) -> Vec<MethodResiduals> {
    let each = Method::WITH_RESIDUALS.into_iter();
    let found = each.filter_map(|method| MethodResiduals::of(method, blocks, fitted));
    found.collect()
}

/// Autocorrelation at lags 0, 1, 2 …: Σ `r_i` r_(i+k) over Σ `r_i²`, mean removed, which of n white
/// residuals has the standard error 1/√n.
fn autocorrelation(values: &[f64]) -> Vec<f64> {
    let mean = robust::mean(values);
    let centred: Vec<f64> = values.iter().map(|v| v - mean).collect();
    let total: f64 = centred.iter().map(|v| v * v).sum();
    let at = |lag: usize| {
        let pairs = centred.iter().zip(&centred[lag..]);
        let product: f64 = pairs.map(|(a, b)| a * b).sum();
        if total > 0.0 { product / total } else { 0.0 }
    };
    (0..=LAGS.min(values.len().saturating_sub(1)))
        .map(at)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_residuals_that_alternate_are_anticorrelated() {
        let values: Vec<f64> = (0..100)
            .map(|i| if i % 2 == 0 { 1.5 } else { 0.5 })
            .collect();
        let found = autocorrelation(&values);
        assert_eq!(found.len(), LAGS + 1);
        assert!((found[0] - 1.0).abs() < 1e-12);
        assert!((found[1] + 0.99).abs() < 1e-12 && (found[2] - 0.98).abs() < 1e-12);
        assert_eq!(autocorrelation(&[2.0, 2.0]), [0.0, 0.0]);
    }
}
