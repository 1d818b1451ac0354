//! Residuals of one kind of observation, item by item.
//!
//! Items (a record, a bracket) are evaluated in parallel. One whose model does not exist at a trial
//! point makes that trial fail; it never becomes a residual number.

use rayon::prelude::*;

use crate::parameters::{Coordinate, Parameters};
use crate::solver::group::Group;
use crate::solver::rows::Rows;

/// Weighted residuals of one kind of observation.
pub trait Block: Sync {
    /// Number of items.
    fn items(&self) -> usize;

    /// Weighted residuals of one item at given parameters, always the same number for an item;
    /// `None` if the model has no such motion there.
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

    /// Rows that stand for an item's residuals and their slopes over some coordinates, each squared
    /// residual weighted; `None` if the model has no such motion there.
    fn rows(
        &self,
        item: usize,
        parameters: &Parameters,
        coordinates: &[Coordinate],
        weight: f64,
    ) -> Option<Rows> {
        let (residuals, columns) = self.slopes(item, parameters, coordinates)?;
        Some(Rows::of(&residuals, &columns, weight))
    }

    /// Which coordinates the block depends on.
    fn touches(&self, coordinate: Coordinate) -> bool;

    /// The groups of records that an item belongs to, whose misfits may be alike; `None`: no group.
    fn group(&self, _item: usize) -> Option<Group> {
        None
    }

    /// The observation of each item; none where an item is of several.
    fn owners(&self) -> Vec<usize> {
        Vec::new()
    }

    /// Which coordinates one of its items depends on; as the whole block does, unless it overrides this.
    fn item_touches(&self, _item: usize, coordinate: Coordinate) -> bool {
        self.touches(coordinate)
    }
}

/// Mean square of each item's weighted residuals at given parameters, in the items' order; `None`
/// if the model has no such motion.
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

/// Relative step of the central differences.
const DIFFERENCE: f64 = 2e-6;
/// Slope of a function of the parameters over one coordinate, by central differences; one-sided
/// at the edge of the model's domain. `here` is its value at the parameters.
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
