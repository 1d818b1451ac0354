//! Records in the file: tables of samples × channels, or groups of arrays.

use std::convert::identity;

use ::hdf5::{AttrValue, DatasetBuilder, FinishedGroup, GroupBuilder};

use crate::hdf5::record::{AttributeValue, ColumnToWrite, Folder, RecordTable, Stored};
use crate::to_f32;

/// Rows of a chunk.
const CHUNK_ROWS: u64 = 4096;
/// Effort of packing: higher ones gain little on noisy signals.
const DEFLATE_LEVEL: u32 = 4;

/// Put a folder's records and folders into a group.
pub(super) fn fill(mut group: GroupBuilder, folder: Folder, single: bool) -> FinishedGroup {
    for record in folder.records {
        if is_table(&record) {
            table(group.create_dataset(&record.name), &record, single);
        } else {
            let own = arrays(group.create_group(&record.name), &record, single);
            group.add_group(own);
        }
    }
    for (name, folder) in folder.folders {
        let inner = fill(group.create_group(&name), folder, single);
        group.add_group(inner);
    }
    group.finish()
}

/// Whether all channels fit one table: of one length, all numbers or all counts.
pub(super) fn is_table(record: &RecordTable) -> bool {
    let counts = |c: &ColumnToWrite| matches!(c.samples, Stored::Counts { .. });
    record
        .channels
        .windows(2)
        .all(|w| w[0].samples.len() == w[1].samples.len() && counts(&w[0]) == counts(&w[1]))
        && record.channels.len() > 1
        && record.channels[0].samples.len() > 1
}

pub(super) fn attr(value: &AttributeValue) -> AttrValue {
    match value {
        AttributeValue::Number(number) => AttrValue::F64(*number),
        AttributeValue::Text(text) => AttrValue::String(text.clone()),
    }
}

/// A record as one dataset samples × channels.
pub(super) fn table(dataset: &mut DatasetBuilder, record: &RecordTable, single: bool) {
    let (mut numbers, mut counts) = (Vec::new(), Vec::new());
    let (mut scales, mut offsets) = (Vec::new(), Vec::new());
    for channel in &record.channels {
        match &channel.samples {
            Stored::Numbers(values) => numbers.push(&values[..]),
            Stored::Counts {
                counts: own,
                scale,
                offset,
            } => {
                counts.push(&own[..]);
                scales.push(*scale);
                offsets.push(*offset);
            }
        }
    }
    if !counts.is_empty() {
        dataset.with_i16_data(&interleaved(&counts, identity));
        dataset.set_attr("scale", AttrValue::F64Array(scales));
        dataset.set_attr("offset", AttrValue::F64Array(offsets));
    } else if single {
        dataset.with_f32_data(&interleaved(&numbers, to_f32));
    } else {
        dataset.with_f64_data(&interleaved(&numbers, identity));
    }
    let rows = record.channels[0].samples.len() as u64;
    let columns = record.channels.len() as u64;
    dataset.with_shape(&[rows, columns]);
    pack(dataset, &[rows.clamp(1, CHUNK_ROWS), columns]);
    let names = record.channels.iter().map(|c| c.name.clone()).collect();
    let units = record.channels.iter().map(|c| c.unit.clone()).collect();
    dataset.set_attr("channels", AttrValue::StringArray(names));
    dataset.set_attr("units", AttrValue::StringArray(units));
    for (name, value) in described(record) {
        dataset.set_attr(&name, value);
    }
}

/// The samples of columns of one length row by row.
fn interleaved<T: Copy, U>(columns: &[&[T]], of: impl Fn(T) -> U) -> Vec<U> {
    (0..columns[0].len())
        .flat_map(|row| columns.iter().map(move |column| column[row]))
        .map(of)
        .collect()
}

fn pack(dataset: &mut DatasetBuilder, chunk: &[u64]) {
    dataset
        .with_chunks(chunk)
        .with_shuffle()
        .with_deflate(DEFLATE_LEVEL);
}

/// The attributes that describe a record.
fn described(record: &RecordTable) -> Vec<(String, AttrValue)> {
    let rate = record
        .sample_rate_hz
        .map(|r| ("sample_rate_hz".to_owned(), AttrValue::F64(r)));
    let own = record.attributes.iter().map(|(n, v)| (n.clone(), attr(v)));
    rate.into_iter().chain(own).collect()
}

/// A record as a group of one-dimensional datasets.
pub(super) fn arrays(mut group: GroupBuilder, record: &RecordTable, single: bool) -> FinishedGroup {
    for (name, value) in described(record) {
        group.set_attr(&name, value);
    }
    for channel in &record.channels {
        // A slash would make a group of the channel.
        let dataset = group.create_dataset(&channel.name.replace('/', "_"));
        match &channel.samples {
            Stored::Counts {
                counts,
                scale,
                offset,
            } => {
                dataset.with_i16_data(counts);
                dataset.set_attr("scale", AttrValue::F64(*scale));
                dataset.set_attr("offset", AttrValue::F64(*offset));
            }
            Stored::Numbers(values) if single => {
                let values: Vec<f32> = values.iter().copied().map(to_f32).collect();
                dataset.with_f32_data(&values);
            }
            Stored::Numbers(values) => {
                dataset.with_f64_data(values);
            }
        }
        if channel.samples.len() > 0 {
            pack(dataset, &[(channel.samples.len() as u64).min(CHUNK_ROWS)]);
        }
        dataset.set_attr("units", AttrValue::String(channel.unit.clone()));
    }
    group.finish()
}
