//! What the verdict rests on: mistakes of the laboratory, methods that do not fit, notes, disagreement.

use serde::{Deserialize, Serialize};

use super::direction::direction;
use super::{Note, PairAgreement, Reason, Remark, Sentence, StatedValue};
use crate::messages::cause::Cause;
use crate::method::Method;
use crate::parameters::Coordinate;
use crate::parameters::effect::Effect;
use impact_records::message::{Message, Value};
use impact_records::record::Role;
use impact_records::signal::digits::decimals_for;
use impact_records::{message_table, messages};

/// Something that the data give away. Deviations are relative (0.01 is 1 %); a z-score is a deviation
/// over its standard error.
#[derive(
    Debug, Clone, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum Finding {
    /// A gap is not as stated.
    WrongClearance {
        /// The clearance as stated, m.
        stated_m: f64,
        /// The clearance that fits, m.
        fitting_m: f64,
        /// How sure.
        z_score: f64,
    },
    /// The gain of a channel is far off the stated one.
    WrongGain {
        /// The channel.
        channel: Role,
        /// Relative deviation, positive where the channel reads too high.
        deviation: f64,
        /// How sure.
        z_score: f64,
    },
    /// The gain of the only channel of motion is far off the stated one, or all clearances are.
    GainOrClearances {
        /// The channel.
        channel: Role,
        /// Relative deviation, positive where the channel reads too high.
        deviation: f64,
        /// How sure.
        z_score: f64,
    },
    /// The gains of all channels of motion are off alike, or all clearances are.
    GainsOrClearances {
        /// Relative deviation, positive where the channels read too high.
        deviation: f64,
        /// How sure.
        z_score: f64,
    },
    /// One of the gains of two channels is off, the data do not tell which.
    GainsApart {
        /// The channels, the one that reads more first.
        channels: [Role; 2],
        /// How much more it reads for the same motion, relative.
        deviation: f64,
        /// How sure.
        z_score: f64,
    },
    /// From some record on a channel reads more or less for the same motion than before.
    GainChanged {
        /// The channel.
        channel: Role,
        /// The first record of the second gain.
        record: String,
        /// Its place in the order of acquisition, from 1.
        number: usize,
        /// Number of records.
        of: usize,
        /// How much more the channel reads from there on, relative.
        deviation: f64,
    },
    /// From some record on a channel reads more or less against another one than before; which of both changes is open.
    GainsPart {
        /// The channel.
        channel: Role,
        /// The channel that may change instead, the other way.
        other: Role,
        /// The first record after the change.
        record: String,
        /// Its place in the order of acquisition, from 1.
        number: usize,
        /// Number of records.
        of: usize,
        /// How much more the channel reads from there on, relative.
        deviation: f64,
    },
    /// A channel is later or earlier than stated.
    LateChannel {
        /// The channel.
        channel: Role,
        /// By how much it is later than stated, ms; negative where it is earlier.
        later_ms: f64,
        /// How sure.
        z_score: f64,
    },
    /// A channel has another delay in each record, and is left out.
    UnsteadyChannel {
        /// The channel.
        channel: Role,
        /// How far its delays differ, ms.
        scatter_ms: f64,
    },
    /// The driving force rises with a power of the frequency, beside what is stated or recorded of it.
    ForceLaw {
        /// The power.
        power: f64,
        /// The frequency to which `x_st` refers, Hz.
        at_hz: f64,
    },
    /// The drive amplitudes differ, or are others than the one to which `x_st` refers.
    DriveAmplitudes {
        /// The least, over that to which `x_st` refers.
        lowest: f64,
        /// The greatest.
        highest: f64,
    },
    /// The sign of a channel is the opposite of the stated one.
    InvertedChannel {
        /// The channel.
        channel: Role,
    },
    /// The corner of a channel's high-pass is far off the stated one.
    WrongCorner {
        /// The channel.
        channel: Role,
        /// Relative deviation, positive where the corner is above the stated one.
        deviation: f64,
        /// How sure.
        z_score: f64,
    },
    /// A channel has passed a high-pass that is not stated.
    UndeclaredHighPass {
        /// The channel.
        channel: Role,
        /// Its corner as it fits, Hz.
        corner_hz: f64,
        /// How sure.
        z_score: f64,
    },
    /// The drive's channel has passed a high-pass that is not stated; it is undone.
    DriveHighPass {
        /// The channel.
        channel: Role,
        /// Its corner, Hz.
        corner_hz: f64,
    },
    /// A channel has passed a low-pass that is not stated.
    UndeclaredLowPass {
        /// The channel.
        channel: Role,
        /// Its corner, as jumps show it, or as it fits where its order is known, Hz.
        corner_hz: f64,
        /// Its corner if it has one pole and its jumps take as long, Hz.
        one_pole_hz: f64,
        /// Its order; `None` where the waveforms do not tell it. Of 2 or more poles the waveforms are alike.
        order: Option<u32>,
    },
    /// The masses, springs, dashpots or drives of both sides differ by far more than is stated or assumed.
    SidesUnlike {
        /// Which of them.
        coordinate: Coordinate,
        /// Relative difference, x less y.
        difference: f64,
        /// How many of its standard uncertainties that is off what is stated or assumed.
        deviations: f64,
    },
    /// The velocities of both masses are swapped.
    SwappedChannels {
        /// How sure.
        z_score: f64,
    },
    /// The drive runs at one multiple of the stated frequencies in most records.
    FrequenciesOffAlike {
        /// Measured over stated frequency.
        ratio: f64,
        /// Records in which they contradict each other.
        records: usize,
        /// Records in which both are known.
        of: usize,
    },
    /// All stated frequencies are off by one small ratio: the sampler's clock is, or the generator.
    ClockOrGenerator {
        /// Measured over stated frequency, the mean.
        ratio: f64,
        /// Its standard error.
        standard_error: f64,
        /// Standard uncertainty of the clock, relative.
        clock_uncertainty: f64,
        /// Records in which both are known.
        records: usize,
        /// How sure.
        z_score: f64,
    },
    /// The drive's frequencies are not the stated ones in most records.
    FrequenciesOff {
        /// Records in which they contradict each other.
        records: usize,
        /// Records in which both are known.
        of: usize,
    },
    /// The drive's frequencies of records in a row are those of the neighbouring rows of the run table.
    RowsShifted {
        /// The first of the records.
        record: String,
        /// How many they are.
        records: usize,
    },
    /// A drive's frequency is stated, and no record shows its drive.
    DriveNotMeasured {
        /// Records that state a frequency.
        records: usize,
    },
    /// No record shows its drive; the motions have its stated frequencies, and no phase.
    PhaseNotMeasured {
        /// Records whose motion has the stated frequency.
        records: usize,
    },
    /// The records are of two rigs, one after the other.
    RigChanged {
        /// The first record after the change.
        record: String,
        /// Its number in the order of acquisition, from 1.
        number: usize,
        /// Number of records.
        of: usize,
        /// What differs, as it was before.
        before: Vec<StatedValue>,
        /// The same after.
        after: Vec<StatedValue>,
    },
    /// The records of a clearance are of another rig than all others.
    ClearanceOnOtherRig {
        /// The clearance, m.
        clearance_m: f64,
        /// What differs, as these records have it.
        own: Vec<StatedValue>,
        /// The same of all others.
        others: Vec<StatedValue>,
    },
    /// The records of sweeps down are of another rig than all others.
    SweepsDownOnOtherRig {
        /// What differs, as these records have it.
        own: Vec<StatedValue>,
        /// The same of all others.
        others: Vec<StatedValue>,
    },
    /// Two gaps have each other's clearances.
    ClearancesExchanged {
        /// Their clearances as stated, m.
        pair_m: [f64; 2],
    },
    /// All clearances are counted from another zero than where the masses touch.
    CommonZero {
        /// What has to be added to each, m.
        added_m: f64,
    },
    /// A channel is of the other sign in some records; they are turned.
    TurnedChannel {
        /// The channel.
        channel: Role,
        /// The records.
        records: Vec<String>,
        /// Number of records.
        of: usize,
    },
    /// Impacts are seen whose speeds are hardly known, and no method has a result.
    UncertainSpeeds {
        /// How many.
        impacts: usize,
        /// Standard error of their speeds over these, in the median.
        share: f64,
    },
    /// Some records, in no order, are of another rig than all others.
    RigsMixed {
        /// Their names.
        records: Vec<String>,
        /// Number of records.
        of: usize,
        /// What differs, as these records have it.
        own: Vec<StatedValue>,
        /// The same of all others.
        others: Vec<StatedValue>,
    },
    /// The motions of most records are not known.
    MotionsUndetermined {
        /// How many.
        records: usize,
        /// Of how many that can be used.
        of: usize,
    },
    /// A channel shows hardly anything of a motion that the same channel of the other mass shows.
    FaintChannel {
        /// The channel.
        channel: Role,
        /// That of the other mass.
        other: Role,
        /// In how many records.
        records: usize,
        /// Of how many in which the masses hit.
        of: usize,
        /// What it shows of the other one, in the median of these records.
        share: f64,
    },
    /// The recorded drive has other amplitudes than stated, and the motion follows the stated ones.
    DriveNotOfTheForce {
        /// In how many records.
        records: usize,
        /// Of how many.
        of: usize,
    },
    /// One mass is driven far less than the other, or not at all.
    DrivesUnlike {
        /// ln(`F_x`/`F_y`), forces per unit of mass.
        drive_asymmetry: f64,
    },
    /// Many records begin before their motion has settled.
    RecordsNotSettled {
        /// How many.
        records: usize,
        /// Of how many.
        of: usize,
        /// Time after which a thousandth of a disturbance is left, s.
        wait_s: f64,
    },
    /// The stated clearances are all about twice those that the motions show; none of them is used.
    WholeGapsStated {
        /// Clearance by the motions over the stated one.
        ratio: f64,
        /// Records in which they were compared.
        records: usize,
    },
    /// The clearances that the motions show are one multiple of the stated ones; none of them is used.
    ClearancesOffAlike {
        /// Clearance by the motions over the stated one.
        ratio: f64,
        /// Records in which they were compared.
        records: usize,
    },
    /// The clearances that the motions show are the stated ones and one length; none of them is used.
    ClearancesShifted {
        /// What has to be added to each, m.
        added_m: f64,
        /// Records in which they were compared.
        records: usize,
    },
    /// Two free masses do not change their speeds in the ratio of the stated masses.
    MomentumNotConserved {
        /// `m_y/m_x` as the speeds show it.
        measured: f64,
        /// `m_y/m_x` as stated.
        stated: f64,
        /// How sure.
        z_score: f64,
    },
    /// The rig has an effect beyond the model, which the estimates allow for.
    BeyondModel {
        /// The effect; a harmonic's cosine names its amplitude.
        effect: Effect,
        /// Its strength.
        strength: f64,
        /// Standard error of the strength.
        standard_error: f64,
        /// How sure.
        z_score: f64,
        /// The approach speed for which R is stated, m/s.
        #[serde(default)]
        speed_m_s: f64,
    },
    /// The model does not fit a method's data.
    Misfit {
        /// The method.
        method: Method,
        /// What it noticed.
        remark: Remark,
    },
    /// A method noticed what the laboratory can mend.
    Noticed {
        /// The method.
        method: Method,
        /// What it noticed.
        remark: Remark,
    },
    /// Why a parameter is weak or not identifiable.
    Parameter {
        /// The parameter.
        parameter: Coordinate,
        /// Why.
        note: Note,
    },
    /// Two methods do not agree.
    Disagreement {
        /// The two of those that do not agree which are furthest apart.
        pair: PairAgreement,
    },
    /// The verdict on a specimen.
    Specimen {
        /// Its name.
        specimen: String,
        /// The verdict.
        verdict: Vec<Sentence>,
    },
    /// What the only mass strikes may be a second one that moves.
    StopMayMove,
    /// A record is filed under the wrong specimen.
    MisfiledRecord {
        /// The record's name.
        record: String,
        /// Why it looks so.
        reason: Reason,
    },
    /// A printed damping ratio fits the published speeds.
    PrintedDampingFits {
        /// The printed damping ratio.
        printed: f64,
    },
    /// A printed damping ratio does not fit the published speeds.
    PrintedDampingDoesNotFit {
        /// The printed damping ratio.
        printed: f64,
        /// Greatest relative deviation of a speed.
        deviation: f64,
    },
    /// Some of the published speeds have no motion with a printed damping ratio.
    PrintedDampingWithoutMotion {
        /// The printed damping ratio.
        printed: f64,
        /// Greatest relative deviation of a speed; `None` if one has no motion at any setting.
        deviation: Option<f64>,
        /// The settings without a motion.
        settings: Vec<PublishedSetting>,
    },
}

