//! Two decays whose frequencies are so near that they beat.

use super::descent::{self, Projected, equations};
use super::fits::peak;
use super::least_squares::{Point, Series};
use super::noise::{Noise, structured};
use super::shape::{Rates, Shape};
use crate::signal::columns::dot;
use crate::signal::robust;

/// When two decays are told from one. Half and twice each of these tell the same:
/// `valid_beats_are_told_over_a_range_of_the_limits`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Share of the decay that one shape must leave, beside noise, before two are tried.
    pub(super) left: f64,
    /// Squares that two decays leave beside the noise over those that one leaves, at most.
    pub(super) explained: f64,
    /// Phase by which the two run apart over the record, at least, rad.
    pub(super) apart: f64,
    /// Amplitude of either beyond which both only cancel, over the greatest excursion.
    pub(super) cancels: f64,
    /// Amplitude of the lesser over the greater one, at least.
    pub(super) telling: f64,
    /// Distances of the frequencies that are tried first, in lines of the spectrum.
    pub(super) lines: [f64; 3],
}

/// Difference of Bayes' criteria that is very strong (Kass and Raftery 1995).
const TOLD: f64 = 10.0;
/// Parameters of another decay: rates and amplitudes.
const OF_ANOTHER: f64 = 4.0;

pub(super) const LIMITS: Limits = Limits {
    left: 0.03,
    explained: 0.25,
    // half a beat
    apart: std::f64::consts::PI,
    cancels: 2.0,
    telling: 0.05,
    lines: [0.7, 1.5, 3.0],
};

/// Two decays beside each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beat {
    /// `ω_d` and σ of each, per value of the series, the stronger first.
    pub(super) rates: [[f64; 2]; 2],
    /// Amplitude of the weaker over that of the stronger.
    pub(super) ratio: f64,
    /// Squares that both leave beside the noise over those that one leaves.
    pub(super) remains: f64,
}

/// Two decays by their rates: `ω_d` and σ of each.
struct Pair<'a> {
    series: &'a Series,
    rates: [f64; 4],
    /// Factors of cosine and sine of each.
    factors: [[f64; 2]; 2],
    rest: Vec<f64>,
    squares: f64,
}

/// The two decays that explain a series that one, of whatever shape, does not.
pub(super) fn find(series: &Series, one: &Point) -> Option<Beat> {
    find_within(series, one, &LIMITS)
}

pub(super) fn find_within(series: &Series, one: &Point, limits: &Limits) -> Option<Beat> {
    let left = series.residuals(one);
    if structured(&left) < limits.left * one.level(series.values.len()) {
        return None;
    }
    let plain = Series::white(series.values.clone(), series.degree);
    let line = std::f64::consts::TAU / series.values.len() as f64;
    let [omega, sigma, ..] = one.rates;
    let starts = limits.lines.iter().flat_map(|lines| {
        let other = lines * line;
        [other, -other].map(|off| [omega - 0.2 * off, 0.5 * sigma, omega + off, 0.5 * sigma])
    });
    // further apart, the other one is the tone of what one decay leaves
    let tone = peak(&left).map(|other| [omega, sigma, other, sigma]);
    let starts = starts.chain(tone);
    let pairs = starts.filter_map(|rates| descent::descend(Pair::of(&plain, rates)?));
    let best = pairs.min_by(|a, b| a.squares.total_cmp(&b.squares))?;
    told(&best, &left, limits)
}

/// Whether two decays are told from one by what that leaves.
fn told(pair: &Pair<'_>, left: &[f64], limits: &Limits) -> Option<Beat> {
    let series = pair.series;
    let count = series.values.len() as f64;
    let centre = robust::mean(&series.values);
    let sizes = series.values.iter().map(|v| (v - centre).abs());
    let greatest = sizes.fold(0.0, f64::max);
    let [first, second] = pair.amplitudes();
    let (strong, weak) = (first.max(second), first.min(second));
    let apart = (pair.rates[0] - pair.rates[2]).abs() * count;
    let decay = pair.rates[1].min(pair.rates[3]) * count > -1.0;
    // a fit may run off beyond the frequencies that samples tell apart
    let told_apart = |omega: f64| omega > 0.0 && omega < std::f64::consts::PI;
    let remains = (structured(&pair.rest) / structured(left)).powi(2);
    let is_told = is_sure(pair, left)
        && remains < limits.explained
        && apart > limits.apart
        && told_apart(pair.rates[0])
        && told_apart(pair.rates[2])
        && decay
        && strong < limits.cancels * greatest
        && weak > limits.telling * strong;
    let [own, own_sigma, other, other_sigma] = pair.rates;
    let mut rates = [[own, own_sigma], [other, other_sigma]];
    if first < second {
        rates.reverse();
    }
    is_told.then_some(Beat {
        rates,
        ratio: weak / strong,
        remains,
    })
}

