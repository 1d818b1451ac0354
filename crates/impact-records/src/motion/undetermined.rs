//! Why a record does not determine its motion.

use serde::{Deserialize, Serialize};

use crate::message::Value;
use crate::{message_table, messages};

/// Why a record does not determine its motion.
#[derive(
    Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum Undetermined {
    /// A free decay has no drive.
    DecayWithoutDrive,
    /// No drive was measured.
    NoDrive,
    /// The record is too short.
    FewerThanTwoPeriods,
    /// The waveform could not be compared with itself.
    NotComparable,
    /// The motion closes, but not within the noise.
    NearlyCloses {
        /// Drive periods after which it does.
        periods_n: u32,
    },
    /// No channel shows a motion.
    NoMotion,
    /// Without velocity, the impact times show no period.
    NoPeriodOfImpacts,
    /// The record is shorter than the motion's period.
    NoWholePeriod,
    /// More impacts than the settings allow.
    TooManyImpacts {
        /// Drive periods of the motion.
        periods_n: u32,
        /// Impacts in them.
        impacts_p: u32,
        /// Most impacts that are looked for.
        most: u32,
    },
    /// The waveform closes, the impacts do not repeat with it.
    ImpactsDoNotRepeat {
        /// Drive periods of the motion.
        periods_n: u32,
    },
    /// No impact, but a motion of several drive periods.
    RepeatsWithoutImpact {
        /// Drive periods of the motion.
        periods_n: u32,
    },
    /// No impact, but the waveform of one: several harmonics of the drive.
    HarmonicsWithoutImpact,
    /// No impact, but a contact that closes again and again.
    ContactAlone {
        /// How often it closes.
        pulses: usize,
    },
    /// No impact, and no period.
    SettlingWithoutImpact,
    /// What the motion misses closing by dies away: the record begins before it has settled.
    NotSettled,
    /// Too few impacts for an irregular motion.
    FewImpacts,
    /// A simulation that is not periodic.
    NotPeriodic,
    /// Starts beyond the contact.
    BeyondContact,
}

messages!(Undetermined);

message_table! { "undetermined": Undetermined;
    Self::NearlyCloses { periods_n } => periods = count(*periods_n);
    Self::TooManyImpacts { periods_n, impacts_p, most } =>
        periods = count(*periods_n),
        impacts = count(*impacts_p),
        most = count(*most);
    Self::ImpactsDoNotRepeat { periods_n } => periods = count(*periods_n);
    Self::RepeatsWithoutImpact { periods_n } => periods = count(*periods_n);
    Self::ContactAlone { pulses } => pulses = Value::Count(*pulses);
}

fn count(n: u32) -> Value<'static> {
    Value::Count(usize::try_from(n).unwrap_or(usize::MAX))
}
