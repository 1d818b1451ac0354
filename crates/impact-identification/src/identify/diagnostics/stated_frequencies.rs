//! Whether the drive's frequencies contradict those that the campaign states, in most of its records, or no
//! drive was measured.

use impact_fit::messages::Finding;
use impact_records::motion::Observation;
use impact_records::record::{FlagCode, Role};
use impact_records::signal::robust;

/// Records from which a contradiction is none of single rows of the run table.
const FEWEST: usize = 3;
/// Relative spread of the ratios of frequencies that have one cause.
const ONE_CAUSE: f64 = 5e-3;

/// Rows of the run table between a record's own and that whose frequency it has.
const SHIFTS: [isize; 4] = [-2, -1, 1, 2];
/// Records from which a shift is none of rows that were exchanged.
const FEWEST_SHIFTED: usize = 4;
/// How much closer the frequency of the other row is than that of the own one: rows that no shift explains are
/// seldom that close to another row, and never several one after the other.
const CLOSER: f64 = 5.0;
/// Standard errors that a measured frequency may be off.
const SURE: f64 = 3.0;

/// That no record that states a frequency shows its drive.
pub fn no_drive(observations: &[Observation]) -> Option<Finding> {
    let stating = observations
        .iter()
        .filter(|o| o.setting.stated_frequency_hz.is_some());
    let records = stating.clone().count();
    let with_tone = stating.clone().filter(|o| o.motion_tone.is_some()).count();
    let none = records > 0
        && stating
            .into_iter()
            .all(|o| o.drive.is_none() && !left_out(o));
    none.then_some(match with_tone {
        0 => Finding::DriveNotMeasured { records },
        records => Finding::PhaseNotMeasured { records },
    })
}

/// Whether the drive's channel is left out, which is named where that is found.
fn left_out(observation: &Observation) -> bool {
    let mut late = observation.late.iter();
    late.any(|l| l.role == Role::Drive && l.unsteady_s.is_some())
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

/// A record's frequencies in its row of the run table, hertz.
#[derive(Clone, Copy)]
struct Row {
    stated_hz: f64,
    measured_hz: f64,
    /// What the measured one may be off by.
    error_hz: f64,
}

impl Row {
    fn of(o: &Observation, clock: f64) -> Option<Self> {
        let drive = o.drive?;
        let measured_hz = drive.frequency_hz;
        Some(Self {
            stated_hz: o.setting.stated_frequency_hz?,
            measured_hz,
            error_hz: SURE * drive.frequency_error_hz.hypot(clock * measured_hz),
        })
    }

    /// Whether the drive has the frequency that another row states and not the own one; `None` where both are alike.
    fn belongs_to(&self, other_hz: f64) -> Option<bool> {
        let own = (self.measured_hz - self.stated_hz).abs();
        let other = (self.measured_hz - other_hz).abs();
        let differ = (own - other).abs() > self.error_hz;
        differ.then_some(own > (CLOSER * other).max(self.error_hz))
    }
}

/// That the frequencies of records in a row are those of the rows before or after their own; `clock`: the relative
/// standard uncertainty of the clock.
pub fn shifted(observations: &[Observation], clock: f64) -> Option<Finding> {
    let rows: Vec<Option<Row>> = observations.iter().map(|o| Row::of(o, clock)).collect();
    let by = |shift: isize| longest_shifted(&rows, shift);
    let longest = SHIFTS.into_iter().filter_map(by).max_by_key(|r| r.len())?;
    (longest.len() >= FEWEST_SHIFTED).then(|| Finding::RowsShifted {
        record: observations[longest[0]].record.clone(),
        records: longest.len(),
    })
}

/// The longest series of records that belong to the row a shift away, without one between that belongs to its own.
fn longest_shifted(rows: &[Option<Row>], shift: isize) -> Option<Vec<usize>> {
    let belongs = |i: usize| {
        let other = rows.get(i.checked_add_signed(shift)?)?.as_ref()?;
        rows[i]?.belongs_to(other.stated_hz)
    };
    let told = (0..rows.len()).filter_map(|i| Some((i, belongs(i)?)));
    let told: Vec<(usize, bool)> = told.collect();
    let series = told.chunk_by(|a, b| a.1 == b.1).filter(|s| s[0].1);
    let longest = series.max_by_key(|s| s.len())?;
    Some(longest.iter().map(|(i, _)| *i).collect())
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

    /// Records at frequencies of a sweep, each named in its own row, or from one on in the row before it.
    fn swept(steps: &[f64], lost: Option<usize>) -> Vec<Observation> {
        let row = |i: usize| {
            if lost.is_some_and(|l| i >= l) {
                i + 1
            } else {
                i
            }
        };
        let one = |i: usize| {
            let mut o = observed(8.0 + steps[row(i)], 8.0 + steps[i]);
            o.record = format!("r{i}");
            o
        };
        (0..steps.len() - usize::from(lost.is_some()))
            .map(one)
            .collect()
    }

    #[test]
    fn a_row_that_is_missing_in_the_run_table_is_found() {
        let coarse = |i: usize| 0.4 * i as f64;
        let fine = |i: usize| 0.03 * i as f64;
        let up_and_down = |i: usize| 0.4 * (8.0 - (i as f64 - 8.0).abs());
        let held = |i: usize| 0.2 * (i / 2) as f64;
        let of = |f: fn(usize) -> f64, lost| {
            let steps: Vec<f64> = (0..24).map(f).collect();
            shifted(&swept(&steps, lost), 50e-6)
        };
        for f in [coarse, fine, up_and_down, held] {
            assert_eq!(of(f, None), None);
            match of(f, Some(6)) {
                Some(Finding::RowsShifted { record, records }) => {
                    assert!(["r6", "r7"].contains(&record.as_str()), "{record}");
                    assert!(records >= 8, "{records}");
                }
                other => panic!("{other:?} of a sweep that ends at {}", f(23)),
            }
        }
        // all off alike
        let mut off = swept(&[0.0, 0.4, 0.8, 1.2, 1.6, 2.0], None);
        for o in &mut off {
            o.setting.stated_frequency_hz = o.drive.map(|d| 1.002 * d.frequency_hz + 0.01);
        }
        assert_eq!(shifted(&off, 50e-6), None);
        for o in &mut off {
            o.setting.stated_frequency_hz = o.drive.map(|d| 0.8 * d.frequency_hz);
        }
        assert_eq!(shifted(&off, 50e-6), None);
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
