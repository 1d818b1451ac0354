//! R from the times of impacts alone: under a constant force a flight lasts 2v/a, so that each flight is
//! R times as long as the one before. Or from heights, each R² times the one before ([`heights`]).
//!
//! The times of a record are a geometric row, `t_k = t_0 + T_0 (1 + R + … + R^(k−1))` ([`rows`]). What scatters about
//! it are errors of the times and R itself, from impact to impact ([`scatter`]).

mod fall;
mod heights;
mod rows;
mod scatter;
mod unlisted;

use crate::estimate::{self, Estimate};
use crate::messages::{Note, Remark};
use crate::method::Method;
use crate::methods::answer::MethodResult;
use crate::methods::fits::Fits;
use crate::methods::flight_times::rows::{Fitted, Row, Rows, rows};
use crate::methods::flight_times::scatter::{Known, RowEstimate, Scatter, Trend, fitted};
use crate::methods::flight_times::unlisted::Unlisted;
use crate::methods::identifier::Identifier;
use crate::methods::impacts::structure::{self, GroupedRatio, Grouping, ImpactGroup, ImpactGroups};
use crate::methods::selection::Selection;
use crate::parameters::Coordinate;
use crate::statistics::distribution::student_tail;
use crate::statistics::quantile::NORMAL_975;
use crate::statistics::scatter::Spread;
use crate::statistics::weighted::{self, Measured};
use impact_records::motion::Observation;
use impact_records::signal::robust;

/// The times between impacts under a constant force.
pub struct FlightTimes;

impl Identifier for FlightTimes {
    fn method(&self) -> Method {
        Method::FlightTimes
    }

    fn records(&self, selection: &Selection<'_>) -> Vec<usize> {
        selection.observed(|o| !o.excluded() && is_timed(o))
    }

    fn result(&self, selection: &Selection<'_>, _: &Fits) -> Option<MethodResult> {
        pooled(selection.evidence.observations)
    }
}

/// Questions among which the false alarms are shared: a trend over bounces, and differences between records.
const QUESTIONS: f64 = 2.0;
/// Probability from which the record furthest off is none of the others (Grubbs 1969, at his 5 %).
const ODD: f64 = 0.05;
/// Change of R over the bounces of a record, or of one record from the others, that matters.
const MATTERS: f64 = 0.005;
/// Records from which one is told from the others.
const SEVERAL: usize = 4;

/// Whether R of a record rests on the times of its impacts, without drive or speeds, or on heights.
pub fn is_timed(o: &Observation) -> bool {
    if heights::are_listed(o) {
        return true;
    }
    let no_speed = |i: &impact_records::event::Impact| i.approach_speed_before_m_s.is_none();
    o.drive.is_none() && o.impacts.len() > 2 && o.impacts.iter().all(no_speed)
}

/// R of all records whose impacts are known by their times or heights alone; `None` without any.
pub fn pooled(observations: &[Observation]) -> Option<MethodResult> {
    let timed = |(_, o): &(usize, &Observation)| !o.excluded() && is_timed(o);
    let records: Vec<(usize, &Observation)> =
        observations.iter().enumerate().filter(timed).collect();
    let by_heights = records.iter().all(|(_, o)| heights::are_listed(o));
    let (rows, known) = if by_heights {
        (heights::rows(&records), heights::known(&records))
    } else {
        (rows(&records), Known::of_times(stated_error_s(&records)))
    };
    let fits: Vec<(&Row, Fitted)> = rows
        .rows
        .iter()
        .filter_map(|row| Some((row, fitted(row)?)))
        .collect();
    if fits.is_empty() {
        let remarks: Vec<Remark> = not_used(&rows, observations).collect();
        return (!rows.missed.is_empty()).then(|| MethodResult {
            remarks,
            ..MethodResult::default()
        });
    }
    let mut result = of_rows(&fits, known, observations);
    result.records = records.len();
    result.remarks.extend(not_used(&rows, observations));
    Some(result)
}

