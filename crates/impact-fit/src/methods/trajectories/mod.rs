//! Trajectories: all four parameters from the waveforms of periodic records.

pub mod block;
pub mod fit;
pub mod nearest_orbit;
pub mod record;
pub mod record_motion;
pub mod reduced_record;
mod result;
pub mod rising_force;
mod select;
mod starts;

use crate::method::Method;
use crate::method_fit::MethodFit;
use crate::methods::answer::MethodResult;
use crate::methods::blocks::Blocks;
use crate::methods::fit::FitResult;
use crate::methods::fits::Fits;
use crate::methods::identifier::{ByRecord, Identifier};
use crate::methods::selection::Selection;
use crate::methods::trajectories::select::END;
use crate::parameters::Parameters;
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

impl ByRecord for Trajectories {
    fn fit_again(&self, selection: &Selection<'_>, found: &Fits) -> Option<FitResult> {
        let (blocks, nominal) = (&selection.blocks, &selection.evidence.nominal);
        fit::from(blocks, nominal, found.begin, Precision::Result)
    }

    fn remove(&self, blocks: &mut Blocks, item: usize) {
        blocks.trajectory.records.remove(item);
    }

    fn is_doubtful(&self, selection: &Selection<'_>, item: usize, at: &Parameters) -> bool {
        selection.settles_slowly(item, at)
    }

    fn unusable(&self, selection: &Selection<'_>, at: &Parameters) -> Vec<usize> {
        selection.near_their_end(at, END)
    }
}

impl Fits {
    /// The fit of the waveforms.
    pub fn waveforms(&self) -> Option<&MethodFit> {
        self.of(Method::Trajectories)
    }
}
