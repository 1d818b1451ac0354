//! What was left out, and why.

use std::collections::BTreeMap;

use super::Gathered;
use crate::identify::Item;
use crate::motion::Motion;
use crate::report::content::LeftOut;

/// Records that no method could use, by reason, and what the fits left out.
pub(super) fn left_out(gathered: &Gathered) -> Vec<LeftOut> {
    let mut by_reason: BTreeMap<String, Why> = Default::default();
    for o in gathered.observations {
        let mut note = |reason: String, words| {
            let why = by_reason.entry(reason).or_default();
            why.note(&o.record, words);
        };
        for flag in o.flags.iter().filter(|f| f.excludes) {
            let of = flag.channel.as_ref().map(|c| format!(" ({c})"));
            let reason = flag.code.replace('_', " ") + &of.unwrap_or_default();
            note(reason, &flag.message);
        }
        if let Motion::Undetermined { reason } = &o.classification.motion
            && !o.excluded()
            && o.drive.is_some()
        {
            note("motion undetermined".into(), reason);
        }
    }
    let mut out: Vec<LeftOut> = by_reason
        .into_iter()
        .map(|(reason, why)| LeftOut {
            what: names(&why.records),
            why: format!("{reason}: {}", why.words()),
            count: (why.records.len() > 1).then_some(why.records.len()),
        })
        .collect();
    // impacts are in a remark of their method
    let left_out = gathered.identification.left_out.iter();
    let left_out = left_out.filter(|l| !matches!(l.item, Item::Impact { .. }));
    out.extend(left_out.map(|l| LeftOut {
        what: l.item.to_string(),
        why: l.reason.to_string(),
        count: None,
    }));
    out
}

/// Records of one reason, and its words as they stand at the first of them.
#[derive(Default)]
struct Why<'a> {
    records: Vec<&'a str>,
    first: &'a str,
    others: bool,
}

impl<'a> Why<'a> {
    fn note(&mut self, record: &'a str, words: &'a str) {
        if self.records.is_empty() {
            self.first = words;
        }
        self.others |= self.first != words;
        self.records.push(record);
    }

    fn words(&self) -> String {
        match (self.others, self.records.first()) {
            (true, Some(record)) => format!("{} (so {record}; the others alike)", self.first),
            _ => self.first.to_owned(),
        }
    }
}

/// The first few names.
fn names(records: &[&str]) -> String {
    match records {
        [a, b, c, _, ..] => format!("{a}, {b}, {c} …"),
        few => few.join(", "),
    }
}
