//! What a report shows: the campaign, the answer, and the comparison with the model, as plain data.

use crate::phrase::{Phrase, Text};
use impact_identification::compare::{Common, Comparison};
use impact_identification::identify::plan::Proposal;
use impact_identification::identify::{Identification, Provenance};
use impact_identification::replay::Compared;
use impact_records::record::calibrate::ChannelSetup;

/// Everything that a report shows. All quantities are SI; what a campaign does not have is empty, so
/// that free decays alone give a report of the pages that apply.
#[derive(Debug, Clone)]
pub struct ReportContent {
    /// Title of the report.
    pub title: String,
    /// What the campaign states about itself.
    pub campaign: CampaignFacts,
    /// The answer.
    pub identification: Identification,
    /// Settings, versions and inputs.
    pub provenance: Provenance,
    /// The fitted model beside the measurement.
    pub compared: Compared,
    /// Settings proposed for measuring next, the best first.
    pub proposals: Vec<Proposal>,
    /// Further tables of numbers, printed with the methods.
    pub tables: Vec<DataTable>,
    /// The command that makes this report again.
    pub command_line: String,
    /// Day of the report, where it is to be printed.
    pub date: Option<String>,
}

/// What the report of several campaigns shows.
#[derive(Debug, Clone)]
pub struct CampaignsContent {
    /// Title.
    pub title: String,
    /// The campaigns, their differences, what they share.
    pub comparison: Comparison,
    /// The command that makes this report again.
    pub command_line: String,
}

/// What a campaign states about itself.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CampaignFacts {
    /// Name of the campaign.
    pub name: String,
    /// What was measured.
    pub subject: Subject,
    /// What it states in words, by the label under which the first page prints it.
    pub stated: Vec<(Phrase, String)>,
    /// First and last day of the acquisition, as the files state them.
    pub dates: Option<[String; 2]>,
    /// Number of input files.
    pub files: usize,
    /// Which rig it was measured on, as stated.
    pub rig: Option<String>,
    /// What the campaigns on that rig have in common, as stated.
    pub shared: Vec<Common>,
    /// Nominal values of the rig as stated.
    pub nominal: Vec<NominalValue>,
    /// The channels.
    pub channels: Vec<ChannelSetup>,
    /// Whether the records are simulated; stated plainly on the first page.
    pub synthetic: bool,
}

/// What was measured.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Subject {
    /// Two masses that hit each other.
    #[default]
    TwoMasses,
    /// One mass that hits a stop.
    OneMass,
    /// Nothing: approach speeds as published.
    PublishedSpeeds,
}

/// A nominal value of the rig.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NominalValue {
    /// Its name.
    pub name: Phrase,
    /// Value in SI.
    pub value: f64,
    /// The SI unit's symbol; empty for a plain number.
    pub unit: &'static str,
}

/// A table of texts and numbers, ready to print; symbols are in dollars.
#[derive(Debug, Clone, PartialEq)]
pub struct DataTable {
    /// What it shows.
    pub caption: Phrase,
    /// Heads of the columns, with their units.
    pub heads: Vec<Text>,
    /// The rows, one cell per head.
    pub rows: Vec<Vec<String>>,
}
