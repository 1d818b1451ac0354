//! The contact law questioned: is R one number, a straight line over the closing speed, or a
//! table? Chosen by Bayes' information criterion (Schwarz 1978).

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

use crate::identify::evidence::impacts::{ImpactBlock, SpeedPair};
use crate::identify::fit::normal::inverse;
use crate::signal::robust;
use crate::signal::whole;

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

    /// The point at which the speed after an impact exceeds that before it most surely, beyond three standard
    /// errors: these speeds are not those of an impact.
    pub fn gained(&self) -> Option<CurvePoint> {
        let gain = |p: &CurvePoint| (p.restitution - 1.0) / p.standard_error;
        let most = self.curve.iter().max_by(|a, b| gain(a).total_cmp(&gain(b)));
        most.copied().filter(|p| gain(p) > 3.0)
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

/// Fewest impacts from which a law is chosen.
const FEWEST: usize = 10;
/// Difference of Bayes' criterion from which evidence is very strong.
const VERY_STRONG: f64 = 10.0;
/// Points of the curve.
const POINTS: usize = 21;

struct Fitted {
    law: Law,
    coefficients: DVector<f64>,
    covariance: DMatrix<f64>,
    chi2: f64,
}

/// Choose the law of a block's impacts; `None` with fewer than ten.
pub fn contact_law(block: &ImpactBlock) -> Option<ContactLaw> {
    let pairs = &block.pairs;
    if pairs.len() < FEWEST {
        return None;
    }
    let mut speeds: Vec<f64> = pairs.iter().map(|p| p.before_m_s).collect();
    speeds.sort_by(f64::total_cmp);
    let knots: Vec<f64> = [0.0, 1.0, 2.0, 3.0]
        .map(|k: f64| speeds[whole::index(((speeds.len() - 1) as f64 * k / 3.0).round())])
        .to_vec();
    let fits: Vec<Fitted> = Law::ALL
        .into_iter()
        .map(|law| fit(block, law, &knots))
        .collect::<Option<_>>()?;
    // Scatter beyond the stated errors is that which the richest law leaves.
    let freedom = pairs.len().saturating_sub(knots.len()).max(1) as f64;
    let scale = (fits[2].chi2 / freedom).max(1.0);
    let penalty = (pairs.len() as f64).ln();
    let criterion = [0, 1, 2]
        .map(|i: usize| fits[i].chi2 / scale + penalty * fits[i].coefficients.len() as f64);
    let least = criterion.iter().copied().fold(f64::INFINITY, f64::min);
    let chosen = fits
        .iter()
        .zip(criterion)
        .find(|(_, c)| *c == least)
        .map(|(f, _)| f)?;
    Some(ContactLaw {
        law: chosen.law,
        criterion: criterion.map(|c| c - least),
        curve: curve(chosen, &knots, scale),
    })
}

/// Weighted least squares of speeds after on the law times speeds before.
fn fit(block: &ImpactBlock, law: Law, knots: &[f64]) -> Option<Fitted> {
    let pairs = &block.pairs;
    let ratios: Vec<f64> = pairs.iter().map(|p| p.after_m_s / p.before_m_s).collect();
    let typical = robust::median(&ratios)?;
    let weight = |p: &SpeedPair| 1.0 / block.error(p, typical);
    let rows: Vec<Vec<f64>> = pairs
        .iter()
        .map(|p| {
            let scale = weight(p) * p.before_m_s;
            law.base(p.before_m_s, knots)
                .iter()
                .map(|b| b * scale)
                .collect()
        })
        .collect();
    let columns = rows.first()?.len();
    let design = DMatrix::from_fn(rows.len(), columns, |i, k| rows[i][k]);
    let target = DVector::from_iterator(pairs.len(), pairs.iter().map(|p| weight(p) * p.after_m_s));
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
    use super::*;

    fn block(law: impl Fn(f64) -> f64) -> ImpactBlock {
        // A fixed, even scatter of unit variance.
        let scatter = |i: usize| (i as f64 * 2.399_963).sin() * 2f64.sqrt();
        let pairs = (0..200)
            .map(|i| {
                let v = 0.05 + 0.01 * i as f64;
                SpeedPair {
                    observation: i,
                    time_s: 0.0,
                    before_m_s: v,
                    after_m_s: law(v) * v + 2e-3 * scatter(i),
                    error_m_s: 2e-3 / 1f64.hypot(0.8),
                    corner_shifts: [None, None],
                    lags: [None, None],
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
    fn valid_the_curve_holds_the_law_within_its_band() {
        let found = contact_law(&block(|v| 0.9 - 0.05 * v));
        for p in found.iter().flat_map(|f| &f.curve) {
            let apart = p.restitution - (0.9 - 0.05 * p.speed_m_s);
            assert!(apart.abs() < 4.0 * p.standard_error, "{p:?}");
        }
        assert!(found.is_some());
    }
}
