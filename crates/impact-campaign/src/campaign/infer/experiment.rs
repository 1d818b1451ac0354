//! What was probably measured: a driven rig, free decays, free flights, or the times of impacts.

use super::found::{Experiment, FolderContents, InferredChannel};
use super::place::{Place, spread};
use impact_records::event::{DetectSettings, Detection, FlightKind, RigKind, detect};
use impact_records::record::calibrate::{ChannelKey, ChannelSetup, RecordSetup, calibrate};
use impact_records::record::{ContactContent, FlagCode, Record, Role, Setting, changes};
use impact_records::signal::columns::{self, dot};
use impact_records::signal::{decay, onsets, robust};
use labfiles::DatasetInfo;
use labfiles::units::{self, Dimension};

/// Records that are looked at.
const MOST_RECORDS: usize = 6;
/// Most rows of a list of events.
const MOST_EVENTS: u64 = 400;
/// Part of a signal that a decay's fit may leave.
const DECAY_LEAVES: f64 = 0.45;
/// Fewest periods of a decay.
const DECAY_PERIODS: f64 = 5.0;
/// Part of a signal that the fit of a decay of few periods may leave, and those periods.
const CLEAR_LEAVES: f64 = 0.15;
const CLEAR_PERIODS: f64 = 1.5;
/// Fewest sounds that are bounces.
const FEWEST_SOUNDS: usize = 4;

/// Whether a dataset is a list of events: few rows, and nothing but times in it.
pub(super) fn is_event_list(set: &DatasetInfo) -> bool {
    let of_time = |c: &labfiles::ChannelInfo| {
        let unit = units::unit_of(c.unit.as_deref(), &c.name);
        unit.is_some_and(|u| u.dimension == Dimension::Time)
    };
    let rows = set.channels.iter().map(|c| c.samples).max().unwrap_or(0);
    let timed = set.channels.iter().filter(|c| of_time(c)).count();
    let numbers = |c: &&labfiles::ChannelInfo| !of_time(c) && numbers_rows(c);
    let counted = set.channels.iter().filter(numbers).count();
    (3..=MOST_EVENTS).contains(&rows) && timed > 0 && timed + counted == set.channels.len()
}

/// Words that name a column of the numbers of events.
const NUMBERED: [&str; 15] = [
    "n", "nr", "no", "i", "k", "index", "row", "zeile", "bounce", "hit", "impact", "event",
    "number", "aufprall", "rebond",
];

/// Whether a column without a unit is called as one that numbers the rows.
fn numbers_rows(channel: &labfiles::ChannelInfo) -> bool {
    let name = channel.name.to_lowercase();
    let bare = name.trim_matches(|c: char| !c.is_alphanumeric());
    channel.unit.is_none() && (name.trim() == "#" || NUMBERED.contains(&bare))
}

/// The column of times of a list of changes.
pub(super) fn changes_at(place: Place<'_>) -> Option<usize> {
    let set = place.set();
    let time = set.time_axis?;
    let times = place.numbers(time);
    let states = changes::candidates(set, time).map(|state| place.numbers(state));
    // an analyser lists the rows of all its lines, those too that never change
    let lines: Vec<Vec<f64>> = states.filter(|s| s.len() == times.len()).collect();
    let mut levels = lines.iter().map(|line| changes::line_levels(&times, line));
    let found = changes::all_change(&lines) && levels.any(|found| found.is_some());
    // a square wave that is sampled at even times changes with each row too
    let steps: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
    let (least, greatest) = columns::extremes(&steps);
    (found && greatest > 2.0 * least).then_some(time)
}

