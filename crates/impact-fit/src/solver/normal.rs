//! Normal equations of some residuals: what parts of a fit's information are compared by.

use nalgebra::{DMatrix, DVector};

use crate::solver::placed_rows::PlacedRows;

/// Normal equations of some residuals.
#[derive(Debug, Clone)]
pub struct Normal {
    /// `JᵀJ` over the free coordinates.
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

    /// Add the information of some rows: matrix and gradient.
    pub fn inform(&mut self, rows: &PlacedRows) {
        let matrix = rows.slopes.tr_mul(&rows.slopes);
        let gradient = rows.slopes.tr_mul(&rows.residuals);
        for (k, to) in rows.places.iter().enumerate() {
            self.gradient[*to] += gradient[k];
            for (i, from) in rows.places.iter().enumerate() {
                self.matrix[(*from, *to)] += matrix[(i, k)];
            }
        }
    }
}

/// Inverse through a scaled Cholesky factor; `None` if numerically singular.
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
