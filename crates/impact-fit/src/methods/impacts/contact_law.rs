//! The contact law questioned: is R one number, a straight line over the closing speed, or a
//! table? Chosen by Bayes' information criterion (Schwarz 1978).
//!
//! The speeds before and after, b and a, have errors of the same size. Regressed on b, the ratio a/b
//! falls wherever speeds differ by little more than their errors: by −R/v where they do not differ at
//! all. With both errors known, by noise and by the impact's time, v̂ = b + κ(a − R b) is the estimate of
//! the true speed whose error is independent of that of a − R b; of equal errors (b + R a)/(1 + R²)
//! (Deming's regression). The laws are fitted over v̂.

use std::f64::consts::SQRT_2;

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::methods::impacts::block::{ImpactBlock, SpeedPair};
use crate::solver::normal::inverse;
use impact_records::signal::whole;

/// How R depends on the closing speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// One R.
    Constant,
    /// R = a + b·v.
    Linear,
    /// Straight lines between four speeds.
    Table,
}

impl Law {
    /// All laws, the simplest first.
    pub const ALL: [Self; 3] = [Self::Constant, Self::Linear, Self::Table];

    /// Values of the law's base functions at a speed.
    fn base(self, speed: f64, knots: &[f64]) -> Vec<f64> {
        match self {
            Self::Constant => vec![1.0],
            Self::Linear => vec![1.0, speed],
            Self::Table => hats(speed, knots),
        }
    }
}

/// R at one speed with its standard error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// Closing speed before the impact, m/s.
    pub speed_m_s: f64,
    /// R there.
    pub restitution: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// The law that the impacts speak for, with the criterion of all.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ContactLaw {
    /// The law with the least criterion.
    pub law: Law,
    /// Criterion of constant, linear and table, less the least of them.
    pub criterion: [f64; 3],
    /// The chosen law over the measured speeds.
    pub curve: Vec<CurvePoint>,
}

impl ContactLaw {
    /// Whether a constant R is ruled out: its criterion lies so far above the least that the evidence
    /// counts as very strong (Kass and Raftery 1995).
    pub fn is_not_constant(&self) -> bool {
        self.criterion[0] > VERY_STRONG
    }

    /// The law as one of R, which is one at most.
    #[must_use]
    pub fn within_one(mut self) -> Self {
        for point in &mut self.curve {
            point.restitution = point.restitution.min(1.0);
        }
        self
    }

    /// Where R is least and greatest, the slower first; `None` of a law without a curve.
    pub fn extremes(&self) -> Option<[CurvePoint; 2]> {
        let by = |a: &&CurvePoint, b: &&CurvePoint| a.restitution.total_cmp(&b.restitution);
        let low = *self.curve.iter().min_by(by)?;
        let high = *self.curve.iter().max_by(by)?;
        let rising = low.speed_m_s <= high.speed_m_s;
        Some(if rising { [low, high] } else { [high, low] })
    }
}

impl CurvePoint {
    /// By how many standard errors the speed after exceeds that before, where the sensors' gains leave open a part of
    /// their ratio.
    fn gain(&self, sensors: f64) -> f64 {
        (self.restitution - 1.0) / self.standard_error.hypot(sensors)
    }
}

/// The speed at which that after an impact exceeds that before it most surely, by the law or, of few impacts without one,
/// of all together: beyond three standard errors these speeds are not those of an impact. The speeds before and after are
/// sums over two sensors, each with a gain of the given relative standard uncertainty.
pub fn gained(
    block: &ImpactBlock,
    law: Option<&ContactLaw>,
    gain_uncertainty: f64,
) -> Option<CurvePoint> {
    let sensors = SQRT_2 * gain_uncertainty;
    let most = match law {
        Some(law) => law
            .curve
            .iter()
            .max_by(|a, b| a.gain(sensors).total_cmp(&b.gain(sensors)))
            .copied(),
        None => together(block),
    };
    most.filter(|point| point.gain(sensors) > 3.0)
}

