//! Least squares over blocks of residuals.
//!
//! A block gives its residuals item by item (a record, a bracket), so that items are evaluated in
//! parallel and only their triangular factors are kept, which are combined in the items' order. An item whose model does not exist at a
//! trial point makes that trial fail; it never becomes a residual number.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::identify::factor::Factor;
pub use crate::identify::least_squares::Ending;
use crate::identify::least_squares::{LeastSquares, Limits, Variance, minimise};
use crate::identify::parameters::{Coordinate, Parameters};

/// Weighted residuals of one kind of observation.
pub trait Block: Sync {
    /// Number of items.
    fn items(&self) -> usize;

    /// Weighted residuals of one item at given parameters, always the same number for an item;
    /// `None` where the model has no such motion there.
    fn residuals(&self, item: usize, parameters: &Parameters) -> Option<Vec<f64>>;

    /// Residuals of one item and their slopes over some coordinates, column by column. Without a
    /// faster way of its own, a block is differenced.
    fn slopes(
        &self,
        item: usize,
        parameters: &Parameters,
        coordinates: &[Coordinate],
    ) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
        let here = self.residuals(item, parameters)?;
        let columns = coordinates
            .iter()
            .map(|coordinate| {
                difference(parameters, *coordinate, &here, |p| self.residuals(item, p))
            })
            .collect::<Option<Vec<_>>>()?;
        Some((here, columns))
    }

    /// Which coordinates the block depends on.
    fn touches(&self, coordinate: Coordinate) -> bool;
}

/// Mean square of each item's weighted residuals at given parameters, in the items' order; `None`
/// where the model has no such motion.
pub fn mean_squares(block: &impl Block, parameters: &Parameters) -> Vec<Option<f64>> {
    (0..block.items())
        .into_par_iter()
        .map(|i| {
            let residuals = block.residuals(i, parameters)?;
            let sum: f64 = residuals.iter().map(|r| r * r).sum();
            Some(sum / residuals.len().max(1) as f64)
        })
        .collect()
}

/// Gaussian prior on one coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// The coordinate.
    pub coordinate: Coordinate,
    /// Centre.
    pub centre: f64,
    /// Standard deviation.
    pub deviation: f64,
}

/// A least-squares problem: blocks with weights, priors, and the coordinates that are free.
pub struct Problem<'a> {
    /// Blocks, each with a factor on its squared residuals (1 / variance factor).
    pub blocks: Vec<(&'a dyn Block, f64)>,
    /// Priors.
    pub priors: Vec<Prior>,
    /// Free coordinates.
    pub free: Vec<Coordinate>,
}

/// A finished fit.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Fit {
    /// Best parameters.
    pub parameters: Parameters,
    /// Free coordinates, in the order of the covariance.
    pub free: Vec<Coordinate>,
    /// Covariance of the free coordinates for unit variance of the weighted residuals.
    #[serde(with = "rows")]
    pub covariance: DMatrix<f64>,
    /// Sum of squared weighted residuals, priors included.
    pub cost: f64,
    /// Number of residuals, priors not counted.
    pub residuals: usize,
    /// How it ended.
    pub ending: Ending,
}

impl Fit {
    /// Standard error of a coordinate; `None` where it was not free.
    pub fn error(&self, coordinate: Coordinate) -> Option<f64> {
        let i = self.free.iter().position(|c| *c == coordinate)?;
        Some(self.covariance[(i, i)].max(0.0).sqrt())
    }

    /// Variance of a coordinate where all others are known; `None` where it was not free.
    pub fn conditional_variance(&self, coordinate: Coordinate) -> Option<f64> {
        let i = self.free.iter().position(|c| *c == coordinate)?;
        Some(inverse(&self.covariance)?[(i, i)].recip())
    }

    /// Correlation of two free coordinates.
    pub fn correlation(&self, a: Coordinate, b: Coordinate) -> Option<f64> {
        let i = self.free.iter().position(|c| *c == a)?;
        let k = self.free.iter().position(|c| *c == b)?;
        let scale = (self.covariance[(i, i)] * self.covariance[(k, k)]).sqrt();
        (scale > 0.0).then(|| self.covariance[(i, k)] / scale)
    }
}

/// A square matrix as a list of rows.
mod rows {
    use nalgebra::DMatrix;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub fn serialize<S: Serializer>(matrix: &DMatrix<f64>, to: S) -> Result<S::Ok, S::Error> {
        let rows: Vec<Vec<f64>> = matrix
            .row_iter()
            .map(|row| row.iter().copied().collect())
            .collect();
        rows.serialize(to)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<DMatrix<f64>, D::Error> {
        let rows: Vec<Vec<f64>> = Deserialize::deserialize(from)?;
        let width = rows.first().map_or(0, Vec::len);
        if rows.iter().any(|row| row.len() != width) {
            return Err(serde::de::Error::custom(
                "the rows of a matrix differ in length",
            ));
        }
        Ok(DMatrix::from_fn(rows.len(), width, |i, k| rows[i][k]))
    }
}

/// Why a fit could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FitError {
    /// The model has no such motion at the start, for these items (block, item).
    #[error("the model has no such motion at the starting values for {} observations", .0.len())]
    NoModel(Vec<(usize, usize)>),
    /// Nothing to fit.
    #[error("there are no observations to fit")]
    Empty,
    /// The slopes are dependent: the data do not tell the coordinates.
    #[error("the data do not tell the parameters apart")]
    Singular,
}

