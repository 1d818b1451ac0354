//! When dry friction begins: with the motion, or on the way, as where a hand stops the mass over some periods or a cable
//! begins to rub.
//!
//! A fit has friction from one of its turning points on, all other parts as in [`super::friction`]. What is not known of
//! the beginning is in β and f0 by the profile of the likelihood: the fit with friction from a turning point on, whose χ² is
//! d above the least, reaches as far as the squared quantile less d allows.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::fits::fitted;
use super::least_squares::{Point, Series};
use super::natural::Natural;
use super::shape::Shape;
use crate::signal::whole;

/// Turning points that are tried at first, evenly over the motion.
const TRIED: usize = 12;
/// Periods before friction that tell f0 alone, at least.
const LEAST_PERIODS: f64 = 1.5;
/// Normal deviate of the 95 % interval.
const QUANTILE: f64 = 1.96;

/// How far β and f0 reach beyond their 95 % intervals, below and above, because it is open when friction begins.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct OpenOnset {
    /// Of the damping ratio.
    pub damping_ratio: [f64; 2],
    /// Of f0, relative.
    pub natural_frequency: [f64; 2],
}

/// A series with the fit of friction that begins where the series says.
pub(super) struct Begun {
    pub(super) series: Series,
    pub(super) point: Point,
    /// Covariance of friction and the rates.
    pub(super) covariance: DMatrix<f64>,
    pub(super) natural: Natural,
    pub(super) open: OpenOnset,
}

impl Begun {
    /// When friction begins, in values from the first one on; `None` if with the motion.
    pub(super) fn after(&self) -> Option<f64> {
        let [omega, _, _, turn] = self.point.rates;
        let swings = Some(self.series.rubbed_from).filter(|s| *s > 0)?;
        Some(turn + swings as f64 * std::f64::consts::PI / omega)
    }
}

/// A fit with friction from a number of swings on.
type Trial = (usize, Point);

/// The fits that a series allows, of which the first has friction all the time.
struct Trials {
    series: Series,
    fits: Vec<Trial>,
}

impl Trials {
    fn of(series: Series, point: Point) -> Self {
        let swings = series.values.len() as f64 * point.rates[0] / std::f64::consts::PI;
        let last = whole::index((swings - 1.0).max(0.0));
        let mut own = Self {
            series,
            fits: vec![(0, point)],
        };
        let mut step = last.div_ceil(TRIED).max(1);
        (1..=last).step_by(step).for_each(|s| own.add(s));
        while step > 1 {
            step = step.div_ceil(2);
            let best = own.best().0;
            let sides = [best.saturating_sub(step), best + step];
            let inside = sides.into_iter().filter(|s| (1..=last).contains(s));
            inside.for_each(|s| own.add(s));
        }
        own
    }

    /// Fit friction from a number of swings on.
    fn add(&mut self, swings: usize) {
        if self.fits.iter().all(|f| f.0 != swings) {
            let rates = self.best().1.rates;
            self.fits.extend(self.fit(swings, rates));
        }
    }

    fn begun(&self, swings: usize) -> Series {
        Series {
            rubbed_from: swings,
            ..self.series.clone()
        }
    }

    /// Friction that begins on the way does not drive the motion.
    fn fit(&self, swings: usize, rates: [f64; 4]) -> Option<Trial> {
        let point = self.begun(swings).descend(Shape::Rubbed, rates)?;
        let rubs = swings == 0 || point.friction() > Some(0.0);
        rubs.then_some((swings, point))
    }

    fn best(&self) -> &Trial {
        let by = |a: &&Trial, b: &&Trial| a.1.squares.total_cmp(&b.1.squares);
        self.fits.iter().min_by(by).unwrap_or(&self.fits[0])
    }

    /// The noise that is beside the best fit, and all fits in it, if that fit is better than friction all the time by
    /// Bayes' criterion (Schwarz 1978): one number more.
    fn settle(&mut self) -> usize {
        let (swings, best) = self.best();
        let swings = *swings;
        if swings == 0 {
            return 0;
        }
        let mut own = self.begun(swings);
        let Some(point) = fitted(&mut own, Shape::Rubbed, best) else {
            return 0;
        };
        let more = (own.values.len() as f64).ln();
        if own.criterion(&point) + more > self.series.criterion(&self.fits[0].1) {
            return 0;
        }
        self.series.noise = own.noise;
        let again = self.fits.iter();
        let again: Vec<Trial> = again.filter_map(|f| self.fit(f.0, f.1.rates)).collect();
        self.fits = again;
        self.best().0
    }

