//! Least squares whose unknowns are in part linear, by Levenberg and Marquardt: a point is the best linear part at its
//! rates, so that a step of the rates alone leads to the next one.

use nalgebra::{DMatrix, DVector};

use crate::signal::columns::dot;

/// The best linear part at given rates.
pub(super) trait Projected: Sized {
    /// What is left of the values, whitened.
    fn rest(&self) -> &[f64];

    /// Sum of its squares.
    fn squares(&self) -> f64;

    /// Whitened columns: the linear ones, then the slopes over the rates.
    fn columns(&self) -> Vec<Vec<f64>>;

    /// Rates that are free.
    fn free(&self) -> usize;

    /// The point at rates that are moved by a step; `None` if there is none.
    fn moved(&self, step: &[f64]) -> Option<Self>;
}

/// Change of χ² that no longer matters: a thousandth of a standard error.
const SETTLED: f64 = 1e-6;
/// Most steps.
const STEPS: usize = 40;

/// The point of the least squares from a start on; `None` if the columns are not independent.
pub(super) fn descend<P: Projected>(start: P) -> Option<P> {
    let mut point = start;
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        let columns = point.columns();
        let (mut normal, right) = equations(&columns, point.rest());
        let first = columns.len() - point.free();
        for k in first..columns.len() {
            normal[(k, k)] *= 1.0 + damping;
        }
        let step = normal.cholesky()?.solve(&right);
        let next = point.moved(&step.as_slice()[first..]);
        match next.filter(|n| n.squares() <= point.squares()) {
            Some(next) => {
                let gained = point.squares() - next.squares();
                let settled = gained <= SETTLED * point.squares() / point.rest().len() as f64;
                point = next;
                damping *= 0.2;
                if settled {
                    break;
                }
            }
            None if damping > 1e6 => break,
            None => damping = (damping * 10.0).max(1e-5),
        }
    }
    Some(point)
}

/// Normal matrix and right side.
pub(super) fn equations(columns: &[Vec<f64>], values: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
    let count = columns.len();
    let mut normal = DMatrix::zeros(count, count);
    for i in 0..count {
        for k in 0..=i {
            let product = dot(&columns[i], &columns[k]);
            normal[(i, k)] = product;
            normal[(k, i)] = product;
        }
    }
    let right = DVector::from_iterator(count, columns.iter().map(|c| dot(c, values)));
    (normal, right)
}
