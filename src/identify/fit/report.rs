//! How a fit came to its end.

use std::fmt;

use argmin::core::TerminationReason;
use serde::{Deserialize, Serialize};

/// Iterations and termination of a fit.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FitReport {
    /// Number of iterations.
    pub iterations: u64,
    /// How often the cost was evaluated, refused steps included.
    pub cost_evaluations: u64,
    /// Sum of squared weighted residuals at the end.
    pub cost: f64,
    /// Damping at the end, as a share of the information.
    pub damping: f64,
    /// Why the solver ended.
    #[serde(with = "Termination")]
    pub termination: TerminationReason,
    /// The iterations one by one; not stored.
    #[serde(skip)]
    pub trace: Vec<Iteration>,
}

/// One iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
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
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            iterations,
            cost,
            damping,
            ..
        } = self;
        let reason = self.termination.text();
        write!(
            f,
            "{iterations} iterations, cost {cost:.6}, damping {damping:.1e}: {reason}"
        )
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_is_stored_with_its_reason() {
        let report = FitReport {
            iterations: 3,
            cost_evaluations: 5,
            cost: 2.5,
            damping: 1e-4,
            termination: TerminationReason::SolverConverged,
            trace: Vec::new(),
        };
        let stored = serde_json::to_value(&report).unwrap();
        assert_eq!(stored["termination"], "solver_converged");
        assert_eq!(serde_json::from_value::<FitReport>(stored).unwrap(), report);
        assert!(report.converged());
        let line = "3 iterations, cost 2.500000, damping 1.0e-4: Solver converged";
        assert_eq!(report.to_string(), line);
    }
}
