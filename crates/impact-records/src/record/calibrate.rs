//! From what a file holds to a [`Record`] in SI: each channel is found, its unit settled, its
//! numbers scaled; what is wrong with it becomes a [`Flag`] and the other records go on.

use super::bind::BoundRole;
use super::bind::flag;
pub use super::bind::{BoundChannel, ChannelKey, ChannelSetup, RecordSetup, StatedTimes, bind};
use super::times::Clocks;
use super::{Channel, ContactContent, Flag, FlagCode, ListedTimes, Problem, Record, Role, Setting};
use super::{changes, condition, consistency, contact_levels, events, heights, late, wrapped};
use labfiles::{ChannelInfo, DatasetInfo, ReadError, Samples, Source, units};

/// A record without channels, for a file that cannot be read.
pub fn unreadable(id: &str, setting: &Setting, error: &ReadError) -> Record {
    let mut record = empty(id, setting);
    record.flags.push(read_flag(error));
    record
}

/// A reader's error as a flag of the record; the caller names the file.
pub fn read_flag(error: &ReadError) -> Flag {
    let (found, remedy) = (error.what(), error.remedy.clone());
    let problem = match error.channel.clone() {
        Some(channel) => Problem::FaultInChannel {
            channel,
            found,
            remedy,
        },
        None => Problem::FaultInFile { found, remedy },
    };
    Flag::new(error.channel.as_deref(), problem)
}

fn empty(id: &str, setting: &Setting) -> Record {
    Record {
        id: id.to_owned(),
        sample_rate_hz: 0.0,
        channels: Vec::new(),
        setting: setting.clone(),
        listed: Default::default(),
        flags: Vec::new(),
    }
}

/// Read one dataset and calibrate it. Never fails: what is wrong becomes a flag of the record,
/// and a channel that cannot be used is left out.
///
/// ```
/// use impact_records::record::calibrate::{ChannelKey, ChannelSetup, RecordSetup, StatedTimes, calibrate};
/// use impact_records::record::{Excitation, Role, Setting, Sweep};
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
///     ..Setting::default()
/// };
/// let channels = [ChannelSetup::plain(Role::VelocityX, ChannelKey::Name("v".into()))];
/// let record = calibrate(
///     source.as_ref(),
///     &RecordSetup {
///         id: "run",
///         dataset: 0,
///         channels: &channels,
///         times: &StatedTimes::default(),
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
    let content = content(setup);
    let clocks = if content.is_list() {
        Clocks::default()
    } else {
        Clocks::of(setup, dataset, &bound, &mut record.flags)
    };
    let mut wanted: Vec<usize> = bound.iter().map(|(_, b)| b.index).collect();
    wanted.extend(&clocks.axes);
    let mut samples = match source.read(setup.dataset, &wanted) {
        Ok(samples) => samples,
        Err(error) => {
            record.flags.push(read_flag(&error));
            return record;
        }
    };
    let axes = samples.split_off(bound.len());
    let (kept, ranges) = scale_all(&mut record, dataset, &bound, samples);
    if !content.is_list() {
        clocks.settle(&mut record, setup, dataset, &kept, axes);
    }
    if content.is_of_heights() {
        settle_heights(source, setup, dataset, &mut record);
        return record;
    }
    if content != ContactContent::Signal {
        let Some(beside) = columns_beside(source, setup, dataset, &mut record) else {
            return record;
        };
        let closed_s = match content {
            ContactContent::Times if beside.is_empty() => {
                keep_closings(source, setup, dataset, &mut record, &kept)
            }
            _ => 0.0,
        };
        events::settle(&mut record, content, closed_s, &beside);
        stated(&mut record.listed, dataset);
        return record;
    }
    if record.flags.iter().any(|f| f.code == FlagCode::Empty) {
        return record;
    }
    condition::inspect(&mut record, &ranges, setup.driven);
    if !record.excluded() {
        contact_levels::settle(&mut record);
        let flags = consistency::inspect(&record);
        record.flags.extend(flags);
    }
    late::align(&mut record, setup.channels);
    record
}

/// Attribute of a dataset that lists times: their standard error, s.
pub const TIMES_ERROR: &str = "times_error_s";
/// Attribute of a dataset that lists times: how long the contact is closed, s.
pub const TIMES_CONTACT: &str = "times_contact_s";

/// Attribute of a dataset of heights: the standard error of each by its last digit, m.
pub const HEIGHTS_DIGIT: &str = "heights_digit_m";
/// Attribute of a dataset of heights: the standard uncertainty of each as it is stated, m.
pub const HEIGHTS_ERROR: &str = "heights_error_m";

