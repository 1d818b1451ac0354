//! Whether a table is wide or long, and which rows are which record and channel.

use std::collections::BTreeMap;

use crate::formats::parquet::columns::{Columns, Range};
use crate::formats::parquet::field::Field;
use crate::source::{ReadError, StoredType};
use crate::timing::is_time_name;

/// Names of columns that name the record, lower case.
const RECORD_NAMES: [&str; 9] = [
    "record",
    "record_id",
    "run",
    "run_id",
    "dataset",
    "file",
    "experiment",
    "test",
    "measurement",
];
/// Names of columns that name the channel, lower case.
const CHANNEL_NAMES: [&str; 4] = ["channel", "variable", "signal", "quantity"];
/// Names of columns that hold the values of a tidy table, lower case.
const VALUE_NAMES: [&str; 4] = ["value", "values", "sample", "y"];

/// Where a channel's samples are: a column and its rows.
pub(crate) struct Origin {
    /// Heading of the channel.
    pub heading: String,
    /// Unit, if a column of units states it.
    pub unit: Option<String>,
    /// The column.
    pub column: usize,
    /// Its rows.
    pub rows: Vec<Range>,
    /// Its own times: the place of another channel of its record.
    pub own_axis: Option<usize>,
}

/// Find the layout of a table.
///
/// # Errors
/// If the columns that name record and channel cannot be read.
pub(crate) fn find(columns: &Columns) -> Result<Vec<(String, Vec<Origin>)>, ReadError> {
    let named = |names: &[&str]| {
        columns
            .fields
            .iter()
            .position(|f| names.contains(&f.name.trim().to_lowercase().as_str()))
    };
    let kind = |i: usize| columns.fields[i].stored;
    let number = |i: usize| kind(i).is_some_and(|s| s != StoredType::Text);
    let key = named(&RECORD_NAMES).filter(|&i| {
        matches!(
            kind(i),
            Some(StoredType::Text | StoredType::Int(_) | StoredType::UInt(_))
        )
    });
    let channel = named(&CHANNEL_NAMES).filter(|&i| kind(i) == Some(StoredType::Text));
    let value = named(&VALUE_NAMES).filter(|&i| number(i));
    match (channel.zip(value), key) {
        (Some((channel, value)), key) => tidy(columns, key, channel, value),
        (None, Some(key)) => {
            let labels = columns.texts(key)?;
            let records = ranges(labels.iter()).into_iter();
            Ok(records
                .map(|(name, rows)| (name.clone(), wide(columns, &rows, Some(key))))
                .collect())
        }
        (None, None) => {
            let all = wide(columns, &[(0, columns.rows)], None);
            Ok(vec![(String::new(), all)])
        }
    }
}

/// A record whose channels are columns.
fn wide(columns: &Columns, rows: &[Range], without: Option<usize>) -> Vec<Origin> {
    let fields = columns.fields.iter().enumerate();
    fields
        .filter(|(i, f)| f.stored.is_some() && Some(*i) != without)
        .map(|(column, field)| Origin {
            heading: field.name.clone(),
            unit: None,
            column,
            rows: rows.to_vec(),
            own_axis: None,
        })
        .collect()
}

/// Records with one row per sample and channel.
fn tidy(
    columns: &Columns,
    key: Option<usize>,
    channel: usize,
    value: usize,
) -> Result<Vec<(String, Vec<Origin>)>, ReadError> {
    let labels = columns.texts(channel)?;
    let records = match key {
        Some(key) => columns.texts(key)?,
        None => vec![String::new(); labels.len()],
    };
    let named = |f: &Field, names: &[&str]| names.contains(&f.name.to_lowercase().as_str());
    let mut fields = columns.fields.iter();
    let time = fields.clone().position(|f| is_time_name(&f.name));
    let unit =
        fields.position(|f| named(f, &["unit", "units"]) && f.stored == Some(StoredType::Text));
    let units = unit
        .map(|u| columns.texts(u))
        .transpose()?
        .unwrap_or_default();
    let units: BTreeMap<&String, String> = labels.iter().zip(units).collect();
    let mut all: Vec<(String, Vec<Origin>)> = Vec::new();
    let mut places: BTreeMap<&String, usize> = BTreeMap::new();
    for ((record, label), rows) in ranges(records.iter().zip(&labels)) {
        let place = *places.entry(record).or_insert_with(|| {
            let axis = time.map(|column| Origin {
                heading: columns.fields[column].name.clone(),
                unit: None,
                column,
                rows: rows.clone(),
                own_axis: None,
            });
            all.push((record.clone(), axis.into_iter().collect()));
            all.len() - 1
        });
        all[place].1.push(Origin {
            heading: label.clone(),
            unit: units.get(label).cloned(),
            column: value,
            rows,
            own_axis: None,
        });
    }
    if let Some(time) = time {
        for (_, plan) in &mut all {
            give_own_times(columns, time, plan)?;
        }
    }
    Ok(all)
}

/// Give channels of a tidy table whose times are not those of the first channel their own time axis: they differ
/// in number, or at the first or last of them.
fn give_own_times(columns: &Columns, time: usize, plan: &mut Vec<Origin>) -> Result<(), ReadError> {
    let ends = |rows: &[Range]| -> Result<(u64, Vec<u64>), ReadError> {
        let count = rows.iter().map(|r| r.1).sum();
        let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
            return Ok((0, Vec::new()));
        };
        let last = (last.0 + last.1.saturating_sub(1), 1);
        let read = columns.read(time, &[(first.0, 1), last])?.into_real();
        Ok((
            count,
            read.unwrap_or_default()
                .into_iter()
                .map(f64::to_bits)
                .collect(),
        ))
    };
    let Some(first) = plan.get(1).map(|first| ends(&first.rows)).transpose()? else {
        return Ok(());
    };
    for channel in 2..plan.len() {
        if ends(&plan[channel].rows)? == first {
            continue;
        }
        let heading = format!("{} of {}", plan[0].heading, plan[channel].heading);
        plan[channel].own_axis = Some(plan.len());
        plan.push(Origin {
            heading,
            unit: plan[0].unit.clone(),
            column: time,
            rows: plan[channel].rows.clone(),
            own_axis: None,
        });
    }
    Ok(())
}

/// Rows of each label, in the order of first appearance.
fn ranges<L: Ord + Copy>(labels: impl Iterator<Item = L>) -> Vec<(L, Vec<Range>)> {
    let mut all: Vec<(L, Vec<Range>)> = Vec::new();
    let mut places: BTreeMap<L, usize> = BTreeMap::new();
    for (row, label) in labels.enumerate() {
        let place = *places.entry(label).or_insert_with(|| {
            all.push((label, Vec::new()));
            all.len() - 1
        });
        extend(&mut all[place].1, row as u64);
    }
    all
}

fn extend(ranges: &mut Vec<Range>, row: u64) {
    match ranges.last_mut() {
        Some((from, count)) if *from + *count == row => *count += 1,
        _ => ranges.push((row, 1)),
    }
}