/// Normal equations of some residuals.
#[derive(Debug, Clone)]
pub struct Normal {
    /// JᵀJ over the free coordinates.
    pub matrix: DMatrix<f64>,
    /// Jᵀr.
    pub gradient: DVector<f64>,
    /// rᵀr.
    pub cost: f64,
    /// Number of residuals.
    pub count: usize,
}

impl Normal {
    /// Those of no residuals.
    pub fn zeros(n: usize) -> Self {
        Self {
            matrix: DMatrix::zeros(n, n),
            gradient: DVector::zeros(n),
            cost: 0.0,
            count: 0,
        }
    }

    /// Add those of other residuals.
    pub fn add(&mut self, other: &Self) {
        self.matrix += &other.matrix;
        self.gradient += &other.gradient;
        self.cost += other.cost;
        self.count += other.count;
    }
}

/// Relative step of the central differences.
const DIFFERENCE: f64 = 2e-6;
/// Least share of a column of slopes that must stand off the others: differences do not tell less.
const LEAST_SHARE: f64 = 1e-8;
const LIMITS: Limits = Limits {
    negligible: 1e-4,
    variance: Variance::Unit,
    damping: 1e-4,
    steps: 60,
};

impl Problem<'_> {
    /// Fit from a start.
    ///
    /// # Errors
    /// [`FitError`] where there is nothing to fit, where observations have no counterpart in the
    /// model at the start, or where the data do not determine the coordinates.
    pub fn fit(&self, start: Parameters) -> Result<Fit, FitError> {
        let minimum = minimise(self, start, &LIMITS)?;
        let factor = minimum.factor;
        Ok(Fit {
            parameters: minimum.point,
            free: self.free.clone(),
            covariance: factor.covariance(LEAST_SHARE).ok_or(FitError::Singular)?,
            cost: factor.cost,
            residuals: factor.count - self.priors.len(),
            ending: minimum.ending,
        })
    }

    /// Sum of squared weighted residuals at given parameters; `None` where an item has no model.
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
    /// `None` where it is singular.
    pub fn covariance_at(&self, parameters: &Parameters) -> Option<DMatrix<f64>> {
        self.known_factor(parameters).0.covariance(LEAST_SHARE)
    }

    /// Normal equations item by item of each block; items without a model are left out.
    pub fn item_parts(&self, parameters: &Parameters) -> Vec<Vec<Normal>> {
        self.blocks
            .iter()
            .map(|(block, weight)| {
                (0..block.items())
                    .into_par_iter()
                    .filter_map(|i| self.item_normal(*block, i, *weight, parameters))
                    .collect()
            })
            .collect()
    }

    /// Normal equations of each block, then those of all priors.
    pub fn parts(&self, parameters: &Parameters) -> Vec<Normal> {
        let total = |items: &mut dyn Iterator<Item = Normal>| {
            let mut sum = Normal::zeros(self.free.len());
            items.for_each(|item| sum.add(&item));
            sum
        };
        let mut parts: Vec<Normal> = self
            .item_parts(parameters)
            .into_iter()
            .map(|items| total(&mut items.into_iter()))
            .collect();
        let mut priors = self.priors.iter().map(|p| self.prior_normal(p, parameters));
        parts.push(total(&mut priors));
        parts
    }

    /// Least cost with one coordinate held at a value, all others fitted anew from where the
    /// covariance of a fit expects them; `None` where no fit is found.
    pub fn cost_with(&self, fit: &Fit, coordinate: Coordinate, value: f64) -> Option<f64> {
        let at = fit.free.iter().position(|c| *c == coordinate)?;
        let step = value - fit.parameters.coordinate(coordinate);
        let mut start = fit.parameters;
        for (i, free) in fit.free.iter().enumerate() {
            let share = fit.covariance[(i, at)] / fit.covariance[(at, at)];
            start = start.with(*free, fit.parameters.coordinate(*free) + share * step);
        }
        // Where the problem is as good as linear, the others already lie where a fit would put
        // them, up to second order, and the cost is right up to fourth.
        let linear = step * step / fit.covariance[(at, at)];
        if let Some(cost) = self.cost(&start)
            && (cost - fit.cost - linear).abs() < 0.02 * linear
        {
            return Some(cost);
        }
        let held = Problem {
            blocks: self.blocks.clone(),
            priors: self.priors.clone(),
            free: fit
                .free
                .iter()
                .copied()
                .filter(|c| *c != coordinate)
                .collect(),
        };
        Some(held.fit(start).ok()?.cost)
    }

    /// Factor over the items that have a model, and those (block, item) that have none.
    fn known_factor(&self, parameters: &Parameters) -> (Factor, Vec<(usize, usize)>) {
        let mut total = Factor::empty(self.free.len());
        let mut missing = Vec::new();
        for (b, (block, weight)) in self.blocks.iter().enumerate() {
            let (places, coordinates) = self.touched(*block);
            let parts: Vec<Option<Factor>> = (0..block.items())
                .into_par_iter()
                .map(|i| {
                    let (residuals, columns) = block.slopes(i, parameters, &coordinates)?;
                    Some(Factor::of(&residuals, &columns, *weight))
                })
                .collect();
            for (i, part) in parts.iter().enumerate() {
                match part {
                    Some(part) => total.add(part, &places),
                    None => missing.push((b, i)),
                }
            }
        }
        for prior in &self.priors {
            let place = self.free.iter().position(|c| *c == prior.coordinate);
            let slopes = place.map(|_| vec![prior.deviation.recip()]);
            let residual = prior_residual(prior, parameters);
            let part = Factor::of(&[residual], slopes.as_slice(), 1.0);
            total.add(&part, place.as_slice());
        }
        (total, missing)
    }

    /// Places among the free coordinates, and the coordinates, that a block depends on.
    fn touched(&self, block: &dyn Block) -> (Vec<usize>, Vec<Coordinate>) {
        self.free
            .iter()
            .copied()
            .enumerate()
            .filter(|(_, c)| block.touches(*c))
            .unzip()
    }

    fn item_normal(
        &self,
        block: &dyn Block,
        item: usize,
        weight: f64,
        at: &Parameters,
    ) -> Option<Normal> {
        let (places, coordinates) = self.touched(block);
        let (residuals, columns) = block.slopes(item, at, &coordinates)?;
        let mut normal = Normal::zeros(self.free.len());
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(x, y)| x * y).sum() };
        for (i, a) in places.iter().zip(&columns) {
            normal.gradient[*i] = weight * dot(a, &residuals);
            for (k, b) in places.iter().zip(&columns) {
                if k <= i {
                    let product = weight * dot(a, b);
                    normal.matrix[(*i, *k)] = product;
                    normal.matrix[(*k, *i)] = product;
                }
            }
        }
        normal.cost = weight * dot(&residuals, &residuals);
        normal.count = residuals.len();
        Some(normal)
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
    type Error = FitError;

    fn factor(&self, at: &Parameters) -> Result<Factor, FitError> {
        let (factor, missing) = self.known_factor(at);
        if !missing.is_empty() {
            return Err(FitError::NoModel(missing));
        }
        if factor.count == 0 {
            return Err(FitError::Empty);
        }
        Ok(factor)
    }

    fn cost(&self, at: &Parameters) -> Option<f64> {
        Problem::cost(self, at)
    }

    fn moved(&self, from: &Parameters, step: &[f64]) -> Parameters {
        let steps = self.free.iter().zip(step);
        steps.fold(*from, |p, (c, d)| p.with(*c, p.coordinate(*c) + d))
    }
}

