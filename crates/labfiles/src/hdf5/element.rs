//! Element types of HDF5 arrays and their conversion to numbers.

use crate::source::{Samples, StoredType};

/// The type of an array's elements, as far as the program reads it.
#[derive(Debug, Clone, PartialEq)]
pub enum Element {
    /// Integers of 1, 2, 4 or 8 bytes.
    Int {
        /// Bytes of an element.
        bytes: usize,
        /// Two's complement, or without sign.
        signed: bool,
        /// Most significant byte first.
        big: bool,
    },
    /// IEEE 754 numbers of 2, 4 or 8 bytes.
    Float {
        /// Bytes of an element.
        bytes: usize,
        /// Most significant byte first.
        big: bool,
    },
    /// Two numbers, real and imaginary part.
    Complex {
        /// The type of either part.
        part: Box<Element>,
        /// Offset of the imaginary part.
        imaginary: usize,
        /// Bytes of an element.
        bytes: usize,
    },
    /// Enumeration of false and true in one byte or more.
    Bool {
        /// The integers that stand for them.
        base: Box<Element>,
    },
    /// Named fields.
    Fields {
        /// Name, offset and type of each.
        fields: Vec<(String, usize, Element)>,
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
    pub fn stored(&self) -> StoredType {
        let bits = |bytes: usize| (8 * bytes) as u8;
        match self {
            Self::Int {
                bytes,
                signed: true,
                ..
            } => StoredType::Int(bits(*bytes)),
            Self::Int { bytes, .. } => StoredType::UInt(bits(*bytes)),
            Self::Float { bytes, .. } => StoredType::Float(bits(*bytes)),
            Self::Complex { part, .. } => StoredType::Complex(bits(part.bytes())),
            Self::Bool { .. } => StoredType::Bool,
            _ => StoredType::Text,
        }
    }

    /// Bytes of an element in the file's unpacked data; zero where unknown.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Int { bytes, .. } | Self::Float { bytes, .. } => *bytes,
            Self::Complex { bytes, .. } | Self::Fields { bytes, .. } => *bytes,
            Self::Bool { base } => base.bytes(),
            Self::Reference => 8,
            Self::Text | Self::Other(_) => 0,
        }
    }

    /// Whether its values are numbers (complex ones too).
    pub fn is_number(&self) -> bool {
        matches!(
            self,
            Self::Int { .. } | Self::Float { .. } | Self::Complex { .. } | Self::Bool { .. }
        )
    }

    /// Whether it is an integer type, to which a scale applies.
    pub fn is_integer(&self) -> bool {
        matches!(self, Self::Int { .. })
    }

    /// Decode the numbers at a stride in an array's bytes. `None`: the bytes are too few or the
    /// type is no number.
    pub fn decode(&self, raw: &[u8], stride: Stride) -> Option<Samples> {
        match self {
            Self::Complex {
                part, imaginary, ..
            } => {
                let re = part.real(raw, stride)?;
                let first = stride.first.checked_add(*imaginary)?;
                let im = part.real(raw, Stride { first, ..stride })?;
                Some(Samples::Complex(re.into_iter().zip(im).collect()))
            }
            _ => self.real(raw, stride).map(Samples::Real),
        }
    }

    fn real(&self, raw: &[u8], stride: Stride) -> Option<Vec<f64>> {
        if !stride.fits(raw.len(), self.bytes()) {
            return None;
        }
        macro_rules! numbers {
            ($type:ty, $big:expr) => {
                if $big {
                    stride.map(raw, |b: [u8; size_of::<$type>()]| {
                        <$type>::from_be_bytes(b) as f64
                    })
                } else {
                    stride.map(raw, |b: [u8; size_of::<$type>()]| {
                        <$type>::from_le_bytes(b) as f64
                    })
                }
            };
        }
        Some(match *self {
            Self::Bool { ref base } => return base.real(raw, stride),
            Self::Int {
                bytes: 1,
                signed: true,
                big,
            } => numbers!(i8, big),
            Self::Int {
                bytes: 2,
                signed: true,
                big,
            } => numbers!(i16, big),
            Self::Int {
                bytes: 4,
                signed: true,
                big,
            } => numbers!(i32, big),
            Self::Int {
                bytes: 8,
                signed: true,
                big,
            } => numbers!(i64, big),
            Self::Int { bytes: 1, big, .. } => numbers!(u8, big),
            Self::Int { bytes: 2, big, .. } => numbers!(u16, big),
            Self::Int { bytes: 4, big, .. } => numbers!(u32, big),
            Self::Int { bytes: 8, big, .. } => numbers!(u64, big),
            Self::Float { bytes: 4, big } => numbers!(f32, big),
            Self::Float { bytes: 8, big } => numbers!(f64, big),
            Self::Float {
                bytes: 2,
                big: true,
            } => stride.map(raw, |b| half(u16::from_be_bytes(b))),
            Self::Float {
                bytes: 2,
                big: false,
            } => stride.map(raw, |b| half(u16::from_le_bytes(b))),
            _ => return None,
        })
    }
}

