//! What a method noticed about its data.

use serde::{Deserialize, Serialize};

use super::{DampingPoint, Item, Note};
use crate::messages::HeightsCause;
use crate::messages::cause::Cause;
use crate::method::Method;
use impact_records::message::{Message, Value};
use impact_records::signal::decay::DampingLaw;
use impact_records::signal::digits::decimals_for;
use impact_records::{message_table, messages};

/// R at one approach speed.
#[derive(Debug, Default, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SpeedPoint {
    /// Approach speed before the impact, m/s.
    pub speed_m_s: f64,
    /// R at this speed.
    pub restitution: f64,
}

/// R of a bounce or of a record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GroupPoint {
    /// Number of the bounce, from 1, or name of the record.
    pub group: String,
    /// R.
    pub restitution: f64,
    /// Half its 95 % interval.
    pub half_width: f64,
}

impl Message for GroupPoint {
    fn table(&self) -> &'static str {
        "value"
    }

    fn kind(&self) -> &'static str {
        "group_point"
    }

    fn values(&self) -> Vec<(&'static str, Value<'_>)> {
        let decimals = decimals_for(self.half_width);
        vec![
            ("value", Value::Number(self.restitution, decimals)),
            ("half", Value::Number(self.half_width, decimals)),
            ("group", Value::Name(&self.group)),
        ]
    }
}

/// The first few groups.
fn named(groups: &[GroupPoint]) -> Value<'_> {
    abridged(&groups[..groups.len().min(Value::NAMED)], groups.len())
}

/// The first of `count` messages, with an ellipsis for the others.
fn abridged(first: &[impl Message], count: usize) -> Value<'_> {
    Value::abridged(first.iter().map(|m| Value::Message(m)), count)
}

/// Relative deviation of responses from which one degree of freedom does not fit.
pub(crate) const ONE_DEGREE_OF_FREEDOM: f64 = 0.15;

