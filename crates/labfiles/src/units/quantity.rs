//! Quantities written as text: a number and a unit.

use crate::text::number;
use crate::units::table::{Dimension, parse_unit};

/// A number with its unit, in SI.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Quantity {
    /// The value in the SI unit of its dimension.
    pub si: f64,
    /// What it measures.
    pub dimension: Dimension,
}

/// Why a text is not a quantity.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum QuantityError {
    /// It does not begin with a number.
    #[error("'{0}' does not begin with a number")]
    NoNumber(String),
    /// The number is written with a decimal comma.
    #[error("'{0}' is written with a comma")]
    Comma(String),
    /// The number is infinite or not a number.
    #[error("'{0}' is not a finite number")]
    NotFinite(String),
    /// The unit is not known.
    #[error("the unit '{0}' is not known")]
    UnknownUnit(String),
    /// It has another dimension than it must have.
    #[error("'{text}' is a {found}, where a {expected} is expected")]
    Dimension {
        /// The text.
        text: String,
        /// Dimension of the text's unit.
        found: &'static str,
        /// Dimension needed.
        expected: &'static str,
    },
    /// A scale of one unit alone.
    #[error("'{0}' is neither a plain factor nor one unit per another")]
    NoRatio(String),
}

/// Read a text such as `1.0 mm`, `12.6 Hz`, `0.5 %` or `7`; without a unit it is a plain number.
///
/// ```
/// use labfiles::units::{Dimension, parse_quantity};
/// let half = parse_quantity("0.5 %")?;
/// assert_eq!((half.si, half.dimension), (0.005, Dimension::Number));
/// let error = parse_quantity("1,5 mm").unwrap_err();
/// assert_eq!(error.to_string(), "'1,5 mm' is written with a comma");
/// # Ok::<(), labfiles::units::QuantityError>(())
/// ```
///
/// # Errors
/// [`QuantityError`] if the number or the unit cannot be read.
pub fn parse_quantity(text: &str) -> Result<Quantity, QuantityError> {
    let (number, symbol) = split_number(text)?;
    if symbol.is_empty() {
        return Ok(Quantity {
            si: number,
            dimension: Dimension::Number,
        });
    }
    let unit = parse_unit(symbol).ok_or_else(|| QuantityError::UnknownUnit(symbol.to_owned()))?;
    Ok(Quantity {
        si: number * unit.to_si,
        dimension: unit.dimension,
    })
}

/// Read a text as [`parse_quantity`] does and require its dimension; gives the value in SI.
///
/// # Errors
/// [`QuantityError`], among them [`QuantityError::Dimension`] if it measures something else.
pub fn parse_quantity_of(text: &str, dimension: Dimension) -> Result<f64, QuantityError> {
    let quantity = parse_quantity(text)?;
    if quantity.dimension == dimension {
        return Ok(quantity.si);
    }
    Err(QuantityError::Dimension {
        text: text.trim().to_owned(),
        found: quantity.dimension.name(),
        expected: dimension.name(),
    })
}

/// The number at the beginning of a text and what follows it.
pub(super) fn split_number(text: &str) -> Result<(f64, &str), QuantityError> {
    let text = text.trim();
    let read = number::parse_prefix(text.as_bytes(), b'.');
    let rest = &text[read.map_or(0, |(_, end)| end)..];
    if rest.starts_with(',') {
        return Err(QuantityError::Comma(text.to_owned()));
    }
    let (value, _) = read.ok_or_else(|| QuantityError::NoNumber(text.to_owned()))?;
    if !value.is_finite() {
        return Err(QuantityError::NotFinite(text.to_owned()));
    }
    Ok((value, rest.trim()))
}
