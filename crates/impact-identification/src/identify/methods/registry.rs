//! The methods in the order of a run.

use crate::identify::methods::boundaries::Boundaries;
use crate::identify::methods::decays::FreeDecays;
use crate::identify::methods::flight_times::FlightTimes;
use crate::identify::methods::flights::Flights;
use crate::identify::methods::identifier::Identifier;
use crate::identify::methods::impacts::Impacts;
use crate::identify::methods::resonance::Resonance;
use crate::identify::methods::trajectories::Trajectories;

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