/// Where the elements of one channel lie in an array's bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stride {
    /// Offset of the first.
    pub first: usize,
    /// Bytes from one to the next.
    pub step: usize,
    /// How many.
    pub count: usize,
}

impl Stride {
    fn fits(self, length: usize, bytes: usize) -> bool {
        let last = self.count.saturating_sub(1).checked_mul(self.step);
        let end = last.and_then(|l| l.checked_add(self.first)?.checked_add(bytes));
        self.count == 0 || end.is_some_and(|e| e <= length && bytes > 0)
    }

    #[inline]
    fn map<const N: usize>(self, raw: &[u8], number: impl Fn([u8; N]) -> f64) -> Vec<f64> {
        if self.count == 0 {
            return Vec::new();
        }
        let tail = &raw[self.first..];
        let of = |chunk: &[u8]| number(std::array::from_fn(|i| chunk[i]));
        if self.step == N {
            return tail.chunks_exact(N).take(self.count).map(of).collect();
        }
        // The last chunk may end with its element.
        (0..self.count)
            .map(|i| of(&tail[i * self.step..i * self.step + N]))
            .collect()
    }
}

/// An IEEE 754 half-precision number.
fn half(bits: u16) -> f64 {
    let sign = if bits >> 15 == 1 { -1.0 } else { 1.0 };
    let exponent = i32::from(bits >> 10 & 0x1F);
    let fraction = f64::from(bits & 0x3FF) / 1024.0;
    sign * match exponent {
        0 => fraction * 2f64.powi(-14),
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        _ => (1.0 + fraction) * 2f64.powi(exponent - 15),
    }
}

/// Fields, or a complex number where they are its two parts.
pub fn compound(fields: Vec<(String, usize, Element)>, bytes: usize) -> Element {
    if let [(re, first, part), (im, imaginary, second)] = fields.as_slice() {
        let pair = [re.to_ascii_lowercase(), im.to_ascii_lowercase()];
        let named = [
            ["r", "i"],
            ["re", "im"],
            ["real", "imag"],
            ["real", "imaginary"],
        ];
        let plain = matches!(part, Element::Float { .. } | Element::Int { .. });
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
pub fn boolean<'a>(base: Element, names: impl Iterator<Item = &'a str>) -> Element {
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
    fn valid_columns_of_a_table() {
        let raw: Vec<u8> = (0..6i16).flat_map(i16::to_be_bytes).collect();
        let element = Element::Int {
            bytes: 2,
            signed: true,
            big: true,
        };
        let stride = Stride {
            first: 2,
            step: 4,
            count: 3,
        };
        assert_eq!(
            element.decode(&raw, stride),
            Some(Samples::Real(vec![1.0, 3.0, 5.0]))
        );
        assert_eq!(element.decode(&raw, Stride { count: 4, ..stride }), None);
        assert_eq!(
            element.decode(
                &raw,
                Stride {
                    step: usize::MAX,
                    ..stride
                }
            ),
            None
        );
    }

    #[test]
    fn valid_half_precision() {
        for (bits, value) in [
            (0x3C00, 1.0),
            (0xC000, -2.0),
            (0x7BFF, 65504.0),
            (1, 2f64.powi(-24)),
        ] {
            assert_eq!(half(bits), value);
        }
        assert!(half(0x7E00).is_nan());
    }
}
