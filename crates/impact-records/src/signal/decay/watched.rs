//! A channel and what of the motion it shows.

use std::ops::Range;

/// What of a motion a channel shows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum MotionSignal {
    /// Displacement, or what is proportional to it.
    #[default]
    Displacement,
    /// Velocity.
    Velocity,
    /// Acceleration.
    Acceleration,
}

/// The samples of a channel and what of the motion they are.
#[derive(Debug, Clone, Copy)]
pub struct Watched<'a> {
    /// Samples.
    pub values: &'a [f64],
    /// What they are.
    pub quantity: MotionSignal,
    /// The values beyond which the samples are clipped, the lower one first, where they are.
    pub rails: Option<[f64; 2]>,
}

impl<'a> Watched<'a> {
    /// Samples of a displacement, or of what is proportional to it.
    pub fn displacement(values: &'a [f64]) -> Self {
        Self {
            values,
            quantity: MotionSignal::Displacement,
            rails: None,
        }
    }

    /// The first sample after the last clipped one of a part; its own first sample where none is.
    pub(super) fn clear_from(&self, part: Range<usize>) -> usize {
        let first = part.start;
        let Some([low, high]) = self.rails else {
            return first;
        };
        let clipped = |v: &f64| *v <= low || *v >= high;
        let at = self.values[part].iter().rposition(clipped);
        at.map_or(first, |at| first + at + 1)
    }
}
