//! Whether one frequency and one damping ratio hold along a decay, and what changes them.

use crate::message_table;
use serde::{Deserialize, Serialize};

use super::fits::laws;
use super::least_squares::{Point, Series};
use super::prepared::Prepared;
use super::shape::Shape;
use crate::signal::whole;

/// Most parts whose damping ratios are compared.
const PARTS: usize = 4;
/// Fewest periods of a part.
const PERIODS_OF_A_PART: f64 = 1.5;
/// Periods from which a decay has two parts whose damping ratios can be compared.
pub const LEAST_TESTED: f64 = 2.0 * PERIODS_OF_A_PART;
/// Share of its first amplitude down to which the parts of a decay are looked at: a record that ends above it was cut off.
pub const RESOLVED: f64 = 0.02;
/// The same in standard deviations of the noise.
const ABOVE_NOISE: f64 = 2.0;
/// Difference of χ² from which one law is told from another (twice the difference of logarithms of the
/// likelihood that Kass and Raftery 1995 call very strong).
const TOLD: f64 = 10.0;

/// What the damping follows beside the velocity.
#[derive(
    Debug,
    Clone,
    Copy,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    strum::EnumIter,
    strum::IntoStaticStr,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case", prefix = "damping_by_")]
pub enum DampingLaw {
    /// Dry friction: β = β0 + c/A at the amplitude A.
    Friction,
    /// Drag of a turbulent flow: β = β0 + c A.
    Drag,
    /// It depends on the amplitude or on time in another way.
    #[default]
    Unknown,
}

message_table! { "damping_law": DampingLaw; }

/// Frequency at the beginning and at the end of a decay.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Drift {
    /// Natural frequency in the middle of the first quarter, Hz, on a line over the time.
    pub first_hz: f64,
    /// The same in the last quarter, Hz.
    pub last_hz: f64,
    /// Standard error of their difference, Hz.
    pub error_hz: f64,
}

impl Drift {
    /// The change over its standard error.
    pub fn z_score(&self) -> f64 {
        (self.last_hz - self.first_hz) / self.error_hz.max(f64::MIN_POSITIVE)
    }
}

/// Damping ratio of a part of a decay.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct PartOfDecay {
    /// Amplitude in the middle of the part, the samples' unit.
    pub amplitude: f64,
    /// Damping ratio.
    pub damping_ratio: f64,
    /// Its standard error.
    pub damping_ratio_error: f64,
}

/// How a decay changes from its beginning to its end; empty of one too short to tell.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Course {
    /// Of the frequency.
    pub drift: Option<Drift>,
    /// How sure it is that the damping ratio changes, in standard errors of the change.
    pub damping_z_score: f64,
    /// What changes the damping ratio best.
    pub law: DampingLaw,
    /// Least and greatest damping ratio: at both ends, of the parts, and those without what changes it by the laws that
    /// are not excluded.
    pub damping_range: Option<[f64; 2]>,
    /// The damping ratio in parts of equal length, the first at the beginning.
    pub parts: Vec<PartOfDecay>,
}

/// The shapes with a changing rate of decay, fitted.
struct Shapes<'a> {
    series: &'a Series,
    fits: Vec<(Point, f64)>,
    variance: f64,
    /// Squares that viscous damping and dry friction leave, swing by swing.
    rubbed: f64,
}

impl<'a> Shapes<'a> {
    /// `None` of a decay too short to tell.
    fn of(prepared: &'a Prepared, viscous: &Point) -> Option<Self> {
        let free = &prepared.free;
        if free.shape == Shape::Viscous {
            return None;
        }
        let series = &prepared.series;
        let bent = series.descend(Shape::Bent, viscous.rates)?;
        let laws = laws(series, &bent);
        let points: Vec<Point> = std::iter::once(bent).chain(laws).collect();
        let variance = free.squares / prepared.degrees(free)?;
        let scored = points.into_iter().filter_map(|point| {
            let inverse = series.inverse(&point)?;
            let error = (inverse[(3, 3)] * variance).sqrt();
            let physical = point.shape == Shape::Bent || point.rates[3] > 0.0;
            let z_score = point.rates[3] / error.max(f64::MIN_POSITIVE);
            physical.then_some((point, z_score))
        });
        let fits: Vec<(Point, f64)> = scored.collect();
        let rubbed = series.descend(Shape::Rubbed, viscous.rates);
        let rubbed = rubbed.filter(|p| p.friction() > Some(0.0));
        (!fits.is_empty()).then_some(Self {
            series,
            fits,
            variance,
            rubbed: rubbed.map_or(f64::INFINITY, |p| p.squares),
        })
    }

    /// The fit with the least squares.
    fn best(&self) -> &(Point, f64) {
        let by = |a: &&(Point, f64), b: &&(Point, f64)| a.0.squares.total_cmp(&b.0.squares);
        self.fits.iter().min_by(by).unwrap_or(&self.fits[0])
    }

