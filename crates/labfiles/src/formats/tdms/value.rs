//! Types and property values of TDMS files.

use chrono::{DateTime, Datelike};

use crate::bytes::{Cursor, decode_text};
use crate::numbers::{ByteOrder, Number};
use crate::source::{ReadError, StoredType};

/// What a channel's samples or a property are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A real number.
    Number(Number),
    /// A complex number of two such parts.
    Complex(Number),
    /// One byte, true if it is not 0.
    Bool,
    /// Text.
    Text,
    /// 16 bytes: fractions of a second (2^-64) and seconds since 1904.
    Time,
    /// Samples of a `DAQmx` device, described by scalers.
    Device,
}

/// A type of samples or properties that is not read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(super) enum UnreadType {
    #[error("void")]
    Void,
    #[error("extended float")]
    ExtendedFloat,
    #[error("fixed point")]
    FixedPoint,
    #[error("unknown type {0:#x}")]
    Unknown(u32),
}

impl Kind {
    /// The kind of a type code.
    pub(super) fn of(code: u32) -> Result<Self, UnreadType> {
        Ok(match code {
            1 => Self::Number(Number::I8),
            2 => Self::Number(Number::I16),
            3 => Self::Number(Number::I32),
            4 => Self::Number(Number::I64),
            5 => Self::Number(Number::U8),
            6 => Self::Number(Number::U16),
            7 => Self::Number(Number::U32),
            8 => Self::Number(Number::U64),
            9 | 0x19 => Self::Number(Number::F32),
            10 | 0x1a => Self::Number(Number::F64),
            0x20 => Self::Text,
            0x21 => Self::Bool,
            0x44 => Self::Time,
            0x08_000c => Self::Complex(Number::F32),
            0x10_000d => Self::Complex(Number::F64),
            0xffff_ffff => Self::Device,
            0 => return Err(UnreadType::Void),
            11 | 0x1b => return Err(UnreadType::ExtendedFloat),
            0x4f => return Err(UnreadType::FixedPoint),
            other => return Err(UnreadType::Unknown(other)),
        })
    }

    /// Bytes of one sample; `None` where they are not fixed.
    pub(super) fn bytes(self) -> Option<u64> {
        match self {
            Self::Number(number) => Some(number.bytes()),
            Self::Complex(number) => Some(2 * number.bytes()),
            Self::Bool => Some(1),
            Self::Time => Some(16),
            Self::Text | Self::Device => None,
        }
    }

    /// The kind as a [`StoredType`].
    pub(super) fn stored(self) -> StoredType {
        match self {
            Self::Number(number) => number.stored(),
            Self::Complex(number) => StoredType::Complex(number.bits()),
            Self::Bool => StoredType::Bool,
            Self::Text => StoredType::Text,
            Self::Time => StoredType::Time,
            Self::Device => StoredType::Float(64),
        }
    }
}

/// A point in time: seconds since 1904-01-01 00:00 UTC and 2^-64 fractions of a second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Stamp {
    /// Whole seconds.
    pub seconds: i64,
    /// Fraction of a second, in units of 2^-64 s.
    pub fraction: u64,
}

impl Stamp {
    /// The stamp of sixteen bytes.
    pub(super) fn of(bytes: &[u8], order: ByteOrder) -> Self {
        let bytes = bytes.first_chunk().copied().unwrap_or_default();
        let word = match order {
            ByteOrder::Little => u128::from_le_bytes(bytes),
            ByteOrder::Big => u128::from_be_bytes(bytes),
        };
        let low = |word: u128| u64::try_from(word & u128::from(u64::MAX)).unwrap_or(u64::MAX);
        Self {
            seconds: low(word >> 64).cast_signed(),
            fraction: low(word),
        }
    }

    /// Seconds since another stamp.
    pub(super) fn seconds_since(self, start: Self) -> f64 {
        let whole = i128::from(self.seconds) - i128::from(start.seconds);
        let unit = 2f64.powi(-64);
        let fraction = i128::from(self.fraction) - i128::from(start.fraction);
        whole as f64 + fraction as f64 * unit
    }

    /// ISO 8601 text in UTC to the nanosecond; `None` where the stamp was never set (0) or its
    /// year has more than four digits.
    pub(super) fn iso8601(self) -> Option<String> {
        if self.seconds == 0 && self.fraction == 0 {
            return None;
        }
        let nanoseconds = (u128::from(self.fraction) * 1_000_000_000) >> 64;
        let nanoseconds = u32::try_from(nanoseconds).ok()?;
        let time = DateTime::from_timestamp(self.seconds.checked_sub(TO_1970_S)?, nanoseconds)?;
        let form = "%Y-%m-%dT%H:%M:%S%.9fZ";
        (0..10_000)
            .contains(&time.year())
            .then(|| time.format(form).to_string())
    }
}

