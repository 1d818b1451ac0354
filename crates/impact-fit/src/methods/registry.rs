//! The methods in the order of a run.

use crate::methods::boundaries::Boundaries;
use crate::methods::decays::FreeDecays;
use crate::methods::flight_times::FlightTimes;
use crate::methods::flights::Flights;
use crate::methods::identifier::Identifier;
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
