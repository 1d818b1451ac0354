//! Records that no method could use, by reason.

use std::collections::BTreeMap;

use crate::motion::{Motion, Observation, Undetermined};
use crate::record::FlagCode;

/// Why a record cannot be used.
#[derive(Debug, Clone, PartialEq)]
pub enum UnusableReason {
    /// A flag, with its details in English.
    Flag(FlagCode, String),
    /// Its motion is undetermined.
    Undetermined(Undetermined),
}

impl UnusableReason {
    /// Name of the flag.
    fn name(&self) -> &'static str {
        match self {
            Self::Flag(code, _) => code.name(),
            Self::Undetermined(_) => "motion undetermined",
        }
    }
}

/// Records that cannot be used for one reason.
#[derive(Debug, Clone, PartialEq)]
pub struct Unusable {
    /// The flag, or why the motion is undetermined at the first of them.
    pub reason: UnusableReason,
    /// The channel concerned, if one is.
    pub channel: Option<String>,
    /// The records' names, in the order of acquisition.
    pub records: Vec<String>,
    /// Whether the details differ among them.
    pub differ: bool,
}

/// Records excluded by a flag or without a determined motion, sorted by reason.
pub(super) fn unusable(observations: &[Observation]) -> Vec<Unusable> {
    let mut by_reason: BTreeMap<String, Unusable> = BTreeMap::new();
    for o in observations {
        for (reason, channel) in reasons(o) {
            let name = reason.name().replace('_', " ");
            let key = format!("{name} {}", channel.unwrap_or_default());
            let entry = by_reason.entry(key).or_insert_with(|| Unusable {
                reason: reason.clone(),
                channel: channel.map(str::to_owned),
                records: Vec::new(),
                differ: false,
            });
            entry.differ |= entry.reason != reason;
            entry.records.push(o.record.clone());
        }
    }
    by_reason.into_values().collect()
}

/// Why a record cannot be used: flag, channel and details of each reason.
fn reasons(o: &Observation) -> Vec<(UnusableReason, Option<&str>)> {
    let excluding = o.flags.iter().filter(|f| f.excludes);
    let flags = excluding.map(|f| {
        let reason = UnusableReason::Flag(f.code, f.message.clone());
        (reason, f.channel.as_deref())
    });
    let mut reasons: Vec<_> = flags.collect();
    if let Motion::Undetermined { reason } = &o.classification.motion
        && reasons.is_empty()
        && o.drive.is_some()
    {
        reasons.push((UnusableReason::Undetermined(reason.clone()), None));
    }
    reasons
}
