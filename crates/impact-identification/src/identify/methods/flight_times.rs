//! R from the times of impacts alone: under a constant force a flight lasts 2v/a, so that each flight is
//! R times as long as the one before.
//!
//! The times of a record are a geometric row, `t_k = t_0 + T_0 (1 + R + … + R^(k−1))`; R, `t_0` and `T_0` are
//! fitted to them by least squares with the error of each time as the noise. That error is the scatter of
//! differences of the flights' logarithms into which neither R nor a steady change of it enters, so that what R
//! does along the bounces is not taken for noise.

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use crate::identify::answer::MethodResult;
use crate::identify::estimate;
use crate::identify::messages::Remark;
use crate::identify::method::Method;
use crate::identify::methods::Identifier;
use crate::identify::methods::found::Found;
use crate::identify::methods::impacts::structure::{
    self, GroupedRatio, Grouping, ImpactGroup, ImpactGroups,
};
use crate::identify::methods::selection::Selection;
use crate::identify::parameters::Coordinate;
use crate::identify::statistics::distribution::student_tail;
use crate::identify::statistics::scatter::Spread;
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

    fn result(&self, selection: &Selection<'_>, _: &Found) -> Option<MethodResult> {
        pooled(selection.evidence.observations)
    }
}

/// Ratios of a flight to the one before, relative to the median, outside of which an impact was missed
/// or something else was heard.
const PLAUSIBLE: [f64; 2] = [0.6, 1.6];
/// Greatest ratio that is possible but for errors of the times.
const GREATEST: f64 = 1.05;
/// Standard error of a time that neither its source nor the scatter states, s.
const USUAL_ERROR_S: f64 = 2e-3;
/// Differences from which the scatter states the error of the times.
const ENOUGH: usize = 3;
/// Questions among which the false alarms are shared: a trend over bounces, and differences between records.
const QUESTIONS: f64 = 2.0;
/// Differences of a row's logarithms for each independent one: 1 + 2Σρ² of third differences of flights, fourth of
/// the times, whose correlations are −56, 28, −8 and 1 over 70.
const PER_INDEPENDENT: f64 = 2.63;
/// Probability from which the record furthest off is none of the others (Grubbs 1969, at his 5 %).
const ODD: f64 = 0.05;
/// Change of R over the bounces of a record, or of one record from the others, that matters.
const MATTERS: f64 = 0.005;
/// Records from which one is told from the others.
const SEVERAL: usize = 4;

/// Consecutive impacts of a record, none missing between them.
#[derive(Debug, Clone)]
struct Row {
    record: usize,
    /// Number of its first flight in the record.
    first: usize,
    times_s: Vec<f64>,
}

/// The geometric row that fits.
#[derive(Debug, Clone, Copy)]
struct Fitted {
    restitution: f64,
    /// Standard error of R for a standard error of 1 s of each time.
    error_per_s: f64,
}

/// Whether R of a record rests on the times of its impacts: it has neither drive nor speeds.
pub fn is_timed(o: &Observation) -> bool {
    let no_speed = |i: &impact_records::event::Impact| i.approach_speed_before_m_s.is_none();
    o.drive.is_none() && o.impacts.len() > 2 && o.impacts.iter().all(no_speed)
}