/// One R for all impacts, at their median speed.
fn together(block: &ImpactBlock) -> Option<CurvePoint> {
    let one = one_restitution(block)?;
    Some(CurvePoint {
        standard_error: one.standard_error.hypot(block.common_error()),
        ..one
    })
}

/// Fewest impacts from which a law is chosen.
const FEWEST: usize = 10;
/// Difference of Bayes' criterion from which evidence is very strong.
const VERY_STRONG: f64 = 10.0;
/// Points of the curve.
const POINTS: usize = 21;

/// An impact as the law has it: the closing speed by both speeds, and the deviation of the speed after
/// from R times the speed before with its standard error, all in m/s.
struct Point {
    speed: f64,
    deviation: f64,
    error: f64,
}

/// The impacts of a block about one R, with the speed by both speeds where R over it is a law.
fn points(block: &ImpactBlock, restitution: f64, law: &dyn Fn(f64) -> f64) -> Vec<Point> {
    let speed = |p: &SpeedPair, own: f64| block.closing_speed(p, own);
    let point = |p: &SpeedPair| Point {
        speed: speed(p, law(speed(p, restitution))),
        deviation: p.after_m_s - restitution * p.before_m_s,
        error: block.error(p, restitution),
    };
    block.pairs.iter().map(point).collect()
}

/// One R for all impacts, each by its error, at their median speed.
fn one_restitution(block: &ImpactBlock) -> Option<CurvePoint> {
    let typical = block.typical_ratio()?;
    // a − R b = (R' − R) v̂ at another R': the mean deviation over the speed corrects the typical one.
    let points = points(block, typical, &|_| typical);
    let sum = |of: fn(&Point) -> f64| points.iter().map(|p| of(p) / p.error.powi(2)).sum::<f64>();
    let squares = sum(|p| p.speed * p.speed);
    (squares > 0.0).then(|| CurvePoint {
        speed_m_s: block.typical_approach_m_s,
        restitution: typical + sum(|p| p.speed * p.deviation) / squares,
        standard_error: squares.sqrt().recip(),
    })
}

struct Fitted {
    law: Law,
    coefficients: DVector<f64>,
    covariance: DMatrix<f64>,
    chi2: f64,
}

impl Fitted {
    /// R at a speed.
    fn at(&self, speed: f64, knots: &[f64]) -> f64 {
        let base = self.law.base(speed, knots);
        base.iter()
            .zip(&self.coefficients)
            .map(|(b, c)| b * c)
            .sum()
    }
}

/// Choose the law of a block's impacts; `None` with fewer than ten.
pub fn contact_law(block: &ImpactBlock) -> Option<ContactLaw> {
    if block.pairs.len() < FEWEST {
        return None;
    }
    let restitution = one_restitution(block)?.restitution;
    let about_one = points(block, restitution, &|_| restitution);
    let mut speeds: Vec<f64> = about_one.iter().map(|p| p.speed).collect();
    speeds.sort_by(f64::total_cmp);
    let knots: Vec<f64> = [0.0, 1.0, 2.0, 3.0]
        .map(|k: f64| speeds[whole::index(((speeds.len() - 1) as f64 * k / 3.0).round())])
        .to_vec();
    let mut fits: Vec<Fitted> = Law::ALL
        .into_iter()
        .map(|law| fit(&about_one, restitution, law, &knots))
        .collect::<Option<_>>()?;
    let mut compared = Compared::of(&fits, about_one.len());
    if compared.criterion[0] > VERY_STRONG {
        // Where R is not one number, the speed by both speeds is that of the law.
        for fitted in &mut fits[1..] {
            for _ in 0..ROUNDS {
                let points = points(block, restitution, &|v| fitted.at(v, &knots));
                *fitted = fit(&points, restitution, fitted.law, &knots)?;
            }
        }
        compared = Compared::of(&fits, about_one.len());
    }
    let chosen = fits
        .iter()
        .zip(compared.criterion)
        .find(|(_, c)| *c == 0.0)?
        .0;
    Some(ContactLaw {
        law: chosen.law,
        criterion: compared.criterion,
        curve: curve(chosen, &knots, compared.scale),
    })
}

/// Rounds in which a law and the speeds by it are found.
const ROUNDS: usize = 3;

