//! How far single records draw a fit away from what all others state.
//!
//! A record that fits badly is seen in its residuals; one that few others can contradict moves the
//! fit and fits well. Of each record, the estimate without it is compared with the one with
//! it, over the covariance of their difference, (AₖA⁻¹)-wise: with A = `LLᵀ` the information of all, J and r
//! the rows of the record's own factor, and h, v the eigenvalues and eigenvectors of J A⁻¹ Jᵀ,
//! Σ (v·r)²/(1−h) is χ² of as many degrees of freedom as the record informs directions.

use nalgebra::{DMatrix, SymmetricEigen};
use rayon::prelude::*;

use crate::solver::normal::{Normal, inverse};
use crate::solver::placed_rows::PlacedRows;
use impact_records::signal::robust;

/// A record's influence on a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Influence {
    /// χ² of the disagreement between the record and all others.
    pub chi2: f64,
    /// Directions in which the record informs.
    pub directions: usize,
}

impl Influence {
    /// That of a record of which nothing is used.
    fn none() -> Self {
        Self {
            chi2: 0.0,
            directions: 0,
        }
    }
}

/// Share of the information in a direction from which a record informs it.
const LEAST_SHARE: f64 = 1e-6;
/// Share of the information in a direction that the others must have to contradict the record.
const LEAST_OTHERS: f64 = 1e-6;

/// The influences of records at a fit's optimum; `None` where the information of all is singular.
pub fn influences(records: &[PlacedRows], others: &Normal) -> Option<Vec<Influence>> {
    let all = together(records, others);
    let scale = all.matrix.diagonal().map(|d| d.sqrt().recip());
    let scaled = DMatrix::from_fn(scale.len(), scale.len(), |i, k| {
        all.matrix[(i, k)] * scale[i] * scale[k]
    });
    let lower = scaled.cholesky()?.l();
    let influence = |record: &PlacedRows| {
        if record.residuals.is_empty() {
            return Some(Influence::none());
        }
        let mut turned = record.transposed(scale.len());
        for (mut row, scale) in turned.row_iter_mut().zip(scale.iter()) {
            row *= *scale;
        }
        if !lower.solve_lower_triangular_mut(&mut turned) {
            return None;
        }
        let axes = SymmetricEigen::try_new(turned.tr_mul(&turned), f64::EPSILON, 1000)?;
        let along = axes.eigenvectors.tr_mul(&record.residuals);
        let mut influence = Influence::none();
        for (h, u) in axes.eigenvalues.iter().zip(along.iter()) {
            if *h > LEAST_SHARE && *h < 1.0 - LEAST_OTHERS {
                influence.chi2 += u * u / (1.0 - h);
                influence.directions += 1;
            }
        }
        Some(influence)
    };
    records.par_iter().map(influence).collect()
}

/// Move all to the optimum of the sum of squares that they make together, to first order; `None` where
/// their information is singular.
pub fn without_gradient(records: &mut [PlacedRows], others: &mut Normal) -> Option<()> {
    let all = together(records, others);
    let step = -(inverse(&all.matrix)? * &all.gradient);
    for record in records {
        record.residuals += record.change(&step);
    }
    others.gradient += &others.matrix * &step;
    Some(())
}

/// What records inform beside all others. It is summed anew, as taking one record's away could leave
/// rounding where no other informs.
fn together(records: &[PlacedRows], others: &Normal) -> Normal {
    let mut all = others.clone();
    records.iter().for_each(|record| all.inform(record));
    all
}

/// Standard deviations of a normal variable from which an influence is not due to chance.
const SURE: f64 = 5.0;
/// The same for a record that there is another reason to doubt.
const DOUBTED: f64 = 2.5;
/// Of several influential ones, those are left out at once that have at least this share of the greatest.
const TOGETHER: f64 = 0.5;

