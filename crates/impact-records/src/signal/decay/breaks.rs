//! Where a free motion breaks off: a blow before the last one has decayed, a hand that stops the mass.
//!
//! Samples a lag apart of a free decay obey x(t) = c1 x(t − L) + c2 x(t − 2L) + c0, whatever its phase. What acts on the mass
//! at t0 makes both sides differ from t0 to t0 + 2L, and no later; friction, a beat and a frequency that changes make them
//! differ as smoothly as they act. That the motion breaks is then decided by the squares that one decay and two motions
//! leave.

use super::descent::equations;
use super::fits::{factor, free, means, peak, rough};
use super::hum::Cleared;
use super::least_squares::{Point, Series};
use super::noise::Noise;
use super::shape::Shape;
use super::{blows, friction};
use crate::signal::{columns, robust, whole};

/// Root mean square of the difference within half a period over those before and after it, from which something acts.
const ACTS: f64 = 5.0;
/// Half periods within which what acts is over.
const OVER: usize = 4;
/// Fits of which each leaves out what the last one does not foresee.
const TRIMMED: usize = 3;
/// Difference of Bayes' criteria that is very strong (Kass and Raftery 1995).
const TOLD: f64 = 10.0;
/// What a fit leaves over the motion, below which it is exact.
const EXACT: f64 = 1e-6;
/// Parameters of two motions with the place of the break: offset, rates and amplitudes of each.
const OF_TWO: f64 = 11.0;
/// Those of one decay whose rates may change.
const OF_ONE: f64 = 7.0;

/// The sample at which the motion of a part breaks off, if it does.
pub(super) fn find(part: &Cleared<'_>) -> Option<usize> {
    let samples = &part.cleared;
    let begun = blows::moves(samples)?;
    let tail = &samples[begun..];
    let omega = peak(tail)?;
    let found = acts(tail, omega)?;
    // what acts once more is no part of the motion after it
    let next = acts(&tail[found..], omega).map_or(tail.len(), |next| found + next);
    let tail = &tail[..next];
    let factor = factor(omega);
    let series = Series {
        quantity: part.channel.quantity,
        factor,
        ..Series::plain(means(tail, factor))
    };
    breaks(&series, omega * factor as f64, found / factor).then_some(begun + found)
}

/// The first sample from which something acts on a motion of about a frequency, rad per sample.
fn acts(samples: &[f64], omega: f64) -> Option<usize> {
    let lag = whole::index((std::f64::consts::FRAC_PI_2 / omega).round()).max(1);
    let rest = unforeseen(samples, lag)?;
    let half = 2 * lag;
    let mut squares = vec![0.0];
    for value in &rest {
        squares.push(squares[squares.len() - 1] + value * value);
    }
    let windows = rest.len().checked_sub(half)?;
    let within = |k: usize| squares[k + half] - squares[k];
    // values that are rounded to steps
    let least = half as f64 * columns::digit(samples).powi(2) / 6.0;
    let quiet = |k: usize| {
        let after = (1..=OVER).map(|j| k + j * half).filter(|k| *k < windows);
        let after = after.map(within).fold(f64::INFINITY, f64::min);
        within(k - half).max(after).max(least)
    };
    let loud = |k: &usize| within(*k) > ACTS * ACTS * quiet(*k);
    let first = (half..windows.saturating_sub(half)).find(loud)?;
    // where they leave what they were before
    let usual = (within(first - half).max(least) / half as f64).sqrt();
    let seen = (first - half..first + half).find(|k| rest[*k].abs() > ACTS * usual)?;
    let onset = rest[..seen].iter().rposition(|r| r.abs() <= usual);
    Some(onset.map_or(seen, |k| k + 1) + half)
}

/// What samples have that those one and two lags before do not foresee, from the second lag on. What acts on the mass is
/// left out of the fit: values beyond the root mean square.
fn unforeseen(samples: &[f64], lag: usize) -> Option<Vec<f64>> {
    let now = samples.get(2 * lag..)?;
    let count = now.len();
    let columns = [
        samples[lag..lag + count].to_vec(),
        samples[..count].to_vec(),
        vec![1.0; count],
    ];
    let mut rest = now.to_vec();
    let mut kept: Vec<usize> = (0..count).collect();
    for _ in 0..TRIMMED {
        let of = |values: &[f64]| kept.iter().map(|k| values[*k]).collect::<Vec<f64>>();
        let own = columns.each_ref().map(|column| of(column));
        let (normal, right) = equations(&own, &of(now));
        let factors = normal.cholesky()?.solve(&right);
        rest = now.to_vec();
        for (column, factor) in columns.iter().zip(factors.iter()) {
            columns::subtract(&mut rest, *factor, column);
        }
        let most = robust::rms(&rest);
        kept.retain(|k| rest[*k].abs() <= most);
    }
    Some(rest)
}

/// Whether two motions, one up to a value and one after it, explain a series better than one decay, under dry friction too,
/// in the noise that is beside both.
fn breaks(series: &Series, omega: f64, at: usize) -> bool {
    let count = series.values.len();
    // the value at the break is a mean of both
    let parts = [0..at.saturating_sub(1), (at + 1).min(count)..count];
    let left = parts.map(|range| residuals(&series.part(range), omega));
    let [Some(before), Some(after)] = left else {
        return false;
    };
    let rest: Vec<f64> = before.into_iter().chain(after).collect();
    let of_two: f64 = rest.iter().map(|v| v * v).sum();
    let independent = count as f64 / Noise::fitted(&rest, &[]).density(omega).max(1.0);
    let of_one = one(series, omega).unwrap_or(f64::INFINITY);
    let all = robust::squares_about_mean(&series.values);
    let least = (EXACT * EXACT * all).max(f64::MIN_POSITIVE);
    let gain = independent * (of_one.max(least) / of_two.max(least)).ln();
    gain > TOLD + (OF_TWO - OF_ONE) * independent.ln()
}

/// The squares that one decay leaves, or one under dry friction.
fn one(series: &Series, omega: f64) -> Option<f64> {
    let viscous = viscous(series, omega)?;
    let bent = free(series, viscous.rates);
    let rubbed = friction::squares(series, &viscous);
    let squares = bent.map(|p| p.squares).into_iter().chain(rubbed);
    Some(squares.fold(viscous.squares, f64::min))
}

/// The viscous decay of a series about a frequency.
fn viscous(series: &Series, omega: f64) -> Option<Point> {
    let [found, sigma] = rough(&series.values, omega)?.rates;
    series.descend(Shape::Viscous, [found, sigma, 0.0, 0.0])
}

/// What a viscous decay, or rest, leaves of a series.
fn residuals(series: &Series, omega: f64) -> Option<Vec<f64>> {
    let centre = robust::mean(&series.values);
    let rests: Vec<f64> = series.values.iter().map(|v| v - centre).collect();
    let decays = viscous(series, omega).map(|point| series.residuals(&point));
    let squares = |rest: &[f64]| rest.iter().map(|v| v * v).sum::<f64>();
    let all = decays.into_iter().chain([rests]);
    all.min_by(|a, b| squares(a).total_cmp(&squares(b)))
        .filter(|rest| !rest.is_empty())
}
