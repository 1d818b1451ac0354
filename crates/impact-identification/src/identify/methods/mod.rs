//! The methods of identification, a folder each: the block of residuals, which records it rests on, its fit and
//! its result. [`REGISTRY`] lists them in the order in which they depend on each other; a run is a loop over it.
//!
//! What they have in common: all blocks of a campaign ([`blocks`]), the selection of records ([`selection`]), a
//! fit of some blocks ([`fit`]) and of all ([`joint`]), what was found so far ([`found`]).

pub mod blocks;
pub mod boundaries;
pub mod decays;
pub mod fit;
pub mod flight_times;
pub mod flights;
pub mod found;
mod groups;
pub mod impacts;
pub mod influence;
pub mod joint;
pub mod resonance;
pub mod selection;
pub mod trajectories;
pub mod weighing;

use crate::identify::answer::MethodResult;
use crate::identify::method::Method;
use crate::identify::methods::fit::FitResult;
use crate::identify::methods::found::Found;
use crate::identify::methods::selection::Selection;

/// A method as a run uses it.
pub trait Identifier: Sync {
    /// Which method it is.
    fn method(&self) -> Method;

    /// Fit what the method rests on, beside what those before it found, and add it to that.
    fn fit(&self, _: &mut Selection<'_>, _: &mut Found) {}

    /// Fit again from where the joint fit is, after influential records were left out; of a method whose
    /// records are judged by their influence.
    fn fit_again(&self, _: &Selection<'_>, _: &Found) -> Option<FitResult> {
        None
    }

    /// Its weight in the joint fit; `None` if it is not part of it.
    fn weight(&self, _: &Selection<'_>, found: &Found) -> Option<f64> {
        found.of(self.method()).map(|fitted| 1.0 / fitted.factor)
    }

    /// The records that it rests on, by their indices; one may come several times.
    fn records(&self, selection: &Selection<'_>) -> Vec<usize>;

    /// What it gives; `None` where there was nothing to fit.
    fn result(&self, selection: &Selection<'_>, found: &Found) -> Option<MethodResult>;
}

/// The methods that a run goes through, each after those that it depends on: waveforms give the others their
/// start and the channels' delays, boundaries rest on the resonance curve.
pub const REGISTRY: [&dyn Identifier; 7] = [
    &trajectories::Trajectories,
    &resonance::Resonance,
    &impacts::Impacts,
    &flights::Flights,
    &boundaries::Boundaries,
    &decays::FreeDecays,
    &flight_times::FlightTimes,
];
