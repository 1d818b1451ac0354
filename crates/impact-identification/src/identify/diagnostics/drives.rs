//! What of the drives of the records decides what `x_st` refers to.

use impact_fit::messages::Finding;
use impact_records::motion::{ForceLaw, Observation};

/// Relative difference of drive amplitudes, and from the one to which `x_st` refers, from which it is said.
const ALIKE: f64 = 0.1;

/// The law of the force that the resonance curve shows, and that the records' drives are not the one to which `x_st`
/// refers.
pub fn drives(observations: &[Observation]) -> Vec<Finding> {
    let law = observations.first().and_then(|o| o.force_law);
    let law = law.map(|ForceLaw { power, at_hz }| Finding::ForceLaw { power, at_hz });
    law.into_iter().chain(amplitudes(observations)).collect()
}

/// That the drive amplitudes differ, or are others than the one to which `x_st` refers.
fn amplitudes(observations: &[Observation]) -> Option<Finding> {
    let used = observations.iter().filter(|o| !o.excluded());
    let relative = used.map(Observation::stated_drive);
    let [lowest, highest] = relative.fold([f64::INFINITY, 0.0], |[low, high], a| {
        [f64::min(low, a), f64::max(high, a)]
    });
    let unlike = lowest < 1.0 - ALIKE || highest > 1.0 + ALIKE;
    (highest > 0.0 && unlike).then_some(Finding::DriveAmplitudes { lowest, highest })
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::motion::Motion;

    #[test]
    fn drives_that_differ_are_named_beside_that_of_the_deflection() {
        let of = |amplitudes: &[f64]| {
            let one = |amplitude: &f64| {
                let mut o = Observation::of("r", 12.0, Motion::Impactless);
                o.setting.drive_amplitude = *amplitude;
                o
            };
            drives(&amplitudes.iter().map(one).collect::<Vec<_>>())
        };
        assert_eq!(of(&[1.0, 0.98, 1.03]), []);
        let [lowest, highest] = [0.5, 1.0];
        assert_eq!(
            of(&[0.5, 1.0]),
            [Finding::DriveAmplitudes { lowest, highest }]
        );
        // volts instead of amplitudes relative to the nominal one
        let [lowest, highest] = [3.0, 3.0];
        assert_eq!(
            of(&[3.0, 3.0]),
            [Finding::DriveAmplitudes { lowest, highest }]
        );
    }
}
