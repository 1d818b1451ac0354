//! Whether the motions of most records are not known.

use impact_fit::messages::Finding;
use impact_records::motion::{Motion, Observation, Undetermined};

/// That the motions of most records were driven long enough and have settled, but neither repeat nor are irregular: what the channels show is not the motion alone, and the few other records are no sample of the campaign.
pub fn undetermined_motions(observations: &[Observation]) -> Option<Finding> {
    let usable = observations.iter().filter(|o| !o.excluded());
    let motions: Vec<&Motion> = usable.map(|o| &o.classification.motion).collect();
    let records = motions.iter().filter(|m| is_disturbed(m)).count();
    (2 * records > motions.len()).then_some(Finding::MotionsUndetermined {
        records,
        of: motions.len(),
    })
}

/// Whether a motion that was compared with itself is not known.
fn is_disturbed(motion: &Motion) -> bool {
    use Undetermined::{ImpactsDoNotRepeat, NearlyCloses, NoWholePeriod, TooManyImpacts};
    let Motion::Undetermined { reason } = motion else {
        return false;
    };
    matches!(
        reason,
        NearlyCloses { .. } | ImpactsDoNotRepeat { .. } | TooManyImpacts { .. } | NoWholePeriod
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_of_most_records_that_nearly_close_are_a_finding() {
        let of = |disturbed: usize, reason: Undetermined| {
            let motion = |i: usize| match i < disturbed {
                true => Motion::Undetermined {
                    reason: reason.clone(),
                },
                false => Motion::Impactless,
            };
            let all: Vec<Observation> = (0..20)
                .map(|i| Observation::of("r", 10.0, motion(i)))
                .collect();
            undetermined_motions(&all)
        };
        let nearly = Undetermined::NearlyCloses { periods_n: 3 };
        let found = Finding::MotionsUndetermined {
            records: 11,
            of: 20,
        };
        assert_eq!(of(11, nearly.clone()), Some(found));
        assert_eq!(of(10, nearly), None);
        assert_eq!(of(20, Undetermined::NotSettled), None);
        assert_eq!(of(20, Undetermined::NoDrive), None);
    }
}
