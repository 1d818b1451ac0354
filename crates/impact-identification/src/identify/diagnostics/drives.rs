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
    let others = [not_of_the_force(observations), amplitudes(observations)];
    law.into_iter()
        .chain(others.into_iter().flatten())
        .collect()
}

/// That the motion does not follow the recorded drive.
fn not_of_the_force(observations: &[Observation]) -> Option<Finding> {
    let used = || observations.iter().filter(|o| !o.excluded());
    let records = used().filter(|o| o.drives_as_stated()).count();
    (records > 0).then(|| Finding::DriveNotOfTheForce {
        records,
        of: used().count(),
    })
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
    use impact_records::record::{Flag, Problem};

    #[test]
    fn drives_that_the_motion_does_not_follow_are_counted() {
        let contradicted = |used: f64| {
            let mut o = Observation::of("r", 12.0, Motion::Impactless);
            let problem = Problem::AmplitudeUnlikeStated {
                measured: 1.0,
                stated: 1.5,
            };
            o.flags.push(Flag::new(None, problem).excluding(false));
            o.setting.drive_amplitude = used;
            o
        };
        let found = |used: [f64; 3]| not_of_the_force(&used.map(contradicted));
        assert_eq!(found([1.0; 3]), None);
        let named = Finding::DriveNotOfTheForce { records: 2, of: 3 };
        assert_eq!(found([1.5, 1.0, 1.5]), Some(named));
    }

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
