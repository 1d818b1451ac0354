//! What oscillates at other frequencies than a decay: hum, other modes.

use super::fits::{factor, free, means, peak, rough};
use super::least_squares::{Point, Series};
use super::shape::{Rates, Shape};
use super::watched::MotionSignal;
use crate::signal::columns;

/// Most oscillations of other frequencies that are taken from a record.
const MOST: usize = 4;
/// Decay over the record, as a logarithm, of what is as steady as a hum.
pub(super) const STEADY: f64 = 0.5;
/// Share of what the decay leaves that another oscillation explains.
const STANDS_OUT: f64 = 0.5;
/// Periods that another oscillation lasts.
const LEAST_TURNS: f64 = 3.0;
/// Rounds in which all oscillations are fitted again beside each other.
const ROUNDS: usize = 3;

/// A tone or a decay of another frequency.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mode {
    /// `ω_d` and σ per sample.
    pub(super) rates: [f64; 2],
    pub(super) amplitude: f64,
    pub(super) steady: bool,
}

/// A mode with its rates and its values at every sample.
pub(super) struct Fitted {
    pub(super) values: Vec<f64>,
    pub(super) mode: Mode,
}

/// The decay that is fitted.
#[derive(Debug, Clone, Copy)]
struct Own {
    /// `ω_d` and σ per sample.
    rates: [f64; 2],
    quantity: MotionSignal,
}

/// Take what oscillates at other frequencies than the decay of given rates from samples, beginning with known
/// ones.
pub(super) fn remove(
    (samples, quantity): (&mut [f64], MotionSignal),
    [omega, sigma, ..]: Rates,
    known: &[[f64; 2]],
) -> Vec<Mode> {
    let own = Own {
        rates: [omega, sigma],
        quantity,
    };
    let mut modes: Vec<Fitted> = Vec::new();
    for rates in known {
        // its own rates: a fit may run off to the decay
        modes.extend(at(&less(samples, &modes), *rates));
    }
    for _ in 0..MOST {
        for _ in 0..if modes.is_empty() { 0 } else { ROUNDS } {
            fit_again(&mut modes, |modes| {
                without_decay(&less(samples, modes), own)
            });
        }
        let found =
            without_decay(&less(samples, &modes), own).and_then(|rest| strongest(&rest, own));
        let Some(found) = found else {
            break;
        };
        modes.push(found);
    }
    let rest = less(samples, &modes);
    samples.copy_from_slice(&rest);
    modes.into_iter().map(|m| m.mode).collect()
}

/// Take the oscillation of about given rates from samples.
pub(super) fn subtract(samples: &mut [f64], rates: [f64; 2]) {
    if let Some(found) = fitted(samples, rates) {
        columns::subtract(samples, 1.0, &found.values);
    }
}

/// Samples less modes.
pub(super) fn less(samples: &[f64], modes: &[Fitted]) -> Vec<f64> {
    let mut rest = samples.to_vec();
    for mode in modes {
        columns::subtract(&mut rest, 1.0, &mode.values);
    }
    rest
}

/// Fit each mode to what is left without it: `rest` gives what all of them leave.
pub(super) fn fit_again(modes: &mut [Fitted], rest: impl Fn(&[Fitted]) -> Option<Vec<f64>>) {
    for k in 0..modes.len() {
        let Some(mut rest) = rest(modes) else {
            return;
        };
        columns::subtract(&mut rest, -1.0, &modes[k].values);
        if let Some(found) = fitted(&rest, modes[k].mode.rates) {
            modes[k] = found;
        }
    }
}

/// What the decay of about given rates leaves of samples. Dry friction is of the decay: the motion under it has odd
/// harmonics, which are no other modes.
fn without_decay(samples: &[f64], own: Own) -> Option<Vec<f64>> {
    let [omega, sigma] = own.rates;
    let factor = factor(omega);
    let rates = [omega, sigma, 0.0, 0.0].map(|r| r * factor as f64);
    let series = Series {
        quantity: own.quantity,
        factor,
        ..Series::plain(means(samples, factor))
    };
    let free = free(&series, rates)?;
    let rubbed = series.descend(Shape::Rubbed, free.rates);
    let decay = rubbed.filter(|r| r.squares < free.squares).unwrap_or(free);
    let whole = Series {
        quantity: own.quantity,
        ..Series::plain(samples.to_vec())
    };
    let point = whole.project(decay.shape, decay.per_sample(factor))?;
    Some(whole.residuals(&point))
}

/// The strongest oscillation of samples, if it is another than the decay of given rates and stands out.
fn strongest(rest: &[f64], own: Own) -> Option<Fitted> {
    let rates = rough(rest, peak(rest)?)?.rates;
    let count = rest.len() as f64;
    if are_one(own.rates, rates, count) {
        return None;
    }
    let found = fitted(rest, rates)?;
    let sigma = found.mode.rates[1];
    let explained = columns::dot(&found.values, &found.values);
    let stands_out = explained > STANDS_OUT * columns::dot(rest, rest);
    let lasts = lasts(found.mode.rates, count);
    (stands_out && sigma * count > -STEADY && lasts).then_some(found)
}

/// Whether an oscillation of given rates lasts over periods enough in a number of samples.
pub(super) fn lasts([omega, sigma]: [f64; 2], count: f64) -> bool {
    let samples = count.min(1.0 / sigma.abs().max(f64::MIN_POSITIVE));
    samples * omega / std::f64::consts::TAU > LEAST_TURNS
}

/// The oscillation of about given rates in samples.
pub(super) fn fitted(samples: &[f64], [omega, sigma]: [f64; 2]) -> Option<Fitted> {
    let factor = factor(omega);
    let rates = [omega, sigma, 0.0, 0.0].map(|r| r * factor as f64);
    let point = free(&Series::plain(means(samples, factor)), rates)?;
    let whole = Series::plain(samples.to_vec());
    let point = whole.project(point.shape, point.per_sample(factor))?;
    Some(Fitted::of(&point, samples.len()))
}

/// The oscillation of given rates in samples.
fn at(samples: &[f64], [omega, sigma]: [f64; 2]) -> Option<Fitted> {
    let series = Series::plain(samples.to_vec());
    let point = series.project(Shape::Viscous, [omega, sigma, 0.0, 0.0])?;
    Some(Fitted::of(&point, samples.len()))
}

impl Fitted {
    /// A fit to a number of samples.
    fn of(point: &Point, count: usize) -> Self {
        let [a, b] = point.amplitudes();
        let [omega, sigma, ..] = point.rates;
        Self {
            values: point.values(count),
            mode: Mode {
                rates: [omega, sigma],
                amplitude: a.hypot(b),
                steady: sigma * (count as f64) < STEADY,
            },
        }
    }
}

/// Whether two oscillations in a number of samples are not told apart.
pub(super) fn are_one(a: [f64; 2], b: [f64; 2], count: f64) -> bool {
    (a[0] - b[0]).abs() <= width(a, count).max(width(b, count))
}

/// Difference of frequency within which a decay over a number of samples is not told from others, rad per
/// sample: three lines of the spectrum, three half widths of its resonance.
pub(super) fn width(rates: [f64; 2], count: f64) -> f64 {
    (3.0 * std::f64::consts::TAU / count).max(3.0 * rates[1])
}