/// Find out what was measured, and set roles and signs for it.
pub(super) fn infer(places: &[Place<'_>], found: &mut FolderContents) {
    let Some(first) = places.first() else { return };
    if first.source.datasets().iter().any(is_event_list) {
        found.experiment = Experiment::Events(events(*first, &mut found.channels));
        return;
    }
    if let Some(time) = changes_at(*first) {
        found.experiment = Experiment::Events(ContactContent::Times);
        found.channels.iter_mut().for_each(|c| c.role = None);
        found.channels[time].role = Some(Role::Contact);
        return;
    }
    let some = spread(places, MOST_RECORDS);
    let moving = |c: &InferredChannel| c.role.is_some_and(Role::is_motion);
    if !found.channels.iter().any(moving) {
        if let Some(index) = microphone(&some, &found.channels) {
            found.experiment = Experiment::Events(ContactContent::Sound);
            found.channels[index].role = Some(Role::Contact);
        } else if let Some(index) = unnamed_decay(&some, &found.channels) {
            found.experiment = Experiment::FreeDecay;
            found.channels[index].role = Some(Role::VelocityX);
        }
        return;
    }
    if found.channels.iter().any(|c| c.role == Some(Role::Drive)) {
        return;
    }
    let records: Vec<Record> = some
        .iter()
        .map(|place| read(*place, &found.channels))
        .collect();
    let two = found
        .channels
        .iter()
        .any(|c| c.role.is_some_and(Role::is_of_y));
    let rig = if two {
        RigKind::Double
    } else {
        RigKind::Single
    };
    if 2 * records.iter().filter(|r| decays(r)).count() > records.len() {
        found.experiment = Experiment::FreeDecay;
        if two && records.iter().all(is_one_body) {
            keep_one_mass(&mut found.channels);
        }
        return;
    }
    let settings = DetectSettings {
        flight: FlightKind::ConstantForce,
        ..DetectSettings::default()
    };
    let sampled = records.iter().filter(|r| r.sample_rate_hz > 0.0);
    let detected: Vec<Detection> = sampled.map(|r| detect(r, rig, &settings)).collect();
    let most = |is: &dyn Fn(&Detection) -> bool| {
        2 * detected.iter().filter(|d| is(d)).count() > records.len()
    };
    let flies = |d: &Detection| !d.impacts.is_empty();
    let notes = |d: &Detection, code| d.flags.iter().any(|f| f.code == code);
    if two && most(&|d| notes(d, FlagCode::SeparateBodies)) {
        // balls thrown side by side: each is a rig of its own
        keep_one_mass(&mut found.channels);
        return infer(places, found);
    }
    let along = |d: &Detection| notes(d, FlagCode::OppositeSign);
    if most(&|d| flies(d) || along(d)) {
        found.experiment = Experiment::FreeFlight(rig);
        let away = most(&|d| flies(d) && notes(d, FlagCode::MeasuredAway));
        orient(away, most(&along), &mut found.channels);
        without_acceleration(&mut found.channels);
    }
}

/// Channels whose names and units say nothing that are tried as the motion of a decay.
const MOST_TRIED: usize = 4;

/// The first channel that decays freely in most records, where no name or unit says what any channel is.
fn unnamed_decay(some: &[Place<'_>], channels: &[InferredChannel]) -> Option<usize> {
    if channels.iter().any(|c| c.role.is_some()) {
        return None;
    }
    let longest = channels.iter().map(|c| c.samples).max()?;
    let alive = |c: &InferredChannel| c.range.is_some_and(|[low, high]| high > low);
    let untold = |i: &usize| {
        let channel = &channels[*i];
        !channel.is_time && channel.samples == longest && alive(channel)
    };
    let mut tried = (0..channels.len()).filter(untold).take(MOST_TRIED);
    tried.find(|index| {
        let mut guessed = channels.to_vec();
        guessed[*index].role = Some(Role::VelocityX);
        let decaying = some.iter().filter(|place| decays(&read(**place, &guessed)));
        2 * decaying.count() > some.len()
    })
}

/// Words in the names of times from one event to the next.
const INTERVALS: [&str; 4] = ["interval", "duration", "diff", "dt"];
/// Words in the names of flights, and of laps, whose times may be counted on.
const FLIGHTS: [&str; 5] = ["flug", "flight", "abstand", "lap", "runde"];

/// Whether a column of times holds those from one event to the next: by its name, by a name of flights whose numbers
/// do not only rise, or by numbers of which most fall.
fn are_intervals(name: &str, values: &[f64]) -> bool {
    let name = name.to_lowercase();
    let called = |words: &[&str]| words.iter().any(|word| name.contains(word));
    let fall = values.windows(2).filter(|w| w[1] < w[0]).count();
    called(&INTERVALS) || (called(&FLIGHTS) && fall > 0) || 2 * fall >= values.len().max(1)
}

/// The column of a list of events that states the impacts.
fn events(place: Place<'_>, channels: &mut [InferredChannel]) -> ContactContent {
    let infos = place.set().channels.iter().enumerate();
    let listed: Vec<usize> = infos
        .filter(|(_, info)| !numbers_rows(info))
        .map(|(i, _)| i)
        .collect();
    let interval = |i: &usize| {
        let values = place.numbers(*i);
        are_intervals(&channels[*i].name, &values)
    };
    let (at, content) = match listed.iter().find(|i| !interval(i)) {
        Some(at) => (Some(*at), ContactContent::Times),
        None => (listed.first().copied(), ContactContent::Intervals),
    };
    for channel in channels.iter_mut() {
        channel.role = None;
    }
    if let Some(channel) = at.and_then(|at| channels.get_mut(at)) {
        channel.role = Some(Role::Contact);
    }
    content
}

/// Samples a second by which sounds are looked for where the files state none: R does not depend on it.
const USUAL_SOUND_HZ: f64 = 44_100.0;
/// Fewest samples of a sound.
const FEWEST_SAMPLES: u64 = 4_000;

/// The channel in which bounces are heard in most records: the first of a sound file, or the only one of a table.
fn microphone(some: &[Place<'_>], channels: &[InferredChannel]) -> Option<usize> {
    let first = some.first()?;
    let mut signals = channels.iter().enumerate().filter(|(_, c)| !c.is_time);
    let (index, channel) = signals.next()?;
    let alone = signals.next().is_none() && channel.unit.is_none();
    let long = channel.samples >= FEWEST_SAMPLES;
    if first.source.format() != "wav"
        && !(alone && long && channels.iter().all(|c| c.role.is_none()))
    {
        return None;
    }
    let heard = some.iter().filter(|place| sounds(**place, index)).count();
    (2 * heard > some.len()).then_some(index)
}

/// Whether a sound is one of bounces: each follows the one before sooner.
fn sounds(place: Place<'_>, channel: usize) -> bool {
    let rate_hz = place.set().sample_rate_hz().unwrap_or(USUAL_SOUND_HZ);
    let values = place.numbers(channel);
    let found = onsets::find(&values, rate_hz);
    let flights: Vec<f64> = found.windows(2).map(|w| w[1] - w[0]).collect();
    let shorter = flights.windows(2).filter(|w| w[1] < w[0]).count();
    found.len() >= FEWEST_SOUNDS && 3 * shorter >= 2 * flights.len().saturating_sub(1)
}

/// A record by the inferred roles, in SI as far as units are known.
fn read(place: Place<'_>, channels: &[InferredChannel]) -> Record {
    let setups: Vec<ChannelSetup> = channels
        .iter()
        .filter_map(|c| {
            let role = c.role.filter(|r| r.is_motion())?;
            Some(ChannelSetup {
                unit: role.dimension().map(|dimension| units::Unit {
                    dimension,
                    to_si: 1.0,
                }),
                ignore_file_unit: true,
                ..ChannelSetup::plain(role, ChannelKey::Name(c.name.clone()))
            })
        })
        .collect();
    let setup = RecordSetup {
        id: "",
        dataset: place.dataset,
        channels: &setups,
        time: None,
        time_unit_s: None,
        // of a camera: neither decays nor flights depend on it
        sample_rate_hz: Some(USUAL_FRAMES_HZ),
        setting: &Setting::default(),
        driven: false,
        skip_s: 0.0,
    };
    calibrate(place.source, &setup)
}

/// Pictures a second by which records are looked at that number them, and state no rate.
const USUAL_FRAMES_HZ: f64 = 240.0;

fn decays(record: &Record) -> bool {
    let channels: Vec<decay::Watched<'_>> = record
        .channels
        .iter()
        .filter(|c| !c.role.is_of_y() && c.values.iter().all(|v| v.is_finite()))
        .map(|c| decay::Watched::displacement(&c.values))
        .collect();
    if channels.is_empty() || record.sample_rate_hz <= 0.0 {
        return false;
    }
    decay::fit_channels(&channels, record.sample_rate_hz)
        .first()
        .is_some_and(|d| {
            let periods = d.samples as f64 / record.sample_rate_hz * d.natural_frequency_hz;
            let long = d.residual_ratio < DECAY_LEAVES && periods > DECAY_PERIODS;
            let clear = d.residual_ratio < CLEAR_LEAVES && periods > CLEAR_PERIODS;
            (long || clear) && d.damping_ratio < 0.5
        })
}

/// Correlation from which two sensors see one body, whichever way they point: 1/(1 + q²) with noise of q times the motion
/// in each, a third. Decays of bodies of their own have less than half of it:
/// `prop_sensors_of_one_body_correlate_and_bodies_of_their_own_do_not`.
const ONE_BODY: f64 = 0.9;

/// Whether the sensors of both masses see one motion, as two on one beam do.
fn is_one_body(record: &Record) -> bool {
    let pairs = [
        (Role::VelocityX, Role::VelocityY),
        (Role::DisplacementX, Role::DisplacementY),
        (Role::AccelerationX, Role::AccelerationY),
    ];
    let both = pairs
        .iter()
        .filter_map(|(x, y)| Some((record.values(*x)?, record.values(*y)?)));
    let alike = |(x, y): (&[f64], &[f64])| correlation(x, y).abs() > ONE_BODY;
    let mut both = both.peekable();
    both.peek().is_some() && both.all(alike)
}

fn correlation(x: &[f64], y: &[f64]) -> f64 {
    let centred = |v: &[f64]| -> Vec<f64> {
        let mean = robust::mean(v);
        v.iter().map(|value| value - mean).collect()
    };
    let (x, y) = (centred(x), centred(y));
    let size = (dot(&x, &x) * dot(&y, &y)).sqrt();
    if size > 0.0 { dot(&x, &y) / size } else { 0.0 }
}

/// Take the roles of the second mass away.
fn keep_one_mass(channels: &mut [InferredChannel]) {
    for channel in channels
        .iter_mut()
        .filter(|c| c.role.is_some_and(Role::is_of_y))
    {
        channel.role = None;
    }
}

/// Signs of the channels as most impacts show them: all measured away, or both masses along one axis.
fn orient(away: bool, along: bool, channels: &mut [InferredChannel]) {
    for channel in channels {
        let moving = channel.role.filter(|r| r.is_motion());
        if moving.is_some_and(|role| away || (along && role.is_of_y())) {
            channel.sign = -1;
        }
    }
}

/// Free flights are recognised by velocity and displacement; an accelerometer adds its drift.
fn without_acceleration(channels: &mut [InferredChannel]) {
    let better = |c: &InferredChannel| {
        let role = c.role.filter(|r| r.is_motion());
        role.is_some_and(|r| !matches!(r, Role::AccelerationX | Role::AccelerationY))
    };
    if !channels.iter().any(better) {
        return;
    }
    for channel in channels {
        let drifts = matches!(
            channel.role,
            Some(Role::AccelerationX | Role::AccelerationY)
        );
        let unclear = channel.role == Some(Role::Contact) && channel.levels.is_none();
        if drifts || unclear {
            channel.role = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_flights_that_fall_are_intervals_and_times_that_rise_are_not() {
        let flights = [685.4, 548.3, 438.6, 350.9];
        let times = [0.0, 685.4, 1233.7, 1672.3];
        for name in ["Flugzeit", "flight", "Lap", "Zeit"] {
            assert!(are_intervals(name, &flights), "{name}");
            assert!(!are_intervals(name, &times), "{name}");
        }
        // three drops in one list, and intervals by their name
        assert!(!are_intervals("Time", &[0.5, 0.9, 1.2, 0.5, 0.9, 1.2]));
        assert!(are_intervals("duration", &times));
        assert!(!are_intervals("t", &[]));
    }

    /// A decay of β = 0.02 over ten periods of 1 Hz.
    fn decay(hz: f64, phase: f64) -> Vec<f64> {
        let turn = std::f64::consts::TAU * hz;
        let value = |t: f64| (-0.02 * turn * t).exp() * (turn * t + phase).cos();
        (0..500).map(|i| value(f64::from(i) / 50.0)).collect()
    }

    #[test]
    fn prop_sensors_of_one_body_correlate_and_bodies_of_their_own_do_not() {
        let own = decay(1.0, 0.3);
        // noise of a fifth of the motion: Weyl's sequence, uniform and without correlation
        let size = robust::rms(&own);
        for (step, sign) in [(0.618_033_988_75, 1.0), (0.414_213_562_37, -1.0)] {
            let noise = |i: usize| 12f64.sqrt() * ((i as f64 * step).fract() - 0.5);
            let other = own.iter().enumerate();
            let other: Vec<f64> = other
                .map(|(i, v)| sign * v + 0.2 * size * noise(i))
                .collect();
            let found = correlation(&own, &other);
            assert!(sign * found > ONE_BODY, "{found}");
        }
        for ratio in [1.2, 1.5, 2.0, 3.0] {
            for phase in [0.0, 0.8, 1.6, 2.4] {
                let found = correlation(&own, &decay(ratio, phase)).abs();
                assert!(found < 0.5 * ONE_BODY, "{ratio} {phase}: {found}");
            }
        }
    }
}
