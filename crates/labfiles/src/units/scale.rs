//! From the numbers of a channel to a quantity.

use crate::units::quantity::{Quantity, QuantityError, split_number};
use crate::units::table::{Unit, parse_unit};

/// How the numbers of a channel become a quantity.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// A plain factor: the numbers keep their unit.
    Factor(f64),
    /// A ratio of two units.
    Ratio {
        /// SI value of the numerator: number times unit.
        numerator: Quantity,
        /// The unit below.
        denominator: Unit,
    },
}

/// Read a scale: a plain factor (`0.5`), or one unit per another (`50 mm/s per V`,
/// `0.05 m/s/V`, or a sensor's sensitivity `100 mV/g`).
///
/// ```
/// use labfiles::units::{Dimension, parse_scale, parse_unit};
/// let volts = parse_unit("V").ok_or("unknown")?;
/// let scaled = parse_scale("100 mV/g")?.apply(volts).ok_or("another unit")?;
/// assert_eq!(scaled.dimension, Dimension::Acceleration);
/// assert!((scaled.to_si - 98.0665).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`QuantityError`] if the number or a unit cannot be read, among them
/// [`QuantityError::NoRatio`] if only one unit is given.
pub fn parse_scale(text: &str) -> Result<Scale, QuantityError> {
    let (number, symbols) = split_number(text)?;
    if symbols.is_empty() {
        return Ok(Scale::Factor(number));
    }
    let (above, below) = split_ratio(symbols)?;
    let numerator = Quantity {
        si: number * above.to_si,
        dimension: above.dimension,
    };
    Ok(Scale::Ratio {
        numerator,
        denominator: below,
    })
}

fn split_ratio(symbols: &str) -> Result<(Unit, Unit), QuantityError> {
    let unknown = |s: &str| QuantityError::UnknownUnit(s.trim().to_owned());
    let bare = |s: &str| parse_unit(s.trim().trim_start_matches('(').trim_end_matches(')'));
    if let Some((above, below)) = symbols.split_once(" per ") {
        let above = bare(above).ok_or_else(|| unknown(above))?;
        return Ok((above, bare(below).ok_or_else(|| unknown(below))?));
    }
    if parse_unit(symbols).is_some() {
        return Err(QuantityError::NoRatio(symbols.to_owned()));
    }
    let cuts = symbols.rmatch_indices('/');
    let pairs = cuts.map(|(at, _)| (bare(&symbols[..at]), bare(&symbols[at + 1..])));
    pairs
        .into_iter()
        .find_map(|(above, below)| above.zip(below))
        .ok_or_else(|| unknown(symbols))
}

impl Scale {
    /// Factor to SI and dimension of numbers in the file's `unit` after scaling; `None` if the
    /// scale does not start from that unit.
    pub fn apply(self, unit: Unit) -> Option<Unit> {
        match self {
            Self::Factor(factor) => Some(Unit {
                to_si: unit.to_si * factor,
                ..unit
            }),
            Self::Ratio {
                numerator,
                denominator,
            } => {
                let per_si = numerator.si / denominator.to_si;
                let (dimension, to_si) = if denominator.dimension == unit.dimension {
                    (numerator.dimension, unit.to_si * per_si)
                } else if numerator.dimension == unit.dimension {
                    (denominator.dimension, unit.to_si / per_si)
                } else {
                    return None;
                };
                Some(Unit { dimension, to_si })
            }
        }
    }
}
