//! Levenberg–Marquardt on the triangular factor of the residuals and their slopes.
//!
//! The loop knows nothing of what is fitted: a problem gives its factor and its cost at a point and
//! says where a step leads.

use serde::{Deserialize, Serialize};

use crate::identify::factor::Factor;

/// What is to be made least: a sum of squared residuals over some unknowns.
pub trait LeastSquares {
    /// Where the residuals are taken.
    type Point: Clone;

    /// Why they cannot be taken.
    type Error;

    /// Factor of the residuals and of their slopes over the unknowns.
    ///
    /// # Errors
    /// Where there is none at the point.
    fn factor(&self, at: &Self::Point) -> Result<Factor, Self::Error>;

    /// Sum of squared residuals; `None` where there is none at the point.
    fn cost(&self, at: &Self::Point) -> Option<f64>;

    /// The point that a step in the unknowns leads to.
    fn moved(&self, from: &Self::Point, step: &[f64]) -> Self::Point;
}

/// When the loop ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// A step is negligible that is shorter than this, in standard errors.
    pub negligible: f64,
    /// Variance of the residuals by which standard errors are meant.
    pub variance: Variance,
    /// Most steps taken.
    pub steps: usize,
}

/// Variance of the residuals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variance {
    /// One: the residuals are weighted.
    Unit,
    /// Told by the residuals themselves.
    Estimated,
}

/// How a fit ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// The step became negligible.
    Converged,
    /// The steps ran out first.
    TooManySteps,
    /// No step in any direction lowers the cost further, though the gradient is not yet zero.
    Stalled,
}

/// Where the loop ended.
#[derive(Debug, Clone)]
pub struct Minimum<Point> {
    /// The point.
    pub point: Point,
    /// Factor there.
    pub factor: Factor,
    /// How it ended.
    pub ending: Ending,
    /// Number of steps taken.
    pub steps: usize,
}

enum Step<Point> {
    Taken { to: Point, negligible: bool },
    Negligible,
    None,
}

/// Least sum of squares from a start.
///
/// # Errors
/// Those of the problem, at the start and where a step leads.
pub fn minimise<P: LeastSquares>(
    problem: &P,
    start: P::Point,
    limits: &Limits,
) -> Result<Minimum<P::Point>, P::Error> {
    let mut minimum = Minimum {
        factor: problem.factor(&start)?,
        point: start,
        ending: Ending::TooManySteps,
        steps: 0,
    };
    let mut damping = 1e-4;
    while minimum.steps < limits.steps {
        match step(problem, &minimum, limits, &mut damping) {
            Step::Taken { to, negligible } => {
                minimum.factor = problem.factor(&to)?;
                minimum.point = to;
                minimum.steps += 1;
                if negligible {
                    minimum.ending = Ending::Converged;
                    break;
                }
            }
            Step::Negligible => {
                minimum.ending = Ending::Converged;
                break;
            }
            Step::None => {
                minimum.ending = Ending::Stalled;
                break;
            }
        }
    }
    Ok(minimum)
}

fn step<P: LeastSquares>(
    problem: &P,
    from: &Minimum<P::Point>,
    limits: &Limits,
    damping: &mut f64,
) -> Step<P::Point> {
    let factor = &from.factor;
    let negligible = limits.negligible * deviation(factor, limits.variance);
    let diagonal: Vec<f64> = factor
        .norms()
        .into_iter()
        .map(|norm| if norm > 0.0 { norm } else { 1.0 })
        .collect();
    for _ in 0..16 {
        let Some(step) = factor.step(*damping, &diagonal) else {
            *damping = (*damping * 10.0).max(1e-6);
            continue;
        };
        let to = problem.moved(&from.point, &step);
        let length = factor.length(&step);
        match problem.cost(&to) {
            Some(cost) if cost < factor.cost => {
                *damping = (*damping * 0.2).max(1e-12);
                let negligible = length < negligible;
                return Step::Taken { to, negligible };
            }
            _ if length < negligible => return Step::Negligible,
            _ => *damping = (*damping * 8.0).max(1e-6),
        }
    }
    Step::None
}

/// Standard deviation of the residuals.
fn deviation(factor: &Factor, variance: Variance) -> f64 {
    match variance {
        Variance::Unit => 1.0,
        Variance::Estimated => {
            let freedom = factor.count.saturating_sub(factor.unknowns()).max(1);
            (factor.cost / freedom as f64).sqrt()
        }
    }
}
