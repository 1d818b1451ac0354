//! Least squares over blocks of residuals.
//!
//! Of each item only the triangular factor is kept, and the factors are combined in the items' order,
//! so that the same bytes come out on any number of threads.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::DMatrix;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::parameters::{Coordinate, Parameters};
use crate::solver::block::Block;
use crate::solver::evaluation::{Evaluation, LastEvaluations, Part, kept};
use crate::solver::factor::Factor;
use crate::solver::group::Group;
use crate::solver::least_squares::{LeastSquares, Limits, Variance, minimise};
use crate::solver::normal::Normal;
use crate::solver::placed_rows::PlacedRows;
use crate::solver::rows::Rows;
use crate::solver::{Fit, FitError, FitProgress};

/// Gaussian prior on one coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Prior {
    /// The coordinate.
    pub coordinate: Coordinate,
    /// Centre.
    pub centre: f64,
    /// Standard deviation.
    pub deviation: f64,
}

impl Prior {
    /// The prior of a coordinate about a centre.
    pub fn new(coordinate: Coordinate, centre: f64, deviation: f64) -> Self {
        Self {
            coordinate,
            centre,
            deviation,
        }
    }
}

/// A least-squares problem: blocks with weights, priors, and the coordinates that are free.
#[derive(Default)]
pub struct Problem<'a> {
    /// Blocks, each with a factor on its squared residuals (1 / variance factor).
    pub blocks: Vec<(&'a dyn Block, f64)>,
    /// Priors.
    pub priors: Vec<Prior>,
    /// Free coordinates.
    pub free: Vec<Coordinate>,
    /// What counts the iterations of its fits.
    pub progress: FitProgress,
    /// How close to the least sum of squares its fits end.
    pub precision: Precision,
    /// What was evaluated last, of these blocks over these coordinates.
    pub(crate) last: LastEvaluations,
}

/// How close to the least sum of squares a fit ends.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Precision {
    /// Within a thousandth of the standard errors.
    #[default]
    Result,
    /// Close enough to start another fit from, or to tell which of two arrangements fits.
    Start,
}

impl Precision {
    fn limits(self) -> Limits {
        // What a result is fitted from is near it: its first steps are hardly damped.
        let (negligible, damping, iterations) = match self {
            Self::Result => (1e-3, 1e-8, 60),
            Self::Start => (0.1, 1e-4, 12),
        };
        Limits {
            negligible,
            variance: Variance::AtLeastUnit,
            damping,
            iterations,
        }
    }
}

/// Standard deviations of a prior from which a fit that ended there is tried again.
const FAR: f64 = 3.0;
/// Share of its deviation to which such a prior is narrowed then.
const NARROW: f64 = 0.1;
/// Share of the rise of the squares by which it may differ from that of a parabola: it has turned where a second minimum is.
const PARABOLA: f64 = 0.25;
/// Deviation of a prior that says next to nothing: of a logarithm a factor of e, of a clearance a millimetre.
const OPEN: f64 = 1.0;
/// Least orthogonal share of a column of slopes: differences do not resolve less.
const LEAST_SHARE: f64 = 1e-8;

/// Whether a nuisance is more than some standard deviations from where it is expected.
fn is_far(prior: &Prior, at: &Parameters, deviations: f64) -> bool {
    let nuisance = !Coordinate::PHYSICAL.contains(&prior.coordinate);
    nuisance && prior_residual(prior, at).abs() > deviations
}

