//! Dry friction beside viscous damping: how much of the damping it may be.
//!
//! A mass under x'' + 2σx' + ω0²x = −ω0² r sign x' swings from one turning point to the next about the equilibrium
//! shifted by ± r. Every swing lasts π/`ω_d`, whatever r is, so the turning points lie where they would without
//! friction, and the motion is e^{−σt}(a cos `ω_d` t + b sin `ω_d` t) + r q(t): q is the response to a square wave of
//! amplitude one that is at rest at one turning point and so at all. This holds exactly until the mass sticks and is
//! linear in r, so that r is one more column of the fit.
//!
//! A viscous fit gives v = β + ρ where ρ ≥ 0 is the damping ratio that friction is worth. The fit with r free gives
//! β, and by their difference ρ with an error that is not correlated with that of v: least squares at a fixed value
//! of a parameter are not correlated with the estimate of that parameter.

use nalgebra::Complex;

use super::least_squares::{Point, Series};
use super::prepared::{Prepared, fitted};
use super::shape::{Rates, Shape};
use super::{GROWS, Natural, damping_slopes};
use crate::signal::{robust, whole};

/// What of a motion a channel shows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum MotionSignal {
    /// Displacement, or what is proportional to it.
    #[default]
    Displacement,
    /// Velocity.
    Velocity,
    /// Acceleration.
    Acceleration,
}

/// A decay by viscous damping and dry friction of any amount.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct BesideFriction {
    /// Natural frequency f0, Hz.
    pub natural_frequency_hz: f64,
    /// Its standard error, Hz.
    pub natural_frequency_error_hz: f64,
    /// Damping ratio of the viscous damping alone.
    pub damping_ratio: f64,
    /// Its standard error were the friction known.
    pub known_friction_error: f64,
    /// Damping ratio that friction adds in a viscous fit; noise may leave it below zero.
    pub added: f64,
    /// Its standard error, which is not correlated with that of a viscous fit.
    pub added_error: f64,
    /// Degrees of freedom of the errors.
    pub freedom: f64,
    /// Friction over stiffness, over the displacement's first amplitude.
    pub rest_ratio: f64,
    /// Periods until the mass sticks, or the decay is over.
    pub periods: f64,
    /// Whether it sticks before that.
    pub sticks: bool,
}

/// Rate λ = −σ + i`ω_d` of a fit.
fn rate(rates: &Rates) -> Complex<f64> {
    Complex::new(-rates[1], rates[0])
}

/// Complex amplitude at the first sample of the displacement whose derivative a fit describes.
fn displacement(point: &Point, quantity: MotionSignal) -> Complex<f64> {
    let [a, b] = point.amplitudes();
    Complex::new(a, -b) * rate(&point.rates).powi(-(quantity as i32))
}

/// Time of a turning point near the first sample, after which the velocity is negative.
pub(super) fn turning(point: &Point, quantity: MotionSignal) -> f64 {
    let velocity = displacement(point, quantity) * rate(&point.rates);
    let phase = std::f64::consts::FRAC_PI_2 - velocity.arg();
    let turn = std::f64::consts::TAU;
    (phase - turn * (phase / turn).round()) / point.rates[0]
}

/// The response q to friction of the displacement one, at rest at its turning points.
pub(super) struct Response {
    rates: Rates,
    quantity: MotionSignal,
    /// Displacement at turning points; the one at the time that the rates name has the number `named`.
    turns: Vec<f64>,
    named: usize,
}

impl Response {
    /// From a sample before the first one to a last time, in samples.
    pub(super) fn of(rates: Rates, quantity: MotionSignal, last: f64) -> Self {
        let [omega, sigma, _, begin] = rates;
        let half = std::f64::consts::PI / omega;
        let left = (-sigma * half).exp();
        let named = whole::index(((1.0 + begin) / half).ceil().max(0.0));
        let later = whole::index(((last - begin) / half).ceil().max(0.0));
        let mut own = Self {
            rates,
            quantity,
            turns: vec![0.0; named + later + 1],
            named,
        };
        for k in (0..named).rev() {
            let about = own.about(k);
            own.turns[k] = about + (about - own.turns[k + 1]) / left;
        }
        for k in named..named + later {
            let about = own.about(k);
            own.turns[k + 1] = about - (own.turns[k] - about) * left;
        }
        own
    }

