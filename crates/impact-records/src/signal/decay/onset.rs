//! When dry friction begins: with the motion, or on the way, as where a hand stops the mass over some periods or a cable
//! begins to rub.
//!
//! A fit has friction all the time, from one of its turning points on, or more of it from there on, all other parts as in
//! [`super::friction`]. What acts on the way need not be dry friction, nor begin at a turning point or at once: where it is told,
//! the motion before it alone is that of the rig. Where it is not told, what is not known of it is in β and f0 by the profile of the
//! likelihood: a fit whose criterion is d above the least reaches as far as the squared quantile less d allows.

use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::fits::{fitted, laws};
use super::least_squares::{Point, Series};
use super::natural::Natural;
use super::noise::Noise;
use super::shape::Shape;
use crate::signal::whole;

/// Turning points that are tried at first, evenly over the motion.
const TRIED: usize = 12;
/// What a fit leaves over the motion, below which it is exact.
const EXACT: f64 = 1e-6;
/// Difference of Bayes' criteria that is very strong (Kass and Raftery 1995): of all places at which noise may look so, one does.
const TOLD: f64 = 10.0;
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
    /// The swings after which more friction begins, and those until which it does not.
    begins: Option<[usize; 2]>,
}

impl Begun {
    /// When more friction begins, in values from the first one on, and until when it does not; `None` if it does not change.
    pub(super) fn after(&self) -> Option<[f64; 2]> {
        let [omega, _, _, turn] = self.point.rates;
        let time = |swings: usize| turn + swings as f64 * std::f64::consts::PI / omega;
        self.begins.map(|b| b.map(time))
    }
}

/// A fit with friction that begins at turning points.
#[derive(Debug, Clone)]
struct Trial {
    /// As in a series.
    frictions: Vec<usize>,
    point: Point,
}

impl Trial {
    /// Swings after which friction begins that is not there all the time; none without.
    fn begins(&self) -> usize {
        self.frictions[0]
    }

    /// Numbers that it has beyond a fit with one friction.
    fn more(&self) -> f64 {
        2.0 * (self.frictions.len() as f64 - 1.0)
    }
}

/// The fits that a series allows, of which the first has the same friction all the time. They are looked for in white noise: noise that
/// is fitted beside the same friction all the time holds what begins on the way.
struct Trials {
    series: Series,
    /// Noise beside the same friction all the time, and the fit.
    steady: (Noise, Point),
    fits: Vec<Trial>,
}

impl Trials {
    fn of(mut series: Series, point: Point) -> Self {
        let swings = series.values.len() as f64 * point.rates[0] / std::f64::consts::PI;
        let last = whole::index((swings - 1.0).max(0.0));
        let frictions = vec![0];
        let noise = std::mem::take(&mut series.noise);
        let white = series.descend(Shape::Rubbed, point.rates);
        let first = white.unwrap_or_else(|| point.clone());
        let mut own = Self {
            series,
            steady: (noise, point),
            fits: vec![Trial {
                frictions,
                point: first,
            }],
        };
        let mut step = last.div_ceil(TRIED).max(1);
        (1..=last).step_by(step).for_each(|s| own.add(s));
        while step > 1 {
            step = step.div_ceil(2);
            let best = own.best().begins();
            let sides = [best.saturating_sub(step), best + step];
            let inside = sides.into_iter().filter(|s| (1..=last).contains(s));
            inside.for_each(|s| own.add(s));
        }
        own
    }

    /// Fit friction from a number of swings on, with and without another one that is there all the time.
    fn add(&mut self, swings: usize) {
        if self.fits.iter().all(|f| f.begins() != swings) {
            let rates = self.best().point.rates;
            for frictions in [vec![swings], vec![swings, 0]] {
                self.fits.extend(self.fit(&frictions, rates));
            }
        }
    }

    fn begun(&self, frictions: &[usize]) -> Series {
        Series {
            frictions: frictions.to_vec(),
            ..self.series.clone()
        }
    }

    /// Friction that begins on the way does not drive the motion.
    fn fit(&self, frictions: &[usize], rates: [f64; 4]) -> Option<Trial> {
        let point = self.begun(frictions).descend(Shape::Rubbed, rates)?;
        let rubs = frictions == [0] || point.later_friction(frictions.len()) > 0.0;
        let frictions = frictions.to_vec();
        rubs.then_some(Trial { frictions, point })
    }

    /// χ² of a fit with what Bayes' criterion adds for numbers beyond those of one friction.
    fn score(&self, trial: &Trial) -> f64 {
        let count = self.series.values.len() as f64;
        trial.point.squares / self.variance() + trial.more() * count.ln()
    }

