//! R from brackets, on their own: the posterior over R of all brackets as interval observations.
//!
//! A bracket says that a boundary lies between two settings and nothing more (14); its likelihood is
//! flat inside, so neither a least-squares optimum nor its curvature means anything. The
//! posterior is therefore summed over a grid of R. At each R the boundaries are taken as linear in all else that acts
//! on them (`surroundings`: f0, β and `x_st` as the resonance curve has them, the length of contacts, asymmetry, the
//! force against frequency, drift, errors of clearances), and expectation propagation (`propagation`) gives the
//! probability that every jump falls into its bracket, with how early they come summed out.
//!
//! Early jumps and the length of contacts act to one side: both take the ends of motions down, and R that explains
//! them up. A rig may have neither, and a few brackets do not show which. The 95 % interval therefore reaches to those
//! of a rig whose contacts have no length, and of one whose jumps come at their boundaries too, unless the brackets refute
//! it.
//!
//! Jumps that are all early by much the same look like jumps at the boundaries of a lower R: brackets
//! alone cannot tell the two apart. Where the waveforms determine an R that the brackets miss, and that
//! early jumps explain, the brackets therefore say from one side only where the boundaries lie.

use std::collections::BTreeMap;

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::methods::boundaries::block::{BoundaryBlock, predicted_hz};
use crate::methods::boundaries::jump::{Early, Jump, Tilt, density, mills_ratio, normal};
use crate::methods::boundaries::over_restitution::BoundaryCurves;
use crate::methods::boundaries::propagation::{Factors, Propagation};
use crate::methods::boundaries::surroundings::{SimulatedBoundary, Surroundings};
use crate::parameters::{Coordinate, Parameters};
use crate::solver::Prior;
use impact_records::motion::{BoundaryKind, Bracket};

/// What brackets say of R.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Posterior {
    /// Posterior mean and standard deviation of R.
    pub restitution: (f64, f64),
    /// 95 % interval of R with equal tails.
    pub interval95: [f64; 2],
    /// Mean distance of the ends of z = 1 from s2, relative to its frequency, where the waveforms show that
    /// they are early.
    pub early: Option<f64>,
    /// Logarithm of the mean likelihood over R from 0 to 1.
    pub evidence: f64,
}

impl Posterior {
    /// With an interval that reaches to that of another posterior, and a normal distribution as wide.
    fn reaching(mut self, other: &Self) -> Self {
        let [low, high] = self.interval95;
        self.interval95 = [low.min(other.interval95[0]), high.max(other.interval95[1])];
        let ((a, sa), (b, sb)) = (self.restitution, other.restitution);
        let spread = 0.5 * (sa * sa + sb * sb) + 0.25 * (a - b).powi(2);
        self.restitution = (0.5 * (a + b), spread.sqrt());
        self
    }

    /// The normal distribution of R that stands for the brackets in a joint fit.
    pub fn as_prior(&self) -> Prior {
        let (centre, deviation) = self.restitution;
        Prior::new(Coordinate::Restitution, centre, deviation)
    }
}

/// How early jumps may come, each as likely before.
const EARLY: [Early; 14] = [
    Early::all(1e-4),
    Early::all(2e-4),
    Early::all(5e-4),
    Early::all(1e-3),
    Early::all(2e-3),
    Early::all(5e-3),
    Early::all(1e-2),
    Early::all(2e-2),
    Early::all(5e-2),
    Early::half(5e-2),
    Early::all(1e-1),
    Early::half(1e-1),
    Early::all(2e-1),
    Early::half(2e-1),
];
/// Scale of early jumps that disturbances other than a step may have.
const DISTURBED: f64 = 2e-2;
/// Steps before the end of its motion from which a step, itself a disturbance, may make it jump.
const STEPS_EARLY: f64 = 3.0;
/// So early that no distance is more likely than another.
const ANY_DISTANCE: [Early; 1] = [Early::all(1.0)];

/// How early jumps may come from the ends of motions, and before grazing, where a disturbance may lead to the motion that
/// exists beside z = 0.
#[derive(Debug, Clone, Copy)]
struct Choices<'a> {
    ends: &'a [Early],
    grazing: &'a [Early],
}

