//! What times of impacts do not contain, yet bears on R: how long contacts last, as a flight begins where one opens,
//! and how much the air slows the flights. Of heights it is instead the level above which they are.
//!
//! Where a contact of length c begins each interval D, the flight lasts D − c. In air, of drag −γ v²/a at the speed v
//! under the acceleration a, a flight of T over the one before is R (1 − (1 + R²) γ T²/16) to first order, and so is the
//! square root of the height after an impact over that before, h = a T²/8. Both make
//! the ratios rise along the bounces: the one as if R were greater, the other as if it were less. So R is an average
//! over both unknowns, each with the likelihood that the scatter of the ratios gives it ([`scatter`](super::scatter)).

use nalgebra::DVector;

use crate::methods::flight_times::fall::Fall;
use crate::methods::flight_times::rows::{Fitted, Listed, Row};
use crate::methods::flight_times::scatter::{Ratios, RowEstimate, Weighing};
use crate::statistics::quantile::NORMAL_975;
use impact_records::motion::Observation;
use impact_records::signal::robust;
use impact_records::signal::spacing::by_ratio;

/// Least and greatest length of the contact of a ball, s: of steel on glass, and of a basketball. Without a
/// statement each factor between them is as likely.
const LENGTHS_S: [f64; 2] = [5e-5, 2e-2];
/// Least and greatest γ of a ball under gravity, 1/s²: g times half the density of air times its area over its mass,
/// of steel and of a table tennis ball. Each factor between them is as likely.
const DRAGS_PER_S2: [f64; 2] = [5e-3, 1.5];
/// Probability that an interval holds. Where one of both alone is the cause, R is at the end of what is likely:
/// contacts of 8 ms in 36 lists of three throws were held in 31 with 0.95.
const CENTRAL: f64 = 0.99;
/// Values of each that are tried.
const TRIED: usize = 25;

/// What the unknowns change of R.
pub(super) struct Unlisted {
    /// Expected change of R from that of contacts without length and flights without air.
    pub(super) change: f64,
    /// Standard error of R by them.
    pub(super) error: f64,
    /// The most likely length of the contacts, s, where both edges of their pulses are known.
    pub(super) contact_s: Option<f64>,
}

impl Unlisted {
    /// Of rows with their fits and what each tells of R, whose times are those at which contacts close; `stated_s`: the
    /// times' standard error as their source states it.
    pub(super) fn of(
        rows: &[(&Row, Fitted)],
        estimates: &[&RowEstimate],
        observations: &[Observation],
        stated_s: Option<f64>,
    ) -> Self {
        let pulse_s = pulse_s(rows, observations);
        let unknowns = tried_of_all(rows, pulse_s);
        let drags: Vec<f64> = by_ratio(DRAGS_PER_S2, TRIED).collect();
        let changes: Vec<Vec<RowChange>> = unknowns
            .iter()
            .map(|unknown| {
                let each = rows.iter().zip(estimates);
                each.map(|((row, _), own)| RowChange::of(row, own, *unknown))
                    .collect()
            })
            .collect();
        let logarithms = likelihoods(rows, (&changes, &drags), stated_s);
        let best = logarithms.iter().flatten().copied();
        let best = best.fold(f64::NEG_INFINITY, f64::max);
        let likely =
            |logarithms: &[f64]| logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let lengths = unknowns.iter().zip(&logarithms);
        let likeliest = lengths.max_by(|a, b| likely(a.1).total_cmp(&likely(b.1)));
        let contact_s = pulse_s.and(likeliest).map(|(length_s, _)| *length_s);
        let weight = |own: &RowEstimate| own.error.max(1e-9).powi(-2);
        let all: f64 = estimates.iter().map(|own| weight(own)).sum();
        let mean = |of_rows: &[RowChange], drag: f64| {
            let each = of_rows.iter().zip(estimates);
            let each = each.map(|(of_row, own)| weight(own) * of_row.of_mean(own, drag));
            each.sum::<f64>() / all
        };
        let tried = changes.iter().zip(&logarithms);
        let tried = tried.flat_map(|(of_rows, logarithms)| {
            let each = drags.iter().zip(logarithms);
            each.map(|(drag, logarithm)| (mean(of_rows, *drag), (logarithm - best).exp()))
        });
        Self {
            contact_s,
            ..Self::over(tried.collect())
        }
    }

