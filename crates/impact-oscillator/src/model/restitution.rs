//! The coefficient of restitution R as a number, a table or a formula of the approach speed.

use serde::{Deserialize, Serialize};

use super::error::{ModelError, range};

/// The coefficient of restitution R, constant or depending on the approach speed v.
///
/// ```
/// use impact_oscillator::Restitution;
///
/// let law = Restitution::Table(vec![(0.0, 0.95), (6.0, 0.85)]);
/// assert!((law.at(3.0) - 0.90).abs() < 1e-12);
/// assert_eq!(law.at(9.0), 0.85);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Restitution {
    /// The same R at every speed.
    Constant(f64),
    /// Pairs (approach speed, R) with rising speeds: linear between them, constant beyond.
    Table(Vec<(f64, f64)>),
    /// R = max(floor, 1 − coefficient · v^exponent).
    PowerLaw {
        /// Factor of the power.
        coefficient: f64,
        /// Exponent, positive.
        exponent: f64,
        /// Least R.
        floor: f64,
    },
    /// R = fast + (slow − fast) · exp(−v/speed).
    Exponential {
        /// R at speed zero.
        slow: f64,
        /// R at great speed.
        fast: f64,
        /// Speed scale of the decay.
        speed: f64,
    },
}

impl Restitution {
    /// R at a approach speed v ≥ 0.
    pub fn at(&self, v: f64) -> f64 {
        match self {
            Self::Constant(r) => *r,
            Self::Table(pairs) => table(pairs, v).0,
            Self::PowerLaw {
                coefficient,
                exponent,
                floor,
            } => (1.0 - coefficient * v.max(0.0).powf(*exponent)).max(*floor),
            Self::Exponential { slow, fast, speed } => fast + (slow - fast) * (-v / speed).exp(),
        }
    }

    /// dR/dv at a approach speed v > 0 (one-sided at the kinks of a table).
    pub fn slope_at(&self, v: f64) -> f64 {
        match self {
            Self::Constant(_) => 0.0,
            Self::Table(pairs) => table(pairs, v).1,
            Self::PowerLaw {
                coefficient,
                exponent,
                floor,
            } => {
                if 1.0 - coefficient * v.powf(*exponent) <= *floor {
                    0.0
                } else {
                    -coefficient * exponent * v.powf(exponent - 1.0)
                }
            }
            Self::Exponential { slow, fast, speed } => -(slow - fast) / speed * (-v / speed).exp(),
        }
    }

    /// The constant value, if R does not depend on the speed.
    pub fn constant(&self) -> Option<f64> {
        match self {
            Self::Constant(r) => Some(*r),
            _ => None,
        }
    }

    /// Whether an impact at some speed is plastic, R = 0.
    pub fn is_plastic_somewhere(&self) -> bool {
        match self {
            Self::Constant(r) => *r <= 0.0,
            Self::Table(pairs) => pairs.iter().any(|p| p.1 <= 0.0),
            Self::PowerLaw {
                coefficient, floor, ..
            } => *coefficient > 0.0 && *floor <= 0.0,
            Self::Exponential { slow, fast, .. } => slow.max(*fast) <= 0.0,
        }
    }

    /// By how much the flights of a chatter last longer than those of a geometric sequence: with
    /// 1 − R = c v^e, 0 < e < 1, the speeds fall like k^(−1/e) and the sum is that over 1 − e.
    pub(super) fn chatter_stretch(&self) -> f64 {
        match self {
            Self::PowerLaw { exponent, .. } if *exponent < 1.0 => 1.0 / (1.0 - exponent),
            _ => 1.0,
        }
    }

    pub(super) fn check(&self) -> Result<(), ModelError> {
        let unit = |name, r: f64| range(name, r, (0.0..=1.0).contains(&r), "0 ≤ R ≤ 1");
        match self {
            Self::Constant(r) => unit("restitution", *r),
            Self::Table(pairs) => {
                if pairs.is_empty() || pairs.windows(2).any(|w| w[0].0 >= w[1].0) {
                    return Err(ModelError::Unsupported(
                        "the table of R(v) needs at least one pair and rising speeds",
                    ));
                }
                pairs
                    .iter()
                    .try_for_each(|p| unit("restitution (table)", p.1))
            }
            Self::PowerLaw {
                coefficient,
                exponent,
                floor,
            } => {
                range(
                    "coefficient",
                    *coefficient,
                    *coefficient >= 0.0,
                    "not negative",
                )?;
                range("exponent", *exponent, *exponent > 0.0, "positive")?;
                unit("floor", *floor)
            }
            Self::Exponential { slow, fast, speed } => {
                range("speed", *speed, *speed > 0.0, "positive")?;
                unit("slow", *slow)?;
                unit("fast", *fast)
            }
        }
    }
}

/// Value and slope of a piecewise linear table, constant beyond its ends.
fn table(pairs: &[(f64, f64)], v: f64) -> (f64, f64) {
    let above = pairs.partition_point(|p| p.0 <= v);
    match (above.checked_sub(1).map(|i| pairs[i]), pairs.get(above)) {
        (Some((v0, r0)), Some(&(v1, r1))) => {
            let slope = (r1 - r0) / (v1 - v0);
            (r0 + slope * (v - v0), slope)
        }
        (Some((_, r)), None) | (None, Some(&(_, r))) => (r, 0.0),
        (None, None) => (f64::NAN, 0.0),
    }
}
