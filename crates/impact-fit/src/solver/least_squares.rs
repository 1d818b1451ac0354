//! Levenberg–Marquardt on the triangular factor of the residuals and their slopes, as a solver of
//! argmin's executor.
//!
//! The solver is independent of what is fitted: a problem gives its factor and its cost at a point and
//! the point that a step leads to.

use argmin::argmin_error_closure;
use argmin::core::observers::ObserverMode;
use argmin::core::{Error, Executor, IterState, KV, Problem, Solver, State, TerminationReason};

use crate::solver::factor::Factor;
use crate::solver::progress::FitProgress;
use crate::solver::report::{FitReport, STALLED};

/// A sum of squared residuals over some unknowns, which [`minimise`] makes least.
pub trait LeastSquares {
    /// Where the residuals are taken.
    type Point: Clone;

    /// Factor of the residuals and of their slopes over the unknowns.
    ///
    /// # Errors
    /// The problem's own, if there is no factor at the point.
    fn factor(&self, at: &Self::Point) -> Result<Factor, Error>;

    /// Sum of squared residuals; `None` if there is none at the point.
    fn cost(&self, at: &Self::Point) -> Option<f64>;

    /// The point that a step in the unknowns leads to.
    fn moved(&self, from: &Self::Point, step: &[f64]) -> Self::Point;

    /// What counts the iterations.
    fn progress(&self) -> FitProgress {
        FitProgress::default()
    }
}

/// When the solver ends, and how it begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// A step shorter than this, in standard errors, is negligible.
    pub negligible: f64,
    /// Variance of the residuals in the standard errors.
    pub variance: Variance,
    /// Damping of the first step, as a share of the information: the larger, the less the start
    /// is trusted.
    pub damping: f64,
    /// Most iterations.
    pub iterations: u64,
}

/// Variance of the residuals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variance {
    /// One, as the residuals are weighted, or more where they are greater than the weights have it.
    AtLeastUnit,
    /// Estimated from the residuals.
    Estimated,
}

/// Where the solver ended.
#[derive(Debug, Clone)]
pub struct Minimum<Point> {
    /// The point.
    pub point: Point,
    /// Factor there.
    pub factor: Factor,
    /// Iterations and termination.
    pub report: FitReport,
}

/// The point, and the factor there in place of a Jacobian.
type FitState<Point> = IterState<Point, (), Factor, (), (), f64>;

/// Least sum of squares from a start.
///
/// # Errors
/// Those of the problem's factor at the start.
pub fn minimise<P: LeastSquares>(
    problem: &P,
    start: P::Point,
    limits: &Limits,
) -> Result<Minimum<P::Point>, Error>
where
    P::Point: 'static,
{
    let result = Executor::new(problem, DampedSteps::new(limits))
        .configure(|state: FitState<P::Point>| state.param(start).max_iters(limits.iterations))
        .add_observer(problem.progress(), ObserverMode::Always)
        .run()?;
    let mut state = result.state;
    let (iterations, termination) = (state.get_iter(), state.get_termination_reason().cloned());
    let (point, factor) = taken(&mut state)?;
    Ok(Minimum {
        report: FitReport {
            iterations,
            cost: factor.cost(),
            damping: result.solver.damping,
            termination: termination.unwrap_or_default(),
        },
        point,
        factor,
    })
}

/// The point of a state and its factor, which are moved out of it.
fn taken<Point: Clone>(state: &mut FitState<Point>) -> Result<(Point, Factor), Error> {
    state
        .take_param()
        .zip(state.take_jacobian())
        .ok_or_else(argmin_error_closure!(
            NotInitialized,
            "a fit needs a point and its factor"
        ))
}

/// Names under which argmin counts the evaluations.
const COST: &str = "cost_count";
const FACTOR: &str = "factor_count";
const STEP: &str = "step_count";

