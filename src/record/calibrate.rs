//! From what a file holds to a [`Record`] in SI: each channel is found, its unit settled, its
//! numbers scaled; what is wrong with it becomes a [`Flag`] and the other records go on.

use serde::{Deserialize, Serialize};

use super::{condition, consistency};
use super::source::{ChannelInfo, DatasetInfo, ReadError, Samples, Source};
use super::time_axis::{self, TimeAxis};
use super::{Channel, Flag, Record, Role, Setting};
use crate::units::{self, Dimension, Quantity, Scale, Unit};

/// A channel of a file, by name or by index.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ChannelKey {
    /// By name; a name without its group serves where only one channel ends so.
    Name(String),
    /// By index in the dataset, from 0.
    Index(usize),
}

impl ChannelKey {
    /// The key in messages.
    pub fn text(&self) -> String {
        match self {
            Self::Name(name) => name.clone(),
            Self::Index(index) => format!("number {index}"),
        }
    }

    /// Index of the channel in a dataset; `None` where it has none such, or several.
    pub fn find(&self, dataset: &DatasetInfo) -> Option<usize> {
        match self {
            Self::Index(index) => (*index < dataset.channels.len()).then_some(*index),
            Self::Name(name) => find_name(name, dataset),
        }
    }
}

fn find_name(name: &str, dataset: &DatasetInfo) -> Option<usize> {
    let exact = dataset.channels.iter().position(|c| c.name == name);
    exact
        .or_else(|| only_one(dataset, |c| c.rsplit('/').next() == Some(name)))
        .or_else(|| {
            only_one(dataset, |c| {
                units::split_unit(c).0 == name && !name.is_empty()
            })
        })
}

fn only_one(dataset: &DatasetInfo, fits: impl Fn(&str) -> bool) -> Option<usize> {
    let mut all = dataset
        .channels
        .iter()
        .enumerate()
        .filter(|(_, c)| fits(&c.name));
    let first = all.next()?.0;
    all.next().is_none().then_some(first)
}

/// How the channel of one role is read: SI value = sign · (number · unit − offset) · scale.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChannelSetup {
    /// What it measures.
    pub role: Role,
    /// Which channel of the file.
    pub source: ChannelKey,
    /// Unit of the numbers in the file; `None`: as the file states.
    pub unit: Option<Unit>,
    /// What the numbers stand for.
    pub scale: Scale,
    /// Value at rest, SI of the file's unit; subtracted before the scale.
    pub offset: f64,
    /// 1 or −1.
    pub sign: f64,
    /// Corner of the first-order high-pass that the signal carries, Hz.
    pub high_pass_hz: Option<f64>,
    /// Level between open and closed contact, after the scale.
    pub threshold: Option<Quantity>,
    /// Greatest magnitude the converter gives, SI of the file's unit.
    pub range: Option<f64>,
    /// Believe `unit` where the file states another.
    pub ignore_file_unit: bool,
}

impl ChannelSetup {
    /// A channel read as it is, in the unit the file states.
    pub fn plain(role: Role, source: ChannelKey) -> Self {
        Self {
            role,
            source,
            unit: None,
            scale: Scale::Factor(1.0),
            offset: 0.0,
            sign: 1.0,
            high_pass_hz: None,
            threshold: None,
            range: None,
            ignore_file_unit: false,
        }
    }
}

/// Everything that turns one dataset into one record.
#[derive(Debug, Clone)]
pub struct RecordSetup<'a> {
    /// The record's name.
    pub id: &'a str,
    /// Index of the dataset in the source.
    pub dataset: usize,
    /// The channels by role.
    pub channels: &'a [ChannelSetup],
    /// The channel with the time, where the file's reader cannot tell.
    pub time: Option<&'a ChannelKey>,
    /// Samples per second, Hz, for files that do not tell.
    pub sample_rate_hz: Option<f64>,
    /// The setting as the laboratory states it.
    pub setting: &'a Setting,
    /// Whether a harmonic drive must be seen.
    pub driven: bool,
    /// Part to leave out at the start, s.
    pub skip_s: f64,
}

/// A channel of a role found in a dataset, with the conversion settled.
#[derive(Debug, Clone, PartialEq)]
pub struct Bound {
    /// Index in the dataset.
    pub index: usize,
    /// Factor and dimension of the calibrated values.
    pub to_si: Unit,
    /// Subtracted after the factor, SI.
    pub offset_si: f64,
    /// Greatest magnitude the converter gives, SI after the scale.
    pub range_si: Option<f64>,
}

