//! From what was found to what the report shows: plain data gathered from the rooms to the left.
//!
//! Nothing is identified here; the fitted model is only drawn beside the measurement.

mod comparison;
mod decays;
mod evidence;
mod plane;
mod rows;
mod simulation;

pub use decays::shown_decays;

use crate::event::Rig;
use crate::identify::Identification;
use crate::identify::fit::Fit;
use crate::identify::fit::parameters::Parameters;
use crate::motion::{Bracket, Motion, Observation};
use crate::record::{Record, Role};
use crate::report::content::{LeftOut, ReportContent};

/// What the report says of the campaign itself.
#[derive(Debug, Clone)]
pub struct CampaignFacts {
    /// Title of the report.
    pub title: String,
    /// Name of the campaign.
    pub name: String,
    /// One or two masses.
    pub rig: Rig,
    /// Nominal values: name, value in SI, unit.
    pub nominal: Vec<(String, f64, String)>,
    /// Who measured, and where.
    pub laboratory: Option<String>,
    /// First and last day of the acquisition.
    pub dates: Option<[String; 2]>,
    /// The channels.
    pub channels: Vec<ChannelFacts>,
    /// Number of input files.
    pub files: usize,
    /// The resolved settings as text.
    pub settings: String,
}

/// What the report says of a channel.
#[derive(Debug, Clone)]
pub struct ChannelFacts {
    /// What it measures.
    pub role: Role,
    /// Its name in the files.
    pub name: String,
    /// Corner of its high-pass, Hz.
    pub high_pass_hz: Option<f64>,
    /// What recorded it, in words.
    pub instrument: Option<String>,
}

/// Everything that the report is gathered from.
pub struct Gathered<'a> {
    /// The campaign.
    pub campaign: &'a CampaignFacts,
    /// The records as observed.
    pub observations: &'a [Observation],
    /// The brackets.
    pub brackets: &'a [Bracket],
    /// The answer.
    pub identification: &'a Identification,
    /// The joint fit.
    pub fit: Option<&'a Fit>,
    /// Factor on its covariance.
    pub factor: f64,
    /// What a fit left out, and why.
    pub left_out: &'a [(String, String)],
    /// Indices of the records to be compared with their simulation.
    pub chosen: &'a [usize],
    /// These records, samples included.
    pub chosen_records: &'a [Record],
    /// Indices of the free decays to be drawn.
    pub decays: &'a [usize],
    /// These records, samples included.
    pub decay_records: &'a [Record],
    /// The command that makes this report again.
    pub command_line: &'a str,
}

impl Gathered<'_> {
    /// The fitted parameters.
    fn parameters(&self) -> Option<&Parameters> {
        self.fit.map(|fit| &fit.parameters)
    }
}

/// Most comparisons in one report.
const MOST_COMPARISONS: usize = 8;

/// Records to compare with their simulation: those named, else the surest of each type of motion
/// that the campaign shows, periodic motions with impacts first.
pub fn chosen_records(observations: &[Observation], named: &[String]) -> Vec<usize> {
    let find = |name: &String| observations.iter().position(|o| o.record == *name);
    let by_name: Vec<usize> = named.iter().filter_map(find).collect();
    if !by_name.is_empty() {
        return by_name;
    }
    let mut best: std::collections::BTreeMap<(u8, String), usize> = Default::default();
    for (i, o) in observations.iter().enumerate() {
        let rank = match &o.finding.motion {
            _ if o.excluded() || o.drive.is_none() => continue,
            Motion::Periodic { .. } => 0,
            Motion::Impactless => 1,
            Motion::Beat | Motion::Chaotic => 2,
            _ => continue,
        };
        let key = (rank, o.finding.motion.label());
        let better = |k: &usize| quality(o) > quality(&observations[*k]);
        if best.get(&key).is_none_or(better) {
            best.insert(key, i);
        }
    }
    best.into_values().take(MOST_COMPARISONS).collect()
}

/// Sureness first, then the strength of the motion over its noise.
fn quality(o: &Observation) -> f64 {
    let noise = o.finding.evidence.noise_ratio.unwrap_or(1.0);
    o.finding.confidence.min(0.95) - noise
}

/// Gather the report's content.
pub fn assemble(gathered: &Gathered) -> ReportContent {
    let title = gathered.campaign.title.clone();
    let mut content = ReportContent::new(title, gathered.identification.clone());
    content.summary = rows::summary(gathered);
    content.records = rows::records(gathered);
    content.brackets = rows::brackets(gathered);
    content.curves = plane::curves(gathered);
    content.region_map = plane::region_map(gathered);
    content.comparisons = comparison::comparisons(gathered);
    content.resonance = evidence::resonance(gathered);
    content.impacts = evidence::impacts(gathered);
    content.free_decays = decays::free_decays(gathered);
    content.residuals = evidence::residuals(gathered);
    content.correlation = evidence::correlation(gathered);
    content.profiles = evidence::profiles(gathered);
    content.left_out = left_out(gathered);
    content.settings_text = gathered.campaign.settings.clone();
    content.command_line = gathered.command_line.to_owned();
    content
}

/// Records that no method could use, by reason, and what the fits left out.
fn left_out(gathered: &Gathered) -> Vec<LeftOut> {
    let mut by_reason: std::collections::BTreeMap<String, Why> = Default::default();
    for o in gathered.observations {
        for flag in o.flags.iter().filter(|f| f.excludes) {
            let channel = flag
                .channel
                .as_ref()
                .map(|c| format!(" ({c})"))
                .unwrap_or_default();
            let reason = format!("{}{channel}", flag.code.replace('_', " "));
            let why = by_reason.entry(reason).or_default();
            why.note(&o.record, &flag.message);
        }
        if let Motion::Undetermined { reason } = &o.finding.motion
            && !o.excluded()
            && o.drive.is_some()
        {
            let why = by_reason.entry("motion undetermined".into()).or_default();
            why.note(&o.record, reason);
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
    out.extend(gathered.left_out.iter().map(|(what, why)| LeftOut {
        what: what.clone(),
        why: why.clone(),
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

fn names(records: &[&str]) -> String {
    match records {
        [a, b, c, _, ..] => format!("{a}, {b}, {c} …"),
        few => few.join(", "),
    }
}
