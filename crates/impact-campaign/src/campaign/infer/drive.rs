//! Whether a rig is driven: which channel, if any, contains a drive that acts throughout the records.

use super::found::InferredChannel;
use super::place::Place;
use super::roles;
use impact_records::record::Role;
use impact_records::signal::steps::{DriveStep, steps};
use impact_records::signal::{robust, tone};

/// Part of the greatest excursion within which a signal rests.
const RESTS: f64 = 0.1;
/// Part of a record that a signal of pulses rests.
const MOSTLY: f64 = 0.8;
/// Residual over amplitude of a drive at most: beyond, the program refuses it as not harmonic.
const HARMONIC: f64 = 0.5;
/// Relative difference of two frequencies at which a drive waits.
const OTHER: f64 = 0.01;
/// Ratio of the last third of a drive to its first below which it fades.
const FADES: f64 = 0.8;
/// Residual over amplitude of a pure sine at most.
const PURE: f64 = 0.1;
/// Change of a steady amplitude from the first third to the last, relative, at most.
const STEADY: f64 = 0.03;
/// Fewest periods of a steady sine.
const FEWEST_PERIODS: f64 = 6.0;
/// Part of the variance of the motion at the frequency of its drive at least: what an open input picks up does not move
/// the mass.
const MOVED: f64 = 0.1;
/// Channels of unknown quantity that are tried as the drive.
const MOST_TRIED: usize = 4;