/// Find a role's channel in a dataset and settle its conversion, from metadata alone.
///
/// # Errors
/// The [`Flag`] that says why the channel cannot be used.
pub fn bind(setup: &ChannelSetup, dataset: &DatasetInfo) -> Result<Bound, Flag> {
    let index = setup
        .source
        .find(dataset)
        .ok_or_else(|| missing(setup, dataset))?;
    let info = &dataset.channels[index];
    let unit = settle_unit(setup, info)?;
    let scaled = setup
        .scale
        .apply(unit)
        .ok_or_else(|| unfit_scale(setup, info, unit))?;
    check_dimension(setup, info, scaled.dimension)?;
    let after_scale = scaled.to_si / unit.to_si;
    Ok(Bound {
        index,
        to_si: Unit {
            to_si: scaled.to_si * setup.sign,
            ..scaled
        },
        offset_si: setup.offset * after_scale * setup.sign,
        range_si: setup.range.map(|r| (r * after_scale).abs()),
    })
}

fn flag(setup: &ChannelSetup, channel: &str, code: &str, message: String, remedy: &str) -> Flag {
    Flag {
        code: code.to_owned(),
        channel: Some(channel.to_owned()),
        message,
        remedy: remedy.to_owned(),
        excludes: !matches!(setup.role, Role::FrameX | Role::FrameY),
    }
}

fn missing(setup: &ChannelSetup, dataset: &DatasetInfo) -> Flag {
    let names: Vec<&str> = dataset.channels.iter().map(|c| c.name.as_str()).collect();
    let shown = names
        .iter()
        .take(16)
        .copied()
        .collect::<Vec<_>>()
        .join(", ");
    let key = setup.source.text();
    let role = setup.role.name();
    flag(
        setup,
        &key,
        "missing_channel",
        format!("no channel '{key}' for the role {role}; the channels are: {shown}"),
        &format!("name one of them in [channels.{role}], or leave the record out"),
    )
}

/// The unit of the numbers in the file: as stated there, or as the set-up says.
fn settle_unit(setup: &ChannelSetup, info: &ChannelInfo) -> Result<Unit, Flag> {
    let stated = info.unit.as_deref().filter(|u| !u.trim().is_empty());
    let known = stated.and_then(units::parse_unit);
    match (setup.unit, known) {
        (Some(ours), Some(theirs)) if !same(ours, theirs) && !setup.ignore_file_unit => {
            Err(contradicts(setup, info, ours))
        }
        (Some(ours), _) => Ok(ours),
        (None, Some(theirs)) => Ok(theirs),
        (None, None) => Err(without_unit(setup, info, stated)),
    }
}

fn same(a: Unit, b: Unit) -> bool {
    a.dimension == b.dimension && (a.to_si / b.to_si - 1.0).abs() < 1e-9
}

fn contradicts(setup: &ChannelSetup, info: &ChannelInfo, ours: Unit) -> Flag {
    let stated = info.unit.as_deref().unwrap_or_default().trim();
    let ours = units::symbol_of(ours).unwrap_or("another unit");
    flag(
        setup,
        &info.name,
        "wrong_unit",
        format!(
            "the file states the unit '{stated}' for channel '{}', campaign.toml '{ours}'",
            info.name
        ),
        &format!(
            "set unit = \"{stated}\" in [channels.{}], or ignore_file_unit = true where the \
             file is wrong",
            setup.role.name()
        ),
    )
}

fn without_unit(setup: &ChannelSetup, info: &ChannelInfo, stated: Option<&str>) -> Flag {
    let found = match stated {
        Some(symbol) => format!("the file states a unit '{symbol}' that is not known"),
        None => "the file states no unit".to_owned(),
    };
    flag(
        setup,
        &info.name,
        "unit_missing",
        format!("{found} for channel '{}'", info.name),
        &format!("write unit = \"…\" in [channels.{}]", setup.role.name()),
    )
}

fn unfit_scale(setup: &ChannelSetup, info: &ChannelInfo, unit: Unit) -> Flag {
    let role = setup.role.name();
    flag(
        setup,
        &info.name,
        "wrong_unit",
        format!(
            "the scale of channel '{}' does not start from its unit, a {}",
            info.name,
            unit.dimension.name()
        ),
        &format!(
            "mend scale or unit in [channels.{role}]: scale = \"50 mm/s per V\", unit = \"V\""
        ),
    )
}

fn check_dimension(setup: &ChannelSetup, info: &ChannelInfo, found: Dimension) -> Result<(), Flag> {
    let role = setup.role;
    let wrong = |expected: &str| {
        let what = format!(
            "channel '{}' of the role {} comes out as a {}, not as {expected}",
            info.name,
            role.name(),
            found.name()
        );
        let remedy = format!("mend unit and scale in [channels.{}]", role.name());
        Err(flag(setup, &info.name, "wrong_unit", what, &remedy))
    };
    match role.dimension() {
        Some(expected) if found != expected => return wrong(&format!("a {}", expected.name())),
        None if !serves(role, found) => return wrong("a quantity that serves there"),
        _ => {}
    }
    match setup.threshold {
        Some(level) if level.dimension != found => wrong(&format!(
            "a {} as its threshold does",
            level.dimension.name()
        )),
        _ => Ok(()),
    }
}