impl<'a> Problem<'a> {
    /// Of blocks with their weights, without priors.
    pub fn of(blocks: Vec<(&'a dyn Block, f64)>, free: Vec<Coordinate>) -> Self {
        Self {
            blocks,
            free,
            ..Self::default()
        }
    }

    /// The same blocks and priors with other coordinates free.
    #[must_use]
    pub fn over(&self, free: Vec<Coordinate>) -> Self {
        Self {
            blocks: self.blocks.clone(),
            priors: self.priors.clone(),
            free,
            progress: self.progress.clone(),
            ..Self::default()
        }
    }

    /// The same with fits that end as close to the least sum of squares as a precision says.
    #[must_use]
    pub fn with_precision(self, precision: Precision) -> Self {
        Self { precision, ..self }
    }

    /// Fit from a start.
    ///
    /// # Errors
    /// [`FitError`] if there is nothing to fit, if observations have no counterpart in the model at the
    /// start, or if the data do not determine the coordinates.
    pub fn fit(&self, start: Parameters) -> Result<Fit, FitError> {
        let minimum = minimise(self, start, &self.precision.limits()).map_err(|error| {
            let own = error.downcast::<FitError>();
            own.unwrap_or(FitError::Solver)
        })?;
        let factor = minimum.factor;
        Ok(Fit {
            parameters: minimum.point,
            free: self.free.clone(),
            covariance: factor.covariance(LEAST_SHARE).ok_or(FitError::Singular)?,
            cost: factor.cost(),
            residuals: factor.count() - self.priors.len(),
            report: minimum.report,
        })
    }

    /// Fit from a start and, where that ends far from what is known beforehand, once more from where a fit
    /// ends that is drawn there; the better of both. In a narrow valley, as that of a gain, a mass and a force
    /// that act alike, a fit may come to a halt on its way.
    ///
    /// # Errors
    /// Those of [`Problem::fit`].
    pub fn fit_from_both_ends(&self, start: Parameters) -> Result<Fit, FitError> {
        let first = self.fit(start)?;
        let drawn = self.drawn(&first.parameters);
        let second = drawn.and_then(|problem| {
            let near = problem.fit(first.parameters).ok()?.parameters;
            let one_valley = self.is_parabola(&first, &near);
            (!one_valley).then(|| self.fit(near).ok()).flatten()
        });
        Ok(match second {
            Some(second) if second.cost < first.cost => second,
            _ => first,
        })
    }

    /// Whether the least squares rise from a fit to other parameters as its covariance has it: no other minimum is beside it
    /// there.
    fn is_parabola(&self, fit: &Fit, other: &Parameters) -> bool {
        let rise = self.cost(other).map(|cost| cost - fit.cost);
        let expected = fit.rise(other);
        let agree = |(rise, expected): (f64, f64)| (rise - expected).abs() < PARABOLA * expected;
        rise.zip(expected).is_some_and(agree)
    }

    /// The same with narrow priors of the nuisances that are far from where they are expected; `None` where
    /// none is far, or the fit only starts another.
    pub fn drawn(&self, at: &Parameters) -> Option<Self> {
        let far = |p: &Prior, limit: f64| is_far(p, at, limit);
        if self.precision == Precision::Start || !self.priors.iter().any(|p| far(p, FAR)) {
            return None;
        }
        let narrowed = |p: &Prior| {
            if far(p, 0.5 * FAR) {
                Prior::new(p.coordinate, p.centre, NARROW * p.deviation)
            } else {
                *p
            }
        };
        Some(self.with_priors(narrowed))
    }

    /// The same with next to nothing known of a coordinate beforehand.
    #[must_use]
    pub fn without(&self, coordinate: Coordinate) -> Self {
        self.with_priors(|p| {
            if p.coordinate == coordinate {
                Prior::new(coordinate, p.centre, OPEN)
            } else {
                *p
            }
        })
    }

    /// The same with each prior changed.
    fn with_priors(&self, changed: impl Fn(&Prior) -> Prior) -> Self {
        Self {
            blocks: self.blocks.clone(),
            priors: self.priors.iter().map(changed).collect(),
            free: self.free.clone(),
            progress: self.progress.clone(),
            precision: self.precision,
            last: self.last.clone(),
        }
    }

    /// Whether what is stated of the rig and its instruments is far off at given parameters.
    pub fn strained(&self, at: &Parameters) -> bool {
        let far = |p: &Prior| p.coordinate.is_stated() && is_far(p, at, FAR);
        self.priors.iter().any(far)
    }

    /// How far some coordinates are from their priors, over these.
    pub fn deviations(&self, at: &Parameters, of: impl Fn(Coordinate) -> bool) -> Vec<f64> {
        let own = self.priors.iter().filter(|p| of(p.coordinate));
        own.map(|p| prior_residual(p, at)).collect()
    }

    /// Sum of squared weighted residuals at given parameters; `None` if an item has no model.
    pub fn cost(&self, parameters: &Parameters) -> Option<f64> {
        if !parameters.in_range() {
            return None;
        }
        let mut sum: f64 = self
            .priors
            .iter()
            .map(|p| prior_residual(p, parameters).powi(2))
            .sum();
        for (block, weight) in &self.blocks {
            let costs: Vec<Option<f64>> = (0..block.items())
                .into_par_iter()
                .map(|i| {
                    block
                        .residuals(i, parameters)
                        .map(|r| r.iter().map(|x| x * x).sum())
                })
                .collect();
            for cost in costs {
                sum += weight * cost?;
            }
        }
        sum.is_finite().then_some(sum)
    }

    /// Inverse of the information at given parameters, over the items that have a model there;
    /// `None` if it is singular.
    pub fn covariance_at(&self, parameters: &Parameters) -> Option<DMatrix<f64>> {
        self.known_factor(parameters).0.covariance(LEAST_SHARE)
    }

    /// Normal equations item by item of each block; items without a model are left out.
    pub fn item_parts(&self, parameters: &Parameters) -> Vec<Vec<Normal>> {
        let blocks = self.blocks.iter();
        blocks
            .map(|(block, weight)| self.items_of(*block, *weight, parameters))
            .collect()
    }

    /// Normal equations item by item of a block with its weight; items without a model are left out.
    fn items_of(&self, block: &dyn Block, weight: f64, at: &Parameters) -> Vec<Normal> {
        let unknowns = self.free.len();
        self.items(block, weight, at, |rows, places| {
            rows.normal(places, unknowns)
        })
    }

    /// Few rows item by item of a block with its weight; items without a model are left out.
    pub fn rows_of(&self, block: &dyn Block, weight: f64, at: &Parameters) -> Vec<PlacedRows> {
        self.items(block, weight, at, |rows, places| rows.placed(places))
    }

    /// What the rows of each item of a block with its weight, and the places of its coordinates among
    /// the free ones, give; items without a model are left out.
    fn items<T: Send>(
        &self,
        block: &dyn Block,
        weight: f64,
        at: &Parameters,
        give: impl Fn(Rows, &[usize]) -> T + Sync,
    ) -> Vec<T> {
        (0..block.items())
            .into_par_iter()
            .filter_map(|i| {
                let (places, coordinates) = kept(&self.free, |c| block.item_touches(i, c));
                let rows = block.rows(i, at, &coordinates, weight)?;
                Some(give(rows, &places))
            })
            .collect()
    }

    /// Normal equations of the items that belong to the same groups, over the items that have a model;
    /// those of the blocks and priors that belong to no group last.
    pub fn groups(&self, parameters: &Parameters) -> (BTreeMap<Group, Normal>, Normal) {
        let n = self.free.len();
        let (mut groups, mut rest) = (BTreeMap::new(), Normal::zeros(n));
        for (group, normal) in self.normals(parameters).into_iter().flatten() {
            let sum = match group {
                Some(group) => groups.entry(group).or_insert_with(|| Normal::zeros(n)),
                None => &mut rest,
            };
            sum.add(&normal);
        }
        rest.add(&self.priors_normal(parameters));
        (groups, rest)
    }

    /// Normal equations of each block, over the items that have a model, then those of all priors.
    pub fn parts(&self, parameters: &Parameters) -> Vec<Normal> {
        let sum = |groups: Vec<(Option<Group>, Normal)>| {
            let mut sum = Normal::zeros(self.free.len());
            groups.iter().for_each(|(_, normal)| sum.add(normal));
            sum
        };
        let mut parts: Vec<Normal> = self.normals(parameters).into_iter().map(sum).collect();
        parts.push(self.priors_normal(parameters));
        parts
    }

    /// Normal equations of each group of each block, over the items that have a model.
    fn normals(&self, parameters: &Parameters) -> Vec<Vec<(Option<Group>, Normal)>> {
        let n = self.free.len();
        let evaluated = self.evaluated(parameters);
        let of_block = |groups: &Vec<(Option<Group>, Part)>| {
            let normals = groups
                .par_iter()
                .map(|(group, part)| (*group, part.normal(n)));
            normals.collect()
        };
        evaluated.blocks.iter().map(of_block).collect()
    }

    /// Normal equations of a block with its weight, over the items that have a model.
    pub fn block_normal(&self, block: &dyn Block, weight: f64, at: &Parameters) -> Normal {
        let items: Vec<usize> = (0..block.items()).collect();
        Part::of((block, weight), &self.free, at, &items).normal(self.free.len())
    }

    /// Normal equations of all priors.
    pub fn priors_normal(&self, parameters: &Parameters) -> Normal {
        let mut sum = Normal::zeros(self.free.len());
        for prior in &self.priors {
            sum.add(&self.prior_normal(prior, parameters));
        }
        sum
    }

    /// Factor over the items that have a model, and those (block, item) that have none.
    fn known_factor(&self, parameters: &Parameters) -> (Factor, Vec<(usize, usize)>) {
        let evaluation = self.evaluated(parameters);
        let (mut parts, mut missing) = (Vec::new(), Vec::new());
        for (b, groups) in evaluation.blocks.iter().enumerate() {
            for (_, part) in groups {
                parts.push((part.factor.rows(), part.places.as_slice()));
                missing.extend(part.missing.iter().map(|i| (b, *i)));
            }
        }
        let mut total = Factor::joined(self.free.len(), &parts);
        for prior in &self.priors {
            let place = self.free.iter().position(|c| *c == prior.coordinate);
            let slopes = place.map(|_| vec![prior.deviation.recip()]);
            let residual = prior_residual(prior, parameters);
            let row = Rows::of(&[residual], slopes.as_slice(), 1.0);
            total.add(&[(&row, place.as_slice())]);
        }
        missing.sort_unstable();
        (total, missing)
    }

    /// All items at given parameters.
    fn evaluated(&self, at: &Parameters) -> Arc<Evaluation> {
        let evaluate = || Evaluation::of(&self.blocks, &self.free, at);
        self.last.at_or(at, evaluate)
    }

    /// Normal equations of one prior.
    pub fn prior_normal(&self, prior: &Prior, parameters: &Parameters) -> Normal {
        let mut part = Normal::zeros(self.free.len());
        let residual = prior_residual(prior, parameters);
        part.cost = residual * residual;
        part.count = 1;
        if let Some(i) = self.free.iter().position(|c| *c == prior.coordinate) {
            part.matrix[(i, i)] = prior.deviation.powi(-2);
            part.gradient[i] = residual / prior.deviation;
        }
        part
    }
}

impl LeastSquares for Problem<'_> {
    type Point = Parameters;