impl Choices<'_> {
    /// The same of all boundaries.
    fn alike(choices: &[Early]) -> Choices<'_> {
        Choices {
            ends: choices,
            grazing: choices,
        }
    }

    fn of(&self, bracket: &Bracket) -> &[Early] {
        match bracket.kind {
            BoundaryKind::Grazing => self.grazing,
            _ => self.ends,
        }
    }

    /// The first, the middle and the last ones alone.
    fn few(&self) -> [Self; 3] {
        [0, 1, 2].map(|half| {
            let one = |choices: &[Early]| choices.len().saturating_sub(1) * half / 2;
            let (ends, grazing) = (one(self.ends), one(self.grazing));
            Self {
                ends: &self.ends[ends..=ends],
                grazing: &self.grazing[grazing..=grazing],
            }
        })
    }
}

/// Ratio of their likelihoods at which brackets refute a rig without early jumps and lasting contacts.
const REFUTED: f64 = 0.05;
/// Deviations by which brackets miss the waveforms' R before their jumps count as early.
const MISSED: f64 = 3.0;
/// Points of the final grid of R.
const FINE: usize = 41;
/// Log-likelihood below the greatest at which the grid of R may end.
const NEGLIGIBLE: f64 = 12.0;

/// Posterior of R amid what else acts on the boundaries; `None` where no bracket determines R. `waveforms`:
/// parameters that the waveforms determine.
pub fn of_brackets(
    block: &BoundaryBlock,
    surroundings: &Surroundings,
    waveforms: Option<&Parameters>,
) -> Option<Posterior> {
    if !block.determines_restitution() {
        return None;
    }
    let all = Choices::alike(early(block));
    let at_their_ends = Choices {
        ends: &EARLY[..1],
        ..all
    };
    let boundaries = BoundaryCurves::new(block, surroundings);
    let mut found = over_grid(&boundaries, all);
    let instants = boundaries.of_instants();
    let least = found.evidence + REFUTED.ln();
    for ends in [all, at_their_ends] {
        let plain = over_grid(&instants, ends);
        if plain.evidence > least {
            found = found.reaching(&plain);
        }
    }
    let (mean, deviation) = found.restitution;
    let missed = waveforms.filter(|p| (p.restitution - mean).abs() > MISSED * deviation);
    let early = missed.and_then(|p| early_jumps(&boundaries, p));
    Some(early.unwrap_or(found))
}

/// How early jumps may come where steps are as long as the brackets.
fn early(block: &BoundaryBlock) -> &'static [Early] {
    let steps = block.brackets.iter().map(|b| b.width_hz() / b.middle_hz());
    let longest = steps
        .map(|step| STEPS_EARLY * step)
        .fold(DISTURBED, f64::max);
    let count = EARLY.iter().filter(|early| early.scale <= longest).count();
    &EARLY[..count]
}

/// Posterior where a jump may come at any distance before its boundary; `None` where that does not
/// explain what the brackets are off the waveforms.
fn early_jumps(boundaries: &BoundaryCurves<'_>, waveforms: &Parameters) -> Option<Posterior> {
    let found = over_grid(boundaries, Choices::alike(&ANY_DISTANCE));
    let [low, high] = found.interval95;
    let early = mean_distance(boundaries.block, waveforms);
    (low..=high)
        .contains(&waveforms.restitution)
        .then_some(Posterior { early, ..found })
}

/// Posterior with jumps so early.
fn over_grid(boundaries: &BoundaryCurves<'_>, early: Choices<'_>) -> Posterior {
    let at = |r: f64| likelihood(boundaries, r, early);
    // A few choices tell where R may be.
    let few = early.few();
    let (low, high) = support(&|r| {
        let logs = few.map(|early| likelihood(boundaries, r, early));
        logs.into_iter().fold(f64::NEG_INFINITY, f64::max)
    });
    let grid: Vec<f64> = (0..FINE)
        .map(|i| low + (high - low) * i as f64 / (FINE - 1) as f64)
        .collect();
    let logs: Vec<f64> = grid.par_iter().map(|r| at(*r)).collect();
    summed(&grid, &logs)
}