    /// The law that is told from all others.
    fn law(&self) -> DampingLaw {
        let least = |shape: Shape| {
            let of_shape = self.fits.iter().filter(|f| f.0.shape == shape);
            let squares = of_shape.map(|f| f.0.squares / self.variance);
            squares.fold(f64::INFINITY, f64::min)
        };
        let friction = least(Shape::Friction).min(self.rubbed / self.variance);
        let (drag, bent) = (least(Shape::Drag), least(Shape::Bent));
        if friction + TOLD < drag.min(bent) {
            DampingLaw::Friction
        } else if drag + TOLD < friction.min(bent) {
            DampingLaw::Drag
        } else {
            DampingLaw::Unknown
        }
    }

    /// Rates of decay without what changes them, by the laws that are not excluded.
    fn viscous(&self) -> impl Iterator<Item = f64> {
        let most = self.best().0.squares + TOLD * self.variance;
        let possible = move |p: &&Point| p.shape != Shape::Bent && p.squares < most;
        let points = self.fits.iter().map(|f| &f.0);
        points.filter(possible).map(|p| p.rates[1])
    }

    /// Standard error of a rate of a fit.
    fn error(&self, point: &Point, rate: usize) -> f64 {
        let inverse = self.series.inverse(point);
        inverse.map_or(0.0, |i| (i[(rate, rate)] * self.variance).sqrt())
    }

    /// Samples over which the decay stands out.
    fn resolved(&self) -> usize {
        let point = &self.best().0;
        let [a, b] = point.amplitudes();
        let deviation = self.variance.sqrt();
        let least = RESOLVED.max(ABOVE_NOISE * deviation / a.hypot(b));
        let all = 0..self.series.values.len();
        let lost = |i: &usize| point.shape.envelope(&point.rates, *i as f64).value < least;
        all.clone().find(lost).unwrap_or(all.end)
    }
}

/// How a decay changes along its course.
pub(super) fn course(prepared: &Prepared, viscous: &Point, rate_hz: f64) -> Course {
    let Some(shapes) = Shapes::of(prepared, viscous) else {
        return Course::default();
    };
    let (best, _) = shapes.best();
    let law = shapes.law();
    let count = shapes.resolved();
    let natural = best.rates[0].hypot(best.rates[1]);
    let parts = parts(shapes.series, best, count, shapes.variance);
    let at = |share: f64| best.shape.rate(&best.rates, share * count as f64) / natural;
    let error = shapes.error(best, 1) / natural;
    let limits = shapes.viscous().map(|sigma| sigma / natural);
    let limits = limits.flat_map(|l| [l - error, l + error]);
    let of_parts = parts.iter().map(|p| p.damping_ratio);
    let values = [at(0.0), at(1.0)].into_iter().chain(of_parts).chain(limits);
    let range = crate::signal::robust::range(values);
    let z_score = shapes.fits.iter().map(|f| f.1.abs()).fold(0.0, f64::max);
    Course {
        drift: drift(&shapes, count, rate_hz / prepared.factor as f64),
        damping_z_score: z_score,
        law,
        damping_range: range.map(|(low, high)| [low, high]),
        parts,
    }
}

/// The line of the frequency over the time, by the best shape; none where viscous damping and dry friction, which do not
/// change the frequency, leave less.
fn drift(shapes: &Shapes<'_>, count: usize, rate_hz: f64) -> Option<Drift> {
    let point = &shapes.best().0;
    if shapes.rubbed + TOLD * shapes.variance < point.squares {
        return None;
    }
    let inverse = shapes.series.inverse(point)?;
    let hz = rate_hz / std::f64::consts::TAU;
    let at = |share: f64| {
        let omega = point.rates[0] + point.rates[2] * share * count as f64;
        omega.hypot(point.rates[1]) * hz
    };
    let error = (inverse[(2, 2)] * shapes.variance).sqrt();
    Some(Drift {
        first_hz: at(0.125),
        last_hz: at(0.875),
        error_hz: error * 0.75 * count as f64 * hz,
    })
}

/// Damping ratios of parts of equal length over the first samples of a series.
fn parts(series: &Series, best: &Point, count: usize, variance: f64) -> Vec<PartOfDecay> {
    let period = std::f64::consts::TAU / best.rates[0];
    let possible = whole::index((count as f64 / (PERIODS_OF_A_PART * period)).floor());
    let number = possible.min(PARTS);
    if number < 2 {
        return Vec::new();
    }
    let length = count / number;
    let of = |k: usize| {
        let own = Series {
            values: series.values[k * length..(k + 1) * length].to_vec(),
            degree: 0,
            taken: Vec::new(),
            ..series.clone()
        };
        let middle = (k as f64 + 0.5) * length as f64;
        let rate = best.shape.rate(&best.rates, middle);
        let point = own.descend(Shape::Viscous, [best.rates[0], rate, 0.0, 0.0])?;
        let inverse = own.inverse(&point)?;
        let natural = point.rates[0].hypot(point.rates[1]);
        let [a, b] = point.amplitudes();
        Some(PartOfDecay {
            amplitude: a.hypot(b) * (-point.rates[1] * 0.5 * length as f64).exp(),
            damping_ratio: point.rates[1] / natural,
            damping_ratio_error: (inverse[(1, 1)] * variance).sqrt() / natural,
        })
    };
    (0..number).filter_map(of).collect()
}
