//! What a run asks of a method.

use crate::method::Method;
use crate::methods::answer::MethodResult;
use crate::methods::blocks::Blocks;
use crate::methods::fit::FitResult;
use crate::methods::fits::Fits;
use crate::methods::selection::Selection;
use crate::parameters::Parameters;

/// A method as a run uses it.
pub trait Identifier: Sync {
    /// Which method it is.
    fn method(&self) -> Method;

    /// Fit what the method rests on, beside what those before it found, and add it to that.
    fn fit(&self, _: &mut Selection<'_>, _: &mut Fits) {}

    /// Its weight in the joint fit; `None` if it is not part of it.
    fn weight(&self, _: &Selection<'_>, found: &Fits) -> Option<f64> {
        found.of(self.method()).map(|fitted| 1.0 / fitted.factor)
    }

    /// The records that it rests on, by their indices; one may come several times.
    fn records(&self, selection: &Selection<'_>) -> Vec<usize>;

    /// What it gives; `None` where there was nothing to fit.
    fn result(&self, selection: &Selection<'_>, found: &Fits) -> Option<MethodResult>;
}

/// A method each item of whose block is one record, which is judged by its influence on the joint fit and can be left
/// out by itself.
pub trait ByRecord: Identifier {
    /// Fit again from where the joint fit is, after influential records were left out.
    fn fit_again(&self, selection: &Selection<'_>, found: &Fits) -> Option<FitResult>;

    /// Remove an item of its block.
    fn remove(&self, blocks: &mut Blocks, item: usize);

    /// Whether an item need not be what the method takes it for, so that it is left out before others.
    fn is_doubtful(&self, _: &Selection<'_>, _item: usize, _at: &Parameters) -> bool {
        false
    }

    /// The items that no fit by slopes can use near parameters.
    fn unusable(&self, _: &Selection<'_>, _at: &Parameters) -> Vec<usize> {
        Vec::new()
    }
}
