//! A recorded motion: steps with the motion's derivatives at both ends, and its impacts.

use crate::equations::Phase4;

/// One impact: dimensionless time since the recording began and speeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Time of first touch.
    pub tau: f64,
    /// Approach speed at first touch.
    pub approach: f64,
    /// Separation speed at the end of contact.
    pub separation: f64,
    /// How long the contact lasts, without a dead zone.
    pub duration: f64,
    /// How long the masses stay together in a dead zone; zero without one, infinite if it has not ended.
    pub dead_zone: f64,
}

/// A step with the motion's derivatives at both ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    pub(super) tau: f64,
    pub(super) length: f64,
    pub(super) from: Phase4,
    pub(super) from_rate: Phase4,
    pub(super) to: Phase4,
    pub(super) to_rate: Phase4,
}

impl Segment {
    /// Cubic Hermite interpolation.
    pub(super) fn at(&self, tau: f64) -> Phase4 {
        let t = ((tau - self.tau) / self.length.max(1e-300)).clamp(0.0, 1.0);
        let (a, b) = (t * t * (3.0 - 2.0 * t), t * (1.0 - t));
        std::array::from_fn(|i| {
            (1.0 - a) * self.from[i]
                + a * self.to[i]
                + self.length * b * ((1.0 - t) * self.from_rate[i] - t * self.to_rate[i])
        })
    }
}

/// A recorded motion.
#[derive(Debug, Clone, Default)]
pub struct Recording {
    pub(super) segments: Vec<Segment>,
    /// Impacts that began while recording.
    pub hits: Vec<Hit>,
}

impl Recording {
    /// The motion at many times in rising order.
    pub fn sample(&self, taus: impl IntoIterator<Item = f64>) -> Vec<Phase4> {
        let mut k = 0;
        let at = |tau: f64| {
            while k + 1 < self.segments.len() && self.segments[k + 1].tau <= tau {
                k += 1;
            }
            self.segments.get(k).map_or([0.0; 4], |s| s.at(tau))
        };
        taus.into_iter().map(at).collect()
    }
}
