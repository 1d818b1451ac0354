//! Whether the motions contradict the clearances that the campaign states, all in the same way: by a factor,
//! as where whole gaps or another unit are stated, or by a shift, as where they are counted from another zero.
//!
//! Between two impacts the masses fly freely from the gap back to the gap. With f0, β and `x_st` of the impactless
//! records, the speed after an impact and the time to the next one tell the clearance ρ, whatever R is: the
//! displacement at the end, e0 + A ρ, is linear in the one at the start, so that ρ = e0/(1 − A).

use impact_oscillator::model::flight::{Drive, State, free_flight};

use crate::identify::diagnostics::doubt::{Doubt, Suspicion};
use impact_fit::evidence::Evidence;
use impact_fit::messages::{Finding, Note};
use impact_fit::parameters::{Coordinate, Parameters};
use impact_records::event::{Impact, RigKind};
use impact_records::motion::Observation;
use impact_records::record::Role;
use impact_records::signal::robust;

/// Records from which a contradiction is none of single rows of the run table.
const FEWEST: usize = 6;
/// Flights of a record whose median is taken.
const FEWEST_FLIGHTS: usize = 3;
/// Least |1 − A| at which a flight tells the clearance.
const LEAST_TELLING: f64 = 0.3;
/// Relative deviation that is none of gains, of single gaps and of contacts that take their time, which all
/// lengthen the flights.
const OFF: f64 = 0.35;
/// Relative deviation from the median within which most records have one cause.
const ONE_CAUSE: f64 = 0.2;
/// Least share of records that have it.
const MOST: f64 = 0.8;
/// Ratio of a clearance to a whole gap, and what contacts add to it at most.
const HALF: [f64; 2] = [0.45, 0.65];

/// That the stated clearances are all off alike, by fitted f0, β and `x_st`.
pub fn contradicted(evidence: &Evidence<'_>, fitted: &Parameters) -> Option<Finding> {
    found(evidence.rig, &stated_and_flown(evidence, fitted))
}

/// What flights tell each of some clearances to be more than stated, m, in the median record; zero where none tells it.
pub fn flown_errors_m(evidence: &Evidence<'_>, fitted: &Parameters, gaps_m: &[f64]) -> Vec<f64> {
    let pairs = stated_and_flown(evidence, fitted);
    let of = |gap_m: &f64| {
        let own = pairs.iter().filter(|[stated, _]| stated == gap_m);
        let errors: Vec<f64> = own.map(|[stated, flown]| flown - stated).collect();
        robust::median(&errors).unwrap_or(0.0)
    };
    gaps_m.iter().map(of).collect()
}

/// The clearance, m, of each record that tells it as it is stated and as the record's flights tell it.
fn stated_and_flown(evidence: &Evidence<'_>, fitted: &Parameters) -> Vec<[f64; 2]> {
    let flown_m = |o: &Observation| flown_m(evidence.rig, o, fitted);
    let of = |o: &Observation| Some([o.setting.clearance_m?, flown_m(o)?]);
    evidence.observations.iter().filter_map(of).collect()
}

/// The finding, and what it leaves open: where all clearances seem to be off by one factor, the scales of the channels
/// may be, and with them `x_st`; where no stated frequency confirms the time, that may be too, and with it f0.
pub fn suspicion(finding: Finding, observations: &[Observation]) -> Suspicion {
    let open = |ratio: f64| {
        move |parameter| Doubt {
            parameter,
            by: ratio.ln().abs(),
            note: Note::InstrumentOff,
        }
    };
    let doubts = match finding {
        Finding::ClearancesOffAlike { ratio, .. } => {
            let time = time_scales_motion(observations).then_some(Coordinate::Frequency);
            let parameters = std::iter::once(Coordinate::Deflection).chain(time);
            parameters.map(open(ratio)).collect()
        }
        _ => Vec::new(),
    };
    Suspicion { finding, doubts }
}

