//! How a fit came to its end.

use std::fmt;

use argmin::core::TerminationReason;
use serde::{Deserialize, Serialize};

/// Iterations and termination of a fit.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FitReport {
    /// Cost and damping after each iteration.
    pub iterations: Vec<Iteration>,
    /// How often the cost was evaluated, trials that were refused included.
    pub cost_evaluations: u64,
    /// Why the solver ended.
    #[serde(with = "Termination")]
    pub termination: TerminationReason,
}

/// One iteration.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Iteration {
    /// Sum of squared weighted residuals after it.
    pub cost: f64,
    /// Damping of the next step, as a share of the information.
    pub damping: f64,
}

/// Why a solver exits though the gradient is not yet zero.
pub(super) const STALLED: &str = "no step lowers the cost";

impl FitReport {
    /// Whether the last step was negligible.
    pub fn converged(&self) -> bool {
        self.termination == TerminationReason::SolverConverged
    }
}

/// One line: iterations, cost, damping and the reason of the termination.
impl fmt::Display for FitReport {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} iterations", self.iterations.len())?;
        if let Some(Iteration { cost, damping }) = self.iterations.last() {
            write!(f, ", cost {cost:.6}, damping {damping:.1e}")?;
        }
        write!(f, ": {}", self.termination.text())
    }
}

/// argmin's reasons as they are stored.
#[derive(Serialize, Deserialize)]
#[serde(remote = "TerminationReason", rename_all = "snake_case")]
enum Termination {
    MaxItersReached,
    TargetCostReached,
    Interrupt,
    SolverConverged,
    Timeout,
    SolverExit(String),
}