/// The records that contradict the others beyond chance, the strongest of them only: without
/// them, the rest is judged again. Where all disagree more than noise explains, that much is
/// allowed to each.
pub fn strongest(influences: &[Influence], doubtful: &[bool]) -> Vec<usize> {
    let per_direction: Vec<f64> = influences
        .iter()
        .filter(|p| p.directions > 0)
        .map(|p| p.chi2 / p.directions as f64)
        .collect();
    let usual = robust::median(&per_direction).unwrap_or(1.0).max(1.0);
    let excess: Vec<f64> = influences
        .iter()
        .zip(doubtful)
        .map(|(p, doubted)| {
            let deviations = if *doubted { DOUBTED } else { SURE };
            p.chi2 / usual / chance(p.directions, deviations)
        })
        .collect();
    let most = excess.iter().copied().fold(0.0, f64::max);
    let limit = (TOGETHER * most).max(1.0);
    (0..excess.len()).filter(|i| excess[*i] > limit).collect()
}

/// The χ² that chance exceeds as rarely as a normal variable so many deviations (Wilson and
/// Hilferty's approximation); infinite where nothing is informed.
fn chance(directions: usize, deviations: f64) -> f64 {
    if directions == 0 {
        return f64::INFINITY;
    }
    let k = directions as f64;
    let spread = 2.0 / (9.0 * k);
    k * (1.0 - spread + deviations * spread.sqrt()).powi(3)
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::*;

    /// One residual and its slopes.
    fn record(slopes: &[f64], residual: f64) -> PlacedRows {
        PlacedRows {
            places: (0..slopes.len()).collect(),
            slopes: DMatrix::from_row_slice(1, slopes.len(), slopes),
            residuals: DVector::from_element(1, residual),
        }
    }

    #[test]
    fn valid_an_influence_is_the_squared_studentised_residual_of_one_measurement() {
        // Three equal measurements of one number: residuals from their mean.
        let values = [0.3, -1.0, 2.2];
        let mean = values.iter().sum::<f64>() / 3.0;
        let records = values.map(|v| record(&[1.0], mean - v));
        let found = influences(&records, &Normal::zeros(1)).expect("regular");
        for (influence, value) in found.iter().zip(values) {
            // Against the mean of the other two: variance 1 + 1/2.
            let others = (3.0 * mean - value) / 2.0;
            assert!((influence.chi2 - (value - others).powi(2) / 1.5).abs() < 1e-9);
        }
    }

    #[test]
    fn a_record_of_which_nothing_is_used_has_no_influence() {
        let nothing = PlacedRows {
            places: vec![0],
            slopes: DMatrix::zeros(0, 1),
            residuals: DVector::zeros(0),
        };
        let records = [record(&[1.0], 0.3), nothing];
        let found = influences(&records, &Normal::zeros(1)).expect("regular");
        assert_eq!(found[1].directions, 0);
        assert_eq!(strongest(&found, &[false; 2]), Vec::<usize>::new());
    }

    #[test]
    fn valid_a_record_that_drags_the_fit_along_is_found() {
        // Many tell the first coordinate, two the second, of which one is wrong by 20 deviations:
        // the fit halves the difference, and the residual of each is 10.
        let mut records: Vec<PlacedRows> = (0..40)
            .map(|i| record(&[-1.0, 0.0], if i % 2 == 0 { 1.0 } else { -1.0 }))
            .collect();
        records.push(record(&[0.0, -1.0], 10.0));
        records.push(record(&[0.0, -1.0], -10.0));
        let found = influences(&records, &Normal::zeros(2)).expect("regular");
        // Two that contradict each other accuse each other alike.
        assert_eq!(strongest(&found, &[false; 42]), vec![40, 41]);
        assert!((found[40].chi2 - 200.0).abs() < 1e-6);
    }

    #[test]
    fn valid_chance_is_the_quantile_of_chi2() {
        // Quantiles at 2.87e-7: 25.7 (one, two-sided would be 5 sigma squared = 25), 50.8 (ten).
        assert!((chance(10, SURE) - 50.8).abs() < 1.0);
        assert!(chance(0, SURE).is_infinite());
    }
}
