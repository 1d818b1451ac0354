//! Records that no method could use, by reason.

use std::collections::BTreeMap;

use crate::motion::{Motion, Observation};

/// Records that cannot be used for one reason.
#[derive(Debug, Clone, PartialEq)]
pub struct Unusable {
    /// Code of the flag; `None`: the type of motion is undetermined.
    pub flag: Option<String>,
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
    let mut note =
        |o: &Observation, key: String, flag: Option<&str>, channel: Option<&str>, message: &str| {
            let entry = by_reason.entry(key).or_insert_with(|| Unusable {
                flag: flag.map(str::to_owned),
                channel: channel.map(str::to_owned),
                records: Vec::new(),
                message: message.to_owned(),
                differ: false,
            });
            entry.differ |= entry.message != message;
            entry.records.push(o.record.clone());
        };
    for o in observations {
        for flag in o.flags.iter().filter(|f| f.excludes) {
            let channel = flag.channel.as_deref();
            let of = channel.map(|c| format!(" ({c})")).unwrap_or_default();
            let key = flag.code.name().replace('_', " ") + &of;
            note(o, key, Some(flag.code.name()), channel, &flag.message);
        }
        if let Motion::Undetermined { reason } = &o.classification.motion
            && !o.excluded()
            && o.drive.is_some()
        {
            note(o, "motion undetermined".into(), None, None, reason);
        }
    }
    by_reason.into_values().collect()
}
