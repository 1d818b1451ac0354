//! Scatter between groups of records beyond noise and nuisances: what the model does not contain.
//!
//! The records are parted by setting (one gap and direction of the sweep), by frequency and by
//! amplitude. Leaving out group g of a partition moves an estimate, to first
//! order, by `Δ_g` = (A − `A_g)⁻¹u_g` with A the information of all, `A_g` and `u_g` the group's own and its
//! gradient at the optimum. Were the residuals noise alone, its variance would be
//! (A − `A_g)⁻¹` − A⁻¹. The ratio
//!
//! `q_i` = `Σ_g` Δ²_{g,i} / `Σ_g` [(A − `A_g)⁻¹` − A⁻¹]_ii                                            (18)
//!
//! is one where the groups differ by no more than they must, and grows with what each group sees
//! otherwise than the others: the delete-a-group jackknife (CR3; Bell and `McCaffrey` 2002, Cameron and
//! Miller 2015) over its own expectation, a Birge ratio of each parameter. What the data, not the
//! stated uncertainties, leave open of a parameter is multiplied by it where it exceeds one; the
//! quantile is Student's with the degrees of freedom that the groups have. Of the partitions the one
//! that leaves the widest interval counts; those by frequency and amplitude only where `q_i` is beyond
//! its 99 % point under noise.

use std::collections::BTreeMap;

use nalgebra::DMatrix;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::parameters::Coordinate;
use crate::solver::group::{Group, PARTITIONS};
use crate::solver::normal::{Normal, inverse};
use crate::solver::{Fit, Problem};
use crate::statistics::quantile::{chi_squared_99, student_975};

/// How much the groups of one partition scatter in one coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Excess {
    /// The coordinate.
    pub coordinate: Coordinate,
    /// Scatter between groups over what noise and nuisances explain, as a ratio of variances.
    pub ratio: f64,
    /// Degrees of freedom of the ratio.
    pub freedom: f64,
    /// Share of the variance that the data leave, not the stated uncertainties.
    pub share: f64,
}

/// Scatter between groups in all coordinates that a fit estimates.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Scatter {
    /// Number of groups by setting.
    pub groups: usize,
    /// Of each coordinate and partition.
    pub excess: Vec<Excess>,
}

/// Standard error of an estimate and the degrees of freedom with which it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Standard error of the coordinate.
    pub error: f64,
    /// Part of it by scatter between groups.
    pub between_groups: f64,
    /// Degrees of freedom; infinite where the noise is known.
    pub freedom: f64,
}

impl Spread {
    /// Of an error that is known itself.
    pub fn known(error: f64) -> Self {
        Self {
            error,
            between_groups: 0.0,
            freedom: f64::INFINITY,
        }
    }

    /// With a further error that is known itself.
    #[must_use]
    pub fn with(self, error: f64) -> Self {
        let whole = self.error.hypot(error);
        let grown = if self.error > 0.0 {
            whole / self.error
        } else {
            1.0
        };
        Self {
            error: whole,
            freedom: self.freedom * grown.powi(4),
            ..self
        }
    }

    /// Half the 95 % interval.
    pub fn half95(self) -> f64 {
        student_975(self.freedom) * self.error
    }

    /// Upper end of the interval of a quantity that is not negative: noise that leaves less than nothing of it tells
    /// no more than noise that leaves nothing.
    pub fn upper_end(&self, value: f64, high: f64) -> f64 {
        if value < 0.0 {
            high.max(self.half95())
        } else {
            high
        }
    }
}

/// Fewest groups whose scatter says something.
const FEWEST: usize = 3;
/// Least part of a variance that a group must inform to count.
const LEAST: f64 = 1e-9;

/// The scatter between groups at a fit's optimum, by each partition of the records.
pub fn scatter(problem: &Problem<'_>, fit: &Fit) -> Scatter {
    let (cells, rest) = problem.groups(&fit.parameters);
    let mut all = rest.clone();
    cells.values().for_each(|cell| all.add(cell));
    let Some(covariance) = inverse(&all.matrix) else {
        return Scatter::default();
    };
    let data = &all.matrix - &rest.matrix;
    let whole = Whole {
        by_data: &covariance * data * &covariance,
        all,
        covariance,
    };
    let mut scatter = Scatter::default();
    for partition in 0..PARTITIONS {
        let groups = merged(&cells, partition);
        if groups.len() < FEWEST {
            continue;
        }
        if partition == 0 {
            scatter.groups = groups.len();
        }
        let found = whole.excess(&groups, &fit.free);
        // the partition by settings is that of the campaign's design; the others count where chance
        // does not explain them
        scatter
            .excess
            .extend(found.filter(|e| partition == 0 || e.is_significant()));
    }
    scatter
}

/// The groups of one partition.
fn merged(cells: &BTreeMap<Group, Normal>, partition: usize) -> Vec<Normal> {
    let mut groups: BTreeMap<usize, Normal> = BTreeMap::new();
    for (group, cell) in cells {
        groups
            .entry(group[partition])
            .and_modify(|sum| sum.add(cell))
            .or_insert_with(|| cell.clone());
    }
    groups.into_values().collect()
}

/// Normal equations of all data and priors, their inverse, and what the data inform of it.
struct Whole {
    all: Normal,
    covariance: DMatrix<f64>,
    by_data: DMatrix<f64>,
}

