//! `impactid check`: read everything, list every fault at once, change nothing.

use std::path::PathBuf;

use clap::Args;

use super::fail::rendered_fault;
use super::{Exit, Failure, Progress, Voice};
use crate::campaign::check::{self, Checked};
use crate::campaign::faults::{Fault, Faults, Severity};
use crate::campaign::load;
use labfiles::open;

/// Arguments of `impactid check`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Check {
    /// The campaign's description
    #[arg(value_name = "CAMPAIGN.TOML", default_value = "campaign.toml")]
    campaign: PathBuf,
}

const EXAMPLE: &str = "\
Example:
  impactid check data-samples/double-oscillator/campaign.toml

Exit codes: 0 no fault; 2 a fault that stops the campaign or leaves records out.";

impl Check {
    pub(super) fn go(self, voice: Voice) -> Result<Exit, Failure> {
        let mut outcome = load(&self.campaign, &open);
        let mut usable = None;
        if let Some(campaign) = &outcome.campaign {
            let total = campaign.records.len() as u64;
            let progress = Progress::new(voice, "reading", total);
            let Checked {
                faults,
                usable: count,
                ..
            } = check::read_all(campaign, &open, &|done| progress.set(done, total));
            outcome.faults.0.extend(faults);
            outcome.faults.tidy();
            usable = Some((count, campaign.records.len()));
        }
        tell(&outcome.faults, usable, voice);
        let harmless = outcome
            .faults
            .0
            .iter()
            .all(|f| f.severity == Severity::Note);
        Ok(if harmless { Exit::Done } else { Exit::BadInput })
    }
}

/// Faults alike in several records are printed once from this many on.
const MANY: usize = 4;

fn tell(faults: &Faults, usable: Option<(usize, usize)>, voice: Voice) {
    for group in faults.alike() {
        let loud = !(voice.is_quiet() && group[0].severity == Severity::Note);
        match (loud, group.len() < MANY || voice.wants_detail()) {
            (false, _) => {}
            (true, true) => group.iter().for_each(|f| eprint!("{}", rendered_fault(f))),
            (true, false) => eprint!("{}", rendered_fault(&gathered(&group))),
        }
    }
    let count = |severity| faults.of(severity).count();
    if let Some((usable, all)) = usable {
        voice.say(&format!("{usable} of {all} records can be used."));
    }
    voice.say(&format!(
        "{} that stop the campaign, {} that leave a record out, {} to know of.",
        faults_in_words(count(Severity::Campaign)),
        count(Severity::Record),
        count(Severity::Note)
    ));
}

/// Places that a gathered fault names; `--verbose` tells each fault by itself.
const NAMED: usize = 6;

/// One fault for many of the same words; the first of their places in it.
fn gathered(group: &[&Fault]) -> Fault {
    let first = group[0];
    let places: Vec<(&str, Option<&str>)> = group.iter().map(|f| place(&f.key)).collect();
    let channel = places[0]
        .1
        .filter(|c| places.iter().all(|p| p.1 == Some(c)));
    let named = group.iter().zip(&places).take(NAMED).map(|(fault, place)| {
        // A channel that all share is said once.
        if channel.is_some() {
            place.0
        } else {
            fault.key.as_str()
        }
    });
    let named: Vec<&str> = named.collect();
    let more = if group.len() > NAMED { ", …" } else { "" };
    Fault {
        what: format!(
            "{} ({}in {} records: {}{more})",
            first.what,
            channel.map(|c| format!("{c}, ")).unwrap_or_default(),
            group.len(),
            named.join(", ")
        ),
        key: String::new(),
        ..first.clone()
    }
}

/// Record and channel of a key.
fn place(key: &str) -> (&str, Option<&str>) {
    match key.split_once(": ") {
        Some((record, channel)) => (record, Some(channel)),
        None => (key, None),
    }
}

fn faults_in_words(count: usize) -> String {
    match count {
        0 => "No faults".to_owned(),
        1 => "1 fault".to_owned(),
        n => format!("{n} faults"),
    }
}
