//! R from brackets alone: the posterior over R of all brackets as interval observations.
//!
//! A bracket says that a boundary lies between two settings and nothing more (14); its likelihood is
//! flat inside, so neither a least-squares optimum nor its curvature means anything. The
//! posterior is therefore summed over a grid of R and `x_st` (which the resonance curve determines), with
//! the scale of early jumps summed out; f0 and β are the resonance curve's.
//!
//! Jumps that are all early by much the same look like jumps at the boundaries of a lower R: brackets
//! alone cannot tell the two apart. Where the waveforms determine an R that the brackets miss, and that
//! early jumps explain, the brackets therefore say from one side only where the boundaries lie.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::identify::evidence::boundary::{BoundaryBlock, bracket_probability, predicted_hz};
use crate::identify::fit::parameters::{Coordinate, Parameters};
use crate::motion::{BoundaryKind, Bracket};

/// What brackets say of R and `x_st`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posterior {
    /// Posterior mean and standard deviation of R.
    pub restitution: (f64, f64),
    /// 95 % interval of R with equal tails.
    pub interval95: [f64; 2],
    /// Posterior mean and standard deviation of ln `x_st`.
    pub ln_deflection: (f64, f64),
    /// Mean distance of the ends of z = 1 from s2, relative to its frequency, where the waveforms show that
    /// they are early.
    pub early: Option<f64>,
}

/// Scales of early jumps that are summed over, relative to the frequency; each as likely before.
const EARLY_SCALES: [f64; 8] = [1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2];
/// A scale so long that no distance of an early jump is more likely than another.
const ANY_DISTANCE: [f64; 1] = [1.0];
/// Deviations by which brackets miss the waveforms' R before their jumps count as early.
const MISSED: f64 = 3.0;
/// Grid of ln `x_st` in its standard errors.
const DEFLECTION_NODES: [f64; 9] = [-3.0, -2.25, -1.5, -0.75, 0.0, 0.75, 1.5, 2.25, 3.0];
/// Points of the final grid of R.
const FINE: usize = 61;
/// Log-likelihood below the greatest at which the grid of R may end.
const NEGLIGIBLE: f64 = 9.0;

/// Posterior about parameters that the resonance curve determines, with the standard error of
/// ln `x_st`; `None` where no bracket determines R. `waveforms`: parameters that the waveforms determine.
pub fn of_brackets(
    block: &BoundaryBlock,
    about: (&Parameters, f64),
    waveforms: Option<&Parameters>,
) -> Option<Posterior> {
    if !block.determines_restitution() {
        return None;
    }
    let found = over_grid(block, about, &EARLY_SCALES);
    let (mean, deviation) = found.restitution;
    let missed = waveforms.filter(|p| (p.restitution - mean).abs() > MISSED * deviation);
    let early = missed.and_then(|p| early_jumps(block, about, p));
    Some(early.unwrap_or(found))
}

/// Posterior where a jump may come at any distance before its boundary; `None` where that does not
/// explain what the brackets are off the waveforms.
fn early_jumps(
    block: &BoundaryBlock,
    about: (&Parameters, f64),
    waveforms: &Parameters,
) -> Option<Posterior> {
    let found = over_grid(block, about, &ANY_DISTANCE);
    let [low, high] = found.interval95;
    let early = mean_distance(block, waveforms);
    (low..=high)
        .contains(&waveforms.restitution)
        .then_some(Posterior { early, ..found })
}

