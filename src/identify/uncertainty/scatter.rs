//! Scatter between groups of records beyond noise and nuisances: what the model does not contain.
//!
//! Leaving out group g of the records (one gap and direction of the sweep) moves an estimate, to first
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
//! quantile is Student's with the degrees of freedom that the groups have.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use crate::identify::fit::normal::{Normal, inverse};
use crate::identify::fit::parameters::Coordinate;
use crate::identify::fit::{Fit, Problem};
use crate::identify::uncertainty::quantile::student_975;

/// How much groups of records scatter in one coordinate.
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
    /// Number of groups.
    pub groups: usize,
    /// Of each coordinate.
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
}

/// Fewest groups whose scatter says something.
const FEWEST: usize = 3;
/// Least part of a variance that a group must inform to count.
const LEAST: f64 = 1e-9;

/// The scatter between groups at a fit's optimum.
pub fn scatter(problem: &Problem<'_>, fit: &Fit) -> Scatter {
    let (groups, rest) = problem.groups(&fit.parameters);
    if groups.len() < FEWEST {
        return Scatter::default();
    }
    let mut all = rest.clone();
    groups.values().for_each(|g| all.add(g));
    let data = &all.matrix - &rest.matrix;
    let Some(covariance) = inverse(&all.matrix) else {
        return Scatter::default();
    };
    let moves: Vec<(Vec<f64>, Vec<f64>)> = groups
        .values()
        .filter_map(|group| left_out(&all, group, &covariance))
        .collect();
    let by_data = &covariance * data * &covariance;
    let excess = fit.free.iter().enumerate().filter_map(|(i, coordinate)| {
        let expected = |m: &(Vec<f64>, Vec<f64>)| m.1[i];
        let least = LEAST * covariance[(i, i)];
        let counted: Vec<_> = moves.iter().filter(|m| expected(m) > least).collect();
        let sum: f64 = counted.iter().map(|m| expected(m)).sum();
        let squares: f64 = counted.iter().map(|m| expected(m).powi(2)).sum();
        let found: f64 = counted.iter().map(|m| m.0[i].powi(2)).sum();
        (sum > 0.0).then(|| Excess {
            coordinate: *coordinate,
            ratio: found / sum,
            freedom: (sum * sum / squares - 1.0).max(1.0),
            share: (by_data[(i, i)] / covariance[(i, i)]).clamp(0.0, 1.0),
        })
    });
    Scatter {
        groups: groups.len(),
        excess: excess.collect(),
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
    /// Standard error of a coordinate of a fit whose covariance is multiplied by a factor.
    pub fn spread(&self, fit: &Fit, factor: f64, coordinate: Coordinate) -> Option<Spread> {
        let variance = fit.error(coordinate)?.powi(2) * factor;
        let mut found = self.excess.iter();
        let Some(excess) = found.find(|e| e.coordinate == coordinate) else {
            return Some(Spread::known(variance.sqrt()));
        };
        let beyond = (excess.ratio / factor - 1.0).max(0.0) * excess.share * variance;
        let whole = variance + beyond;
        // Welch and Satterthwaite: only what the groups' scatter was found from is uncertain.
        let freedom = match beyond > 0.0 {
            true => excess.freedom * (whole / beyond).powi(2),
            false => f64::INFINITY,
        };
        Some(Spread {
            error: whole.sqrt(),
            between_groups: beyond.sqrt(),
            freedom,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::fit::parameters::Parameters;
    use crate::identify::fit::{Block, Prior};

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

        fn group(&self, item: usize) -> Option<usize> {
            Some(item)
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