/// Read the columns of heights that follow in the same row, and settle the drops.
fn settle_heights(
    source: &dyn Source,
    setup: &RecordSetup<'_>,
    dataset: &DatasetInfo,
    record: &mut Record,
) {
    let Some(contact) = setup.channels.iter().find(|c| c.role == Role::Contact) else {
        return;
    };
    record.channels.retain(|c| c.role == Role::Contact);
    let first = record.channels.first().map(|c| c.values.clone());
    let (Some(first), Ok(bound)) = (first, bind(contact, dataset)) else {
        return;
    };
    let Some(beside) = columns_beside(source, setup, dataset, record) else {
        return;
    };
    let unit_m = bound.to_si.to_si.abs();
    let all = beside.iter().flatten().chain(&first);
    let raw: Vec<f64> = all.map(|h| (h + bound.offset_si) / unit_m).collect();
    let number = |key: &str| dataset.attributes.get(key)?.parse().ok();
    let known = ListedTimes {
        digit_m: number(HEIGHTS_DIGIT).unwrap_or(0.0),
        height_m: number(HEIGHTS_ERROR)
            .or(contact.height_uncertainty_m)
            .unwrap_or(0.0),
        ..ListedTimes::default()
    };
    let step_m = if known.digit_m > 0.0 {
        0.0
    } else {
        events::printed_step(&raw) * unit_m
    };
    heights::settle(record, contact.content, &beside, (step_m, known));
}

/// The columns that follow that of the contact in the same row; `None`, with a flag, where one cannot be read.
fn columns_beside(
    source: &dyn Source,
    setup: &RecordSetup<'_>,
    dataset: &DatasetInfo,
    record: &mut Record,
) -> Option<Vec<Vec<f64>>> {
    let contact = setup.channels.iter().find(|c| c.role == Role::Contact);
    let then = contact
        .into_iter()
        .flat_map(|c| c.then.iter().map(move |key| (c, key)));
    let read: Result<Vec<Vec<f64>>, Flag> = then
        .map(|(contact, key)| column(source, setup.dataset, dataset, contact, key))
        .collect();
    read.map_err(|flag| record.flags.push(flag)).ok()
}

/// The values of a further column, SI, calibrated as the first, whose unit it has where it states none.
fn column(
    source: &dyn Source,
    index: usize,
    dataset: &DatasetInfo,
    contact: &ChannelSetup,
    key: &ChannelKey,
) -> Result<Vec<f64>, Flag> {
    let stated = |key: &ChannelKey| dataset.channels[key.find(dataset)?].unit.as_deref();
    let of_first = || units::parse_unit(stated(&contact.source)?);
    let unit = contact
        .unit
        .or_else(|| of_first().filter(|_| stated(key).is_none()));
    let own = ChannelSetup {
        source: key.clone(),
        unit,
        ..contact.clone()
    };
    let bound = bind(&own, dataset)?;
    let samples = source.read(index, &[bound.index]);
    let samples = samples.map_err(|error| read_flag(&error))?.remove(0);
    Ok(scaled(samples, &own, &bound, &dataset.channels[bound.index])?.values)
}

/// Take what a dataset of calibrated times states of them.
fn stated(listed: &mut ListedTimes, dataset: &DatasetInfo) {
    let number = |key: &str| dataset.attributes.get(key)?.parse().ok();
    if let Some(error_s) = number(TIMES_ERROR) {
        *listed = ListedTimes {
            error_s,
            contact_s: number(TIMES_CONTACT).unwrap_or(0.0),
            ..ListedTimes::default()
        };
    }
}

/// Keep of a list of changes the times at which the contact closes; how long it is closed, s, 0 where no column
/// tells it.
fn keep_closings(
    source: &dyn Source,
    setup: &RecordSetup<'_>,
    dataset: &DatasetInfo,
    record: &mut Record,
    kept: &[usize],
) -> f64 {
    let contact = record.channels.iter_mut().zip(kept);
    let mut contact = contact.filter(|(c, _)| c.role == Role::Contact);
    let Some((channel, &index)) = contact.next() else {
        return 0.0;
    };
    let states = |state: usize| {
        let read = source.read(setup.dataset, &[state]).ok()?.pop()?;
        let read = read.into_real()?;
        let levels = changes::line_levels(&channel.values, &read)?;
        Some((
            state,
            levels,
            changes::closings(&channel.values, &read, levels),
        ))
    };
    let mut lines: Vec<_> = changes::candidates(dataset, index)
        .filter_map(states)
        .collect();
    if let [(first, ..), (second, ..), ..] = lines[..] {
        let names = [first, second].map(|i| dataset.channels[i].name.as_str());
        record.flags.push(two_lines(names));
        return 0.0;
    }
    let Some((state, levels, closings)) = lines.pop() else {
        return 0.0;
    };
    channel.values = closings.times_s;
    let name = &dataset.channels[state].name;
    let problem = Problem::ChangesOfLine {
        channel: name.clone(),
        count: channel.values.len(),
        closed: levels.closed,
    };
    let flag = Flag::new(Some(name), problem);
    record.flags.push(flag.excluding(false));
    closings.closed_s
}