/// Settle which channel is the drive: a channel that is called so and rests but for pulses is a hammer; where no other
/// is called so, a pure sine at which the mass moves is the drive, whatever it is called.
pub(super) fn settle(some: &[Place<'_>], channels: &mut [InferredChannel]) {
    let called = |channels: &[InferredChannel]| {
        let is = |c: &InferredChannel| c.role == Some(Role::Drive);
        channels.iter().position(is)
    };
    if let Some(index) = called(channels)
        && most(some, |place| is_so(*place, &channels[index], is_pulses))
    {
        channels[index].role = None;
    }
    if called(channels).is_none()
        && let Some(index) = sine(some, channels)
    {
        channels[index].role = Some(Role::Drive);
    }
}

/// Take the role from a drive that does not act throughout most records: it fades as the motion does, or is no tone.
pub(super) fn without_idle(some: &[Place<'_>], channels: &mut [InferredChannel]) {
    let drives = channels.iter_mut().filter(|c| c.role == Some(Role::Drive));
    for channel in drives {
        if most(some, |place| is_so(*place, channel, |values| !acts(values))) {
            channel.role = None;
        }
    }
}

/// Whether most records are so.
fn most(some: &[Place<'_>], are: impl Fn(&Place<'_>) -> bool) -> bool {
    2 * some.iter().filter(|place| are(place)).count() > some.len()
}

/// Whether a record has a channel and its values are so.
fn is_so(place: Place<'_>, channel: &InferredChannel, are: impl Fn(&[f64]) -> bool) -> bool {
    values(place, channel).is_some_and(|values| are(&values))
}

/// A channel's values in a record.
fn values(place: Place<'_>, channel: &InferredChannel) -> Option<Vec<f64>> {
    Some(place.numbers(channel.find(place.set())?))
}

/// Whether a signal rests for most of a record, as a hammer's.
fn is_pulses(values: &[f64]) -> bool {
    let Some(rest) = robust::median(values) else {
        return false;
    };
    let excursion = |v: &f64| (v - rest).abs();
    let greatest = values.iter().map(excursion).fold(0.0, f64::max);
    let resting = values.iter().filter(|v| excursion(v) < RESTS * greatest);
    resting.count() as f64 > MOSTLY * values.len() as f64
}

/// Whether a signal is a tone from the beginning of a record to its end, at one frequency or at one after the other.
fn acts(values: &[f64]) -> bool {
    if waits(values) > 1 {
        return true;
    }
    let third = values.len() / 3;
    let size = |part: &[f64]| robust::squares_about_mean(part).sqrt();
    let harmonic = tone::fit(values, 1.0).is_some_and(|t| t.residual_rms < HARMONIC * t.amplitude);
    harmonic && size(&values[values.len() - third..]) > FADES * size(&values[..third])
}

/// At how many frequencies a tone waits, where it does so for most of a record; 0 where all are one.
fn waits(values: &[f64]) -> usize {
    let found = steps(values, 1.0);
    let Some(first) = found.first() else { return 0 };
    let others = |s: &DriveStep| (s.frequency_hz / first.frequency_hz - 1.0).abs() > OTHER;
    let kept: usize = found.iter().map(|s| s.to - s.from).sum();
    if 2 * kept > values.len() && found.iter().any(others) {
        found.len()
    } else {
        0
    }
}

/// That the drive of records waits at one frequency after another, as the first of them shows: a record is one setting.
pub(super) fn note_of_steps(some: &[Place<'_>], channels: &[InferredChannel]) -> Option<String> {
    let drive = channels.iter().find(|c| c.role == Some(Role::Drive))?;
    let (place, count) = some.iter().find_map(|place| {
        let count = waits(&values(*place, drive)?);
        (count > 1).then_some((place, count))
    })?;
    let file = place.source.path().file_name()?.to_string_lossy();
    let name = &drive.name;
    Some(format!(
        "{file}: '{name}' goes through {count} frequencies, and a record is one setting: cut it with impactid convert {file} \
         --cut '{name}' --out PATH, and begin with the records in PATH"
    ))
}

/// A channel of unknown quantity that is a pure and steady sine in most records, at whose frequency the mass moves.
fn sine(some: &[Place<'_>], channels: &[InferredChannel]) -> Option<usize> {
    let moving = channels
        .iter()
        .find(|c| c.role.is_some_and(Role::is_motion))?;
    let alive = |c: &InferredChannel| c.range.is_some_and(|[low, high]| high > low);
    let untold = |i: &usize| {
        let channel = &channels[*i];
        channel.role.is_none() && !channel.is_time && alive(channel) && roles::is_unknown(channel)
    };
    let mut tried = (0..channels.len()).filter(untold).take(MOST_TRIED);
    tried.find(|index| {
        let drives = |place: &Place<'_>| {
            let sine = values(*place, &channels[*index]);
            let frequency = sine.and_then(|values| steady_sine(&values));
            let motion = values(*place, moving);
            let share = frequency.zip(motion).map(|(f, motion)| share(&motion, f));
            share.is_some_and(|share| share > MOVED)
        };
        most(some, drives)
    })
}

/// The frequency of a signal that is a pure and steady sine, in periods per sample.
fn steady_sine(values: &[f64]) -> Option<f64> {
    let whole = tone::fit(values, 1.0)?;
    let third = values.len() / 3;
    let amplitude = |part: &[f64]| Some(tone::fit_from(part, 1.0, whole.frequency_hz)?.amplitude);
    let first = amplitude(&values[..third])?;
    let last = amplitude(&values[values.len() - third..])?;
    let pure = whole.residual_rms < PURE * whole.amplitude;
    let periods = whole.frequency_hz * values.len() as f64;
    let steady = (last / first - 1.0).abs() < STEADY && periods > FEWEST_PERIODS;
    (pure && steady).then_some(whole.frequency_hz)
}

/// The part of the variance of values at a frequency, in periods per sample.
fn share(values: &[f64], frequency: f64) -> f64 {
    let mean = robust::mean(values);
    let (mut even, mut odd) = (0.0, 0.0);
    for (i, value) in values.iter().enumerate() {
        let angle = std::f64::consts::TAU * frequency * i as f64;
        even += (value - mean) * angle.cos();
        odd += (value - mean) * angle.sin();
    }
    let all = robust::squares_about_mean(values);
    if all > 0.0 {
        2.0 * (even * even + odd * odd) / (all * values.len() as f64)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(value: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..3000).map(|i| value(f64::from(i) * 5e-4)).collect()
    }

    #[test]
    fn valid_a_hammer_rests_and_a_sine_does_not() {
        let noise = |t: f64| 0.01 * (7919.0 * t).sin();
        let hammer = wave(|t| {
            if (t - 0.25).abs() < 4e-3 {
                3.0
            } else {
                noise(t)
            }
        });
        assert!(is_pulses(&hammer));
        assert!(!is_pulses(&wave(|t| (60.0 * t).sin())));
        assert!(!is_pulses(&wave(|t| (60.0 * t).sin().signum())));
    }

    #[test]
    fn valid_a_drive_acts_to_the_end_and_a_decay_fades() {
        assert!(acts(&wave(|t| 0.3 + (60.0 * t).sin())));
        assert!(!acts(&wave(|t| 0.3 + (-t).exp() * (60.0 * t).sin())));
        let idle = wave(|t| (1e5 * t * t).sin());
        assert!(!acts(&idle));
    }

    #[test]
    fn valid_a_drive_that_waits_at_unlike_frequencies_acts() {
        let tone = |hz: f64, t: f64| (std::f64::consts::TAU * hz * t).sin();
        let stepped = wave(|t| tone(if t < 0.7 { 100.0 } else { 130.0 }, t));
        assert_eq!(waits(&stepped), 2);
        assert!(acts(&stepped));
        assert_eq!(waits(&wave(|t| tone(100.0, t))), 0);
        assert_eq!(waits(&wave(|t| tone(100.0 + 30.0 * t, t))), 0);
    }

    #[test]
    fn valid_a_pure_sine_is_one_of_constant_amplitude() {
        let frequency = steady_sine(&wave(|t| 1.5 * (60.0 * t).sin())).unwrap();
        assert!((frequency - 60.0 * 5e-4 / std::f64::consts::TAU).abs() < 1e-9);
        // a decay of β = 0.001, and a wave with a harmonic of a fifth
        assert_eq!(
            steady_sine(&wave(|t| (-0.06 * t).exp() * (60.0 * t).sin())),
            None
        );
        assert_eq!(
            steady_sine(&wave(|t| (60.0 * t).sin() + 0.2 * (120.0 * t).sin())),
            None
        );
    }

    #[test]
    fn valid_the_share_of_a_tone_is_that_of_its_variance() {
        let frequency = 10.0 * 5e-4;
        let turn = std::f64::consts::TAU;
        let both = wave(|t| 3.0 + (turn * 10.0 * t).sin() + 2.0 * (turn * 30.0 * t).cos());
        assert!((share(&both, frequency) - 0.2).abs() < 1e-9);
    }
}
