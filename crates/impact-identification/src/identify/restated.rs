//! Evidence with other clearances than the campaign states.

use impact_fit::evidence::Evidence;
use impact_records::motion::{Bracket, Observation};

/// Observations and brackets with other clearances.
pub(super) struct Restated {
    observations: Vec<Observation>,
    brackets: Vec<Bracket>,
}

impl Restated {
    /// Each stated clearance as it is meant, m.
    pub(super) fn of(evidence: &Evidence<'_>, meant_m: impl Fn(f64) -> f64) -> Self {
        let mut observations = evidence.observations.to_vec();
        for o in &mut observations {
            o.setting.clearance_m = o.setting.clearance_m.map(&meant_m);
        }
        let mut brackets = evidence.brackets.to_vec();
        for bracket in &mut brackets {
            bracket.clearance_m = meant_m(bracket.clearance_m);
        }
        Self {
            observations,
            brackets,
        }
    }

    /// As if no clearance were stated.
    pub(super) fn without_clearances(evidence: &Evidence<'_>) -> Self {
        let mut observations = evidence.observations.to_vec();
        for o in &mut observations {
            o.setting.clearance_m = None;
        }
        Self {
            observations,
            brackets: Vec::new(),
        }
    }

    /// What else the same evidence states, with these clearances.
    pub(super) fn evidence<'b>(&'b self, of: &Evidence<'b>) -> Evidence<'b> {
        Evidence {
            observations: &self.observations,
            brackets: &self.brackets,
            ..*of
        }
    }
}