/// What a method noticed about its data. Shares and deviations are relative (0.01 is 1 %).
#[derive(
    Debug, Default, Clone, PartialEq, Serialize, Deserialize, strum::EnumIter, strum::IntoStaticStr,
)]
#[strum(serialize_all = "snake_case")]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case")]
pub enum Remark {
    /// The responses without impacts are those of one degree of freedom.
    OneDegreeOfFreedom {
        /// Root mean square of the relative deviations.
        deviation: f64,
    },
    /// They are not.
    NotOneDegreeOfFreedom {
        /// Root mean square of the relative deviations.
        deviation: f64,
    },
    /// How much of the waveforms the orbits leave unexplained, in the median record.
    WaveformsUnexplained {
        /// Root mean square of the residuals over that of the signal.
        share: f64,
    },
    /// Only some of the waveforms were kept.
    WaveformsThinned {
        /// Number of periodic records whose waveform is fitted.
        fitted: usize,
        /// Number of periodic records.
        periodic: usize,
    },
    /// The method takes the rig as ideal, where effects beyond the model were found.
    #[default]
    IdealRig,
    /// How far the states deviate from impact to impact.
    StatesDeviate {
        /// Root mean square of the deviations over their standard errors.
        ratio: f64,
    },
    /// R by plain least squares on the midpoints of the saddle-node brackets.
    BracketMidpoints {
        /// R.
        restitution: f64,
        /// Half its 95 % interval.
        half_width: f64,
    },
    /// Motions end well before their boundaries.
    EarlyJumps {
        /// Mean distance from the boundary, relative to its frequency.
        distance: f64,
    },
    /// R of the impacts is not R of the whole bodies.
    WhichRestitution {
        /// R where the bodies touch, by the speeds at impacts.
        at_impact: f64,
        /// R of the whole bodies.
        of_bodies: f64,
        /// By which method.
        method: Method,
    },
    /// R is the same at all speeds.
    RestitutionConstant {
        /// Slowest approach speed, m/s.
        slow_m_s: f64,
        /// Fastest approach speed, m/s.
        fast_m_s: f64,
        /// Change of R between them that the data allow.
        within: f64,
    },
    /// R depends on the speed, by so little that one constant with that range as its error serves.
    RestitutionChangesLittle {
        /// R at the slower end of its range.
        slower: SpeedPoint,
        /// R at the faster end.
        faster: SpeedPoint,
    },
    /// R depends on the speed.
    RestitutionChanges {
        /// R at the slower end of its range.
        slower: SpeedPoint,
        /// R at the faster end.
        faster: SpeedPoint,
    },
    /// Speeds after impacts exceed those before.
    SpeedsGained {
        /// Approach speed before the impact, m/s.
        speed_m_s: f64,
        /// Speed after over speed before.
        ratio: f64,
    },
    /// R depends on the speed because a contact lasts several samples.
    LongContact {
        /// R at the slower end of its range.
        slower: SpeedPoint,
        /// R at the faster end.
        faster: SpeedPoint,
        /// Length of a contact, samples.
        samples: f64,
    },
    /// The speeds of most impacts cannot be used.
    FewUsable {
        /// Impacts whose speeds are used.
        used: usize,
        /// Impacts with speeds.
        of: usize,
    },
    /// R changes from bounce to bounce.
    RestitutionByBounce {
        /// R of the first, the second … bounce.
        points: Vec<GroupPoint>,
    },
    /// R differs between records.
    RecordsDiffer {
        /// R of each record.
        points: Vec<GroupPoint>,
    },
    /// The ratio of the masses by conservation of momentum.
    MassRatio {
        /// `m_y/m_x`.
        ratio: f64,
        /// Half its 95 % interval.
        half_width: f64,
    },
    /// How far the times of impacts are off the fitted rows.
    TimesScatter {
        /// Standard error of a time, s.
        error_s: f64,
    },
    /// How long contacts last and how much the air slows the flights is not known, and leaves R open.
    FlightTimesOpen {
        /// Half the 95 % interval that it leaves of R.
        half_width: f64,
    },
    /// How far heights are off those of one R.
    HeightsScatter {
        /// Standard error of a height, m.
        error_m: f64,
    },
    /// How much the air slows the flights is not known, and leaves R of heights open.
    HeightsOpen {
        /// Half the 95 % interval that it leaves of R.
        half_width: f64,
    },
    /// R of heights changes with the height.
    RestitutionByHeight {
        /// R at the least height.
        low: f64,
        /// R at the greatest.
        high: f64,
        /// What may be the cause.
        cause: HeightsCause,
    },
    /// Tops are missing among heights: one height is R⁴ times the one before.
    TopsMissed {
        /// How many.
        count: usize,
        /// The record of the first one.
        record: String,
        /// The height before it, m.
        height_m: f64,
    },
    /// R scatters from impact to impact by more than the errors of what is measured explain.
    RestitutionScatters {
        /// Standard deviation over R.
        share: f64,
    },
    /// One record has another R than all others, which agree; it is left out.
    OddRecord {
        /// Its name.
        record: String,
        /// Its R.
        restitution: f64,
        /// R of the others.
        others: f64,
    },
    /// Flights that follow none of R times their length were left out.
    FlightsLeftOut {
        /// How many.
        count: usize,
    },
    /// Impacts are missing among times: a flight is two.
    ImpactsMissed {
        /// How many.
        count: usize,
        /// The record of the first one.
        record: String,
        /// When it was, s.
        time_s: f64,
    },
    /// Impacts whose speeds are far from those of the others were left out.
    OutlyingImpacts {
        /// How many.
        count: usize,
        /// The first few of them.
        first: Vec<Item>,
    },
    /// How much of the free decays the fits leave unexplained, in the median record.
    DecaysUnexplained {
        /// Root mean square of the residuals over that of the signal.
        share: f64,
        /// The part of it that is no noise.
        #[serde(default)]
        structure: f64,
    },
    /// The free decays have more than one oscillator and noise.
    DecaysHaveStructure {
        /// Root mean square of the residuals over that of the signal.
        share: f64,
        /// The part of it that is no noise.
        structure: f64,
    },
    /// The frequency changes over the decays.
    DecaysDrift {
        /// Number of decays that do.
        count: usize,
        /// Natural frequency in the first quarter of the decay that drifts most, Hz.
        first_hz: f64,
        /// In its last quarter, Hz.
        last_hz: f64,
        /// The change over half the 95 % interval of the whole decay's frequency.
        intervals: f64,
    },
    /// The damping ratio changes over the decays.
    DecaysDamping {
        /// Number of decays along which it does.
        count: usize,
        /// Parts of the decay along which it changes most.
        points: Vec<DampingPoint>,
        /// What explains it.
        law: DampingLaw,
    },
    /// Dry friction damps the decays beside viscous damping.
    DecaysRubbed {
        /// Part of the damping ratio of viscous fits that friction is worth.
        share: f64,
        /// Half its 95 % interval.
        half: f64,
    },
    /// A steady tone beside the decays, fitted with them.
    DecaysHum {
        /// Number of decays with one.
        count: usize,
        /// Frequency of the strongest, Hz.
        frequency_hz: f64,
        /// Its amplitude over that of the decay.
        ratio: f64,
    },
    /// The motion was stopped, not by the rig's damping.
    DecaysStopped {
        /// Number of decays that were.
        count: usize,
        /// When the first was, s from its record's first sample.
        seconds: f64,
    },
    /// Dry friction begins on the way.
    DecaysRubbedLater {
        /// Number of decays in which it does.
        count: usize,
        /// Periods after which it begins in the first of them.
        periods: f64,
    },
    /// Another mode beside the decays, fitted with them.
    DecaysMode {
        /// Number of decays with one.
        count: usize,
        /// Frequency of the strongest, Hz.
        frequency_hz: f64,
        /// Its amplitude over that of the decay.
        ratio: f64,
    },
    /// A decay shows a multiple of its own frequency.
    DecaysHarmonic {
        /// Number of decays that do.
        count: usize,
        /// Which.
        multiple: usize,
        /// Its amplitude over that of the decay.
        ratio: f64,
    },
    /// Two modes of near frequencies beat, which one decay does not explain.
    DecaysBeat {
        /// Number of decays that do.
        count: usize,
        /// Frequency of the stronger one, Hz.
        first_hz: f64,
        /// Of the weaker one, Hz.
        second_hz: f64,
        /// Amplitude of the weaker over that of the stronger.
        ratio: f64,
    },
    /// A drift under the decays, fitted with them.
    DecaysBackground {
        /// Number of decays with one.
        count: usize,
        /// Its greatest range over the decay's amplitude.
        ratio: f64,
    },
    /// Slow noise under the decays makes their intervals wide.
    DecaysSlowNoise {
        /// Number of decays with such noise.
        count: usize,
        /// How many times as wide as by the scatter of neighbouring samples, at most.
        times: f64,
    },
    /// The free decays are not of one oscillator.
    DecaysDiffer {
        /// Greatest relative deviation of a natural frequency from the mean.
        spread: f64,
    },
    /// The free decays have unlike damping ratios.
    DecaysDampingDiffers {
        /// The least.
        low: f64,
        /// The greatest.
        high: f64,
    },
    /// The method has no result.
    NoResult {
        /// Why.
        why: Note,
    },
    /// How well a damping ratio gives the published speeds.
    PublishedSpeedsMet {
        /// The damping ratio.
        damping_ratio: f64,
        /// Greatest relative deviation of a speed.
        deviation: f64,
    },
}