/// R of all records whose impacts are known by their times alone; `None` without any.
pub fn pooled(observations: &[Observation]) -> Option<MethodResult> {
    let timed = |(_, o): &(usize, &Observation)| !o.excluded() && is_timed(o);
    let records: Vec<(usize, &Observation)> =
        observations.iter().enumerate().filter(timed).collect();
    let Rows {
        rows,
        left_out,
        missed,
    } = rows(&records);
    let fits: Vec<(&Row, Fitted)> = rows
        .iter()
        .filter_map(|row| Some((row, fitted(&row.times_s)?)))
        .collect();
    if fits.is_empty() {
        return None;
    }
    let noise = time_noise(&fits, &records);
    let error_s = noise.error;
    let all: Vec<ImpactGroup> = fits
        .iter()
        .map(|(row, fit)| ImpactGroup {
            group: observations[row.record].record.clone(),
            impacts: row.times_s.len(),
            speed_m_s: None,
            restitution: fit.restitution,
            standard_error: fit.error_per_s * error_s,
        })
        .collect();
    let odd = odd_record(&all);
    let used = |i: &usize| Some(*i) != odd;
    let indices: Vec<usize> = (0..fits.len()).filter(used).collect();
    let groups: Vec<ImpactGroup> = indices.iter().map(|i| all[*i].clone()).collect();
    let rows: Vec<(&Row, Fitted)> = indices.iter().map(|i| fits[*i]).collect();
    let (value, error) = weighted(&groups);
    let error = error.hypot(error_of_contacts(&rows, &groups, observations));
    let ratios: Vec<GroupedRatio> = rows
        .iter()
        .flat_map(|(row, _)| ratios(row, error_s))
        .collect();
    let mut result = MethodResult {
        observations: rows.iter().map(|(row, _)| row.times_s.len()).sum(),
        records: records.len(),
        fits: Some(true),
        ..MethodResult::default()
    };
    let spread = Spread { error, ..noise };
    let restitution = estimate::estimate_within(Coordinate::Restitution, value, spread, None);
    result.parameters.restitution = Some(restitution);
    result.impact_groups = Some(ImpactGroups {
        by_record: all.clone(),
        ..structure::groups(&ratios, observations)
    });
    result.remarks.push(Remark::TimesScatter { error_s });
    result
        .remarks
        .extend(not_used(left_out, &missed, observations));
    if let Some(odd) = odd {
        result.remarks.push(Remark::OddRecord {
            record: all[odd].group.clone(),
            restitution: all[odd].restitution,
            others: value,
        });
    }
    let scatter = ratios.len() > 1 && !rows.is_empty();
    let grouping = if trend(&rows, noise) {
        Some(Grouping::Bounce)
    } else {
        between_records(&groups).or_else(|| structure::structure(&ratios))
    };
    if let Some(grouping) = grouping.filter(|_| scatter) {
        result.judge_structure(grouping);
    }
    Some(result)
}

/// What the flights that are left out, and the impacts that seem to be missing, are to be known by.
fn not_used(
    left_out: usize,
    missed: &[(usize, f64)],
    observations: &[Observation],
) -> impl Iterator<Item = Remark> {
    let flights = (left_out > 0).then_some(Remark::FlightsLeftOut { count: left_out });
    let impacts = missed
        .first()
        .map(|(record, time_s)| Remark::ImpactsMissed {
            count: missed.len(),
            record: observations[*record].record.clone(),
            time_s: *time_s,
        });
    flights.into_iter().chain(impacts)
}

/// Standard error of R by the contacts' length, where listed times are those at which contacts close: a flight begins
/// where the contact opens, if the length is that of the touch, and where it closes, if it is that of a pulse that
/// an instrument makes longer. R is as likely to be anything between.
fn error_of_contacts(
    rows: &[(&Row, Fitted)],
    groups: &[ImpactGroup],
    observations: &[Observation],
) -> f64 {
    let change = |row: &Row, fit: &Fitted| {
        let impacts = observations[row.record].impacts.iter();
        let lasting: Vec<f64> = impacts.filter_map(|i| i.contact_duration_s).collect();
        let contact_s = robust::median(&lasting)?;
        let shorter = row.times_s.iter().enumerate();
        let shorter: Vec<f64> = shorter.map(|(k, t)| t - k as f64 * contact_s).collect();
        let flies = shorter.windows(2).all(|w| w[1] > w[0]);
        let other = fitted(&shorter).filter(|_| flies)?;
        Some(fit.restitution - other.restitution)
    };
    let weight = |g: &ImpactGroup| g.standard_error.max(1e-9).powi(-2);
    let all: f64 = groups.iter().map(weight).sum();
    let changes = rows.iter().zip(groups);
    let mean = changes
        .map(|((row, fit), g)| weight(g) * change(row, fit).unwrap_or(0.0))
        .sum::<f64>()
        / all;
    mean.abs() / 3f64.sqrt()
}