/// Moments and quantiles of a posterior from its logarithm on the grid.
fn summed(grid: &[f64], logs: &[f64]) -> Posterior {
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = logs.iter().map(|l| (l - most).exp()).collect();
    let step = (grid[grid.len() - 1] - grid[0]) / (grid.len() - 1) as f64;
    let (mean, spread) = moments(grid, &weights);
    Posterior {
        // A cell of a grid stands for its whole width.
        restitution: (mean, spread.hypot(step / 12f64.sqrt())),
        interval95: [0.025, 0.975].map(|share| quantile(grid, &weights, share)),
        early: None,
        evidence: most + (weights.iter().sum::<f64>() * step).ln(),
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
    for count in [40u32, 16, 12] {
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

/// Brackets whose jumps come alike early: the end of z = 1, that of longer motions, doublings, grazing.
type Family = (&'static str, bool);

/// A bracket and where its boundary lies.
struct Held<'a> {
    bracket: &'a Bracket,
    boundary: &'a SimulatedBoundary,
}

/// Log-likelihood of all brackets at R. How early the jumps of each family of boundaries come is summed out.
fn likelihood(boundaries: &BoundaryCurves<'_>, restitution: f64, early: Choices<'_>) -> f64 {
    let places = boundaries.at(restitution);
    let mut log = 0.0;
    let mut families: BTreeMap<Family, usize> = BTreeMap::new();
    let mut of_families: Vec<&[Early]> = Vec::new();
    let mut held: Vec<(Held<'_>, usize)> = Vec::new();
    for (bracket, place) in boundaries.block.brackets.iter().zip(&places) {
        let Some(boundary) = place else {
            // A boundary that does not reach the clearance is as one far away.
            log += Jump::of(bracket, Early::all(1.0))
                .probability(f64::INFINITY)
                .ln();
            continue;
        };
        let count = families.len();
        let family = (bracket.kind.name(), bracket.periods_n > 1);
        let index = *families.entry(family).or_insert(count);
        if index == of_families.len() {
            of_families.push(early.of(bracket));
        }
        held.push((Held { bracket, boundary }, index));
    }
    log + summed_over_early(&held, &of_families, boundaries)
}

/// Logarithm of the mean over the choices of all families, each as likely before: a family's sum is taken at the best choices
/// of the others.
fn summed_over_early(
    held: &[(Held<'_>, usize)],
    families: &[&[Early]],
    boundaries: &BoundaryCurves<'_>,
) -> f64 {
    let mut directions: Vec<_> = held
        .iter()
        .map(|(h, _)| h.boundary.direction.clone())
        .collect();
    directions.extend(boundaries.positive());
    if directions.is_empty() {
        return 0.0;
    }
    let directions = DMatrix::from_columns(&directions);
    let covariance = directions.tr_mul(&directions);
    let mut from: Option<Propagation> = None;
    let mut of = |chosen: &[Early]| {
        let jumps: Vec<Jump> = held
            .iter()
            .map(|(h, family)| {
                let jump = Jump::of(h.bracket, chosen[*family]);
                jump.seen_within(h.boundary.alternating_hz)
            })
            .collect();
        let tilt = |k: usize, mean: f64, variance: f64| match held.get(k) {
            Some((h, _)) => jumps[k].about(h.boundary.seen_hz() + mean, variance),
            None => positive(mean, variance),
        };
        let factors = Factors {
            covariance: &covariance,
            tilt,
        };
        let found = Propagation::of(&factors, from.as_ref());
        let log = found.log;
        if log.is_finite() {
            from = Some(found);
        }
        log
    };
    let middles = families.iter().map(|choices| choices[choices.len() / 2]);
    let mut chosen: Vec<Early> = middles.collect();
    let mut best = of(&chosen);
    let mut beyond = 0.0;
    for (family, choices) in families.iter().enumerate() {
        let before = chosen[family];
        let logs: Vec<f64> = choices
            .iter()
            .map(|early| {
                chosen[family] = *early;
                if *early == before { best } else { of(&chosen) }
            })
            .collect();
        let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let at = logs.iter().position(|l| *l == most).unwrap_or(0);
        chosen[family] = choices[at];
        let mean = logs.iter().map(|l| (l - most).exp()).sum::<f64>() / logs.len() as f64;
        beyond += mean.ln();
        best = most;
    }
    best + beyond
}

/// Probability that a normal deviate is positive.
fn positive(mean: f64, variance: f64) -> Tilt {
    let s = variance.sqrt();
    let score = mean / s;
    if score < -5.0 {
        // by Mills' ratio: the probability itself would be rounded to nothing
        let hazard = mills_ratio(-score).recip();
        return Tilt {
            log: -0.5 * score * score - 0.5 * std::f64::consts::TAU.ln() - hazard.ln(),
            slope: hazard / s,
            curvature: -hazard * (hazard + score) / variance,
        };
    }
    let density = density(score) / s;
    Tilt::of([normal(score), density, -density * score / s])
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
    use crate::fixture::bracket;
    use crate::methods::boundaries::block::alternating_hz;
    use crate::parameters::Coordinate;
    use crate::parameters::effect::Effect;
    use crate::solver::Prior;
    use impact_records::event::RigKind;

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
        let grid: Vec<f64> = (0..FINE).map(|i| 0.7 + 0.2 * i as f64 / 40.0).collect();
        let of_r = |r: &f64| -0.5 * ((r - 0.8) / 0.02).powi(2);
        let logs: Vec<f64> = grid.iter().map(of_r).collect();
        let found = summed(&grid, &logs);
        let (mean, deviation) = found.restitution;
        assert!(
            (mean - 0.8).abs() < 1e-9 && (deviation - 0.02).abs() < 2e-4,
            "{found:?}"
        );
        let [low, high] = found.interval95;
        assert!((low - 0.8 + 0.0392).abs() < 5e-4 && (high - 0.8 - 0.0392).abs() < 5e-4);
    }

    /// Brackets of s2 at five η of a rig with R = 0.7, 2 % wide: the jumps end this share before s2.
    fn ending(early: f64) -> (BoundaryBlock, Parameters) {
        let p = Parameters::symmetric(0.7, 12.6, 0.05, 1e-3);
        let half_widths = early / 0.01;
        let brackets = [1.1, 1.2, 1.3, 1.4, 1.5]
            .map(|eta| bracket(BoundaryKind::SaddleNode, eta, &p, half_widths));
        (BoundaryBlock::new(RigKind::Double, &brackets), p)
    }

    /// A rig of which nothing but R is open.
    fn ideal(p: &Parameters) -> Surroundings {
        Surroundings::known(p, &[])
    }

    #[test]
    fn valid_jumps_all_early_hold_r_once_the_waveforms_show_them() {
        let (block, p) = ending(0.08);
        let alone = of_brackets(&block, &ideal(&p), None).unwrap();
        assert!(
            alone.interval95[1] < 0.7 && alone.early.is_none(),
            "{alone:?}"
        );
        let beside = of_brackets(&block, &ideal(&p), Some(&p)).unwrap();
        let [low, high] = beside.interval95;
        assert!(low < 0.7 && 0.7 < high, "{beside:?}");
        assert!((beside.early.unwrap() - 0.08).abs() < 1e-9);
    }

    #[test]
    fn valid_jumps_that_are_late_contradict_the_waveforms() {
        let (block, p) = ending(-0.04);
        let beside = of_brackets(&block, &ideal(&p), Some(&p)).unwrap();
        assert!(
            beside.interval95[0] > 0.7 && beside.early.is_none(),
            "{beside:?}"
        );
    }

    #[test]
    fn valid_jumps_at_the_boundary_say_the_same_beside_the_waveforms() {
        let (block, p) = ending(0.0);
        let alone = of_brackets(&block, &ideal(&p), None).unwrap();
        let beside = of_brackets(&block, &ideal(&p), Some(&p)).unwrap();
        assert_eq!(alone, beside);
    }

    /// Five brackets of s2 about where contacts of half a millisecond put it, with R = 0.7.
    fn lasting() -> (BoundaryBlock, Parameters) {
        let p = Parameters::symmetric(0.7, 12.6, 0.05, 1e-3);
        let length = Coordinate::Effect(Effect::ContactDuration);
        let brackets = [1.1, 1.2, 1.3, 1.4, 1.5].map(|eta| {
            let mut held = bracket(BoundaryKind::SaddleNode, eta, &p, 0.0);
            let lasts = p.with(length, 0.5);
            let at = predicted_hz(&held, &lasts, RigKind::Double).unwrap();
            let width = 0.003 * at;
            (held.frequency_low_hz, held.frequency_high_hz) = (at - 0.4 * width, at + 0.6 * width);
            held
        });
        (BoundaryBlock::new(RigKind::Double, &brackets), p)
    }

    #[test]
    fn valid_contacts_that_last_are_held_by_their_prior_and_take_r_down_without_it() {
        let (block, p) = lasting();
        let instants = of_brackets(&block, &ideal(&p), None).unwrap();
        assert!(instants.interval95[1] < 0.69, "{instants:?}");
        let effect = Effect::ContactDuration;
        let prior = Prior::new(Coordinate::Effect(effect), 0.0, effect.accepted());
        let surroundings = Surroundings::known(&p, &[prior]);
        let [low, high] = of_brackets(&block, &surroundings, None).unwrap().interval95;
        assert!(low < 0.7 && 0.7 < high && high - low < 0.1, "{low} {high}");
    }

    #[test]
    fn valid_ends_at_the_lower_edges_of_their_brackets_are_held_without_early_jumps() {
        // each s2 a twentieth of the width above the last setting at which z = 1 was seen
        let p = Parameters::symmetric(0.7, 12.6, 0.05, 1e-3);
        let brackets = [1.1, 1.3, 1.5].map(|eta| bracket(BoundaryKind::SaddleNode, eta, &p, -0.9));
        let block = BoundaryBlock::new(RigKind::Double, &brackets);
        let effect = Effect::ContactDuration;
        let prior = Prior::new(Coordinate::Effect(effect), 0.0, effect.accepted());
        let surroundings = Surroundings::known(&p, &[prior]);
        let [low, high] = of_brackets(&block, &surroundings, None).unwrap().interval95;
        assert!(low < 0.7 && 0.72 < high, "{low} {high}");
        let boundaries = BoundaryCurves::new(&block, &surroundings);
        let alone = over_grid(&boundaries, Choices::alike(&EARLY[..8]));
        assert!(alone.interval95[0] > 0.7, "{alone:?}");
    }

    #[test]
    fn valid_a_few_jumps_thrown_far_out_by_long_steps_leave_r_held() {
        // of five ends in steps of 8 %, two come two steps early
        for places in [[0.1, 0.5, 2.4, 0.3, 2.6], [0.6, 2.2, 0.4, 2.9, 0.2]] {
            let p = Parameters::symmetric(0.7, 12.6, 0.05, 1e-3);
            let etas = [1.1, 1.2, 1.3, 1.4, 1.5];
            let brackets = etas.iter().zip(places).map(|(eta, steps)| {
                let mut held = bracket(BoundaryKind::SaddleNode, *eta, &p, 0.0);
                let (at, step) = (eta * p.natural_frequency_hz, 0.08 * p.natural_frequency_hz);
                held.frequency_low_hz = at - steps * step;
                held.frequency_high_hz = held.frequency_low_hz + step;
                held
            });
            let block = BoundaryBlock::new(RigKind::Double, &brackets.collect::<Vec<_>>());
            let [low, high] = of_brackets(&block, &ideal(&p), None).unwrap().interval95;
            assert!(low < 0.7 && 0.7 < high && high - low < 0.4, "{low} {high}");
        }
    }

    #[test]
    fn valid_a_doubling_that_settles_slowly_is_held() {
        // both sweeps show it where an alternation keeps 0.96 over a cycle
        let p = Parameters::symmetric(0.7, 12.6, 0.05, 1e-3);
        let doubling = bracket(BoundaryKind::PeriodDoubling, 0.93, &p, 0.0);
        let s1_hz = predicted_hz(&doubling, &p, RigKind::Double).unwrap();
        let range_hz = alternating_hz(&doubling, &p, RigKind::Double, s1_hz);
        assert!(range_hz > 0.01 * doubling.middle_hz(), "{range_hz}");
        let held = [-0.1, 0.1].map(|off| {
            let mut held = doubling.clone();
            let low = s1_hz + (0.8 + off) * range_hz;
            (held.frequency_low_hz, held.frequency_high_hz) = (low, 1.005 * low);
            held
        });
        let block = BoundaryBlock::new(RigKind::Double, &held);
        let [low, high] = of_brackets(&block, &ideal(&p), None).unwrap().interval95;
        assert!(low < 0.7 && 0.7 < high, "{low} {high}");
    }

    #[test]
    fn prop_the_interval_follows_the_width_of_the_brackets() {
        let p = Parameters::symmetric(0.8, 12.0, 0.06, 1e-3);
        let half_width = |width: f64| {
            let brackets = [1.15, 1.25, 1.35, 1.5, 1.6].map(|eta| {
                let mut held = bracket(BoundaryKind::SaddleNode, eta, &p, 0.0);
                let at = eta * p.natural_frequency_hz;
                let below = 0.3 * width * at;
                (held.frequency_low_hz, held.frequency_high_hz) =
                    (at - below, at - below + width * at);
                held
            });
            let block = BoundaryBlock::new(RigKind::Double, &brackets);
            let found = of_brackets(&block, &ideal(&p), None).unwrap();
            let [low, high] = found.interval95;
            assert!(low < 0.8 && 0.8 < high, "{width}: {found:?}");
            0.5 * (high - low)
        };
        let widths = [0.07, 0.03, 0.01, 0.003].map(half_width);
        assert!(widths.windows(2).all(|w| w[1] < 0.6 * w[0]), "{widths:?}");
    }

    #[test]
    fn the_support_of_a_narrow_likelihood_is_found_and_kept() {
        let at = |r: f64| -0.5 * ((r - 0.613) / 1e-3).powi(2);
        let (low, high) = support(&at);
        // 4.9 deviations are negligible (12 below the greatest)
        assert!(
            low < 0.613 - 4.2e-3 && high > 0.613 + 4.2e-3,
            "{low} {high}"
        );
        assert!(high - low < 0.05, "{low} {high}");
    }
}
