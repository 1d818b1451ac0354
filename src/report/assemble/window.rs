//! The stretch of a record that is drawn.

use crate::event::{Detection, DriveTone};
use crate::report::content::Signal;

/// The stretch of a record that is drawn: it begins at a zero phase of the drive.
pub(super) struct Window {
    /// Its start, s into the record.
    pub(super) start_s: f64,
    /// Its length, s.
    pub(super) length_s: f64,
    rate_hz: f64,
}

impl Window {
    pub(super) fn new(detection: &Detection, drive: &DriveTone, periods: f64) -> Self {
        let rate_hz = detection.kinematics.rate_hz;
        let period = drive.period_s();
        let start_s = period * (1.0 - drive.phase_at(0.0) / std::f64::consts::TAU);
        Self {
            start_s,
            length_s: periods * period,
            rate_hz,
        }
    }

    fn range(&self, samples: usize) -> std::ops::Range<usize> {
        let first = (self.start_s * self.rate_hz).ceil() as usize;
        let last = ((self.start_s + self.length_s) * self.rate_hz).floor() as usize + 1;
        first.min(samples)..last.min(samples)
    }

    pub(super) fn signal(&self, values: &[f64]) -> Signal {
        let range = self.range(values.len());
        Signal {
            time_s: range
                .clone()
                .map(|i| i as f64 / self.rate_hz - self.start_s)
                .collect(),
            values: values[range].to_vec(),
        }
    }
}
