//! Why a model cannot be evaluated.

use thiserror::Error;

/// Why a model cannot be evaluated as requested.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ModelError {
    /// A parameter is outside its admissible range.
    #[error("{name} = {} is out of range: {expected}", short(*value))]
    OutOfRange {
        /// The parameter's name.
        name: &'static str,
        /// The value given.
        value: f64,
        /// What is admissible.
        expected: &'static str,
    },
    /// The masses start overlapping.
    #[error(
        "the start lies {depth} beyond the contact X + Y = 2ρ: start at or below it, or lower the displacements"
    )]
    StartsInContact {
        /// How far beyond the contact.
        depth: f64,
    },
    /// The work was given up before its end: nobody waits for it.
    #[error("the simulation was given up before its end")]
    GivenUp,
    /// The request has no meaning for this machine.
    #[error("{0}")]
    Unsupported(&'static str),
}

/// A value as text, without hundreds of digits.
fn short(value: f64) -> String {
    let plain = value == 0.0 || (1e-6..1e15).contains(&value.abs());
    if plain {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// A finite value that meets a condition.
///
/// # Errors
/// [`ModelError::OutOfRange`] where it is not finite or does not meet it.
pub fn range(
    name: &'static str,
    value: f64,
    ok: bool,
    expected: &'static str,
) -> Result<(), ModelError> {
    if ok && value.is_finite() {
        Ok(())
    } else {
        Err(ModelError::OutOfRange {
            name,
            value,
            expected,
        })
    }
}
