//! Numbers as binary files store them: kind, width, byte order, and their way to f64.

use half::f16;

use super::source::StoredType;
pub(crate) use crate::bytes::ByteOrder;
use crate::bytes::to_usize;

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
    /// IEEE 754, 16 bits.
    F16,
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
            Self::I16 | Self::U16 | Self::F16 => 16,
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
            Self::F16 | Self::F32 | Self::F64 => StoredType::Float(bits),
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

/// Numbers one after the other.
pub(crate) fn decode(number: Number, order: ByteOrder, bytes: &[u8], out: &mut Vec<f64>) {
    let stride = to_usize(number.bytes());
    let spacing = Spacing {
        offset: 0,
        stride,
        count: bytes.len() / stride,
    };
    decode_spaced(number, order, bytes, spacing, out);
}

/// Numbers at equal distances, as far as the bytes go.
pub(crate) fn decode_spaced(
    number: Number,
    order: ByteOrder,
    bytes: &[u8],
    spacing: Spacing,
    out: &mut Vec<f64>,
) {
    let rows = bytes.get(spacing.offset..).unwrap_or(&[]);
    macro_rules! extend {
        ($kind:ty, $from:ident, $to:expr) => {{
            let value = |chunk: &[u8; size_of::<$kind>()]| $to(<$kind>::$from(*chunk));
            if spacing.stride == size_of::<$kind>() {
                out.extend(rows.as_chunks().0.iter().take(spacing.count).map(value));
            } else {
                let rows = rows.chunks(spacing.stride.max(1)).take(spacing.count);
                out.extend(rows.map_while(|row| row.first_chunk()).map(value));
            }
        }};
    }
    macro_rules! go {
        ($kind:ty, $to:expr) => {
            match order {
                ByteOrder::Little => extend!($kind, from_le_bytes, $to),
                ByteOrder::Big => extend!($kind, from_be_bytes, $to),
            }
        };
    }
    match number {
        Number::I8 => go!(i8, f64::from),
        Number::U8 => go!(u8, f64::from),
        Number::I16 => go!(i16, f64::from),
        Number::U16 => go!(u16, f64::from),
        Number::I32 => go!(i32, f64::from),
        Number::U32 => go!(u32, f64::from),
        Number::I64 => go!(i64, |v| v as f64),
        Number::U64 => go!(u64, |v| v as f64),
        Number::F16 => go!(f16, f16::to_f64),
        Number::F32 => go!(f32, f64::from),
        Number::F64 => go!(f64, f64::from),
    }
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
        for (bits, value) in [
            (0x3C00_u16, 1.0),
            (0x3C01, 1.000_976_562_5),
            (0xC000, -2.0),
            (0x7BFF, 65_504.0),
            (1, 2f64.powi(-24)),
            (0x7C00, f64::INFINITY),
        ] {
            check(Number::F16, &bits.to_le_bytes(), value);
        }
        let mut nan = Vec::new();
        decode(
            Number::F16,
            ByteOrder::Little,
            &0x7E00_u16.to_le_bytes(),
            &mut nan,
        );
        assert!(nan[0].is_nan());
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
