//! Fits of shapes to a series of means: where to begin, and what leaves rates free to change.

use super::least_squares::{Point, Series};
use super::noise::Noise;
use super::shape::{Rates, Shape};
use crate::signal::{robust, spectrum, whole};

/// Means that a period is fitted by, at least, where it has as many samples.
const PER_PERIOD: f64 = 40.0;
/// Periods and time constants from which a changing rate is told from a steady one.
const TELLS: f64 = 1.8;
/// Relative change of the frequency along a decay that is none of one.
const OFF: f64 = 0.1;
/// Rounds in which the noise and the fit follow from each other.
const ROUNDS: usize = 2;

/// Means over a number of samples each.
pub(super) fn means(samples: &[f64], factor: usize) -> Vec<f64> {
    samples.chunks_exact(factor).map(robust::mean).collect()
}

/// Samples of a mean for a frequency, rad per sample, so that no more than are fitted follow.
pub(super) fn factor(omega: f64) -> usize {
    let period = std::f64::consts::TAU / omega;
    whole::index((period / PER_PERIOD).floor()).max(1)
}

/// The strongest frequency, rad per sample.
pub(super) fn peak(samples: &[f64]) -> Option<f64> {
    Some(spectrum::peak_frequency(samples)? * std::f64::consts::TAU)
}

/// `ω_d` and σ per sample by a search about a peak of the spectrum.
pub(super) fn rough(samples: &[f64], peak: f64) -> Option<Rough> {
    let periods = samples.len() as f64 * peak / std::f64::consts::TAU;
    let factor = whole::index((std::f64::consts::TAU / peak / 16.0).floor()).max(1);
    let series = Series::plain(means(samples, factor));
    let wide: &[f64] = if periods > 8.0 {
        &[1.0]
    } else {
        &[0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.15, 1.3, 1.5, 1.75, 2.0]
    };
    let scaled = |omega: f64, beta: f64| -> Rates {
        let per_mean = omega * factor as f64;
        [per_mean, beta * per_mean, 0.0, 0.0]
    };
    let starts = wide.iter().flat_map(|w| {
        let betas = [0.0, 0.003, 0.02, 0.06, 0.13, 0.25, 0.4, 0.55];
        betas.map(|b| scaled(w * peak, b))
    });
    let mut points: Vec<Point> = starts
        .filter_map(|rates| series.project(Shape::Viscous, rates))
        .collect();
    points.sort_by(|a, b| a.squares.total_cmp(&b.squares));
    let found = points
        .iter()
        .take(3)
        .filter_map(|p| series.descend(Shape::Viscous, p.rates))
        .min_by(|a, b| a.squares.total_cmp(&b.squares))?;
    let all = robust::squares_about_mean(&series.values);
    let [a, b] = found.amplitudes();
    let count = series.values.len();
    let free = count.saturating_sub(found.parameters()).max(1) as f64;
    Some(Rough {
        rates: [found.rates[0], found.rates[1]].map(|r| r / factor as f64),
        amplitude: a.hypot(b),
        explains: 1.0 - found.squares / all.max(f64::MIN_POSITIVE),
        gain: (all - found.squares) * free / found.squares.max(f64::MIN_POSITIVE),
        count,
    })
}

/// A first estimate of a decay.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rough {
    /// `ω_d` and σ per sample.
    pub(super) rates: [f64; 2],
    /// Amplitude at the first sample.
    pub(super) amplitude: f64,
    /// Share of the samples' variance that it explains.
    pub(super) explains: f64,
    /// Squares that it takes, in variances of what it leaves, of a number of values.
    pub(super) gain: f64,
    pub(super) count: usize,
}

/// A fit whose rates are free to change, of a decay that is long enough to tell; else the viscous one.
pub(super) fn free(series: &Series, start: Rates) -> Option<Point> {
    let viscous = series.descend(Shape::Viscous, start)?;
    let [omega, sigma, ..] = viscous.rates;
    let length = (series.values.len() as f64).min(2.0 / sigma.abs().max(f64::MIN_POSITIVE));
    if length * omega / std::f64::consts::TAU <= TELLS {
        return Some(viscous);
    }
    let bent = series.descend(Shape::Bent, viscous.rates).filter(|bent| {
        let change = 0.5 * bent.rates[2] * length;
        (bent.rates[0] / omega - 1.0).abs() < OFF && (change / omega).abs() < OFF
    });
    Some(bent.unwrap_or(viscous))
}

/// Fits of the laws of damping beside the viscous one.
pub(super) fn laws(series: &Series, bent: &Point) -> Vec<Point> {
    let [omega, sigma, ..] = bent.rates;
    let fitted = |shape: Shape| {
        let starts = [0.5, 0.05].map(|s| [omega, (1.0 - s) * sigma, 0.0, s * sigma]);
        let fits = starts
            .into_iter()
            .filter_map(|rates| series.descend(shape, rates));
        fits.min_by(|a, b| a.squares.total_cmp(&b.squares))
    };
    let laws = [Shape::Friction, Shape::Drag].into_iter();
    laws.filter_map(fitted).collect()
}

/// The fit of a shape in the noise that is beside it.
pub(super) fn fitted(series: &mut Series, shape: Shape, start: &Point) -> Option<Point> {
    let mut point = series.descend(shape, start.rates)?;
    for _ in 0..ROUNDS {
        let residuals = series.residuals(&point);
        let columns = series.columns(&point);
        series.noise = Noise::fitted(&residuals, &columns);
        point = series.descend(shape, point.rates)?;
    }
    Some(point)
}