/// Levenberg–Marquardt: how strongly steps are damped, and in which measure of the unknowns.
struct DampedSteps<'a> {
    limits: &'a Limits,
    damping: f64,
    /// Steps in a row that were as good as linear.
    linear: u32,
    /// Whether the last step was taken as it was first tried: then the next is expected to be, and its
    /// factor is evaluated at once.
    sure: bool,
    /// Length of the last step, in standard errors for residuals of unit variance; zero before the first.
    length: f64,
    /// Steps in a row that lowered the cost by more than predicted, and how much longer the next is made.
    short: u32,
    stretch: f64,
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
/// Steps in a row that were as good as linear, from which on the problem is taken to be.
const LINEAR: u32 = 3;
/// Share of the predicted reduction from which a step counts as short, as those of residuals that are bounded do; steps in
/// a row from which the next is made longer, and how many times at most.
const SHORT: f64 = 1.2;
const SHORT_STEPS: u32 = 2;
const MOST_STRETCH: f64 = 8.0;
/// How far from 1 the share of the predicted reduction may be where steps shrink steadily, and how much
/// shorter each step must then be.
const STEADY: f64 = 0.2;

/// What the trials from a point led to.
enum Trial<Point> {
    /// A point of lower cost with its factor, and whether what remains is negligible.
    Lower {
        to: Point,
        factor: Factor,
        negligible: bool,
    },
    /// No lower cost within a negligible step.
    Negligible,
    /// No lower cost at any damping.
    Stalled,
}

impl<'a> DampedSteps<'a> {
    fn new(limits: &'a Limits) -> Self {
        Self {
            limits,
            damping: limits.damping,
            linear: 0,
            sure: true,
            length: 0.0,
            short: 0,
            stretch: 1.0,
            scales: Vec::new(),
        }
    }

    /// Make the next step as much longer as the last one was too short: of a parabola of the cost along it whose
    /// curvature is 2 − share of what was expected, as far as its minimum.
    fn adapt_stretch(&mut self, share: f64) {
        let longer = self.stretch / (2.0 - share).max(MOST_STRETCH.recip());
        self.short = if longer > SHORT { self.short + 1 } else { 0 };
        self.stretch = if self.short < SHORT_STEPS {
            1.0
        } else {
            longer.min(MOST_STRETCH)
        };
    }

    fn update_scales(&mut self, factor: &Factor) {
        for (scale, norm) in self.scales.iter_mut().zip(factor.norms()) {
            *scale = (MEMORY * *scale).max(norm);
        }
    }

    /// Fall in cost that a step of some length leads to if the problem is linear.
    fn predicted_reduction(&self, step: &[f64], length: f64) -> f64 {
        let scaled = step.iter().zip(&self.scales);
        let damped: f64 = scaled.map(|(s, d)| (s * d).powi(2)).sum();
        length * length + 2.0 * self.damping * damped
    }

    /// After a step whose reduction is this share of the predicted one; a poor prediction increases
    /// the damping nevertheless, and after several good ones the steps soon are Gauss and Newton's.
    fn decrease_damping(&mut self, share: f64) {
        self.linear = if share > 0.95 { self.linear + 1 } else { 0 };
        let factor = match share {
            _ if self.linear >= LINEAR => 0.01,
            s if s > 0.75 => 0.2,
            s if s < 0.25 => 4.0,
            _ => 1.0,
        };
        self.damping = (self.damping * factor).max(LEAST_DAMPING);
    }

    fn increase_damping(&mut self) {
        self.sure = false;
        (self.short, self.stretch) = (0, 1.0);
        self.damping = (self.damping * 4.0).max(REFUSED_DAMPING);
    }

    /// Whether steps are negligible from here on: the last was, or it was so much shorter than the one
    /// before that the next, shorter by the same factor, will be.
    fn is_last(&self, length: f64, share: f64, negligible: f64) -> bool {
        let shrinks = length / self.length;
        let steady = (share - 1.0).abs() < STEADY && shrinks < STEADY;
        length < negligible || (steady && length * shrinks < negligible)
    }

    /// Cost where a step leads, with the factor where the step is expected to be taken; `None` where
    /// there is none.
    fn evaluate<P: LeastSquares>(
        &self,
        problem: &mut Problem<&P>,
        to: &P::Point,
        at_once: bool,
    ) -> Result<Option<(f64, Option<Factor>)>, Error> {
        if at_once {
            let found = problem.problem(FACTOR, |p| Ok(p.factor(to).ok()))?;
            return Ok(found.map(|factor| (factor.cost(), Some(factor))));
        }
        let cost = problem.problem(COST, |p| Ok(p.cost(to)))?;
        Ok(cost.map(|cost| (cost, None)))
    }

