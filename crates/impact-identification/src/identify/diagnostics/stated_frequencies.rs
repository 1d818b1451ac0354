//! Whether the drive's frequencies contradict those that the campaign states, in most of its records, or no
//! drive was measured.

use impact_fit::messages::Finding;
use impact_records::motion::Observation;
use impact_records::record::FlagCode;
use impact_records::signal::robust;

/// Records from which a contradiction is none of single rows of the run table.
const FEWEST: usize = 3;
/// Relative spread of the ratios of frequencies that have one cause.
const ONE_CAUSE: f64 = 5e-3;

/// That no record that states a frequency shows its drive.
pub fn no_drive(observations: &[Observation]) -> Option<Finding> {
    let stating = observations
        .iter()
        .filter(|o| o.setting.stated_frequency_hz.is_some());
    let records = stating.clone().count();
    let with_tone = stating.clone().filter(|o| o.motion_tone.is_some()).count();
    let none = records > 0 && stating.into_iter().all(|o| o.drive.is_none());
    none.then_some(match with_tone {
        0 => Finding::DriveNotMeasured { records },
        records => Finding::PhaseNotMeasured { records },
    })
}

/// That more than half of the records that state a frequency are driven at another one.
pub fn contradicted(observations: &[Observation]) -> Option<Finding> {
    let ratio = |o: &Observation| Some(o.drive?.frequency_hz / o.setting.stated_frequency_hz?);
    let compared = observations.iter().filter_map(|o| Some((o, ratio(o)?)));
    let of = compared.clone().count();
    let off = |o: &Observation| o.has_flag(FlagCode::DriveFrequencyContradicts);
    let ratios: Vec<f64> = compared.filter(|(o, _)| off(o)).map(|(_, r)| r).collect();
    let records = ratios.len();
    if records < FEWEST || 2 * records <= of {
        return None;
    }
    let ratio = robust::median(&ratios)?;
    let alike = ratios.iter().all(|r| (r / ratio - 1.0).abs() < ONE_CAUSE);
    Some(if alike {
        Finding::FrequenciesOffAlike { ratio, records, of }
    } else {
        Finding::FrequenciesOff { records, of }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::run::identify;
    use impact_fit::fixture::{evidence, observed as observed_all, recorded};
    use impact_fit::parameters::Coordinate;
    use impact_records::event::DriveTone;
    use impact_records::motion::Motion;
    use impact_records::record::{Flag, Problem, Role};
    use impact_records::signal::tone;

    fn observed(stated_hz: f64, frequency_hz: f64) -> Observation {
        let mut o = Observation::of("r", stated_hz, Motion::Impactless);
        o.setting.stated_frequency_hz = Some(stated_hz);
        o.drive = Some(DriveTone::at(frequency_hz, 1.0));
        if stated_hz != frequency_hz {
            let problem = Problem::FrequencyUnlikeStated {
                measured_hz: frequency_hz,
                stated_hz,
            };
            o.flags.push(Flag::new(None, problem));
        }
        o
    }

    #[test]
    fn frequencies_that_are_off_in_most_records_are_found() {
        let of = |pairs: &[[f64; 2]]| {
            let all: Vec<Observation> = pairs.iter().map(|[s, f]| observed(*s, *f)).collect();
            contradicted(&all)
        };
        let one_slip = [[8.0, 8.0], [9.0, 9.0], [10.0, 12.5], [11.0, 11.0]];
        assert_eq!(of(&one_slip), None);
        let faster = [[8.0, 10.0], [10.0, 12.5], [12.0, 15.0], [13.0, 13.0]];
        let alike = Finding::FrequenciesOffAlike {
            ratio: 1.25,
            records: 3,
            of: 4,
        };
        assert_eq!(of(&faster), Some(alike));
        assert_eq!(no_drive(&[observed(8.0, 8.0)]), None);
        let mut unseen = observed(8.0, 8.0);
        unseen.drive = None;
        let none = Finding::DriveNotMeasured { records: 1 };
        assert_eq!(no_drive(std::slice::from_ref(&unseen)), Some(none));
        unseen.motion_tone = observed(8.0, 8.0).drive;
        let phase = Finding::PhaseNotMeasured { records: 1 };
        assert_eq!(no_drive(&[unseen]), Some(phase));
        let shuffled = [[8.0, 12.0], [10.0, 8.0], [12.0, 10.0]];
        let differ = Finding::FrequenciesOff { records: 3, of: 3 };
        assert_eq!(of(&shuffled), Some(differ));
    }

    #[test]
    fn valid_amplitudes_at_stated_frequencies_tell_f0_beta_and_the_deflection() {
        let mut records = recorded(0.8, 12.0, 80, 21);
        for record in &mut records {
            let drive = record
                .values(Role::Drive)
                .map(|v| tone::fit(v, record.sample_rate_hz));
            let found = drive.flatten().expect("a drive").frequency_hz;
            record.setting.stated_frequency_hz = Some((1e3 * found).round() / 1e3);
            record.channels.retain(|c| c.role != Role::Drive);
        }
        let observations = observed_all(&records);
        let found = identify(&evidence(&observations));
        let phase = |f: &Finding| matches!(f, Finding::PhaseNotMeasured { .. });
        assert!(found.suspicions.iter().any(phase), "{:?}", found.suspicions);
        for (parameter, truth) in [
            (Coordinate::Frequency, 12.0),
            (Coordinate::Damping, 0.06),
            (Coordinate::Deflection, 1e-3),
            (Coordinate::Restitution, 0.8),
        ] {
            let estimate = found.joint.parameters.get(parameter).expect("an estimate");
            let [low, high] = estimate.interval95.expect("an interval");
            let half = 0.5 * (high - low);
            let apart = (estimate.value.expect("a value") - truth).abs();
            assert!(
                apart < 1.5 * half && half < 0.3 * truth,
                "{parameter:?}: {estimate:?}"
            );
        }
    }
}
