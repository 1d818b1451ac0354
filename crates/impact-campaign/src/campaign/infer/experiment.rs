//! What was probably measured: a driven rig, free decays, free flights, or the times of impacts.

use super::found::{Experiment, FolderContents, InferredChannel};
use super::heights::{self, Heights};
use super::look::{Detected, bounces, correlation, notes, read, strikes, strikes_once};
use super::place::{Place, spread};
use super::{axes, bodies};
use super::{contact, drive, lists};
use impact_records::event::{Detection, RigKind};
use impact_records::record::{Channel, ContactContent, FlagCode, Record, Role};
use impact_records::signal::decay::{self, Decay, Watched};
use impact_records::signal::onsets;
use impact_records::signal::robust;
use labfiles::timing::AxisUnit;

/// Records that are looked at.
const MOST_RECORDS: usize = 6;
/// Part of a signal that a decay's fit may leave.
const DECAY_LEAVES: f64 = 0.45;
/// Fewest periods of a decay.
const DECAY_PERIODS: f64 = 5.0;
/// Part of a signal that the fit of a decay of few periods may leave, and those periods.
const CLEAR_LEAVES: f64 = 0.15;
const CLEAR_PERIODS: f64 = 1.5;
/// Part of a signal that the fit of a decay of half a swing may leave, and its greatest damping ratio.
const HEAVY_LEAVES: f64 = 0.05;
const MOST_DAMPED: f64 = 0.9;
/// Fewest sounds that are bounces.
const FEWEST_SOUNDS: usize = 4;

