//! The type of a column and its way to samples.

use half::f16;
use polars::prelude::{ArrowDataType, ArrowTimeUnit, DataType, PolarsResult, Series, polars_bail};
use polars_arrow::array::{ArrayRef, FixedSizeBinaryArray, PrimitiveArray};

use crate::source::{Samples, StoredType};

/// A column's name and type.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    /// Its name as written.
    pub name: String,
    /// How its samples are stored; `None`: a type that is not read.
    pub stored: Option<StoredType>,
    /// The type by which its pages are decoded.
    pub physical: ArrowDataType,
    /// Ticks per second of a point in time.
    pub ticks_per_second: f64,
}

impl Field {
    /// A column of a type of the footer's schema.
    pub(crate) fn new(name: String, datatype: &ArrowDataType) -> Self {
        use ArrowDataType as A;
        let ticks = |unit: &ArrowTimeUnit| match unit {
            ArrowTimeUnit::Second => 1.0,
            ArrowTimeUnit::Millisecond => 1e3,
            ArrowTimeUnit::Microsecond => 1e6,
            ArrowTimeUnit::Nanosecond => 1e9,
        };
        let text = |d: &A| matches!(d, A::Utf8 | A::LargeUtf8 | A::Utf8View);
        let (stored, physical, ticks_per_second) = match datatype {
            A::Int8 => (Some(StoredType::Int(8)), A::Int32, 1.0),
            A::Int16 => (Some(StoredType::Int(16)), A::Int32, 1.0),
            A::Int32 => (Some(StoredType::Int(32)), A::Int32, 1.0),
            A::Int64 => (Some(StoredType::Int(64)), A::Int64, 1.0),
            A::UInt8 => (Some(StoredType::UInt(8)), A::Int32, 1.0),
            A::UInt16 => (Some(StoredType::UInt(16)), A::Int32, 1.0),
            A::UInt32 => (Some(StoredType::UInt(32)), A::UInt32, 1.0),
            A::UInt64 => (Some(StoredType::UInt(64)), A::UInt64, 1.0),
            A::Float16 => (Some(StoredType::Float(16)), A::FixedSizeBinary(2), 1.0),
            A::Float32 => (Some(StoredType::Float(32)), A::Float32, 1.0),
            A::Float64 => (Some(StoredType::Float(64)), A::Float64, 1.0),
            A::Boolean => (Some(StoredType::Bool), A::Boolean, 1.0),
            A::Timestamp(unit, _) => {
                let stored = Some(StoredType::Time);
                (stored, A::Timestamp(*unit, None), ticks(unit))
            }
            A::Time64(unit) | A::Duration(unit) => (Some(StoredType::Time), A::Int64, ticks(unit)),
            A::Time32(unit) => (Some(StoredType::Time), A::Int32, ticks(unit)),
            A::Date32 => (Some(StoredType::Time), A::Int32, 1.0 / 86_400.0),
            A::Dictionary(_, inner, _) if text(inner) => (Some(StoredType::Text), A::Utf8View, 1.0),
            other if text(other) => (Some(StoredType::Text), A::Utf8View, 1.0),
            other => (None, other.clone(), 1.0),
        };
        Self {
            name,
            stored,
            physical,
            ticks_per_second,
        }
    }
}

/// Points in time as the integers that they are, and numbers of two bytes as numbers; others as they
/// are.
pub(crate) fn plain(array: ArrayRef) -> ArrayRef {
    let any = array.as_any();
    match array.dtype() {
        ArrowDataType::Timestamp(..) => {
            let ticks = any.downcast_ref::<PrimitiveArray<i64>>().cloned();
            ticks.map_or(array, |t| t.to(ArrowDataType::Int64).boxed())
        }
        ArrowDataType::FixedSizeBinary(2) => {
            let number = |bytes: &[u8]| f16::from_le_bytes([bytes[0], bytes[1]]).to_f64();
            let halves = any.downcast_ref::<FixedSizeBinaryArray>();
            let numbers = halves.map(|all| all.iter().map(|v| v.map(number)).collect());
            numbers.map_or(array, |n: PrimitiveArray<f64>| n.boxed())
        }
        _ => array,
    }
}

/// A column's samples; missing numbers are NaN, missing texts empty.
#[expect(clippy::cast_lossless, reason = "the macro is for 64-bit integers too")]
pub(crate) fn samples(series: &Series) -> PolarsResult<Samples> {
    macro_rules! numbers {
        ($chunked:expr) => {{
            let mut values = Vec::with_capacity($chunked.len());
            for chunk in $chunked.downcast_iter() {
                match chunk.validity() {
                    None => values.extend(chunk.values().iter().map(|v| *v as f64)),
                    Some(_) => {
                        values.extend(chunk.iter().map(|v| v.map_or(f64::NAN, |v| *v as f64)))
                    }
                }
            }
            Samples::Real(values)
        }};
    }
    Ok(match series.dtype() {
        DataType::String => {
            let texts = series
                .str()?
                .iter()
                .map(|t| t.unwrap_or_default().to_owned());
            Samples::Text(texts.collect())
        }
        DataType::Boolean => {
            let truths = series
                .bool()?
                .iter()
                .map(|b| b.map_or(f64::NAN, |b| f64::from(u8::from(b))));
            Samples::Real(truths.collect())
        }
        DataType::Int32 => numbers!(series.i32()?),
        DataType::Int64 => numbers!(series.i64()?),
        DataType::UInt32 => numbers!(series.u32()?),
        DataType::UInt64 => numbers!(series.u64()?),
        DataType::Float32 => numbers!(series.f32()?),
        DataType::Float64 => numbers!(series.f64()?),
        other => polars_bail!(ComputeError: "{other} is not read"),
    })
}
