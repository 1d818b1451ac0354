//! A driving force that rises with a power of the frequency, which the drive's channel does not show.

use serde::{Deserialize, Serialize};

/// A force of the amplitude (f/f₁)^p: p = 2 of a rotating unbalance, −1 of a coil on a constant voltage.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ForceLaw {
    /// The power p.
    pub power: f64,
    /// The frequency f₁ to which the amplitude refers, Hz.
    pub at_hz: f64,
}

impl ForceLaw {
    /// The force at a frequency over that at `at_hz`.
    pub fn factor(&self, frequency_hz: f64) -> f64 {
        (frequency_hz / self.at_hz).powf(self.power)
    }
}
