//! Rows that stand for the residuals of a record: as few as it informs directions.

use nalgebra::{DMatrix, DVector};

/// Few rows that have the normal equations of some residuals.
#[derive(Debug, Clone)]
pub struct Rows {
    /// Slopes over the unknowns, a row for each residual.
    pub slopes: DMatrix<f64>,
    /// The residuals.
    pub residuals: DVector<f64>,
}
