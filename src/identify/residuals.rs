//! The weighted residuals of each method at the fitted parameters, and how they hang together.

use crate::identify::evidence::{Blocks, Evidence};
use crate::identify::fit::Block;
use crate::identify::fit::parameters::Parameters;
use crate::identify::method::Method;
use crate::signal::robust;

/// Lags of the autocorrelation.
const LAGS: usize = 20;
/// Fewer residuals tell nothing.
const FEWEST: usize = 5;

/// The residuals of one method.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodResiduals {
    /// The method: resonance, trajectories or impacts.
    pub method: Method,
    /// Each residual over its standard error, with the index of its observation.
    pub residuals: Vec<(usize, f64)>,
    /// Their autocorrelation at lags 0, 1, 2 … up to twenty.
    pub autocorrelation: Vec<f64>,
}

/// Residuals at the fitted parameters of the methods that have five or more, without those of
/// observations that the fit left out.
pub fn residuals(
    evidence: &Evidence<'_>,
    fitted: &Parameters,
    left_out: impl Fn(usize) -> bool,
) -> Vec<MethodResiduals> {
    let mut evidence = *evidence;
    // effects of no strength change no residual
    evidence.nominal.effects = fitted.effects_present();
    let mut blocks = Blocks::new(&evidence);
    blocks.weigh(fitted);
    let resonance = blocks.resonance.points.iter().map(|p| p.observation);
    let trajectory = blocks.trajectory.records.iter().map(|r| r.observation);
    let impact = blocks.impact.pairs.iter().map(|p| p.observation);
    let of = |method, block: &dyn Block, owners: Vec<usize>| {
        let items = owners.into_iter().enumerate();
        let kept = items.filter(|(_, owner)| !left_out(*owner));
        let residuals: Vec<(usize, f64)> = kept
            .filter_map(|(item, owner)| Some((owner, block.residuals(item, fitted)?)))
            .flat_map(|(owner, list)| list.into_iter().map(move |r| (owner, r)))
            .collect();
        let values: Vec<f64> = residuals.iter().map(|r| r.1).collect();
        MethodResiduals {
            method,
            residuals,
            autocorrelation: autocorrelation(&values),
        }
    };
    let all = [
        of(Method::Resonance, &blocks.resonance, resonance.collect()),
        of(
            Method::Trajectories,
            &blocks.trajectory,
            trajectory.collect(),
        ),
        of(Method::Impacts, &blocks.impact, impact.collect()),
    ];
    let enough = |m: &MethodResiduals| m.residuals.len() >= FEWEST;
    all.into_iter().filter(enough).collect()
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
