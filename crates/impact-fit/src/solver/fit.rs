//! A finished fit, and why one could not be made.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use super::normal::inverse;
use super::report::FitReport;
use crate::parameters::{Coordinate, Parameters};

/// A finished fit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Best parameters.
    pub parameters: Parameters,
    /// Free coordinates, in the order of the covariance.
    pub free: Vec<Coordinate>,
    /// Covariance of the free coordinates for unit variance of the weighted residuals.
    #[serde(with = "row_by_row")]
    pub covariance: DMatrix<f64>,
    /// Sum of squared weighted residuals, priors included.
    pub cost: f64,
    /// Number of residuals, priors not counted.
    pub residuals: usize,
    /// Iterations and termination; stored with the method's result.
    #[serde(skip)]
    pub report: FitReport,
}

impl Fit {
    /// The parameters that are fitted, each with its place among the free coordinates.
    pub fn estimated(&self) -> Vec<(usize, Coordinate)> {
        let free = self.free.iter().copied().enumerate();
        free.filter(|(_, c)| Coordinate::PHYSICAL.contains(c))
            .collect()
    }

    /// Standard error of a coordinate; `None` if it was not free.
    pub fn error(&self, coordinate: Coordinate) -> Option<f64> {
        let i = self.free.iter().position(|c| *c == coordinate)?;
        Some(self.covariance[(i, i)].max(0.0).sqrt())
    }

    /// By how much the squares rise from here to other parameters, to second order; `None` where that is not determined.
    pub fn rise(&self, other: &Parameters) -> Option<f64> {
        let apart = |c: &Coordinate| other.coordinate(*c) - self.parameters.coordinate(*c);
        let apart = DVector::from_iterator(self.free.len(), self.free.iter().map(apart));
        Some(apart.dot(&(inverse(&self.covariance)? * &apart)))
    }

    /// Variance of a coordinate if all others are known; `None` if it was not free.
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
mod row_by_row {
    use nalgebra::DMatrix;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(
        matrix: &DMatrix<f64>,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        let rows: Vec<Vec<f64>> = matrix
            .row_iter()
            .map(|row| row.iter().copied().collect())
            .collect();
        rows.serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<DMatrix<f64>, D::Error> {
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
    /// Two masses hit each other and one of them is measured: approach speeds are not known.
    #[error("only one of the two masses is measured")]
    OneOfTwo,
    /// The speeds at impacts come from displacements.
    #[error("speeds at impacts come from displacements")]
    Differentiated,
    /// The velocities rang beside the impacts.
    #[error("the velocities ring beside the impacts")]
    Ringing,
    /// The accelerations are clipped at most impacts.
    #[error("the accelerations are clipped at most impacts")]
    Clipped,
    /// The solver ended without a point.
    #[error("the solver failed")]
    Solver,
    /// The slopes are dependent: the data do not determine the coordinates.
    #[error("the data do not separate the parameters")]
    Singular,
}
