//! Records to one HDF5 file.

use std::path::Path;

use crate::convert::item::{Column, ConvertError, Item, Options};
use crate::hdf5::{AttributeValue, CampaignWriter, ColumnToWrite, RecordTable};

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
    let numbers = |column: Column| {
        let values = column.samples.into_real()?;
        let unit = column.unit.unwrap_or_default();
        Some(ColumnToWrite::numbers(column.name, unit, values))
    };
    let channels = item.columns()?.into_iter().filter_map(numbers).collect();
    let start = item
        .start_time()
        .map(|s| ("start_time".to_owned(), AttributeValue::from(s)));
    let value = |text: &String| match text.parse::<f64>() {
        Ok(number) if number.is_finite() => AttributeValue::Number(number),
        _ => AttributeValue::Text(text.clone()),
    };
    let own = item.described().map(|(k, v)| (k.clone(), value(v)));
    Ok(RecordTable {
        name: item.name.clone(),
        sample_rate_hz: item.sample_rate_hz(),
        channels,
        attributes: start.into_iter().chain(own).collect(),
    })
}
