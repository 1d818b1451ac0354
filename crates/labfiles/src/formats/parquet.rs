//! Parquet tables: wide (one column per channel), long by record (a column that names the record
//! beside the channels) and tidy (columns record, channel, time, value).

pub(crate) mod columns;
pub(crate) mod field;
pub(crate) mod footer;
pub(crate) mod guard;
pub(crate) mod shape;

use std::collections::BTreeMap;
use std::path::Path;

use crate::attribute;
use crate::conventions::{COLUMNS_KEY, RECORDS_KEY};
use crate::formats::csv::header::name_and_unit;
use crate::formats::parquet::columns::Columns;
use crate::formats::parquet::columns::SIGNATURE;
use crate::formats::parquet::shape::Origin;
use crate::rate;
use crate::source::{
    ChannelInfo, Clock, DatasetInfo, ReadError, Reader, Samples, Source, StoredType, opened,
};
use crate::timing::{self, AxisUnit};

struct ParquetReader {
    columns: Columns,
    plans: Vec<Vec<Origin>>,
}

/// Parquet's signature is at the front.
pub(crate) fn recognises(front: &[u8]) -> bool {
    front.starts_with(&SIGNATURE)
}

/// Open a Parquet file.
///
/// # Errors
/// If its footer is damaged or it holds no numbers.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let columns = Columns::open(path)?;
    let notes = columns.left_out();
    let own = columns.attributes.get(RECORDS_KEY);
    let own: BTreeMap<String, BTreeMap<String, String>> = own
        .and_then(|json| serde_json::from_str(json).ok())
        .unwrap_or_default();
    let held = columns.attributes.get(COLUMNS_KEY);
    let held: BTreeMap<String, Vec<String>> = held
        .and_then(|json| serde_json::from_str(json).ok())
        .unwrap_or_default();
    let (mut datasets, mut plans) = (Vec::new(), Vec::new());
    for (name, mut plan) in shape::find(&columns)? {
        if let Some(held) = held.get(&name) {
            plan.retain(|origin| held.contains(&origin.heading));
        }
        let own = own.get(&name).cloned().unwrap_or_default();
        datasets.push(dataset(&columns, name, &plan, own)?);
        plans.push(plan);
    }
    if datasets.iter().all(|d| d.channels.is_empty()) {
        return Err(ReadError::new(
            path,
            "columns of numbers",
            format!("none ({})", notes.join("; ")),
            "write the samples as numbers",
        ));
    }
    let reader = ParquetReader { columns, plans };
    opened("parquet", path, datasets, notes, reader)
}

/// A record; `own` are its attributes, if the file's footer keeps them.
fn dataset(
    columns: &Columns,
    name: String,
    plan: &[Origin],
    own: BTreeMap<String, String>,
) -> Result<DatasetInfo, ReadError> {
    let mut channels: Vec<ChannelInfo> = plan.iter().map(|o| channel(columns, o)).collect();
    let time_axis = channels
        .iter()
        .position(timing::is_time_axis)
        .or_else(|| channels.iter().position(|c| c.stored == StoredType::Time));
    let mut attributes = columns.attributes.clone();
    attributes.remove(RECORDS_KEY);
    attributes.remove(COLUMNS_KEY);
    attributes.extend(own);
    let mut rate = attribute::sample_rate_hz(&attributes);
    let first = time_axis.and_then(|axis| columns.first_time(plan[axis].column, &plan[axis].rows));
    let start = first.or_else(|| attribute::start_time(&attributes));
    if let Some(axis) = time_axis.filter(|_| rate.is_none())
        && let Samples::Real(values) = columns.read(plan[axis].column, &plan[axis].rows)?
    {
        let info = &channels[axis];
        let head = &values[..values.len().min(rate::HEAD_SAMPLES)];
        let unit = AxisUnit::of(info.unit.as_deref(), &info.name, head).seconds();
        let of = |unit| rate::from_axis(head, values.last().copied(), values.len() as u64, unit);
        rate = unit.and_then(of);
    }
    for channel in &mut channels {
        channel.sample_rate_hz = rate;
        channel.start_time.clone_from(&start);
    }
    Ok(DatasetInfo {
        name,
        channels,
        time_axis,
        attributes,
    })
}

fn channel(columns: &Columns, origin: &Origin) -> ChannelInfo {
    let (name, in_heading) = name_and_unit(&origin.heading);
    let key = format!("{}.unit", origin.heading);
    let unit = origin.unit.clone().or(in_heading);
    ChannelInfo {
        unit: unit.or_else(|| columns.attributes.get(&key).cloned()),
        name,
        stored: columns.fields[origin.column]
            .stored
            .unwrap_or(StoredType::Text),
        samples: origin.rows.iter().map(|r| r.1).sum(),
        sample_rate_hz: None,
        start_time: None,
        clock: origin.own_axis.map_or(Clock::Shared, Clock::Axis),
        start_s: None,
        properties: BTreeMap::new(),
    }
}

impl Reader for ParquetReader {
    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        let plan = &self.plans[dataset];
        channels
            .iter()
            .map(|&c| self.columns.read(plan[c].column, &plan[c].rows))
            .collect()
    }
}

#[cfg(test)]
mod tests;
