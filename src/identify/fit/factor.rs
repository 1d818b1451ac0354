//! Triangular factor of weighted residuals and their slopes.
//!
//! Information is carried by its square root: the upper triangular R of [J r], of which the normal
//! equations are `RᵀR`. Forming `JᵀJ` would square the condition of the problem and lose half of its
//! digits. Rows are folded in by Householder reflections (Golub and Van Loan, Matrix Computations,
//! chapter 5), so that factors of parts stack into that of the whole.

use multiversion::multiversion;
use nalgebra::{DMatrix, DVector};

use crate::identify::fit::normal::Normal;
use crate::identify::fit::reduced_rows::Rows;

/// Upper triangular factor R of the rows [J r] of some residuals, with their cost and number.
#[derive(Debug, Clone)]
pub struct Factor {
    /// Number of unknowns n.
    unknowns: usize,
    /// R, (n + 1) × (n + 1), column by column; the last column belongs to the residuals.
    triangle: Vec<f64>,
    /// rᵀr.
    pub cost: f64,
    /// Number of residuals.
    pub count: usize,
}

/// Share of the square of a column that rounding may leave.
const ROUNDING: f64 = 1e-26;

/// Rows that are folded in together: as many as stay in the processor's first cache.
const BLOCK: usize = 128;

impl Factor {
    /// That of no residuals, over n unknowns.
    pub fn empty(unknowns: usize) -> Self {
        Self {
            unknowns,
            triangle: vec![0.0; (unknowns + 1) * (unknowns + 1)],
            cost: 0.0,
            count: 0,
        }
    }

    /// That of some residuals with their slopes over n unknowns, column by column, each squared
    /// residual weighted.
    pub fn of(residuals: &[f64], slopes: &[Vec<f64>], weight: f64) -> Self {
        let mut factor = Self::empty(slopes.len());
        if residuals.len() <= slopes.len() {
            return factor.of_few(residuals, slopes, weight);
        }
        let root = weight.sqrt();
        let mut rows = Vec::with_capacity(BLOCK * (slopes.len() + 1));
        for start in (0..residuals.len()).step_by(BLOCK) {
            let block = start..(start + BLOCK).min(residuals.len());
            rows.clear();
            for column in slopes.iter().map(Vec::as_slice).chain([residuals]) {
                rows.extend(column[block.clone()].iter().map(|x| root * x));
            }
            factor.fold(&mut rows, block.len());
        }
        factor.cost = weight * dot(residuals, residuals);
        factor.count = residuals.len();
        factor
    }

    /// That of fewer residuals than unknowns: each reflection uses up one of them. A column that those
    /// before it leave nothing but rounding of uses up none.
    fn of_few(mut self, residuals: &[f64], slopes: &[Vec<f64>], weight: f64) -> Self {
        let (width, height) = (self.unknowns + 1, residuals.len());
        let columns = slopes.iter().map(Vec::as_slice).chain([residuals]);
        let mut rows: Vec<f64> = columns.flatten().map(|x| weight.sqrt() * x).collect();
        let square = |column: &[f64]| inner(column, column);
        let squares: Vec<f64> = rows.chunks_exact(height.max(1)).map(square).collect();
        let mut used = 0;
        for (j, whole) in squares.iter().enumerate() {
            let (done, rest) = rows.split_at_mut((j + 1) * height);
            let pivot = &done[j * height..];
            if used < height && square(pivot) > ROUNDING * whole {
                reflect(&mut self.triangle, (j, width), pivot, (rest, height));
                used += 1;
            }
        }
        self.cost = weight * dot(residuals, residuals);
        self.count = height;
        self
    }

    /// That over other unknowns, whose slopes are sums of multiples of these slopes.
    #[must_use]
    pub fn combined(&self, sums: &[Vec<(usize, f64)>]) -> Self {
        let height = self.unknowns + 1;
        let column = |i: usize| &self.triangle[i * height..(i + 1) * height];
        let mut rows = vec![0.0; height * (sums.len() + 1)];
        let (slopes, residuals) = rows.split_at_mut(height * sums.len());
        for (sum, into) in sums.iter().zip(slopes.chunks_exact_mut(height)) {
            for (i, times) in sum {
                subtract(into, -times, column(*i));
            }
        }
        residuals.copy_from_slice(column(self.unknowns));
        let mut factor = Self::empty(sums.len());
        factor.fold(&mut rows, height);
        factor.cost = self.cost;
        factor.count = self.count;
        factor
    }

