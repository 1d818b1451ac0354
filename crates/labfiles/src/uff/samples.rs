//! Samples of functions, from text or binary.

use super::ascii::Numbers;
use super::origin::{Origin, Side};
use super::sets::{Form, Function, snippet};
use crate::bytes::{FileBytes, to_usize};
use crate::numbers::{self, ByteOrder, Number, Spacing};
use crate::source::{ReadError, Samples};

/// The numbers of a function, each kind apart.
#[derive(Debug, Default, Clone)]
struct Columns {
    abscissa: Vec<f64>,
    real: Vec<f64>,
    imaginary: Vec<f64>,
}

/// Read channels of a dataset; a function of which abscissa and ordinate are asked for is read
/// once.
pub(super) fn read(
    file: &FileBytes,
    functions: &[Function],
    wanted: &[Origin],
) -> Result<Vec<Samples>, ReadError> {
    let mut all: Vec<Option<Samples>> = vec![None; wanted.len()];
    for slot in 0..wanted.len() {
        if all[slot].is_some() {
            continue;
        }
        let number = wanted[slot].function;
        let function = &functions[number];
        let mut columns = columns(file, function).map_err(|e| ReadError {
            channel: Some(function.header.lines[0].clone()),
            ..e
        })?;
        let same = (slot..wanted.len()).filter(|&other| wanted[other].function == number);
        let slots: Vec<usize> = same.collect();
        for (position, &other) in slots.iter().enumerate() {
            let last = position + 1 == slots.len();
            let part = if last {
                std::mem::take(&mut columns)
            } else {
                columns.clone()
            };
            all[other] = Some(pick(function, part, wanted[other].side));
        }
    }
    Ok(all.into_iter().flatten().collect())
}

/// The abscissa of an uneven function.
pub(super) fn abscissa(file: &FileBytes, function: &Function) -> Result<Vec<f64>, ReadError> {
    Ok(columns(file, function)?.abscissa)
}

fn pick(function: &Function, columns: Columns, side: Side) -> Samples {
    let header = &function.header;
    match side {
        Side::Abscissa if header.even => {
            let step = |k: u64| header.start + k as f64 * header.increment;
            Samples::Real((0..function.samples).map(step).collect())
        }
        Side::Abscissa => Samples::Real(columns.abscissa),
        Side::Ordinate if header.complex() => {
            Samples::Complex(numbers::pair(columns.real, columns.imaginary))
        }
        Side::Ordinate => Samples::Real(columns.real),
    }
}

fn columns(file: &FileBytes, function: &Function) -> Result<Columns, ReadError> {
    let body = file.slice(function.at, function.bytes, "a function")?;
    match function.form {
        Form::Ascii => ascii(file, function, body),
        Form::Binary {
            order,
            abscissa,
            ordinate,
        } => Ok(binary(function, body, order, [abscissa, ordinate])),
    }
}

fn ascii(file: &FileBytes, function: &Function, body: &[u8]) -> Result<Columns, ReadError> {
    let header = &function.header;
    let width = to_usize(header.per_point());
    let needed = to_usize(function.samples) * width;
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
    // Programs may fill the last line with zeros, not more.
    let extra = text.count().map_err(|e| fault(e.at))?;
    if extra >= 6 && function.samples == header.points {
        let found = format!("{extra} numbers more");
        return Err(file.refuse(function.at, format!("{needed} numbers"), found));
    }
    Ok(apart(all, header.even, header.complex()))
}

/// Take the numbers of each point apart: abscissa, real part, imaginary part.
fn apart(all: Vec<f64>, even: bool, complex: bool) -> Columns {
    let width = 1 + usize::from(complex) + usize::from(!even);
    if width == 1 {
        return Columns {
            real: all,
            ..Columns::default()
        };
    }
    let column = |at: usize| all.iter().skip(at).step_by(width).copied().collect();
    let first = usize::from(!even);
    Columns {
        abscissa: if even { Vec::new() } else { column(0) },
        real: column(first),
        imaginary: if complex {
            column(first + 1)
        } else {
            Vec::new()
        },
    }
}

fn binary(
    function: &Function,
    body: &[u8],
    order: ByteOrder,
    [abscissa, ordinate]: [Number; 2],
) -> Columns {
    let header = &function.header;
    let width = to_usize(ordinate.bytes());
    let first = if header.even {
        0
    } else {
        to_usize(abscissa.bytes())
    };
    let stride = first + width * (1 + usize::from(header.complex()));
    let count = to_usize(function.samples);
    let take = |number, offset| {
        let mut out = Vec::with_capacity(count);
        let spacing = Spacing {
            offset,
            stride,
            count,
        };
        numbers::decode_spaced(number, order, body, spacing, &mut out);
        out
    };
    Columns {
        abscissa: if header.even {
            Vec::new()
        } else {
            take(abscissa, 0)
        },
        real: take(ordinate, first),
        imaginary: if header.complex() {
            take(ordinate, first + width)
        } else {
            Vec::new()
        },
    }
}
