//! From what was found to what the report shows: plain data gathered from the rooms to the left.
//!
//! Nothing is identified here; the fitted model is only drawn beside the measurement.

mod chosen;
mod comparison;
mod decays;
mod evidence;
mod left_out;
mod plane;
mod rows;
mod window;

pub use chosen::chosen_records;
pub use decays::shown_decays;

use std::collections::BTreeMap;

use crate::event::RigKind;
use crate::identify::fit::Fit;
use crate::identify::fit::parameters::Parameters;
use crate::identify::{Identification, Item, Provenance, Reason};
use crate::motion::{Bracket, Observation};
use crate::record::{Record, Role};
use crate::report::content::ReportContent;

/// What the report says of the campaign itself.
#[derive(Debug, Clone)]
pub struct CampaignFacts {
    /// Title of the report.
    pub title: String,
    /// Name of the campaign.
    pub name: String,
    /// One or two masses.
    pub rig: RigKind,
    /// Nominal values: name, value in SI, unit.
    pub nominal: Vec<(String, f64, String)>,
    /// Whether its records are simulated.
    pub synthetic: bool,
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
    /// Where it comes from.
    pub provenance: &'a Provenance,
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
    /// The joint fit.
    fn fit(&self) -> Option<&Fit> {
        self.identification.joint_fit.as_ref().map(|j| &j.fit)
    }

    /// The fitted parameters.
    fn parameters(&self) -> Option<&Parameters> {
        self.fit().map(|fit| &fit.parameters)
    }

    /// Why a record was left out, the first reason of several; by its index.
    fn record_reasons(&self) -> BTreeMap<usize, &Reason> {
        let left_out = self.identification.left_out.iter().rev();
        left_out
            .filter_map(|l| match &l.item {
                Item::Record { index, .. } => Some((*index, &l.reason)),
                Item::Bracket { .. } | Item::Impact { .. } => None,
            })
            .collect()
    }

    /// Why a bracket was left out, by its index.
    fn bracket_reason(&self, bracket: usize) -> Option<&Reason> {
        let mut left_out = self.identification.left_out.iter();
        left_out.find_map(|l| match &l.item {
            Item::Bracket { index, .. } if *index == bracket => Some(&l.reason),
            _ => None,
        })
    }
}

/// Whether a channel of a role measures the motion of a mass.
fn moves(role: Role) -> bool {
    !matches!(role, Role::Drive | Role::Contact) && !role.is_frame()
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
    content.left_out = left_out::left_out(gathered);
    content.provenance = gathered.provenance.clone();
    content.settings_text = gathered.campaign.settings.clone();
    content.command_line = gathered.command_line.to_owned();
    content
}
