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
use crate::csv::header::name_and_unit;
pub(crate) use crate::parquet::columns::SIGNATURE;
use crate::parquet::columns::{Columns, Range};
use crate::parquet::field::Field;
use crate::parquet::shape::{Labelled, Shape, Tidy};
use crate::rate;
use crate::source::{
    ChannelInfo, DatasetInfo, Opened, ReadError, Reader, Samples, Source, StoredType,
};
use crate::units::parse_unit;

/// The key under which a footer keeps each record's attributes, as JSON.
pub(crate) const RECORDS_KEY: &str = "impactid_records";
/// The records of a file, as far as they are described.
struct Builder {
    columns: Columns,
    datasets: Vec<DatasetInfo>,
    plans: Vec<Vec<Origin>>,
    notes: Vec<String>,
    /// Attributes of each record, if the file's footer keeps them.
    own: BTreeMap<String, BTreeMap<String, String>>,
}

struct ParquetReader {
    columns: Columns,
    plans: Vec<Vec<Origin>>,
}

/// Where a channel's samples are: a column and its rows.
struct Origin {
    column: usize,
    rows: Vec<Range>,
}

/// Open a Parquet file.
///
/// # Errors
/// If its footer is damaged or it holds no numbers.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let columns = Columns::open(path)?;
    let shape = shape::find(&columns)?;
    let notes = columns.left_out();
    let own = columns.attributes().get(RECORDS_KEY);
    let own = own
        .and_then(|json| serde_json::from_str(json).ok())
        .unwrap_or_default();
    let mut source = Builder {
        columns,
        datasets: Vec::new(),
        plans: Vec::new(),
        notes,
        own,
    };
    match shape {
        Shape::Wide => source.add_wide(String::new(), &[(0, source.columns.rows())], &[]),
        Shape::ByRecord { key, records } => {
            for (name, rows) in records {
                source.add_wide(name, &rows, &[key]);
            }
        }
        Shape::Tidy { tidy, records } => {
            for (name, channels) in records {
                source.add_tidy(name, channels, &tidy);
            }
        }
    }
    if source.datasets.iter().all(|d| d.channels.is_empty()) {
        return Err(ReadError::new(
            path,
            "columns of numbers",
            format!("none ({})", source.notes.join("; ")),
            "Write the samples as numbers.",
        ));
    }
    source.measure_rates()?;
    Ok(Box::new(Opened {
        format: "parquet",
        path: path.to_path_buf(),
        datasets: source.datasets,
        notes: source.notes,
        reader: ParquetReader {
            columns: source.columns,
            plans: source.plans,
        },
    }))
}

fn length(rows: &[Range]) -> u64 {
    rows.iter().map(|r| r.1).sum()
}

impl Builder {
    /// A record whose channels are columns.
    fn add_wide(&mut self, name: String, rows: &[Range], without: &[usize]) {
        let fields: Vec<(usize, Field)> = self
            .columns
            .fields()
            .iter()
            .enumerate()
            .filter(|(i, f)| f.stored.is_some() && !without.contains(i))
            .map(|(i, f)| (i, f.clone()))
            .collect();
        let channels = fields
            .iter()
            .map(|(_, f)| self.channel(&f.name, None, f, length(rows)))
            .collect();
        let plan = fields
            .iter()
            .map(|&(column, _)| Origin {
                column,
                rows: rows.to_vec(),
            })
            .collect();
        self.push(name, channels, plan);
    }

    /// A record whose channels are rows of one column.
    fn add_tidy(&mut self, name: String, channels: Labelled, tidy: &Tidy) {
        let Tidy {
            value,
            time,
            unit: units,
        } = tidy;
        let (value, time) = (*value, *time);
        let mut infos = Vec::new();
        let mut plan = Vec::new();
        let axis = time.zip(channels.first().map(|(_, rows)| rows.clone()));
        if let Some((column, rows)) = axis {
            let field = self.columns.fields()[column].clone();
            infos.push(self.channel(&field.name, None, &field, length(&rows)));
            plan.push(Origin { column, rows });
        }
        let field = self.columns.fields()[value].clone();
        for (channel, rows) in channels {
            let unit = units.as_ref().and_then(|u| u.get(&channel).cloned());
            infos.push(self.channel(&channel, unit, &field, length(&rows)));
            plan.push(Origin {
                column: value,
                rows,
            });
        }
        self.push(name, infos, plan);
    }

    fn channel(
        &self,
        heading: &str,
        unit: Option<String>,
        field: &Field,
        samples: u64,
    ) -> ChannelInfo {
        let (name, in_heading) = name_and_unit(heading);
        let key = format!("{heading}.unit");
        ChannelInfo {
            unit: unit
                .or(in_heading)
                .or_else(|| self.columns.attributes().get(&key).cloned()),
            name,
            stored: field.stored.unwrap_or(StoredType::Text),
            samples,
            sample_rate_hz: None,
            start_time: None,
            properties: BTreeMap::new(),
        }
    }

    fn push(&mut self, name: String, mut channels: Vec<ChannelInfo>, plan: Vec<Origin>) {
        let time_axis = channels
            .iter()
            .position(attribute::is_time_axis)
            .or_else(|| channels.iter().position(|c| c.stored == StoredType::Time));
        if let Some(axis) = time_axis
            && let Some(start) = self.columns.first_time(plan[axis].column, &plan[axis].rows)
        {
            channels
                .iter_mut()
                .for_each(|c| c.start_time = Some(start.clone()));
        }
        let mut attributes = self.columns.attributes().clone();
        attributes.remove(RECORDS_KEY);
        attributes.extend(self.own.get(&name).cloned().unwrap_or_default());
        let (rate, start) = (
            attribute::sample_rate_hz(&attributes),
            attribute::start_time(&attributes),
        );
        for channel in &mut channels {
            channel.sample_rate_hz = channel.sample_rate_hz.or(rate);
            channel.start_time = channel.start_time.take().or_else(|| start.clone());
        }
        self.datasets.push(DatasetInfo {
            name,
            channels,
            time_axis,
            attributes,
        });
        self.plans.push(plan);
    }

    /// Rates that the file does not state, from the ends of the time axes.
    fn measure_rates(&mut self) -> Result<(), ReadError> {
        for d in 0..self.datasets.len() {
            let info = &self.datasets[d];
            let Some(axis) = info.time_axis.filter(|_| info.sample_rate_hz().is_none()) else {
                continue;
            };
            let origin = &self.plans[d][axis];
            let Samples::Real(values) = self.columns.read(origin.column, &origin.rows)? else {
                continue;
            };
            let unit = info.channels[axis].unit.as_deref().and_then(parse_unit);
            let head = &values[..values.len().min(rate::HEAD_SAMPLES)];
            let rate = rate::from_axis(head, values.last().copied(), values.len() as u64)
                .map(|r| r / unit.map_or(1.0, |u| u.to_si));
            self.datasets[d]
                .channels
                .iter_mut()
                .for_each(|c| c.sample_rate_hz = rate);
        }
        Ok(())
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
