//! The types of `hdf5-pure` as ours.

use ::hdf5::{Datatype, DatatypeByteOrder, FloatingPointLayout, ReferenceType};

use crate::bytes::to_usize;
use crate::formats::hdf5::element::{Element, boolean, compound};
use crate::numbers::{ByteOrder, Number};

/// A type as ours; [`Element::Other`] where no samples are of it.
pub(super) fn element(datatype: &Datatype) -> Element {
    let other = || Element::Other(datatype.to_string());
    match datatype {
        Datatype::FixedPoint {
            size,
            byte_order,
            layout,
        } => {
            let whole = layout.bit_offset == 0
                && size.checked_mul(8) == Some(u32::from(layout.bit_precision));
            let number = match (*size, layout.signed) {
                (1, true) => Number::I8,
                (2, true) => Number::I16,
                (4, true) => Number::I32,
                (8, true) => Number::I64,
                (1, false) => Number::U8,
                (2, false) => Number::U16,
                (4, false) => Number::U32,
                (8, false) => Number::U64,
                _ => return other(),
            };
            let order = order(*byte_order).filter(|_| whole);
            order.map_or_else(other, |order| Element::Number(number, order))
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
            let number = match size {
                2 if half => Number::F16,
                4 if *layout == FloatingPointLayout::IEEE754_BINARY32 => Number::F32,
                8 if *layout == FloatingPointLayout::IEEE754_BINARY64 => Number::F64,
                _ => return other(),
            };
            order(*byte_order).map_or_else(other, |order| Element::Number(number, order))
        }
        Datatype::Compound { size, members } => {
            let fields = members.iter().map(|m| {
                (
                    m.name.clone(),
                    to_usize(m.byte_offset),
                    element(&m.datatype),
                )
            });
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

/// The order of a number's bytes; `None`: neither of the usual two.
fn order(order: DatatypeByteOrder) -> Option<ByteOrder> {
    match order {
        DatatypeByteOrder::LittleEndian => Some(ByteOrder::Little),
        DatatypeByteOrder::BigEndian => Some(ByteOrder::Big),
        DatatypeByteOrder::Vax => None,
    }
}
