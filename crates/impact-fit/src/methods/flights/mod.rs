//! Multiple shooting: all four parameters from records followed from impact to impact.

mod belief;
pub mod block;
mod constants;
mod fit;
mod node;
mod repeated;
mod result;
mod select;

use crate::method::Method;
use crate::methods::answer::MethodResult;
use crate::methods::fits::Fits;
use crate::methods::identifier::Identifier;
use crate::methods::selection::Selection;

/// Multiple shooting.
pub struct Flights;

impl Identifier for Flights {
    fn method(&self) -> Method {
        Method::Flights
    }

    fn fit(&self, selection: &mut Selection<'_>, found: &mut Fits) {
        let fitted = selection.fit_flights(found.start());
        found.set(self.method(), fitted);
    }

    fn weight(&self, _: &Selection<'_>, found: &Fits) -> Option<f64> {
        let fitted = found.of(self.method())?;
        found.joins_flights().then(|| 1.0 / fitted.factor)
    }

    fn records(&self, selection: &Selection<'_>) -> Vec<usize> {
        selection.blocks.owners(self.method())
    }

    fn result(&self, selection: &Selection<'_>, found: &Fits) -> Option<MethodResult> {
        let fitted = found.attempt(self.method())?;
        Some(result::result(&selection.blocks, fitted))
    }
}

impl Fits {
    /// Whether multiple shooting enters the joint fit: it rests on the speeds at impacts, which then do not, and
    /// waveforms tell the same better than either.
    pub fn joins_flights(&self) -> bool {
        self.of(Method::Flights).is_some() && self.waveforms().is_none()
    }
}
