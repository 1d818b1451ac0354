//! A free decay: offset + e^{−σt}(a cos `ω_d` t + b sin `ω_d` t), fitted by least squares to all channels
//! that show it, with what its residuals have beside noise.

mod least_squares;
mod structure;

use super::whole;
use least_squares::{Point, Signals, descend};
use nalgebra::Vector2;

pub use structure::Drift;

/// A fitted free decay.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Decay {
    /// Natural frequency f0 = √(σ² + `ω_d²)/2π`, Hz.
    pub natural_frequency_hz: f64,
    /// Its standard error, Hz.
    pub natural_frequency_error_hz: f64,
    /// Damping ratio β = σ/√(σ² + `ω_d²`).
    pub damping_ratio: f64,
    /// Its standard error.
    pub damping_ratio_error: f64,
    /// Amplitude at the first fitted sample, the samples' unit.
    pub amplitude: f64,
    /// Phase of the cosine there, rad.
    pub phase_rad: f64,
    /// Constant part, the samples' unit.
    pub offset: f64,
    /// Root mean square of the residual over that of the signal.
    pub residual_ratio: f64,
    /// The part of it that neighbouring samples share, so that it is no noise: another mode, a drift,
    /// damping that is not viscous.
    #[serde(default)]
    pub structured_ratio: f64,
    /// How the frequency changes from the beginning of the decay to its end; `None` for a decay too
    /// short to tell.
    #[serde(default)]
    pub drift: Option<Drift>,
    /// The channel whose amplitude, phase and offset are given: the one with the least noise, by its
    /// place among those fitted.
    #[serde(default)]
    pub channel: usize,
    /// First fitted sample.
    pub first: usize,
    /// Number of fitted samples.
    pub samples: usize,
}

impl Decay {
    /// The fitted decay at each of its samples, from the first fitted one on.
    pub fn values(&self, rate_hz: f64) -> Vec<f64> {
        let natural = std::f64::consts::TAU * self.natural_frequency_hz / rate_hz;
        let sigma = self.damping_ratio * natural;
        let omega = natural * (1.0 - self.damping_ratio.powi(2)).max(0.0).sqrt();
        let at = |i: usize| {
            let t = i as f64;
            let envelope = self.amplitude * (-sigma * t).exp();
            self.offset + envelope * (omega * t + self.phase_rad).cos()
        };
        (0..self.samples).map(at).collect()
    }
}

/// Earliest start of a fit, s from the first sample: records of a blow are triggered by it.
const FROM_S: f64 = 0.1;
/// Least time between the blow and the start of a fit, s.
const WAIT_S: f64 = 0.05;
/// Further starts within one period that show how far the answer depends on the start.
const OTHER_STARTS: usize = 4;

/// Fit the free decay that follows the greatest excursion of the samples of one channel.
///
/// ```
/// use impactid::signal::decay;
///
/// // f0 = 14 Hz, β = 0.02, released at t = 0.
/// let natural = std::f64::consts::TAU * 14.0;
/// let damped = natural * f64::sqrt(1.0 - 0.02 * 0.02);
/// let value = |t: f64| (-0.02 * natural * t).exp() * (damped * t).cos();
/// let samples: Vec<f64> = (0..2000).map(|i| value(f64::from(i) / 1000.0)).collect();
/// let found = decay::fit(&samples, 1000.0).unwrap();
/// assert!((found.natural_frequency_hz - 14.0).abs() < 1e-6);
/// assert!((found.damping_ratio - 0.02).abs() < 1e-6);
/// ```
pub fn fit(samples: &[f64], rate_hz: f64) -> Option<Decay> {
    fit_channels(&[samples], rate_hz)
}

