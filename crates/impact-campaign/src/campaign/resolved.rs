//! The campaign as resolved: SI, every default explicit, paths from the working directory. It is
//! written to the results as `campaign.resolved.json`, with `/` in paths on every system.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::slashes;
use super::sources::Sources;
use super::written::{Excitation, Flight, Format, LanguageCode, Machine, Paper};
use impact_identification::compare::Common;
use impact_identification::identify::evidence::options::IntervalMethod;
use impact_identification::identify::parameters::effect::EffectKind;
use impact_records::event::DetectSettings;
use impact_records::motion::{ClassifySettings, LateChannel};
use impact_records::record::Setting;
use impact_records::record::calibrate::{ChannelKey, ChannelSetup, RecordSetup};

/// A campaign ready to be analysed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ResolvedCampaign {
    /// Name on the report's first page.
    pub name: String,
    /// Two masses, or one against a stop.
    pub machine: Machine,
    /// What acts between impacts.
    pub flight: Flight,
    /// Whether its records are simulated.
    #[serde(default)]
    pub synthetic: bool,
    /// Who measured, and where.
    #[serde(default)]
    pub laboratory: Option<String>,
    /// When it was measured, in words.
    #[serde(default)]
    pub measured: Option<String>,
    /// campaign.toml itself.
    #[serde(serialize_with = "slashes::serialize")]
    pub file: PathBuf,
    /// The run table, where there is one.
    #[serde(default, serialize_with = "slashes::serialize_option")]
    pub run_table: Option<PathBuf>,
    /// Nominal values of the rig.
    pub rig: NominalValues,
    /// The channels by role, in the order of the roles.
    pub channels: Vec<ChannelSetup>,
    /// The channel with the time, if the reader of the files cannot find it.
    pub time: Option<ChannelKey>,
    /// Seconds in the unit of the time axes that state none.
    #[serde(default)]
    pub time_unit_s: Option<f64>,
    /// Samples per second, Hz, for files that state none.
    pub sample_rate_hz: Option<f64>,
    /// The records in the order of acquisition.
    pub records: Vec<RecordEntry>,
    /// Settings of the analysis.
    pub analysis: Analysis,
    /// Settings of the report.
    pub report: Report,
    /// Published speeds to be identified from, instead of records.
    #[serde(default)]
    pub published: Option<super::written::Published>,
    /// Opens the files of the records.
    #[serde(skip)]
    pub sources: Sources,
}

/// Nominal values of the rig (`None`: not stated) and their standard uncertainties.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct NominalValues {
    /// Natural frequency f0, Hz.
    pub natural_frequency_hz: Option<f64>,
    /// Damping ratio β.
    pub damping_ratio: Option<f64>,
    /// Static deflection `x_st`, m.
    pub static_deflection_m: Option<f64>,
    /// Coefficient of restitution R.
    pub restitution: Option<f64>,
    /// Mass x, kg.
    pub mass_x_kg: Option<f64>,
    /// Mass y, kg.
    pub mass_y_kg: Option<f64>,
    /// Standard uncertainty of the channels' scales, relative.
    pub gain_uncertainty: f64,
    /// Standard uncertainty of the corners of the channels' high-pass, relative.
    pub corner_uncertainty: f64,
    /// Standard uncertainty of the sampler's clock, relative.
    #[serde(default)]
    pub clock_uncertainty: f64,
    /// Standard uncertainty of the clearances, m.
    pub clearance_uncertainty_m: f64,
    /// Standard uncertainty of the masses, relative.
    #[serde(default)]
    pub mass_uncertainty: f64,
    /// Effects beyond the model that the fit allows; `None`: all.
    #[serde(default)]
    pub effects: Option<Vec<EffectKind>>,
    /// Which rig it is, in words.
    #[serde(default)]
    pub name: Option<String>,
    /// What stays the same in all campaigns on the rig.
    #[serde(default)]
    pub shared: Vec<Common>,
}