    /// Equilibrium of a swing: against a velocity that is negative after the named turning point.
    fn about(&self, swing: usize) -> f64 {
        if swing.abs_diff(self.named).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        }
    }

    /// Time of a turning point, in samples.
    fn turn(&self, swing: usize) -> f64 {
        let [omega, _, _, begin] = self.rates;
        begin + (swing as f64 - self.named as f64) * std::f64::consts::PI / omega
    }

    /// The swing to which a time belongs.
    fn swing(&self, t: f64) -> usize {
        let [omega, _, _, begin] = self.rates;
        let number = (t - begin) * omega / std::f64::consts::PI + self.named as f64;
        whole::index(number.floor().max(0.0)).min(self.turns.len() - 1)
    }

    /// At a time of a swing, in samples.
    fn at(&self, t: f64, swing: usize) -> f64 {
        let [omega, sigma, ..] = self.rates;
        let about = self.about(swing);
        let own = t - self.turn(swing);
        let swung = (self.turns[swing] - about) * (-sigma * own).exp();
        let (sin, cos) = (omega * own).sin_cos();
        let squared = omega * omega + sigma * sigma;
        match self.quantity {
            MotionSignal::Displacement => about + swung * (cos + sigma / omega * sin),
            MotionSignal::Velocity => -swung * squared / omega * sin,
            MotionSignal::Acceleration => -swung * squared * (cos - sigma / omega * sin),
        }
    }

    /// Means over as many samples as those of a series, whose swings are those of a response of near rates.
    fn means(&self, swings: &Self, series: &Series) -> Vec<f64> {
        let parts = series.factor.clamp(1, MOST_PARTS);
        let middle = 0.5 * (parts as f64 - 1.0);
        let mean = |i: usize| {
            let of = |k: usize| {
                let t = i as f64 + (k as f64 - middle) / parts as f64;
                self.at(t, swings.swing(t))
            };
            (0..parts).map(of).sum::<f64>() / parts as f64
        };
        (0..series.values.len()).map(mean).collect()
    }
}

/// Most points of a mean: a step of q is then where it is within a twentieth of a mean.
const MOST_PARTS: usize = 20;

/// Step of a difference over a rate, relative.
const STEP: f64 = 1e-6;

/// q at the samples of a series.
pub(super) fn column(series: &Series, rates: Rates) -> Vec<f64> {
    let response = Response::of(rates, series.quantity, series.values.len() as f64);
    response.means(&response, series)
}

/// Slopes of q over `ω_d` and σ at the samples of a series, the named turning point where it is.
pub(super) fn slopes(series: &Series, rates: Rates) -> [Vec<f64>; 2] {
    let last = series.values.len() as f64;
    let here = Response::of(rates, series.quantity, last);
    let step = STEP * rates[0];
    [0, 1].map(|k| {
        let moved = |by: f64| {
            let mut rates = rates;
            rates[k] += by;
            Response::of(rates, series.quantity, last + 1.0).means(&here, series)
        };
        let (after, before) = (moved(step), moved(-step));
        let pairs = after.iter().zip(&before);
        pairs.map(|(a, b)| (a - b) / (2.0 * step)).collect()
    })
}

/// The first turning point, in samples, from which no more than a swing is left: the displacement falls by 2 r from
/// one to the next and sticks within r.
fn last_turn(point: &Point, quantity: MotionSignal, count: usize) -> Option<usize> {
    let rest = point.friction().filter(|r| *r > 0.0)?;
    let response = Response::of(point.rates, MotionSignal::Displacement, count as f64);
    let own = displacement(point, quantity);
    let rate = rate(&point.rates);
    let sticks = |k: &usize| {
        let there = (own * (rate * response.turn(*k)).exp()).re + rest * response.turns[*k];
        there.abs() < 2.0 * rest
    };
    let within = |k: &usize| (0.0..count as f64).contains(&response.turn(*k));
    let mut turns = (0..response.turns.len()).filter(within);
    Some(whole::index(response.turn(turns.find(sticks)?).ceil()))
}

/// Periods of the first fit of a motion that may come to rest: three quarters, the least that has two turning points.
const FIRST_PERIODS: f64 = 0.75;
/// Most fits until the end of a motion is found: each may be twice as long as the one before.
const MOST_FITS: usize = 24;

/// Where a motion comes to rest by fits of more and more of it, if it does.
fn rests_at(series: &Series, viscous: &Point) -> Option<usize> {
    let count = series.values.len();
    let first = whole::index(FIRST_PERIODS * std::f64::consts::TAU / viscous.rates[0]);
    let mut length = first.min(count);
    for _ in 0..MOST_FITS {
        let point = series
            .part(0..length)
            .descend(Shape::Rubbed, viscous.rates)?;
        let end = last_turn(&point, series.quantity, count).unwrap_or(count);
        if end <= length || length == count {
            return Some(end.max(first)).filter(|e| *e < count);
        }
        length = end.min(2 * length);
    }
    None
}

/// The squares that a motion up to a value and rest after it leave.
fn squares_until(series: &Series, viscous: &Point, end: usize) -> Option<f64> {
    let point = series.part(0..end).descend(Shape::Rubbed, viscous.rates)?;
    let tail = &series.values[end..];
    let centre = robust::mean(tail);
    let rests: f64 = tail.iter().map(|v| (v - centre).powi(2)).sum();
    Some((point.squares + rests).max(f64::MIN_POSITIVE))
}

/// Ends that a motion may have under friction: where it comes to rest, and that of the series.
fn ends(series: &Series, viscous: &Point) -> impl Iterator<Item = usize> {
    let all = [rests_at(series, viscous), Some(series.values.len())];
    all.into_iter().flatten()
}