/// R of rows with their fits.
fn of_rows(fits: &[(&Row, Fitted)], known: Known, observations: &[Observation]) -> MethodResult {
    let scatter = Scatter::of(fits, known);
    let all = by_row(fits, &scatter, observations);
    let odd = odd_record(&all);
    let used = |i: &usize| Some(*i) != odd;
    let indices: Vec<usize> = (0..fits.len()).filter(used).collect();
    let groups: Vec<ImpactGroup> = indices.iter().map(|i| all[*i].clone()).collect();
    let rows: Vec<(&Row, Fitted)> = indices.iter().map(|i| fits[*i]).collect();
    let (value, error) = weighted(&groups);
    let estimates: Vec<&RowEstimate> = indices.iter().map(|i| &scatter.rows[*i]).collect();
    let unlisted = Unlisted::of(&rows, &estimates, observations, known.least);
    let value = value + unlisted.change;
    let ratios: Vec<GroupedRatio> = indices
        .iter()
        .flat_map(|i| ratios(fits[*i].0, &scatter.rows[*i]))
        .collect();
    let mut result = MethodResult {
        observations: rows.iter().map(|(row, _)| row.impacts()).sum(),
        fits: Some(true),
        ..MethodResult::default()
    };
    let restitution = estimated(value, error, &scatter, known, &unlisted);
    result.parameters.restitution = Some(restitution);
    result.impact_groups = Some(ImpactGroups {
        by_record: all.clone(),
        ..structure::groups(&ratios, observations)
    });
    let said = remarks(error, &scatter, known, &unlisted);
    result.remarks.extend(said);
    result.remarks.extend(odd.map(|odd| Remark::OddRecord {
        record: all[odd].group.clone(),
        restitution: all[odd].restitution,
        others: value,
    }));
    if ratios.len() > 1 {
        judge(&mut result, &rows, &groups, &ratios, known, &unlisted);
    }
    result
}

/// Judge whether R is one number over bounces and records.
fn judge(
    result: &mut MethodResult,
    rows: &[(&Row, Fitted)],
    groups: &[ImpactGroup],
    ratios: &[GroupedRatio],
    known: Known,
    unlisted: &Unlisted,
) {
    let trend = scatter::trend(rows, known.least).filter(is_change);
    let grouping = match trend {
        Some(_) if rises_by_contacts(rows, known, unlisted) => between_records(groups),
        Some(trend) if known.heights => {
            let each: Vec<&Row> = rows.iter().map(|(row, _)| *row).collect();
            return heights::judge(result, &each, &trend);
        }
        Some(_) => Some(Grouping::Bounce),
        None => between_records(groups).or_else(|| structure::structure(ratios)),
    };
    if let Some(grouping) = grouping {
        result.judge_structure(grouping);
    }
}

/// Whether a change of R along the bounces is none of the flights alone: contacts of one length, as their pulses show
/// them, make R seem to rise.
fn rises_by_contacts(rows: &[(&Row, Fitted)], known: Known, unlisted: &Unlisted) -> bool {
    let Some(contact_s) = unlisted.contact_s else {
        return false;
    };
    let without = |(row, _): &(&Row, Fitted)| {
        let row = row.without_contacts(contact_s);
        fitted(&row).map(|fit| (row, fit))
    };
    let flights: Vec<(Row, Fitted)> = rows.iter().filter_map(without).collect();
    let flights: Vec<(&Row, Fitted)> = flights.iter().map(|(row, fit)| (row, *fit)).collect();
    let trend = scatter::trend(&flights, known.least);
    !trend.as_ref().is_some_and(is_change)
}

/// R with the error that the rows leave of it and what times do not contain. Where it may be 1, the flights need not be those
/// of a mass that bounces: trials one below the other are as long in the mean.
fn estimated(
    value: f64,
    error: f64,
    scatter: &Scatter,
    known: Known,
    unlisted: &Unlisted,
) -> Estimate {
    let spread = Spread {
        freedom: scatter.freedom,
        ..Spread::known(error)
    };
    let narrow = estimate::estimate_within(Coordinate::Restitution, value, spread, None);
    let mut estimate = estimate::wider(Coordinate::Restitution, &narrow, unlisted.error);
    if let Some(error) = scatter.listed.filter(|_| !scatter.told) {
        estimate.weaken(if known.heights {
            Note::HeightsNotTold { error_m: error }
        } else {
            Note::TimesNotTold { error_s: error }
        });
    }
    let alike = estimate.interval95.is_some_and(|[_, high]| high >= 1.0);
    if alike && !known.heights {
        estimate.weaken(Note::FlightsAlike);
    }
    estimate
}

