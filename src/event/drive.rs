//! The drive's frequency and phase, measured from its channel.

use crate::event::DriveTone;
use crate::record::consistency::mistaken;
use crate::record::{Flag, Record, Role};
use crate::signal::tone;

/// Least ratio of residual to amplitude at which a drive no longer counts as harmonic.
const NOT_HARMONIC: f64 = 0.5;

/// Measure the drive of a record from its drive channel.
///
/// Returns the tone, if the record has a drive channel that holds one, and flags: a drive that is
/// no harmonic tone, and a measured frequency that contradicts the stated one by more than
/// `tolerance` (relative) or three standard errors, whichever is greater.
pub fn measure(record: &Record, tolerance: f64) -> (Option<DriveTone>, Vec<Flag>) {
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
    let drive = DriveTone {
        frequency_hz: tone.frequency_hz,
        frequency_error_hz: tone.frequency_error_hz,
        amplitude: tone.amplitude,
        phase_rad: tone.phase_rad,
        residual_ratio: ratio,
    };
    let flags = contradiction(record, &channel.name, &drive, tolerance)
        .into_iter()
        .collect();
    (Some(drive), flags)
}

fn no_tone(channel: &str) -> Flag {
    Flag {
        code: "drive_not_harmonic".into(),
        channel: Some(channel.into()),
        message: "the drive channel holds no single harmonic tone".into(),
        remedy: "check that the drive channel is named correctly and that the drive was on".into(),
        excludes: true,
    }
}

fn contradiction(
    record: &Record,
    channel: &str,
    drive: &DriveTone,
    tolerance: f64,
) -> Option<Flag> {
    let stated = record.setting.stated_frequency_hz?;
    let allowed = (tolerance * stated).max(3.0 * drive.frequency_error_hz);
    ((drive.frequency_hz - stated).abs() > allowed).then(|| Flag {
        code: "drive_frequency_contradicts".into(),
        channel: Some(channel.into()),
        message: format!(
            "the drive channel shows {:.4} Hz, the campaign states {stated:.4} Hz{}",
            drive.frequency_hz,
            mistaken(stated / drive.frequency_hz)
                .map_or(String::new(), |m| format!(": the factor {m}"))
        ),
        remedy: "the measured frequency is used; correct the run table or the file's name".into(),
        excludes: false,
    })
}
