//! Rows of consecutive impacts, and the geometric row of times that fits each.

use nalgebra::{Matrix3, Vector3};

use crate::methods::flight_times::fall::Fall;
use impact_records::motion::Observation;
use impact_records::signal::robust;

/// Ratios of a flight to the one before, relative to the median, outside of which an impact was missed
/// or something else was heard.
const PLAUSIBLE: [f64; 2] = [0.6, 1.6];
/// Ratio to the flight before from which on a lone one is the time between two throws of one list.
const REST: f64 = 3.0;
/// Greatest ratio that is possible but for errors of the times.
const GREATEST: f64 = 1.05;

/// Consecutive impacts of a record, none missing between them.
#[derive(Debug, Clone)]
pub(super) struct Row {
    pub(super) record: usize,
    /// Number of its first flight in the record.
    pub(super) first: usize,
    pub(super) listed: Listed,
}

/// What of a row's impacts is listed.
#[derive(Debug, Clone)]
pub(super) enum Listed {
    /// The times of impacts, s.
    Times(Vec<f64>),
    /// The heights before and after each impact, m.
    Heights(Vec<Fall>),
}

impl Row {
    /// Its falls, if it lists heights.
    pub(super) fn falls(&self) -> Option<&[Fall]> {
        match &self.listed {
            Listed::Heights(falls) => Some(falls),
            Listed::Times(_) => None,
        }
    }

    /// The flights before and after each impact between two, s.
    pub(super) fn flights_s(&self) -> Vec<[f64; 2]> {
        match &self.listed {
            Listed::Times(times_s) => {
                let triples = times_s.windows(3);
                triples.map(|t| [t[1] - t[0], t[2] - t[1]]).collect()
            }
            Listed::Heights(falls) => falls.iter().map(Fall::flights_s).collect(),
        }
    }

    /// The row with its flights alone: without the contacts of a length, s, at which they begin.
    pub(super) fn without_contacts(&self, contact_s: f64) -> Self {
        let listed = match &self.listed {
            Listed::Times(times_s) => {
                let times = times_s.iter().enumerate();
                Listed::Times(times.map(|(k, t)| t - k as f64 * contact_s).collect())
            }
            heights @ Listed::Heights(_) => heights.clone(),
        };
        Self {
            listed,
            ..self.clone()
        }
    }

    /// Number of impacts.
    pub(super) fn impacts(&self) -> usize {
        match &self.listed {
            Listed::Times(times_s) => times_s.len(),
            Listed::Heights(falls) => falls.len(),
        }
    }

    /// Number of the bounce of each ratio.
    pub(super) fn bounces(&self) -> Vec<usize> {
        match &self.listed {
            Listed::Times(times_s) => {
                let last = self.first + times_s.len().saturating_sub(2);
                (self.first..last).collect()
            }
            Listed::Heights(falls) => falls.iter().map(|fall| fall.bounce).collect(),
        }
    }
}

/// The geometric row that fits.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fitted {
    pub(super) restitution: f64,
    /// Standard error of R for a standard error of 1 s of each time, or of 1 m of each height.
    pub(super) error_per_unit: f64,
}

/// The rows of all records.
#[derive(Default)]
pub(super) struct Rows {
    pub(super) rows: Vec<Row>,
    /// Flights that belong to none.
    pub(super) left_out: usize,
    /// Where an impact is missing: the record's index and the time, s.
    pub(super) missed: Vec<(usize, f64)>,
    /// Where a top between heights is missing: the record's index and the height before it, m.
    pub(super) skipped: Vec<(usize, f64)>,
}

/// The rows of all records, parted where a flight does not follow from the one before.
pub(super) fn rows(records: &[(usize, &Observation)]) -> Rows {
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
        let two = (1..flights.len()).filter_map(|k| Some((k, two_in_one(&ratios, k, median)?)));
        let two: Vec<(usize, f64)> = two.chain(two_at_an_end(&ratios)).collect();
        let first =
            |(k, r): &(usize, f64)| (*record, o.impacts[*k].time_s + flights[*k] / (1.0 + r));
        found.missed.extend(two.iter().map(first));
        let missed: Vec<usize> = two.iter().map(|(k, _)| *k).collect();
        let mut begin = 0;
        for end in 1..=flights.len() {
            let beside = missed.contains(&end) || missed.contains(&(end - 1));
            let goes_on = end < flights.len() && !beside && plausible(ratios[end - 1]);
            if goes_on {
                continue;
            }
            if end - begin < 2 {
                let rests = begin > 0 && ratios[begin - 1] > REST;
                found.left_out += usize::from(!rests);
            } else {
                found.rows.push(Row {
                    record: *record,
                    first: begin,
                    listed: Listed::Times(
                        o.impacts[begin..=end].iter().map(|i| i.time_s).collect(),
                    ),
                });
            }
            begin = end;
        }
    }
    found
}

/// How far the ratio of the flight after one that is two may be off what R of the two gives, relative.
const AS_TWO: f64 = 0.15;

/// R where a flight is two, the impact between them missing: the ratios to the flight before and of the one
/// after are R(1 + R) and R²/(1 + R), nearer to that than to R both; or the flight is longer than the one before, and
/// what follows is of the R that the two give.
fn two_in_one(ratios: &[f64], flight: usize, restitution: f64) -> Option<f64> {
    let (to, from) = (ratios.get(flight - 1)?, ratios.get(flight)?);
    let own = 0.5 * ((1.0 + 4.0 * to).sqrt() - 1.0);
    if *to > GREATEST && own < GREATEST && (from * (1.0 + own) / own.powi(2)).ln().abs() < AS_TWO {
        return Some(own);
    }
    let (sum, half) = (1.0 + restitution, 0.5 * (1.0 + restitution).ln());
    let near = |ratio: f64, two: f64| (ratio / two).ln().abs() < half;
    let both = near(*to, restitution * sum) && near(*from, restitution.powi(2) / sum);
    both.then_some(restitution)
}

/// R where the first flight of a row, or the last one, is two: its ratio to the flight beside it is then R²/(1 + R) or
/// R(1 + R), where the next ratio is R.
fn two_at_an_end(ratios: &[f64]) -> Option<(usize, f64)> {
    let &[first, second, ..] = ratios else {
        return None;
    };
    let &[.., before, last] = ratios else {
        return None;
    };
    let near = |ratio: f64, two: f64| (ratio / two).ln().abs() < AS_TWO;
    if second < GREATEST && near(first, second.powi(2) / (1.0 + second)) {
        Some((0, second))
    } else if before < GREATEST && near(last, before * (1.0 + before)) {
        Some((ratios.len(), before))
    } else {
        None
    }
}

/// Gauss–Newton for `t_0`, `T_0` and R from the ratio of the first two flights.
pub(super) fn fitted_times(times_s: &[f64]) -> Option<Fitted> {
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
        error_per_unit: variance.sqrt(),
    })
}
