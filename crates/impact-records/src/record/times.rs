//! When the samples of a record were taken: by a time axis, by a rate, or by a clock of each channel.

use super::alignment::{self, Timing};
use super::bind::{BoundRole, RecordSetup};
use super::{Channel, Flag, FlagCode, Problem, Record, Role};
use super::{changes, condition, even, time_axis};
use crate::signal::columns::extremes;
use labfiles::timing::AxisUnit;
use labfiles::units::symbol_of;
use labfiles::{Clock, DatasetInfo, Samples, StoredType};

/// The clocks of a record's channels, from metadata alone.
#[derive(Debug, Default)]
pub(super) struct Clocks {
    /// Time axes that must be read: indices in the dataset.
    pub(super) axes: Vec<usize>,
    /// Whether the channels must be aligned: they have several axes or rates, or begin at unlike times.
    apart: bool,
}

/// The time axis of a channel; `None`: its rate.
fn axis_of(
    setup: &RecordSetup<'_>,
    dataset: &DatasetInfo,
    channel: usize,
    shared: Option<usize>,
) -> Option<usize> {
    match dataset.channels[channel].clock {
        // what campaign.toml names is the time of all
        _ if setup.times.time.is_some() => shared,
        Clock::Shared => shared,
        Clock::Axis(axis) => Some(axis),
        Clock::Rate => None,
    }
}

/// The axis that all channels share which have none of their own.
fn shared_axis(setup: &RecordSetup<'_>, dataset: &DatasetInfo) -> Result<Option<usize>, Flag> {
    let found = time_axis::find(setup.times.time.as_ref(), dataset)?;
    Ok(found.or_else(|| frames(setup, dataset)))
}

/// A column that counts a camera's frames, if the rate of the frames is stated: it shows lost ones.
fn frames(setup: &RecordSetup<'_>, dataset: &DatasetInfo) -> Option<usize> {
    setup.times.sample_rate_hz?;
    (0..dataset.channels.len()).find(|i| time_axis::counts_frames(dataset, *i))
}

