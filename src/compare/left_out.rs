//! Records that no method could use, by reason.

use std::collections::BTreeMap;

use crate::motion::{Motion, Observation};
use crate::record::FlagCode;

/// Records that cannot be used for one reason.
#[derive(Debug, Clone, PartialEq)]
pub struct Unusable {
    /// The flag; `None`: the type of motion is undetermined.
    pub flag: Option<FlagCode>,
    /// The channel concerned, if one is.
    pub channel: Option<String>,
    /// The records' names, in the order of acquisition.
    pub records: Vec<String>,
    /// Details at the first of them.
    pub message: String,
    /// Whether the details differ among them.
    pub differ: bool,
}

/// Records excluded by a flag or without a determined motion, sorted by reason.
pub(super) fn unusable(observations: &[Observation]) -> Vec<Unusable> {
    let mut by_reason: BTreeMap<String, Unusable> = BTreeMap::new();
    for o in observations {
        for (flag, channel, message) in reasons(o) {
            let name = flag.map_or("motion undetermined", FlagCode::name);
            let key = format!("{} {}", name.replace('_', " "), channel.unwrap_or_default());
            let entry = by_reason.entry(key).or_insert_with(|| Unusable {
                flag,
                channel: channel.map(str::to_owned),
                records: Vec::new(),
                message: message.to_owned(),
                differ: false,
            });
            entry.differ |= entry.message != message;
            entry.records.push(o.record.clone());
        }
    }
    by_reason.into_values().collect()
}

/// Why a record cannot be used: flag, channel and details of each reason.
fn reasons(o: &Observation) -> Vec<(Option<FlagCode>, Option<&str>, &str)> {
    let excluding = o.flags.iter().filter(|f| f.excludes);
    let flags = excluding.map(|f| (Some(f.code), f.channel.as_deref(), f.message.as_str()));
    let mut reasons: Vec<_> = flags.collect();
    if let Motion::Undetermined { reason } = &o.classification.motion
        && reasons.is_empty()
        && o.drive.is_some()
    {
        reasons.push((None, None, reason));
    }
    reasons
}
