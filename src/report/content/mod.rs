//! What a report says, as plain data: written by the pipeline, drawn by the figures and the
//! document, stored as JSON between the two.
//!
//! All quantities are SI. Every list may be empty and every `Option` may be `None`: a campaign of
//! free decays alone, or a body bouncing on a stop without any drive, gives a report of the pages
//! that apply.

mod evidence;
mod plane;

pub use evidence::*;
pub use plane::*;

use serde::{Deserialize, Serialize};

use crate::identify::{Identification, Provenance};
use crate::motion::Motion;
use crate::record::{Role, Sweep};

/// Everything that a report shows.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ReportContent {
    /// Title of the report.
    pub title: String,
    /// What was measured, when, with what.
    #[serde(default)]
    pub summary: CampaignSummary,
    /// The answer.
    pub identification: Identification,
    /// One row a record.
    #[serde(default)]
    pub records: Vec<RecordRow>,
    /// Measured brackets of the boundaries.
    #[serde(default)]
    pub brackets: Vec<BracketRow>,
    /// Simulated boundaries in the (η, ρ) plane.
    #[serde(default)]
    pub curves: Vec<BoundaryCurve>,
    /// Simulated regions of motion in the (η, ρ) plane.
    #[serde(default)]
    pub region_map: Option<RegionMap>,
    /// Records compared with their simulation, trace by trace.
    #[serde(default)]
    pub comparisons: Vec<Comparison>,
    /// Settings proposed for measuring next, the best first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub proposals: Vec<ProposedPoint>,
    /// Impactless resonance curves.
    #[serde(default)]
    pub resonance: Vec<ResonanceCurve>,
    /// Speeds after over before impact.
    #[serde(default)]
    pub impacts: Vec<ImpactScatter>,
    /// Free decays with their fits.
    #[serde(default)]
    pub free_decays: Vec<FreeDecay>,
    /// Residuals of each method.
    #[serde(default)]
    pub residuals: Vec<ResidualSet>,
    /// Profile likelihoods of the parameters.
    #[serde(default)]
    pub profiles: Vec<Profile>,
    /// Correlation of the jointly estimated parameters.
    #[serde(default)]
    pub correlation: Option<Correlation>,
    /// What was left out, and why.
    #[serde(default)]
    pub left_out: Vec<LeftOut>,
    /// Further tables of numbers, printed with the methods.
    #[serde(default)]
    pub tables: Vec<DataTable>,
    /// Versions and inputs.
    #[serde(default)]
    pub provenance: Provenance,
    /// The resolved settings, as text to be printed.
    #[serde(default)]
    pub settings_text: String,
    /// The command that makes this report again.
    #[serde(default)]
    pub command_line: String,
    /// Further remarks, one paragraph each.
    #[serde(default)]
    pub remarks: Vec<String>,
}

impl ReportContent {
    /// A report that has an answer and nothing else yet; fill the fields that apply.
    pub fn new(title: impl Into<String>, identification: Identification) -> Self {
        Self {
            title: title.into(),
            summary: CampaignSummary::default(),
            identification,
            records: Vec::new(),
            brackets: Vec::new(),
            curves: Vec::new(),
            region_map: None,
            comparisons: Vec::new(),
            proposals: Vec::new(),
            resonance: Vec::new(),
            impacts: Vec::new(),
            free_decays: Vec::new(),
            residuals: Vec::new(),
            profiles: Vec::new(),
            correlation: None,
            left_out: Vec::new(),
            tables: Vec::new(),
            provenance: Provenance::default(),
            settings_text: String::new(),
            command_line: String::new(),
            remarks: Vec::new(),
        }
    }
}

/// What was measured, when, with what.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct CampaignSummary {
    /// Name of the campaign.
    pub name: String,
    /// The rig, in one line.
    pub rig: String,
    /// Who measured, where.
    pub laboratory: Option<String>,
    /// First and last day (or time) of the acquisition, as the files state them.
    pub dates: Option<[String; 2]>,
    /// Number of records read.
    pub records_total: usize,
    /// Number of records that entered the identification.
    pub records_used: usize,
    /// Number of impacts detected.
    pub impacts_total: usize,
    /// Number of input files.
    pub files_total: usize,
    /// Length of a record, s (the most frequent one).
    pub record_length_s: Option<f64>,
    /// Sample rate, Hz.
    pub sample_rate_hz: Option<f64>,
    /// Least and greatest measured drive frequency, Hz.
    pub frequency_range_hz: Option<[f64; 2]>,
    /// The clearances r, m.
    pub clearances_m: Vec<f64>,
    /// Nominal values of the rig as stated in campaign.toml.
    pub nominal: Vec<NominalValue>,
    /// The channels and what recorded them.
    pub channels: Vec<ChannelRow>,
    /// Whether the data are simulated; said plainly on the first page.
    pub synthetic: bool,
    /// Further lines on how it was measured.
    pub notes: Vec<String>,
}

/// A nominal value of the rig.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NominalValue {
    /// What it is, in words; a symbol may stand in dollars, as in `natural frequency $f_0$`.
    pub name: String,
    /// Value in SI.
    pub value: f64,
    /// The SI unit's symbol; empty for a plain number.
    pub unit: String,
}

/// A channel and what recorded it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChannelRow {
    /// What it measures.
    pub role: Role,
    /// Its name in the files.
    pub name: String,
    /// The unit in which the files hold it.
    pub unit: String,
    /// Instrument, threshold and the like, in words.
    #[serde(default)]
    pub note: String,
    /// Corner of the high-pass that it carries, Hz.
    #[serde(default)]
    pub high_pass_hz: Option<f64>,
}

/// One record as the table and the map show it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RecordRow {
    /// The record's name.
    pub id: String,
    /// Rig, mass or bumper, where the campaign holds several.
    #[serde(default)]
    pub specimen: Option<String>,
    /// Measured drive frequency, Hz; `None` without a drive.
    pub frequency_hz: Option<f64>,
    /// η = f/f0, where f0 is known.
    pub eta: Option<f64>,
    /// Clearance r, m.
    pub clearance_m: Option<f64>,
    /// ρ = r/x_st, where x_st is known.
    pub rho: Option<f64>,
    /// Direction of the sweep.
    pub sweep: Sweep,
    /// Type of motion found.
    pub motion: Motion,
    /// Impacts p in one period of the motion.
    pub impacts_p: Option<u32>,
    /// Drive periods n in one period of the motion.
    pub periods_n: Option<u32>,
    /// Confidence in the type of motion, 0 to 1.
    pub confidence: Option<f64>,
    /// Number of impacts seen in the record.
    #[serde(default)]
    pub impacts: usize,
    /// Quality flags, as short words.
    #[serde(default)]
    pub flags: Vec<String>,
    /// The methods that used the record.
    #[serde(default)]
    pub used_by: Vec<String>,
    /// Why no method used it, where none did.
    #[serde(default)]
    pub left_out: Option<String>,
}

/// A table of texts and numbers, ready to print; symbols stand in dollars.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct DataTable {
    /// What it shows.
    pub caption: String,
    /// Heads of the columns, with their units.
    pub heads: Vec<String>,
    /// The rows, as many cells as heads.
    pub rows: Vec<Vec<String>>,
}

/// Something left out, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LeftOut {
    /// What.
    pub what: String,
    /// Why.
    pub why: String,
    /// How many, where it stands for several.
    #[serde(default)]
    pub count: Option<usize>,
}
