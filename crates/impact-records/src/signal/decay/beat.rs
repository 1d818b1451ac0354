//! Two decays whose frequencies are so near that they beat.

use super::least_squares::{Point, Series, equations};
use super::noise::structured;
use super::shape::{Rates, Shape};
use crate::signal::columns::dot;
use crate::signal::robust;

/// Share of the decay that one shape must leave, beside noise, before two are tried.
const LEFT: f64 = 0.03;
/// Squares that two decays leave over those that one leaves, at most.
const EXPLAINED: f64 = 0.25;
/// Distances of the frequencies that are tried first, in lines of the spectrum.
const LINES: [f64; 3] = [0.7, 1.5, 3.0];
/// Phase by which the two run apart over the record, at least, rad: half a beat.
const APART: f64 = std::f64::consts::PI;
/// Amplitude of either beyond which both only cancel, over the greatest excursion.
const CANCELS: f64 = 2.0;
/// Amplitude of the lesser over the greater one, at least.
const TELLING: f64 = 0.05;
/// Steps of the descent.
const STEPS: usize = 30;

/// Two decays beside each other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beat {
    /// Their frequencies, rad per sample of the series, the stronger first.
    pub(super) frequencies: [f64; 2],
    /// Amplitude of the weaker over that of the stronger.
    pub(super) ratio: f64,
}

/// Two decays by their rates: `ω_d` and σ of each.
struct Pair {
    rates: [f64; 4],
    amplitudes: [f64; 2],
    rest: Vec<f64>,
    squares: f64,
}

/// The two decays that explain a series that one, of whatever shape, does not.
pub(super) fn find(series: &Series, one: &Point) -> Option<Beat> {
    let left = series.residuals(one);
    if structured(&left) < LEFT * one.level(series.values.len()) {
        return None;
    }
    let plain = Series::white(series.values.clone(), series.degree);
    let line = std::f64::consts::TAU / series.values.len() as f64;
    let [omega, sigma, ..] = one.rates;
    let starts = LINES.iter().flat_map(|lines| {
        let other = lines * line;
        [other, -other].map(|off| [omega - 0.2 * off, 0.5 * sigma, omega + off, 0.5 * sigma])
    });
    let pairs = starts.filter_map(|rates| descend(&plain, rates));
    let best = pairs.min_by(|a, b| a.squares.total_cmp(&b.squares))?;
    told(&plain, &best, dot(&left, &left))
}

/// Whether two decays are told from one that leaves squares.
fn told(series: &Series, pair: &Pair, of_one: f64) -> Option<Beat> {
    let count = series.values.len() as f64;
    let centre = robust::mean(&series.values);
    let sizes = series.values.iter().map(|v| (v - centre).abs());
    let greatest = sizes.fold(0.0, f64::max);
    let [first, second] = pair.amplitudes;
    let (strong, weak) = (first.max(second), first.min(second));
    let apart = (pair.rates[0] - pair.rates[2]).abs() * count;
    let decay = pair.rates[1].min(pair.rates[3]) * count > -1.0;
    let is_told = pair.squares < EXPLAINED * of_one
        && apart > APART
        && decay
        && strong < CANCELS * greatest
        && weak > TELLING * strong;
    let frequencies = if first >= second {
        [pair.rates[0], pair.rates[2]]
    } else {
        [pair.rates[2], pair.rates[0]]
    };
    is_told.then_some(Beat {
        frequencies,
        ratio: weak / strong,
    })
}

/// The best amplitudes of two decays of given rates.
fn project(series: &Series, rates: [f64; 4]) -> Option<Pair> {
    let [first, second]: [Rates; 2] = [
        [rates[0], rates[1], 0.0, 0.0],
        [rates[2], rates[3], 0.0, 0.0],
    ];
    let mut columns = series.linear_columns(Shape::Viscous, &first);
    columns.extend(series.oscillation(Shape::Viscous, &second));
    let (normal, right) = equations(&columns, &series.values);
    let linear = normal.cholesky()?.solve(&right);
    let mut rest = series.values.clone();
    for (column, factor) in columns.iter().zip(linear.iter()) {
        crate::signal::columns::subtract(&mut rest, *factor, column);
    }
    let count = linear.len();
    let amplitude = |from: usize| linear[from].hypot(linear[from + 1]);
    let squares = dot(&rest, &rest);
    squares.is_finite().then(|| Pair {
        rates,
        amplitudes: [amplitude(count - 4), amplitude(count - 2)],
        rest,
        squares,
    })
}

/// The two decays of the least squares from a start, by Levenberg and Marquardt with differences.
fn descend(series: &Series, start: [f64; 4]) -> Option<Pair> {
    let mut pair = project(series, start)?;
    let step = 1e-4 / series.values.len() as f64;
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        let slopes: Option<Vec<Vec<f64>>> = (0..4)
            .map(|k| {
                let mut rates = pair.rates;
                rates[k] += step;
                let moved = project(series, rates)?.rest;
                let slopes = moved.iter().zip(&pair.rest);
                Some(slopes.map(|(m, r)| (r - m) / step).collect())
            })
            .collect();
        let (mut normal, right) = equations(&slopes?, &pair.rest);
        for k in 0..4 {
            normal[(k, k)] *= 1.0 + damping;
        }
        let Some(factor) = normal.cholesky() else {
            break;
        };
        let moves = factor.solve(&right);
        let mut rates = pair.rates;
        for (rate, step) in rates.iter_mut().zip(moves.iter()) {
            *rate += step;
        }
        match project(series, rates).filter(|p| p.squares < pair.squares) {
            Some(next) => {
                let settled = pair.squares - next.squares < 1e-6 * pair.squares;
                pair = next;
                damping *= 0.1;
                if settled {
                    break;
                }
            }
            None if damping > 1e6 => break,
            None => damping *= 10.0,
        }
    }
    Some(pair)
}
