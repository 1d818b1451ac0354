//! campaign.toml exactly as written, before anything is checked against anything else.
//!
//! Every quantity with a dimension is a string with number and unit (`clearance = "1.0 mm"`,
//! `natural_frequency = "12.6 Hz"`); only dimensionless quantities may be bare numbers
//! (`damping_ratio = 0.07`). Unknown keys are refused. All keys are optional here: missing ones
//! are handled by [`super::resolve`], so that every problem is reported at once.

use serde::Deserialize;

use super::sections::about::AboutTable;
use super::sections::analysis::AnalysisTable;
use super::sections::channels::ChannelTables;
use super::sections::published::Published;
use super::sections::records::RecordsTable;
use super::sections::report::ReportTable;
use super::sections::rig::RigTable;

/// The whole of campaign.toml.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct WrittenCampaign {
    /// What the campaign is.
    pub campaign: AboutTable,
    /// Where the records are and at which setting each was taken.
    pub records: RecordsTable,
    /// Nominal values of the rig.
    pub rig: RigTable,
    /// The channels by role.
    pub channels: ChannelTables,
    /// Settings of the analysis.
    pub analysis: AnalysisTable,
    /// Settings of the report.
    pub report: ReportTable,
    /// Published speeds to be identified from, instead of records.
    pub published: Option<Published>,
}
