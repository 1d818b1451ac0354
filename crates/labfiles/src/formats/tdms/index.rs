//! The raw data index of a channel: type, length, and the scalers of `DAQmx` data.

use std::sync::Arc;

use super::layout::{Device, Scaler, Share};
use super::value::Kind;
use crate::bytes::{Cursor, FileBytes};
use crate::numbers::Number;
use crate::source::ReadError;

const DEVICE: u32 = 0x1269;
const DIGITAL: [u32; 2] = [0x126a, 0x1369];

/// Read a raw data index, of which `header` has just been read.
pub(super) fn share(
    file: &FileBytes,
    cursor: &mut Cursor<'_>,
    header: u32,
) -> Result<Share, ReadError> {
    let at = cursor.at() - 4;
    let digital = DIGITAL.contains(&header);
    let device = digital || header == DEVICE;
    if !device && !(20..=28).contains(&header) {
        let expected = "a raw data index of 20 or 28 bytes, or one of DAQmx";
        return Err(file.refuse(at, expected, format!("{header:#x}")));
    }
    let code = cursor.u32("a data type")?;
    let kind = Kind::of(code).map_err(|unread| {
        let remedy = "save the channel again, as double precision numbers (DBL)";
        let found = unread.to_string();
        file.unsupported(at + 4, found, "a data type that is read", remedy)
    })?;
    let dimension = cursor.u32("a dimension")?;
    if dimension != 1 {
        return Err(file.refuse(at + 8, "dimension 1", dimension.to_string()));
    }
    let count = cursor.u64("the number of samples")?;
    let device = if device {
        Some(Arc::new(device_index(file, cursor, digital)?))
    } else {
        None
    };
    let bytes = match kind.bytes() {
        _ if device.is_some() => Some(0),
        Some(size) => count.checked_mul(size),
        None if kind == Kind::Text => {
            Some(cursor.u64("the bytes of texts")?).filter(|&bytes| bytes / 4 >= count)
        }
        None => None,
    };
    let unfit = || {
        let found = format!("{count} samples");
        file.refuse(at, "a length that fits the type", found)
    };
    Ok(Share {
        kind,
        count,
        bytes: bytes.ok_or_else(unfit)?,
        device,
    })
}

fn device_index(
    file: &FileBytes,
    cursor: &mut Cursor<'_>,
    digital: bool,
) -> Result<Device, ReadError> {
    let at = cursor.at();
    let count = cursor.u32("the number of DAQmx scalers")?;
    let scalers: Result<Vec<_>, _> = (0..count).map(|_| scaler(cursor, digital)).collect();
    let scalers = scalers?;
    let widths = cursor.u32("the number of raw data widths")?;
    let widths: Result<Vec<_>, _> = (0..widths)
        .map(|_| cursor.u32("a raw data width").map(u64::from))
        .collect();
    if scalers.is_empty() {
        return Err(file.refuse(at, "at least one DAQmx scaler", "none"));
    }
    Ok(Device {
        scalers,
        widths: widths?,
    })
}

fn scaler(cursor: &mut Cursor<'_>, digital: bool) -> Result<Scaler, ReadError> {
    let code = cursor.u32("a DAQmx type")?;
    let number = match code {
        0 => Number::U8,
        1 => Number::I8,
        2 => Number::U16,
        3 => Number::I16,
        4 => Number::U32,
        5 => Number::I32,
        6 => Number::U64,
        7 => Number::I64,
        other => return Err(cursor.refuse("a DAQmx type from 0 to 7", other.to_string())),
    };
    let buffer = cursor.u32("a DAQmx buffer")?;
    let offset = u64::from(cursor.u32("a DAQmx offset")?);
    if digital {
        cursor.u8("a DAQmx bitmap")?;
    } else {
        cursor.u32("a DAQmx bitmap")?;
    }
    let scale = cursor.u32("a DAQmx scale")?;
    let (byte, bit) = if digital {
        (offset / 8, Some((offset % 8) as u32))
    } else {
        (offset, None)
    };
    Ok(Scaler {
        scale,
        number,
        buffer,
        byte,
        bit,
    })
}
