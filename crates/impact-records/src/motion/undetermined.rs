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

message_table! { Undetermined;
    Self::DecayWithoutDrive =>
        "a free decay, without drive",
        "ein Ausschwingversuch, ohne Erregung";
    Self::NoDrive =>
        "no drive was measured, so no period is known",
        "keine Erregung wurde gemessen, daher ist keine Periode bekannt";
    Self::FewerThanTwoPeriods =>
        "the record holds fewer than two drive periods",
        "die Aufzeichnung enthält weniger als zwei Erregerperioden";
    Self::NotComparable =>
        "the waveform could not be compared with itself",
        "der Verlauf ließ sich nicht mit sich selbst vergleichen";
    Self::NearlyCloses { periods_n } =>
        "the motion nearly closes after {periods} drive periods but not within the noise: still \
         settling, or of a longer period",
        "die Bewegung schließt sich nach {periods} Erregerperioden beinahe, aber nicht innerhalb \
         des Rauschens: noch nicht eingeschwungen, oder von längerer Periode",
        periods = count(*periods_n);
    Self::NoMotion =>
        "neither velocity nor contact shows any motion",
        "weder Geschwindigkeit noch Kontakt zeigt eine Bewegung";
    Self::NoPeriodOfImpacts =>
        "the impact times alone show no period",
        "die Stoßzeiten allein zeigen keine Periode";
    Self::NoWholePeriod =>
        "no whole period of the motion fits into the record",
        "keine ganze Periode der Bewegung passt in die Aufzeichnung";
    Self::TooManyImpacts { periods_n, impacts_p, most } =>
        "the waveform closes after {periods} drive periods with {impacts} impacts, more than the \
         {most} that are looked for (analysis.most_impacts_p)",
        "der Verlauf schließt sich nach {periods} Erregerperioden mit {impacts} Stößen, mehr als \
         den {most}, nach denen gesucht wird (analysis.most_impacts_p)",
        periods = count(*periods_n), impacts = count(*impacts_p), most = count(*most);
    Self::ImpactsDoNotRepeat { periods_n } =>
        "the waveform closes after {periods} drive periods, but the impacts found do not repeat \
         with it: some were missed or are too slow to see",
        "der Verlauf schließt sich nach {periods} Erregerperioden, aber die gefundenen Stöße \
         wiederholen sich nicht mit ihm: einige fehlen oder sind zu langsam, um sichtbar zu sein",
        periods = count(*periods_n);
    Self::RepeatsWithoutImpact { periods_n } =>
        "no impact was found, yet the motion repeats only after {periods} drive periods: impacts \
         too slow to see, or still settling",
        "kein Stoß wurde gefunden, doch wiederholt sich die Bewegung erst nach {periods} \
         Erregerperioden: Stöße, die zu langsam sind, oder noch nicht eingeschwungen",
        periods = count(*periods_n);
    Self::HarmonicsWithoutImpact =>
        "no impact was found, yet the waveform has the harmonics of a motion with impacts: they are \
         too slow to see in these channels",
        "kein Stoß wurde gefunden, doch hat der Verlauf die Oberschwingungen einer Bewegung mit Stößen: \
         sie sind in diesen Kanälen zu langsam, um sichtbar zu sein";
    Self::SettlingWithoutImpact =>
        "no impact was found, yet the motion does not repeat: still settling",
        "kein Stoß wurde gefunden, doch wiederholt sich die Bewegung nicht: noch nicht \
         eingeschwungen";
    Self::NotSettled =>
        "not settled: the record begins before the disturbance of the start, or of the last change \
         of a setting, has died away",
        "nicht eingeschwungen: die Aufzeichnung beginnt, bevor die Störung vom Anfang oder von der \
         letzten Änderung einer Einstellung abgeklungen ist";
    Self::FewImpacts =>
        "too few impacts to recognise an irregular motion",
        "zu wenige Stöße, um eine unregelmäßige Bewegung zu erkennen";
    Self::NotPeriodic =>
        "the noiseless simulation is not periodic",
        "die rauschfreie Simulation ist nicht periodisch";
    Self::BeyondContact => "starts beyond the contact", "beginnt jenseits des Kontakts";
}

fn count(n: u32) -> Value<'static> {
    Value::Count(usize::try_from(n).unwrap_or(usize::MAX))
}
