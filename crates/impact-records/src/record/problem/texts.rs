//! The values that the sentences about problems of a record have.

use super::kind::Problem;
use crate::message::Value;
use crate::message_table;
use crate::record::role::Role;
use crate::signal::digits::significant;
use labfiles::units::Dimension;

/// Significant digits of a level of a channel.
const LEVEL_DIGITS: i32 = 5;

/// What the user can do about a problem.
#[derive(Debug, Clone)]
pub struct Remedy(pub Problem);

impl From<&Remedy> for &'static str {
    fn from(remedy: &Remedy) -> Self {
        (&remedy.0).into()
    }
}

fn remedy_key(remedy: &Remedy) -> String {
    format!("{}_remedy", <&'static str>::from(remedy))
}

fn at_level(value: f64) -> Value<'static> {
    Value::Digits(significant(value, LEVEL_DIGITS))
}

fn symbol(dimension: Dimension) -> Value<'static> {
    Value::Name(dimension.si_symbol())
}

/// A role as campaign.toml names it.
fn in_campaign(role: Role) -> Value<'static> {
    Value::Name(role.name())
}

/// A number with four digits and a power of ten.
fn power(value: f64) -> Value<'static> {
    Value::Digits(format!("{value:.3e}"))
}

fn mm(value_m: f64) -> Value<'static> {
    Value::Number(1e3 * value_m, 4)
}

fn names(names: &[String]) -> Value<'_> {
    Value::List(names.iter().map(|n| Value::Name(n)).collect())
}