impl Whole {
    /// How much groups scatter in each coordinate.
    fn excess(&self, groups: &[Normal], free: &[Coordinate]) -> impl Iterator<Item = Excess> {
        let moves: Vec<(Vec<f64>, Vec<f64>)> = groups
            .par_iter()
            .filter_map(|group| left_out(&self.all, group, &self.covariance))
            .collect();
        free.iter().enumerate().filter_map(move |(i, coordinate)| {
            let expected = |m: &(Vec<f64>, Vec<f64>)| m.1[i];
            let variance = self.covariance[(i, i)];
            let counted = || moves.iter().filter(|m| expected(m) > LEAST * variance);
            let sum: f64 = counted().map(expected).sum();
            let squares: f64 = counted().map(|m| expected(m).powi(2)).sum();
            let found: f64 = counted().map(|m| m.0[i].powi(2)).sum();
            (sum > 0.0).then(|| Excess {
                coordinate: *coordinate,
                ratio: found / sum,
                freedom: (sum * sum / squares - 1.0).max(1.0),
                share: (self.by_data[(i, i)] / variance).clamp(0.0, 1.0),
            })
        })
    }
}

impl Excess {
    /// Whether chance makes the groups scatter so only in one of a hundred cases.
    fn is_significant(&self) -> bool {
        self.ratio * self.freedom > chi_squared_99(self.freedom)
    }

    /// Standard error of the coordinate that has a variance without it.
    fn spread(&self, variance: f64, factor: f64) -> Spread {
        let beyond = (self.ratio / factor - 1.0).max(0.0) * self.share * variance;
        let whole = variance + beyond;
        // Welch and Satterthwaite: only what the groups' scatter was found from is uncertain.
        let freedom = if beyond > 0.0 {
            self.freedom * (whole / beyond).powi(2)
        } else {
            f64::INFINITY
        };
        Spread {
            error: whole.sqrt(),
            between_groups: beyond.sqrt(),
            freedom,
        }
    }
}

/// What leaving out a group moves, and the variance of that under noise.
fn left_out(
    all: &Normal,
    group: &Normal,
    covariance: &DMatrix<f64>,
) -> Option<(Vec<f64>, Vec<f64>)> {
    let without = inverse(&(&all.matrix - &group.matrix))?;
    let moved = &without * &group.gradient;
    let gained = without.diagonal() - covariance.diagonal();
    Some((moved.as_slice().to_vec(), gained.as_slice().to_vec()))
}

impl Scatter {
    /// Standard error of a coordinate of a fit whose covariance is multiplied by a factor, by the
    /// partition whose groups leave the widest interval.
    pub fn spread(&self, fit: &Fit, factor: f64, coordinate: Coordinate) -> Option<Spread> {
        let variance = fit.error(coordinate)?.powi(2) * factor;
        let found = self.excess.iter().filter(|e| e.coordinate == coordinate);
        let spreads = found.map(|e| e.spread(variance, factor));
        let widest = spreads.max_by(|a, b| a.half95().total_cmp(&b.half95()));
        Some(widest.unwrap_or(Spread::known(variance.sqrt())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::Parameters;
    use crate::solver::{Block, Prior};

    /// Groups of measurements of R, each with a deviation of its own.
    struct Groups {
        values: Vec<Vec<f64>>,
        error: f64,
    }

    impl Block for Groups {
        fn items(&self) -> usize {
            self.values.len()
        }

        fn residuals(&self, item: usize, parameters: &Parameters) -> Option<Vec<f64>> {
            let of = |v: &f64| (v - parameters.restitution) / self.error;
            Some(self.values[item].iter().map(of).collect())
        }

        fn touches(&self, coordinate: Coordinate) -> bool {
            coordinate == Coordinate::Restitution
        }

        fn group(&self, item: usize) -> Option<Group> {
            Some([item, 0, 0])
        }
    }

    fn found(groups: &Groups) -> (Fit, Scatter) {
        let problem = Problem {
            blocks: vec![(groups, 1.0)],
            priors: vec![Prior {
                coordinate: Coordinate::Restitution,
                centre: 0.5,
                deviation: 1e3,
            }],
            free: vec![Coordinate::Restitution],
            ..Problem::default()
        };
        let fit = problem
            .fit(Parameters::symmetric(0.5, 10.0, 0.05, 1e-3))
            .expect("a fit");
        let scatter = scatter(&problem, &fit);
        (fit, scatter)
    }

    #[test]
    fn valid_the_ratio_of_equal_groups_is_that_of_an_analysis_of_variance() {
        // Four groups of two: means 0.4, 0.5, 0.6, 0.7, error 0.01 of each value.
        let values = [0.4, 0.5, 0.6, 0.7].map(|m| vec![m - 0.01, m + 0.01]);
        let groups = Groups {
            values: values.to_vec(),
            error: 0.01,
        };
        let (fit, scatter) = found(&groups);
        // Between-group mean square over the variance of a mean: Σ(m − m̄)²/3 / (0.01²/2).
        let want = 0.05 / 3.0 / (1e-4 / 2.0);
        let excess = scatter.excess[0];
        assert!((excess.ratio / want - 1.0).abs() < 1e-6, "{excess:?}");
        assert!((excess.freedom - 3.0).abs() < 1e-6);
        let spread = scatter
            .spread(&fit, 1.0, Coordinate::Restitution)
            .expect("a spread");
        // The standard error of the mean of four groups, √(Σ(m − m̄)²/3/4).
        assert!((spread.error - (0.05f64 / 12.0).sqrt()).abs() < 1e-6);
    }

    #[test]
    fn prop_groups_that_agree_leave_the_error_as_it_is() {
        let groups = Groups {
            values: vec![vec![0.49, 0.51]; 6],
            error: 0.01,
        };
        let (fit, scatter) = found(&groups);
        let spread = scatter
            .spread(&fit, 1.0, Coordinate::Restitution)
            .expect("a spread");
        assert_eq!(spread.between_groups, 0.0);
        assert_eq!(Some(spread.error), fit.error(Coordinate::Restitution));
    }
}
