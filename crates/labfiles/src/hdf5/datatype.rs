//! The types of `hdf5-pure` as ours.

use ::hdf5::{Datatype, DatatypeByteOrder, FloatingPointLayout, ReferenceType};

use crate::hdf5::element::{Element, boolean, compound};

/// A type as ours; [`Element::Other`] where no samples are of it.
pub fn element(datatype: &Datatype) -> Element {
    let other = || Element::Other(kind(datatype).to_owned());
    match datatype {
        Datatype::FixedPoint {
            size,
            byte_order,
            layout,
        } => {
            let whole = layout.bit_offset == 0
                && size.checked_mul(8) == Some(u32::from(layout.bit_precision));
            match (*size, byte_order, whole) {
                (
                    1 | 2 | 4 | 8,
                    DatatypeByteOrder::LittleEndian | DatatypeByteOrder::BigEndian,
                    true,
                ) => {
                    let big = matches!(byte_order, DatatypeByteOrder::BigEndian);
                    Element::Int {
                        bytes: *size as usize,
                        signed: layout.signed,
                        big,
                    }
                }
                _ => other(),
            }
        }
        Datatype::FloatingPoint {
            size,
            byte_order,
            layout,
        } => {
            let half = (
                layout.exponent_size,
                layout.mantissa_size,
                layout.exponent_bias,
            ) == (5, 10, 15);
            let ieee = match size {
                2 => half,
                4 => *layout == FloatingPointLayout::IEEE754_BINARY32,
                8 => *layout == FloatingPointLayout::IEEE754_BINARY64,
                _ => false,
            };
            match (byte_order, ieee) {
                (DatatypeByteOrder::Vax, _) | (_, false) => other(),
                (order, true) => Element::Float {
                    bytes: *size as usize,
                    big: matches!(order, DatatypeByteOrder::BigEndian),
                },
            }
        }
        Datatype::Compound { size, members } => {
            let fields = members
                .iter()
                .map(|m| (m.name.clone(), m.byte_offset as usize, element(&m.datatype)));
            compound(fields.collect(), *size as usize)
        }
        Datatype::Enumeration {
            base_type, members, ..
        } => boolean(element(base_type), members.iter().map(|m| m.name.as_str())),
        Datatype::String { .. }
        | Datatype::VariableLength {
            is_string: true, ..
        } => Element::Text,
        Datatype::Reference {
            ref_type: ReferenceType::Object,
            ..
        } => Element::Reference,
        _ => other(),
    }
}

/// A type in words, for messages.
fn kind(datatype: &Datatype) -> &'static str {
    match datatype {
        Datatype::FixedPoint { .. } => "integer of unusual width",
        Datatype::FloatingPoint { .. } => "floating point of unusual width",
        Datatype::Time { .. } => "time",
        Datatype::BitField { .. } => "bit field",
        Datatype::Opaque { .. } => "opaque",
        Datatype::VariableLength { .. } => "variable length",
        Datatype::Array { .. } => "array",
        Datatype::Reference { .. } => "region reference",
        _ => "unknown",
    }
}
