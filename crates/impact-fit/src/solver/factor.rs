//! Triangular factor of weighted residuals and their slopes.
//!
//! Information is carried by its square root: the upper triangular R of [J r], of which the normal
//! equations are `RᵀR`. Forming `JᵀJ` would square the condition of the problem and lose half of its
//! digits. Rows are folded in by reflections, so that factors of parts stack into that of the whole.

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::solver::reflection::NewRows;
use crate::solver::rows::{BLOCK, Rows};
use impact_records::signal::columns::dot;

/// Rows with the places of their unknowns among those of a factor.
pub(super) type Placed<'a> = (&'a Rows, &'a [usize]);

/// Upper triangular factor R of the rows [J r] of some residuals, with their cost and number.
#[derive(Debug, Clone)]
pub struct Factor(Rows);

impl Factor {
    /// That of no residuals, over n unknowns.
    pub fn empty(unknowns: usize) -> Self {
        Self(Rows::empty_triangle(unknowns))
    }

    /// That of some residuals with their slopes over n unknowns, column by column.
    pub fn of(residuals: &[f64], slopes: &[Vec<f64>]) -> Self {
        let places: Vec<usize> = (0..slopes.len()).collect();
        let mut factor = Self::empty(slopes.len());
        factor.add(&[(&Rows::of(residuals, slopes, 1.0), places.as_slice())]);
        factor
    }

