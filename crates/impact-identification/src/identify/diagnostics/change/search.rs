//! A joint fit, in whose records a change of the rig or of a gain is looked for.

use impact_fit::evidence::Evidence;
use impact_fit::method::Method;
use impact_fit::methods::selection::Selection;
use impact_fit::parameters::Parameters;
use impact_fit::solver::Problem;
use impact_fit::solver::placed_rows::PlacedRows;

/// A joint fit: what it was made of, its problem with the methods in its order, its optimum and variance factor.
#[derive(Clone, Copy)]
pub struct Fitted<'a> {
    /// What was fitted.
    pub selection: &'a Selection<'a>,
    /// The problem.
    pub problem: &'a Problem<'a>,
    /// The methods in it.
    pub present: &'a [Method],
    /// The optimum.
    pub at: &'a Parameters,
    /// Its variance factor.
    pub factor: f64,
}

/// What tells where the records of a fit would most be of two rigs.
pub struct Search<'a> {
    pub(in crate::identify::diagnostics) evidence: &'a Evidence<'a>,
    pub(in crate::identify::diagnostics) fitted: Fitted<'a>,
    /// The rows of the records at the optimum, with their places among the observations.
    pub(super) rows: Vec<(usize, PlacedRows)>,
}

impl<'a> Search<'a> {
    /// In the records of a fit.
    pub fn new(evidence: &'a Evidence<'a>, fitted: Fitted<'a>) -> Self {
        let mut rows: Vec<(usize, PlacedRows)> = Vec::new();
        for ((block, weight), method) in fitted.problem.blocks.iter().zip(fitted.present) {
            if !Method::BY_RECORD.contains(method) {
                continue;
            }
            let owners = fitted.selection.blocks.owners(*method);
            let own = fitted.problem.rows_of(*block, *weight, fitted.at);
            if own.len() == owners.len() {
                rows.extend(owners.into_iter().zip(own));
            }
        }
        Self {
            evidence,
            fitted,
            rows,
        }
    }
}
