//! The drive's frequency and phase, measured from its channel.

use std::f64::consts::TAU;

use nalgebra::Complex;
use serde::{Deserialize, Serialize};

use crate::record::consistency::{ComparedChannels, mistaken};
use crate::record::{Channel, Flag, Problem, Record, Role, before_high_pass};
use crate::signal::tone;

/// The drive as measured from its channel: amplitude · cos(2π f t + phase).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DriveTone {
    /// Measured frequency, Hz.
    pub frequency_hz: f64,
    /// Its standard error, Hz.
    pub frequency_error_hz: f64,
    /// Amplitude in the channel's SI unit.
    pub amplitude: f64,
    /// Phase at the first sample, rad.
    pub phase_rad: f64,
    /// Root mean square of the residual, relative to the amplitude.
    pub residual_ratio: f64,
}

impl DriveTone {
    /// A pure tone of a frequency, Hz, and an amplitude, whose phase is zero at the first sample.
    pub fn at(frequency_hz: f64, amplitude: f64) -> Self {
        Self {
            frequency_hz,
            frequency_error_hz: 0.0,
            amplitude,
            phase_rad: 0.0,
            residual_ratio: 0.0,
        }
    }

    /// Phase of the drive at a time since the first sample, rad in [0, 2π).
    pub fn phase_at(&self, time_s: f64) -> f64 {
        (TAU * self.frequency_hz * time_s + self.phase_rad).rem_euclid(TAU)
    }

    /// Drive period, s.
    pub fn period_s(&self) -> f64 {
        1.0 / self.frequency_hz
    }
}

/// Ratio of residual to amplitude above which a drive does not count as harmonic.
const NOT_HARMONIC: f64 = 0.5;

/// Measure the drive of a record from its drive channel.
///
/// Returns the tone as it was before the channel's filters, if the record has a drive channel that holds one, and flags: a
/// drive that is not a harmonic tone, and a measured frequency that differs from the stated one by more than `tolerance`
/// (relative) and three standard errors.
pub(super) fn measure(record: &Record, tolerance: f64) -> (Option<DriveTone>, Vec<Flag>) {
    let Some(channel) = record.channel(Role::Drive) else {
        return (None, Vec::new());
    };
    let Some(tone) = tone::fit(&channel.values, record.sample_rate_hz) else {
        return (None, vec![no_tone(&channel.name)]);
    };
    let ratio = tone.residual_rms / tone.amplitude;
    if ratio > NOT_HARMONIC {
        return (None, vec![no_tone(&channel.name)]);
    }
    let passed = passed(channel, tone.frequency_hz);
    let drive = DriveTone {
        frequency_hz: tone.frequency_hz,
        frequency_error_hz: tone.frequency_error_hz,
        amplitude: tone.amplitude / passed.norm(),
        phase_rad: tone.phase_rad - passed.arg(),
        residual_ratio: ratio,
    };
    let flags = contradiction(record, &channel.name, &drive, tolerance)
        .into_iter()
        .collect();
    (Some(drive), flags)
}

/// What the filters stated of a channel make of a unit amplitude at a frequency.
fn passed(channel: &Channel, frequency_hz: f64) -> Complex<f64> {
    let high = before_high_pass(channel.high_pass_hz.unwrap_or(0.0), frequency_hz).inv();
    let rate = Complex::new(0.0, TAU * frequency_hz);
    channel
        .low_pass
        .map_or(high, |low| high * low.transfer(rate))
}

/// Relative deviation from the stated frequency within which a motion's tone is the drive's.
const NEAR_STATED: f64 = 0.02;

/// The tone that a motion has near the frequency that is stated for its drive, of a record without a
/// drive channel: its frequency is the drive's, its phase is not.
pub fn of_motion(record: &Record, motion: &[f64], rate_hz: f64) -> Option<DriveTone> {
    let stated_hz = record.setting.stated_frequency_hz?;
    if record.channel(Role::Drive).is_some() || motion.iter().any(|v| !v.is_finite()) {
        return None;
    }
    let tone = tone::fit_from(motion, rate_hz, stated_hz)?;
    let near = (tone.frequency_hz / stated_hz - 1.0).abs() < NEAR_STATED;
    // what is no tone has no more at one frequency than at others
    let harmonic = tone.residual_rms < tone.amplitude;
    (near && harmonic).then_some(DriveTone {
        frequency_hz: tone.frequency_hz,
        frequency_error_hz: tone.frequency_error_hz,
        amplitude: tone.amplitude,
        phase_rad: tone.phase_rad,
        residual_ratio: tone.residual_rms / tone.amplitude,
    })
}

fn no_tone(channel: &str) -> Flag {
    Flag::new(Some(channel), Problem::NoTone)
}