    /// That of many parts, rows whose unknowns are those at the given places among n. They are folded
    /// on all threads, in blocks of fixed size, so that the number of threads changes nothing.
    pub(super) fn joined(unknowns: usize, parts: &[Placed<'_>]) -> Self {
        let of_block = |block: &&[Placed<'_>]| {
            let mut factor = Self::empty(unknowns);
            factor.fold(block);
            factor
        };
        let blocks = blocks(parts).par_iter().map(of_block).collect();
        Self::stacked(unknowns, blocks)
    }

    /// That of factors over the same n unknowns.
    pub(super) fn stacked(unknowns: usize, factors: Vec<Self>) -> Self {
        let mut factors = factors.into_iter();
        let mut whole = factors.next().unwrap_or_else(|| Self::empty(unknowns));
        let rest: Vec<Self> = factors.collect();
        let all: Vec<usize> = (0..unknowns).collect();
        let rest = rest.iter().map(|factor| (factor.rows(), &all[..]));
        whole.add(&Vec::from_iter(rest));
        whole
    }

    /// Add rows whose unknowns are those at the given places among this factor's.
    pub(super) fn add(&mut self, parts: &[Placed<'_>]) {
        for block in blocks(parts) {
            self.fold(block);
        }
    }

    /// Fold rows into the triangle: those first that have slopes over the first unknowns, so that each
    /// column has entries in its first rows alone.
    fn fold(&mut self, parts: &[Placed<'_>]) {
        if parts.is_empty() {
            return;
        }
        let unknowns = self.unknowns();
        let mut starts = vec![0; unknowns + 2];
        let firsts: Vec<Vec<usize>> = parts.iter().map(|part| firsts(*part, unknowns)).collect();
        for first in firsts.iter().flatten() {
            starts[first + 1] += 1;
        }
        for i in 0..=unknowns {
            starts[i + 1] += starts[i];
        }
        let mut new = NewRows::zeros(unknowns + 1, starts[unknowns + 1]);
        for ((rows, places), firsts) in parts.iter().zip(firsts) {
            let to_row = firsts.into_iter().map(|first| {
                starts[first] += 1;
                starts[first] - 1
            });
            let to_row: Vec<usize> = to_row.collect();
            for (i, to) in places.iter().chain([&unknowns]).enumerate() {
                let column = new.column_mut(*to);
                for (row, entry) in to_row.iter().zip(rows.column(i)) {
                    column[*row] = *entry;
                }
            }
            self.0.cost += rows.cost;
            self.0.count += rows.count;
        }
        new.fold_into(self.0.entries_mut());
    }

    /// The triangle.
    pub fn rows(&self) -> &Rows {
        &self.0
    }

    /// rᵀr.
    pub fn cost(&self) -> f64 {
        self.0.cost
    }

    /// Number of residuals.
    pub fn count(&self) -> usize {
        self.0.count
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.0.unknowns()
    }

    fn entry(&self, row: usize, column: usize) -> f64 {
        self.0.column(column)[row]
    }

    /// Norms of the columns of slopes: the square roots of the diagonal of `JᵀJ`.
    pub fn norms(&self) -> Vec<f64> {
        let norm = |i: usize| dot(self.0.column(i), self.0.column(i)).sqrt();
        (0..self.unknowns()).map(norm).collect()
    }

    /// Step s that makes |Js + r|² + damping·|Ds|² least, D being diagonal; `None` if it is not
    /// determined.
    pub fn step(&self, damping: f64, diagonal: &[f64]) -> Option<Vec<f64>> {
        let n = self.unknowns();
        let mut damped = self.clone();
        let mut rows = NewRows::zeros(n + 1, n);
        for (i, d) in diagonal.iter().enumerate() {
            rows.column_mut(i)[i] = damping.sqrt() * d;
        }
        rows.fold_into(damped.0.entries_mut());
        let mut step = vec![0.0; n];
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|k| damped.entry(i, k) * step[k]).sum();
            step[i] = -(damped.entry(i, n) + known) / damped.entry(i, i);
        }
        step.iter().all(|s| s.is_finite()).then_some(step)
    }

    /// |Js|: the length of a step in standard errors, for residuals of unit variance.
    pub fn length(&self, step: &[f64]) -> f64 {
        let row = |i: usize| -> f64 {
            (i..self.unknowns())
                .map(|k| self.entry(i, k) * step[k])
                .sum()
        };
        (0..self.unknowns())
            .map(|i| row(i).powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// (JᵀJ)⁻¹; `None` if the part of a column of slopes that is orthogonal to those before it is
    /// less than `least` of its norm.
    pub fn covariance(&self, least: f64) -> Option<DMatrix<f64>> {
        let n = self.unknowns();
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

/// Of each row of a part the place of its first slope that is not zero; n for none.
fn firsts((rows, places): Placed<'_>, unknowns: usize) -> Vec<usize> {
    let mut firsts = vec![unknowns; rows.height()];
    for (i, place) in places.iter().enumerate() {
        for (first, slope) in firsts.iter_mut().zip(rows.column(i)) {
            if *slope != 0.0 {
                *first = (*first).min(*place);
            }
        }
    }
    firsts
}

/// Parts one after the other, of so many rows together as are folded at once.
fn blocks<'a, 'p>(parts: &'p [Placed<'a>]) -> Vec<&'p [Placed<'a>]> {
    let mut height = 0;
    let mut start = 0;
    let mut blocks = Vec::new();
    for (i, (rows, _)) in parts.iter().enumerate() {
        if i > start && height + rows.height() > BLOCK {
            blocks.push(&parts[start..i]);
            (start, height) = (i, 0);
        }
        height += rows.height();
    }
    blocks.push(&parts[start..]);
    blocks
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::solver::normal::Normal;

    /// Numbers of no pattern.
    fn noise(seed: u64, count: usize) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        (0..count).map(|_| random.random_range(-1.0..1.0)).collect()
    }

    /// Rows whose unknowns are some of those of a fit, the middle one of no effect.
    fn part(seed: u64, height: usize, places: &[usize]) -> Rows {
        let slopes = |i: &usize| match i {
            4 => vec![0.0; height],
            i => noise(seed + *i as u64, height),
        };
        let slopes: Vec<Vec<f64>> = places.iter().map(slopes).collect();
        Rows::of(&noise(seed, height), &slopes, 0.7)
    }

    #[test]
    fn prop_a_factor_has_the_normal_equations_of_its_parts() {
        for (heights, seed) in [
            (vec![1, 1, 2], 10),
            (vec![5, 40, 3], 20),
            (vec![300, 12, 700], 30),
        ] {
            let places = [vec![0, 2, 4, 6], vec![6, 1, 3], vec![0, 1, 2, 3, 4, 5, 6]];
            let parts: Vec<Rows> = (0..3)
                .map(|i| part(seed + 100 * i as u64, heights[i], &places[i]))
                .collect();
            let mut factor = Factor::empty(7);
            let pairs = parts.iter().zip(&places);
            let pairs: Vec<Placed<'_>> = pairs.map(|(rows, p)| (rows, p.as_slice())).collect();
            factor.add(&pairs);
            let mut sum = Normal::zeros(7);
            let pairs = parts.iter().zip(&places);
            pairs.for_each(|(rows, places)| sum.add(&rows.normal(places, 7)));
            let all: Vec<usize> = (0..7).collect();
            let found = factor.rows().normal(&all, 7);
            let most = sum.matrix.amax().max(sum.gradient.amax());
            assert!((found.matrix - sum.matrix).amax() < 1e-13 * most);
            assert!((found.gradient - sum.gradient).amax() < 1e-13 * most);
            assert_eq!((factor.count(), found.count), (sum.count, sum.count));
            assert!((factor.cost() - sum.cost).abs() < 1e-12 * sum.cost);
            let below = |i: usize| factor.0.column(i)[i + 1..].iter().all(|x| *x == 0.0);
            assert!((0..8).all(below));
        }
    }

    #[test]
    fn prop_sums_of_columns_are_slopes_of_other_unknowns() {
        let (height, slopes) = (60, [noise(1, 60), noise(2, 60), noise(3, 60)]);
        let sums = [
            vec![(0, 2.0), (2, -0.5)],
            vec![(1, 1.0)],
            vec![],
            vec![(0, 1.0), (1, 3.0), (2, 1.0)],
        ];
        let total = |sum: &Vec<(usize, f64)>| -> Vec<f64> {
            let at = |row: usize| sum.iter().map(|(i, times)| times * slopes[*i][row]).sum();
            (0..height).map(at).collect()
        };
        let residuals = noise(4, height);
        let whole = Rows::of(&residuals, &sums.each_ref().map(total), 2.0);
        let combined = Rows::of(&residuals, &slopes, 2.0).combined(&sums);
        let places = [0, 1, 2, 3];
        let (want, found) = (whole.normal(&places, 4), combined.normal(&places, 4));
        assert!((found.matrix - want.matrix).amax() < 1e-11);
        assert!((found.gradient - want.gradient).amax() < 1e-11);
        assert_eq!(combined.placed(&places).slopes.nrows(), 3);
    }

    #[test]
    fn prop_what_rounding_leaves_of_rounding_stays_finite() {
        for tiny in [1e-150, 1e-155, 1e-158, 1e-161, 5e-324] {
            let slopes = [vec![1.0, 2.0, 3.0], vec![tiny, -tiny, tiny]];
            let mut factor = Factor::of(&[0.1, 0.2, -0.1], &slopes);
            let other = Factor::of(&[0.3, 0.1, 0.2], &slopes);
            factor.add(&[(other.rows(), [0, 1].as_slice())]);
            let is_finite = |i| factor.0.column(i).iter().all(|x| x.is_finite());
            assert!((0..3).all(is_finite), "{tiny:e}");
        }
    }
}