/// Which dimensions serve for the roles that take several.
fn serves(role: Role, found: Dimension) -> bool {
    use Dimension::{Acceleration, Force, Length, Number, Velocity, Voltage};
    match role {
        Role::Drive => matches!(found, Voltage | Force | Length | Acceleration | Number),
        Role::Contact => matches!(found, Voltage | Force | Number),
        Role::FrameX | Role::FrameY => matches!(found, Length | Velocity | Acceleration),
        _ => true,
    }
}

/// A record without channels, for a file that cannot be read.
pub fn unreadable(id: &str, setting: &Setting, error: &ReadError) -> Record {
    let mut record = empty(id, setting);
    record.flags.push(read_flag(error));
    record
}

fn read_flag(error: &ReadError) -> Flag {
    Flag {
        code: "unreadable".to_owned(),
        channel: error.channel.clone(),
        message: error.to_string(),
        remedy: error.remedy.clone(),
        excludes: true,
    }
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
pub fn calibrate(source: &dyn Source, setup: &RecordSetup<'_>) -> Record {
    let mut record = empty(setup.id, setup.setting);
    let Some(dataset) = source.datasets().get(setup.dataset) else {
        record.flags.push(no_dataset(source, setup.dataset));
        return record;
    };
    let bound = bind_all(setup, dataset, &mut record.flags);
    let axis = match time_axis::find(setup.time, dataset) {
        Ok(axis) => axis,
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
    fill(&mut record, setup, dataset, &bound, samples, times);
    record
}

fn no_dataset(source: &dyn Source, index: usize) -> Flag {
    Flag {
        code: "unreadable".to_owned(),
        channel: None,
        message: format!(
            "{} holds {} datasets, number {index} is asked for",
            source.path().display(),
            source.datasets().len()
        ),
        remedy: "the file has changed since it was listed: run again".to_owned(),
        excludes: true,
    }
}

/// The time axis in s; `None` where it holds no real numbers.
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

/// Scale the samples into the record, settle the time, and look for what is wrong.
fn fill(
    record: &mut Record,
    setup: &RecordSetup<'_>,
    dataset: &DatasetInfo,
    bound: &[BoundRole<'_>],
    samples: Vec<Samples>,
    mut times: Option<Vec<f64>>,
) {
    let mut samples = samples.into_iter();
    let mut ranges = Vec::with_capacity(bound.len());
    for (channel, found) in bound {
        let info = &dataset.channels[found.index];
        match samples.next().map(|s| scaled(s, channel, found, info)) {
            Some(Ok(channel)) => {
                ranges.push(found.range_si);
                record.channels.push(channel);
            }
            Some(Err(flag)) => record.flags.push(flag),
            None => {}
        }
    }
    condition::equal_lengths(record, times.as_mut());
    condition::trim_missing(record, times.as_mut());
    settle_rate(record, setup, dataset, bound, times.as_deref());
    condition::inspect(record, &ranges, setup.driven);
    if !record.excluded() {
        let flags = consistency::inspect(record);
        record.flags.extend(flags);
    }
    skip(record, setup.skip_s);
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
            "not_numbers",
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
    let TimeAxis {
        sample_rate_hz,
        flags,
    } = times.map(time_axis::inspect).unwrap_or_default();
    record.flags.extend(flags);
    let stated = stated_rate(record, dataset, bound);
    let rate = sample_rate_hz.or(stated).or(setup.sample_rate_hz);
    match rate.filter(|r| r.is_finite() && *r > 0.0) {
        Some(rate) => record.sample_rate_hz = rate,
        None => record.flags.push(Flag {
            code: "no_sample_rate".to_owned(),
            channel: None,
            message: "neither a time axis nor a sample rate tells when the samples were taken"
                .to_owned(),
            remedy: "write sample_rate = \"2 kHz\" or time = \"…\" in [records]".to_owned(),
            excludes: true,
        }),
    }
}

/// The rate that the file states for the channels; a flag where they differ.
fn stated_rate(record: &mut Record, dataset: &DatasetInfo, bound: &[BoundRole<'_>]) -> Option<f64> {
    let rates = bound.iter().filter_map(|(_, b)| {
        let info = &dataset.channels[b.index];
        info.sample_rate_hz.map(|rate| (rate, &info.name))
    });
    let mut first: Option<f64> = None;
    for (rate, name) in rates {
        let known = *first.get_or_insert(rate);
        if (rate / known - 1.0).abs() > 1e-6 {
            record.flags.push(Flag {
                code: "unequal_sample_rates".to_owned(),
                channel: Some(name.clone()),
                message: format!("channel '{name}' has {rate} samples a second, others {known}"),
                remedy: "record all channels at one rate, or leave the channel out".to_owned(),
                excludes: true,
            });
        }
    }
    first
}

/// Leave out the start of the record.
fn skip(record: &mut Record, skip_s: f64) {
    let count = (skip_s * record.sample_rate_hz).round() as usize;
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
    Flag {
        code: "empty".to_owned(),
        channel: None,
        message: format!("the record lasts {duration_s} s, and {skip_s} s of it are skipped"),
        remedy: "lower skip in [analysis]".to_owned(),
        excludes: true,
    }
}