messages!(Finding);

impl Finding {
    /// The kind of cause that it names; `None` where it has no part in the fits.
    pub fn cause(&self) -> Option<Cause> {
        match self {
            Self::UndeclaredHighPass { .. } | Self::MotionsUndetermined { .. } => {
                Some(Cause::Channel)
            }
            Self::FaintChannel { records, of, .. } if 4 * records > *of => Some(Cause::Channel),
            Self::RigChanged { .. }
            | Self::ClearanceOnOtherRig { .. }
            | Self::SweepsDownOnOtherRig { .. }
            | Self::RigsMixed { .. } => Some(Cause::Change),
            Self::RecordsNotSettled { records, of, .. } if 4 * records > *of => {
                Some(Cause::Unsettled)
            }
            Self::WrongClearance { .. }
            | Self::ClearancesExchanged { .. }
            | Self::CommonZero { .. }
            | Self::WrongGain { .. }
            | Self::GainOrClearances { .. }
            | Self::GainsOrClearances { .. }
            | Self::GainsApart { .. }
            | Self::GainChanged { .. }
            | Self::GainsPart { .. }
            | Self::LateChannel { .. }
            | Self::UnsteadyChannel { .. }
            | Self::ForceLaw { .. }
            | Self::InvertedChannel { .. }
            | Self::TurnedChannel { .. }
            | Self::DriveHighPass { .. }
            | Self::UndeclaredLowPass { .. }
            | Self::WrongCorner { .. }
            | Self::SidesUnlike { .. }
            | Self::SwappedChannels { .. } => Some(Cause::Statement),
            Self::BeyondModel { .. } => Some(Cause::Effect),
            Self::Misfit { remark, .. } => remark.cause(),
            Self::Disagreement { .. } => Some(Cause::Symptom),
            _ => None,
        }
    }
}

