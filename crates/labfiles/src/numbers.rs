//! Numbers as binary files store them: kind, width, byte order, and their way to f64.

use super::source::StoredType;

/// The order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ByteOrder {
    /// Least significant byte first.
    Little,
    /// Most significant byte first.
    Big,
}

/// How one real number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Number {
    /// Signed, 8 bits.
    I8,
    /// Signed, 16 bits.
    I16,
    /// Signed, 32 bits.
    I32,
    /// Signed, 64 bits.
    I64,
    /// Unsigned, 8 bits.
    U8,
    /// Unsigned, 16 bits.
    U16,
    /// Unsigned, 32 bits.
    U32,
    /// Unsigned, 64 bits.
    U64,
    /// IEEE 754, 32 bits.
    F32,
    /// IEEE 754, 64 bits.
    F64,
}

impl Number {
    /// Bytes of one number.
    pub(crate) fn bytes(self) -> u64 {
        u64::from(self.bits() / 8)
    }

    /// Bits of one number.
    pub(crate) fn bits(self) -> u8 {
        match self {
            Self::I8 | Self::U8 => 8,
            Self::I16 | Self::U16 => 16,
            Self::I32 | Self::U32 | Self::F32 => 32,
            Self::I64 | Self::U64 | Self::F64 => 64,
        }
    }

    /// The type as a [`StoredType`].
    pub(crate) fn stored(self) -> StoredType {
        let bits = self.bits();
        match self {
            Self::I8 | Self::I16 | Self::I32 | Self::I64 => StoredType::Int(bits),
            Self::U8 | Self::U16 | Self::U32 | Self::U64 => StoredType::UInt(bits),
            Self::F32 | Self::F64 => StoredType::Float(bits),
        }
    }

    /// The type's usual name, e.g. `int16`.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::I8 => "int8",
            Self::I16 => "int16",
            Self::I32 => "int32",
            Self::I64 => "int64",
            Self::U8 => "uint8",
            Self::U16 => "uint16",
            Self::U32 => "uint32",
            Self::U64 => "uint64",
            Self::F32 => "float32",
            Self::F64 => "float64",
        }
    }
}

/// Places of the samples of one channel among bytes: every `stride` bytes from `offset` on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Spacing {
    /// First byte of the first sample.
    pub offset: usize,
    /// Bytes from one sample to the next.
    pub stride: usize,
    /// Number of samples.
    pub count: usize,
}

macro_rules! by_kind {
    ($number:expr, $order:expr, $go:ident, $($arg:expr),*) => {
        match ($number, $order) {
            (Number::I8, _) => $go!(i8, from_le_bytes, $($arg),*),
            (Number::U8, _) => $go!(u8, from_le_bytes, $($arg),*),
            (Number::I16, ByteOrder::Little) => $go!(i16, from_le_bytes, $($arg),*),
            (Number::I16, ByteOrder::Big) => $go!(i16, from_be_bytes, $($arg),*),
            (Number::U16, ByteOrder::Little) => $go!(u16, from_le_bytes, $($arg),*),
            (Number::U16, ByteOrder::Big) => $go!(u16, from_be_bytes, $($arg),*),
            (Number::I32, ByteOrder::Little) => $go!(i32, from_le_bytes, $($arg),*),
            (Number::I32, ByteOrder::Big) => $go!(i32, from_be_bytes, $($arg),*),
            (Number::U32, ByteOrder::Little) => $go!(u32, from_le_bytes, $($arg),*),
            (Number::U32, ByteOrder::Big) => $go!(u32, from_be_bytes, $($arg),*),
            (Number::I64, ByteOrder::Little) => $go!(i64, from_le_bytes, $($arg),*),
            (Number::I64, ByteOrder::Big) => $go!(i64, from_be_bytes, $($arg),*),
            (Number::U64, ByteOrder::Little) => $go!(u64, from_le_bytes, $($arg),*),
            (Number::U64, ByteOrder::Big) => $go!(u64, from_be_bytes, $($arg),*),
            (Number::F32, ByteOrder::Little) => $go!(f32, from_le_bytes, $($arg),*),
            (Number::F32, ByteOrder::Big) => $go!(f32, from_be_bytes, $($arg),*),
            (Number::F64, ByteOrder::Little) => $go!(f64, from_le_bytes, $($arg),*),
            (Number::F64, ByteOrder::Big) => $go!(f64, from_be_bytes, $($arg),*),
        }
    };
}