/// Fit one free decay to several channels of equal length, each weighted by its noise.
///
/// The fit begins 0.1 s into the record, and at least 0.05 s after the blow. Fits from later
/// starts within one period show how much another mode or a drift changes the result; their spread
/// is part of the standard errors. Channels are often computed from each other, so the standard
/// errors are never below those of the best channel alone. `None` with fewer than three periods to
/// fit, or if nothing decays.
pub fn fit_channels(channels: &[&[f64]], rate_hz: f64) -> Option<Decay> {
    let alone: Vec<Option<Start>> = channels.iter().map(|c| Start::of(c, rate_hz)).collect();
    let (best, start) = alone
        .iter()
        .enumerate()
        .filter_map(|(i, start)| Some((i, start.as_ref()?)))
        .min_by(|a, b| a.1.point_error().total_cmp(&b.1.point_error()))?;
    let agrees =
        |other: &&Start| (other.point.rates[0] / start.point.rates[0] - 1.0).abs() < SAME_FREQUENCY;
    let signals: Vec<(&[f64], f64)> = channels
        .iter()
        .zip(&alone)
        .filter_map(|(c, s)| Some((*c, s.as_ref().filter(agrees)?)))
        .map(|(c, s)| (&c[start.first..], s.variance.recip()))
        .collect();
    let point = descend(&signals, start.point.rates)?;
    let tail = &channels[best][start.first..];
    let mut decay = point.decay(tail, rate_hz)?;
    decay.first = start.first;
    decay.channel = best;
    let covariance = point.covariance(&signals)?;
    let [mut frequency, mut damping] = point.errors(&covariance, rate_hz);
    let [least_frequency, least_damping] = start.point.errors(&start.covariance, rate_hz);
    frequency = frequency.max(least_frequency);
    damping = damping.max(least_damping);
    let period = std::f64::consts::TAU / point.rates[0];
    let [of_frequency, of_damping] = other_starts(&signals, &point, period, rate_hz);
    decay.natural_frequency_error_hz = frequency.hypot(of_frequency);
    decay.damping_ratio_error = damping.hypot(of_damping);
    decay.drift = structure::drift(&signals, &point, rate_hz);
    Some(decay)
}

/// Relative difference of frequency above which a channel shows something else.
const SAME_FREQUENCY: f64 = 0.02;

/// The fit of one channel alone.
struct Start {
    first: usize,
    point: Point,
    /// Covariance of the rates.
    covariance: nalgebra::Matrix2<f64>,
    /// Variance of the residual, as far as independent.
    variance: f64,
}

impl Start {
    fn of(samples: &[f64], rate_hz: f64) -> Option<Self> {
        let centre = super::robust::median(samples)?;
        let peak = samples
            .iter()
            .enumerate()
            .max_by(|a, b| (a.1 - centre).abs().total_cmp(&(b.1 - centre).abs()))?
            .0;
        let wait = whole::index((WAIT_S * rate_hz).ceil());
        let first = (peak + wait).max(whole::index((FROM_S * rate_hz).ceil()));
        let tail = samples.get(first..)?;
        let per_sample = super::spectrum::peak_frequency(tail)?;
        if (tail.len() as f64) < LEAST_PERIODS / per_sample {
            return None;
        }
        let omega = per_sample * std::f64::consts::TAU;
        let plain = [(tail, 1.0)];
        let point = [0.001, 0.005, 0.02, 0.08]
            .into_iter()
            .filter_map(|beta| descend(&plain, Vector2::new(omega, beta * omega)))
            .min_by(|a, b| a.squares.total_cmp(&b.squares))
            .filter(|p| p.rates[1] > 0.0)?;
        let residuals = point.residuals(0, tail);
        let squares: f64 = residuals.iter().map(|r| r * r).sum();
        let variance = squares / tail.len().checked_sub(5).filter(|n| *n > 0)? as f64;
        let least = (1e-9 * super::robust::rms(tail))
            .powi(2)
            .max(f64::MIN_POSITIVE);
        let variance = (variance * structure::correlation_factor(&residuals)).max(least);
        let covariance = point.covariance(&[(tail, variance.recip())])?;
        Some(Self {
            first,
            point,
            covariance,
            variance,
        })
    }

    fn point_error(&self) -> f64 {
        self.covariance[(0, 0)].max(0.0).sqrt() / self.point.rates[0]
    }
}

/// Fewest periods that a fit needs.
const LEAST_PERIODS: f64 = 3.0;