/// What scatters, and what times do not contain where it decides the interval; `error`: of R by the rows alone.
fn remarks(
    error: f64,
    scatter: &Scatter,
    known: Known,
    unlisted: &Unlisted,
) -> impl Iterator<Item = Remark> {
    let listed = scatter.listed.map(|error| {
        if known.heights {
            Remark::HeightsScatter { error_m: error }
        } else {
            Remark::TimesScatter { error_s: error }
        }
    });
    let own = scatter
        .own
        .map(|share| Remark::RestitutionScatters { share });
    let half_width = NORMAL_975 * unlisted.error;
    let open = (unlisted.error > error).then_some(if known.heights {
        Remark::HeightsOpen { half_width }
    } else {
        Remark::FlightTimesOpen { half_width }
    });
    listed.into_iter().chain(own).chain(open)
}

/// R of each row.
fn by_row(
    fits: &[(&Row, Fitted)],
    scatter: &Scatter,
    observations: &[Observation],
) -> Vec<ImpactGroup> {
    let each = fits.iter().zip(&scatter.rows);
    each.map(|((row, _), own)| ImpactGroup {
        group: observations[row.record].record.clone(),
        impacts: row.impacts(),
        speed_m_s: None,
        restitution: own.restitution,
        standard_error: own.error,
    })
    .collect()
}

/// Whether a change of R along the bounces is one that matters, and no chance.
fn is_change(trend: &Trend) -> bool {
    let chance = student_tail(trend.deviates, trend.freedom);
    chance < structure::FALSE_ALARMS / QUESTIONS && trend.change > MATTERS
}

/// What the flights that are left out, and the impacts that seem to be missing, are to be known by.
fn not_used(found: &Rows, observations: &[Observation]) -> impl Iterator<Item = Remark> {
    let left_out = found.left_out;
    let flights = (left_out > 0).then_some(Remark::FlightsLeftOut { count: left_out });
    let impacts = found
        .missed
        .first()
        .map(|(record, time_s)| Remark::ImpactsMissed {
            count: found.missed.len(),
            record: observations[*record].record.clone(),
            time_s: *time_s,
        });
    let tops = found
        .skipped
        .first()
        .map(|(record, height_m)| Remark::TopsMissed {
            count: found.skipped.len(),
            record: observations[*record].record.clone(),
            height_m: *height_m,
        });
    flights.into_iter().chain(impacts).chain(tops)
}

/// Whether R differs between records by more than the errors of their times.
fn between_records(groups: &[ImpactGroup]) -> Option<Grouping> {
    let ratio = |g: &ImpactGroup| GroupedRatio {
        record: 0,
        bounce: 0,
        speed_m_s: None,
        ratio: g.restitution,
        error: g.standard_error,
    };
    let each: Vec<GroupedRatio> = groups.iter().map(ratio).collect();
    structure::differ(&each).then_some(Grouping::Record)
}

/// The one record whose R is far from that of all others, which agree.
fn odd_record(groups: &[ImpactGroup]) -> Option<usize> {
    if groups.len() < SEVERAL {
        return None;
    }
    let values: Vec<f64> = groups.iter().map(|g| g.restitution).collect();
    let centre = robust::median(&values)?;
    let (odd, group) = groups.iter().enumerate().max_by(|a, b| {
        let off = |g: &ImpactGroup| (g.restitution - centre).abs();
        off(a.1).total_cmp(&off(b.1))
    })?;
    let others: Vec<ImpactGroup> = groups
        .iter()
        .filter(|g| g.group != group.group)
        .cloned()
        .collect();
    // several rows may be of one record
    if others.len() + 1 < SEVERAL {
        return None;
    }
    let (mean, _) = weighted(&others);
    let off: Vec<f64> = others.iter().map(|g| g.restitution - mean).collect();
    let spread = robust::rms(&off) * (off.len() as f64 / (off.len() - 1) as f64).sqrt();
    let apart = (group.restitution - mean).abs();
    let chance = group
        .standard_error
        .hypot(spread * (1.0 + 1.0 / off.len() as f64).sqrt());
    // any of them might have been the furthest
    let probability = groups.len() as f64 * student_tail(apart / chance, (off.len() - 1) as f64);
    (probability < ODD && apart > STRANGE).then_some(odd)
}

/// Difference of R from the other records' that is looked at.
const STRANGE: f64 = 0.02;

/// Weighted mean of the records with the greater of inner and outer standard error.
fn weighted(groups: &[ImpactGroup]) -> (f64, f64) {
    let measured = groups.iter().map(|g| Measured {
        value: g.restitution,
        error: g.standard_error.max(1e-9),
        freedom: f64::INFINITY,
    });
    let measured: Vec<Measured> = measured.collect();
    let (mean, spread) = weighted::mean(&measured, &weighted::by_errors(&measured));
    (mean, spread.error)
}

