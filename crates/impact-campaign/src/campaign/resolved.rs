//! The campaign as resolved: SI, every default explicit, paths from the working directory. It is
//! written to the results as `campaign.resolved.json`, with `/` in paths on every system.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::sections::about::About;
use super::sections::analysis::Analysis;
use super::sections::published::Published;
use super::sections::report::ReportSettings;
use super::sections::rig::NominalValues;
use super::slashes;
use super::sources::Sources;
use super::values::{Excitation, Flight};
use impact_records::event::DetectSettings;
use impact_records::motion::{ClassifySettings, LateChannel};
use impact_records::record::calibrate::{ChannelSetup, RecordSetup, StatedTimes};
use impact_records::record::{Role, Setting};

/// Its name in a folder of results, which every one has.
pub(crate) const RESOLVED: &str = "campaign.resolved.json";

/// A campaign ready to be analysed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ResolvedCampaign {
    /// What the campaign is.
    #[serde(flatten)]
    pub about: About,
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
    /// What is stated of the times of its records.
    #[serde(flatten)]
    pub times: StatedTimes,
    /// The records in the order of acquisition.
    pub records: Vec<RecordEntry>,
    /// Settings of the analysis.
    pub analysis: Analysis,
    /// Settings of the report.
    pub report: ReportSettings,
    /// Published speeds to be identified from, instead of records.
    #[serde(default)]
    pub published: Option<Published>,
    /// Opens the files of the records.
    #[serde(skip)]
    pub sources: Sources,
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
        self.about.flight == Flight::Harmonic && entry.setting.excitation == Excitation::Harmonic
    }

    /// Settings of the detection of impacts.
    pub fn detect_settings(&self) -> DetectSettings {
        DetectSettings {
            flight: self.about.flight,
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

    /// The same with all paths below a folder; absolute ones stay.
    #[must_use]
    pub(crate) fn below(mut self, base: &Path) -> Self {
        let records = self.records.iter_mut().map(|r| &mut r.file);
        let files = records.chain([&mut self.file]).chain(&mut self.run_table);
        files.for_each(|file| *file = base.join(&*file));
        self
    }

    /// The same with channels that are later than stated by what was found.
    #[must_use]
    pub fn with_late(&self, late: &[LateChannel]) -> Self {
        let mut campaign = self.clone();
        let left_out = |role| {
            late.iter()
                .any(|l| l.role == role && l.unsteady_s.is_some())
        };
        campaign.channels.retain(|setup| !left_out(setup.role));
        for setup in &mut campaign.channels {
            let found = late.iter().find(|l| l.role == setup.role);
            setup.delay_s += found.map_or(0.0, |l| l.delay_s);
            setup.low_pass = setup.low_pass.or(found.and_then(|l| l.low_pass));
            setup.high_pass_hz = setup.high_pass_hz.or(found.and_then(|l| l.high_pass_hz));
            if found.is_some_and(|l| l.inverted) {
                setup.sign = -setup.sign;
            }
        }
        campaign
    }

    /// The campaign with channels turned in those records in which they were found to be of the other sign.
    #[must_use]
    pub fn with_turned(mut self, turned: impl IntoIterator<Item = (usize, Vec<Role>)>) -> Self {
        for (record, roles) in turned {
            self.records[record].setting.turned = roles;
        }
        self
    }

    /// What [`impact_records::record::calibrate::calibrate`] needs for one of its records.
    pub fn setup_of<'a>(&'a self, entry: &'a RecordEntry) -> RecordSetup<'a> {
        RecordSetup {
            id: &entry.id,
            dataset: entry.dataset.unwrap_or(0),
            channels: &self.channels,
            times: &self.times,
            setting: &entry.setting,
            driven: self.driven(entry),
            skip_s: self.analysis.skip_s,
        }
    }
}
