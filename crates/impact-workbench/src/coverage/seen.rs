//! A simulated campaign after its identification.

use impact_identification::identify::Identification;
use impact_records::motion::{Bracket, Motion, Observation};
use impact_records::record::FlagCode;

/// A campaign after identification.
pub(super) struct Seen {
    /// The motions according to the noiseless simulation.
    pub(super) motions: Vec<Motion>,
    pub(super) observations: Vec<Observation>,
    pub(super) brackets: Vec<Bracket>,
    pub(super) outcome: Identification,
}

impl Seen {
    pub(super) fn flag(&self, code: FlagCode) -> bool {
        let flagged = |o: &&Observation| o.has_flag(code);
        2 * self.observations.iter().filter(flagged).count() > self.observations.len()
    }
}
