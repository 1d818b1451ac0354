//! Samples of functions, decoded from the mapped file.

use super::ascii::Numbers;
use super::sets::{Form, Function, snippet};
use crate::bytes::{FileBytes, to_usize};
use crate::numbers::{self, Spacing};
use crate::source::{ReadError, Samples};

/// What a channel is of its function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    /// The abscissa.
    Abscissa,
    /// The ordinate.
    Ordinate,
}

/// One side of a function.
pub(super) fn read(
    file: &FileBytes,
    function: &Function,
    side: Side,
) -> Result<Samples, ReadError> {
    let header = &function.header;
    if side == Side::Abscissa && header.even {
        let step = |k: u64| header.start + k as f64 * header.increment;
        return Ok(Samples::Real((0..function.samples).map(step).collect()));
    }
    let body = file.slice(function.at, function.bytes, "a function")?;
    let mut all = match function.form {
        Form::Ascii => ascii(file, function, body)?,
        Form::Binary { .. } => Vec::new(),
    };
    let first = usize::from(!header.even);
    let width = to_usize(header.per_point());
    let mut column = |at: usize| match function.form {
        Form::Ascii if width == 1 => std::mem::take(&mut all),
        Form::Ascii => all.iter().skip(at).step_by(width).copied().collect(),
        Form::Binary { .. } => binary(function, body, at),
    };
    Ok(match side {
        Side::Abscissa => Samples::Real(column(0)),
        Side::Ordinate if header.complex() => {
            Samples::Complex(numbers::pair(column(first), column(first + 1)))
        }
        Side::Ordinate => Samples::Real(column(first)),
    })
}

fn ascii(file: &FileBytes, function: &Function, body: &[u8]) -> Result<Vec<f64>, ReadError> {
    let header = &function.header;
    let needed = to_usize(function.samples) * to_usize(header.per_point());
    let mut all = Vec::with_capacity(needed.min(body.len() / 2 + 1));
    let mut text = Numbers::new(body);
    let fault = |at: usize| {
        let found = format!("{:?}", snippet(body, at));
        file.refuse(function.at + at as u64, "a number", found)
    };
    text.take(needed, &mut all).map_err(|e| fault(e.at))?;
    if all.len() < needed {
        let found = format!("{} numbers", all.len());
        return Err(file.refuse(function.at, format!("{needed} numbers"), found));
    }
    // programs fill the last line
    let extra = text.count().map_err(|e| fault(e.at))?;
    if extra >= 6 && function.samples == header.points {
        let found = format!("{extra} numbers more");
        return Err(file.refuse(function.at, format!("{needed} numbers"), found));
    }
    Ok(all)
}

/// One of the numbers of each point: abscissa if it is uneven, real part, imaginary part.
fn binary(function: &Function, body: &[u8], at: usize) -> Vec<f64> {
    let mut out = Vec::with_capacity(to_usize(function.samples));
    if let Form::Binary {
        order,
        abscissa,
        ordinate,
    } = function.form
    {
        let header = &function.header;
        let width = to_usize(ordinate.bytes());
        let first = if header.even {
            0
        } else {
            to_usize(abscissa.bytes())
        };
        let (number, offset) = match at.checked_sub(usize::from(!header.even)) {
            None => (abscissa, 0),
            Some(part) => (ordinate, first + part * width),
        };
        let spacing = Spacing {
            offset,
            stride: first + width * (1 + usize::from(header.complex())),
            count: to_usize(function.samples),
        };
        numbers::decode_spaced(number, order, body, spacing, &mut out);
    }
    out
}
