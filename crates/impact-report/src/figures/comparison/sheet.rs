//! The sheet on which a comparison is drawn.

use crate::kit::axis::Axis;
use crate::kit::canvas::Canvas;
use crate::kit::look;
use crate::locale::Locale;
use crate::phrase::Phrase;
use impact_identification::replay::ReplayedRecord;

/// Left edge of the phase portraits, points.
pub(super) const PORTRAIT_LEFT: f64 = 387.0;
/// Width of a phase portrait, points.
pub(super) const PORTRAIT_WIDTH: f64 = look::FULL_WIDTH - PORTRAIT_LEFT - 2.0;
/// Room above the panels, for letter and titles, points.
pub(super) const TOP: f64 = 13.0;
/// Width of the simulated curve behind the measured one, points.
pub(super) const BACK_WIDTH: f64 = 1.7;

/// The time in drive periods.
pub(super) struct TimeAxis {
    pub(super) start: f64,
    pub(super) period: f64,
    pub(super) shown: (f64, f64),
}

impl TimeAxis {
    pub(super) fn axis(&self) -> Axis {
        Axis::new(self.shown.0, self.shown.1, Phrase::TimeInDrivePeriods).with_ticks(5)
    }

    pub(super) fn of(&self, time_s: f64) -> f64 {
        (time_s - self.start) / self.period
    }
}

/// A comparison and the canvas that it is drawn on.
pub(super) struct Sheet<'a> {
    pub(super) comparison: &'a ReplayedRecord,
    pub(super) locale: Locale<'a>,
    pub(super) canvas: Canvas,
    pub(super) time: TimeAxis,
    pub(super) column: f64,
}
