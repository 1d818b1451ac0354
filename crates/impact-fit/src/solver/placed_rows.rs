//! Rows over some of the unknowns of a fit.

use nalgebra::{DMatrix, DVector};

/// Few rows that have the normal equations of some residuals, over those unknowns of a fit that they
/// depend on.
#[derive(Debug, Clone)]
pub struct PlacedRows {
    /// The unknowns, by their places in the fit.
    pub places: Vec<usize>,
    /// Slopes over them, a row for each residual.
    pub slopes: DMatrix<f64>,
    /// The residuals.
    pub residuals: DVector<f64>,
}

impl PlacedRows {
    /// Slopes over all unknowns, of which there are so many; a column for each residual.
    pub fn transposed(&self, unknowns: usize) -> DMatrix<f64> {
        let mut turned = DMatrix::zeros(unknowns, self.residuals.len());
        for (column, place) in self.slopes.column_iter().zip(&self.places) {
            turned.row_mut(*place).tr_copy_from(&column);
        }
        turned
    }

    /// What a change of all unknowns adds to the residuals.
    pub fn change(&self, step: &DVector<f64>) -> DVector<f64> {
        &self.slopes * step.select_rows(&self.places)
    }
}
