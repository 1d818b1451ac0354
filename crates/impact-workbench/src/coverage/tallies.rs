//! What identifications of simulated campaigns without a mistake say, counted.

use std::collections::BTreeMap;

use serde::Serialize;

use super::seen::Seen;
use impact_fit::{Effect, Finding, VerdictKind};
use impact_records::motion::{Motion, Observation};

/// So many of so many.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Tally {
    /// How often it happened.
    pub found: usize,
    /// Out of how many.
    pub of: usize,
}

impl Tally {
    /// How many of these are so.
    pub(super) fn count(all: impl IntoIterator<Item = bool>) -> Self {
        let mut tally = Self::default();
        for so in all {
            tally.found += usize::from(so);
            tally.of += 1;
        }
        tally
    }
}

/// Motion types of records against those of the noiseless simulation.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct MotionTally {
    /// Records whose simulated motion is impactless or periodic.
    pub periodic: usize,
    /// Those classified as what they are.
    pub right: usize,
    /// Those called undetermined.
    pub undetermined: usize,
    /// Those classified as something else, but not surely.
    pub doubtful: usize,
    /// Those surely classified as something else.
    pub wrong: usize,
    /// Records whose simulated motion does not repeat within 96 drive periods.
    pub not_periodic: usize,
    /// Those surely classified as impactless or periodic.
    pub called_periodic: usize,
}

/// Confidence from which on a classification is sure.
const SURE: f64 = 0.9;

impl MotionTally {
    pub(super) fn add(&mut self, truth: &Motion, found: (&Motion, f64)) {
        let (motion, sure) = (found.0, found.1 >= SURE);
        if matches!(truth, Motion::Undetermined { .. }) {
            self.not_periodic += 1;
            self.called_periodic += usize::from(sure && motion.is_periodic());
            return;
        }
        self.periodic += 1;
        let counter = match motion {
            Motion::Undetermined { .. } => &mut self.undetermined,
            _ if truth.label() == motion.label() => &mut self.right,
            _ if sure => &mut self.wrong,
            _ => &mut self.doubtful,
        };
        *counter += 1;
    }

    fn join(&mut self, other: &Self) {
        self.periodic += other.periodic;
        self.right += other.right;
        self.undetermined += other.undetermined;
        self.doubtful += other.doubtful;
        self.wrong += other.wrong;
        self.not_periodic += other.not_periodic;
        self.called_periodic += other.called_periodic;
    }
}

/// What one campaign's identification says.
#[derive(Debug)]
pub(super) struct Statement {
    verdict: VerdictKind,
    agree: Option<bool>,
    effects: Vec<Effect>,
    suspects: bool,
    accuses_gap: bool,
    motions: MotionTally,
}

impl Statement {
    /// Of a campaign.
    pub(super) fn of(seen: &Seen) -> Self {
        let suspicions = &seen.outcome.suspicions;
        let gap = |f: &Finding| matches!(f, Finding::WrongClearance { .. });
        let findings = &seen.outcome.verdict.findings;
        let effect = |f: &Finding| match f {
            Finding::BeyondModel { effect, .. } => Some(*effect),
            _ => None,
        };
        Self {
            verdict: seen.outcome.verdict.kind,
            agree: seen.outcome.agreement.agree,
            effects: findings.iter().filter_map(effect).collect(),
            suspects: !suspicions.is_empty(),
            accuses_gap: suspicions.iter().any(gap),
            motions: motions(&seen.observations, &seen.motions),
        }
    }
}

fn motions(observations: &[Observation], truth: &[Motion]) -> MotionTally {
    let mut tally = MotionTally::default();
    for (observation, truth) in observations.iter().zip(truth) {
        let found = &observation.classification;
        tally.add(truth, (&found.motion, found.confidence));
    }
    tally
}

/// The same over all campaigns.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Tallies {
    /// Number of campaigns with each verdict.
    pub verdicts: BTreeMap<VerdictKind, usize>,
    /// Campaigns whose methods do not agree, of those with methods to compare.
    pub methods_disagree: Tally,
    /// Campaigns in which each effect beyond the model is named.
    pub named_effects: BTreeMap<&'static str, Tally>,
    /// Campaigns in which a mistake of the laboratory is suspected.
    pub false_alarms: Tally,
    /// Campaigns in which a gap is.
    pub gaps_accused: Tally,
    /// Motion types of all records.
    pub motions: MotionTally,
}

impl Tallies {
    pub(super) fn of(statements: &[Statement]) -> Self {
        let mut tallies = Self {
            methods_disagree: Tally::count(statements.iter().filter_map(|s| Some(!s.agree?))),
            false_alarms: Tally::count(statements.iter().map(|s| s.suspects)),
            gaps_accused: Tally::count(statements.iter().map(|s| s.accuses_gap)),
            ..Self::default()
        };
        for statement in statements {
            *tallies.verdicts.entry(statement.verdict).or_default() += 1;
            tallies.motions.join(&statement.motions);
        }
        for effect in Effect::ALL {
            let tally = Tally::count(statements.iter().map(|s| s.effects.contains(effect)));
            if tally.found > 0 {
                tallies.named_effects.insert(effect.name(), tally);
            }
        }
        tallies
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::motion::Undetermined;

    #[test]
    fn motions_are_right_undetermined_or_wrong() {
        let unknown = Motion::Undetermined {
            reason: Undetermined::NotPeriodic,
        };
        let one = Motion::periodic(1, 1);
        let mut tally = MotionTally::default();
        for (truth, found, confidence) in [
            (&one, &one, 0.5),
            (&one, &unknown, 0.0),
            (&one, &Motion::periodic(2, 2), 0.95),
            (&one, &Motion::periodic(2, 2), 0.5),
            (&unknown, &Motion::Chaotic, 0.95),
            (&unknown, &one, 0.95),
        ] {
            tally.add(truth, (found, confidence));
        }
        let want = MotionTally {
            periodic: 4,
            right: 1,
            undetermined: 1,
            doubtful: 1,
            wrong: 1,
            not_periodic: 2,
            called_periodic: 1,
        };
        assert_eq!(tally, want);
    }
}
