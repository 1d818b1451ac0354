//! Channels that are later than the drive's by whole samples: what they show is moved back by as many, so
//! that all channels of a record show an impact at one time. What is left of a delay is less than a sample.

use super::Record;
use super::calibrate::ChannelSetup;

/// Whole samples of a delay.
fn whole_samples(delay_s: f64, rate_hz: f64) -> i64 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a delay is less than a second, and the cast saturates"
    )]
    let samples = (delay_s * rate_hz).round() as i64;
    samples
}

/// What is left of a channel's delay, less that of its low-pass, when whole samples are removed, s.
pub fn remainder_s(setup: &ChannelSetup, rate_hz: f64) -> f64 {
    let removed_s = if rate_hz > 0.0 {
        whole_samples(setup.whole_delay_s(), rate_hz) as f64 / rate_hz
    } else {
        0.0
    };
    setup.delay_s - removed_s
}

/// Move each channel back by the whole samples of its delay; what not all channels hold any more is cut off.
pub(super) fn align(record: &mut Record, setups: &[ChannelSetup]) {
    let rate_hz = record.sample_rate_hz;
    let late_by = |role| {
        let setup = setups.iter().find(|s| s.role == role);
        setup.map_or(0, |s| whole_samples(s.whole_delay_s(), rate_hz))
    };
    let earliest = record.channels.iter().map(|c| late_by(c.role)).min();
    let latest = record.channels.iter().map(|c| late_by(c.role)).max();
    let (Some(earliest), Some(latest)) = (earliest, latest) else {
        return;
    };
    if earliest == 0 && latest == 0 {
        return;
    }
    for channel in &mut record.channels {
        let values = &mut channel.values;
        let before = usize::try_from(late_by(channel.role) - earliest).unwrap_or(0);
        let behind = usize::try_from(latest - late_by(channel.role)).unwrap_or(0);
        values.truncate(values.len().saturating_sub(behind));
        values.drain(..before.min(values.len()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::calibrate::ChannelKey;
    use crate::record::{LowPass, Role};

    #[test]
    fn channels_that_are_late_or_early_by_whole_samples_show_one_time() {
        let count = 20;
        let shown = |late: i32| -> Vec<f64> { (0..count).map(|i| f64::from(i - late)).collect() };
        let mut record = Record::of(
            2000.0,
            &[
                (Role::Drive, &shown(0)),
                (Role::VelocityX, &shown(3)),
                (Role::VelocityY, &shown(-1)),
            ],
        );
        let setup = |role, delay_s| ChannelSetup {
            delay_s,
            ..ChannelSetup::plain(role, ChannelKey::Index(0))
        };
        // 3.2 and −0.8 samples
        let setups = [
            setup(Role::VelocityX, 1.6e-3),
            setup(Role::VelocityY, -0.4e-3),
        ];
        align(&mut record, &setups);
        let drive = record.values(Role::Drive).expect("a drive").to_vec();
        assert_eq!(drive.len(), 16);
        for role in [Role::VelocityX, Role::VelocityY] {
            assert_eq!(record.values(role), Some(&drive[..]));
        }
        for setup in &setups {
            assert!((remainder_s(setup, 2000.0) - 0.1e-3).abs() < 1e-12);
        }
        // a low-pass of 0.7958 ms: two samples are removed, of which the filter explains all but 0.2042 ms
        let filtered = ChannelSetup {
            low_pass: Some(LowPass {
                corner_hz: 200.0,
                order: 1,
            }),
            ..setup(Role::VelocityX, 0.0)
        };
        assert!((remainder_s(&filtered, 2000.0) + 1e-3).abs() < 1e-12);
    }
}