/// The least squares that a motion under viscous damping and friction leaves.
pub(super) fn squares(series: &Series, viscous: &Point) -> Option<f64> {
    let all = ends(series, viscous).filter_map(|end| squares_until(series, viscous, end));
    all.min_by(f64::total_cmp)
}

/// Bayes' criterion of a motion up to a value and rest after it (Schwarz 1978).
fn criterion(series: &Series, viscous: &Point, end: usize) -> Option<f64> {
    let count = series.values.len();
    // the end and the place
    let more = if end < count { 2.0 } else { 0.0 };
    let squares = squares_until(series, viscous, end)?;
    Some(count as f64 * squares.ln() + more * (count as f64).ln())
}

/// The series of a decay up to where its mass sticks, and the fit. The noise is that beside this fit, unless a rate of
/// decay that changes in another way leaves less.
fn settled(prepared: &Prepared, viscous: &Point) -> Option<(Series, Point)> {
    let mut series = prepared.series.clone();
    let count = series.values.len();
    let scored = ends(&series, viscous).filter_map(|e| Some((e, criterion(&series, viscous, e)?)));
    let (end, _) = scored.min_by(|a, b| a.1.total_cmp(&b.1))?;
    series.values.truncate(end);
    let mut point = series.descend(Shape::Rubbed, viscous.rates)?;
    let own_noise = end < count || matches!(prepared.free.shape, Shape::Viscous | Shape::Rubbed);
    if own_noise {
        point = fitted(&mut series, Shape::Rubbed, &point)?;
    }
    Some((series, point))
}

/// The decay beside friction; `None` if friction is not told from the rest at all, or would be worth so much more than
/// all damping that the rest grows: what looks like friction is something else then.
pub(super) fn beside(prepared: &Prepared, viscous: &Point, hz: f64) -> Option<BesideFriction> {
    let (series, point) = settled(prepared, viscous)?;
    let covariance = series.covariance(&point)?;
    let of_rates = covariance.view((1, 1), (2, 2)).into_owned();
    let natural = Natural::of(&point.rates, &of_rates);
    if natural.damping_ratio < -GROWS * natural.damping_ratio_error {
        return None;
    }
    let [omega, sigma, ..] = viscous.rates;
    let slopes = damping_slopes(&point.rates);
    let with_rest = slopes[0] * covariance[(0, 1)] + slopes[1] * covariance[(0, 2)];
    let added_error = with_rest.abs() / covariance[(0, 0)].sqrt();
    let known = natural.damping_ratio_error.powi(2) - added_error.powi(2);
    Some(BesideFriction {
        natural_frequency_hz: natural.frequency * hz,
        natural_frequency_error_hz: natural.frequency_error * hz,
        damping_ratio: natural.damping_ratio,
        known_friction_error: known.max(0.0).sqrt(),
        added: sigma / omega.hypot(sigma) - natural.damping_ratio,
        added_error,
        freedom: series.freedom(&point),
        rest_ratio: point.friction()? / displacement(&point, series.quantity).norm(),
        periods: series.values.len() as f64 * natural.frequency,
        sticks: series.values.len() < prepared.series.values.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::released;
    use super::super::{Watched, fit_channels};
    use super::*;

    /// Differences of a series, at the same times.
    fn differentiated(values: &[f64], rate_hz: f64) -> Vec<f64> {
        let inner = values.windows(3).map(|w| 0.5 * (w[2] - w[0]) * rate_hz);
        inner.collect()
    }

    #[test]
    fn valid_f0_beta_and_friction_are_recovered_from_motions_under_both() {
        for (damping_ratio, rest, periods) in [
            (0.05, 0.02, 2.0),
            (0.05, 0.02, 6.0),
            (0.08, 0.03, 3.0),
            (0.01, 4e-3, 10.0),
            (0.002, 1e-3, 40.0),
        ] {
            let samples = released(3.0, damping_ratio, rest, (180.0, periods));
            let channel = Watched::displacement(&samples);
            let found = fit_channels(&[channel], 180.0)[0].beside_friction.unwrap();
            assert!(
                (found.natural_frequency_hz / 3.0 - 1.0).abs() < 1e-5,
                "{found:?}"
            );
            assert!(
                (found.damping_ratio / damping_ratio - 1.0).abs() < 1e-3,
                "{found:?}"
            );
        }
    }

    #[test]
    fn valid_velocities_and_accelerations_tell_the_friction_too() {
        let fine = released(3.0, 0.02, 8e-3, (18_000.0, 4.0));
        let velocity = differentiated(&fine, 18_000.0);
        let acceleration = differentiated(&velocity, 18_000.0);
        for (quantity, values) in [
            (MotionSignal::Velocity, velocity),
            (MotionSignal::Acceleration, acceleration),
        ] {
            let values: Vec<f64> = values.into_iter().step_by(100).collect();
            let channel = Watched {
                values: &values,
                quantity,
            };
            let found = fit_channels(&[channel], 180.0)[0].beside_friction.unwrap();
            assert!(
                (found.damping_ratio / 0.02 - 1.0).abs() < 0.01,
                "{quantity:?} {found:?}"
            );
        }
    }
}