message_table! { "finding": Finding, key = template_key;
    Self::WrongClearance { stated_m, fitting_m, .. } =>
        stated_mm = millimetres(*stated_m),
        fitting_mm = millimetres(*fitting_m);
    Self::WrongGain { channel, deviation, .. } | Self::GainOrClearances { channel, deviation, .. } =>
        channel = Value::Message(channel),
        key = Value::Name(channel.name()),
        share = Value::Percent(deviation.abs(), 1),
        direction = direction(*deviation);
    Self::GainsOrClearances { deviation, .. } =>
        share = Value::Percent(deviation.abs(), 1),
        direction = direction(*deviation);
    Self::GainsApart { channels: [high, low], deviation, .. } =>
        high = Value::Message(high),
        high_key = Value::Name(high.name()),
        low = Value::Message(low),
        low_key = Value::Name(low.name()),
        share = Value::Percent(*deviation, 1);
    Self::GainChanged { channel, record, number, of, deviation } =>
        channel = Value::Message(channel),
        record = Value::Name(record),
        number = Value::Count(*number),
        of = Value::Count(*of),
        share = Value::Percent(deviation.abs(), 1);
    Self::GainsPart { channel, other, record, number, of, deviation } =>
        channel = Value::Message(channel),
        other = Value::Message(other),
        record = Value::Name(record),
        number = Value::Count(*number),
        of = Value::Count(*of),
        share = Value::Percent(deviation.abs(), 1);
    Self::LateChannel { channel, later_ms, .. } =>
        channel = Value::Message(channel),
        key = Value::Name(channel.name()),
        time = Value::Number(later_ms.abs(), 2);
    Self::UnsteadyChannel { channel, scatter_ms } =>
        channel = Value::Message(channel),
        time = Value::Number(*scatter_ms, 1);
    Self::ForceLaw { power, at_hz } =>
        power = Value::Number(*power, 2),
        hz = Value::Number(*at_hz, 2);
    Self::DriveAmplitudes { lowest, highest } =>
        lowest = Value::Number(*lowest, 2),
        highest = Value::Number(*highest, 2);
    Self::InvertedChannel { channel } =>
        channel = Value::Message(channel),
        key = Value::Name(channel.name());
    Self::WrongCorner { channel, deviation, .. } =>
        channel = Value::Message(channel),
        key = Value::Name(channel.name()),
        share = Value::Percent(deviation.abs(), 0),
        direction = direction(*deviation);
    Self::UndeclaredHighPass { channel, corner_hz, .. }
    | Self::DriveHighPass { channel, corner_hz } =>
        channel = Value::Message(channel),
        key = Value::Name(channel.name()),
        corner = Value::Shortest(two_digits(*corner_hz));
    Self::UndeclaredLowPass { channel, corner_hz, one_pole_hz, order: None } =>
        channel = Value::Message(channel),
        key = Value::Name(channel.name()),
        corner = Value::Shortest(two_digits(*corner_hz)),
        one_pole = Value::Shortest(two_digits(*one_pole_hz));
    Self::UndeclaredLowPass { channel, corner_hz, .. } =>
        channel = Value::Message(channel),
        key = Value::Name(channel.name()),
        corner = Value::Shortest(two_digits(*corner_hz));
    Self::SidesUnlike { coordinate, difference, deviations } =>
        coordinate = Value::Message(coordinate),
        share = Value::Percent(*difference, 1),
        deviations = Value::Number(deviations.abs(), 1);
    Self::FrequenciesOffAlike { ratio, records, of } =>
        ratio = Value::Number(*ratio, 4),
        records = Value::Count(*records),
        of = Value::Count(*of);
    Self::ClockOrGenerator { ratio, clock_uncertainty, records, .. } =>
        ratio = Value::Number(*ratio, 5),
        clock = Value::Shortest(two_digits(1e6 * clock_uncertainty)),
        records = Value::Count(*records);
    Self::FrequenciesOff { records, of } =>
        records = Value::Count(*records),
        of = Value::Count(*of);
    Self::RowsShifted { record, records } =>
        record = Value::Name(record),
        records = Value::Count(*records);
    Self::DriveNotMeasured { records } => records = Value::Count(*records);
    Self::PhaseNotMeasured { records } => records = Value::Count(*records);
    Self::RigChanged { record, number, of, before, after } =>
        record = Value::Name(record),
        number = Value::Count(*number),
        of = Value::Count(*of),
        before = Value::list(before),
        after = Value::list(after);
    Self::ClearanceOnOtherRig { clearance_m, own, others } =>
        gap = millimetres(*clearance_m),
        own = Value::list(own),
        others = Value::list(others);
    Self::SweepsDownOnOtherRig { own, others } =>
        own = Value::list(own),
        others = Value::list(others);
    Self::ClearancesExchanged { pair_m: [one_m, other_m] } =>
        one_mm = millimetres(*one_m),
        other_mm = millimetres(*other_m);
    Self::CommonZero { added_m } => added_mm = millimetres(*added_m);
    Self::TurnedChannel { channel, records, of } =>
        channel = Value::Message(channel),
        count = Value::Count(records.len()),
        of = Value::Count(*of),
        records = Value::some_names(records);
    Self::UncertainSpeeds { impacts, share } =>
        count = Value::Count(*impacts),
        share = Value::Percent(*share, 0);
    Self::RigsMixed { records, of, own, others } =>
        count = Value::Count(records.len()),
        of = Value::Count(*of),
        records = Value::some_names(records),
        own = Value::list(own),
        others = Value::list(others);
    Self::MotionsUndetermined { records, of } =>
        records = Value::Count(*records),
        of = Value::Count(*of);
    Self::FaintChannel { channel, other, records, of, share } =>
        channel = Value::Message(channel),
        other = Value::Message(other),
        key = Value::Name(channel.name()),
        other_key = Value::Name(other.name()),
        records = Value::Count(*records),
        of = Value::Count(*of),
        times = Value::Shortest(two_digits(share.recip()));
    Self::DriveNotOfTheForce { records, of } =>
        records = Value::Count(*records),
        of = Value::Count(*of);
    Self::DrivesUnlike { drive_asymmetry } =>
        mass = Value::Name(if *drive_asymmetry > 0.0 { "y" } else { "x" }),
        other = Value::Name(if *drive_asymmetry > 0.0 { "x" } else { "y" }),
        share = Value::Shortest(two_digits(100.0 * (-drive_asymmetry.abs()).exp()));
    Self::RecordsNotSettled { records, of, wait_s } =>
        records = Value::Count(*records),
        of = Value::Count(*of),
        wait = Value::Shortest(two_digits(*wait_s));
    Self::WholeGapsStated { ratio, records } =>
        ratio = Value::Number(*ratio, 2),
        records = Value::Count(*records);
    Self::ClearancesOffAlike { ratio, records } =>
        ratio = Value::Shortest(two_digits(*ratio)),
        records = Value::Count(*records);
    Self::ClearancesShifted { added_m, records } =>
        added_mm = Value::Number(1e3 * added_m, 2),
        records = Value::Count(*records);
    Self::MomentumNotConserved { measured, stated, .. } =>
        measured = Value::Number(*measured, 3),
        stated = Value::Number(*stated, 3);
    Self::BeyondModel { effect: Effect::RestitutionSpeed, strength, standard_error, speed_m_s, .. } =>
        strength = of_effect(Effect::RestitutionSpeed, strength.abs(), *standard_error),
        error = of_effect(Effect::RestitutionSpeed, 1.96 * standard_error, *standard_error),
        speed = Value::Number(*speed_m_s, 3);
    Self::BeyondModel { effect, strength, standard_error, .. } =>
        strength = of_effect(*effect, strength.abs(), *standard_error),
        error = of_effect(*effect, 1.96 * standard_error, *standard_error);
    Self::Misfit { method, remark } | Self::Noticed { method, remark } =>
        method = Value::Message(method),
        remark = Value::Message(remark);
    Self::Parameter { parameter, note } =>
        parameter = Value::Message(parameter),
        note = Value::Message(note);
    Self::Disagreement { pair } => pair = Value::Message(pair);
    Self::Specimen { specimen, verdict } =>
        specimen = Value::Name(specimen),
        verdict = sentences(verdict);
    Self::MisfiledRecord { record, reason } =>
        record = Value::Name(record),
        reason = Value::Message(reason);
    Self::PrintedDampingFits { printed } => value = Value::Shortest(*printed);
    Self::PrintedDampingDoesNotFit { printed, deviation } =>
        value = Value::Shortest(*printed),
        share = Value::Percent(*deviation, 1);
    Self::PrintedDampingWithoutMotion { printed, settings, .. } =>
        value = Value::Shortest(*printed),
        settings = Value::list(settings);
}

