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

/// Values beyond which samples are clipped, as they were recorded: a drift may be taken from the samples since.
#[derive(Debug, Clone, Copy)]
pub struct Rails<'a> {
    /// The samples as recorded.
    pub recorded: &'a [f64],
    /// The lower value.
    pub low: f64,
    /// The upper value.
    pub high: f64,
}

/// The samples of a channel and what of the motion they are.
#[derive(Debug, Clone, Copy)]
pub struct Watched<'a> {
    /// Samples.
    pub values: &'a [f64],
    /// What they are.
    pub quantity: MotionSignal,
    /// Where they are clipped, if they are.
    pub rails: Option<Rails<'a>>,
}

impl<'a> Watched<'a> {
    /// Samples that are not clipped.
    pub fn new(values: &'a [f64], quantity: MotionSignal) -> Self {
        Self {
            values,
            quantity,
            rails: None,
        }
    }

    /// Samples of a displacement, or of what is proportional to it.
    pub fn displacement(values: &'a [f64]) -> Self {
        Self::new(values, MotionSignal::Displacement)
    }

    /// The first sample after the last clipped one of a part; its own first sample where none is.
    pub(super) fn clear_from(&self, part: Range<usize>) -> usize {
        let first = part.start;
        let Some(rails) = self.rails else {
            return first;
        };
        let clipped = |v: &f64| *v <= rails.low || *v >= rails.high;
        let at = rails.recorded[part].iter().rposition(clipped);
        at.map_or(first, |at| first + at + 1)
    }
}
