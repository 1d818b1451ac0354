//! One impact as multiple shooting takes it.

use crate::parameters::Parameters;
use impact_records::event::CornerShift;

/// One impact as it was measured, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Time since the record's first sample, s.
    pub time_s: f64,
    /// Its standard error, s.
    pub time_error_s: f64,
    /// Phase of the drive, rad.
    pub drive_phase_rad: f64,
    /// Speeds of x and y before, m/s; where only their sum is known, that and zero.
    pub before_m_s: [f64; 2],
    /// Speeds of x and y after, m/s, likewise.
    pub after_m_s: [f64; 2],
    /// Standard error of each speed, m/s.
    pub error_m_s: f64,
    /// What of it is noise, m/s.
    pub noise_m_s: f64,
    /// What the channels' corners would change of the speeds of x and of y.
    pub corner_shifts: [Option<CornerShift>; 2],
}

impl Node {
    /// Speeds of x and y before and after, m/s, with the corners that the channels have; `together`: their sum.
    pub(super) fn speeds_m_s(&self, parameters: &Parameters, together: bool) -> [[f64; 2]; 2] {
        let shifts = self
            .corner_shifts
            .map(|shift| shift.map_or(0.0, |s| parameters.corner_shift_m_s(&s)));
        let shifts = if together {
            [shifts[0] + shifts[1], 0.0]
        } else {
            shifts
        };
        [self.before_m_s, self.after_m_s].map(|speeds| [0, 1].map(|m| speeds[m] + shifts[m]))
    }
}
