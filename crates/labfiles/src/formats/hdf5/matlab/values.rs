//! What MATLAB's arrays hold: their numbers and texts, and the samples of them.

use crate::bytes::to_usize;
use crate::formats::hdf5::element::Element;
use crate::formats::hdf5::store::Array;
use crate::formats::mat::arrange::Origin;
use crate::formats::mat::text;
use crate::formats::mat::tree::{Content, Encoding, Leaf, Part};
use crate::numbers::ByteOrder;
use crate::source::Samples;

/// What an array holds: numbers, or characters of 16 bits.
pub(crate) fn content(array: &Array, class: &str, at: u64) -> Option<Content> {
    let bytes = array.count()?.checked_mul(array.element.bytes() as u64)?;
    let (Element::Number(number, _), complex) = (match &array.element {
        Element::Complex { part, .. } => (&**part, true),
        element => (element, false),
    }) else {
        return None;
    };
    let part = Part {
        at,
        bytes,
        number: *number,
    };
    match (complex, class) {
        (false, "char") => Some(Content::Text(part, Encoding::Utf16)),
        (true, "char") => None,
        (true, _) => Some(Content::Complex(part, part, number.bits())),
        (false, _) => Some(Content::Real(part)),
    }
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
