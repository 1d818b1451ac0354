//! Records to one HDF5 file.

use std::path::Path;

use crate::convert::item::{ConvertError, Item, Options};
use crate::hdf5_write::{CampaignWriter, ColumnToWrite, RecordTable, Value};
use crate::source::Samples;

/// Write all records; texts are left out, complex numbers become two channels.
pub(super) fn write(items: &[Item<'_>], out: &Path, options: &Options) -> Result<(), ConvertError> {
    let mut writer = CampaignWriter::create(out);
    if options.single_precision {
        writer = writer.single_precision();
    }
    for item in items {
        let record = record(item)?;
        if !record.channels.is_empty() {
            writer.add(record)?;
        }
    }
    Ok(writer.finish()?)
}

fn record(item: &Item<'_>) -> Result<RecordTable, ConvertError> {
    let mut channels = Vec::new();
    let named = item.names().into_iter().zip(item.channels());
    for ((name, info), samples) in named.zip(item.read()?) {
        let unit = info.unit.clone().unwrap_or_default();
        match samples {
            Samples::Real(values) => {
                channels.push(ColumnToWrite::numbers(name, unit, values));
            }
            Samples::Complex(values) => {
                let (re, im) = values.into_iter().unzip();
                channels.push(ColumnToWrite::numbers(
                    format!("{name}.re"),
                    unit.clone(),
                    re,
                ));
                channels.push(ColumnToWrite::numbers(format!("{name}.im"), unit, im));
            }
            Samples::Text(_) => {}
        }
    }
    let start = item
        .start_time()
        .map(|s| ("start_time".to_owned(), Value::from(s)));
    let value = |text: &String| match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Value::Number(number),
        _ => Value::Text(text.clone()),
    };
    let own = item.described().map(|(k, v)| (k.clone(), value(v)));
    Ok(RecordTable {
        name: item.name.clone(),
        sample_rate_hz: item.sample_rate_hz(),
        channels,
        attributes: start.into_iter().chain(own).collect(),
    })
}
