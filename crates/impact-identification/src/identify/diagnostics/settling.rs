//! Whether a campaign's records begin before their motions have settled, and how long to wait.

use impact_fit::estimate::ParameterSet;
use impact_fit::messages::Finding;
use impact_fit::statistics::quantile::NORMAL_975;
use impact_records::motion::Observation;
use impact_records::signal::robust;

/// Fewest records, and the least share of a campaign's, that are more than single slow motions near a
/// boundary.
const FEWEST: usize = 3;
const LEAST_SHARE: f64 = 0.05;
/// Part of a disturbance that may be left when a record begins.
const LEFT: f64 = 1e-3;

/// That motions of many records die toward others while they are recorded. A disturbance decays like
/// e^(−2πβ f0 t); the wait is what leaves a thousandth of it or, where β or f0 is not known, as long as a
/// record.
pub fn not_settled(observations: &[Observation], parameters: &ParameterSet) -> Option<Finding> {
    let seen: Vec<&Observation> = observations
        .iter()
        .filter(|o| !o.excluded() && o.classification.evidence.waveform_closure.is_some())
        .collect();
    let settling = seen
        .iter()
        .filter(|o| o.classification.evidence.settling.is_some());
    let records = settling.count();
    let growing = seen
        .iter()
        .filter(|o| o.classification.evidence.growing.is_some());
    let wander = wander(records, growing.count());
    if records < FEWEST || (records as f64) < LEAST_SHARE * seen.len() as f64 || wander {
        return None;
    }
    let value = |estimate: &Option<impact_fit::Estimate>| estimate.as_ref()?.value;
    let rate = value(&parameters.natural_frequency_hz).zip(value(&parameters.damping_ratio));
    let durations: Vec<f64> = seen.iter().map(|o| o.duration_s).collect();
    let wait_s = match rate {
        Some((f0, beta)) => -LEFT.ln() / (std::f64::consts::TAU * beta * f0),
        None => robust::median(&durations)?,
    };
    Some(Finding::RecordsNotSettled {
        records,
        of: seen.len(),
        wait_s,
    })
}

/// Whether disturbances die away no more often than they grow, by the sign test with continuity: of motions that wander, as
/// where R scatters, by chance as many do either, and of motions that have not settled hardly any grows. Kinds `unsettled`
/// and `scatter` of `tests/scripts`, seeds 66001 to 66010: 690 to 4 and 18 to 27.
fn wander(dying: usize, growing: usize) -> bool {
    let [dying, growing] = [dying as f64, growing as f64];
    growing > 0.0 && dying - growing - 1.0 < NORMAL_975 * (dying + growing).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_fit::estimate::estimate;
    use impact_fit::parameters::Coordinate;
    use impact_records::motion::Motion;

    fn observed(settling: Option<f64>) -> Observation {
        let mut o = Observation::of("r", 12.0, Motion::Impactless);
        o.classification.evidence.waveform_closure = Some(0.01);
        o.classification.evidence.settling = settling;
        o
    }

    #[test]
    fn many_records_that_begin_too_early_are_a_finding_and_single_ones_are_not() {
        let of = |settling: usize, settled: usize, parameters: &ParameterSet| {
            let early = (0..settling).map(|_| observed(Some(0.05)));
            let all: Vec<Observation> = early.chain((0..settled).map(|_| observed(None))).collect();
            not_settled(&all, parameters)
        };
        let unknown = ParameterSet::default();
        assert_eq!(of(2, 10, &unknown), None);
        assert_eq!(of(3, 97, &unknown), None);
        let early = |wait_s: f64| Finding::RecordsNotSettled {
            records: 3,
            of: 12,
            wait_s,
        };
        assert_eq!(of(3, 9, &unknown), Some(early(1.0)));
        // as many grow: motions wander
        let mut wandering: Vec<Observation> = (0..8).map(|_| observed(Some(0.05))).collect();
        wandering.extend((0..6).map(|_| observed(None)));
        for o in wandering.iter_mut().skip(8) {
            o.classification.evidence.growing = Some(0.05);
        }
        assert_eq!(not_settled(&wandering, &unknown), None);
        // a thousandth is left after ln 1000 over 2π · 0.05 · 10 Hz: 2.199 s
        let known = ParameterSet {
            natural_frequency_hz: Some(estimate(Coordinate::Frequency, 10f64.ln(), 1e-3)),
            damping_ratio: Some(estimate(Coordinate::Damping, 0.05f64.ln(), 1e-3)),
            ..ParameterSet::default()
        };
        let Some(Finding::RecordsNotSettled { wait_s, .. }) = of(3, 9, &known) else {
            panic!("none");
        };
        assert!((wait_s - 2.198_806).abs() < 1e-6, "{wait_s}");
        assert_eq!(
            early(2.2).to_string(),
            "3 of 12 records begin before their motion has settled, so that their motions are not \
             known, or named less surely: wait at least 2.2 s after each change of a setting before \
             recording"
        );
    }
}
