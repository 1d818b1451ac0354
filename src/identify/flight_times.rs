//! R from the times of impacts alone: under a constant force a flight lasts 2v/a, so that each flight is
//! R times as long as the one before.
//!
//! The times of a record are a geometric row, `t_k = t_0 + T_0 (1 + R + … + R^(k−1))`; R, `t_0` and `T_0` are
//! fitted to them by least squares with the error of each time as the noise.

use nalgebra::{Matrix3, Vector3};

use crate::identify::diagnostics::structure::{self, GroupedRatio, ImpactGroup, ImpactGroups};
use crate::identify::diagnostics::verdict::judge_structure;
use crate::identify::estimate;
use crate::identify::fit::parameters::Coordinate;
use crate::identify::identification::MethodResult;
use crate::identify::messages::Remark;
use crate::motion::Observation;
use crate::signal::robust;

/// Ratios of a flight to the one before, relative to the median, outside of which an impact was missed
/// or something else was heard.
const PLAUSIBLE: [f64; 2] = [0.6, 1.6];
/// Greatest ratio that is possible but for errors of the times.
const GREATEST: f64 = 1.05;
/// Standard error of a time that neither its source nor the scatter states, s.
const USUAL_ERROR_S: f64 = 2e-3;
/// Degrees of freedom from which the scatter states the error of the times.
const ENOUGH: usize = 3;

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
    squares: f64,
    freedom: usize,
}

/// Whether R of a record rests on the times of its impacts: it has neither drive nor speeds.
pub fn is_timed(o: &Observation) -> bool {
    let no_speed = |i: &crate::event::Impact| i.approach_speed_before_m_s.is_none();
    o.drive.is_none() && o.impacts.len() > 2 && o.impacts.iter().all(no_speed)
}

/// R of all records whose impacts are known by their times alone; `None` without any.
pub fn pooled(observations: &[Observation]) -> Option<MethodResult> {
    let timed = |(_, o): &(usize, &Observation)| !o.excluded() && is_timed(o);
    let records: Vec<(usize, &Observation)> =
        observations.iter().enumerate().filter(timed).collect();
    let (rows, left_out) = rows(&records);
    let fits: Vec<(&Row, Fitted)> = rows
        .iter()
        .filter_map(|row| Some((row, fitted(&row.times_s)?)))
        .collect();
    if fits.is_empty() {
        return None;
    }
    let error_s = time_error_s(&fits, &records);
    let groups: Vec<ImpactGroup> = fits
        .iter()
        .map(|(row, fit)| ImpactGroup {
            group: observations[row.record].record.clone(),
            impacts: row.times_s.len(),
            speed_m_s: None,
            restitution: fit.restitution,
            standard_error: fit.error_per_s * error_s,
        })
        .collect();
    let (value, error) = weighted(&groups);
    let ratios: Vec<GroupedRatio> = fits
        .iter()
        .flat_map(|(row, _)| ratios(row, error_s))
        .collect();
    let mut result = MethodResult {
        observations: fits.iter().map(|(row, _)| row.times_s.len()).sum(),
        records: records.len(),
        fits: Some(true),
        ..MethodResult::default()
    };
    let restitution = estimate::estimate(Coordinate::Restitution, value, error);
    result.parameters.restitution = Some(restitution);
    result.impact_groups = Some(ImpactGroups {
        by_record: groups,
        ..structure::groups(&ratios, observations)
    });
    result.remarks.push(Remark::TimesScatter { error_s });
    if left_out > 0 {
        result
            .remarks
            .push(Remark::FlightsLeftOut { count: left_out });
    }
    if let Some(grouping) = structure::structure(&ratios) {
        judge_structure(&mut result, grouping);
    }
    Some(result)
}

/// The rows of all records, and how many flights belong to none.
fn rows(records: &[(usize, &Observation)]) -> (Vec<Row>, usize) {
    let flights = |o: &Observation| -> Vec<f64> {
        let times = o.impacts.windows(2);
        times.map(|w| w[1].time_s - w[0].time_s).collect()
    };
    let all: Vec<f64> = records
        .iter()
        .flat_map(|(_, o)| {
            flights(o)
                .windows(2)
                .map(|w| w[1] / w[0])
                .collect::<Vec<_>>()
        })
        .filter(|r| *r < GREATEST)
        .collect();
    let Some(median) = robust::median(&all) else {
        return (Vec::new(), 0);
    };
    let plausible = |r: f64| r > PLAUSIBLE[0] * median && r < (PLAUSIBLE[1] * median).min(GREATEST);
    let (mut rows, mut left_out) = (Vec::new(), 0);
    for (record, o) in records {
        let flights = flights(o);
        let mut begin = 0;
        for end in 1..=flights.len() {
            let goes_on = end < flights.len() && plausible(flights[end] / flights[end - 1]);
            if goes_on {
                continue;
            }
            if end - begin < 2 {
                left_out += end - begin;
            } else {
                rows.push(Row {
                    record: *record,
                    first: begin,
                    times_s: o.impacts[begin..=end].iter().map(|i| i.time_s).collect(),
                });
            }
            begin = end;
        }
    }
    (rows, left_out)
}

/// Gauss–Newton for `t_0`, `T_0` and R from the ratio of the first two flights.
fn fitted(times_s: &[f64]) -> Option<Fitted> {
    let freedom = times_s.len().checked_sub(3)?;
    let (first, second) = (times_s[1] - times_s[0], times_s[2] - times_s[1]);
    let mut at = Vector3::new(times_s[0], first, second / first);
    let mut normal = Matrix3::zeros();
    let mut squares = 0.0;
    for _ in 0..40 {
        normal = Matrix3::zeros();
        let mut right = Vector3::zeros();
        squares = 0.0;
        let (mut sum, mut slope, mut power, mut power_slope) = (0.0, 0.0, 1.0, 0.0);
        for time in times_s {
            let row = Vector3::new(1.0, sum, at[1] * slope);
            let residual = time - at[0] - at[1] * sum;
            normal += row * row.transpose();
            right += row * residual;
            squares += residual * residual;
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
        squares,
        freedom,
    })
}

/// Standard error of the times, s: as they scatter about the rows, at least as their source states.
fn time_error_s(fits: &[(&Row, Fitted)], records: &[(usize, &Observation)]) -> f64 {
    let errors: Vec<f64> = records
        .iter()
        .flat_map(|(_, o)| o.impacts.iter().map(|i| i.time_error_s))
        .collect();
    let stated = robust::median(&errors).unwrap_or(0.0);
    let freedom: usize = fits.iter().map(|(_, f)| f.freedom).sum();
    if freedom < ENOUGH {
        return stated.max(USUAL_ERROR_S);
    }
    let squares: f64 = fits.iter().map(|(_, f)| f.squares).sum();
    stated.max((squares / freedom as f64).sqrt())
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
    use crate::event::Impact;
    use crate::motion::Motion;

    /// A record of impacts at given times, without speeds.
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
