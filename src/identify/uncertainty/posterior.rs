//! R from brackets alone: the posterior over R of all brackets as interval observations.
//!
//! A bracket says that a boundary lies between two settings and nothing more (14); its likelihood is
//! flat inside, so neither a least-squares optimum nor its curvature means anything. The
//! posterior is therefore summed over a grid of R and `x_st` (which the resonance curve determines), with
//! the scale of early jumps summed out; f0 and β are the resonance curve's.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::identify::evidence::boundary::{BoundaryBlock, bracket_probability, predicted_hz};
use crate::identify::fit::parameters::{Coordinate, Parameters};
use crate::motion::Bracket;

/// What brackets say of R and `x_st`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posterior {
    /// Posterior mean and standard deviation of R.
    pub restitution: (f64, f64),
    /// 95 % interval of R with equal tails.
    pub interval95: [f64; 2],
    /// Posterior mean and standard deviation of ln `x_st`.
    pub ln_deflection: (f64, f64),
}

/// Scales of early jumps that are summed over, relative to the frequency; each as likely before.
const EARLY_SCALES: [f64; 8] = [1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2];
/// Grid of ln `x_st` in its standard errors.
const DEFLECTION_NODES: [f64; 9] = [-3.0, -2.25, -1.5, -0.75, 0.0, 0.75, 1.5, 2.25, 3.0];
/// Points of the final grid of R.
const FINE: usize = 61;
/// Log-likelihood below the greatest at which the grid of R may end.
const NEGLIGIBLE: f64 = 9.0;

/// Posterior about parameters that the resonance curve determines, with the standard error of
/// ln `x_st`; `None` where no bracket determines R.
pub fn of_brackets(block: &BoundaryBlock, about: &Parameters, error: f64) -> Option<Posterior> {
    if !block.determines_restitution() {
        return None;
    }
    let centre = about.coordinate(Coordinate::Deflection);
    let at = |r: f64, node: f64| {
        let moved = about.with(Coordinate::Deflection, centre + node * error);
        likelihood(
            block,
            &Parameters {
                restitution: r,
                ..moved
            },
        )
    };
    let (low, high) = support(&|r| at(r, 0.0));
    let grid: Vec<f64> = (0..FINE)
        .map(|i| low + (high - low) * i as f64 / (FINE - 1) as f64)
        .collect();
    let cells: Vec<Vec<f64>> = grid
        .par_iter()
        .map(|r| {
            DEFLECTION_NODES
                .iter()
                .map(|node| at(*r, *node) - 0.5 * node * node)
                .collect()
        })
        .collect();
    Some(summed(&grid, &cells, (centre, error)))
}

/// Moments and quantiles of a posterior from its logarithm on the grid.
fn summed(grid: &[f64], cells: &[Vec<f64>], (centre, error): (f64, f64)) -> Posterior {
    let most = cells
        .iter()
        .flatten()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<Vec<f64>> = cells
        .iter()
        .map(|row| row.iter().map(|c| (c - most).exp()).collect())
        .collect();
    let over_r: Vec<f64> = weights.iter().map(|row| row.iter().sum()).collect();
    let over_nodes: Vec<f64> = (0..DEFLECTION_NODES.len())
        .map(|k| weights.iter().map(|row| row[k]).sum())
        .collect();
    let step = (grid[grid.len() - 1] - grid[0]) / (grid.len() - 1) as f64;
    let (mean, spread) = moments(grid, &over_r);
    let (node, node_spread) = moments(&DEFLECTION_NODES, &over_nodes);
    let node_step = DEFLECTION_NODES[1] - DEFLECTION_NODES[0];
    Posterior {
        // A cell of a grid stands for its whole width.
        restitution: (mean, spread.hypot(step / 12f64.sqrt())),
        interval95: [
            quantile(grid, &over_r, 0.025),
            quantile(grid, &over_r, 0.975),
        ],
        ln_deflection: (
            centre + node * error,
            node_spread.hypot(node_step / 12f64.sqrt()) * error,
        ),
    }
}

fn moments(values: &[f64], weights: &[f64]) -> (f64, f64) {
    let total: f64 = weights.iter().sum();
    let mean = |f: &dyn Fn(f64) -> f64| {
        let sum: f64 = values.iter().zip(weights).map(|(v, w)| w * f(*v)).sum();
        sum / total
    };
    let centre = mean(&|v| v);
    (centre, mean(&|v| (v - centre).powi(2)).sqrt())
}

/// Quantile of a density on an even grid, each point standing for a cell about it.
fn quantile(grid: &[f64], weights: &[f64], share: f64) -> f64 {
    let total: f64 = weights.iter().sum();
    let step = (grid[grid.len() - 1] - grid[0]) / (grid.len() - 1) as f64;
    let mut below = 0.0;
    for (value, weight) in grid.iter().zip(weights) {
        let next = below + weight / total;
        if next >= share && *weight > 0.0 {
            let inside = (share - below) / (next - below);
            return (value + (inside - 0.5) * step).clamp(0.0, 1.0);
        }
        below = next;
    }
    grid[grid.len() - 1]
}