    /// The normal equations over all unknowns, of which these are at the given places.
    pub fn normal(&self, places: &[usize], unknowns: usize) -> Normal {
        let mut normal = Normal::zeros(unknowns);
        let column = |i: usize| &self.triangle[i * (self.unknowns + 1)..][..=i];
        for (i, to) in places.iter().enumerate() {
            normal.gradient[*to] = dot(column(i), &column(self.unknowns)[..=i]);
            for (k, other) in places.iter().enumerate().take(i + 1) {
                let product = dot(&column(i)[..=k], column(k));
                normal.matrix[(*to, *other)] = product;
                normal.matrix[(*other, *to)] = product;
            }
        }
        normal.cost = self.cost;
        normal.count = self.count;
        normal
    }

    /// The rows that have an unknown, over all unknowns, of which these are at the given places.
    pub fn rows(&self, places: &[usize], unknowns: usize) -> Rows {
        let present = self.present(self.unknowns);
        let mut slopes = DMatrix::zeros(present.len(), unknowns);
        for (k, to) in places.iter().enumerate() {
            for (row, i) in present.iter().enumerate().take_while(|(_, i)| **i <= k) {
                slopes[(row, *to)] = self.entry(*i, k);
            }
        }
        let residuals = present.iter().map(|i| self.entry(*i, self.unknowns));
        Rows {
            slopes,
            residuals: DVector::from_iterator(present.len(), residuals),
        }
    }

    /// Which of the first rows have entries: fewer residuals than unknowns leave some without.
    fn present(&self, rows: usize) -> Vec<usize> {
        (0..rows).filter(|i| self.entry(*i, *i) != 0.0).collect()
    }

    /// Add other residuals, whose unknowns are those at the given places among this factor's.
    pub fn add(&mut self, other: &Self, places: &[usize]) {
        let width = other.unknowns + 1;
        let present = other.present(width);
        let height = present.len();
        let mut rows = vec![0.0; height * (self.unknowns + 1)];
        let targets = places.iter().copied().chain([self.unknowns]);
        for (column, to) in other.triangle.chunks_exact(width).zip(targets) {
            let into = &mut rows[to * height..(to + 1) * height];
            into.iter_mut()
                .zip(&present)
                .for_each(|(x, i)| *x = column[*i]);
        }
        // The other factor is triangular: a column has entries in the rows of the unknowns up to it, the
        // residuals in all.
        let filled: Vec<usize> = if places.is_sorted() {
            let known = |to: usize| {
                let unknowns = places.partition_point(|p| *p <= to);
                present.partition_point(|i| *i < unknowns)
            };
            (0..self.unknowns).map(known).chain([height]).collect()
        } else {
            vec![height; self.unknowns + 1]
        };
        self.fold_columns(&mut rows, height, |column| filled[column]);
        self.cost += other.cost;
        self.count += other.count;
    }

    /// Fold rows [J r], given column by column, into the triangle; the rows are used up.
    fn fold(&mut self, rows: &mut [f64], height: usize) {
        self.fold_columns(rows, height, |_| height);
    }