/// Whether two decays explain what one leaves surely (Schwarz 1978).
fn is_sure(pair: &Pair<'_>, left: &[f64]) -> bool {
    let density = Noise::fitted(&pair.rest, &[]).density(pair.rates[0]);
    let independent = left.len() as f64 / density.max(1.0);
    let gain = independent * (dot(left, left) / pair.squares.max(f64::MIN_POSITIVE)).ln();
    gain > TOLD + OF_ANOTHER * independent.ln()
}

/// Take the weaker of two decays of given rates per sample, the stronger first, from samples; its amplitude.
pub(super) fn take_weaker(samples: &mut [f64], [strong, weak]: [[f64; 2]; 2]) -> Option<f64> {
    let series = Series::plain(samples.to_vec());
    let pair = Pair::of(&series, [strong[0], strong[1], weak[0], weak[1]])?;
    let both = series.oscillation(Shape::Viscous, &[weak[0], weak[1], 0.0, 0.0]);
    for (column, factor) in both.iter().zip(pair.factors[1]) {
        crate::signal::columns::subtract(samples, factor, column);
    }
    Some(pair.amplitudes()[1])
}

impl<'a> Pair<'a> {
    /// The best amplitudes of two decays of given rates.
    fn of(series: &'a Series, rates: [f64; 4]) -> Option<Self> {
        let columns = linear_columns(series, rates);
        let (normal, right) = equations(&columns, &series.values);
        let linear = normal.cholesky()?.solve(&right);
        let mut rest = series.values.clone();
        for (column, factor) in columns.iter().zip(linear.iter()) {
            crate::signal::columns::subtract(&mut rest, *factor, column);
        }
        let first = linear.len() - 4;
        let factors = |k: usize| [linear[first + 2 * k], linear[first + 2 * k + 1]];
        let squares = dot(&rest, &rest);
        squares.is_finite().then(|| Self {
            series,
            rates,
            factors: [factors(0), factors(1)],
            rest,
            squares,
        })
    }

    /// Amplitudes of both.
    fn amplitudes(&self) -> [f64; 2] {
        self.factors.map(|[a, b]| a.hypot(b))
    }
}

/// The rates of each of two decays.
fn each([omega, sigma, other, of_other]: [f64; 4]) -> [Rates; 2] {
    [[omega, sigma, 0.0, 0.0], [other, of_other, 0.0, 0.0]]
}

/// Background, then cosine and sine of each decay.
fn linear_columns(series: &Series, rates: [f64; 4]) -> Vec<Vec<f64>> {
    let [first, second] = each(rates);
    let mut columns = series.linear_columns(Shape::Viscous, &first);
    columns.extend(series.oscillation(Shape::Viscous, &second));
    columns
}

impl Projected for Pair<'_> {
    fn rest(&self) -> &[f64] {
        &self.rest
    }

    fn squares(&self) -> f64 {
        self.squares
    }

    fn columns(&self) -> Vec<Vec<f64>> {
        let mut columns = linear_columns(self.series, self.rates);
        for (rates, factors) in each(self.rates).iter().zip(self.factors) {
            columns.extend(self.series.slopes(Shape::Viscous, rates, factors));
        }
        columns
    }

    fn free(&self) -> usize {
        self.rates.len()
    }

    fn moved(&self, step: &[f64]) -> Option<Self> {
        let mut rates = self.rates;
        for (rate, step) in rates.iter_mut().zip(step) {
            *rate += step;
        }
        Self::of(self.series, rates)
    }
}