/// Root mean square changes of frequency, Hz, and damping ratio by later starts within one period.
fn other_starts(signals: &Signals<'_>, point: &Point, period: f64, rate_hz: f64) -> [f64; 2] {
    let own = point.natural(rate_hz);
    let (mut squares, mut count) = ([0.0, 0.0], 0.0);
    for k in 1..=OTHER_STARTS {
        let skip = whole::index((period * k as f64 / OTHER_STARTS as f64).round());
        let later: Vec<(&[f64], f64)> = signals
            .iter()
            .filter_map(|(tail, weight)| Some((tail.get(skip..)?, *weight)))
            .collect();
        let long_enough = later
            .first()
            .is_some_and(|(tail, _)| tail.len() as f64 >= LEAST_PERIODS * period);
        let found = match long_enough {
            true => descend(&later, point.rates),
            false => None,
        };
        if let Some(found) = found {
            let other = found.natural(rate_hz);
            squares[0] += (other[0] - own[0]).powi(2);
            squares[1] += (other[1] - own[1]).powi(2);
            count += 1.0;
        }
    }
    squares.map(|s| (s / f64::max(count, 1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_a_noise_free_decay_is_recovered() {
        let (rate, f0, beta) = (1652.9, 14.3, 0.0183);
        let natural = std::f64::consts::TAU * f0;
        let damped = natural * f64::sqrt(1.0 - beta * beta);
        let samples: Vec<f64> = (0..2048)
            .map(|i| (f64::from(i) - 10.0) / rate)
            .map(|t| {
                if t < 0.0 {
                    0.2
                } else {
                    0.2 + 3.0 * (-beta * natural * t).exp() * (damped * t).cos()
                }
            })
            .collect();
        let decay = fit(&samples, rate).unwrap();
        assert!((decay.natural_frequency_hz / f0 - 1.0).abs() < 1e-8);
        assert!((decay.damping_ratio / beta - 1.0).abs() < 1e-6);
        assert!((decay.offset - 0.2).abs() < 1e-8);
        let fitted = decay.values(rate);
        assert_eq!(fitted.len(), decay.samples);
        let measured = samples[decay.first..].iter().zip(&fitted);
        assert!(measured.clone().all(|(m, f)| (m - f).abs() < 1e-7));
    }

    /// A decay of f0 = 2.5 Hz and β = 0.0015 at 100 Hz with even scatter, its frequency rising by a
    /// share over 5 s.
    fn scattered(deviation: f64, rise: f64) -> Vec<f64> {
        let natural = std::f64::consts::TAU * 2.5;
        let scatter =
            |i: usize| deviation * (i as f64 * i as f64 * 0.618_033_988_749_895 % 1.0 - 0.5);
        (0..500)
            .map(|i| {
                let t = i as f64 / 100.0;
                let phase = natural * (t + rise * t * t / 10.0);
                (-0.0015 * natural * t).exp() * phase.cos() + scatter(i) * 12f64.sqrt()
            })
            .collect()
    }

    #[test]
    fn valid_noise_is_no_structure_and_the_best_channel_decides() {
        let (fine, coarse) = (scattered(0.002, 0.0), scattered(0.15, 0.0));
        let both = fit_channels(&[&coarse, &fine], 100.0).unwrap();
        let alone = fit(&fine, 100.0).unwrap();
        assert_eq!(both.channel, 1);
        assert!((both.natural_frequency_hz / 2.5 - 1.0).abs() < 1e-4);
        assert!((both.natural_frequency_hz - alone.natural_frequency_hz).abs() < 1e-4);
        let noisy = fit(&coarse, 100.0).unwrap();
        assert!(
            noisy.residual_ratio > 0.15 && noisy.structured_ratio < 0.08,
            "{noisy:?}"
        );
        assert!((noisy.natural_frequency_hz / 2.5 - 1.0).abs() < 1e-2);
    }

    #[test]
    fn valid_a_frequency_that_rises_over_the_decay_is_a_drift() {
        let steady = fit(&scattered(0.002, 0.0), 100.0).unwrap();
        let drift = steady.drift.unwrap();
        assert!(drift.z_score().abs() < 4.0, "{drift:?}");
        // From the middle of the first quarter to that of the last: three quarters of 1 %.
        let rising = fit(&scattered(0.002, 0.01), 100.0).unwrap();
        let drift = rising.drift.unwrap();
        assert!(drift.z_score() > 3.0, "{drift:?}");
        let share = drift.last_hz / drift.first_hz - 1.0;
        assert!((share - 0.0075).abs() < 0.002, "{share}");
    }
}