/// Settings of the analysis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Analysis {
    /// Part of each record skipped at its start, s.
    pub skip_s: f64,
    /// Longest motion searched, in drive periods.
    pub longest_period_n: u32,
    /// Most impacts searched in one period of a motion.
    pub most_impacts_p: u32,
    /// Seed of everything random.
    pub seed: u64,
    /// Method of the intervals, in addition to the covariance.
    #[serde(default)]
    pub uncertainty: IntervalMethod,
    /// Replicas of a bootstrap.
    #[serde(default)]
    pub replicas: usize,
}

/// Settings of the report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Title.
    pub title: String,
    /// Records whose time series and phase portraits are drawn; empty: chosen by the program.
    pub points: Vec<String>,
    /// Paper size.
    pub paper: Paper,
    /// Language.
    pub language: LanguageCode,
    /// Whether numbers are printed with a decimal comma.
    pub decimal_comma: bool,
    /// Formats; the data of the figures are always written.
    #[serde(default)]
    pub formats: Vec<Format>,
    /// A typst template instead of the built-in one.
    #[serde(default, serialize_with = "slashes::serialize_option")]
    pub template: Option<PathBuf>,
    /// A table of the report's words in another language.
    #[serde(default, serialize_with = "slashes::serialize_option")]
    pub words: Option<PathBuf>,
    /// An image for the first page.
    #[serde(default, serialize_with = "slashes::serialize_option")]
    pub logo: Option<PathBuf>,
}

/// One record of the campaign.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RecordEntry {
    /// Name, unique in the campaign.
    pub id: String,
    /// The file, absolute or relative to the working directory.
    #[serde(serialize_with = "slashes::serialize")]
    pub file: PathBuf,
    /// Index of the dataset in the file; `None` if the file could not be opened.
    pub dataset: Option<usize>,
    /// The setting as stated.
    pub setting: Setting,
    /// Whether `exclude` names it.
    pub excluded: bool,
}

impl ResolvedCampaign {
    /// The folder of campaign.toml.
    pub fn folder(&self) -> &Path {
        self.file.parent().unwrap_or(Path::new("."))
    }

    /// Whether a record must contain a harmonic drive.
    pub fn driven(&self, entry: &RecordEntry) -> bool {
        self.flight == Flight::Harmonic && entry.setting.excitation == Excitation::Harmonic
    }

    /// Settings of the detection of impacts.
    pub fn detect_settings(&self) -> DetectSettings {
        DetectSettings {
            flight: self.flight,
            ..DetectSettings::default()
        }
    }

    /// Settings of the classification of motions.
    pub fn classify_settings(&self) -> ClassifySettings {
        ClassifySettings {
            most_periods: self.analysis.longest_period_n,
            most_impacts: self.analysis.most_impacts_p,
            ..ClassifySettings::default()
        }
    }

    /// The same with channels that are later than stated by what was found.
    #[must_use]
    pub fn with_late(&self, late: &[LateChannel]) -> Self {
        let mut campaign = self.clone();
        for setup in &mut campaign.channels {
            let found = late.iter().find(|l| l.role == setup.role);
            setup.delay_s += found.map_or(0.0, |l| l.delay_s);
            setup.low_pass = setup.low_pass.or(found.and_then(|l| l.low_pass));
        }
        campaign
    }

    /// What [`impact_records::record::calibrate::calibrate`] needs for one of its records.
    pub fn setup_of<'a>(&'a self, entry: &'a RecordEntry) -> RecordSetup<'a> {
        RecordSetup {
            id: &entry.id,
            dataset: entry.dataset.unwrap_or(0),
            channels: &self.channels,
            time: self.time.as_ref(),
            time_unit_s: self.time_unit_s,
            sample_rate_hz: self.sample_rate_hz,
            setting: &entry.setting,
            driven: self.driven(entry),
            skip_s: self.analysis.skip_s,
        }
    }
}
