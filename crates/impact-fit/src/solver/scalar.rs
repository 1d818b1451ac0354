//! The least value of a function of one variable.

use argmin::core::{CostFunction, Executor};
use argmin::solver::brent::BrentOpt;

/// Steps of Brent's method at most; it takes about ten.
const BRENT_STEPS: u64 = 100;

struct Function<F>(F);

impl<F: Fn(f64) -> f64> CostFunction for Function<F> {
    type Param = f64;
    type Output = f64;

    fn cost(&self, at: &f64) -> Result<f64, argmin::core::Error> {
        Ok((self.0)(*at))
    }
}

/// Where a function is least between two ends, to a tolerance, by Brent's method.
pub fn least(f: impl Fn(f64) -> f64, [low, high]: [f64; 2], tolerance: f64) -> Option<f64> {
    let brent = BrentOpt::new(low, high).set_tolerance(0.0, tolerance);
    let found = Executor::new(Function(f), brent)
        .configure(|state| state.max_iters(BRENT_STEPS))
        .timer(false)
        .run();
    found.ok()?.state.best_param
}