    /// Try steps of increasing damping until one lowers the cost.
    fn try_steps<P: LeastSquares>(
        &mut self,
        problem: &mut Problem<&P>,
        from: &P::Point,
        factor: &Factor,
    ) -> Result<Trial<P::Point>, Error> {
        let negligible = self.limits.negligible * deviation(factor, self.limits.variance);
        for _ in 0..MOST_TRIALS {
            let Some(step) = factor.step(self.damping, &self.scales) else {
                self.increase_damping();
                continue;
            };
            let step: Vec<f64> = step.iter().map(|s| self.stretch * s).collect();
            let length = factor.length(&step);
            let to = problem.problem(STEP, |p| Ok(p.moved(from, &step)))?;
            let found = self.evaluate(problem, &to, self.sure)?;
            match found {
                Some((cost, there)) if cost < factor.cost() => {
                    let predicted = self.predicted_reduction(&step, length);
                    let share = self.stretch * (factor.cost() - cost) / predicted;
                    let negligible = self.is_last(length, share, negligible);
                    self.decrease_damping(share);
                    self.adapt_stretch(share);
                    (self.sure, self.length) = (true, length);
                    let factor = match there {
                        Some(factor) => factor,
                        None => problem.problem(FACTOR, |p| p.factor(&to))?,
                    };
                    return Ok(Trial::Lower {
                        to,
                        factor,
                        negligible,
                    });
                }
                _ if length < negligible => return Ok(Trial::Negligible),
                _ => self.increase_damping(),
            }
        }
        Ok(Trial::Stalled)
    }
}

impl<P: LeastSquares> Solver<&P, FitState<P::Point>> for DampedSteps<'_> {
    fn name(&self) -> &str {
        "Levenberg–Marquardt"
    }

    fn init(
        &mut self,
        problem: &mut Problem<&P>,
        mut state: FitState<P::Point>,
    ) -> Result<(FitState<P::Point>, Option<KV>), Error> {
        let start = state
            .take_param()
            .ok_or_else(argmin_error_closure!(NotInitialized, "a fit needs a start"))?;
        let factor = problem.problem(FACTOR, |p| p.factor(&start))?;
        self.scales = vec![0.0; factor.unknowns()];
        let state = state.param(start).cost(factor.cost()).jacobian(factor);
        Ok((state, None))
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<&P>,
        mut state: FitState<P::Point>,
    ) -> Result<(FitState<P::Point>, Option<KV>), Error> {
        let (from, factor) = taken(&mut state)?;
        self.update_scales(&factor);
        let trial = self.try_steps(problem, &from, &factor)?;
        let (point, factor, end) = match trial {
            Trial::Lower {
                to,
                factor,
                negligible,
            } => {
                let end = negligible.then_some(TerminationReason::SolverConverged);
                (to, factor, end)
            }
            Trial::Negligible => (from, factor, Some(TerminationReason::SolverConverged)),
            Trial::Stalled => {
                let stalled = TerminationReason::SolverExit(STALLED.into());
                (from, factor, Some(stalled))
            }
        };
        let state = state.param(point).cost(factor.cost()).jacobian(factor);
        let state = match end {
            Some(reason) => state.terminate_with(reason),
            None => state,
        };
        Ok((state, None))
    }
}