/// The range of R that carries the likelihood: found on a coarse grid, refined, then widened
/// until it is negligible at both ends.
fn support(at: &(dyn Fn(f64) -> f64 + Sync)) -> (f64, f64) {
    let (mut low, mut high) = (0.0f64, 1.0f64);
    for count in [40u32, 20, 20] {
        let step = (high - low) / f64::from(count);
        let values: Vec<(f64, f64)> = (0..=count)
            .into_par_iter()
            .map(|i| low + step * f64::from(i))
            .map(|r| (r, at(r)))
            .collect();
        let most = values.iter().map(|v| v.1).fold(f64::NEG_INFINITY, f64::max);
        let heavy = values.iter().filter(|v| v.1 > most - NEGLIGIBLE);
        let (first, last) = heavy.fold((1.0f64, 0.0f64), |(a, b), v| (a.min(v.0), b.max(v.0)));
        (low, high) = ((first - step).max(0.0), (last + step).min(1.0));
    }
    (low, high.max(low + 1e-6))
}

/// Log-likelihood of all brackets. Each family of boundaries has its own scale of early jumps, which is
/// summed out: the end of z = 1, that of longer motions, doublings, grazing.
fn likelihood(block: &BoundaryBlock, parameters: &Parameters) -> f64 {
    let mut families: BTreeMap<(&str, bool), Vec<(&Bracket, f64)>> = BTreeMap::new();
    for bracket in &block.brackets {
        // A boundary that does not reach the clearance is as one far away.
        let place = predicted_hz(bracket, parameters, block.rig).unwrap_or(f64::INFINITY);
        let family = (bracket.kind.name(), bracket.periods_n > 1);
        families.entry(family).or_default().push((bracket, place));
    }
    families
        .values()
        .map(|places| summed_over_scales(places))
        .sum()
}

/// Log-likelihood of brackets whose boundaries lie at given frequencies, Hz.
fn summed_over_scales(places: &[(&Bracket, f64)]) -> f64 {
    let of_scale = |scale: &f64| -> f64 {
        let probabilities = places
            .iter()
            .map(|(b, f)| bracket_probability(b, *scale, *f));
        probabilities.map(f64::ln).sum()
    };
    let logs: Vec<f64> = EARLY_SCALES.iter().map(of_scale).collect();
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    most + logs.iter().map(|l| (l - most).exp()).sum::<f64>().ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_moments_of_three_weights() {
        // weights 1, 2, 1 at 0, 1, 2: mean 1, variance (1·1 + 2·0 + 1·1)/4 = 1/2
        let (mean, deviation) = moments(&[0.0, 1.0, 2.0], &[1.0, 2.0, 1.0]);
        assert!((mean - 1.0).abs() < 1e-15 && (deviation - 0.5f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn valid_quantiles_of_an_even_density_are_those_of_a_line() {
        // ten cells of width 0.1 about 0.05, 0.15 … 0.95: the density is even over 0 to 1
        let grid: Vec<f64> = (0..10).map(|i| 0.05 + 0.1 * f64::from(i)).collect();
        for share in [0.025, 0.31, 0.5, 0.975] {
            let found = quantile(&grid, &[1.0; 10], share);
            assert!((found - share).abs() < 1e-12, "{share} {found}");
        }
    }

    #[test]
    fn valid_a_normal_likelihood_gives_back_its_mean_and_deviation() {
        // R 0.8 ± 0.02 and ln x_st without information: its own prior, a normal one, comes back
        let grid: Vec<f64> = (0..FINE).map(|i| 0.7 + 0.2 * i as f64 / 60.0).collect();
        let cells: Vec<Vec<f64>> = grid
            .iter()
            .map(|r| {
                let of_r = -0.5 * ((r - 0.8) / 0.02).powi(2);
                let nodes = DEFLECTION_NODES.iter();
                nodes.map(|node| of_r - 0.5 * node * node).collect()
            })
            .collect();
        let found = summed(&grid, &cells, (-7.0, 0.1));
        let (mean, deviation) = found.restitution;
        assert!(
            (mean - 0.8).abs() < 1e-9 && (deviation - 0.02).abs() < 1e-4,
            "{found:?}"
        );
        let [low, high] = found.interval95;
        assert!((low - 0.8 + 0.0392).abs() < 5e-4 && (high - 0.8 - 0.0392).abs() < 5e-4);
        assert!((found.ln_deflection.0 + 7.0).abs() < 1e-9);
        assert!((found.ln_deflection.1 - 0.1).abs() < 0.004, "{found:?}");
    }

    #[test]
    fn the_support_of_a_narrow_likelihood_is_found_and_kept() {
        let at = |r: f64| -0.5 * ((r - 0.613) / 1e-3).powi(2);
        let (low, high) = support(&at);
        // 4.24 deviations are negligible (9 below the greatest)
        assert!(
            low < 0.613 - 4.2e-3 && high > 0.613 + 4.2e-3,
            "{low} {high}"
        );
        assert!(high - low < 0.05, "{low} {high}");
    }
}
