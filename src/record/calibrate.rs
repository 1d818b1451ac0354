//! From what a file holds to a [`Record`] in SI: each channel is found, its unit settled, its
//! numbers scaled; what is wrong with it becomes a [`Flag`] and the other records go on.

use super::bind::flag;
pub use super::bind::{Bound, ChannelKey, ChannelSetup, bind};
use super::time_axis;
use super::{Channel, ContactContent, Flag, FlagCode, Record, Role, Setting};
use super::{condition, consistency, events, late};
use crate::signal::whole;
use labfiles::{ChannelInfo, DatasetInfo, ReadError, Samples, Source};

/// Everything that turns one dataset into one record.
#[derive(Debug, Clone)]
pub struct RecordSetup<'a> {
    /// The record's name.
    pub id: &'a str,
    /// Index of the dataset in the source.
    pub dataset: usize,
    /// The channels by role.
    pub channels: &'a [ChannelSetup],
    /// The channel with the time, if the file's reader cannot find it.
    pub time: Option<&'a ChannelKey>,
    /// Samples per second, Hz, for files that do not state it.
    pub sample_rate_hz: Option<f64>,
    /// The setting as the laboratory states it.
    pub setting: &'a Setting,
    /// Whether a harmonic drive must be seen.
    pub driven: bool,
    /// Part to leave out at the start, s.
    pub skip_s: f64,
}

/// A record without channels, for a file that cannot be read.
pub fn unreadable(id: &str, setting: &Setting, error: &ReadError) -> Record {
    let mut record = empty(id, setting);
    record.flags.push(read_flag(error));
    record
}

/// A reader's error as a flag of the record; the caller names the file.
pub fn read_flag(error: &ReadError) -> Flag {
    let place = match &error.channel {
        Some(channel) => format!("channel '{channel}': "),
        None => String::new(),
    };
    let byte = error
        .byte
        .map(|b| format!(" (at byte {b})"))
        .unwrap_or_default();
    Flag::new(
        FlagCode::Unreadable,
        error.channel.as_deref(),
        format!("{place}{}; expected {}{byte}", error.found, error.expected),
        error.remedy.clone(),
    )
}

fn empty(id: &str, setting: &Setting) -> Record {
    Record {
        id: id.to_owned(),
        sample_rate_hz: 0.0,
        channels: Vec::new(),
        setting: setting.clone(),
        flags: Vec::new(),
    }
}

/// Read one dataset and calibrate it. Never fails: what is wrong becomes a flag of the record,
/// and a channel that cannot be used is left out.
///
/// ```
/// use impactid::record::calibrate::{ChannelKey, ChannelSetup, RecordSetup, calibrate};
/// use impactid::record::{Excitation, Role, Setting, Sweep};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("run.csv");
/// let rows: String = (0..200)
///     .map(|i| format!("{},{}\n", f64::from(i) / 2000.0, (0.1 * f64::from(i)).sin()))
///     .collect();
/// std::fs::write(&path, format!("time [s],v [mm/s]\n{rows}"))?;
/// let source = labfiles::open(&path)?;
/// let setting = Setting {
///     stated_frequency_hz: None,
///     clearance_m: None,
///     sweep: Sweep::Unknown,
///     drive_amplitude: 1.0,
///     sequence: 0,
///     specimen: None,
///     excitation: Excitation::Harmonic,
/// };
/// let channels = [ChannelSetup::plain(Role::VelocityX, ChannelKey::Name("v".into()))];
/// let record = calibrate(
///     source.as_ref(),
///     &RecordSetup {
///         id: "run",
///         dataset: 0,
///         channels: &channels,
///         time: None,
///         sample_rate_hz: None,
///         setting: &setting,
///         driven: false,
///         skip_s: 0.0,
///     },
/// );
/// assert!(record.flags.is_empty());
/// assert!((record.sample_rate_hz - 2000.0).abs() < 1e-6);
/// let velocity = record.values(Role::VelocityX).unwrap();
/// assert!((velocity[10] - 1e-3 * 1f64.sin()).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn calibrate(source: &dyn Source, setup: &RecordSetup<'_>) -> Record {
    let mut record = empty(setup.id, setup.setting);
    let Some(dataset) = source.datasets().get(setup.dataset) else {
        record.flags.push(no_dataset(source, setup.dataset));
        return record;
    };
    let bound = bind_all(setup, dataset, &mut record.flags);
    let axis = match time_axis::find(setup.time, dataset) {
        Ok(axis) => axis.or_else(|| frames(setup, dataset)),
        Err(flag) => {
            record.flags.push(flag);
            None
        }
    };
    let mut wanted: Vec<usize> = bound.iter().map(|(_, b)| b.index).collect();
    wanted.extend(axis);
    let mut samples = match source.read(setup.dataset, &wanted) {
        Ok(samples) => samples,
        Err(error) => {
            record.flags.push(read_flag(&error));
            return record;
        }
    };
    let times = axis.and_then(|index| seconds(samples.pop(), dataset, index));
    let counts_frames = axis.is_some_and(|i| time_axis::counts_frames(dataset, i));
    let mut times: Option<Vec<f64>> = match setup.sample_rate_hz.filter(|_| counts_frames) {
        Some(rate_hz) => times.map(|t| t.iter().map(|n| n / rate_hz).collect()),
        None => times,
    };
    let ranges = scale_all(&mut record, dataset, &bound, samples);
    let content = content(setup);
    if !content.is_list() {
        condition::equal_lengths(&mut record, times.as_mut());
        condition::trim_missing(&mut record, times.as_mut());
        settle_rate(&mut record, setup, dataset, &bound, times.as_deref());
    }
    if content != ContactContent::Signal {
        events::settle(&mut record, content);
        return record;
    }
    condition::inspect(&mut record, &ranges, setup.driven);
    if !record.excluded() {
        let flags = consistency::inspect(&record);
        record.flags.extend(flags);
    }
    late::align(&mut record, setup.channels);
    skip(&mut record, setup.skip_s);
    record
}

