//! A driving force that rises with a power of the frequency, which the drive's channel does not show.

use serde::{Deserialize, Serialize};

use super::observation::Observation;

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

/// Let the drive amplitudes of all records follow a law, beside what is stated or measured of them.
pub fn follow_force_law(observations: &mut [Observation], law: ForceLaw) {
    for o in observations {
        o.force_law = Some(law);
        o.setting.drive_amplitude *= o.force_factor();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Motion, scale_drives};

    #[test]
    fn amplitudes_follow_the_law_however_often_they_are_scaled() {
        let at = |hz: f64| Observation::of("r", hz, Motion::Impactless);
        let mut all = [at(10.0), at(20.0)];
        let law = ForceLaw {
            power: 2.0,
            at_hz: 10.0,
        };
        follow_force_law(&mut all, law);
        scale_drives(&mut all);
        let amplitudes = all.map(|o| o.setting.drive_amplitude);
        assert!((amplitudes[0] - 1.0).abs() < 1e-12 && (amplitudes[1] - 4.0).abs() < 1e-12);
    }
}