/// Whether R changes along the bounces, by its logarithm as a line over their number in all records.
fn trend(rows: &[(&Row, Fitted)], noise: Spread) -> bool {
    let (mut weight, mut sum, mut longest) = (0.0, 0.0, 0);
    for (row, _) in rows {
        let Some((slope, error_per_s)) = slope(&row.times_s) else {
            continue;
        };
        let own = (error_per_s * noise.error).powi(-2);
        weight += own;
        sum += own * slope;
        longest = longest.max(row.times_s.len());
    }
    if !(weight > 0.0) {
        return false;
    }
    let slope = sum / weight;
    let change = (slope * (longest as f64 - 3.0)).abs();
    let chance = student_tail(slope * weight.sqrt(), noise.freedom);
    chance < structure::FALSE_ALARMS / QUESTIONS && change > MATTERS
}

/// Change of R from bounce to bounce along a row, with its standard error for a standard error of 1 s of each
/// time: weighted least squares of the ratios over their number, the errors of neighbours being correlated.
fn slope(times_s: &[f64]) -> Option<(f64, f64)> {
    let flights: Vec<f64> = times_s.windows(2).map(|w| w[1] - w[0]).collect();
    let count = flights.len().checked_sub(1).filter(|n| *n > 2)?;
    let ratio = |k: usize| flights[k + 1] / flights[k];
    // the ratio's slopes over the three times that it has
    let slopes = |k: usize| {
        let (r, t) = (ratio(k), flights[k]);
        [r / t, -(1.0 + r) / t, 1.0 / t]
    };
    let covariance = DMatrix::from_fn(count, count, |i, k| {
        let (a, b) = (slopes(i), slopes(k));
        let shared = |n: usize| (n + i).checked_sub(k).and_then(|m| b.get(m)).copied();
        // time number i + n of the row is number i + n − k of ratio k
        (0..3).map(|n| a[n] * shared(n).unwrap_or(0.0)).sum::<f64>()
    });
    let whitened = covariance.cholesky()?;
    let design = DMatrix::from_fn(count, 2, |i, k| if k == 0 { 1.0 } else { i as f64 });
    let values = DVector::from_fn(count, |i, _| ratio(i));
    let weighted = whitened.solve(&design);
    let inverse = (design.transpose() * &weighted).try_inverse()?;
    let found = &inverse * (weighted.transpose() * values);
    Some((found[1], inverse[(1, 1)].max(0.0).sqrt()))
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
    let (mean, _) = weighted(&others);
    let off: Vec<f64> = others.iter().map(|g| g.restitution - mean).collect();
    let spread = robust::rms(&off) * (off.len() as f64 / (off.len() - 1).max(1) as f64).sqrt();
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

/// The rows of all records.
#[derive(Default)]
struct Rows {
    rows: Vec<Row>,
    /// Flights that belong to none.
    left_out: usize,
    /// Where an impact is missing: the record's index and the time, s.
    missed: Vec<(usize, f64)>,
}

/// The rows of all records, parted where a flight does not follow from the one before.
fn rows(records: &[(usize, &Observation)]) -> Rows {
    let flights = |o: &Observation| -> Vec<f64> {
        let times = o.impacts.windows(2);
        times.map(|w| w[1].time_s - w[0].time_s).collect()
    };
    let ratios = |o: &Observation| -> Vec<f64> {
        let flights = flights(o);
        flights.windows(2).map(|w| w[1] / w[0]).collect()
    };
    let all = records.iter().flat_map(|(_, o)| ratios(o));
    let all: Vec<f64> = all.filter(|r| *r < GREATEST).collect();
    let mut found = Rows::default();
    let Some(median) = robust::median(&all) else {
        return found;
    };
    let plausible = |r: f64| r > PLAUSIBLE[0] * median && r < (PLAUSIBLE[1] * median).min(GREATEST);
    for (record, o) in records {
        let flights = flights(o);
        let ratios = ratios(o);
        let missed: Vec<usize> = (1..flights.len())
            .filter(|k| two_in_one(&ratios, *k, median))
            .collect();
        let first = |k: &usize| (*record, o.impacts[*k].time_s + flights[*k] / (1.0 + median));
        found.missed.extend(missed.iter().map(first));
        let mut begin = 0;
        for end in 1..=flights.len() {
            let beside = missed.contains(&end) || missed.contains(&(end - 1));
            let goes_on = end < flights.len() && !beside && plausible(ratios[end - 1]);
            if goes_on {
                continue;
            }
            if end - begin < 2 {
                found.left_out += end - begin;
            } else {
                found.rows.push(Row {
                    record: *record,
                    first: begin,
                    times_s: o.impacts[begin..=end].iter().map(|i| i.time_s).collect(),
                });
            }
            begin = end;
        }
    }
    found
}

/// Whether a flight is two, the impact between them missing: the ratios to the flight before and of the one
/// after are R(1 + R) and R²/(1 + R), nearer to that than to R both.
fn two_in_one(ratios: &[f64], flight: usize, restitution: f64) -> bool {
    let (Some(to), Some(from)) = (ratios.get(flight - 1), ratios.get(flight)) else {
        return false;
    };
    let (sum, half) = (1.0 + restitution, 0.5 * (1.0 + restitution).ln());
    let near = |ratio: f64, two: f64| (ratio / two).ln().abs() < half;
    near(*to, restitution * sum) && near(*from, restitution.powi(2) / sum)
}

/// Gauss–Newton for `t_0`, `T_0` and R from the ratio of the first two flights.
fn fitted(times_s: &[f64]) -> Option<Fitted> {
    times_s.len().checked_sub(3)?;
    let (first, second) = (times_s[1] - times_s[0], times_s[2] - times_s[1]);
    let mut at = Vector3::new(times_s[0], first, second / first);
    let mut normal = Matrix3::zeros();
    for _ in 0..40 {
        normal = Matrix3::zeros();
        let mut right = Vector3::zeros();
        let (mut sum, mut slope, mut power, mut power_slope) = (0.0, 0.0, 1.0, 0.0);
        for time in times_s {
            let row = Vector3::new(1.0, sum, at[1] * slope);
            let residual = time - at[0] - at[1] * sum;
            normal += row * row.transpose();
            right += row * residual;
            sum += power;
            slope += power_slope;
            power_slope = power_slope * at[2] + power;
            power *= at[2];
        }
        let step = normal.try_inverse()? * right;
        at += step;
        if step[2].abs() < 1e-12 {
            break;
        }
    }
    let variance = normal.try_inverse()?[(2, 2)];
    (at[2].is_finite() && at[2] > 0.0 && variance > 0.0).then(|| Fitted {
        restitution: at[2],
        error_per_s: variance.sqrt(),
    })
}

/// Standard error of the times, s: by what no R and no steady change of it explains, at least as their source
/// states; and how well it is known.
fn time_noise(fits: &[(&Row, Fitted)], records: &[(usize, &Observation)]) -> Spread {
    let errors: Vec<f64> = records
        .iter()
        .flat_map(|(_, o)| o.impacts.iter().map(|i| i.time_error_s))
        .collect();
    let stated = robust::median(&errors).unwrap_or(0.0);
    let of = |factors: &[f64]| -> Vec<f64> {
        let rows = fits.iter();
        rows.flat_map(|(row, _)| differences(&row.times_s, factors))
            .collect()
    };
    let third = of(&[-1.0, 3.0, -3.0, 1.0]);
    let differences = if third.len() < ENOUGH {
        of(&[1.0, -2.0, 1.0])
    } else {
        third
    };
    if differences.len() < ENOUGH {
        return Spread::known(stated.max(USUAL_ERROR_S));
    }
    let scatter = robust::rms(&differences);
    if stated >= scatter {
        return Spread::known(stated);
    }
    Spread {
        freedom: (differences.len() as f64 / PER_INDEPENDENT).max(1.0),
        ..Spread::known(scatter)
    }
}

/// Differences of the logarithms of a row's flights, each over its standard error for one of 1 s of each time.
fn differences(times_s: &[f64], factors: &[f64]) -> Vec<f64> {
    let flights: Vec<f64> = times_s.windows(2).map(|w| w[1] - w[0]).collect();
    let of = |flights: &[f64]| {
        let value: f64 = flights.iter().zip(factors).map(|(t, f)| f * t.ln()).sum();
        // each time ends one flight and begins the next
        let weights: Vec<f64> = flights.iter().zip(factors).map(|(t, f)| f / t).collect();
        let inner = weights
            .windows(2)
            .map(|w| (w[0] - w[1]).powi(2))
            .sum::<f64>();
        let ends = weights[0].powi(2) + weights[weights.len() - 1].powi(2);
        value / (inner + ends).sqrt()
    };
    flights.windows(factors.len()).map(of).collect()
}

/// Weighted mean of the records with the greater of inner and outer standard error.
fn weighted(groups: &[ImpactGroup]) -> (f64, f64) {
    let weight = |g: &ImpactGroup| g.standard_error.max(1e-9).powi(-2);
    let all: f64 = groups.iter().map(weight).sum();
    let mean = groups
        .iter()
        .map(|g| weight(g) * g.restitution)
        .sum::<f64>()
        / all;
    let chi2: f64 = groups
        .iter()
        .map(|g| weight(g) * (g.restitution - mean).powi(2))
        .sum();
    let freedom = groups.len().saturating_sub(1).max(1) as f64;
    (mean, (chi2 / freedom).max(1.0).sqrt() / all.sqrt())
}

/// Each flight over the one before.
fn ratios(row: &Row, error_s: f64) -> impl Iterator<Item = GroupedRatio> + '_ {
    let triples = row.times_s.windows(3).enumerate();
    triples.map(move |(k, t)| {
        let (before, after) = (t[1] - t[0], t[2] - t[1]);
        let ratio = after / before;
        let slopes = [ratio, 1.0 + ratio, 1.0].map(|s| s / before);
        GroupedRatio {
            record: row.record,
            bounce: row.first + k,
            speed_m_s: None,
            ratio,
            error: error_s * slopes.iter().map(|s| s * s).sum::<f64>().sqrt(),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
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
        assert!((r - 0.8).abs() < 1e-9, "{r}");
        // The stated error of 0.1 ms, not the residuals of none, gives the standard error.
        assert!(error > 1e-5 && error < 1e-3, "{error}");
    }

    #[test]
    fn a_missed_bounce_parts_the_row_and_a_click_before_it_is_left_out() {
        let mut times = row(0.8, 9);
        times.remove(4);
        // The release, 0.3 s before the first bounce: the fall is half a flight.
        times.insert(0, 0.7);
        let found = pooled(&[timed("a", &times)]).expect("a result");
        let r = found
            .parameters
            .restitution
            .expect("R")
            .value
            .expect("a value");
        assert!((r - 0.8).abs() < 1e-6, "{r}");
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
        assert!((r.expect("R") - 0.5).abs() < 1e-6);
        // R that rises from 0.41 to 0.53, and each impact there
        let found = pooled(&[timed("a", &changing(0.41, 0.03, 5, 0.0, 0))]).expect("a result");
        let missed = |r: &Remark| matches!(r, Remark::ImpactsMissed { .. });
        assert!(!found.remarks.iter().any(missed), "{:?}", found.remarks);
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
        assert_eq!(r.status, crate::identify::Status::Weak);
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
}
