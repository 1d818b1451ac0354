//! Element types of HDF5 arrays and their conversion to numbers.

use crate::bytes::to_usize;
use crate::numbers::{self, ByteOrder, Number, Spacing};
use crate::source::{Samples, StoredType};

/// The type of an array's elements, as far as the program reads it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Element {
    /// Integers, or IEEE 754 numbers.
    Number(Number, ByteOrder),
    /// Two numbers, real and imaginary part.
    Complex {
        /// The type of either part.
        part: Box<Self>,
        /// Offset of the imaginary part.
        imaginary: usize,
        /// Bytes of an element.
        bytes: usize,
    },
    /// Enumeration of false and true in one byte or more.
    Bool {
        /// The integers that represent them.
        base: Box<Self>,
    },
    /// Named fields.
    Fields {
        /// Name, offset and type of each.
        fields: Vec<(String, usize, Self)>,
        /// Bytes of an element.
        bytes: usize,
    },
    /// Text, of fixed or variable length.
    Text,
    /// References to other objects of the file.
    Reference,
    /// A type that is not read; its name is for messages.
    Other(String),
}

impl Element {
    /// How the numbers are stored, for the channel's description.
    pub(crate) fn stored(&self) -> StoredType {
        match self {
            Self::Number(number, _) => number.stored(),
            Self::Complex { part, .. } => match part.stored() {
                StoredType::Int(bits) | StoredType::UInt(bits) | StoredType::Float(bits) => {
                    StoredType::Complex(bits)
                }
                other => other,
            },
            Self::Bool { .. } => StoredType::Bool,
            _ => StoredType::Text,
        }
    }

    /// Bytes of an element in the file's unpacked data; zero where unknown.
    pub(crate) fn bytes(&self) -> usize {
        match self {
            Self::Number(number, _) => to_usize(number.bytes()),
            Self::Complex { bytes, .. } | Self::Fields { bytes, .. } => *bytes,
            Self::Bool { base } => base.bytes(),
            Self::Reference => 8,
            Self::Text | Self::Other(_) => 0,
        }
    }

    /// Whether its values are numbers (complex ones too).
    pub(crate) fn is_number(&self) -> bool {
        matches!(
            self,
            Self::Number(..) | Self::Complex { .. } | Self::Bool { .. }
        )
    }

    /// Whether it is an integer type, to which a scale applies.
    pub(crate) fn is_integer(&self) -> bool {
        matches!(self, Self::Number(number, _) if !matches!(number, Number::F16 | Number::F32 | Number::F64))
    }

    /// Decode the numbers spaced in an array's bytes. `None`: the bytes are too few or the
    /// type is no number.
    pub(crate) fn decode(&self, raw: &[u8], spacing: Spacing) -> Option<Samples> {
        match self {
            Self::Complex {
                part, imaginary, ..
            } => {
                let re = part.real(raw, spacing)?;
                let offset = spacing.offset.checked_add(*imaginary)?;
                let im = part.real(raw, Spacing { offset, ..spacing })?;
                Some(Samples::Complex(re.into_iter().zip(im).collect()))
            }
            _ => self.real(raw, spacing).map(Samples::Real),
        }
    }

    fn real(&self, raw: &[u8], spacing: Spacing) -> Option<Vec<f64>> {
        if !fits(spacing, raw.len(), self.bytes()) {
            return None;
        }
        let mut values = Vec::with_capacity(spacing.count);
        match self {
            Self::Bool { base } => return base.real(raw, spacing),
            Self::Number(number, order) => {
                numbers::decode_spaced(*number, *order, raw, spacing, &mut values);
            }
            _ => return None,
        }
        Some(values)
    }
}

/// Whether an array of `length` bytes has all elements of a spacing.
fn fits(spacing: Spacing, length: usize, bytes: usize) -> bool {
    let last = spacing.count.saturating_sub(1).checked_mul(spacing.stride);
    let end = last.and_then(|l| l.checked_add(spacing.offset)?.checked_add(bytes));
    spacing.count == 0 || end.is_some_and(|e| e <= length && bytes > 0)
}

/// Fields, or a complex number where they are its two parts.
pub(crate) fn compound(fields: Vec<(String, usize, Element)>, bytes: usize) -> Element {
    if let [(re, first, part), (im, imaginary, second)] = fields.as_slice() {
        let pair = [re.to_ascii_lowercase(), im.to_ascii_lowercase()];
        let named = [
            ["r", "i"],
            ["re", "im"],
            ["real", "imag"],
            ["real", "imaginary"],
        ];
        let plain = matches!(part, Element::Number(..));
        if named.iter().any(|n| pair[0] == n[0] && pair[1] == n[1])
            && part == second
            && plain
            && *first == 0
        {
            return Element::Complex {
                part: Box::new(part.clone()),
                imaginary: *imaginary,
                bytes,
            };
        }
    }
    Element::Fields { fields, bytes }
}

/// An enumeration: of false and true, or else its integers.
pub(crate) fn boolean<'a>(base: Element, names: impl Iterator<Item = &'a str>) -> Element {
    let names: Vec<String> = names.map(str::to_ascii_lowercase).collect();
    if names.len() == 2 && names.iter().all(|n| n == "false" || n == "true") {
        return Element::Bool {
            base: Box::new(base),
        };
    }
    base
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_a_table() {
        let raw: Vec<u8> = (0..6i16).flat_map(i16::to_be_bytes).collect();
        let element = Element::Number(Number::I16, ByteOrder::Big);
        let spacing = Spacing {
            offset: 2,
            stride: 4,
            count: 3,
        };
        let decoded = Samples::Real(vec![1.0, 3.0, 5.0]);
        assert_eq!(element.decode(&raw, spacing), Some(decoded));
        let more = Spacing {
            count: 4,
            ..spacing
        };
        assert_eq!(element.decode(&raw, more), None);
        let wide = Spacing {
            stride: usize::MAX,
            ..spacing
        };
        assert_eq!(element.decode(&raw, wide), None);
    }
}
