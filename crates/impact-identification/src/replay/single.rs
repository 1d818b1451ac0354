//! One record beside what the model does there, with any parameters.

use super::decays::{FreeDecay, free_decay};
use super::input::Input;
use super::replays::{ReplayedRecord, comparison};
use impact_fit::parameters::Parameters;
use impact_records::message::Value;
use impact_records::message_table;
use impact_records::record::Problem;

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
#[derive(Debug, Clone, PartialEq, strum::EnumIter, strum::IntoStaticStr)]
#[strum(serialize_all = "snake_case")]
pub enum WhyNot {
    /// There is no such record.
    Unknown,
    /// Its file cannot be read.
    Unreadable {
        /// The problem of its first flag.
        problem: Problem,
    },
    /// It has neither a drive nor a free decay that was found.
    NeitherDriveNorDecay,
}

message_table! { "why_not": WhyNot;
    Self::Unreadable { problem } => problem = Value::Message(problem);
}

/// A record by its index beside what the model with parameters does there; without them the record alone.
pub fn beside(input: &Input<'_>, index: usize, parameters: Option<&Parameters>) -> BesideRecord {
    let Some(o) = input.observations.get(index) else {
        return BesideRecord::Nothing(WhyNot::Unknown);
    };
    let Some(record) = (input.read)(index) else {
        return BesideRecord::Nothing(WhyNot::Unknown);
    };
    if record.samples() == 0 {
        let problem = record.flags.first().map(|flag| flag.problem.clone());
        let problem = problem.unwrap_or_default();
        return BesideRecord::Nothing(WhyNot::Unreadable { problem });
    }
    if let Some(decay) = free_decay(o, &record, None) {
        return BesideRecord::Decay(Box::new(decay));
    }
    match comparison(input, o, &record, 'A', parameters) {
        Some(found) => BesideRecord::Motion(Box::new(found)),
        None => BesideRecord::Nothing(WhyNot::NeitherDriveNorDecay),
    }
}

#[cfg(test)]
mod tests {
    use strum::IntoEnumIterator;

    use super::*;
    use impact_records::message::{boxed, faults};

    #[test]
    fn every_reason_has_its_texts() {
        let all: Vec<_> = boxed(WhyNot::iter()).collect();
        assert_eq!(faults(&all), Vec::<String>::new());
    }
}
