//! How a fit came to its end.

use std::fmt;

use argmin::core::TerminationReason;

/// Iterations and termination of a fit.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FitReport {
    /// Number of iterations.
    pub iterations: u64,
    /// Sum of squared weighted residuals at the end.
    pub cost: f64,
    /// Damping at the end, as a share of the information.
    pub damping: f64,
    /// Why the solver ended.
    pub termination: TerminationReason,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_is_one_line_with_its_reason() {
        let report = FitReport {
            iterations: 3,
            cost: 2.5,
            damping: 1e-4,
            termination: TerminationReason::SolverConverged,
        };
        assert!(report.converged());
        let line = "3 iterations, cost 2.500000, damping 1.0e-4: Solver converged";
        assert_eq!(report.to_string(), line);
    }
}
