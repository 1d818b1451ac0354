//! The resonance curve: f0, β and `x_st` from the records without impacts.

pub mod block;
pub mod channels;
pub mod drive_amplitudes;
mod drive_channel;
pub mod fit;
pub mod force_law;
mod misfit;
mod phases;
mod result;
mod select;
mod unsteady;

use crate::method::Method;
use crate::method_fit::MethodFit;
use crate::methods::answer::MethodResult;
use crate::methods::blocks::Blocks;
use crate::methods::fit::FitResult;
use crate::methods::fits::Fits;
use crate::methods::identifier::{ByRecord, Identifier};
use crate::methods::selection::Selection;

/// The resonance curve.
pub struct Resonance;

impl Identifier for Resonance {
    fn method(&self) -> Method {
        Method::Resonance
    }

    /// Beside the first fit, which gives the waveforms their start, from where they are.
    fn fit(&self, selection: &mut Selection<'_>, found: &mut Fits) {
        if let Some(waveforms) = found.waveforms().map(|f| f.fit.parameters) {
            let before = found.take(self.method());
            let fitted = selection.fit_resonance_again(before, &waveforms);
            found.set(self.method(), fitted);
        }
    }

    fn records(&self, selection: &Selection<'_>) -> Vec<usize> {
        selection.blocks.owners(self.method())
    }

    fn result(&self, selection: &Selection<'_>, found: &Fits) -> Option<MethodResult> {
        let fitted = found.attempt(self.method())?;
        Some(result::result(&selection.blocks, fitted))
    }
}

impl ByRecord for Resonance {
    fn fit_again(&self, selection: &Selection<'_>, found: &Fits) -> Option<FitResult> {
        fit::from(&selection.blocks, &selection.evidence.nominal, found.begin)
    }

    fn remove(&self, blocks: &mut Blocks, item: usize) {
        blocks.resonance.points.remove(item);
    }
}

impl Fits {
    /// The fit of the resonance curve.
    pub fn curve(&self) -> Option<&MethodFit> {
        self.of(Method::Resonance)
    }
}
