//! Problems of a record, each with its kind, its place and a remedy.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::message::Message;

/// Defines [`FlagCode`] with the name of each code in files and tables, and its text in English and
/// German.
macro_rules! flag_codes {
    ($($(#[$doc:meta])* $code:ident = $name:literal, $english:literal, $german:literal,)*) => {
        /// Kind of a problem.
        #[derive(
            Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
        )]
        pub enum FlagCode {
            $($(#[$doc])* #[serde(rename = $name)] $code,)*
        }

        impl FlagCode {
            /// All codes.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$code),*];

            /// The stable name in files and tables.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$code => $name,)*
                }
            }
        }

        impl Message for FlagCode {
            fn kind(&self) -> &'static str {
                self.name()
            }

            fn texts(&self) -> [&'static str; 2] {
                match self {
                    $(Self::$code => [$english, $german],)*
                }
            }
        }
    };
}

flag_codes! {
    /// The file or the dataset cannot be read.
    Unreadable = "unreadable", "unreadable", "nicht lesbar",
    /// There are no samples.
    Empty = "empty", "empty", "leer",
    /// The dataset has no channel of the stated name.
    MissingChannel = "missing_channel", "missing channel", "fehlender Kanal",
    /// The file has no such dataset.
    MissingDataset = "missing_dataset", "missing dataset", "fehlender Datensatz",
    /// Unit, scale or threshold do not suit the channel's role.
    WrongUnit = "wrong_unit", "wrong unit", "falsche Einheit",
    /// Neither the file nor the campaign states a unit.
    UnitMissing = "unit_missing", "unit missing", "fehlende Einheit",
    /// The channel holds no real numbers.
    NotNumbers = "not_numbers", "not numbers", "keine Zahlen",
    /// Some values are NaN or infinite.
    NotANumber = "not_a_number", "not a number", "keine Zahl",
    /// The channels differ in length.
    UnequalLengths = "unequal_lengths", "unequal lengths", "ungleiche Längen",
    /// Samples without a value were cut off at the ends.
    Trimmed = "trimmed", "trimmed", "beschnitten",
    /// A channel is constant.
    DeadChannel = "dead_channel", "dead channel", "toter Kanal",
    /// A channel reaches the limits of its converter.
    Clipped = "clipped", "clipped", "übersteuert",
    /// The rows are changes of the contact, of which those that close it count.
    ContactChanges = "contact_changes", "changes of the contact", "Wechsel des Kontakts",
    /// The rows are neither impacts nor changes of the contact.
    ContactUnclear = "contact_unclear", "contact unclear", "Kontakt unklar",
    /// A camera's picture stood still, then jumped.
    FrozenFrames = "frozen_frames", "frozen frames", "stehende Bilder",
    /// Samples are missing.
    DroppedSamples = "dropped_samples", "dropped samples", "fehlende Abtastwerte",
    /// Time stamps are repeated.
    RepeatedSamples = "repeated_samples", "repeated samples", "wiederholte Abtastwerte",
    /// The time axis holds no numbers.
    TimeUnreadable = "time_unreadable", "time unreadable", "Zeit nicht lesbar",
    /// The time runs backward.
    TimeBackward = "time_backward", "time backward", "Zeit läuft zurück",
    /// The time axis is not uniform.
    TimeNotUniform = "time_not_uniform", "time not uniform", "Zeit nicht gleichmäßig",
    /// The time is printed too coarsely to tell the rate.
    TimeCoarse = "time_coarse", "time printed coarsely", "Zeit grob gerundet",
    /// The time axis states another unit than campaign.toml does.
    TimeUnitWrong = "time_unit_wrong", "wrong unit of time", "falsche Einheit der Zeit",
    /// The unit of the time axis is not known.
    TimeUnitMissing = "time_unit_missing", "unit of time missing", "Einheit der Zeit fehlt",
    /// The unit of the time axis was assumed.
    TimeUnitAssumed = "time_unit_assumed", "unit of time assumed", "Einheit der Zeit angenommen",
    /// Channels that begin at unlike times were put in place.
    ChannelsShifted = "channels_shifted", "channels shifted", "Kanäle verschoben",
    /// A channel does not state when it begins, others do.
    StartMissing = "start_missing", "start missing", "Beginn fehlt",
    /// Channels were not recorded at the same time.
    ChannelsApart = "channels_apart", "channels apart", "Kanäle nicht gleichzeitig",
    /// No sample rate is known.
    NoSampleRate = "no_sample_rate", "no sample rate", "keine Abtastrate",
    /// The rate that the file states is not that of its time axis.
    RateContradicts = "rate_contradicts", "rate contradicts", "Abtastrate widerspricht",
    /// The channels differ in sample rate.
    UnequalSampleRates = "unequal_sample_rates", "unequal sample rates", "ungleiche Abtastraten",
    /// Channels of the two masses are swapped.
    SwappedMasses = "swapped_masses", "swapped masses", "vertauschte Massen",
    /// Two channels have opposite signs.
    OppositeSign = "opposite_sign", "opposite sign", "entgegengesetzte Vorzeichen",
    /// The scales of two channels contradict each other.
    ScalesContradict = "scales_contradict", "scales contradict", "Maßstäbe widersprechen sich",
    /// The drive channel holds no harmonic tone.
    DriveNotHarmonic = "drive_not_harmonic", "drive not harmonic", "Erregung nicht harmonisch",
    /// Measured and stated drive frequency differ.
    DriveFrequencyContradicts = "drive_frequency_contradicts", "drive frequency contradicts", "Erregerfrequenz widerspricht",
    /// A displacement goes beyond the stop without an impact.
    BeyondStop = "beyond_stop", "beyond the stop", "jenseits des Anschlags",
    /// Jumps of the approach velocity go up.
    JumpsPointTheWrongWay = "jumps_point_the_wrong_way", "jumps point the wrong way", "Sprünge in falscher Richtung",
    /// A channel is positive away from the stop or the other mass; the record was turned around.
    MeasuredAway = "measured_away", "measured away", "in Gegenrichtung gemessen",
    /// Two masses fly freely and one alone is measured.
    OneMassAlone = "one_mass_alone", "one mass alone", "nur eine Masse",
    /// Part of the approach before an impact is no free flight.
    ApproachCut = "approach_cut", "approach cut", "Anflug gekürzt",
    /// Falls of the velocity without a free flight beside them.
    NoFreeFlight = "no_free_flight", "no free flight", "kein freier Flug",
    /// An impact's approach speed would be above any that was measured.
    SpeedNeverMeasured = "speed_never_measured", "speed never measured", "nie gemessene Geschwindigkeit",
    /// Under constant force no impact was found.
    NoImpact = "no_impact", "no impact", "kein Stoß",
    /// No free decay was found.
    NoFreeDecay = "no_free_decay", "no free decay", "kein Ausschwingen",
    /// Contact pulses without a jump of velocity, of a record that is identified.
    ContactWithoutVelocityJump = "contact_without_velocity_jump", "contact without velocity jump", "Kontakt ohne Sprung der Geschwindigkeit",
    /// Contact pulses without a jump of velocity, of a record that is checked.
    ContactWithoutJump = "contact_without_jump", "contact without jump", "Kontakt ohne Sprung",
    /// The campaign excludes the record.
    Excluded = "excluded", "excluded", "ausgeschlossen",
}

impl fmt::Display for FlagCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A problem of a record: its kind, its channel, and a remedy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Flag {
    /// Its kind.
    pub code: FlagCode,
    /// The channel concerned (name in the file), if there is one.
    pub channel: Option<String>,
    /// One sentence: what was found and what was expected.
    pub message: String,
    /// One sentence: what the user can do.
    pub remedy: String,
    /// Whether it excludes the record from the identification.
    pub excludes: bool,
}

impl Flag {
    /// A problem that excludes the record.
    pub fn new(
        code: FlagCode,
        channel: Option<&str>,
        message: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self {
            code,
            channel: channel.map(str::to_owned),
            message: message.into(),
            remedy: remedy.into(),
            excludes: true,
        }
    }

    /// The same problem; it excludes the record if `excludes`.
    #[must_use]
    pub fn excluding(self, excludes: bool) -> Self {
        Self { excludes, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_is_stored_under_its_name() {
        let code = FlagCode::JumpsPointTheWrongWay;
        let stored = serde_json::to_string(&code).unwrap();
        assert_eq!(stored, format!("\"{code}\""));
        assert_eq!(serde_json::from_str::<FlagCode>(&stored).unwrap(), code);
    }
}