/// Whether a time axis that is off by a factor would scale all motions: they are integrated from velocities or
/// accelerations, and no record states its frequency.
fn time_scales_motion(observations: &[Observation]) -> bool {
    let states = |o: &Observation| o.setting.stated_frequency_hz.is_some();
    let displacement = |role| matches!(role, Role::DisplacementX | Role::DisplacementY);
    let measures = |o: &Observation| {
        let roles = [false, true].map(|of_y| o.speed_from(of_y));
        roles.into_iter().flatten().any(displacement)
    };
    !observations.iter().any(|o| states(o) || measures(o))
}

/// What pairs of stated and flown clearances, m, have in common where it is not that they are alike.
fn found(rig: RigKind, pairs: &[[f64; 2]]) -> Option<Finding> {
    let records = pairs.len();
    let median = |value: fn(&[f64; 2]) -> f64| {
        robust::median(&pairs.iter().map(value).collect::<Vec<f64>>())
    };
    let (ratio, added_m) = (median(|[s, f]| f / s)?, median(|[s, f]| f - s)?);
    let off = |[stated, flown]: &[f64; 2]| (flown / stated - 1.0).abs() > OFF;
    let share = |holds: &dyn Fn(&[f64; 2]) -> bool| {
        pairs.iter().filter(|pair| holds(pair)).count() as f64 / records as f64
    };
    if records < FEWEST || share(&off) < MOST {
        return None;
    }
    let near = |value: f64, expected: f64| (value / expected - 1.0).abs() < ONE_CAUSE;
    let multiplied = share(&|[stated, flown]| near(*flown, ratio * stated));
    let shifted = share(&|[stated, flown]| near(*flown, stated + added_m));
    if multiplied.max(shifted) < MOST {
        return None;
    }
    Some(if shifted > multiplied {
        Finding::ClearancesShifted { added_m, records }
    } else if rig == RigKind::Double && (HALF[0]..HALF[1]).contains(&ratio) {
        Finding::WholeGapsStated { ratio, records }
    } else {
        Finding::ClearancesOffAlike { ratio, records }
    })
}

/// The clearance, m, as the flights of a record tell it.
fn flown_m(rig: RigKind, o: &Observation, fitted: &Parameters) -> Option<f64> {
    let drive = o.drive?;
    if o.excluded() || o.impacts.iter().any(|i| i.dead_zone_s > 0.0) {
        return None;
    }
    let length_m = fitted.static_deflection_m * o.setting.drive_amplitude;
    let flights = o.impacts.windows(2);
    let clearances: Vec<f64> = flights
        .filter_map(|pair| {
            let flight = Flight::between(rig, &pair[0], &pair[1])?;
            flight.clearance(fitted, drive.frequency_hz, length_m)
        })
        .collect();
    let enough = clearances.len() >= FEWEST_FLIGHTS;
    Some(length_m * robust::median(&clearances).filter(|_| enough)?)
}

/// The flight of one mass from an impact to the next.
struct Flight {
    duration_s: f64,
    phase_rad: f64,
    /// Its speed toward the other mass at the start, m/s.
    speed_m_s: f64,
}

impl Flight {
    fn between(rig: RigKind, from: &Impact, to: &Impact) -> Option<Self> {
        let masses = match rig {
            RigKind::Double => 2.0,
            RigKind::Single => 1.0,
        };
        Some(Self {
            duration_s: to.time_s - from.time_s,
            phase_rad: from.drive_phase_rad?,
            speed_m_s: from.approach_speed_after_m_s? / masses,
        })
    }

