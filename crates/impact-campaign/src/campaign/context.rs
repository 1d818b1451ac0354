//! What every part of the resolution shares, and quantities as written to SI.

use toml::Spanned;

use super::diagnostic::{Code, Diagnostic, FaultCollector, Place, Severity};
use super::lines::Text;
use super::nearest::nearest;
use super::values::{Placed, WrittenQuantity};
use labfiles::units::{self, Dimension, QuantityError};

/// The lines of campaign.toml and the problems found so far.
#[derive(Debug)]
pub(crate) struct ResolveContext<'a> {
    pub(super) text: Text<'a>,
    pub(super) faults: FaultCollector,
}

impl ResolveContext<'_> {
    /// Note a problem at a placed value that stops the campaign.
    pub(super) fn fault<T>(
        &mut self,
        code: Code,
        at: &Spanned<T>,
        key: &str,
        message: impl Into<String>,
        remedy: &str,
    ) {
        let line = self.text.line_of(at);
        self.faults.fault(code, line, key, message, remedy);
    }

    /// Note what stops nothing, at a placed value.
    pub(super) fn note<T>(
        &mut self,
        at: &Spanned<T>,
        key: &str,
        message: impl Into<String>,
        remedy: &str,
    ) {
        let place = Place {
            file: self.faults.file().to_path_buf(),
            line: self.text.line_of(at),
            item: key.to_owned(),
            ..Place::default()
        };
        let kind = (Code::InvalidValue, Severity::Note);
        self.faults
            .extend([Diagnostic::new(kind, place, message, remedy)]);
    }

    /// A quantity of a dimension in SI; `None` if it is not written or faulty.
    pub(super) fn quantity(
        &mut self,
        placed: &Placed<WrittenQuantity>,
        key: &str,
        dimension: Dimension,
    ) -> Option<f64> {
        let placed = placed.as_ref()?;
        match in_si(placed.get_ref(), key, dimension) {
            Ok(value) => Some(value),
            Err(wrong) => {
                self.fault(
                    Code::InvalidValue,
                    placed,
                    key,
                    wrong.message,
                    &wrong.remedy,
                );
                None
            }
        }
    }

    /// A quantity within a range, both ends allowed.
    pub(super) fn within(
        &mut self,
        placed: &Placed<WrittenQuantity>,
        key: &str,
        dimension: Dimension,
        range: [f64; 2],
    ) -> Option<f64> {
        let value = self.quantity(placed, key, dimension)?;
        if (range[0]..=range[1]).contains(&value) {
            return Some(value);
        }
        let symbol = dimension.si_symbol();
        let message = format!("{value} {symbol} is out of range");
        let zero = if range[0] == 0.0 { "0 or " } else { "" };
        let remedy = if range[1].is_finite() {
            format!("write a value from {} to {} {symbol}", range[0], range[1])
        } else {
            format!("write {zero}a positive value, in {symbol} or a multiple of it")
        };
        if let Some(placed) = placed {
            self.fault(Code::OutOfRange, placed, key, message, &remedy);
        }
        None
    }

    /// Note a name of a record that there is not.
    pub(super) fn unknown_record<T>(
        &mut self,
        placed: &Spanned<T>,
        key: &str,
        name: &str,
        records: &[&str],
    ) {
        let what = format!("no record is called '{name}'");
        let remedy = match nearest(name, records) {
            Some(near) => format!("did you mean '{near}'?"),
            None => format!(
                "the first records are {}",
                records[..records.len().min(4)].join(", ")
            ),
        };
        self.fault(Code::UnknownRecord, placed, key, what, &remedy);
    }

    /// A positive quantity.
    pub(super) fn positive(
        &mut self,
        placed: &Placed<WrittenQuantity>,
        key: &str,
        dimension: Dimension,
    ) -> Option<f64> {
        self.within(placed, key, dimension, [f64::MIN_POSITIVE, f64::INFINITY])
    }
}

/// Why a text or a number is not the quantity needed.
pub(super) struct Wrong {
    pub(super) message: String,
    pub(super) remedy: String,
}

fn in_si(quantity: &WrittenQuantity, key: &str, dimension: Dimension) -> Result<f64, Wrong> {
    let text = match quantity {
        WrittenQuantity::Bare(value) if dimension == Dimension::Number && value.is_finite() => {
            return Ok(*value);
        }
        WrittenQuantity::Bare(value) if dimension == Dimension::Number => {
            return Err(Wrong {
                message: format!("{value} is not a number"),
                remedy: "write a finite number".to_owned(),
            });
        }
        WrittenQuantity::Bare(value) => {
            return Err(without_unit(key, &value.to_string(), dimension));
        }
        WrittenQuantity::Text(text) => text,
    };
    units::parse_quantity_of(text, dimension).map_err(|error| match &error {
        QuantityError::Dimension {
            found: "plain number",
            ..
        } => without_unit(key, text, dimension),
        _ => Wrong {
            message: error.to_string(),
            remedy: remedy(&error, dimension),
        },
    })
}

fn without_unit(key: &str, number: &str, dimension: Dimension) -> Wrong {
    let name = key.rsplit('.').next().unwrap_or(key).replace('_', " ");
    let symbol = common_symbol(dimension);
    Wrong {
        message: format!("a {name} without unit: {number}"),
        remedy: format!("write number and unit in quotes, such as \"{number} {symbol}\""),
    }
}

/// The symbol of a dimension that is usual in a laboratory.
fn common_symbol(dimension: Dimension) -> &'static str {
    match dimension {
        Dimension::Length => "mm",
        _ => units::symbols_of(dimension)
            .first()
            .copied()
            .unwrap_or(dimension.si_symbol()),
    }
}

/// What to do about a text that is not the quantity needed.
pub(super) fn remedy(error: &QuantityError, dimension: Dimension) -> String {
    match error {
        QuantityError::Comma(_) => "write a decimal point".to_owned(),
        QuantityError::NotFinite(_) => "write a finite number".to_owned(),
        QuantityError::NoRatio(_) => {
            "write the ratio, such as \"50 mm/s per V\", or a plain factor".to_owned()
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