/// Standard error of the times that their source states, s.
fn stated_error_s(records: &[(usize, &Observation)]) -> Option<f64> {
    let impacts = records.iter().flat_map(|(_, o)| &o.impacts);
    let errors: Vec<f64> = impacts.map(|i| i.time_error_s).collect();
    robust::median(&errors).filter(|error| *error > 0.0)
}

/// Each flight over the one before.
fn ratios(row: &Row, own: &RowEstimate) -> impl Iterator<Item = GroupedRatio> {
    let each = row.flights_s().into_iter().zip(row.bounces());
    each.zip(&own.ratio_errors)
        .map(|(([before, after], bounce), error)| {
            let ratio = after / before;
            GroupedRatio {
                record: row.record,
                bounce,
                speed_m_s: None,
                ratio,
                error: ratio * error,
            }
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimate::Status;
    use impact_records::event::Impact;
    use impact_records::motion::Motion;

    /// A record of impacts at given times, without speeds.
    #[test]
    fn valid_the_length_of_contacts_is_part_of_the_interval() {
        // what lists of closings are: impacts with a pulse of 2 ms behind, or flights from opening to closing
        for (r, count) in [(0.8_f64, 10), (0.65, 7), (0.92, 12)] {
            for touch_s in [0.0, 2e-3] {
                let flights = (0..count).map(|k| 0.5 * r.powi(k) + touch_s);
                let mut times = vec![0.3];
                times.extend(flights.scan(0.3, |at, flight| {
                    *at += flight;
                    Some(*at)
                }));
                let mut listed = timed("a", &times);
                for impact in &mut listed.impacts {
                    impact.contact_duration_s = Some(2e-3);
                }
                let found = pooled(&[listed]).expect("a result");
                let estimate = found.parameters.restitution.expect("R");
                let [low, high] = estimate.interval95.expect("an interval");
                assert!(low < r && r < high, "{r}, {touch_s}: {low} to {high}");
                assert!(high - low < 0.02, "{low} to {high}");
            }
        }
    }

    fn timed(name: &str, times_s: &[f64]) -> Observation {
        let mut o = Observation::of(name, 1.0, Motion::Impactless);
        o.impacts = times_s
            .iter()
            .map(|t| Impact {
                approach_speed_before_m_s: None,
                time_error_s: 1e-4,
                ..Impact::at(*t, 0.0)
            })
            .collect();
        o
    }

    fn row(restitution: f64, count: usize) -> Vec<f64> {
        let mut times = vec![1.0];
        let mut flight = 0.5;
        for _ in 0..count {
            times.push(times[times.len() - 1] + flight);
            flight *= restitution;
        }
        times
    }

    fn restitution(observations: &[Observation]) -> (f64, f64) {
        let found = pooled(observations).expect("a result");
        let r = found.parameters.restitution.expect("R");
        (
            r.value.expect("a value"),
            r.standard_error.expect("an error"),
        )
    }

    #[test]
    fn valid_an_exact_row_gives_its_ratio() {
        let (r, error) = restitution(&[timed("a", &row(0.8, 7))]);
        // The stated error of 0.1 ms, not the residuals of none, and the length of contacts give the standard error.
        assert!((r - 0.8).abs() < error, "{r}");
        assert!(error > 1e-5 && error < 1e-3, "{error}");
    }

    #[test]
    fn a_missed_bounce_parts_the_row_and_a_click_before_it_is_left_out() {
        let mut times = row(0.8, 9);
        times.remove(4);
        // The release, 0.3 s before the first bounce: the fall is half a flight.
        times.insert(0, 0.7);
        let found = pooled(&[timed("a", &times)]).expect("a result");
        let r = found.parameters.restitution.clone();
        let r = r.and_then(|r| r.value).expect("R");
        assert!((r - 0.8).abs() < 1e-3, "{r}");
        assert!(
            found.remarks.contains(&Remark::FlightsLeftOut { count: 2 }),
            "{:?}",
            found.remarks
        );
        // four flights of 0.5 s, 0.4 s … before it: 1 + 0.5 (1 + 0.8 + 0.64 + 0.512) s
        let missed = |r: &&Remark| matches!(r, Remark::ImpactsMissed { .. });
        let text = found.remarks.iter().find(missed).expect("a remark");
        assert_eq!(
            text.to_string(),
            "impacts missing among the times: 1, the first in a at about 2.476 s; the flights over them are left \
             out: see why they were not heard"
        );
    }

    #[test]
    fn an_impact_missing_at_a_low_restitution_is_told_from_a_change_of_it() {
        // merged flights are 0.75 of the one before, which alone would pass beside R = 0.5
        let mut times = row(0.5, 8);
        times.remove(4);
        let found = pooled(&[timed("a", &times)]).expect("a result");
        let missed = |r: &Remark| matches!(r, Remark::ImpactsMissed { count: 1, .. });
        assert!(found.remarks.iter().any(missed), "{:?}", found.remarks);
        let r = found.parameters.restitution.and_then(|r| r.value);
        assert!((r.expect("R") - 0.5).abs() < 1e-2);
        // R that rises from 0.41 to 0.53, and each impact there
        let found = pooled(&[timed("a", &changing(0.41, 0.03, 5, 0.0, 0))]).expect("a result");
        let missed = |r: &Remark| matches!(r, Remark::ImpactsMissed { .. });
        assert!(!found.remarks.iter().any(missed), "{:?}", found.remarks);
    }

    #[test]
    fn a_bounce_missed_in_a_short_throw_is_named_and_gives_no_r() {
        // R = 0.84, the second of five impacts not heard
        let found = pooled(&[timed("a", &[0.5, 1.2589, 2.4314, 2.8816])]).expect("a result");
        assert_eq!(found.parameters.restitution, None);
        let text = found.remarks.iter().map(ToString::to_string);
        let text = text.collect::<Vec<_>>().join("\n");
        assert!(
            text.contains("impacts missing among the times: 1, the first in a at about 1.896 s"),
            "{text}"
        );
    }

    #[test]
    fn an_impact_missed_in_the_first_or_the_last_of_three_flights_is_named() {
        // the second of five impacts, and the fourth of them, where R(1 + R) alone would pass beside R
        for (restitution, missing) in [(0.8, 1), (0.6, 3)] {
            let mut times = row(restitution, 4);
            let second_s = times.remove(missing);
            let found = pooled(&[timed("a", &times)]).expect("a result");
            let text = found.remarks.iter().map(ToString::to_string);
            let text = text.collect::<Vec<_>>().join("\n");
            let named = format!(
                "impacts missing among the times: 1, the first in a at about {second_s:.3} s"
            );
            assert!(text.contains(&named), "{text}");
            let r = found.parameters.restitution.expect("R");
            let [low, high] = r.interval95.expect("an interval");
            assert!(low < restitution && restitution < high, "{low} {high}");
        }
    }

    #[test]
    fn rows_of_one_record_alone_have_no_odd_record_among_them() {
        // four throws of one list, the last on another spot
        let throw = |at: f64, r: f64| row(r, 5).into_iter().map(move |t| t + at);
        let rows = [0.0, 20.0, 40.0, 60.0]
            .into_iter()
            .zip([0.8, 0.8, 0.8, 0.6]);
        let times: Vec<f64> = rows.flat_map(|(at, r)| throw(at, r)).collect();
        let found = pooled(&[timed("a", &times)]).expect("a result");
        let odd = |r: &Remark| matches!(r, Remark::OddRecord { .. });
        assert!(!found.remarks.iter().any(odd), "{:?}", found.remarks);
        assert_eq!(found.fits, Some(false), "{:?}", found.remarks);
    }

    #[test]
    fn valid_trials_below_each_other_are_no_flights_of_one_mass() {
        // the first flights of ten throws, of 0.6 s but for the hand
        let flights = (0..10).map(|k: usize| 0.6 + 0.04 * (k as f64 * 2.399_963).sin());
        let times = flights.scan(0.0, |time, flight| {
            *time += flight;
            Some(*time)
        });
        let times: Vec<f64> = std::iter::once(0.0).chain(times).collect();
        let found = pooled(&[timed("a", &times)]).expect("a result");
        let r = found.parameters.restitution.expect("R");
        assert_eq!((r.status, r.note), (Status::Weak, Some(Note::FlightsAlike)));
    }

    #[test]
    fn rests_between_the_throws_of_a_list_are_no_flights_left_out() {
        let throws = [0.0, 20.0, 40.0].into_iter();
        let times: Vec<f64> = throws
            .flat_map(|at| row(0.8, 5).into_iter().map(move |t| t + at))
            .collect();
        let found = pooled(&[timed("a", &times)]).expect("a result");
        let left = |r: &Remark| matches!(r, Remark::FlightsLeftOut { .. });
        assert!(!found.remarks.iter().any(left), "{:?}", found.remarks);
        assert_eq!(found.observations, 18);
    }

    #[test]
    fn three_times_tell_nothing_of_their_own_errors() {
        let found = pooled(&[timed("a", &[0.5, 1.1, 1.58])]).expect("a result");
        let r = found.parameters.restitution.expect("R");
        assert_eq!(r.status, Status::Weak);
        assert!(matches!(r.note, Some(Note::TimesNotTold { .. })), "{r:?}");
        let [low, high] = r.interval95.expect("an interval");
        assert!(high - low > 0.01, "{low} {high}");
    }

    #[test]
    fn prop_intervals_of_short_throws_hold_r() {
        use rand::SeedableRng;
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(20_261_128);
        for (impacts, throws, scatter_s) in [
            (4, 1, 3e-4),
            (4, 1, 1e-5),
            (3, 3, 3e-4),
            (5, 1, 3e-4),
            (4, 3, 1e-4),
        ] {
            let held = (0..200).filter(|_| {
                let mut throw = |k: usize| {
                    let times = row(0.78, impacts - 1);
                    let times = times.iter().map(|t| t + scatter_s * normal(&mut rng));
                    // printed to 0.1 ms
                    let times: Vec<f64> = times.map(|t| (1e4 * t).round() / 1e4).collect();
                    timed(&format!("throw {k}"), &times)
                };
                let all: Vec<Observation> = (0..throws).map(&mut throw).collect();
                let found = pooled(&all).expect("a result");
                let r = found.parameters.restitution.and_then(|r| r.interval95);
                r.is_some_and(|[low, high]| (low..=high).contains(&0.78))
            });
            let share = held.count() as f64 / 200.0;
            assert!(share > 0.9, "{impacts} {throws} {scatter_s}: {share}");
        }
    }

    #[test]
    fn prop_intervals_hold_r_however_long_contacts_last() {
        use rand::SeedableRng;
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(20_261_129);
        for (contact_s, impacts, throws) in [
            (0.0, 7, 3),
            (1e-3, 7, 3),
            (5e-3, 5, 1),
            (5e-3, 7, 3),
            (1.5e-2, 7, 1),
        ] {
            let held = (0..200).filter(|k| {
                let r = 0.6 + 0.3 * f64::from(k % 10) / 9.0;
                let mut throw = |k: usize| {
                    let times = row(r, impacts - 1).into_iter().enumerate();
                    let times = times
                        .map(|(k, t)| t + k as f64 * contact_s + 2e-4 * normal(&mut rng))
                        .collect::<Vec<_>>();
                    timed(&format!("throw {k}"), &times)
                };
                let all: Vec<Observation> = (0..throws).map(&mut throw).collect();
                let found = pooled(&all).expect("a result");
                let interval = found.parameters.restitution.and_then(|r| r.interval95);
                interval.is_some_and(|[low, high]| (low..=high).contains(&r))
            });
            let share = held.count() as f64 / 200.0;
            assert!(share > 0.9, "{contact_s} {impacts} {throws}: {share}");
        }
    }

    #[test]
    fn valid_contacts_whose_length_the_pulses_show_are_no_change_of_r() {
        use rand::SeedableRng;
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(20_261_130);
        let mut told = |slope: f64, pulse_s: f64| {
            let mut flight = 0.6;
            let times = (0..9).scan(1.0, |t, k| {
                let hit = *t + 1e-4 * normal(&mut rng);
                *t += flight + 0.008;
                flight *= 0.78 + slope * f64::from(k);
                Some(hit)
            });
            let mut observed = timed("plate", &times.collect::<Vec<_>>());
            for impact in &mut observed.impacts {
                impact.contact_duration_s = Some(pulse_s);
            }
            let found = pooled(&[observed]).expect("a result");
            (
                found.fits,
                found.parameters.restitution.and_then(|r| r.interval95),
            )
        };
        for _ in 0..20 {
            // a force shows the contact itself, an amplifier may lengthen the pulse
            for pulse_s in [0.008, 0.012] {
                let (fits, interval) = told(0.0, pulse_s);
                let [low, high] = interval.expect("an interval");
                assert!(
                    fits == Some(true) && low < 0.78 && 0.78 < high,
                    "{low} {high}"
                );
            }
            assert_eq!(told(0.01, 0.008).0, Some(false));
        }
    }

    #[test]
    fn what_times_do_not_contain_is_named_where_it_decides_the_interval() {
        let found = pooled(&[timed("a", &row(0.5, 4))]).expect("a result");
        let text = found.remarks.iter().map(ToString::to_string);
        let text = text.collect::<Vec<_>>().join("\n");
        assert!(text.contains("leave R open by ± 0.0"), "{text}");
    }

    #[test]
    fn records_that_differ_are_named_not_averaged() {
        let all = [timed("a", &row(0.72, 6)), timed("b", &row(0.5, 6))];
        let found = pooled(&all).expect("a result");
        assert_eq!(found.fits, Some(false));
        let differ = |r: &Remark| matches!(r, Remark::RecordsDiffer { .. });
        assert!(found.remarks.iter().any(differ), "{:?}", found.remarks);
        let [low, high] = found
            .parameters
            .restitution
            .expect("R")
            .interval95
            .expect("an interval");
        assert!(low <= 0.5 && high >= 0.72);
    }

    /// A row whose R begins at one value and changes by another from bounce to bounce, with scatter of its times.
    fn changing(first: f64, change: f64, count: usize, scatter_s: f64, seed: usize) -> Vec<f64> {
        let mut times = vec![1.0];
        let (mut flight, mut restitution) = (0.6, first);
        for _ in 0..count {
            times.push(times[times.len() - 1] + flight);
            flight *= restitution;
            restitution += change;
        }
        let scatter = |i: usize| scatter_s * ((i + 7 * seed) as f64 * 2.399_963).sin() * 1.4;
        times
            .iter()
            .enumerate()
            .map(|(i, t)| t + scatter(i))
            .collect()
    }

    #[test]
    fn valid_a_trend_over_the_bounces_is_found_though_it_enlarges_the_scatter_about_one_r() {
        // R from 0.923 to 0.943 over 20 bounces
        let rising = changing(0.923, 0.001, 20, 1e-4, 1);
        let found = pooled(&[timed("a", &rising)]).expect("a result");
        let by_bounce = |r: &Remark| matches!(r, Remark::RestitutionByBounce { .. });
        assert!(found.remarks.iter().any(by_bounce), "{:?}", found.remarks);
        assert_eq!(found.fits, Some(false));
        let r = found.parameters.restitution.expect("R");
        assert_eq!(r.status, crate::Status::Weak);
        let [low, high] = r.interval95.expect("an interval");
        assert!(low < 0.925 && high > 0.941, "{low} {high}");
        // the scatter is that of the times, not of the trend
        let scatter = found.remarks.iter().find_map(|r| match r {
            Remark::TimesScatter { error_s } => Some(*error_s),
            _ => None,
        });
        assert!(
            (0.5e-4..2e-4).contains(&scatter.expect("a scatter")),
            "{scatter:?}"
        );
        let steady = changing(0.933, 0.0, 20, 1e-4, 1);
        assert_eq!(
            pooled(&[timed("a", &steady)]).expect("a result").fits,
            Some(true)
        );
    }

    #[test]
    fn valid_r_of_a_ball_that_the_air_slows_is_in_the_interval() {
        // a ball that loses R at the floor and c v² on its way, c from a tennis to a table tennis ball
        let g = 9.81_f64;
        for (r, drag_per_m) in [(0.72_f64, 0.018_f64), (0.83, 0.03), (0.75, 0.12)] {
            // up from u: h = ln(1 + c u²/g)/2c; down through h: w² = g (1 − exp(−2ch))/c
            let (rate, end) = ((g * drag_per_m).sqrt(), (g / drag_per_m).sqrt());
            let mut times = vec![0.5];
            let mut up = 4.4_f64;
            for _ in 0..7 {
                let height = (1.0 + (up / end).powi(2)).ln() / (2.0 * drag_per_m);
                let down = end * (1.0 - (-2.0 * drag_per_m * height).exp()).sqrt();
                let flight = ((up / end).atan() + (down / end).atanh()) / rate;
                times.push(times[times.len() - 1] + flight);
                up = r * down;
            }
            let found = pooled(&[timed("a", &times)]).expect("a result");
            let estimate = found.parameters.restitution.expect("R");
            let [low, high] = estimate.interval95.expect("an interval");
            assert!(low < r && r < high, "{r}, {drag_per_m}: {low} to {high}");
        }
    }

    #[test]
    fn one_throw_that_is_not_like_the_others_is_named_and_left_out() {
        let throw =
            |r: f64, seed: usize| timed(&format!("throw {seed}"), &changing(r, 0.0, 8, 2e-4, seed));
        let mut all: Vec<Observation> =
            (0..5).map(|k| throw(0.878 + 0.001 * k as f64, k)).collect();
        all.push(throw(0.822, 5));
        let found = pooled(&all).expect("a result");
        let named = found
            .remarks
            .iter()
            .find(|r| matches!(r, Remark::OddRecord { .. }));
        let text = named.expect("a remark").to_string();
        assert!(
            text.starts_with("throw 5 has R = 0.822 where all others agree on 0.88"),
            "{text}"
        );
        let (r, _) = restitution(&all);
        assert!((r - 0.88).abs() < 2e-3, "{r}");
    }

    #[test]
    fn valid_scatter_of_the_times_covers_the_ratio() {
        // ± 2 ms of even scatter on five rows of seven impacts.
        let all: Vec<Observation> = (0..5usize)
            .map(|k| {
                let scatter = |i: usize| 2e-3 * ((i + 7 * k) as f64 * 2.399_963).sin() * 1.4;
                let times: Vec<f64> = row(0.763, 6)
                    .iter()
                    .enumerate()
                    .map(|(i, t)| t + scatter(i))
                    .collect();
                timed(&format!("r{k}"), &times)
            })
            .collect();
        let (r, error) = restitution(&all);
        assert!((r - 0.763).abs() < 2.0 * error, "{r} ± {error}");
        assert!(error < 0.01);
    }

    /// A standard normal deviate.
    fn normal(rng: &mut rand_chacha::ChaCha8Rng) -> f64 {
        use rand_distr::{Distribution, StandardNormal};
        StandardNormal.sample(rng)
    }

    #[test]
    fn prop_intervals_hold_r_whether_the_times_scatter_or_r_itself() {
        use rand::SeedableRng;
        const LISTS: usize = 150;
        // relative scatter of R, scatter of the times in s, impacts; the times are stated to 0.1 ms
        let cases = [
            (0.0, 1e-4, 10),
            (0.0, 1e-3, 8),
            (5e-3, 1e-4, 10),
            (2e-2, 1e-4, 10),
            (3e-2, 5e-4, 8),
            (2e-2, 1e-4, 6),
        ];
        for (number, (own, scatter_s, impacts)) in cases.into_iter().enumerate() {
            let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(20_261_127 + number as u64);
            let held = (0..LISTS).filter(|_| {
                let mut times = vec![1.0];
                let mut flight = 0.6;
                for _ in 1..impacts {
                    times.push(times[times.len() - 1] + flight);
                    flight *= 0.8 * (1.0 + own * normal(&mut rng));
                }
                let measured: Vec<f64> = times
                    .iter()
                    .map(|t| t + scatter_s * normal(&mut rng))
                    .collect();
                let found = pooled(&[timed("a", &measured)]).expect("a result");
                let interval = found.parameters.restitution.and_then(|r| r.interval95);
                interval.is_some_and(|[low, high]| low <= 0.8 && 0.8 <= high)
            });
            let share = held.count() as f64 / LISTS as f64;
            assert!(share > 0.9, "{own} {scatter_s} {impacts}: {share}");
        }
    }

    #[test]
    fn valid_r_that_scatters_from_impact_to_impact_is_named_with_its_scatter() {
        use rand::SeedableRng;
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let lists: Vec<Observation> = (0..4)
            .map(|k| {
                let mut times = vec![1.0];
                let mut flight = 0.6;
                for _ in 0..10 {
                    times.push(times[times.len() - 1] + flight);
                    flight *= 0.85 * (1.0 + 0.02 * normal(&mut rng));
                }
                timed(&format!("list {k}"), &times)
            })
            .collect();
        let found = pooled(&lists).expect("a result");
        let share = found.remarks.iter().find_map(|r| match r {
            Remark::RestitutionScatters { share } => Some(*share),
            _ => None,
        });
        assert!(
            (share.expect("a scatter") - 0.02).abs() < 0.006,
            "{share:?}"
        );
        // one of the two, not both
        let times = |r: &Remark| matches!(r, Remark::TimesScatter { .. });
        assert!(!found.remarks.iter().any(times));
    }
}