message_table! { "problem": Problem;
    Self::FaultInFile { found, .. } => found = Value::Name(found);
    Self::FaultInChannel { channel, found, .. } =>
        channel = Value::Name(channel),
        found = Value::Name(found);
    Self::FewerDatasets { path, datasets, index } =>
        path = Value::Name(path),
        datasets = Value::Count(*datasets),
        index = Value::Count(*index);
    Self::NoDataset { path } => path = Value::Name(path);
    Self::AllSkipped { duration_s, skip_s } =>
        duration = Value::Shortest(*duration_s),
        skip = Value::Shortest(*skip_s);
    Self::FewSamples { samples } => samples = Value::Count(*samples);
    Self::NoSuchChannel { channel, role, channels } =>
        channel = Value::Name(channel),
        role = in_campaign(*role),
        channels = names(channels);
    Self::NoSuchTimeAxis { channel } => channel = Value::Name(channel);
    Self::NoSuchDataset { dataset, line, datasets } =>
        dataset = Value::Name(dataset),
        line = Value::Count(*line),
        datasets = names(datasets);
    Self::UnitContradicts { channel, stated, ours, .. } =>
        channel = Value::Name(channel),
        stated = Value::Name(stated),
        ours = Value::Name(ours);
    Self::UnitContradictsOther { channel, stated, .. } =>
        channel = Value::Name(channel),
        stated = Value::Name(stated);
    Self::UnfitScale { channel, dimension, .. } =>
        channel = Value::Name(channel),
        dimension = Value::Message(dimension);
    Self::WrongQuantity { channel, role, found, expected } =>
        channel = Value::Name(channel),
        role = in_campaign(*role),
        found = Value::Message(found),
        expected = Value::Message(expected);
    Self::VoltageOfMotion { channel, role, expected, .. } =>
        channel = Value::Name(channel),
        role = in_campaign(*role),
        expected = Value::Message(expected);
    Self::TurningMotion { channel, role, found, expected, .. } =>
        channel = Value::Name(channel),
        role = in_campaign(*role),
        found = Value::Message(found),
        expected = Value::Message(expected);
    Self::UnknownUnit { channel, unit, .. } =>
        channel = Value::Name(channel),
        unit = Value::Name(unit);
    Self::NoUnit { channel, .. } => channel = Value::Name(channel);
    Self::NoRealNumbers { channel } => channel = Value::Name(channel);
    Self::MissingValues { channel, count, first } =>
        channel = Value::Name(channel),
        count = Value::Count(*count),
        first = Value::Count(*first);
    Self::ShortGapsFilled { channel, count, gaps, first } =>
        channel = Value::Name(channel),
        count = Value::Count(*count),
        gaps = Value::Count(*gaps),
        first = Value::Count(*first);
    Self::GapsLeftOut { channel, count, gaps, first } =>
        channel = Value::Name(channel),
        count = Value::Count(*count),
        gaps = Value::Count(*gaps),
        first = Value::Count(*first);
    Self::LengthsDiffer { shortest, longest } =>
        shortest = Value::Count(*shortest),
        longest = Value::Count(*longest);
    Self::EndsCutOff { count } => count = Value::Count(*count);
    Self::ConstantChannel { channel, level, dimension } =>
        channel = Value::Name(channel),
        level = at_level(*level),
        unit = symbol(*dimension);
    Self::ClippedSamples { channel, count, share, low, high, dimension } =>
        channel = Value::Name(channel),
        count = Value::Count(*count),
        share = Value::Percent(*share, 1),
        low = at_level(*low),
        high = at_level(*high),
        unit = symbol(*dimension);
    Self::ClippedSwings { channel, count, low, high, dimension } =>
        channel = Value::Name(channel),
        count = Value::Count(*count),
        low = at_level(*low),
        high = at_level(*high),
        unit = symbol(*dimension);
    Self::ClippedSpikes { channel, count, level, dimension } =>
        channel = Value::Name(channel),
        count = Value::Count(*count),
        level = at_level(*level),
        unit = symbol(*dimension);
    Self::ChangesOfLine { channel, count, closed } =>
        channel = Value::Name(channel),
        count = Value::Count(*count),
        closed = Value::Shortest(*closed);
    Self::GroupsOfRows { closed_s, impacts } =>
        length = Value::Number(1e3 * closed_s, 3),
        impacts = Value::Count(*impacts);
    Self::ThrowsInRows { throws, impacts } =>
        throws = Value::Count(*throws),
        impacts = Value::Count(*impacts);
    Self::HeightsTaken { impacts, drops, highest_m, lowest_m } =>
        impacts = Value::Count(*impacts),
        drops = Value::Count(*drops),
        high = Value::Number(*highest_m, 3),
        low = Value::Number(*lowest_m, 3);
    Self::HeightsRise { rise, all } => rise = Value::Count(*rise), all = Value::Count(*all);
    Self::ReboundAboveDrop { row, from_m, to_m } =>
        row = Value::Count(*row),
        from = Value::Number(*from_m, 3),
        to = Value::Number(*to_m, 3);
    Self::HeightBelowPlate { row } => row = Value::Count(*row);
    Self::EitherLine { first, second } =>
        first = Value::Name(first),
        second = Value::Name(second);
    Self::GrowingIntervals { intervals, longer, row } =>
        longer = Value::Count(*longer),
        intervals = Value::Count(*intervals),
        row = Value::Count(*row);
    Self::FrozenPictures { channel, count, samples, first, interpolated } =>
        channel = Value::Name(channel),
        count = Value::Count(*count),
        samples = Value::Count(*samples),
        first = Value::Count(*first),
        interpolated = Value::Count(*interpolated);
    Self::SlowerSensor { channel, samples } =>
        channel = Value::Name(channel),
        samples = Value::Number(*samples, 0);
    Self::HeldLeftOut { channel, count, samples, first } =>
        channel = Value::Name(channel),
        count = Value::Count(*count),
        samples = Value::Count(*samples),
        first = Value::Count(*first);
    Self::ReadingsGoOn { channel, range, count, first } =>
        channel = Value::Name(channel),
        range = Value::Number(*range, if range.fract() == 0.0 { 0 } else { 4 }),
        count = Value::Count(*count),
        first = Value::Count(*first);
    Self::SwingsListed { count } => count = Value::Count(*count);
    Self::MotionGrows { times } => times = Value::Number(*times, 1);
    Self::EchoesLeftOut { count, impacts, delay_ms } =>
        count = Value::Count(*count),
        impacts = Value::Count(*impacts),
        delay = Value::Number(*delay_ms, 0);
    Self::LoneSpikes { channel, count, first } =>
        channel = Value::Name(channel),
        count = Value::Count(*count),
        first = Value::Count(*first);
    Self::HeldSamples { samples, first } =>
        samples = Value::Count(*samples),
        first = Value::Count(*first);
    Self::LostSamples { count, after_s } =>
        count = Value::Shortest(*count),
        after = Value::Shortest(*after_s);
    Self::RepeatedStamps { count } => count = Value::Count(*count);
    Self::TimeFalls { sample, before_s, after_s } =>
        sample = Value::Count(*sample),
        before = Value::Shortest(*before_s),
        after = Value::Shortest(*after_s);
    Self::TimeTurns { sample, bits, unit } =>
        sample = Value::Count(*sample),
        bits = Value::Count(*bits),
        unit = Value::Name(unit);
    Self::ImpactsNotInOrder { impact } => impact = Value::Count(*impact);
    Self::UnevenStamps { unit_s } => unit = power(*unit_s);
    Self::ScatteredSteps { spread_s, mean_s } =>
        spread = power(*spread_s),
        mean = power(*mean_s);
    Self::PutOnEvenTimes { lost, spread_s, step_s } =>
        lost = Value::Count(*lost),
        spread = power(*spread_s),
        step = power(*step_s);
    Self::StrayingTimes { stray_s, step_s } =>
        stray = power(*stray_s),
        step = power(*step_s);
    Self::RowsAreChanges { channel, .. } => channel = Value::Name(channel);
    Self::FewStamps { samples, stamps } =>
        samples = Value::Count(*samples),
        stamps = Value::Count(*stamps);
    Self::TimeUnitContradicts { axis, own_s, stated_s } =>
        axis = Value::Name(axis),
        own = Value::Shortest(*own_s),
        stated = Value::Shortest(*stated_s);
    Self::TimeWithoutUnit { axis, first, step } =>
        axis = Value::Name(axis),
        first = Value::Shortest(*first),
        step = Value::Shortest(*step);
    Self::TimeInOtherUnit { axis, unit } =>
        axis = Value::Name(axis),
        unit = Value::Name(unit);
    Self::TimeTakenSince1970 { axis, unit } =>
        axis = Value::Name(axis),
        unit = Value::Name(unit);
    Self::TimeTakenAsSeconds { axis } => axis = Value::Name(axis);
    Self::TimeTurnedAround { axis } => axis = Value::Name(axis);
    Self::TimeTakenAsDays { axis } => axis = Value::Name(axis);
    Self::LaterChannel { channel, by_s } =>
        channel = Value::Name(channel),
        by = Value::Number(*by_s, 6);
    Self::StartNotStated { channel } => channel = Value::Name(channel);
    Self::TooLateChannel { channel, by_s } =>
        channel = Value::Name(channel),
        by = Value::Number(*by_s, 6);
    Self::RateBesideDecimation { rate_hz, decimation } =>
        rate = Value::Shortest(*rate_hz),
        decimation = Value::Shortest(*decimation);
    Self::StepContradicts { stated_s, measured_s } =>
        stated = Value::Shortest(*stated_s),
        measured = Value::Number(*measured_s, 6);
    Self::RatesOfTwoDiffer { channel, rate_hz, other, other_hz } =>
        channel = Value::Name(channel),
        rate = Value::Shortest(*rate_hz),
        other = Value::Name(other),
        other_rate = Value::Shortest(*other_hz);
    Self::RateUnlikeOthers { channel, rate_hz, others_hz } =>
        channel = Value::Name(channel),
        rate = Value::Shortest(*rate_hz),
        others = Value::Shortest(*others_hz);
    Self::FollowsOtherMass { crossed, own } =>
        crossed = Value::Number(*crossed, 2),
        own = Value::Number(*own, 2);
    Self::OppositeChannels { quantity, rate } =>
        quantity = in_campaign(*quantity),
        rate = in_campaign(*rate);
    Self::OppositeUnlikeChannels { quantity, rate, factor } =>
        quantity = in_campaign(*quantity),
        rate = in_campaign(*rate),
        factor = Value::Number(*factor, 3);
    Self::MassesDoNotMeet { alone, together } =>
        alone = Value::Count(*alone),
        together = Value::Count(*together);
    Self::PathsDiffer { quantity, rate, ratio } =>
        quantity = in_campaign(*quantity),
        rate = in_campaign(*rate),
        ratio = Value::Number(*ratio, 4);
    Self::PathsDifferByUnits { quantity, rate, ratio, units } =>
        quantity = in_campaign(*quantity),
        rate = in_campaign(*rate),
        ratio = Value::Number(*ratio, 4),
        units = Value::Message(units);
    Self::SpeedsDiffer { quantity, rate, ratio } =>
        quantity = in_campaign(*quantity),
        rate = in_campaign(*rate),
        ratio = Value::Number(*ratio, 4);
    Self::SpeedsDifferByUnits { quantity, rate, ratio, units } =>
        quantity = in_campaign(*quantity),
        rate = in_campaign(*rate),
        ratio = Value::Number(*ratio, 4),
        units = Value::Message(units);
    Self::FrequencyUnlikeStated { measured_hz, stated_hz }
    | Self::RowOfAnother { measured_hz, stated_hz } =>
        measured = Value::Number(*measured_hz, 4),
        stated = Value::Number(*stated_hz, 4);
    Self::AmplitudeUnlikeStated { measured, stated } =>
        measured = Value::Number(*measured, 2),
        stated = Value::Number(*stated, 2);
    Self::FrequencyInOtherUnits { measured_hz, stated_hz, units } =>
        measured = Value::Number(*measured_hz, 4),
        stated = Value::Number(*stated_hz, 4),
        units = Value::Message(units);
    Self::PathBeyondStop { reached_m, clearance_m } =>
        reached = mm(*reached_m),
        clearance = mm(*clearance_m);
    Self::PathBeyondMass { reached_m, clearance_m } =>
        reached = mm(*reached_m),
        clearance = mm(*clearance_m);
    Self::UpwardJumps { up, down } =>
        up = Value::Count(*up),
        down = Value::Count(*down);
    Self::ApproachInPart { time_s, cut_s } =>
        time = Value::Number(*time_s, 3),
        cut = Value::Number(*cut_s, 3);
    Self::NoFlightBefore { count, time_s } =>
        count = Value::Count(*count),
        time = Value::Number(*time_s, 3);
    Self::NoFlightAfter { count, time_s } =>
        count = Value::Count(*count),
        time = Value::Number(*time_s, 3);
    Self::SpeedBeyondMeasured { count, time_s } =>
        count = Value::Count(*count),
        time = Value::Number(*time_s, 3);
    Self::FewTimes { impacts, needed } =>
        impacts = Value::Count(*impacts),
        needed = Value::Count(*needed);
    Self::FewSounds { impacts, needed } =>
        impacts = Value::Count(*impacts),
        needed = Value::Count(*needed);
    Self::PulsesWithoutJump { pulses, impacts } =>
        pulses = Value::Count(*pulses),
        impacts = Value::Count(*impacts);
    Self::ContactsWithoutJump { without, with } =>
        without = Value::Count(*without),
        with = Value::Count(*with);
    Self::ThresholdWithinNoise { threshold, rest, noise, dimension } =>
        threshold = at_level(*threshold),
        rest = at_level(*rest),
        noise = at_level(*noise),
        unit = symbol(*dimension);
    Self::ContactOpens { share } => share = Value::Percent(*share, 1);
}

