//! Whether a table is wide or long, and which rows are which record and channel.

use std::collections::BTreeMap;

use crate::attribute;
use crate::parquet::columns::{Columns, Range};
use crate::source::{ReadError, StoredType};

/// Labels with the rows that have them.
pub(crate) type Labelled = Vec<(String, Vec<Range>)>;

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

/// How a table is laid out.
pub(crate) enum Shape {
    /// Every column is a channel, the table is one record.
    Wide,
    /// A column names the record, the others are channels.
    ByRecord {
        /// That column.
        key: usize,
        /// The records with their rows.
        records: Labelled,
    },
    /// One column holds all values, others name record, channel and time.
    Tidy {
        /// Which columns they are.
        tidy: Tidy,
        /// The records with their channels and their rows.
        records: Vec<(String, Labelled)>,
    },
}

/// The columns of a tidy table.
pub(crate) struct Tidy {
    /// The column of values.
    pub value: usize,
    /// The time axis.
    pub time: Option<usize>,
    /// Units by channel.
    pub unit: Option<BTreeMap<String, String>>,
}

/// Find the layout of a table.
///
/// # Errors
/// If the columns that name record and channel cannot be read.
pub(crate) fn find(columns: &Columns) -> Result<Shape, ReadError> {
    let named = |names: &[&str]| {
        columns
            .fields()
            .iter()
            .position(|f| names.contains(&f.name.trim().to_lowercase().as_str()))
    };
    let kind = |i: usize| columns.fields()[i].stored;
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
            Ok(Shape::ByRecord {
                key,
                records: ranges(labels.iter().map(String::as_str)),
            })
        }
        (None, None) => Ok(Shape::Wide),
    }
}

fn tidy(
    columns: &Columns,
    key: Option<usize>,
    channel: usize,
    value: usize,
) -> Result<Shape, ReadError> {
    let labels = columns.texts(channel)?;
    let records = match key {
        Some(key) => columns.texts(key)?,
        None => vec![String::new(); labels.len()],
    };
    let mut sorted: Vec<(String, Labelled)> = Vec::new();
    let mut places: BTreeMap<&str, (usize, BTreeMap<&str, usize>)> = BTreeMap::new();
    for (row, (record, label)) in records.iter().zip(&labels).enumerate() {
        let (r, channels) = places.entry(record).or_insert_with(|| {
            sorted.push((record.clone(), Vec::new()));
            (sorted.len() - 1, BTreeMap::new())
        });
        let own = &mut sorted[*r].1;
        let c = *channels.entry(label).or_insert_with(|| {
            own.push((label.clone(), Vec::new()));
            own.len() - 1
        });
        extend(&mut own[c].1, row as u64);
    }
    let time = columns
        .fields()
        .iter()
        .position(|f| attribute::is_time_name(&f.name));
    let unit = columns.fields().iter().position(|f| {
        matches!(f.name.to_lowercase().as_str(), "unit" | "units")
            && f.stored == Some(StoredType::Text)
    });
    let unit = unit.map(|u| columns.texts(u)).transpose()?;
    let unit = unit.map(|units| labels.iter().cloned().zip(units).collect());
    Ok(Shape::Tidy {
        tidy: Tidy { value, time, unit },
        records: sorted,
    })
}

/// The rows of each label, labels in the order in which they come first.
fn ranges<'a>(labels: impl Iterator<Item = &'a str>) -> Labelled {
    let mut all: Labelled = Vec::new();
    let mut places: BTreeMap<&str, usize> = BTreeMap::new();
    for (row, label) in labels.enumerate() {
        let place = *places.entry(label).or_insert_with(|| {
            all.push((label.to_owned(), Vec::new()));
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