/// What the channel of the contact contains.
fn content(setup: &RecordSetup<'_>) -> ContactContent {
    let contact = setup.channels.iter().find(|c| c.role == Role::Contact);
    contact.map_or(ContactContent::Signal, |c| c.content)
}

/// A column that counts a camera's frames, if the rate of the frames is stated: it shows lost ones.
fn frames(setup: &RecordSetup<'_>, dataset: &DatasetInfo) -> Option<usize> {
    setup.sample_rate_hz?;
    (0..dataset.channels.len()).find(|i| time_axis::counts_frames(dataset, *i))
}

fn no_dataset(source: &dyn Source, index: usize) -> Flag {
    Flag::new(
        FlagCode::Unreadable,
        None,
        format!(
            "{} holds {} datasets, number {index} is asked for",
            source.path().display(),
            source.datasets().len()
        ),
        "the file has changed since it was listed: run again",
    )
}

/// The time axis in s; `None` if it holds no real numbers.
fn seconds(samples: Option<Samples>, dataset: &DatasetInfo, index: usize) -> Option<Vec<f64>> {
    let Some(Samples::Real(mut times)) = samples else {
        return None;
    };
    let factor = time_axis::seconds_per_unit(dataset, index);
    times.iter_mut().for_each(|t| *t *= factor);
    Some(times)
}

type BoundRole<'a> = (&'a ChannelSetup, Bound);

fn bind_all<'a>(
    setup: &RecordSetup<'a>,
    dataset: &DatasetInfo,
    flags: &mut Vec<Flag>,
) -> Vec<BoundRole<'a>> {
    let mut bound = Vec::with_capacity(setup.channels.len());
    for channel in setup.channels {
        match bind(channel, dataset) {
            Ok(found) => bound.push((channel, found)),
            Err(flag) => flags.push(flag),
        }
    }
    bound
}