messages!(Remark);

impl Remark {
    /// The kind of cause that it names, of a method that does not fit.
    pub fn cause(&self) -> Option<Cause> {
        match self {
            Self::RestitutionChanges { .. }
            | Self::LongContact { .. }
            | Self::RestitutionByBounce { .. } => Some(Cause::Contact),
            Self::RecordsDiffer { .. } => Some(Cause::Change),
            Self::NotOneDegreeOfFreedom { .. }
            | Self::WaveformsUnexplained { .. }
            | Self::StatesDeviate { .. }
            | Self::WhichRestitution { .. }
            | Self::FewUsable { .. } => Some(Cause::Symptom),
            _ => None,
        }
    }
}

/// The kind or, of R that rises with the speed, a text of its own.
fn template_key(remark: &Remark) -> String {
    match remark {
        Remark::RestitutionChanges { slower, faster }
        | Remark::LongContact { slower, faster, .. }
            if faster.restitution > slower.restitution =>
        {
            format!("{}_rising", remark.kind())
        }
        _ => remark.kind().to_owned(),
    }
}

message_table! { "remark": Remark, key = template_key;
    Self::OneDegreeOfFreedom { deviation } =>
        share = Value::Percent(*deviation, 2),
        most = Value::Percent(ONE_DEGREE_OF_FREEDOM, 0);
    Self::NotOneDegreeOfFreedom { deviation } => share = Value::Percent(*deviation, 0);
    Self::WaveformsUnexplained { share } => share = Value::Percent(*share, 2);
    Self::WaveformsThinned { fitted, periodic } =>
        some = Value::Count(*fitted),
        count = Value::Count(*periodic);
    Self::StatesDeviate { ratio } => ratio = Value::Number(*ratio, 1);
    Self::BracketMidpoints { restitution, half_width } =>
        value = Value::Number(*restitution, decimals_for(*half_width)),
        half = Value::Number(*half_width, decimals_for(*half_width));
    Self::EarlyJumps { distance } => share = Value::Percent(*distance, 1);
    Self::WhichRestitution { at_impact, of_bodies, method } =>
        impact = Value::Number(*at_impact, 4),
        bodies = Value::Number(*of_bodies, 4),
        method = Value::Message(method);
    Self::RestitutionConstant { slow_m_s, fast_m_s, within } =>
        slow = Value::Number(*slow_m_s, 3),
        fast = Value::Number(*fast_m_s, 3),
        change = Value::Number(*within, 3);
    Self::RestitutionChangesLittle { slower, faster } =>
        first = Value::Number(slower.restitution, 4),
        slow = Value::Number(slower.speed_m_s, 3),
        last = Value::Number(faster.restitution, 4),
        fast = Value::Number(faster.speed_m_s, 3);
    Self::RestitutionChanges { slower, faster } =>
        first = Value::Number(slower.restitution, 3),
        slow = Value::Number(slower.speed_m_s, 3),
        last = Value::Number(faster.restitution, 3),
        fast = Value::Number(faster.speed_m_s, 3);
    Self::SpeedsGained { speed_m_s, ratio } =>
        ratio = Value::Number(*ratio, 1),
        speed = Value::Number(*speed_m_s, 3);
    Self::LongContact { slower, faster, samples } =>
        first = Value::Number(slower.restitution, 3),
        slow = Value::Number(slower.speed_m_s, 3),
        last = Value::Number(faster.restitution, 3),
        fast = Value::Number(faster.speed_m_s, 3),
        count = Value::Number(*samples, 0);
    Self::FewUsable { used, of } => used = Value::Count(*used), of = Value::Count(*of);
    Self::RestitutionByBounce { points } => points = named(points);
    Self::RecordsDiffer { points } => points = named(points);
    Self::MassRatio { ratio, half_width } =>
        value = Value::Number(*ratio, decimals_for(*half_width)),
        half = Value::Number(*half_width, decimals_for(*half_width));
    Self::TimesScatter { error_s } => error = Value::Number(1e3 * error_s, 2);
    Self::FlightTimesOpen { half_width } | Self::HeightsOpen { half_width } =>
        half = Value::Number(*half_width, decimals_for(*half_width));
    Self::HeightsScatter { error_m } => error = Value::Number(1e3 * error_m, 1);
    Self::RestitutionByHeight { low, high, cause } =>
        low = Value::Number(*low, 3),
        high = Value::Number(*high, 3),
        cause = Value::Message(cause);
    Self::TopsMissed { count, record, height_m } =>
        count = Value::Count(*count),
        record = Value::Name(record),
        height = Value::Number(*height_m, 3);
    Self::RestitutionScatters { share } => share = Value::Number(1e2 * share, 1);
    Self::OddRecord { record, restitution, others } =>
        record = Value::Name(record),
        own = Value::Number(*restitution, 3),
        others = Value::Number(*others, 3);
    Self::FlightsLeftOut { count } => count = Value::Count(*count);
    Self::ImpactsMissed { count, record, time_s } =>
        count = Value::Count(*count),
        record = Value::Name(record),
        time = Value::Number(*time_s, 3);
    Self::OutlyingImpacts { count, first } =>
        count = Value::Count(*count),
        which = abridged(first, *count);
    Self::DecaysUnexplained { share, structure } =>
        share = Value::Percent(*share, 1),
        structure = Value::Percent(*structure, 1);
    Self::DecaysHaveStructure { share, structure } =>
        share = Value::Percent(*share, 1),
        structure = Value::Percent(*structure, 1);
    Self::DecaysDrift { count, first_hz, last_hz, intervals } =>
        count = Value::Count(*count),
        first = Value::Number(*first_hz, 4),
        last = Value::Number(*last_hz, 4),
        intervals = Value::Number(*intervals, 0);
    Self::DecaysDamping { count, points, law } =>
        count = Value::Count(*count),
        points = Value::list(points),
        law = Value::Message(law);
    Self::DecaysRubbed { share, half } =>
        share = Value::Percent(*share, 1),
        half = Value::Percent(*half, 1);
    Self::DecaysHum { count, frequency_hz, ratio } =>
        count = Value::Count(*count),
        frequency = Value::Number(*frequency_hz, 1),
        share = Value::Percent(*ratio, 1);
    Self::DecaysStopped { count, seconds } =>
        count = Value::Count(*count),
        seconds = Value::Number(*seconds, 2);
    Self::DecaysRubbedLater { count, periods } =>
        count = Value::Count(*count),
        periods = Value::Number(*periods, 1);
    Self::DecaysMode { count, frequency_hz, ratio } =>
        count = Value::Count(*count),
        frequency = Value::Number(*frequency_hz, 1),
        share = Value::Percent(*ratio, 0);
    Self::DecaysHarmonic { count, multiple, ratio } =>
        count = Value::Count(*count),
        multiple = Value::Count(*multiple),
        share = Value::Percent(*ratio, 0);
    Self::DecaysBeat { count, first_hz, second_hz, ratio } =>
        count = Value::Count(*count),
        first = Value::Number(*first_hz, 3),
        second = Value::Number(*second_hz, 3),
        share = Value::Percent(*ratio, 0);
    Self::DecaysBackground { count, ratio } =>
        count = Value::Count(*count),
        share = Value::Percent(*ratio, 0);
    Self::DecaysSlowNoise { count, times } =>
        count = Value::Count(*count),
        times = Value::Number(*times, 0);
    Self::DecaysDiffer { spread } => share = Value::Percent(*spread, 1);
    Self::DecaysDampingDiffers { low, high } =>
        low = Value::Number(*low, 4),
        high = Value::Number(*high, 4);
    Self::NoResult { why } => why = Value::Message(why);
    Self::PublishedSpeedsMet { damping_ratio, deviation } =>
        value = Value::Number(*damping_ratio, 4),
        share = Value::Percent(*deviation, 2);
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::message::plain;

    #[test]
    fn half_widths_keep_two_digits() {
        let point = GroupPoint {
            restitution: 0.81234,
            half_width: 0.000_21,
            group: "felt".to_owned(),
        };
        let text = plain(&point);
        assert!(text.contains("0.81234 ± 0.00021"), "{text}");
        let open = Remark::HeightsOpen {
            half_width: 0.000_31,
        };
        let text = plain(&open);
        assert!(text.contains("± 0.00031"), "{text}");
    }
}
