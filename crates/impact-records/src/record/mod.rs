//! What was acquired: a record of channels on one time axis, in SI, with its setting and flags.
//!
//! [`labfiles`] opens files of any supported format; calibration turns what they hold into
//! [`Record`]s. A simulated record is the same type, so that one detector and one classifier
//! judge experiment and simulation alike. This module does not use the model.

mod alignment;
mod bind;
pub mod calibrate;
pub mod changes;
mod condition;
pub mod consistency;
mod contact_levels;
mod content;
mod even;
mod events;
mod flag;
mod flag_code;
mod gaps;
mod heights;
mod held;
mod high_pass;
pub mod late;
mod low_pass;
pub mod problem;
mod role;
mod spikes;
mod table_rows;
pub mod time_axis;
mod times;
mod wrapped;

use serde::{Deserialize, Serialize};

use labfiles::units::Dimension;

pub use content::ContactContent;
pub use flag::Flag;
pub use flag_code::FlagCode;
pub use high_pass::before_high_pass;
pub use low_pass::LowPass;
pub use problem::{MeasuredQuantity, MistakenUnits, Problem, Remedy};
pub use role::Role;

/// One channel of a record, calibrated to SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// What it measures.
    pub role: Role,
    /// Its name in the file.
    pub name: String,
    /// Its dimension, hence its SI unit.
    pub dimension: Dimension,
    /// The samples, SI.
    pub values: Vec<f64>,
    /// Corner of the first-order high-pass that the signal still carries, Hz; `None`: none.
    pub high_pass_hz: Option<f64>,
    /// Low-pass that the signal has passed; `None`: none that matters.
    pub low_pass: Option<LowPass>,
    /// How it was smoothed, where it rang beside impacts; `None`: it is as it was measured.
    pub smoothing: Option<Smoothing>,
    /// Level between open and closed contact, SI; only for [`Role::Contact`].
    pub threshold: Option<f64>,
}

/// How a channel was smoothed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Smoothing {
    /// Time to either side by which a jump is spread, s.
    pub reach_s: f64,
    /// Standard deviation of the white noise before, SI.
    pub noise: f64,
}

/// Direction in which the drive frequency was stepped when the record was taken.
#[derive(
    Debug,
    Default,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    strum::EnumIter,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantNames,
)]
#[strum(serialize_all = "snake_case", ascii_case_insensitive)]
#[serde(rename_all = "snake_case")]
pub enum Sweep {
    /// Frequency stepped upward.
    Up,
    /// Frequency stepped downward.
    Down,
    /// Not stated: the record holds no information about hysteresis.
    #[default]
    Unknown,
}

crate::message_table! { "sweep": Sweep; }

impl Sweep {
    /// The direction's name in tables.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// How a record was excited.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    Hash,
    Serialize,
    Deserialize,
    strum::EnumString,
    strum::VariantNames,
)]
#[strum(serialize_all = "snake_case", ascii_case_insensitive)]
#[serde(rename_all = "snake_case")]
pub enum Excitation {
    /// A harmonic drive.
    #[default]
    Harmonic,
    /// A blow or a release, then nothing.
    FreeDecay,
}

/// The setting at which a record was taken, as the laboratory states it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Setting {
    /// Drive frequency as written down, Hz (the program measures its own).
    pub stated_frequency_hz: Option<f64>,
    /// Half the static gap: r in "gap 2r", m (for a mass against a stop: the whole gap).
    pub clearance_m: Option<f64>,
    /// Direction of the frequency sweep.
    pub sweep: Sweep,
    /// Drive amplitude relative to the campaign's nominal one.
    pub drive_amplitude: f64,
    /// Position in the order of acquisition.
    pub sequence: usize,
    /// Which rig, mass or bumper it was taken on, if a campaign holds several (column
    /// `specimen` of the run table); parameters are identified for each.
    #[serde(default)]
    pub specimen: Option<String>,
    /// How it was excited.
    #[serde(default)]
    pub excitation: Excitation,
    /// Channels that were found to be of the other sign in this record and not in others; they are turned as it is read.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub turned: Vec<Role>,
}

impl Default for Setting {
    /// Nothing is stated but the usual drive.
    fn default() -> Self {
        Self {
            stated_frequency_hz: None,
            clearance_m: None,
            sweep: Sweep::default(),
            drive_amplitude: 1.0,
            sequence: 0,
            specimen: None,
            excitation: Excitation::default(),
            turned: Vec::new(),
        }
    }
}

/// How well a contact that lists the times of impacts states them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ListedTimes {
    /// Standard error of each, s: that of the last digit, and of where in the contact the impact is.
    pub error_s: f64,
    /// How long the contact is usually closed, s; 0 where that is not known. It is part of the intervals from one
    /// closing to the next.
    pub contact_s: f64,
    /// Of heights: standard error of each by its last digit, m.
    pub digit_m: f64,
    /// Of heights: standard uncertainty of each as it is stated, m; 0 where it is not.
    pub height_m: f64,
}

/// A record: channels of one acquisition on one uniform time axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Name, unique in the campaign: the file's name, with the dataset if a file holds many.
    pub id: String,
    /// Samples per second, Hz.
    pub sample_rate_hz: f64,
    /// The channels that campaign.toml names, all of the same length.
    pub channels: Vec<Channel>,
    /// The setting at which it was taken.
    pub setting: Setting,
    /// What is known of the times that a contact lists; nothing where it has samples.
    pub listed: ListedTimes,
    /// Problems found while it was read.
    pub flags: Vec<Flag>,
}

impl Record {
    /// The channel of a role, if the record has one.
    pub fn channel(&self, role: Role) -> Option<&Channel> {
        self.channels.iter().find(|c| c.role == role)
    }

    /// The samples of a role, SI.
    pub fn values(&self, role: Role) -> Option<&[f64]> {
        self.channel(role).map(|c| c.values.as_slice())
    }

    /// Number of samples of each channel.
    pub fn samples(&self) -> usize {
        self.channels.first().map_or(0, |c| c.values.len())
    }

    /// Duration, s.
    pub fn duration_s(&self) -> f64 {
        self.samples() as f64 / self.sample_rate_hz
    }

    /// Whether a flag excludes it from the identification.
    pub fn excluded(&self) -> bool {
        self.flags.iter().any(|f| f.excludes)
    }
}

#[cfg(test)]
impl Record {
    /// A record of some channels at a sample rate; a contact closes above 2.5 V.
    pub(crate) fn of(sample_rate_hz: f64, channels: &[(Role, &[f64])]) -> Self {
        let channel = |(role, values): &(Role, &[f64])| Channel {
            role: *role,
            name: role.name().to_owned(),
            dimension: role.dimension().unwrap_or(Dimension::Voltage),
            values: values.to_vec(),
            high_pass_hz: None,
            low_pass: None,
            smoothing: None,
            threshold: (*role == Role::Contact).then_some(2.5),
        };
        Self {
            id: "record".into(),
            sample_rate_hz,
            channels: channels.iter().map(channel).collect(),
            setting: Setting::default(),
            listed: Default::default(),
            flags: Vec::new(),
        }
    }
}