/// The kind or, of an effect beyond the model, its name and sign, which have texts of their own.
fn template_key(finding: &Finding) -> String {
    match finding {
        Finding::BeyondModel {
            effect, strength, ..
        } => {
            let way = if *strength > 0.0 { "above" } else { "below" };
            format!("{}_{}_zero", effect.name(), way)
        }
        Finding::LateChannel {
            channel, later_ms, ..
        } => {
            let which = if *later_ms > 0.0 { "late" } else { "early" };
            let what = if matches!(channel, Role::Drive | Role::Contact) {
                "drive"
            } else {
                "channel"
            };
            format!("{which}_{what}")
        }
        Finding::UnsteadyChannel {
            channel: Role::Drive,
            ..
        } => "unsteady_drive".to_owned(),
        Finding::GainChanged { deviation, .. } if *deviation < 0.0 => "gain_fell".to_owned(),
        Finding::GainsPart { deviation, .. } if *deviation < 0.0 => "gains_part_less".to_owned(),
        Finding::UndeclaredLowPass { order: Some(1), .. } => "undeclared_low_pass_1".to_owned(),
        Finding::UndeclaredLowPass { order: Some(_), .. } => "undeclared_low_pass_2".to_owned(),
        _ => finding.kind().to_owned(),
    }
}

fn millimetres(metres: f64) -> Value<'static> {
    Value::Number(1e3 * metres, 3)
}

/// A strength of an effect in its unit, with decimals by which the half width of its 95 % interval has two digits.
fn of_effect(effect: Effect, strength: f64, standard_error: f64) -> Value<'static> {
    let factor = effect.unit().factor();
    Value::Number(
        factor * strength,
        decimals_for(1.96 * factor * standard_error),
    )
}

/// Rounded to two significant digits.
fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

fn sentences(verdict: &[Sentence]) -> Value<'_> {
    Value::Sentences(verdict.iter().map(|s| Value::Message(s)).collect())
}

/// A published speed's setting.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PublishedSetting {
    /// R.
    pub restitution: f64,
    /// η.
    pub frequency_ratio: f64,
}

impl Message for PublishedSetting {
    fn table(&self) -> &'static str {
        "value"
    }

    fn kind(&self) -> &'static str {
        "published_setting"
    }

    fn values(&self) -> Vec<(&'static str, Value<'_>)> {
        vec![
            ("restitution", Value::Shortest(self.restitution)),
            ("frequency_ratio", Value::Shortest(self.frequency_ratio)),
        ]
    }
}
