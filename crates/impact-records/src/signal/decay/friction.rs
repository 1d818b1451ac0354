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

use super::change::LEAST_TESTED;
use super::fits::fitted;
use super::least_squares::{Point, Series};
use super::natural::{GROWS, damping_slopes};
use super::onset::{self, OpenOnset};
use super::prepared::Prepared;
use super::response::{Response, rate};
use super::shape::Shape;
use super::watched::MotionSignal;
use crate::signal::whole;

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
    /// Whether the fall of the amplitude alone tells it, as harmonics of another cause contradict it.
    #[serde(default)]
    pub by_fall: bool,
    /// Friction over stiffness, over the displacement's first amplitude.
    pub rest_ratio: f64,
    /// Periods until the mass sticks, or the decay is over.
    pub periods: f64,
    /// Whether it sticks before that.
    pub sticks: bool,
    /// Periods from the first fitted sample on after which more friction begins; `None` if it does not change.
    #[serde(default)]
    pub begins: Option<f64>,
    /// Periods until which it does not begin.
    #[serde(default)]
    pub unchanged: Option<f64>,
    /// What is open because it is not known when friction begins.
    #[serde(default)]
    pub open: OpenOnset,
}

impl BesideFriction {
    /// Periods until dry friction holds the mass, if they are enough to test what damps it.
    pub(super) fn rest(&self) -> Option<f64> {
        Some(self.periods).filter(|periods| self.sticks && *periods >= LEAST_TESTED)
    }
}

/// The first turning point, in samples, from which no more than a swing is left: the displacement falls by 2 r from
/// one to the next and sticks within r.
fn last_turn(point: &Point, quantity: MotionSignal, count: usize) -> Option<usize> {
    let rest = point.friction().filter(|r| *r > 0.0)?;
    let response = Response::of(point.rates, MotionSignal::Displacement, count as f64);
    let own = point.displacement(quantity);
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

/// Root mean square of what is no motion any more over that of what the fit to the motion leaves, at most.
const QUIET: f64 = 3.0;

/// The squares that a motion up to a value and rest after it leave, both over a background; `None` where what follows
/// does not rest, as where two motions that beat have cancelled each other.
fn squares_until(series: &Series, viscous: &Point, end: usize) -> Option<f64> {
    let point = series.part(0..end).descend(Shape::Rubbed, viscous.rates)?;
    let after = series.part(end..series.values.len());
    // no more values than the background has factors are met whatever they are
    let rests = after.squares_about_background().unwrap_or(0.0);
    let exact = (1e-6 * point.displacement(series.quantity).norm()).powi(2);
    let quiet = QUIET * QUIET * (point.squares / end as f64).max(exact);
    let all = (point.squares + rests).max(f64::MIN_POSITIVE);
    (rests <= quiet * after.values.len() as f64).then_some(all)
}

/// Parts of a series, each from its beginning, whose fits are asked where the motion ends: where noise hides the end from
/// fits of more and more of it, one of them holds most of the motion and little of the rest.
const PARTS: usize = 8;

/// Ends that a motion may have under friction: where it comes to rest, as fits of parts have it, and that of the series.
fn ends(series: &Series, viscous: &Point) -> impl Iterator<Item = usize> {
    let count = series.values.len();
    let of_part = |k: usize| {
        let part = series.part(0..k * count / PARTS);
        let point = part.descend(Shape::Rubbed, viscous.rates)?;
        last_turn(&point, series.quantity, count).filter(|end| *end < count)
    };
    let mut all: Vec<usize> = (1..=PARTS).filter_map(of_part).collect();
    all.extend(rests_at(series, viscous));
    all.push(count);
    all.sort_unstable();
    all.dedup();
    all.into_iter()
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
    Some(beside_harmonics(&series, &point).unwrap_or((series, point)))
}

/// What a fit leaves over the motion, below which it is exact.
const EXACT: f64 = 1e-6;
/// Squares that harmonics leave of those without them, at most, where there are some.
const LESS: f64 = 0.95;
/// Normal deviate from which friction by its harmonics and friction by the fall of the amplitude are not the same.
const APART: f64 = 3.3;

/// The fit with harmonics of the motion beside it, where it has another friction: a spring that is not straight makes harmonics
/// too, and the fall of the amplitude alone tells friction then.
fn beside_harmonics(series: &Series, point: &Point) -> Option<(Series, Point)> {
    let [omega, sigma, ..] = point.rates;
    let mut own = series.clone();
    let harmonics = [2.0, 3.0].map(|order| [order * omega, order * sigma]);
    let below = harmonics.iter().filter(|[w, _]| *w < std::f64::consts::PI);
    own.taken.extend(below);
    let found = fitted(&mut own, Shape::Rubbed, point)?;
    let squares = |series: &Series, point: &Point| {
        let rest = series.residuals(point);
        rest.iter().map(|v| v * v).sum::<f64>()
    };
    let count = series.values.len();
    let left = squares(series, point);
    let exact = (EXACT * point.level(count)).powi(2) * count as f64;
    if left < exact || squares(&own, &found) > LESS * left {
        return None;
    }
    let known = [(series, point), (&own, &found)].map(|(series, point)| {
        let variance = series.covariance(point)?[(0, 0)];
        Some((point.friction()?, variance))
    });
    let [Some((by_both, less)), Some((by_fall, more))] = known else {
        return None;
    };
    let apart = (by_fall - by_both).abs();
    (apart > APART * (more - less).max(0.0).sqrt()).then_some((own, found))
}

/// The decay beside friction; `None` if friction is not told from the rest at all, or would be worth so much more than
/// all damping that the rest grows: what looks like friction is something else then.
pub(super) fn beside(prepared: &Prepared, viscous: &Point, hz: f64) -> Option<BesideFriction> {
    let (series, point) = settled(prepared, viscous)?;
    let by_fall = series.taken.len() > prepared.series.taken.len();
    let begun = onset::find(series, point)?;
    let (series, point) = (&begun.series, &begun.point);
    let (covariance, natural) = (&begun.covariance, &begun.natural);
    if natural.damping_ratio < -GROWS * natural.damping_ratio_error {
        return None;
    }
    let slopes = damping_slopes(&point.rates);
    let with_rest = slopes[0] * covariance[(0, 1)] + slopes[1] * covariance[(0, 2)];
    let added_error = with_rest.abs() / covariance[(0, 0)].sqrt();
    let rest = point.friction()?;
    let [omega, sigma, ..] = viscous.rates;
    // a viscous fit has what begins on the way too
    let added = if series.frictions.len() > 1 {
        -with_rest / covariance[(0, 0)] * rest
    } else {
        sigma / omega.hypot(sigma) - natural.damping_ratio
    };
    let known = natural.damping_ratio_error.powi(2) - added_error.powi(2);
    let periods = begun.after();
    let periods = periods.map(|times| times.map(|t| t * natural.frequency));
    Some(BesideFriction {
        natural_frequency_hz: natural.frequency * hz,
        natural_frequency_error_hz: natural.frequency_error * hz,
        damping_ratio: natural.damping_ratio,
        known_friction_error: known.max(0.0).sqrt(),
        added,
        added_error,
        freedom: series.freedom(point),
        by_fall,
        rest_ratio: rest / point.displacement(series.quantity).norm(),
        periods: series.values.len() as f64 * natural.frequency,
        sticks: series.values.len() < prepared.series.values.len(),
        begins: periods.map(|p| p[0]),
        unchanged: periods.map(|p| p[1]),
        open: begun.open,
    })
}