fn two_lines([first, second]: [&str; 2]) -> Flag {
    let problem = Problem::EitherLine {
        first: first.to_owned(),
        second: second.to_owned(),
    };
    Flag::new(Some(second), problem)
}

/// What the channel of the contact contains.
fn content(setup: &RecordSetup<'_>) -> ContactContent {
    let contact = setup.channels.iter().find(|c| c.role == Role::Contact);
    contact.map_or(ContactContent::Signal, |c| c.content)
}

fn no_dataset(source: &dyn Source, index: usize) -> Flag {
    let problem = Problem::FewerDatasets {
        path: source.path().display().to_string(),
        datasets: source.datasets().len(),
        index,
    };
    Flag::new(None, problem)
}

fn bind_all<'a>(
    setup: &RecordSetup<'a>,
    dataset: &DatasetInfo,
    flags: &mut Vec<Flag>,
) -> Vec<BoundRole<'a>> {
    let mut bound = Vec::with_capacity(setup.channels.len());
    for channel in setup.channels {
        match bind(channel, dataset) {
            Ok(found) if setup.setting.turned.contains(&channel.role) => {
                bound.push((channel, found.turned()));
            }
            Ok(found) => bound.push((channel, found)),
            Err(flag) => flags.push(flag),
        }
    }
    bound
}