/// Scale the samples into the record; gives the converter's range of each channel kept.
fn scale_all(
    record: &mut Record,
    dataset: &DatasetInfo,
    bound: &[BoundRole<'_>],
    samples: Vec<Samples>,
) -> Vec<Option<f64>> {
    let mut ranges = Vec::with_capacity(bound.len());
    for ((channel, found), samples) in bound.iter().zip(samples) {
        match scaled(samples, channel, found, &dataset.channels[found.index]) {
            Ok(channel) => {
                ranges.push(found.range_si);
                record.channels.push(channel);
            }
            Err(flag) => record.flags.push(flag),
        }
    }
    ranges
}

fn scaled(
    samples: Samples,
    setup: &ChannelSetup,
    bound: &Bound,
    info: &ChannelInfo,
) -> Result<Channel, Flag> {
    let Samples::Real(mut values) = samples else {
        return Err(flag(
            setup,
            &info.name,
            FlagCode::NotNumbers,
            format!("channel '{}' holds no real numbers", info.name),
            "name the channel with the measured signal",
        ));
    };
    for value in &mut values {
        *value = *value * bound.to_si.to_si - bound.offset_si;
    }
    Ok(Channel {
        role: setup.role,
        name: info.name.clone(),
        dimension: bound.to_si.dimension,
        values,
        high_pass_hz: setup.high_pass_hz,
        low_pass: setup.low_pass,
        threshold: setup.threshold.map(|t| t.si),
    })
}

/// The sample rate: from the time axis, else as the file states, else as campaign.toml does.
fn settle_rate(
    record: &mut Record,
    setup: &RecordSetup<'_>,
    dataset: &DatasetInfo,
    bound: &[BoundRole<'_>],
    times: Option<&[f64]>,
) {
    let sample_rate_hz = times.and_then(|times| time_axis::inspect(times, &mut record.flags));
    let stated = stated_rate(record, dataset, bound);
    let rate = sample_rate_hz.or(stated).or(setup.sample_rate_hz);
    match rate.filter(|r| r.is_finite() && *r > 0.0) {
        Some(rate) => {
            record.sample_rate_hz = rate;
            record
                .flags
                .extend(contradicting_step(rate, dataset, bound));
        }
        None => record.flags.push(Flag::new(
            FlagCode::NoSampleRate,
            None,
            "neither a time axis nor a sample rate states when the samples were taken",
            "write sample_rate = \"2 kHz\" or time = \"…\" in [records]",
        )),
    }
}

/// Relative difference of rates that rounding of a printed step does not explain.
const RATES_DIFFER: f64 = 5e-3;

/// A step that a file states beside a time axis of another step.
fn contradicting_step(
    rate_hz: f64,
    dataset: &DatasetInfo,
    bound: &[BoundRole<'_>],
) -> Option<Flag> {
    let stated = bound.iter().find_map(|(_, b)| {
        let text = dataset.channels[b.index].properties.get("Delta_X")?;
        text.replace(',', ".").trim().parse::<f64>().ok()
    });
    let step_s = stated.filter(|s| s.is_finite() && *s > 0.0)?;
    if (step_s * rate_hz - 1.0).abs() < RATES_DIFFER {
        return None;
    }
    let found = format!(
        "the header states a step of {step_s} s (Delta_X), the time channel has {:.6} s: the channel is \
         used",
        1.0 / rate_hz
    );
    let remedy = "check which of the two is right; without the time channel the step would be used";
    Some(Flag::new(FlagCode::RateContradicts, None, found, remedy).excluding(false))
}

/// The rate that the file states for the channels; a flag if they differ.
fn stated_rate(record: &mut Record, dataset: &DatasetInfo, bound: &[BoundRole<'_>]) -> Option<f64> {
    let rates = bound.iter().filter_map(|(_, b)| {
        let info = &dataset.channels[b.index];
        info.sample_rate_hz.map(|rate| (rate, &info.name))
    });
    let mut first: Option<f64> = None;
    for (rate, name) in rates {
        let known = *first.get_or_insert(rate);
        if (rate / known - 1.0).abs() > 1e-6 {
            record.flags.push(Flag::new(
                FlagCode::UnequalSampleRates,
                Some(name),
                format!("channel '{name}' has {rate} samples a second, others {known}"),
                "record all channels at one rate, or leave the channel out",
            ));
        }
    }
    first
}

/// Leave out the start of the record.
fn skip(record: &mut Record, skip_s: f64) {
    let count = whole::index((skip_s * record.sample_rate_hz).round());
    if count == 0 || record.samples() == 0 {
        return;
    }
    if count >= record.samples() {
        record.flags.push(all_skipped(record.duration_s(), skip_s));
    }
    for channel in &mut record.channels {
        channel.values.drain(..count.min(channel.values.len()));
    }
}

fn all_skipped(duration_s: f64, skip_s: f64) -> Flag {
    Flag::new(
        FlagCode::Empty,
        None,
        format!("the record lasts {duration_s} s, and {skip_s} s of it are skipped"),
        "lower skip in [analysis]",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table of two columns, as a Record whose time axis is the first.
    fn record(times_s: impl Iterator<Item = f64>) -> Record {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        let rows = times_s.enumerate();
        let rows: String = rows
            .map(|(i, t)| format!("{t},{}\n", [1.0, -2.0][i % 2]))
            .collect();
        std::fs::write(&path, format!("time [s],x\n{rows}")).unwrap();
        let source = labfiles::open(&path).unwrap();
        let channels = [ChannelSetup::plain(
            Role::Drive,
            ChannelKey::Name("x".into()),
        )];
        let setup = RecordSetup {
            id: "run",
            dataset: 0,
            channels: &channels,
            time: None,
            sample_rate_hz: None,
            setting: &Setting::default(),
            driven: false,
            skip_s: 0.0,
        };
        calibrate(source.as_ref(), &setup)
    }

    #[test]
    fn uneven_times_are_refused_by_name_and_equal_steps_give_the_rate() {
        let uneven = |record: &Record| {
            record
                .flags
                .iter()
                .any(|f| f.code == FlagCode::TimeNotUniform)
        };
        let even = record((0..200).map(|i| f64::from(i) / 4000.0));
        assert!((even.sample_rate_hz - 4000.0).abs() < 1e-6 && !uneven(&even));
        assert!(uneven(&record((0..200).map(|i| f64::from(i * i) / 4000.0))));
    }
}