    /// How far the other fits reach beyond the interval of the one with friction from a number of swings on.
    fn open(&self, own: usize, of: &Natural) -> OpenOnset {
        let least = self.best().1.squares;
        let variance = self.variance();
        let others = self.fits.iter().filter(|f| f.0 != own);
        let reaches = others.filter_map(|(swings, point)| {
            let left = QUANTILE.powi(2) - (point.squares - least) / variance;
            let allowed = (left > 0.0).then(|| natural(&self.begun(*swings), point));
            Some((allowed.flatten()?.1, left.sqrt()))
        });
        let none = OpenOnset::default();
        reaches.fold(none, |open, (found, reach)| {
            open.with(&OpenOnset {
                damping_ratio: beyond(damping(of), damping(&found), reach),
                natural_frequency: beyond(frequency(of), frequency(&found), reach),
            })
        })
    }

    /// Mean square of the noise.
    fn variance(&self) -> f64 {
        let (_, best) = self.best();
        let freedom = self.series.values.len().saturating_sub(best.parameters());
        (best.squares / freedom.max(1) as f64).max(f64::MIN_POSITIVE)
    }

    /// What the motion before friction alone tells.
    fn before(&self, begun: &Begun) -> Option<Natural> {
        let values = whole::index(begun.after()?.max(0.0)).min(self.series.values.len());
        let [omega, sigma, ..] = begun.point.rates;
        if (values as f64) * omega < LEAST_PERIODS * std::f64::consts::TAU {
            return None;
        }
        let own = Series {
            values: self.series.values[..values].to_vec(),
            ..self.series.clone()
        };
        let point = own.descend(Shape::Viscous, [omega, sigma, 0.0, 0.0])?;
        let covariance = own.inverse(&point)? * self.variance();
        Some(Natural::of(&point.rates, &covariance))
    }
}

fn damping(natural: &Natural) -> [f64; 2] {
    [natural.damping_ratio, natural.damping_ratio_error]
}

/// The logarithm of f0, with its error.
fn frequency(natural: &Natural) -> [f64; 2] {
    let relative = natural.frequency_error / natural.frequency;
    [natural.frequency.ln(), relative]
}

/// How far a value with its error, times a deviate, reaches below and above the 95 % interval of another one.
fn beyond([own, own_error]: [f64; 2], [value, error]: [f64; 2], deviate: f64) -> [f64; 2] {
    let reach = deviate * error - QUANTILE * own_error;
    [own - value + reach, value - own + reach].map(|r| r.max(0.0))
}

impl OpenOnset {
    fn with(&self, other: &Self) -> Self {
        let most = |a: [f64; 2], b: [f64; 2]| [a[0].max(b[0]), a[1].max(b[1])];
        Self {
            damping_ratio: most(self.damping_ratio, other.damping_ratio),
            natural_frequency: most(self.natural_frequency, other.natural_frequency),
        }
    }
}

/// Covariance of friction and the rates of a fit, with f0 and β.
fn natural(series: &Series, point: &Point) -> Option<(DMatrix<f64>, Natural)> {
    let covariance = series.covariance(point)?;
    let of_rates = covariance.view((1, 1), (2, 2)).into_owned();
    let natural = Natural::of(&point.rates, &of_rates);
    Some((covariance, natural))
}

/// The series, and the fit of friction all the time to it, with what follows from when friction begins.
pub(super) fn find(series: Series, point: Point) -> Option<Begun> {
    let mut trials = Trials::of(series, point);
    let swings = trials.settle();
    let (_, point) = trials.fits.iter().find(|f| f.0 == swings)?;
    let series = trials.begun(swings);
    let (covariance, natural) = natural(&series, point)?;
    let mut begun = Begun {
        point: point.clone(),
        series,
        open: trials.open(swings, &natural),
        covariance,
        natural,
    };
    // what stops a mass need not be dry friction, which has a form of its own within a period
    if let Some(before) = trials.before(&begun) {
        begun.open = begun.open.with(&OpenOnset {
            natural_frequency: beyond(frequency(&begun.natural), frequency(&before), QUANTILE),
            ..OpenOnset::default()
        });
    }
    Some(begun)
}