impl ByteOrder {
    /// The 32-bit number that four bytes hold.
    pub(crate) fn u32(self, bytes: [u8; 4]) -> u32 {
        match self {
            Self::Little => u32::from_le_bytes(bytes),
            Self::Big => u32::from_be_bytes(bytes),
        }
    }
}

/// A number in the single precision that was asked for.
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding is what the caller asks for"
)]
pub(crate) fn to_f32(value: f64) -> f32 {
    value as f32
}

/// Append the numbers that fill `bytes` (an incomplete last one is left out).
#[expect(clippy::cast_lossless, reason = "the macro is for 64-bit integers too")]
pub(crate) fn decode(number: Number, order: ByteOrder, bytes: &[u8], out: &mut Vec<f64>) {
    macro_rules! go {
        ($kind:ty, $from:ident, $bytes:expr, $out:expr) => {{
            let (whole, _) = $bytes.as_chunks::<{ size_of::<$kind>() }>();
            $out.extend(whole.iter().map(|&chunk| <$kind>::$from(chunk) as f64));
        }};
    }
    by_kind!(number, order, go, bytes, out);
}

/// Append the numbers spaced in `bytes`; stops early where the bytes end.
#[expect(clippy::cast_lossless, reason = "the macro is for 64-bit integers too")]
pub(crate) fn decode_spaced(
    number: Number,
    order: ByteOrder,
    bytes: &[u8],
    spacing: Spacing,
    out: &mut Vec<f64>,
) {
    macro_rules! go {
        ($kind:ty, $from:ident, $bytes:expr, $out:expr) => {{
            let rows = $bytes.get(spacing.offset..).unwrap_or(&[]);
            let rows = rows.chunks(spacing.stride.max(1)).take(spacing.count);
            $out.extend(
                rows.map_while(|row| row.first_chunk())
                    .map(|&c| <$kind>::$from(c) as f64),
            );
        }};
    }
    if spacing.stride as u64 == number.bytes() {
        let bytes = bytes.get(spacing.offset..).unwrap_or(&[]);
        let length = spacing.count.saturating_mul(spacing.stride);
        return decode(number, order, &bytes[..length.min(bytes.len())], out);
    }
    by_kind!(number, order, go, bytes, out);
}

/// Pair real and imaginary parts.
pub(crate) fn pair(real: Vec<f64>, imaginary: Vec<f64>) -> Vec<(f64, f64)> {
    real.into_iter().zip(imaginary).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_in_both_orders() {
        let check = |number, little: &[u8], value: f64| {
            let mut big = little.to_vec();
            big.reverse();
            let mut out = Vec::new();
            decode(number, ByteOrder::Little, little, &mut out);
            decode(number, ByteOrder::Big, &big, &mut out);
            assert_eq!(out, [value, value], "{number:?}");
        };
        check(Number::I8, &(-5i8).to_le_bytes(), -5.0);
        check(Number::U8, &[200], 200.0);
        check(Number::I16, &(-300i16).to_le_bytes(), -300.0);
        check(Number::U16, &60_000u16.to_le_bytes(), 60_000.0);
        check(Number::I32, &(-70_000i32).to_le_bytes(), -70_000.0);
        check(Number::U32, &4_000_000_000u32.to_le_bytes(), 4e9);
        check(
            Number::I64,
            &(-1i64 << 40).to_le_bytes(),
            -((1u64 << 40) as f64),
        );
        check(
            Number::U64,
            &(1u64 << 63).to_le_bytes(),
            (1u64 << 63) as f64,
        );
        check(Number::F32, &1.5f32.to_le_bytes(), 1.5);
        check(Number::F64, &(-0.1f64).to_le_bytes(), -0.1);
    }

    #[test]
    fn spaced_numbers_stop_at_the_end() {
        let bytes = [1, 9, 9, 2, 9, 9, 3];
        let mut out = Vec::new();
        let spacing = Spacing {
            offset: 0,
            stride: 3,
            count: 100,
        };
        decode_spaced(Number::U8, ByteOrder::Little, &bytes, spacing, &mut out);
        assert_eq!(out, [1.0, 2.0, 3.0]);
        out.clear();
        let spacing = Spacing {
            offset: 1,
            stride: 3,
            count: 2,
        };
        decode_spaced(Number::U16, ByteOrder::Little, &bytes, spacing, &mut out);
        assert_eq!(out, [f64::from(0x0909), f64::from(0x0909)]);
    }
}