/// Seconds from 1904-01-01 to 1970-01-01.
const TO_1970_S: i64 = 24_107 * 86_400;

/// The value of a property.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    /// A number; integers beyond 2^53 keep their text only.
    Number(f64, String),
    /// Text.
    Text(String),
    /// True or false.
    Bool(bool),
    /// A point in time.
    Time(Stamp),
}

impl Value {
    /// Read a property's value of a type.
    pub(super) fn read(
        cursor: &mut Cursor<'_>,
        code: u32,
        order: ByteOrder,
    ) -> Result<Self, ReadError> {
        let kind = match Kind::of(code) {
            Ok(kind) => kind,
            Err(UnreadType::Void) => return Ok(Self::Text(String::new())),
            Err(other) => return Err(cursor.refuse("a property's type", other.to_string())),
        };
        Ok(match kind {
            Kind::Text => Self::Text(text(cursor, "a property")?),
            Kind::Bool => Self::Bool(cursor.u8("a property")? != 0),
            Kind::Time => Self::Time(Stamp::of(cursor.take(16, "a time stamp")?, order)),
            Kind::Number(number) => self::number(cursor, number)?,
            Kind::Complex(part) => {
                let (re, im) = (self::number(cursor, part)?, self::number(cursor, part)?);
                Self::Text(format!("{} {}", re.text(), im.text()))
            }
            Kind::Device => return Err(cursor.refuse("a property's type", "DAQmx raw data")),
        })
    }

    /// The value as text.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Number(_, text) | Self::Text(text) => text.clone(),
            Self::Bool(value) => value.to_string(),
            Self::Time(stamp) => stamp.iso8601().unwrap_or_default(),
        }
    }

    /// The value as a number, if it is one.
    pub(super) fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value, _) => Some(*value),
            _ => None,
        }
    }
}

#[expect(clippy::cast_lossless, reason = "the macro is for 64-bit integers too")]
fn number(cursor: &mut Cursor<'_>, number: Number) -> Result<Value, ReadError> {
    macro_rules! as_is {
        ($value:expr) => {{
            let value = $value;
            Value::Number(value as f64, value.to_string())
        }};
    }
    Ok(match number {
        Number::I8 => as_is!(cursor.u8("a property")?.cast_signed()),
        Number::U8 => as_is!(cursor.u8("a property")?),
        Number::I16 => as_is!(cursor.u16("a property")?.cast_signed()),
        Number::U16 => as_is!(cursor.u16("a property")?),
        Number::I32 => as_is!(cursor.u32("a property")?.cast_signed()),
        Number::U32 => as_is!(cursor.u32("a property")?),
        Number::I64 => as_is!(cursor.u64("a property")?.cast_signed()),
        Number::U64 => as_is!(cursor.u64("a property")?),
        Number::F16 => as_is!(half::f16::from_bits(cursor.u16("a property")?).to_f64()),
        Number::F32 => as_is!(f32::from_bits(cursor.u32("a property")?)),
        Number::F64 => as_is!(f64::from_bits(cursor.u64("a property")?)),
    })
}

/// A text after its length.
pub(super) fn text(cursor: &mut Cursor<'_>, what: &str) -> Result<String, ReadError> {
    let length = cursor.u32(what)?;
    Ok(decode_text(cursor.take(u64::from(length), what)?).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_stamps_as_dates() {
        let iso = |seconds, fraction| Stamp { seconds, fraction }.iso8601();
        assert_eq!(
            iso(2_082_844_800, 0).as_deref(),
            Some("1970-01-01T00:00:00.000000000Z")
        );
        assert_eq!(
            iso(3_540_000_000 + 12, 1 << 63).as_deref(),
            Some("2016-03-05T05:20:12.500000000Z")
        );
        // Around the leap day of a year divisible by 400.
        assert_eq!(
            iso(3_034_540_800, 0).as_deref(),
            Some("2000-02-28T00:00:00.000000000Z")
        );
        assert_eq!(
            iso(3_034_627_200, 0).as_deref(),
            Some("2000-02-29T00:00:00.000000000Z")
        );
        assert_eq!(
            iso(3_034_713_600, 0).as_deref(),
            Some("2000-03-01T00:00:00.000000000Z")
        );
        assert_eq!(iso(0, 0), None);
        assert_eq!(iso(i64::MIN, 0), None);
        assert_eq!(iso(i64::MAX, 0), None);
    }

    #[test]
    fn differences_of_stamps_keep_the_fraction() {
        let start = Stamp {
            seconds: 3_540_000_000,
            fraction: 1 << 63,
        };
        let later = Stamp {
            seconds: 3_540_000_001,
            fraction: 0,
        };
        assert_eq!(later.seconds_since(start), 0.5);
        assert_eq!(start.seconds_since(later), -0.5);
    }
}