/// How well laws fit.
struct Compared {
    /// Bayes' criterion of each, less the least of them.
    criterion: [f64; 3],
    /// Factor on the variances.
    scale: f64,
}

impl Compared {
    fn of(fits: &[Fitted], points: usize) -> Self {
        // Scatter beyond the stated errors is that which the richest law leaves.
        let freedom = points.saturating_sub(fits[2].coefficients.len()).max(1) as f64;
        let scale = (fits[2].chi2 / freedom).max(1.0);
        let penalty = (points as f64).ln();
        let criterion = [0, 1, 2]
            .map(|i: usize| fits[i].chi2 / scale + penalty * fits[i].coefficients.len() as f64);
        let least = criterion.iter().copied().fold(f64::INFINITY, f64::min);
        Self {
            criterion: criterion.map(|c| c - least),
            scale,
        }
    }
}

/// Weighted least squares of the deviations from one R on the law less that, times the speed.
fn fit(points: &[Point], restitution: f64, law: Law, knots: &[f64]) -> Option<Fitted> {
    let rows: Vec<Vec<f64>> = points
        .iter()
        .map(|p| {
            let base = law.base(p.speed, knots).into_iter();
            base.map(|b| b * p.speed / p.error).collect()
        })
        .collect();
    let columns = rows.first()?.len();
    let design = DMatrix::from_fn(rows.len(), columns, |i, k| rows[i][k]);
    let targets = points.iter();
    let targets = targets.map(|p| (p.deviation + restitution * p.speed) / p.error);
    let target = DVector::from_iterator(points.len(), targets);
    let covariance = inverse(&design.tr_mul(&design))?;
    let coefficients = &covariance * design.tr_mul(&target);
    let chi2 = (&target - &design * &coefficients).norm_squared();
    Some(Fitted {
        law,
        coefficients,
        covariance,
        chi2,
    })
}

fn curve(fitted: &Fitted, knots: &[f64], scale: f64) -> Vec<CurvePoint> {
    let (slow, fast) = (knots[0], knots[knots.len() - 1]);
    (0..POINTS)
        .map(|i| {
            let speed_m_s = slow + (fast - slow) * i as f64 / (POINTS - 1) as f64;
            let base = DVector::from_vec(fitted.law.base(speed_m_s, knots));
            let variance = scale * base.dot(&(&fitted.covariance * &base));
            CurvePoint {
                speed_m_s,
                restitution: base.dot(&fitted.coefficients),
                standard_error: variance.max(0.0).sqrt(),
            }
        })
        .collect()
}