    fn factor(&self, at: &Parameters) -> Result<Factor, argmin::core::Error> {
        if !at.in_range() {
            return Err(FitError::NoModel(Vec::new()).into());
        }
        let (factor, missing) = self.known_factor(at);
        if !missing.is_empty() {
            return Err(FitError::NoModel(missing).into());
        }
        if factor.count() == 0 {
            return Err(FitError::Empty.into());
        }
        Ok(factor)
    }

    fn cost(&self, at: &Parameters) -> Option<f64> {
        Problem::cost(self, at)
    }

    fn progress(&self) -> FitProgress {
        self.progress.clone()
    }

    fn moved(&self, from: &Parameters, step: &[f64]) -> Parameters {
        let steps = self.free.iter().zip(step);
        steps.fold(*from, |p, (c, d)| p.with(*c, p.coordinate(*c) + d))
    }
}

fn prior_residual(prior: &Prior, parameters: &Parameters) -> f64 {
    (parameters.coordinate(prior.coordinate) - prior.centre) / prior.deviation
}

#[cfg(test)]
mod tests {
    use super::*;

    /// R and a gain g that is 1 or −1 by the data.
    struct TwoValleys;

    impl Block for TwoValleys {
        fn items(&self) -> usize {
            2
        }

        fn residuals(&self, item: usize, parameters: &Parameters) -> Option<Vec<f64>> {
            let gain = parameters.coordinate(Coordinate::Gain(0));
            Some(match item {
                0 => vec![1e3 * (parameters.restitution - 0.8)],
                _ => vec![1e3 * (gain * gain - 1e-2)],
            })
        }