    fn best(&self) -> &Trial {
        let by = |a: &&Trial, b: &&Trial| self.score(a).total_cmp(&self.score(b));
        self.fits.iter().min_by(by).unwrap_or(&self.fits[0])
    }

    /// The noise that is beside the best fit, and all fits in it, if that fit is better than the same friction all the time
    /// by Bayes' criterion (Schwarz 1978): of its numbers the parameters do not hold the beginning.
    fn settle(&mut self) -> Trial {
        let told = self.told();
        self.series.noise = told.clone().unwrap_or_else(|| self.steady.0.clone());
        let again = self.fits.iter();
        let again = again.filter_map(|f| self.fit(&f.frictions, f.point.rates));
        let again: Vec<Trial> = again.collect();
        if !again.is_empty() {
            self.fits = again;
        }
        match told {
            Some(_) => self.best().clone(),
            None => Trial {
                frictions: vec![0],
                point: self.steady.1.clone(),
            },
        }
    }

    /// The noise beside the best fit, if that begins on the way and is told.
    fn told(&self) -> Option<Noise> {
        let best = Some(self.best()).filter(|b| b.begins() > 0)?;
        let (noise, steady) = &self.steady;
        let count = self.series.values.len();
        let exact = (EXACT * steady.level(count)).powi(2);
        let mut own = self.begun(&best.frictions);
        let point = fitted(&mut own, Shape::Rubbed, &best.point)?;
        let more = (count as f64).ln();
        let series = Series {
            noise: noise.clone(),
            ..self.begun(&[0])
        };
        let other = self.smooth().fold(series.criterion(steady), f64::min);
        let told = own.criterion(&point) + more + TOLD < other;
        (told && steady.squares > exact * count as f64).then_some(own.noise)
    }

    /// Bayes' criterion of frequencies and rates of decay that change smoothly from the first value on, each in the noise
    /// beside it: what these explain as well does not begin on the way.
    fn smooth(&self) -> impl Iterator<Item = f64> {
        let rates = self.steady.1.rates;
        let start = [rates[0], rates[1], 0.0, 0.0];
        let bent = self.series.descend(Shape::Bent, start).into_iter();
        let points = bent.flat_map(|bent| [laws(&self.series, &bent), vec![bent]].concat());
        points.filter_map(|point| {
            let mut own = self.series.clone();
            let point = fitted(&mut own, point.shape, &point)?;
            Some(own.criterion(&point))
        })
    }

    /// The swings after which friction of a fit begins, and the last ones until which it does not: fits of a beginning there or
    /// before are excluded.
    fn between(&mut self, found: &Trial) -> [usize; 2] {
        loop {
            let most = self.score(found) + QUANTILE.powi(2);
            let later = self.fits.iter().filter(|f| f.begins() > 0);
            let possible = later.clone().filter(|f| self.score(f) <= most);
            let first = possible.map(Trial::begins).fold(found.begins(), usize::min);
            let excluded = later.map(Trial::begins).filter(|s| *s < first);
            let last = excluded.fold(0, usize::max);
            let fits = self.fits.len();
            if first - last > 1 {
                self.add(last.midpoint(first));
            }
            if self.fits.len() == fits {
                return [found.begins(), last];
            }
        }
    }

    /// How far the other fits reach beyond the interval of one.
    fn open(&self, own: &Trial, of: &Natural) -> OpenOnset {
        let least = self.score(self.best());
        let others = self.fits.iter().filter(|f| f.frictions != own.frictions);
        let reaches = others.filter_map(|fit| {
            let left = QUANTILE.powi(2) - (self.score(fit) - least);
            let allowed = (left > 0.0).then(|| natural(&self.begun(&fit.frictions), &fit.point));
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

    /// Mean square of the noise: what the least fit leaves.
    fn variance(&self) -> f64 {
        let by = |a: &&Trial, b: &&Trial| a.point.squares.total_cmp(&b.point.squares);
        let best = &self.fits.iter().min_by(by).unwrap_or(&self.fits[0]).point;
        let freedom = self.series.values.len().saturating_sub(best.parameters());
        (best.squares / freedom.max(1) as f64).max(f64::MIN_POSITIVE)
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

/// The series, and the fit of the same friction all the time to it, with what follows from when more of it begins.
pub(super) fn find(series: Series, point: Point) -> Option<Begun> {
    let mut trials = Trials::of(series, point);
    let found = trials.settle();
    let begins = (found.begins() > 0).then(|| trials.between(&found));
    let series = trials.begun(&found.frictions);
    let (covariance, natural) = natural(&series, &found.point)?;
    let open = trials.open(&found, &natural);
    Some(Begun {
        point: found.point,
        series,
        open,
        covariance,
        natural,
        begins,
    })
}
