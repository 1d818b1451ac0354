//! Kinds of problems of a record, by the names that files and tables have for them.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::message::Message;

/// Defines [`FlagCode`] with the name of each code in files and tables, which is the key of its text.
macro_rules! flag_codes {
    ($($(#[$doc:meta])* $code:ident = $name:literal,)*) => {
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
            fn table(&self) -> &'static str {
                "flag"
            }

            fn kind(&self) -> &'static str {
                self.name()
            }
        }
    };
}

flag_codes! {
    /// The file or the dataset cannot be read.
    Unreadable = "unreadable",
    /// There are no samples.
    Empty = "empty",
    /// There are too few samples.
    TooFewSamples = "too_few_samples",
    /// The dataset has no channel of the stated name.
    MissingChannel = "missing_channel",
    /// The file has no such dataset.
    MissingDataset = "missing_dataset",
    /// Unit, scale or threshold do not suit the channel's role.
    WrongUnit = "wrong_unit",
    /// Neither the file nor the campaign states a unit.
    UnitMissing = "unit_missing",
    /// The channel holds no real numbers.
    NotNumbers = "not_numbers",
    /// Some values are NaN or infinite.
    NotANumber = "not_a_number",
    /// The channels differ in length.
    UnequalLengths = "unequal_lengths",
    /// Samples without a value were cut off at the ends.
    Trimmed = "trimmed",
    /// A channel is constant.
    DeadChannel = "dead_channel",
    /// A channel reaches the limits of its converter.
    Clipped = "clipped",
    /// The rows are changes of the contact, of which those that close it count.
    ContactChanges = "contact_changes",
    /// The rows are neither impacts nor changes of the contact.
    ContactUnclear = "contact_unclear",
    /// Heights from which R follows.
    Heights = "heights",
    /// Readings begin again at the other end of their range.
    Wrapped = "wrapped",
    /// Echoes of impacts were heard.
    Echoes = "echoes",
    /// A camera's picture stood still, then jumped.
    FrozenFrames = "frozen_frames",
    /// Lone samples were far off those around them.
    Spikes = "spikes",
    /// Samples are missing.
    DroppedSamples = "dropped_samples",
    /// Time stamps are repeated.
    RepeatedSamples = "repeated_samples",
    /// The time axis holds no numbers.
    TimeUnreadable = "time_unreadable",
    /// The time runs backward.
    TimeBackward = "time_backward",
    /// The time axis is not uniform.
    TimeNotUniform = "time_not_uniform",
    /// The time is printed too coarsely to tell the rate.
    TimeCoarse = "time_coarse",
    /// The time axis states another unit than campaign.toml does.
    TimeUnitWrong = "time_unit_wrong",
    /// The unit of the time axis is not known.
    TimeUnitMissing = "time_unit_missing",
    /// The unit of the time axis was assumed.
    TimeUnitAssumed = "time_unit_assumed",
    /// Channels that begin at unlike times were put in place.
    ChannelsShifted = "channels_shifted",
    /// A channel does not state when it begins, others do.
    StartMissing = "start_missing",
    /// Channels were not recorded at the same time.
    ChannelsApart = "channels_apart",
    /// No sample rate is known.
    NoSampleRate = "no_sample_rate",
    /// The rate that the file states is not that of its time axis.
    RateContradicts = "rate_contradicts",
    /// The channels differ in sample rate.
    UnequalSampleRates = "unequal_sample_rates",
    /// Channels of the two masses are swapped.
    SwappedMasses = "swapped_masses",
    /// Two channels have opposite signs.
    OppositeSign = "opposite_sign",
    /// Two masses change their velocities at different times.
    SeparateBodies = "separate_bodies",
    /// The scales of two channels contradict each other.
    ScalesContradict = "scales_contradict",
    /// The drive channel holds no harmonic tone.
    DriveNotHarmonic = "drive_not_harmonic",
    /// Measured and stated drive frequency differ.
    DriveFrequencyContradicts = "drive_frequency_contradicts",
    /// A record's drive is not that of its row of the run table.
    RowContradicts = "row_contradicts",
    /// Measured and stated drive amplitude differ.
    DriveAmplitudeContradicts = "drive_amplitude_contradicts",
    /// A displacement goes beyond the stop without an impact.
    BeyondStop = "beyond_stop",
    /// Jumps of the approach velocity go up.
    JumpsPointTheWrongWay = "jumps_point_the_wrong_way",
    /// A channel is positive away from the stop or the other mass; the record was turned around.
    MeasuredAway = "measured_away",
    /// Two masses fly freely and one alone is measured.
    OneMassAlone = "one_mass_alone",
    /// Part of the approach before an impact is no free flight.
    ApproachCut = "approach_cut",
    /// Falls of the velocity without a free flight beside them.
    NoFreeFlight = "no_free_flight",
    /// An impact's approach speed would be above any that was measured.
    SpeedNeverMeasured = "speed_never_measured",
    /// Under constant force no impact was found.
    NoImpact = "no_impact",
    /// No free decay was found.
    NoFreeDecay = "no_free_decay",
    /// Contact pulses without a jump of velocity, of a record that is identified.
    ContactWithoutVelocityJump = "contact_without_velocity_jump",
    /// Contact pulses without a jump of velocity, of a record that is checked.
    ContactWithoutJump = "contact_without_jump",
    /// The contact's threshold is within its noise.
    ThresholdInNoise = "threshold_in_noise",
    /// The contact opens at impacts; it was turned around.
    ContactInverted = "contact_inverted",
    /// The campaign excludes the record.
    Excluded = "excluded",
}

impl fmt::Display for FlagCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
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