message_table! { "remedy": Remedy, key = remedy_key;
    Self(Problem::FaultInFile { remedy, .. }) => remedy = Value::Name(remedy);
    Self(Problem::FaultInChannel { remedy, .. }) => remedy = Value::Name(remedy);
    Self(Problem::NoSuchChannel { role, .. }) => role = in_campaign(*role);
    Self(Problem::UnitContradicts { role, stated, .. }) =>
        role = in_campaign(*role),
        stated = Value::Name(stated);
    Self(Problem::UnitContradictsOther { role, stated, .. }) =>
        role = in_campaign(*role),
        stated = Value::Name(stated);
    Self(Problem::UnfitScale { role, .. }) => role = in_campaign(*role);
    Self(Problem::WrongQuantity { role, .. }) => role = in_campaign(*role);
    Self(Problem::VoltageOfMotion { role, unit, .. }) =>
        role = in_campaign(*role),
        unit = Value::Name(unit);
    Self(Problem::TurningMotion { role, scale, .. }) =>
        role = in_campaign(*role),
        scale = Value::Name(scale);
    Self(Problem::UnknownUnit { role, .. }) => role = in_campaign(*role);
    Self(Problem::NoUnit { role, .. }) => role = in_campaign(*role);
    Self(Problem::RateBesideDecimation { rate_hz, decimation }) =>
        rate = Value::Shortest(*rate_hz),
        divided = Value::Shortest(rate_hz / decimation);
    Self(Problem::RowsAreChanges { axis, .. }) => axis = Value::Name(axis);
    Self(Problem::OppositeChannels { quantity, rate }) =>
        quantity = in_campaign(*quantity),
        rate = in_campaign(*rate);
    Self(Problem::OppositeUnlikeChannels { quantity, rate, .. }) =>
        quantity = in_campaign(*quantity),
        rate = in_campaign(*rate);
    Self(Problem::PathsDiffer { quantity, rate, .. }) =>
        quantity = in_campaign(*quantity),
        rate = in_campaign(*rate);
    Self(Problem::PathsDifferByUnits { quantity, rate, .. }) =>
        quantity = in_campaign(*quantity),
        rate = in_campaign(*rate);
    Self(Problem::SpeedsDiffer { quantity, rate, .. }) =>
        quantity = in_campaign(*quantity),
        rate = in_campaign(*rate);
    Self(Problem::SpeedsDifferByUnits { quantity, rate, .. }) =>
        quantity = in_campaign(*quantity),
        rate = in_campaign(*rate);
}

