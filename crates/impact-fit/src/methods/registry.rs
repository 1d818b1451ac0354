//! The methods in the order of a run.

use crate::method::Method;
use crate::methods::boundaries::Boundaries;
use crate::methods::decays::FreeDecays;
use crate::methods::flight_times::FlightTimes;
use crate::methods::flights::Flights;
use crate::methods::identifier::{ByRecord, Identifier};
use crate::methods::impacts::Impacts;
use crate::methods::resonance::Resonance;
use crate::methods::trajectories::Trajectories;

/// The methods that a run goes through, each after those that it depends on: waveforms give the others their
/// start and the channels' delays, boundaries rest on the resonance curve.
pub const REGISTRY: [&dyn Identifier; 7] = [
    &Trajectories,
    &Resonance,
    &Impacts,
    &Flights,
    &Boundaries,
    &FreeDecays,
    &FlightTimes,
];

/// Those whose records are judged one by one ([`Method::BY_RECORD`]), in the order of a run.
pub const BY_RECORD: [&dyn ByRecord; 2] = [&Trajectories, &Resonance];

/// A method whose records are judged one by one.
pub fn by_record(method: Method) -> Option<&'static dyn ByRecord> {
    BY_RECORD.into_iter().find(|of| of.method() == method)
}