    /// Over changes with their likelihoods: their mean, and the error of which 1.96 hold [`CENTRAL`].
    fn over(mut tried: Vec<(f64, f64)>) -> Self {
        tried.sort_by(|a, b| a.0.total_cmp(&b.0));
        let all: f64 = tried.iter().map(|(_, likely)| likely).sum();
        let change = tried
            .iter()
            .map(|(change, likely)| change * likely)
            .sum::<f64>()
            / all;
        let reached = |share: f64| {
            let mut sum = 0.0;
            let at = tried.iter().find(|(_, likely)| {
                sum += likely / all;
                sum >= share
            });
            at.map_or(change, |(reached, _)| *reached)
        };
        let [low, high] = [0.5 - 0.5 * CENTRAL, 0.5 + 0.5 * CENTRAL].map(reached);
        Self {
            change,
            error: (change - low).max(high - change).max(0.0) / NORMAL_975,
            contact_s: None,
        }
    }
}

/// Least and greatest height, m, by which all may be too great, as of a ball's middle: half of a marble and of a
/// basketball. Each factor between them is as likely, and that they are right as all of these.
const OFFSETS_M: [f64; 2] = [5e-3, 0.12];

/// Heights by which all may be too great, m, less than half the lowest.
fn offsets_m(falls: &[&Fall]) -> Vec<f64> {
    let lowest_m = falls
        .iter()
        .map(|f| f.after_m)
        .fold(f64::INFINITY, f64::min);
    let some = by_ratio(OFFSETS_M.map(|m| m.min(0.5 * lowest_m)), TRIED / 2);
    some.chain(std::iter::repeat_n(0.0, TRIED / 2)).collect()
}

/// Median length of the pulses of the contacts, s, where times of impacts are listed with both edges.
fn pulse_s(rows: &[(&Row, Fitted)], observations: &[Observation]) -> Option<f64> {
    let times = rows.iter().filter(|(row, _)| row.falls().is_none());
    let pulses = times.flat_map(|(row, _)| {
        let impacts = observations[row.record].impacts.iter();
        impacts.filter_map(|i| i.contact_duration_s)
    });
    robust::median(&pulses.collect::<Vec<_>>())
}

/// What is tried of the unknown of all impacts: heights by which all may be too great, m, or lengths of contacts, s. These
/// are up to those of pulses with both edges, as an instrument may make a pulse longer than the touch; else
/// all usual ones that leave flights.
fn tried_of_all(rows: &[(&Row, Fitted)], pulse_s: Option<f64>) -> Vec<f64> {
    let falls = rows.iter().filter_map(|(row, _)| row.falls());
    let falls: Vec<&Fall> = falls.flatten().collect();
    if !falls.is_empty() {
        return offsets_m(&falls);
    }
    let flights = rows.iter().flat_map(|(row, _)| row.flights_s());
    let longest_s = 0.5 * flights.flatten().fold(f64::INFINITY, f64::min);
    match pulse_s {
        Some(pulse_s) => {
            let share = |k: usize| k as f64 / (TRIED - 1) as f64;
            (0..TRIED)
                .map(|k| share(k) * pulse_s.min(longest_s))
                .collect()
        }
        None => by_ratio(LENGTHS_S.map(|s| s.min(longest_s)), TRIED).collect(),
    }
}

/// What the unknown of all impacts changes of the logarithms of a row's ratios, and what air of γ = 1/s² takes from them.
struct RowChange {
    by_unknown: DVector<f64>,
    by_air: DVector<f64>,
}

