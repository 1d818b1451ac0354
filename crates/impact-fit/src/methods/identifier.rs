//! What a run asks of a method.

use crate::method::Method;
use crate::methods::answer::MethodResult;
use crate::methods::fit::FitResult;
use crate::methods::fits::Fits;
use crate::methods::selection::Selection;

/// A method as a run uses it.
pub trait Identifier: Sync {
    /// Which method it is.
    fn method(&self) -> Method;

    /// Fit what the method rests on, beside what those before it found, and add it to that.
    fn fit(&self, _: &mut Selection<'_>, _: &mut Fits) {}

    /// Fit again from where the joint fit is, after influential records were left out; of a method whose
    /// records are judged by their influence.
    fn fit_again(&self, _: &Selection<'_>, _: &Fits) -> Option<FitResult> {
        None
    }

    /// Its weight in the joint fit; `None` if it is not part of it.
    fn weight(&self, _: &Selection<'_>, found: &Fits) -> Option<f64> {
        found.of(self.method()).map(|fitted| 1.0 / fitted.factor)
    }

    /// The records that it rests on, by their indices; one may come several times.
    fn records(&self, selection: &Selection<'_>) -> Vec<usize>;

    /// What it gives; `None` where there was nothing to fit.
    fn result(&self, selection: &Selection<'_>, found: &Fits) -> Option<MethodResult>;
}
