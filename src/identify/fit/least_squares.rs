//! Levenberg–Marquardt on the triangular factor of the residuals and their slopes.
//!
//! The loop knows nothing of what is fitted: a problem gives its factor and its cost at a point and
//! says where a step leads.

use serde::{Deserialize, Serialize};

use crate::identify::fit::factor::Factor;

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
    /// Damping of the first step, as a share of the information: the larger, the less the start
    /// is trusted.
    pub damping: f64,
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

/// How strongly steps are held back, and in which measure of the unknowns.
struct Hold {
    damping: f64,
    /// Scales of the unknowns: the norms of their slopes, falling slowly. A slope that vanishes
    /// suddenly does not set its unknown free (Moré 1978), and an old one is forgotten.
    scales: Vec<f64>,
}

/// Share of a scale that the next step remembers.
const MEMORY: f64 = 0.9;
const LEAST_DAMPING: f64 = 1e-18;
/// Damping that a refused step has at least.
const REFUSED_DAMPING: f64 = 1e-10;
const MOST_TRIALS: usize = 40;

impl Hold {
    fn remember(&mut self, factor: &Factor) {
        for (scale, norm) in self.scales.iter_mut().zip(factor.norms()) {
            *scale = (MEMORY * *scale).max(norm);
        }
    }

    /// Fall in cost that a step promises where the problem is linear.
    fn promise(&self, step: &[f64], length: f64) -> f64 {
        let scaled = step.iter().zip(&self.scales);
        let held: f64 = scaled.map(|(s, d)| (s * d).powi(2)).sum();
        length * length + 2.0 * self.damping * held
    }

    /// After a step that kept some share of its promise.
    fn ease(&mut self, kept: f64) {
        let factor = match kept {
            k if k > 0.75 => 0.2,
            k if k < 0.25 => 4.0,
            _ => 1.0,
        };
        self.damping = (self.damping * factor).max(LEAST_DAMPING);
    }

    fn tighten(&mut self) {
        self.damping = (self.damping * 4.0).max(REFUSED_DAMPING);
    }
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
    let mut hold = Hold {
        damping: limits.damping,
        scales: vec![0.0; minimum.factor.unknowns()],
    };
    while minimum.steps < limits.steps {
        hold.remember(&minimum.factor);
        match step(problem, &minimum, limits, &mut hold) {
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
    hold: &mut Hold,
) -> Step<P::Point> {
    let factor = &from.factor;
    let negligible = limits.negligible * deviation(factor, limits.variance);
    for _ in 0..MOST_TRIALS {
        let Some(step) = factor.step(hold.damping, &hold.scales) else {
            hold.tighten();
            continue;
        };
        let to = problem.moved(&from.point, &step);
        let length = factor.length(&step);
        match problem.cost(&to) {
            Some(cost) if cost < factor.cost => {
                hold.ease((factor.cost - cost) / hold.promise(&step, length));
                let negligible = length < negligible;
                return Step::Taken { to, negligible };
            }
            _ if length < negligible => return Step::Negligible,
            _ => hold.tighten(),
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
