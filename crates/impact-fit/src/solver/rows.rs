//! Rows that stand for residuals and their slopes.

use nalgebra::{DMatrix, DVector};

use crate::solver::normal::Normal;
use crate::solver::placed_rows::PlacedRows;
use crate::solver::reflection::NewRows;
use impact_records::signal::columns::{dot, subtract};

/// Rows [J r] of some weighted residuals and their slopes over some unknowns, or fewer rows that have
/// the same normal equations.
#[derive(Debug, Clone)]
pub struct Rows {
    /// Number of unknowns n.
    unknowns: usize,
    height: usize,
    /// [J r] column by column; the last column belongs to the residuals.
    entries: Vec<f64>,
    /// rᵀr.
    pub cost: f64,
    /// Number of residuals.
    pub count: usize,
}

/// Rows that are folded in together: as many as stay in the processor's caches.
pub(super) const BLOCK: usize = 256;

impl Rows {
    /// The triangle of no residuals, over n unknowns.
    pub(super) fn empty_triangle(unknowns: usize) -> Self {
        Self {
            unknowns,
            height: unknowns + 1,
            entries: vec![0.0; (unknowns + 1) * (unknowns + 1)],
            cost: 0.0,
            count: 0,
        }
    }

    /// Of some residuals with their slopes over n unknowns, column by column, each squared residual
    /// weighted: n + 1 rows at most.
    pub fn of(residuals: &[f64], slopes: &[Vec<f64>], weight: f64) -> Self {
        let root = weight.sqrt();
        let columns = || slopes.iter().map(Vec::as_slice).chain([residuals]);
        let mut rows = if residuals.len() > slopes.len() + 1 {
            let mut triangle = Self::empty_triangle(slopes.len());
            for start in (0..residuals.len()).step_by(BLOCK) {
                let block = start..(start + BLOCK).min(residuals.len());
                let mut new = NewRows::zeros(slopes.len() + 1, block.len());
                for (i, column) in columns().enumerate() {
                    let pairs = new.column_mut(i).iter_mut().zip(&column[block.clone()]);
                    pairs.for_each(|(to, x)| *to = root * x);
                }
                new.fold_into(&mut triangle.entries);
            }
            triangle
        } else {
            Self {
                height: residuals.len(),
                entries: columns().flatten().map(|x| root * x).collect(),
                ..Self::empty_triangle(slopes.len())
            }
        };
        rows.cost = weight * dot(residuals, residuals);
        rows.count = residuals.len();
        rows
    }

    /// Those over other unknowns, whose slopes are sums of multiples of these slopes.
    #[must_use]
    pub fn combined(&self, sums: &[Vec<(usize, f64)>]) -> Self {
        let mut entries = vec![0.0; self.height * (sums.len() + 1)];
        let (slopes, residuals) = entries.split_at_mut(self.height * sums.len());
        for (sum, into) in sums.iter().zip(slopes.chunks_exact_mut(self.height.max(1))) {
            for (i, times) in sum {
                subtract(into, -times, self.column(*i));
            }
        }
        residuals.copy_from_slice(self.column(self.unknowns));
        Self {
            unknowns: sums.len(),
            entries,
            ..*self
        }
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Number of rows.
    pub(crate) fn height(&self) -> usize {
        self.height
    }

    /// Column by column.
    pub(super) fn entries_mut(&mut self) -> &mut [f64] {
        &mut self.entries
    }

    /// Slopes over an unknown; those of the last, n, are the residuals.
    pub(crate) fn column(&self, i: usize) -> &[f64] {
        &self.entries[i * self.height..][..self.height]
    }

    /// The normal equations over all unknowns, of which these are at the given places.
    pub fn normal(&self, places: &[usize], unknowns: usize) -> Normal {
        let mut normal = Normal::zeros(unknowns);
        let residuals = self.column(self.unknowns);
        for (i, to) in places.iter().enumerate() {
            normal.gradient[*to] = dot(self.column(i), residuals);
            for (k, other) in places.iter().enumerate().take(i + 1) {
                let product = dot(self.column(i), self.column(k));
                normal.matrix[(*to, *other)] = product;
                normal.matrix[(*other, *to)] = product;
            }
        }
        normal.cost = self.cost;
        normal.count = self.count;
        normal
    }

    /// The rows that have slopes, over the unknowns at the given places of a fit that they depend on.
    pub fn placed(&self, places: &[usize]) -> PlacedRows {
        let has_slopes = |row: &usize| (0..self.unknowns).any(|i| self.column(i)[*row] != 0.0);
        let present: Vec<usize> = (0..self.height).filter(has_slopes).collect();
        let depends = |i: &usize| present.iter().any(|row| self.column(*i)[*row] != 0.0);
        let columns: Vec<usize> = (0..self.unknowns).filter(depends).collect();
        let entry = |row: usize, i: usize| self.column(columns[i])[present[row]];
        let residuals = present.iter().map(|row| self.column(self.unknowns)[*row]);
        PlacedRows {
            places: columns.iter().map(|i| places[*i]).collect(),
            slopes: DMatrix::from_fn(present.len(), columns.len(), entry),
            residuals: DVector::from_iterator(present.len(), residuals),
        }
    }
}