fn prior_residual(prior: &Prior, parameters: &Parameters) -> f64 {
    (parameters.coordinate(prior.coordinate) - prior.centre) / prior.deviation
}

/// Slope of a function of the parameters over one coordinate, by central differences; one-sided
/// where the model ends. `here` is its value at the parameters.
pub fn difference(
    at: &Parameters,
    coordinate: Coordinate,
    here: &[f64],
    function: impl Fn(&Parameters) -> Option<Vec<f64>>,
) -> Option<Vec<f64>> {
    let centre = at.coordinate(coordinate);
    let evaluate = |shift: f64| {
        let shifted = at.with(coordinate, centre + shift);
        shifted.in_range().then(|| function(&shifted)).flatten()
    };
    let slope = |above: &[f64], below: &[f64], step: f64| {
        above
            .iter()
            .zip(below)
            .map(|(a, b)| (a - b) / step)
            .collect()
    };
    match (evaluate(DIFFERENCE), evaluate(-DIFFERENCE)) {
        (Some(above), Some(below)) => Some(slope(&above, &below, 2.0 * DIFFERENCE)),
        (Some(above), None) => Some(slope(&above, here, DIFFERENCE)),
        (None, Some(below)) => Some(slope(here, &below, DIFFERENCE)),
        (None, None) => None,
    }
}

/// Inverse through a scaled Cholesky factor; `None` where numerically singular.
pub fn inverse(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = matrix
        .diagonal()
        .map(|d| if d > 0.0 { d.sqrt().recip() } else { 0.0 });
    if scale.iter().any(|s| *s == 0.0) {
        return None;
    }
    let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, k| {
        matrix[(i, k)] * scale[i] * scale[k]
    });
    let inverse = scaled.cholesky()?.inverse();
    Some(DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, k| {
        inverse[(i, k)] * scale[i] * scale[k]
    }))
}
