//! A channel and what of the motion it shows.

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
}

impl<'a> Watched<'a> {
    /// Samples of a displacement, or of what is proportional to it.
    pub fn displacement(values: &'a [f64]) -> Self {
        Self {
            values,
            quantity: MotionSignal::Displacement,
        }
    }
}