/// Weights of the knots in a straight line between the two about a speed.
fn hats(speed: f64, knots: &[f64]) -> Vec<f64> {
    let mut weights = vec![0.0; knots.len()];
    let upper = knots
        .partition_point(|k| *k < speed)
        .clamp(1, knots.len() - 1);
    let (low, high) = (knots[upper - 1], knots[upper]);
    let share = if high > low {
        ((speed - low) / (high - low)).clamp(0.0, 1.0)
    } else {
        0.5
    };
    weights[upper - 1] = 1.0 - share;
    weights[upper] = share;
    weights
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;

    fn block(law: impl Fn(f64) -> f64) -> ImpactBlock {
        // Fixed, even scatters of the speeds before and after.
        let error_m_s = 2e-3 / 1f64.hypot(0.8);
        let scatter = |turns: f64| turns.sin() * 2f64.sqrt() * error_m_s;
        let pairs = (0..200)
            .map(|i| {
                let v = 0.05 + 0.01 * i as f64;
                let before_m_s = v + scatter(1.0 + 1.732_051 * i as f64);
                let after_m_s = law(v) * v + scatter(2.399_963 * i as f64);
                SpeedPair {
                    observation: i,
                    ..SpeedPair::of_speeds(before_m_s, after_m_s, error_m_s)
                }
            })
            .collect();
        ImpactBlock::of_pairs(pairs, 0.0)
    }

    #[test]
    fn valid_the_law_behind_the_speeds_is_chosen() {
        let chosen = |law: fn(f64) -> f64| contact_law(&block(law)).map(|c| c.law);
        assert_eq!(chosen(|_| 0.8), Some(Law::Constant));
        assert_eq!(chosen(|v| 0.9 - 0.05 * v), Some(Law::Linear));
        assert_eq!(chosen(|v| 0.9 - 0.1 * v.powf(0.2)), Some(Law::Table));
    }

    #[test]
    fn speeds_that_few_impacts_gain_are_found_beyond_what_sensors_leave_open() {
        let of = |ratio: f64, count: usize| {
            let pair = |i| {
                SpeedPair::of_speeds(0.5 + 0.1 * i as f64, ratio * (0.5 + 0.1 * i as f64), 1e-3)
            };
            let block = ImpactBlock::of_pairs((0..count).map(pair).collect(), 0.0);
            assert_eq!(contact_law(&block), None);
            gained(&block, None, 5e-3).map(|p| p.restitution)
        };
        assert!((of(1.15, 1).expect("a gain") - 1.15).abs() < 1e-9);
        assert!((of(1.05, 3).expect("a gain") - 1.05).abs() < 1e-9);
        assert_eq!(of(1.01, 3), None);
        assert_eq!(of(0.95, 3), None);
    }

    /// What a standard error of the time changes of the approach speeds before and after, m/s.
    const BY_TIME_M_S: [f64; 2] = [-4e-3, -1e-3];

    /// Pairs of one R with errors of both speeds and of the time, whose true speeds are at most a share
    /// apart.
    fn noisy(apart: f64, seed: u64) -> ImpactBlock {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
        let pairs = (0..250u32)
            .map(|i| {
                let v = 0.28 * (1.0 + apart * f64::from(i % 11) / 10.0);
                let late = normal();
                let [before, after] = BY_TIME_M_S.map(|m_s| m_s * late);
                let before_m_s = v + before + 2e-3 * normal();
                let after_m_s = 0.835 * v - after + 2e-3 * normal();
                SpeedPair {
                    observation: usize::from(i % 2 == 1),
                    time_s: f64::from(i),
                    by_time_m_s: BY_TIME_M_S,
                    ..SpeedPair::of_speeds(before_m_s, after_m_s, 2e-3)
                }
            })
            .collect();
        ImpactBlock::of_pairs(pairs, 1e-3)
    }

    #[test]
    fn valid_noise_of_the_speed_before_makes_no_law() {
        // Regressed on the speed before, whose noise is as great as what the speeds differ by, R would
        // fall by R/v = 3 per m/s: from 0.835 at 0.28 m/s by 0.03 within the noise.
        for apart in [0.0, 0.01, 0.08] {
            let found: Vec<ContactLaw> = (0..40)
                .filter_map(|seed| contact_law(&noisy(apart, seed)))
                .collect();
            assert_eq!(found.len(), 40);
            let told = found.iter().filter(|law| law.is_not_constant()).count();
            assert_eq!(told, 0, "of speeds {apart} apart");
        }
    }

    #[test]
    fn valid_the_slope_over_the_speed_is_unbiased_by_noise() {
        let mut slopes = Vec::new();
        for seed in 0..40 {
            let block = noisy(0.08, seed);
            let r = one_restitution(&block).unwrap().restitution;
            assert!((r - 0.835).abs() < 3e-3, "{r}");
            let fitted = fit(&points(&block, r, &|_| r), r, Law::Linear, &[]).unwrap();
            let error = fitted.covariance[(1, 1)].sqrt();
            slopes.push(fitted.coefficients[1] / error);
        }
        let mean = slopes.iter().sum::<f64>() / 40.0;
        assert!(mean.abs() < 0.6, "{mean} standard errors");
    }

    #[test]
    fn valid_the_curve_holds_the_law_within_its_band() {
        let found = contact_law(&block(|v| 0.9 - 0.05 * v));
        for p in found.iter().flat_map(|f| &f.curve) {
            let apart = p.restitution - (0.9 - 0.05 * p.speed_m_s);
            assert!(apart.abs() < 4.0 * p.standard_error, "{p:?}");
        }
        assert!(found.is_some());
    }
}