    /// The clearance from which it leads back to itself, over a length; `None` where it hardly tells.
    fn clearance(&self, fitted: &Parameters, frequency_hz: f64, length_m: f64) -> Option<f64> {
        let rate = fitted.natural_rate();
        let machine = fitted.without_asymmetry().machine(RigKind::Single);
        let drive = Drive {
            eta: frequency_hz / fitted.natural_frequency_hz,
            phase: self.phase_rad,
        };
        let end = |x: f64| {
            let vx = self.speed_m_s / (length_m * rate);
            let start = State {
                x,
                vx,
                ..State::default()
            };
            free_flight(&machine, drive, &start)
                .at(self.duration_s * rate)
                .x
        };
        let telling = 1.0 - (end(1.0) - end(0.0));
        (telling.abs() > LEAST_TELLING).then(|| end(0.0) / telling)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::motion::Motion;

    fn pairs(flown: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        let stated = (1..9).map(|i| 5e-4 * f64::from(i));
        stated.map(|s| [s, flown(s)]).collect()
    }

    #[test]
    fn what_clearances_have_in_common_is_told_apart() {
        assert_eq!(found(RigKind::Double, &pairs(|s| 1.1 * s)), None);
        // one of eight is off
        assert_eq!(
            found(
                RigKind::Double,
                &pairs(|s| if s > 3.9e-3 { 2.0 * s } else { s })
            ),
            None
        );
        let halves = Finding::WholeGapsStated {
            ratio: 0.5,
            records: 8,
        };
        assert_eq!(found(RigKind::Double, &pairs(|s| 0.5 * s)), Some(halves));
        // a mass and a stop have one gap
        let alike = Finding::ClearancesOffAlike {
            ratio: 0.5,
            records: 8,
        };
        assert_eq!(found(RigKind::Single, &pairs(|s| 0.5 * s)), Some(alike));
        let Some(Finding::ClearancesOffAlike { ratio, records: 8 }) =
            found(RigKind::Double, &pairs(|s| 1e3 * s))
        else {
            panic!("another unit is not found");
        };
        assert!((ratio - 1e3).abs() < 1e-9);
        let Some(Finding::ClearancesShifted {
            added_m,
            records: 8,
        }) = found(RigKind::Double, &pairs(|s| s + 3e-3))
        else {
            panic!("another zero is not found");
        };
        assert!((added_m - 3e-3).abs() < 1e-12);
        // nothing in common
        assert_eq!(
            found(
                RigKind::Double,
                &pairs(|s| if s < 2.2e-3 { 0.3 * s } else { 4.0 * s })
            ),
            None
        );
    }

    #[test]
    fn a_factor_may_be_that_of_the_channels_scales_and_a_shift_is_not() {
        let alike = Finding::ClearancesOffAlike {
            ratio: 1e-3,
            records: 8,
        };
        let mut observation = Observation::of("r", 12.0, Motion::Impactless);
        let open = |o: &Observation| {
            let doubts = suspicion(alike.clone(), std::slice::from_ref(o)).doubts;
            assert!(doubts.iter().all(|d| (d.by - 1000f64.ln()).abs() < 1e-12));
            doubts.iter().map(|d| d.parameter).collect::<Vec<_>>()
        };
        // without a stated frequency the time may be off instead
        observation.setting.stated_frequency_hz = None;
        assert_eq!(
            open(&observation),
            [Coordinate::Deflection, Coordinate::Frequency]
        );
        observation.setting.stated_frequency_hz = Some(12.0);
        assert_eq!(open(&observation), [Coordinate::Deflection]);
        let shifted = Finding::ClearancesShifted {
            added_m: 1e-3,
            records: 8,
        };
        assert_eq!(suspicion(shifted, &[]).doubts, []);
    }

    #[test]
    fn valid_a_flight_of_the_model_tells_its_clearance() {
        let fitted = Parameters::symmetric(0.8, 12.0, 0.05, 2e-3);
        let machine = fitted.machine(RigKind::Single);
        let (eta, phase, clearance, speed) = (0.9, 1.2, 0.7, -1.5);
        let start = State {
            x: clearance,
            vx: speed,
            ..State::default()
        };
        let paths = free_flight(&machine, Drive { eta, phase }, &start);
        let gap = |t: f64| clearance - paths.at(t).x;
        // it leaves the gap at once; the next time that it is back is found by bisection
        let step = (1..100_000).map(|i| 1e-3 * f64::from(i));
        let after = step.into_iter().find(|t| gap(*t) < 0.0).expect("an impact");
        let (mut low, mut high) = (after - 1e-3, after);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if gap(middle) < 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        let flight = Flight {
            duration_s: high / fitted.natural_rate(),
            phase_rad: phase,
            speed_m_s: speed * fitted.static_deflection_m * fitted.natural_rate(),
        };
        let told = flight.clearance(&fitted, eta * fitted.natural_frequency_hz, 2e-3);
        assert!((told.expect("a telling flight") - clearance).abs() < 1e-9);
    }
}
