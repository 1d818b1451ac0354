//! Records that no method could use, by reason.

use std::collections::BTreeMap;

use impact_records::message::{Message, plain};
use impact_records::motion::{Motion, Observation, Undetermined};
use impact_records::record::Problem;

/// Why a record cannot be used.
#[derive(Debug, Clone, PartialEq)]
pub enum UnusableReason {
    /// The problem of a flag.
    Flag(Problem),
    /// Its motion is undetermined.
    Undetermined(Undetermined),
}

impl UnusableReason {
    /// Name of the flag.
    fn name(&self) -> &'static str {
        match self {
            Self::Flag(problem) => problem.code().name(),
            Self::Undetermined(_) => "motion undetermined",
        }
    }

    /// What is stated of it in English.
    fn stated(&self) -> String {
        match self {
            Self::Flag(problem) => plain(problem),
            Self::Undetermined(reason) => plain(reason),
        }
    }
}

/// Records that cannot be used for one kind of reason.
#[derive(Debug, Clone, PartialEq)]
pub struct Unusable {
    /// The flag, or why the motion is undetermined, with the details of the first of them.
    pub reason: UnusableReason,
    /// The channel concerned, if one is.
    pub channel: Option<String>,
    /// The records' names, in the order of acquisition.
    pub records: Vec<String>,
    /// Whether the details (numbers) differ among them.
    pub differ: bool,
}

/// Records excluded by a flag or without a determined motion, sorted by kind of reason.
pub(super) fn unusable(observations: &[Observation]) -> Vec<Unusable> {
    let mut by_reason: BTreeMap<String, Unusable> = BTreeMap::new();
    for o in observations {
        for Found {
            reason,
            channel,
            kind,
        } in reasons(o)
        {
            let name = reason.name().replace('_', " ");
            let key = format!("{name} {} {kind}", channel.unwrap_or_default());
            let entry = by_reason.entry(key).or_insert_with(|| Unusable {
                reason: reason.clone(),
                channel: channel.map(str::to_owned),
                records: Vec::new(),
                differ: false,
            });
            entry.differ |= entry.reason.stated() != reason.stated();
            entry.records.push(o.record.clone());
        }
    }
    by_reason.into_values().collect()
}

/// One reason why a record cannot be used.
struct Found<'a> {
    reason: UnusableReason,
    channel: Option<&'a str>,
    /// What is the same in reasons of one kind: a flag's remedy, why a motion is undetermined.
    kind: String,
}

/// Why a record cannot be used.
fn reasons(o: &Observation) -> Vec<Found<'_>> {
    let excluding = o.flags.iter().filter(|f| f.excludes);
    let flags = excluding.map(|f| Found {
        reason: UnusableReason::Flag(f.problem.clone()),
        channel: f.channel.as_deref(),
        kind: f.remedy(),
    });
    let mut reasons: Vec<_> = flags.collect();
    if let Motion::Undetermined { reason } = &o.classification.motion
        && reasons.is_empty()
        && o.drive.is_some()
    {
        reasons.push(Found {
            reason: UnusableReason::Undetermined(reason.clone()),
            channel: None,
            kind: reason.kind().to_owned(),
        });
    }
    reasons
}