        fn touches(&self, coordinate: Coordinate) -> bool {
            matches!(coordinate, Coordinate::Restitution | Coordinate::Gain(0))
        }
    }

    #[test]
    fn a_fit_that_ends_far_from_what_is_stated_is_made_from_there_too() {
        let gain = Coordinate::Gain(0);
        let problem = |deviation: f64| Problem {
            blocks: vec![(&TwoValleys, 1.0)],
            priors: vec![Prior::new(gain, 0.05, deviation)],
            free: vec![Coordinate::Restitution, gain],
            ..Problem::default()
        };
        let start = Parameters::symmetric(0.7, 10.0, 0.05, 1e-3).with(gain, -0.2);
        let ended = |fit: Fit| fit.parameters.coordinate(gain);
        // −0.1 is five deviations from 0.05, 0.1 is one and a half
        let tight = problem(0.03);
        assert!((ended(tight.fit(start).expect("a fit")) + 0.1).abs() < 1e-2);
        let found = tight.fit_from_both_ends(start).expect("a fit");
        assert!((ended(found) - 0.1).abs() < 1e-2);
        // with a wide prior both are expected, and the fit stays where it is
        let wide = problem(0.1);
        let found = wide.fit_from_both_ends(start).expect("a fit");
        assert!((ended(found) + 0.1).abs() < 1e-2);
    }
}
