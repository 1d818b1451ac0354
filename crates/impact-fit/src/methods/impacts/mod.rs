//! Speeds at impacts: R from the approach and separation speeds.

mod bias;
pub mod block;
pub mod contact_law;
pub mod fit;
mod momentum;
mod result;
pub mod structure;
pub mod within_record;

pub use result::impact;

use crate::messages::Finding;
use crate::method::Method;
use crate::methods::answer::MethodResult;
use crate::methods::fits::Fits;
use crate::methods::identifier::Identifier;
use crate::methods::selection::Selection;

/// The speeds at impacts.
pub struct Impacts;

impl Impacts {
    /// The masses' ratio where their momentum at impacts contradicts what is stated.
    pub fn contradicted_masses(selection: &Selection<'_>) -> Option<Finding> {
        momentum::momentum(&selection.blocks.impact, selection.evidence)?.1
    }

    /// Widen R, where it rests on the impacts alone, by what their extrapolation has in common.
    pub fn widen_common(joint: &mut MethodResult, selection: &Selection<'_>) {
        result::widen_common(joint, &selection.blocks.impact);
    }
}

impl Identifier for Impacts {
    fn method(&self) -> Method {
        Method::Impacts
    }

    /// Beside the first fit, which gives the waveforms their start, with the channels' delays that these tell.
    fn fit(&self, selection: &mut Selection<'_>, found: &mut Fits) {
        let start = found.start();
        let told = found.waveforms().or(found.curve()).is_some();
        if told && selection.blocks.delay_impacts(&start) {
            let fitted = fit::from(&selection.blocks, &selection.evidence.nominal, start);
            found.set(self.method(), fitted);
        }
    }

    /// None with speeds that impacts seem to gain, which tell no R.
    fn weight(&self, selection: &Selection<'_>, found: &Fits) -> Option<f64> {
        let block = &selection.blocks.impact;
        let law = contact_law::contact_law(block);
        let gains = selection.evidence.nominal.gain_uncertainty;
        let gained = contact_law::gained(block, law.as_ref(), gains).is_some();
        let own = found.of(self.method()).filter(|_| !gained)?;
        let told = found.waveforms().or(found.curve()).unwrap_or(own);
        let bias = bias::impact_bias(block, &told.fit, selection.evidence.nominal.effects);
        (!found.joins_flights()).then(|| bias::weight(own, bias))
    }

    fn records(&self, selection: &Selection<'_>) -> Vec<usize> {
        selection.blocks.owners(self.method())
    }

    fn result(&self, selection: &Selection<'_>, found: &Fits) -> Option<MethodResult> {
        let fitted = found.attempt(self.method())?;
        let Selection {
            blocks, evidence, ..
        } = selection;
        let together = found.together().map(|f| &f.fit);
        Some(result::result(blocks, fitted, evidence, together))
    }
}