#[cfg(test)]
mod tests {
    use strum::IntoEnumIterator;

    use super::super::parts::parts;
    use super::*;
    use crate::message::{boxed, faults, plain, typed};
    use crate::record::Sweep;

    #[test]
    fn every_problem_and_remedy_has_its_texts() {
        let all = boxed(Problem::iter())
            .chain(boxed(Problem::iter().map(Remedy)))
            .chain(parts())
            .chain(boxed(Sweep::iter()));
        let all: Vec<_> = all.collect();
        assert!(all.len() > 170);
        assert_eq!(faults(&all), Vec::<String>::new());
    }

    #[test]
    fn levels_have_their_unit_and_numbers_are_typed_with_a_hyphen() {
        let clipped = Problem::ClippedSamples {
            channel: "vx".into(),
            count: 12,
            share: 0.0123,
            low: -5.000_01,
            high: 0.000_125,
            dimension: Dimension::Acceleration,
        };
        let text = "channel 'vx' is clipped: 12 samples (1.2 %) at -5 m/s² or 0.000125 m/s²";
        assert_eq!(typed(&clipped), text);
        assert_eq!(plain(&clipped), text.replace('-', "\u{2212}"));
        let uneven = Problem::UnevenStamps { unit_s: 1.0e-4 };
        assert!(typed(&uneven).contains("stamps of 1.000e-4 s"));
    }
}