impl Clocks {
    /// Of the channels that roles are bound to.
    pub(super) fn of(
        setup: &RecordSetup<'_>,
        dataset: &DatasetInfo,
        bound: &[BoundRole<'_>],
        flags: &mut Vec<Flag>,
    ) -> Self {
        let shared = shared_axis(setup, dataset).unwrap_or_else(|flag| {
            flags.push(flag);
            None
        });
        let each = bound
            .iter()
            .map(|(_, b)| axis_of(setup, dataset, b.index, shared));
        let each: Vec<Option<usize>> = each.collect();
        let mut axes: Vec<usize> = each.iter().copied().flatten().collect();
        if bound.is_empty() {
            // what is wrong with the times is told even where no channel can be used
            axes.extend(shared);
        }
        axes.sort_unstable();
        axes.dedup();
        let mixed = axes.len() > 1 || (!axes.is_empty() && each.contains(&None));
        let stated = bound.iter().map(|(_, b)| dataset.channels[b.index].start_s);
        let (first_s, last_s) = extremes(&alignment::starts_s(stated));
        let unlike = last_s - first_s > 1e-9;
        Self {
            axes,
            apart: mixed || unlike,
        }
    }

    /// Give the record its sample rate: `kept` are the indices of its channels in the dataset, `axes` the samples
    /// of the time axes.
    pub(super) fn settle(
        &self,
        record: &mut Record,
        setup: &RecordSetup<'_>,
        dataset: &DatasetInfo,
        kept: &[usize],
        axes: Vec<Samples>,
    ) {
        let read = self.axes.iter().zip(axes);
        let mut times: Vec<Option<Vec<f64>>> = read
            .map(|(axis, samples)| seconds(samples, setup, dataset, *axis, &mut record.flags))
            .collect();
        if self.apart {
            self.align(record, setup, dataset, kept, &times);
            condition::cut_to_shortest(record);
            condition::skip(record, None, setup.skip_s);
            return;
        }
        let mut times = times.first_mut().and_then(Option::take);
        condition::equal_lengths(record, times.as_mut());
        if let (Some(times), Some(&axis)) = (&mut times, self.axes.first()) {
            turn(record, times, &dataset.channels[axis].name);
        }
        condition::trim_missing(record, times.as_mut());
        if times.is_some() {
            condition::skip(record, times.as_mut(), setup.skip_s);
        }
        if let Some(times) = times.as_mut().filter(|_| !setup.driven) {
            let note = even::resample(record, times);
            record.flags.extend(note);
        }
        settle_rate(record, setup, dataset, kept, times.as_deref());
        if times.is_none() {
            condition::skip(record, None, setup.skip_s);
        }
        if let (Some(times), Some(&axis)) = (times, self.axes.first()) {
            advise_times(record, &times, &dataset.channels[axis].name);
        }
    }

    /// Put channels with clocks of their own on one axis.
    fn align(
        &self,
        record: &mut Record,
        setup: &RecordSetup<'_>,
        dataset: &DatasetInfo,
        kept: &[usize],
        times: &[Option<Vec<f64>>],
    ) {
        let shared = shared_axis(setup, dataset).unwrap_or(None);
        let mut timings = Vec::with_capacity(kept.len());
        for (i, &index) in kept.iter().enumerate() {
            let values = &mut record.channels[i].values;
            let (first, last) = condition::filled(values);
            values.truncate(last);
            values.drain(..first);
            let info = &dataset.channels[index];
            let axis = axis_of(setup, dataset, index, shared);
            let axis = axis.and_then(|axis| self.axes.iter().position(|a| *a == axis));
            let own = axis.and_then(|axis| times[axis].as_deref());
            let own = own.map(|t| &t[first.min(t.len())..last.min(t.len())]);
            let measured = own.and_then(|own| time_axis::inspect(own, &mut record.flags));
            let rate = measured
                .or(info.sample_rate_hz)
                .or(setup.times.sample_rate_hz);
            let Some(rate_hz) = rate.filter(|r| r.is_finite() && *r > 0.0) else {
                no_rate(record);
                return;
            };
            let start_s = match own.and_then(|own| own.first()) {
                Some(first_s) => Some(first_s + info.start_s.unwrap_or(0.0)),
                None => info.start_s.map(|s| s + first as f64 / rate_hz),
            };
            timings.push(Timing { rate_hz, start_s });
        }
        record.sample_rate_hz = alignment::align(record, &timings).unwrap_or(0.0);
    }
}

/// Turn a record around whose last sample is first: all its times fall.
fn turn(record: &mut Record, times: &mut [f64], axis: &str) {
    let falls = times.len() > 2 && times.windows(2).all(|w| w[1] < w[0]);
    let same = |c: &Channel| c.values.len() == times.len();
    if !falls || !record.channels.iter().all(same) {
        return;
    }
    times.reverse();
    for channel in &mut record.channels {
        channel.values.reverse();
    }
    let axis = axis.to_owned();
    let flag = Flag::new(Some(&axis.clone()), Problem::TimeTurnedAround { axis });
    record.flags.push(flag.excluding(false));
}

/// Say of a contact whose rows are its changes, not samples, what to write instead.
fn advise_times(record: &mut Record, times: &[f64], axis: &str) {
    let uneven = |f: &Flag| {
        use FlagCode::{DroppedSamples, RepeatedSamples, TimeNotUniform};
        matches!(f.code, TimeNotUniform | DroppedSamples | RepeatedSamples)
    };
    let contact = record.channel(Role::Contact);
    let changes = contact.filter(|c| changes::levels(times, &c.values).is_some());
    let Some(name) = changes.map(|c| c.name.clone()) else {
        return;
    };
    if !record.flags.iter().any(uneven) {
        return;
    }
    record.flags.retain(|f| !uneven(f));
    let problem = Problem::RowsAreChanges {
        channel: name.clone(),
        axis: axis.to_owned(),
    };
    record.flags.push(Flag::new(Some(&name), problem));
}

/// A time axis in s; `None` if it holds no real numbers, or in no unit that is known.
fn seconds(
    samples: Samples,
    setup: &RecordSetup<'_>,
    dataset: &DatasetInfo,
    axis: usize,
    flags: &mut Vec<Flag>,
) -> Option<Vec<f64>> {
    let Samples::Real(mut times) = samples else {
        return None;
    };
    let info = &dataset.channels[axis];
    let stated_hz = setup.times.sample_rate_hz.or(info.sample_rate_hz);
    let factor = match (
        time_axis::counts_frames(dataset, axis),
        setup.times.sample_rate_hz,
    ) {
        (true, Some(rate_hz)) => rate_hz.recip(),
        // points in time are read as s since the first
        _ if info.stored == StoredType::Time => 1.0,
        _ => {
            let unit = AxisUnit::of(info.unit.as_deref(), &info.name, &times);
            match unit_s(&unit, &info.name, setup.times.time_unit_s, flags) {
                Some(factor) => factor,
                // counts of samples at a rate that is stated
                None => match (stated_hz, time_axis::usual_step(&times)) {
                    (Some(rate_hz), Some(step)) => (rate_hz * step).recip(),
                    _ => {
                        let problem = axis_problem(&unit, &info.name);
                        flags.extend(problem.map(|p| Flag::new(Some(&info.name), p)));
                        return None;
                    }
                },
            }
        }
    };
    times.iter_mut().for_each(|t| *t *= factor);
    Some(times)
}

/// Seconds in the unit of a time axis; what is assumed, and what contradicts campaign.toml, is noted.
fn unit_s(
    unit: &AxisUnit,
    name: &str,
    stated_s: Option<f64>,
    flags: &mut Vec<Flag>,
) -> Option<f64> {
    let own_s = unit.seconds();
    match (unit, own_s, stated_s) {
        (AxisUnit::Stated(_), Some(own), Some(stated)) if (own / stated - 1.0).abs() > 1e-9 => {
            let problem = Problem::TimeUnitContradicts {
                axis: name.to_owned(),
                own_s: own,
                stated_s: stated,
            };
            flags.push(Flag::new(Some(name), problem));
            Some(own)
        }
        (AxisUnit::Stated(_), own, _) => own,
        (_, _, Some(stated)) => Some(stated),
        (_, own, None) => {
            let assumed = own.and_then(|_| axis_problem(unit, name));
            flags.extend(assumed.map(|p| Flag::new(Some(name), p).excluding(false)));
            own
        }
    }
}

/// What is assumed of the unit of a time axis, or why nothing is; `None` where it is stated.
fn axis_problem(unit: &AxisUnit, name: &str) -> Option<Problem> {
    let axis = name.to_owned();
    Some(match unit {
        AxisUnit::Stated(_) => return None,
        AxisUnit::Epoch(unit) => Problem::TimeTakenSince1970 {
            axis,
            unit: symbol_of(*unit).unwrap_or("s").to_owned(),
        },
        AxisUnit::Seconds => Problem::TimeTakenAsSeconds { axis },
        AxisUnit::Days => Problem::TimeTakenAsDays { axis },
        AxisUnit::Undetermined { first, step } => Problem::TimeWithoutUnit {
            axis,
            first: *first,
            step: *step,
        },
        AxisUnit::Other(unit) => Problem::TimeInOtherUnit {
            axis,
            unit: unit.clone(),
        },
    })
}

/// The sample rate: from the time axis, else as the file states, else as campaign.toml does.
fn settle_rate(
    record: &mut Record,
    setup: &RecordSetup<'_>,
    dataset: &DatasetInfo,
    kept: &[usize],
    times: Option<&[f64]>,
) {
    let measured = times.and_then(|times| time_axis::inspect(times, &mut record.flags));
    let stated = stated_rate(record, dataset, kept);
    let coarse = record.flags.iter().any(|f| f.code == FlagCode::TimeCoarse);
    let decimation = labfiles::attribute::decimation(&dataset.attributes);
    let left_out = decimation.filter(|_| measured.is_none());
    let rate = match coarse {
        // the file's rate is that of the same stamps
        true => setup.times.sample_rate_hz,
        // beside a decimation it may be that before it
        false if left_out.is_some() => setup.times.sample_rate_hz.or(stated),
        false => measured.or(stated).or(setup.times.sample_rate_hz),
    };
    if rate.is_some() {
        record.flags.retain(|f| f.code != FlagCode::TimeCoarse);
    }
    match rate.filter(|r| r.is_finite() && *r > 0.0) {
        Some(rate) => {
            record.sample_rate_hz = rate;
            record.flags.extend(contradicting_step(rate, dataset, kept));
            let taken = left_out.filter(|_| setup.times.sample_rate_hz.is_none());
            record.flags.extend(taken.map(|decimation| {
                let problem = Problem::RateBesideDecimation {
                    rate_hz: rate,
                    decimation,
                };
                Flag::new(None, problem).excluding(false)
            }));
        }
        None => no_rate(record),
    }
}

/// Note that no rate is known, unless it is noted why.
fn no_rate(record: &mut Record) {
    let why = [
        FlagCode::TimeUnitMissing,
        FlagCode::TimeUnreadable,
        FlagCode::TimeBackward,
        FlagCode::TimeCoarse,
    ];
    if record.flags.iter().any(|f| why.contains(&f.code)) {
        return;
    }
    record.flags.push(Flag::new(None, Problem::NoClock));
}

/// Relative difference of rates that rounding of a printed step does not explain.
const RATES_DIFFER: f64 = 5e-3;

/// A step that a file states beside a time axis of another step.
fn contradicting_step(rate_hz: f64, dataset: &DatasetInfo, kept: &[usize]) -> Option<Flag> {
    let stated = kept.iter().find_map(|&index| {
        let text = dataset.channels[index].properties.get("Delta_X")?;
        text.replace(',', ".").trim().parse::<f64>().ok()
    });
    let step_s = stated.filter(|s| s.is_finite() && *s > 0.0)?;
    if (step_s * rate_hz - 1.0).abs() < RATES_DIFFER {
        return None;
    }
    let problem = Problem::StepContradicts {
        stated_s: step_s,
        measured_s: 1.0 / rate_hz,
    };
    Some(Flag::new(None, problem).excluding(false))
}

/// The rate that the file states for the channels; a flag if they differ.
fn stated_rate(record: &mut Record, dataset: &DatasetInfo, kept: &[usize]) -> Option<f64> {
    let rates = kept.iter().filter_map(|&index| {
        let info = &dataset.channels[index];
        info.sample_rate_hz.map(|rate| (rate, &info.name))
    });
    let mut first: Option<f64> = None;
    for (rate, name) in rates {
        let known = *first.get_or_insert(rate);
        if (rate / known - 1.0).abs() > 1e-6 {
            let problem = Problem::RateUnlikeOthers {
                channel: name.clone(),
                rate_hz: rate,
                others_hz: known,
            };
            record.flags.push(Flag::new(Some(name), problem));
        }
    }
    first
}