impl RowChange {
    fn of(row: &Row, own: &RowEstimate, unknown: f64) -> Self {
        let flights = row.flights_s();
        let left = |of: f64| (1.0 - unknown / of).ln();
        let changed = |[before, after]: [f64; 2]| left(after) - left(before);
        let (by_unknown, length_s): (Vec<f64>, f64) = match &row.listed {
            Listed::Times(_) => (flights.iter().map(|pair| changed(*pair)).collect(), unknown),
            Listed::Heights(falls) => {
                let root = |f: &Fall| 0.5 * changed([f.before_m, f.after_m]);
                (falls.iter().map(root).collect(), 0.0)
            }
        };
        let of_both = (1.0 + own.restitution.powi(2)) / 16.0;
        let by_air = flights
            .iter()
            .map(|[before, _]| of_both * (before - length_s).powi(2));
        Self {
            by_unknown: by_unknown.into(),
            by_air: DVector::from_iterator(flights.len(), by_air),
        }
    }

    /// Change of the row's R, whose logarithm is a weighted mean of those of the ratios.
    fn of_mean(&self, own: &RowEstimate, drag: f64) -> f64 {
        let each = self.by_unknown.iter().zip(&self.by_air).zip(&own.weights);
        let logarithm: f64 = each
            .map(|((l, air), weight)| weight * (l + drag * air))
            .sum();
        own.restitution * logarithm.exp_m1()
    }
}

/// Logarithms of the restricted likelihoods, over the ratio of the variances of R and of the times, of each length
/// and each drag. No scatter is less than what the source of the times states.
fn likelihoods(
    rows: &[(&Row, Fitted)],
    (changes, drags): (&[Vec<RowChange>], &[f64]),
    stated_s: Option<f64>,
) -> Vec<Vec<f64>> {
    let ratios = Ratios::of(rows.iter().map(|(row, _)| *row));
    let mut sums = vec![vec![f64::NEG_INFINITY; drags.len()]; changes.len()];
    let freedom = ratios.freedom();
    if freedom == 0.0 {
        return vec![vec![0.0; drags.len()]; changes.len()];
    }
    let least = freedom * ratios.of_times(stated_s.unwrap_or(0.0));
    for own in ratios.own_variances() {
        let Some(weighted) = Weighted::of(&ratios, own) else {
            continue;
        };
        for (of_rows, sums) in changes.iter().zip(&mut sums) {
            let squares = weighted.squares(&ratios, of_rows);
            for (drag, sum) in drags.iter().zip(sums) {
                let squares = squares[0] + drag * (squares[1] + drag * squares[2]);
                let squares = squares.max(least).max(f64::MIN_POSITIVE);
                let beyond = ratios.beyond(squares / freedom, stated_s);
                let logarithm = weighted.weight - 0.5 * freedom * squares.ln() - beyond;
                let (low, high) = (sum.min(logarithm), sum.max(logarithm));
                *sum = high + (low - high).exp().ln_1p();
            }
        }
    }
    sums
}

/// The rows' logarithms, each weighed for one ratio of the variances.
struct Weighted {
    rows: Vec<Weighing>,
    /// −½ ln of the determinants.
    weight: f64,
}

impl Weighted {
    fn of(ratios: &Ratios, own: f64) -> Option<Self> {
        let rows = ratios.rows.iter();
        let rows = rows.map(|row| Weighing::of(ratios.covariance(row, own)));
        let rows: Vec<Weighing> = rows.collect::<Option<_>>()?;
        let weight = rows.iter().map(Weighing::logarithm).sum();
        Some(Self { rows, weight })
    }

    /// Squares about each row's mean, a polynomial in the drag.
    fn squares(&self, ratios: &Ratios, changes: &[RowChange]) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for ((row, change), weighing) in ratios.rows.iter().zip(changes).zip(&self.rows) {
            let values = weighing.centred(&(&row.values + &change.by_unknown));
            let air = weighing.centred(&change.by_air);
            let [of_values, of_air] = [&values, &air].map(|v| weighing.factor.solve(v));
            sums[0] += values.dot(&of_values);
            sums[1] += 2.0 * air.dot(&of_values);
            sums[2] += air.dot(&of_air);
        }
        sums
    }
}