/// Find out what was measured, and set roles and signs for it.
pub(super) fn infer(places: &[Place<'_>], found: &mut FolderContents) {
    let Some(first) = places.first() else { return };
    let times = lists::of_times(*first);
    if let Some(content) = lists::along_rows(*first, &times) {
        list(*first, times[0], &mut found.channels);
        let names = times.iter().filter_map(|i| found.channels.get(*i));
        found.then = names.skip(1).map(|c| c.name.clone()).collect();
        found.experiment = Experiment::Events(content);
        return;
    }
    if !times.is_empty() {
        let content = events(*first, &times, &mut found.channels);
        found.experiment = Experiment::Events(content);
        if content == ContactContent::Times {
            let note = other_lists(*first, &times, &found.channels);
            found.notes.extend(note);
        }
        return;
    }
    if let Some(listed) = heights::of(*first) {
        found.experiment = Experiment::Events(listed.content);
        of_heights(&listed, found);
        return;
    }
    let some = spread(places, MOST_RECORDS);
    drive::settle(&some, &mut found.channels);
    let moving = |c: &InferredChannel| c.role.is_some_and(Role::is_motion);
    if !found.channels.iter().any(moving) {
        without_motion(&some, found);
    } else if !found.states_drive {
        of_motions(&some, found);
    }
    if found.experiment == Experiment::Driven {
        found
            .notes
            .extend(drive::note_of_steps(&some, &found.channels));
        bodies::ask_of_driven(found);
    }
}

/// Give the first column of heights its role, and note those that follow.
fn of_heights(listed: &Heights, found: &mut FolderContents) {
    without_roles(&mut found.channels);
    let names = listed.columns.iter().filter_map(|i| found.channels.get(*i));
    found.then = names.skip(1).map(|c| c.name.clone()).collect();
    if listed.of_bodies {
        found.notes.push(format!(
            "{}: taken for rebounds of one body; if they are of unlike bodies or floors, give each a campaign of its own",
            found.then.join(", ")
        ));
    }
    if let Some(first) = listed
        .columns
        .first()
        .and_then(|i| found.channels.get_mut(*i))
    {
        first.role = Some(Role::Contact);
    }
}

/// What records without a known channel of motion show.
fn without_motion(some: &[Place<'_>], found: &mut FolderContents) {
    let plate = contact::bounced_on(some, &found.channels);
    let decay = unnamed_decay(some, &found.channels);
    let (index, experiment, role) = if let Some((index, level)) = plate {
        found.channels[index].closes_at = Some(level);
        (
            index,
            Experiment::FreeFlight(RigKind::Single),
            Role::Contact,
        )
    } else if let Some(index) = microphone(some, &found.channels, decay) {
        let sound = Experiment::Events(ContactContent::Sound);
        (index, sound, Role::Contact)
    } else if let Some(index) = decay {
        (index, Experiment::FreeDecay, Role::VelocityX)
    } else {
        return;
    };
    found.experiment = experiment;
    without_roles(&mut found.channels);
    found.channels[index].role = Some(role);
}

/// What records of motions show: a drive, free decays or free flights.
fn of_motions(some: &[Place<'_>], found: &mut FolderContents) {
    let records = read_all(some, found);
    let decaying = records.iter().filter(|r| decays(r)).count();
    let mostly_decays = 2 * decaying > records.len();
    if mostly_decays {
        drive::without_idle(some, &mut found.channels);
    }
    if found.channels.iter().any(|c| c.role == Some(Role::Drive)) {
        return;
    }
    let swinging = records.iter().filter(|r| swings(r)).count();
    let mostly_swing = 2 * swinging > records.len();
    if !mostly_swing {
        bodies::take_second(some, found);
    }
    let of_y = |c: &InferredChannel| c.role.is_some_and(Role::is_of_y);
    let two = found.channels.iter().any(of_y);
    let rig = if two {
        RigKind::Double
    } else {
        RigKind::Single
    };
    if mostly_decays {
        // carts that come to rest strike each other once, which is seen along one axis too
        let strike = |d: &Detection| match mostly_swing {
            true => strikes(d),
            false => strikes_once(d) || notes(d, FlagCode::OppositeSign),
        };
        let struck = two && Detected::of(&read_all(some, found), RigKind::Double).most(strike);
        let clear = records.iter().filter(|r| is_clear(r)).count();
        let bounces = || 2 * clear <= records.len() && Detected::of(&records, rig).most(bounces);
        if !struck && (two || !bounces()) {
            free_decays(some, &records, found);
            return;
        }
    }
    let fly = flights(some, rig, found);
    if found.experiment == Experiment::FreeFlight(rig) {
        bodies::ask_or_note(some, rig, found);
    }
    let fades = |r: &Record| longest(r).is_some_and(|d| fades(&d, r));
    if !fly && (decaying > 0 && 2 * decaying >= records.len() || records.iter().all(fades)) {
        free_decays(some, &records, found);
    }
}

/// Some records by the roles found so far.
fn read_all(some: &[Place<'_>], found: &FolderContents) -> Vec<Record> {
    let read = |place: &Place<'_>| read(*place, &found.channels);
    some.iter().map(read).collect()
}

/// Whether records show free flights; sets signs, roles and notes for them.
fn flights(some: &[Place<'_>], rig: RigKind, found: &mut FolderContents) -> bool {
    let detected = Detected::of(&read_all(some, found), rig);
    if rig == RigKind::Double && detected.most(|d| notes(d, FlagCode::SeparateBodies)) {
        // balls thrown side by side: each is a rig of its own
        found.notes.push(bodies::apart(&found.channels));
        keep_one_mass(&mut found.channels);
        return flights(some, RigKind::Single, found);
    }
    let flies = |d: &Detection| !d.impacts.is_empty();
    let along = |d: &Detection| notes(d, FlagCode::OppositeSign);
    if !detected.most(|d| flies(d) || along(d)) {
        return false;
    }
    found.experiment = Experiment::FreeFlight(rig);
    let away = detected.most(|d| flies(d) && notes(d, FlagCode::MeasuredAway));
    orient(away, detected.most(along), &mut found.channels);
    without_acceleration(&mut found.channels);
    true
}

/// The records are free decays, of one body where all sensors see one motion.
fn free_decays(some: &[Place<'_>], records: &[Record], found: &mut FolderContents) {
    found.experiment = Experiment::FreeDecay;
    if records.iter().all(is_one_body) {
        keep_one_mass(&mut found.channels);
    }
    axes::note_turning(some, found);
}

/// Channels whose names and units say nothing that are tried as the motion of a decay.
const MOST_TRIED: usize = 4;

/// How many times as long as that of a channel before it a decay lasts that is the motion, and the other one what struck it: a
/// hammer's pulse rings too.
const LASTS: f64 = 4.0;

/// The first channel that decays freely in most records, where no name or unit says what any channel is, or another one whose
/// decays last far longer.
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
    let tried = (0..channels.len()).filter(untold).take(MOST_TRIED);
    let lasting = tried.filter_map(|index| {
        let mut guessed = channels.to_vec();
        guessed[index].role = Some(Role::VelocityX);
        let read = |place: &Place<'_>| from_greatest(read(*place, &guessed));
        let decaying = some.iter().map(read).filter(decays);
        let lasts: Vec<f64> = decaying.map(|r| lasts(&r)).collect();
        let mostly = 2 * lasts.len() > some.len();
        Some((index, robust::median(&lasts).filter(|_| mostly)?))
    });
    let longest = lasting.reduce(|own, next| if next.1 > LASTS * own.1 { next } else { own });
    longest.map(|(index, _)| index)
}

/// Samples of an unnamed channel that are looked at, and those of them before its greatest excursion.
const MOST_SAMPLES: usize = 50_000;
const BEFORE_GREATEST: usize = 2_000;

/// The part of a long record of one channel that begins at its greatest excursion, where a decay would.
fn from_greatest(mut record: Record) -> Record {
    let long = |c: &&mut Channel| c.values.len() > MOST_SAMPLES;
    for channel in record.channels.iter_mut().filter(long) {
        let mean = robust::mean(&channel.values);
        let excursion = |v: &f64| (v - mean).abs();
        let excursions = channel.values.iter().map(excursion).enumerate();
        let greatest = excursions.max_by(|a, b| a.1.total_cmp(&b.1));
        let first = greatest.map_or(0, |(i, _)| i.saturating_sub(BEFORE_GREATEST));
        channel.values.drain(..first);
        channel.values.truncate(MOST_SAMPLES);
    }
    record
}

/// Words in the names of times from one event to the next.
const INTERVALS: [&str; 4] = ["interval", "duration", "diff", "dt"];
/// Words in the names of flights, and of laps, whose times may be counted on.
const FLIGHTS: [&str; 5] = ["flug", "flight", "abstand", "lap", "runde"];

/// Whether a column of times holds those from one event to the next: by its name, by a name of flights whose numbers
/// do not only rise, or by numbers of which most fall, and are no times of which the last is first.
fn are_intervals(name: &str, values: &[f64]) -> bool {
    let name = name.to_lowercase();
    let called = |words: &[&str]| words.iter().any(|word| name.contains(word));
    let fall = values.windows(2).filter(|w| w[1] < w[0]).count();
    called(&INTERVALS)
        || (called(&FLIGHTS) && fall > 0)
        || (2 * fall >= values.len().max(1) && !lists::are_reversed(values))
}

/// Part of the longest interval by which printed sums may differ from it.
const SUM_ROUNDED: f64 = 0.05;

/// Whether numbers are what others differ by from row to row, as the laps beside the total time of a stopwatch; laps that are
/// written as times of day are counted from the first of them.
fn are_differences(laps: &[f64], totals: &[f64]) -> bool {
    let steps: Vec<f64> = totals.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
    let longest = steps.iter().copied().fold(0.0, f64::max);
    let alike = |laps: &[f64]| {
        let over = laps.iter().zip(&steps).map(|(lap, step)| lap - step);
        robust::range(over).is_some_and(|(low, high)| high - low <= SUM_ROUNDED * longest)
    };
    // with the first row last, a lap stands beside the total time that it leads to
    let (Some(later), Some(before)) = (laps.get(1..), laps.get(..steps.len())) else {
        return false;
    };
    steps.len() > 1 && laps.len() == totals.len() && (alike(later) || alike(before))
}

/// The column of a list of events that states the impacts, among those that contain times.
fn events(place: Place<'_>, listed: &[usize], channels: &mut [InferredChannel]) -> ContactContent {
    let values: Vec<Vec<f64>> = listed.iter().map(|i| place.numbers(*i)).collect();
    let lap = |own: &Vec<f64>| values.iter().any(|of| are_differences(own, of));
    let interval = |i: &usize| {
        let own = place.numbers(*i);
        lap(&own) || are_intervals(&channels[*i].name, &own)
    };
    let (at, content) = match listed.iter().find(|i| !interval(i)) {
        Some(at) => (Some(*at), ContactContent::Times),
        None => (listed.first().copied(), ContactContent::Intervals),
    };
    if let Some(at) = at {
        list(place, at, channels);
    }
    content
}

/// That further columns are lists of times of their own, which are not used: times beside their intervals, or beginnings
/// beside ends, are none.
fn other_lists(place: Place<'_>, listed: &[usize], channels: &[InferredChannel]) -> Option<String> {
    let used = listed
        .iter()
        .find(|i| channels[**i].role == Some(Role::Contact))?;
    let own = place.numbers(*used);
    let differs = |i: &&usize| {
        let values = place.numbers(**i);
        let last = values.iter().rfind(|v| v.is_finite());
        let last = last.zip(own.iter().rfind(|v| v.is_finite()));
        let far = last.is_some_and(|(a, b)| (a / b - 1.0).abs() > UNLIKE_LISTS);
        let lap = are_differences(&values, &own) || are_intervals(&channels[**i].name, &values);
        far && !lap
    };
    let others = listed.iter().filter(|i| *i != used).filter(differs);
    let names: Vec<&str> = others.map(|i| channels[*i].name.as_str()).collect();
    let first = channels[*used].name.as_str();
    (!names.is_empty()).then(|| {
        format!(
            "{}: taken for another list than {first}, and not used here: give it a campaign of its own",
            names.join(", ")
        )
    })
}

/// Difference of the last times of two lists, over one of them, that beginnings and ends of the same impacts do not have.
const UNLIKE_LISTS: f64 = 0.02;

/// Take a column as the list of the impacts.
fn list(place: Place<'_>, at: usize, channels: &mut [InferredChannel]) {
    without_roles(channels);
    if let Some(channel) = channels.get_mut(at) {
        channel.role = Some(Role::Contact);
        let unit = channel.unit.as_deref();
        channel.counted_in = Some(AxisUnit::of(unit, &channel.name, &place.numbers(at)));
    }
}

/// Samples a second by which sounds are looked for where the files state none: R does not depend on it.
const USUAL_SOUND_HZ: f64 = 44_100.0;
/// Fewest samples of a sound.
const FEWEST_SAMPLES: u64 = 4_000;

/// The channel in which bounces are heard in most records: the first of a sound file, or the only one of a table. Beside another
/// one that decays far longer it is that of a hammer.
fn microphone(
    some: &[Place<'_>],
    channels: &[InferredChannel],
    decay: Option<usize>,
) -> Option<usize> {
    let first = some.first()?;
    let mut signals = channels.iter().enumerate().filter(|(_, c)| !c.is_time);
    let (index, channel) = signals.next()?;
    if decay.is_some_and(|other| other != index) {
        return None;
    }
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
    found.len() >= FEWEST_SOUNDS && contact::shorten(&flights)
}

/// Whether a record is a free decay: it swings, or comes to rest without.
fn decays(record: &Record) -> bool {
    swings(record) || watched(record).iter().any(decay::comes_to_rest)
}

/// The motions of the first mass, where they can be looked at.
fn watched(record: &Record) -> Vec<Watched<'_>> {
    if record.sample_rate_hz <= 0.0 {
        return Vec::new();
    }
    record
        .channels
        .iter()
        .filter(|c| !c.role.is_of_y() && c.values.iter().all(|v| v.is_finite()))
        .map(|c| Watched::new(&c.values, c.role.motion_signal()))
        .collect()
}

/// Whether a record's longest oscillation is a free decay: a hold before its release, or noise, may be fitted first.
fn swings(record: &Record) -> bool {
    let is_one = |d: &Decay| {
        let periods = periods(d, record);
        let long = d.residual_ratio < DECAY_LEAVES && periods > DECAY_PERIODS;
        let clear = d.residual_ratio < CLEAR_LEAVES && periods > CLEAR_PERIODS;
        let heavy = d.residual_ratio < HEAVY_LEAVES && periods > CLEAR_PERIODS;
        (long || clear) && d.damping_ratio < 0.5 || heavy && d.damping_ratio < MOST_DAMPED
    };
    longest(record).as_ref().is_some_and(is_one)
}

/// Whether a record's longest oscillation leaves little of it.
fn is_clear(record: &Record) -> bool {
    longest(record).is_some_and(|d| d.residual_ratio < CLEAR_LEAVES)
}

/// The longest oscillation of a record.
fn longest(record: &Record) -> Option<Decay> {
    let found = decay::fit_channels(&watched(record), record.sample_rate_hz);
    found.into_iter().max_by_key(|d| d.samples)
}

/// How long the longest oscillation of a record lasts, s; 0 if it has none.
fn lasts(record: &Record) -> f64 {
    longest(record).map_or(0.0, |d| d.samples as f64 / record.sample_rate_hz)
}

/// The periods that a decay was fitted to.
fn periods(decay: &Decay, record: &Record) -> f64 {
    decay.samples as f64 / record.sample_rate_hz * decay.natural_frequency_hz
}

/// Part of a signal that the fit of a decay of several modes, or under much noise, may leave.
const FADES_LEAVES: f64 = 0.8;

/// Whether an oscillation falls by e and more, whatever else is in the record: where nothing drives the masses and they do not
/// fly, it is a free decay of which the identification says what is wrong.
fn fades(decay: &Decay, record: &Record) -> bool {
    let periods = periods(decay, record);
    let falls = std::f64::consts::TAU * decay.damping_ratio * periods > 1.0;
    falls
        && periods > DECAY_PERIODS
        && decay.damping_ratio < 0.5
        && decay.residual_ratio < FADES_LEAVES
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

/// Take all roles away.
fn without_roles(channels: &mut [InferredChannel]) {
    for channel in channels {
        channel.role = None;
    }
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
    use impact_records::signal::robust;

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
        // the last impact first
        let reversed: Vec<f64> = times.iter().rev().copied().collect();
        assert!(!are_intervals("Zeit", &reversed));
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
