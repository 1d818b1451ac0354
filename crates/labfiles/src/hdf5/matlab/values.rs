//! What MATLAB's arrays hold: their numbers and texts, and the samples of them.

use crate::hdf5::element::{Element, Stride};
use crate::hdf5::store::Array;
use crate::mat::arrange::{Origin, Slice};
use crate::mat::text;
use crate::mat::tree::{Content, Encoding, Leaf, Part};
use crate::numbers::{ByteOrder, Number};
use crate::source::Samples;

/// What an array holds: numbers, or characters of 16 bits.
pub fn content(array: &Array, class: &str, at: u64) -> Option<Content> {
    let bytes = array.count()?.checked_mul(array.element.bytes() as u64)?;
    match (&array.element, class) {
        (element, "char") => {
            let part = Part {
                at,
                bytes,
                number: number(element)?,
            };
            Some(Content::Text(part, Encoding::Utf16))
        }
        (Element::Complex { part, .. }, _) => {
            let bits = 8 * part.bytes() as u8;
            let part = Part {
                at,
                bytes,
                number: number(part)?,
            };
            Some(Content::Complex(part, part, bits))
        }
        (element, _) => Some(Content::Real(Part {
            at,
            bytes,
            number: number(element)?,
        })),
    }
}

fn number(element: &Element) -> Option<Number> {
    Some(match element {
        Element::Int {
            bytes: 1,
            signed: true,
            ..
        } => Number::I8,
        Element::Int {
            bytes: 2,
            signed: true,
            ..
        } => Number::I16,
        Element::Int {
            bytes: 4,
            signed: true,
            ..
        } => Number::I32,
        Element::Int {
            bytes: 8,
            signed: true,
            ..
        } => Number::I64,
        Element::Int { bytes: 1, .. } => Number::U8,
        Element::Int { bytes: 2, .. } => Number::U16,
        Element::Int { bytes: 4, .. } => Number::U32,
        Element::Int { bytes: 8, .. } => Number::U64,
        Element::Float { bytes: 4, .. } => Number::F32,
        Element::Float { bytes: 8, .. } => Number::F64,
        _ => return None,
    })
}

/// MATLAB's name of a class; "array" for classes of its own objects.
pub fn static_class(name: &str) -> &'static str {
    const CLASSES: [&str; 12] = [
        "char", "double", "single", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64",
        "uint64", "logical",
    ];
    CLASSES
        .iter()
        .find(|c| **c == name)
        .copied()
        .unwrap_or("array")
}

/// An array's bytes with the least significant byte of each number first.
pub fn little(array: &Array, mut raw: Vec<u8>) -> Vec<u8> {
    if let Element::Int {
        bytes, big: true, ..
    }
    | Element::Float { bytes, big: true } = array.element
    {
        raw.chunks_exact_mut(bytes).for_each(<[u8]>::reverse);
    }
    raw
}

/// The samples that an origin names, from its array's bytes. `None`: the bytes are too few.
pub fn extract(leaf: &Leaf, array: &Array, origin: Origin, raw: &[u8]) -> Option<Samples> {
    if leaf.count() == 0 {
        return Some(if leaf.is_numeric() {
            Samples::Real(Vec::new())
        } else {
            Samples::Text(Vec::new())
        });
    }
    if !leaf.is_numeric() {
        return Some(Samples::Text(text::rows(
            leaf,
            &little(array, raw.to_vec()),
            ByteOrder::Little,
        )));
    }
    let size = array.element.bytes();
    let (rows, count) = (leaf.dims[0] as usize, leaf.count() as usize);
    let stride = match origin.slice {
        Slice::Whole => Stride {
            first: 0,
            step: size,
            count,
        },
        Slice::Column(c) => Stride {
            first: c as usize * rows * size,
            step: size,
            count: rows,
        },
        Slice::Row(r) => Stride {
            first: r as usize * size,
            step: rows * size,
            count: count / rows.max(1),
        },
    };
    array.element.decode(raw, stride)
}
