//! Quantities as written to SI, with the fault that names the remedy.

use toml::Spanned;

use super::faults::Notebook;
use super::read::Text;
use super::written::{Placed, Quantity};
use labfiles::units::{self, Dimension, QuantityError};

/// What every part of the resolution needs: the text's lines and the notebook of faults.
#[derive(Debug)]
pub struct Desk<'a> {
    /// Lines of campaign.toml.
    pub text: Text<'a>,
    /// The faults noted so far.
    pub book: Notebook,
}

impl Desk<'_> {
    /// A fault at a placed value.
    pub fn fault<T>(&mut self, at: &Spanned<T>, key: &str, what: String, remedy: &str) {
        self.book.fault(self.text.line_of(at), key, what, remedy);
    }

    /// A quantity of a dimension in SI; `None` where it is not written or faulty.
    pub fn quantity(
        &mut self,
        placed: &Placed<Quantity>,
        key: &str,
        dimension: Dimension,
    ) -> Option<f64> {
        let placed = placed.as_ref()?;
        match in_si(placed.get_ref(), key, dimension) {
            Ok(value) => Some(value),
            Err((what, remedy)) => {
                self.fault(placed, key, what, &remedy);
                None
            }
        }
    }

    /// A quantity that must lie in a range, both ends allowed.
    pub fn within(
        &mut self,
        placed: &Placed<Quantity>,
        key: &str,
        dimension: Dimension,
        range: [f64; 2],
    ) -> Option<f64> {
        let value = self.quantity(placed, key, dimension)?;
        if (range[0]..=range[1]).contains(&value) {
            return Some(value);
        }
        let symbol = dimension.si_symbol();
        let what = format!("{value} {symbol} is outside of what can be");
        let remedy = match range[1].is_finite() {
            true => format!("it lies between {} and {} {symbol}", range[0], range[1]),
            false => format!("it must be positive, in {symbol} or a multiple"),
        };
        if let Some(placed) = placed {
            self.fault(placed, key, what, &remedy);
        }
        None
    }

    /// A positive quantity.
    pub fn positive(
        &mut self,
        placed: &Placed<Quantity>,
        key: &str,
        dimension: Dimension,
    ) -> Option<f64> {
        self.within(placed, key, dimension, [f64::MIN_POSITIVE, f64::INFINITY])
    }
}

/// The last part of a dotted key, as words.
fn words(key: &str) -> String {
    key.rsplit('.').next().unwrap_or(key).replace('_', " ")
}

/// SI value, or what is wrong and the remedy.
fn in_si(quantity: &Quantity, key: &str, dimension: Dimension) -> Result<f64, (String, String)> {
    let text = match quantity {
        Quantity::Bare(value) if dimension == Dimension::Number => return finite(*value),
        Quantity::Bare(value) => return Err(without_unit(key, &value.to_string(), dimension)),
        Quantity::Text(text) => text,
    };
    units::parse_quantity_of(text, dimension).map_err(|error| match &error {
        QuantityError::Dimension {
            found: "plain number",
            ..
        } => without_unit(key, text, dimension),
        _ => (error.to_string(), remedy(&error, dimension)),
    })
}

fn finite(value: f64) -> Result<f64, (String, String)> {
    match value.is_finite() {
        true => Ok(value),
        false => Err((
            format!("{value} is not a number"),
            "write a finite number".to_owned(),
        )),
    }
}

fn without_unit(key: &str, number: &str, dimension: Dimension) -> (String, String) {
    let example = units::symbols_of(dimension)
        .into_iter()
        .nth(common(dimension));
    let symbol = example.unwrap_or(dimension.si_symbol());
    (
        format!("a {} without unit: {number}", words(key)),
        format!("write number and unit in quotes, such as \"{number} {symbol}\""),
    )
}

/// Which symbol of a dimension is the usual one in a laboratory.
fn common(dimension: Dimension) -> usize {
    match dimension {
        Dimension::Length => 2,
        _ => 0,
    }
}

/// What to do about a text that is not the quantity needed.
pub fn remedy(error: &QuantityError, dimension: Dimension) -> String {
    match error {
        QuantityError::Comma(_) => "write a decimal point".to_owned(),
        QuantityError::NotFinite(_) => "write a finite number".to_owned(),
        QuantityError::NoRatio(_) => {
            "write what stands for what, such as \"50 mm/s per V\", or a plain factor".to_owned()
        }
        _ => {
            let symbols = units::symbols_of(dimension).join(", ");
            format!(
                "write a number and a unit of {}: {symbols}",
                dimension.name()
            )
        }
    }
}