fn contradiction(
    record: &Record,
    channel: &str,
    drive: &DriveTone,
    tolerance: f64,
) -> Option<Flag> {
    let stated = record.setting.stated_frequency_hz?;
    let allowed = (tolerance * stated).max(3.0 * drive.frequency_error_hz);
    if (drive.frequency_hz - stated).abs() <= allowed {
        return None;
    }
    let (measured_hz, stated_hz) = (drive.frequency_hz, stated);
    let units = mistaken(stated_hz / measured_hz, ComparedChannels::Frequency);
    let problem = match units {
        Some(units) => Problem::FrequencyInOtherUnits {
            measured_hz,
            stated_hz,
            units,
        },
        None => Problem::FrequencyUnlikeStated {
            measured_hz,
            stated_hz,
        },
    };
    Some(Flag::new(Some(channel), problem).excluding(false))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{FlagCode, LowPass};

    fn tone(frequency_hz: f64, phase_rad: f64) -> impl Fn(usize) -> f64 {
        move |i| (std::f64::consts::TAU * frequency_hz * i as f64 / 2000.0 + phase_rad).cos()
    }

    fn record(of: impl Fn(usize) -> f64) -> Record {
        let values: Vec<f64> = (0..2000).map(of).collect();
        Record::of(2000.0, &[(Role::Drive, &values)])
    }

    #[test]
    fn valid_the_tone_is_measured_and_gives_phases() {
        let clean = tone(12.6, 0.4);
        let (found, flags) = measure(&record(|i| 2.0 * clean(i)), 5e-3);
        let drive = found.unwrap();
        assert!(flags.is_empty());
        assert!((drive.frequency_hz - 12.6).abs() < 1e-8);
        assert!((drive.amplitude - 2.0).abs() < 1e-8);
        // A quarter period after the first sample the phase is 0.4 + π/2.
        let quarter = drive.phase_at(0.25 * drive.period_s());
        assert!((quarter - 0.4 - std::f64::consts::FRAC_PI_2).abs() < 1e-7);
    }

    #[test]
    fn valid_the_drive_is_that_before_the_channel_s_filters() {
        // 2 cos(θ + 0.4) behind f/(f − i f_c): 1/√2 of it and an eighth of a turn ahead; behind one pole as far behind
        let plain = tone(12.6, 0.4);
        let ahead = tone(12.6, 0.4 + 0.25 * std::f64::consts::PI);
        let mut shown = record(|i| std::f64::consts::SQRT_2 * ahead(i));
        shown.channels[0].high_pass_hz = Some(12.6);
        let mut both = record(plain);
        both.channels[0].high_pass_hz = Some(12.6);
        both.channels[0].low_pass = Some(LowPass {
            corner_hz: 12.6,
            order: 1,
        });
        for passed in [shown, both] {
            let drive = measure(&passed, 5e-3).0.expect("a drive");
            assert!((drive.amplitude - 2.0).abs() < 1e-8, "{drive:?}");
            assert!((drive.phase_at(0.0) - 0.4).abs() < 1e-7, "{drive:?}");
        }
    }

    #[test]
    fn a_frequency_in_another_unit_is_named() {
        let mut stated = record(tone(12.6, 0.0));
        stated.setting.stated_frequency_hz = Some(12.6 * std::f64::consts::TAU);
        let (found, flags) = measure(&stated, 5e-3);
        assert!(found.is_some());
        assert_eq!(flags[0].code, FlagCode::DriveFrequencyContradicts);
        assert!(
            flags[0].message().contains("between Hz and rad/s"),
            "{}",
            flags[0].message()
        );
        assert!(!flags[0].excludes);
        stated.setting.stated_frequency_hz = Some(12.6 * std::f64::consts::SQRT_2);
        let (_, flags) = measure(&stated, 5e-3);
        assert!(
            !flags[0].message().contains("factor"),
            "{}",
            flags[0].message()
        );
        stated.setting.stated_frequency_hz = Some(12.62);
        assert!(measure(&stated, 5e-3).1.is_empty());
    }

    #[test]
    fn a_motion_has_the_frequency_of_a_drive_that_is_stated_and_not_recorded() {
        let (drive, half) = (tone(12.6, 0.4), tone(6.3, 0.1));
        let motion: Vec<f64> = (0..2000).map(|i| drive(i) + 0.3 * half(i)).collect();
        let mut unrecorded = Record::of(2000.0, &[(Role::VelocityX, &motion)]);
        assert_eq!(of_motion(&unrecorded, &motion, 2000.0), None);
        unrecorded.setting.stated_frequency_hz = Some(12.5);
        let found = of_motion(&unrecorded, &motion, 2000.0).expect("a tone");
        assert!((found.frequency_hz - 12.6).abs() < 0.02, "{found:?}");
        // neither another tone nor a recorded drive
        unrecorded.setting.stated_frequency_hz = Some(15.0);
        assert_eq!(of_motion(&unrecorded, &motion, 2000.0), None);
        let mut recorded = record(tone(12.6, 0.0));
        recorded.setting.stated_frequency_hz = Some(12.6);
        assert_eq!(of_motion(&recorded, &motion, 2000.0), None);
    }

    #[test]
    fn two_equal_tones_are_no_drive() {
        let (low, high) = (tone(12.6, 0.0), tone(47.0, 0.0));
        let (found, flags) = measure(&record(|i| low(i) + high(i)), 5e-3);
        assert_eq!(found, None);
        assert_eq!(flags[0].code, FlagCode::DriveNotHarmonic);
        assert!(measure(&Record::of(2000.0, &[]), 5e-3).1.is_empty());
    }
}