/// Posterior with jumps of these scales.
fn over_grid(
    block: &BoundaryBlock,
    (about, error): (&Parameters, f64),
    scales: &[f64],
) -> Posterior {
    let centre = about.coordinate(Coordinate::Deflection);
    let at = |r: f64, node: f64| {
        let moved = about.with(Coordinate::Deflection, centre + node * error);
        let parameters = Parameters {
            restitution: r,
            ..moved
        };
        likelihood(block, &parameters, scales)
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
    summed(&grid, &cells, (centre, error))
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
        early: None,
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
fn likelihood(block: &BoundaryBlock, parameters: &Parameters, scales: &[f64]) -> f64 {
    let mut families: BTreeMap<(&str, bool), Vec<(&Bracket, f64)>> = BTreeMap::new();
    for bracket in &block.brackets {
        // A boundary that does not reach the clearance is as one far away.
        let place = predicted_hz(bracket, parameters, block.rig).unwrap_or(f64::INFINITY);
        let family = (bracket.kind.name(), bracket.periods_n > 1);
        families.entry(family).or_default().push((bracket, place));
    }
    families
        .values()
        .map(|places| summed_over(places, scales))
        .sum()
}

/// Log-likelihood of brackets whose boundaries lie at given frequencies, Hz.
fn summed_over(places: &[(&Bracket, f64)], scales: &[f64]) -> f64 {
    let of_scale = |scale: &f64| -> f64 {
        let probabilities = places
            .iter()
            .map(|(b, f)| bracket_probability(b, *scale, *f));
        probabilities.map(f64::ln).sum()
    };
    let logs: Vec<f64> = scales.iter().map(of_scale).collect();
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    most + logs.iter().map(|l| (l - most).exp()).sum::<f64>().ln()
}

/// Mean distance of the ends of z = 1 from their s2, relative to its frequency.
fn mean_distance(block: &BoundaryBlock, parameters: &Parameters) -> Option<f64> {
    let ends = |b: &&Bracket| b.kind == BoundaryKind::SaddleNode && b.periods_n == 1;
    let distance = |b: &Bracket| {
        let place = predicted_hz(b, parameters, block.rig)?;
        Some((place - b.middle_hz()).abs() / place)
    };
    let distances: Vec<f64> = block
        .brackets
        .iter()
        .filter(ends)
        .filter_map(distance)
        .collect();
    let count = distances.len();
    (count > 0).then(|| distances.iter().sum::<f64>() / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::RigKind;
    use crate::identify::evidence::boundary::tests::bracket;

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

    /// Brackets of s2 at five η of a rig with R = 0.7, 2 % wide: the jumps end this share before s2.
    fn ending(early: f64) -> (BoundaryBlock, Parameters) {
        let p = Parameters::symmetric(0.7, 12.6, 0.05, 1e-3);
        let half_widths = early / 0.01;
        let brackets = [1.1, 1.2, 1.3, 1.4, 1.5]
            .map(|eta| bracket(BoundaryKind::SaddleNode, eta, &p, half_widths));
        (BoundaryBlock::new(RigKind::Double, &brackets), p)
    }

    #[test]
    fn valid_jumps_all_early_hold_r_once_the_waveforms_show_them() {
        let (block, p) = ending(0.08);
        let alone = of_brackets(&block, (&p, 1e-3), None).unwrap();
        assert!(
            alone.interval95[1] < 0.7 && alone.early.is_none(),
            "{alone:?}"
        );
        let beside = of_brackets(&block, (&p, 1e-3), Some(&p)).unwrap();
        let [low, high] = beside.interval95;
        assert!(low < 0.7 && 0.7 < high, "{beside:?}");
        assert!((beside.early.unwrap() - 0.08).abs() < 1e-9);
    }

    #[test]
    fn valid_jumps_that_are_late_contradict_the_waveforms() {
        let (block, p) = ending(-0.04);
        let beside = of_brackets(&block, (&p, 1e-3), Some(&p)).unwrap();
        assert!(
            beside.interval95[0] > 0.7 && beside.early.is_none(),
            "{beside:?}"
        );
    }

    #[test]
    fn valid_jumps_at_the_boundary_say_the_same_beside_the_waveforms() {
        let (block, p) = ending(0.0);
        let alone = of_brackets(&block, (&p, 1e-3), None).unwrap();
        let beside = of_brackets(&block, (&p, 1e-3), Some(&p)).unwrap();
        assert_eq!(alone, beside);
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
