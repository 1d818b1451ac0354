//! Trajectories: all four parameters from the waveforms of periodic records.

pub mod block;
pub mod fit;
pub mod nearest_orbit;
pub mod record;
pub mod record_motion;
pub mod reduced_record;
mod result;
pub(super) mod select;
mod starts;

use crate::method::Method;
use crate::methods::answer::MethodResult;
use crate::methods::fit::FitResult;
use crate::methods::fits::Fits;
use crate::methods::identifier::Identifier;
use crate::methods::selection::Selection;
use crate::solver::Precision;

/// The waveforms.
pub struct Trajectories;

impl Identifier for Trajectories {
    fn method(&self) -> Method {
        Method::Trajectories
    }

    fn fit(&self, selection: &mut Selection<'_>, found: &mut Fits) {
        found.set(self.method(), selection.fit_trajectories(found.begin));
    }

    fn fit_again(&self, selection: &Selection<'_>, found: &Fits) -> Option<FitResult> {
        let (blocks, nominal) = (&selection.blocks, &selection.evidence.nominal);
        fit::from(blocks, nominal, found.begin, Precision::Result)
    }

    fn records(&self, selection: &Selection<'_>) -> Vec<usize> {
        selection.blocks.owners(self.method())
    }

    fn result(&self, selection: &Selection<'_>, found: &Fits) -> Option<MethodResult> {
        let fitted = found.attempt(self.method())?;
        let Selection {
            blocks, evidence, ..
        } = selection;
        Some(result::result(blocks, fitted, evidence))
    }
}
