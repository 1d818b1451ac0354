//! Rows over all unknowns of a fit.

use nalgebra::{DMatrix, DVector};

/// Few rows that have the normal equations of some residuals, over all unknowns of a fit.
#[derive(Debug, Clone)]
pub struct PlacedRows {
    /// Slopes over the unknowns, a row for each residual.
    pub slopes: DMatrix<f64>,
    /// The residuals.
    pub residuals: DVector<f64>,
}