/// Scale the samples into the record; gives for each channel kept its index in the dataset, and the
/// converter's range.
fn scale_all(
    record: &mut Record,
    dataset: &DatasetInfo,
    bound: &[BoundRole<'_>],
    samples: Vec<Samples>,
) -> (Vec<usize>, Vec<Option<f64>>) {
    let (mut kept, mut ranges) = (Vec::new(), Vec::new());
    let excitation = record.setting.excitation;
    for ((channel, found), mut samples) in bound.iter().zip(samples) {
        let info = &dataset.channels[found.index];
        if let Samples::Real(values) = &mut samples {
            let wraps = wrapped::go_on(values, &info.name, channel.role, excitation);
            record.flags.extend(wraps);
        }
        match scaled(samples, channel, found, info) {
            Ok(channel) => {
                kept.push(found.index);
                ranges.push(found.range_si);
                record.channels.push(channel);
            }
            Err(flag) => record.flags.push(flag),
        }
    }
    (kept, ranges)
}

fn scaled(
    samples: Samples,
    setup: &ChannelSetup,
    bound: &BoundChannel,
    info: &ChannelInfo,
) -> Result<Channel, Flag> {
    let Samples::Real(mut values) = samples else {
        let channel = info.name.clone();
        let problem = Problem::NoRealNumbers { channel };
        return Err(flag(setup, &info.name, problem));
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
        smoothing: None,
        threshold: setup.threshold.map(|t| t.si),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table of two columns, as a Record whose time axis is the first.
    fn record(times_s: impl Iterator<Item = f64>) -> Record {
        let rows = times_s.enumerate();
        let rows = rows.map(|(i, t)| format!("{t},{}\n", [1.0, -2.0][i % 2]));
        of_rows(&rows.collect::<String>(), 0.0)
    }

    #[test]
    fn a_record_whose_last_sample_is_first_is_read_from_its_end_and_a_clock_that_jumps_back_is_not()
    {
        let falls = record((0..100).rev().map(|i| f64::from(i) * 1e-3));
        assert!(!falls.excluded(), "{:?}", falls.flags);
        assert_eq!(
            falls.flags[0].message(),
            "the time 'time' falls from the first row to the last: the record is read from its end"
        );
        assert!((falls.sample_rate_hz - 1000.0).abs() < 1e-6);
        assert_eq!(falls.channels[0].values[..2], [-2.0, 1.0]);
        let jumps = record((0..100).map(|i| f64::from(i % 60) * 1e-3));
        let message = jumps.flags[0].message();
        assert!(
            message.starts_with("the time runs backward after sample 59"),
            "{message}"
        );
        assert!(jumps.excluded());
    }

    /// The record of rows of a time and a value, without its first seconds.
    fn of_rows(rows: &str, skip_s: f64) -> Record {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.csv");
        std::fs::write(&path, format!("time [s],x [V]\n{rows}")).unwrap();
        let source = labfiles::open(&path).unwrap();
        let channels = [ChannelSetup::plain(
            Role::Drive,
            ChannelKey::Name("x".into()),
        )];
        let setup = RecordSetup {
            id: "run",
            dataset: 0,
            channels: &channels,
            times: &StatedTimes::default(),
            setting: &Setting::default(),
            driven: false,
            skip_s,
        };
        calibrate(source.as_ref(), &setup)
    }

    /// Bounces of R = 0.8 as a logic analyser lists them: the contact is closed for 2 ms.
    fn list_of_changes() -> String {
        let mut text = String::from("Time [s],Channel 0\n0.000000000,0\n");
        let mut at = 0.5;
        for k in 0..12 {
            text += &format!("{at:.9},1\n{:.9},0\n", at + 2e-3);
            at += 0.5 * 0.8f64.powi(k);
        }
        text
    }

    fn of_list(text: &str, channel: &str, content: ContactContent) -> Record {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("digital.csv");
        std::fs::write(&path, text).unwrap();
        let source = labfiles::open(&path).unwrap();
        let contact = ChannelSetup {
            content,
            ignore_file_unit: true,
            unit: labfiles::units::parse_unit(if channel == "Time" { "s" } else { "V" }),
            ..ChannelSetup::plain(Role::Contact, ChannelKey::Name(channel.into()))
        };
        let setup = RecordSetup {
            id: "digital",
            dataset: 0,
            channels: &[contact],
            times: &StatedTimes::default(),
            setting: &Setting::default(),
            driven: false,
            skip_s: 0.0,
        };
        calibrate(source.as_ref(), &setup)
    }

    #[test]
    fn a_contact_whose_rows_are_its_changes_is_told_to_be_one_of_times() {
        let record = of_list(&list_of_changes(), "Channel 0", ContactContent::Signal);
        let flags: Vec<&Flag> = record.flags.iter().filter(|f| f.excludes).collect();
        assert_eq!(flags.len(), 1, "{flags:?}");
        assert_eq!(flags[0].code, FlagCode::TimeNotUniform);
        assert!(
            flags[0]
                .remedy()
                .contains("channel = \"Time\" and content = \"times\""),
            "{flags:?}"
        );
    }

    #[test]
    fn rows_of_two_lines_are_left_open() {
        let mut text = String::from("Time [s],A,B\n");
        for k in 0..12 {
            let at = 0.5 * f64::from(k);
            let row = |after: f64, a: u8, b: u8| format!("{:.6},{a},{b}\n", at + after);
            text += &[
                row(0.0, 1, 0),
                row(0.001, 0, 0),
                row(0.2, 0, 1),
                row(0.201, 0, 0),
            ]
            .concat();
        }
        let record = of_list(&text, "Time", ContactContent::Times);
        assert_eq!(record.flags[0].code, FlagCode::ContactUnclear);
        assert!(record.excluded());
    }

    #[test]
    fn of_a_list_of_changes_those_that_close_the_contact_are_impacts() {
        let record = of_list(&list_of_changes(), "Time", ContactContent::Times);
        let times = record.values(Role::Contact).unwrap();
        assert_eq!(times.len(), 12);
        let flights: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
        assert!(
            flights.windows(2).all(|w| (w[1] / w[0] - 0.8).abs() < 1e-6),
            "{flights:?}"
        );
        assert_eq!(
            record.flags[0].message(),
            "the rows are changes of 'Channel 0': the 12 at which it goes to 1 are the impacts"
        );
        // somewhere in a contact of 2 ms
        assert!((record.listed.error_s - 2e-3 / 12f64.sqrt()).abs() < 1e-8);
        assert!(!record.excluded());
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
    #[test]
    fn what_is_wrong_with_the_skipped_start_does_not_count() {
        // an amplifier that is overloaded, and rows that are lost
        let value = |i: usize| match i {
            20..90 => "inf".to_owned(),
            _ => format!("{}", [1.0, -2.0][i % 2]),
        };
        let rows = (0..400).filter(|i| !(100..130).contains(i));
        let rows: String = rows
            .map(|i| format!("{},{}\n", i as f64 / 1000.0, value(i)))
            .collect();
        assert!(of_rows(&rows, 0.0).excluded());
        assert!(of_rows(&rows, 0.05).excluded());
        let clean = of_rows(&rows, 0.2);
        assert_eq!(clean.flags, []);
        assert_eq!(clean.samples(), 200);
        assert!((clean.sample_rate_hz - 1000.0).abs() < 1e-6);
    }
}
