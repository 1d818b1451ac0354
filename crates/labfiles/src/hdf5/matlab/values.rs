//! What MATLAB's arrays hold: their numbers and texts, and the samples of them.

use crate::bytes::to_usize;
use crate::hdf5::element::Element;
use crate::hdf5::store::Array;
use crate::mat::arrange::Origin;
use crate::mat::text;
use crate::mat::tree::{Content, Encoding, Leaf, Part};
use crate::numbers::{ByteOrder, Number};
use crate::source::Samples;

/// What an array holds: numbers, or characters of 16 bits.
pub(crate) fn content(array: &Array, class: &str, at: u64) -> Option<Content> {
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
            let bits = u8::try_from(8 * part.bytes()).ok()?;
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
    match element {
        Element::Number(number, _) => Some(*number),
        _ => None,
    }
}

/// MATLAB's name of a class; "array" for classes of its own objects.
pub(crate) fn static_class(name: &str) -> &'static str {
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
pub(crate) fn little(array: &Array, mut raw: Vec<u8>) -> Vec<u8> {
    if let Element::Number(number, ByteOrder::Big) = array.element {
        raw.chunks_exact_mut(to_usize(number.bytes()))
            .for_each(<[u8]>::reverse);
    }
    raw
}

/// The samples that an origin names, from its array's bytes. `None`: the bytes are too few.
pub(crate) fn extract(leaf: &Leaf, array: &Array, origin: Origin, raw: &[u8]) -> Option<Samples> {
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
    let spacing = origin.slice.spacing(leaf, array.element.bytes());
    array.element.decode(raw, spacing)
}