    /// The same where only some first rows of each column, never fewer than of the one before, have
    /// entries.
    fn fold_columns(&mut self, rows: &mut [f64], height: usize, filled: impl Fn(usize) -> usize) {
        if height == 0 {
            return;
        }
        let width = self.unknowns + 1;
        for j in 0..width {
            let (done, rest) = rows.split_at_mut((j + 1) * height);
            let filled = filled(j);
            let pivot = &done[j * height..][..filled];
            reflect(&mut self.triangle, (j, width), pivot, (rest, height));
        }
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    fn entry(&self, row: usize, column: usize) -> f64 {
        self.triangle[column * (self.unknowns + 1) + row]
    }

    /// Norms of the columns of slopes: the square roots of the diagonal of `JᵀJ`.
    pub fn norms(&self) -> Vec<f64> {
        self.triangle
            .chunks_exact(self.unknowns + 1)
            .take(self.unknowns)
            .map(|column| dot(column, column).sqrt())
            .collect()
    }

    /// Step s that makes |Js + r|² + damping·|Ds|² least, D being diagonal; `None` if it is not
    /// determined.
    pub fn step(&self, damping: f64, diagonal: &[f64]) -> Option<Vec<f64>> {
        let n = self.unknowns;
        let mut damped = self.clone();
        let mut rows = vec![0.0; n * (n + 1)];
        for (i, d) in diagonal.iter().enumerate() {
            rows[i * n + i] = damping.sqrt() * d;
        }
        damped.fold(&mut rows, n);
        let mut step = vec![0.0; n];
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|k| damped.entry(i, k) * step[k]).sum();
            step[i] = -(damped.entry(i, n) + known) / damped.entry(i, i);
        }
        step.iter().all(|s| s.is_finite()).then_some(step)
    }

    /// |Js|: the length of a step in standard errors, for residuals of unit variance.
    pub fn length(&self, step: &[f64]) -> f64 {
        let row =
            |i: usize| -> f64 { (i..self.unknowns).map(|k| self.entry(i, k) * step[k]).sum() };
        (0..self.unknowns)
            .map(|i| row(i).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// (JᵀJ)⁻¹; `None` if the part of a column of slopes that is orthogonal to those before it is
    /// less than `least` of its norm.
    pub fn covariance(&self, least: f64) -> Option<DMatrix<f64>> {
        let n = self.unknowns;
        let norms = self.norms();
        let determined = (0..n).all(|i| self.entry(i, i).abs() > least * norms[i]);
        if !determined {
            return None;
        }
        let mut inverse = DMatrix::<f64>::zeros(n, n);
        for k in 0..n {
            inverse[(k, k)] = self.entry(k, k).recip();
            for i in (0..k).rev() {
                let known: f64 = (i + 1..=k)
                    .map(|l| self.entry(i, l) * inverse[(l, k)])
                    .sum();
                inverse[(i, k)] = -known / self.entry(i, i);
            }
        }
        Some(&inverse * inverse.transpose())
    }
}

/// Square of rows that are nothing: what rounding leaves of rounding, whose reciprocal overflows.
const NOTHING: f64 = 1e-280;

/// Fold the rows of one column, the pivot, into its diagonal entry of a triangle of so many columns by
/// a Householder reflection, which acts on the rows of all later columns, `height` apart.
///
/// The same arithmetic, in the same order, on vectors of any width: no bit depends on the processor.
#[multiversion(targets("x86_64+avx2"))]
fn reflect(
    triangle: &mut [f64],
    (j, width): (usize, usize),
    pivot: &[f64],
    (rest, height): (&mut [f64], usize),
) {
    let below = inner(pivot, pivot);
    if below < NOTHING {
        return;
    }
    let top = triangle[j * width + j];
    let end = -(top * top + below).sqrt().copysign(top);
    triangle[j * width + j] = end;
    // The reflection I − 2vvᵀ/vᵀv with v = (lead, pivot), where vᵀv = −2·end·lead.
    let lead = top - end;
    let scale = -(end * lead).recip();
    for (k, column) in rest.chunks_exact_mut(height).enumerate() {
        let head = &mut triangle[(j + 1 + k) * width + j];
        let column = &mut column[..pivot.len()];
        let share = scale * (lead * *head + inner(pivot, column));
        *head -= share * lead;
        less(column, share, pivot);
    }
}

/// Inner product.
#[multiversion(targets("x86_64+avx2"))]
pub(in crate::identify) fn dot(a: &[f64], b: &[f64]) -> f64 {
    inner(a, b)
}

/// Subtract a multiple of another column.
#[multiversion(targets("x86_64+avx2"))]
fn subtract(from: &mut [f64], share: f64, column: &[f64]) {
    less(from, share, column);
}

/// Inner product, in sixteen sums that do not wait for each other.
#[inline(always)]
fn inner(a: &[f64], b: &[f64]) -> f64 {
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<16>(), b.as_chunks::<16>());
    let mut sums = [0.0; 16];
    for (x, y) in a.iter().zip(b) {
        sums = std::array::from_fn(|i| sums[i] + x[i] * y[i]);
    }
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}

/// Subtract a multiple of another column.
#[inline(always)]
fn less(from: &mut [f64], share: f64, column: &[f64]) {
    let ((wide, rest), (others, other_rest)) = (from.as_chunks_mut::<8>(), column.as_chunks::<8>());
    for (x, y) in wide.iter_mut().zip(others) {
        *x = std::array::from_fn(|i| x[i] - share * y[i]);
    }
    for (x, y) in rest.iter_mut().zip(other_rest) {
        *x -= share * y;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_what_rounding_leaves_of_rounding_stays_finite() {
        for tiny in [1e-150, 1e-155, 1e-158, 1e-161, 5e-324] {
            let slopes = [vec![1.0, 2.0, 3.0], vec![tiny, -tiny, tiny]];
            let mut factor = Factor::of(&[0.1, 0.2, -0.1], &slopes, 1.0);
            let other = Factor::of(&[0.3, 0.1, 0.2], &slopes, 1.0);
            factor.add(&other, &[0, 1]);
            assert!(factor.triangle.iter().all(|x| x.is_finite()), "{tiny:e}");
        }
    }
}
