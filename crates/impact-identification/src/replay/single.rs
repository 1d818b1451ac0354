//! One record beside what the model does there, with any parameters.

use std::fmt;

use super::decays::{FreeDecay, free_decay};
use super::input::Input;
use super::replays::{ReplayedRecord, comparison};
use impact_fit::parameters::Parameters;

/// A record beside its simulation.
#[derive(Debug, Clone, PartialEq)]
pub enum BesideRecord {
    /// A driven record beside the motion of the model.
    Motion(Box<ReplayedRecord>),
    /// A free decay beside its fit.
    Decay(Box<FreeDecay>),
    /// Nothing can be shown.
    Nothing(WhyNot),
}

/// Why a record cannot be shown beside a simulation.
#[derive(Debug, Clone, PartialEq)]
pub enum WhyNot {
    /// There is no such record.
    Unknown,
    /// Its file cannot be read; the flag's message.
    Unreadable(String),
    /// It has neither a drive nor a free decay that was found.
    NeitherDriveNorDecay,
}

impl fmt::Display for WhyNot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown => f.write_str("the campaign has no such record"),
            Self::Unreadable(message) => write!(f, "the record cannot be read: {message}"),
            Self::NeitherDriveNorDecay => f.write_str(
                "no drive was found in the record, so it has no phase to be simulated in step with, \
                 and no free decay",
            ),
        }
    }
}

/// A record by its index beside what the model with parameters does there.
pub fn beside(input: &Input<'_>, index: usize, parameters: &Parameters) -> BesideRecord {
    let Some(o) = input.observations.get(index) else {
        return BesideRecord::Nothing(WhyNot::Unknown);
    };
    let Some(record) = (input.read)(index) else {
        return BesideRecord::Nothing(WhyNot::Unknown);
    };
    if record.samples() == 0 {
        let message = record.flags.first().map(|flag| flag.message.clone());
        return BesideRecord::Nothing(WhyNot::Unreadable(message.unwrap_or_default()));
    }
    if let Some(decay) = free_decay(o, &record, None) {
        return BesideRecord::Decay(Box::new(decay));
    }
    match comparison(input, o, &record, ('A', Some(parameters))) {
        Some(found) => BesideRecord::Motion(Box::new(found)),
        None => BesideRecord::Nothing(WhyNot::NeitherDriveNorDecay),
    }
}