/// Standard deviation of the residuals.
fn deviation(factor: &Factor, variance: Variance) -> f64 {
    let freedom = factor.count().saturating_sub(factor.unknowns()).max(1);
    // counts of residuals are far below 2⁵³
    let estimated = (factor.cost() / freedom as f64).sqrt();
    match variance {
        Variance::AtLeastUnit => estimated.max(1.0),
        Variance::Estimated => estimated,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Residuals over two unknowns with their slopes; the cost may be withheld.
    struct Curve {
        residuals: fn([f64; 2]) -> [f64; 3],
        slopes: fn([f64; 2]) -> [[f64; 3]; 2],
        has_cost: bool,
    }

    impl LeastSquares for Curve {
        type Point = [f64; 2];

        fn factor(&self, at: &[f64; 2]) -> Result<Factor, Error> {
            if at[0] > 1e3 {
                return Err(Error::msg("out of reach"));
            }
            let slopes = (self.slopes)(*at).map(|column| column.to_vec());
            Ok(Factor::of(&(self.residuals)(*at), &slopes))
        }

        fn cost(&self, at: &[f64; 2]) -> Option<f64> {
            let cost = (self.residuals)(*at).iter().map(|r| r * r).sum();
            self.has_cost.then_some(cost)
        }

        fn moved(&self, from: &[f64; 2], step: &[f64]) -> [f64; 2] {
            [from[0] + step[0], from[1] + step[1]]
        }
    }

    /// The line a + bt through 1, 3, 5 at t = 0, 1, 2: a = 1, b = 2.
    const LINE: Curve = Curve {
        residuals: |[a, b]| [a - 1.0, a + b - 3.0, a + 2.0 * b - 5.0],
        slopes: |_| [[1.0; 3], [0.0, 1.0, 2.0]],
        has_cost: true,
    };

    /// Rosenbrock's valley, least at (1, 1).
    const VALLEY: Curve = Curve {
        residuals: |[x, y]| [10.0 * (y - x * x), 1.0 - x, 0.0],
        slopes: |[x, _]| [[-20.0 * x, -1.0, 0.0], [10.0, 0.0, 0.0]],
        has_cost: true,
    };

    /// The valley with its iterations counted.
    struct Counted(FitProgress);

    impl LeastSquares for Counted {
        type Point = [f64; 2];

        fn factor(&self, at: &[f64; 2]) -> Result<Factor, Error> {
            VALLEY.factor(at)
        }

        fn cost(&self, at: &[f64; 2]) -> Option<f64> {
            VALLEY.cost(at)
        }

        fn moved(&self, from: &[f64; 2], step: &[f64]) -> [f64; 2] {
            VALLEY.moved(from, step)
        }

        fn progress(&self) -> FitProgress {
            self.0.clone()
        }
    }

    const LIMITS: Limits = Limits {
        negligible: 1e-9,
        variance: Variance::AtLeastUnit,
        damping: 1e-6,
        iterations: 200,
    };

    #[test]
    fn valid_a_line_and_a_curved_valley_are_solved() {
        let line = minimise(&LINE, [0.0, 0.0], &LIMITS).unwrap();
        assert!((line.point[0] - 1.0).abs() < 1e-9 && (line.point[1] - 2.0).abs() < 1e-9);
        assert!(line.report.converged() && line.report.iterations < 6);
        let valley = minimise(&VALLEY, [-1.2, 1.0], &LIMITS).unwrap();
        assert!((valley.point[0] - 1.0).abs() < 1e-9 && (valley.point[1] - 1.0).abs() < 1e-9);
        assert!(valley.report.converged() && valley.report.cost == valley.factor.cost());
    }

    #[test]
    fn the_cost_falls_with_every_iteration_and_each_is_counted() {
        let counted = Counted(FitProgress::default());
        let whole = minimise(&counted, [-1.2, 1.0], &LIMITS).unwrap().report;
        assert_eq!(counted.0.iterations(), whole.iterations);
        let cost_after = |iterations| {
            let limits = Limits {
                iterations,
                ..LIMITS
            };
            minimise(&VALLEY, [-1.2, 1.0], &limits).unwrap().report.cost
        };
        let costs: Vec<f64> = (1..=whole.iterations).map(cost_after).collect();
        assert!(costs.windows(2).all(|w| w[1] <= w[0]));
        assert_eq!(costs.last(), Some(&whole.cost));
    }

    #[test]
    fn the_reason_of_the_end_is_reported() {
        let few = Limits {
            iterations: 2,
            ..LIMITS
        };
        let short = minimise(&VALLEY, [-1.2, 1.0], &few).unwrap().report;
        assert_eq!(short.termination, TerminationReason::MaxItersReached);
        assert_eq!(short.iterations, 2);
        let blind = Curve {
            has_cost: false,
            ..VALLEY
        };
        let never_negligible = Limits {
            negligible: 0.0,
            ..LIMITS
        };
        let stalled = minimise(&blind, [-1.2, 1.0], &never_negligible).unwrap();
        assert_eq!(stalled.point, [-1.2, 1.0]);
        let reason = TerminationReason::SolverExit(STALLED.into());
        assert_eq!(stalled.report.termination, reason);
        assert!(!stalled.report.converged());
        let error = minimise(&VALLEY, [2e3, 0.0], &LIMITS).unwrap_err();
        assert_eq!(error.to_string(), "out of reach");
    }
}
