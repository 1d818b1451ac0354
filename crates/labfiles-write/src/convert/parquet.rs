//! Records to one Parquet file: one row group per record.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use polars::prelude::{Column, DataFrame, DataType, Schema};
use polars_io::parquet::write::{KeyValueMetadata, ParquetCompression, ParquetWriter};

use crate::convert::item::{ConvertError, Item, Options, heading, io};
use crate::hdf5::WriteError;
use crate::output::write_whole_or;
use crate::to_f32;
use labfiles::conventions::{COLUMNS_KEY, RECORDS_KEY};
use labfiles::{Samples, StoredType};

/// Write all records; with several there is a column `record`, and channels that a record lacks
/// are empty.
pub(super) fn write(items: &[Item<'_>], out: &Path, options: &Options) -> Result<(), ConvertError> {
    let library = |e: polars::error::PolarsError| WriteError::Library {
        path: out.to_path_buf(),
        reason: e.to_string(),
    };
    let columns = columns(items);
    let several = items.len() > 1;
    let single = options.single_precision;
    let schema: Schema = several
        .then(|| ("record".into(), DataType::String))
        .into_iter()
        .chain(
            columns
                .iter()
                .map(|(name, text)| (name.as_str().into(), kind(*text, single))),
        )
        .collect();
    let fill = |file: &mut BufWriter<File>| {
        let mut writer = ParquetWriter::new(file)
            .with_compression(ParquetCompression::Snappy)
            .with_key_value_metadata(Some(KeyValueMetadata::from_static(footer(items))))
            .batched(&schema)
            .map_err(library)?;
        for item in items {
            let frame = frame(item, &columns, several, single)?.map_err(library)?;
            if frame.height() > 0 {
                writer.write_batch(&frame).map_err(library)?;
            }
        }
        writer.finish().map_err(library)?;
        Ok(())
    };
    write_whole_or(out, fill, |e| io(out)(e).into())
}

fn kind(text: bool, single: bool) -> DataType {
    match (text, single) {
        (true, _) => DataType::String,
        (false, true) => DataType::Float32,
        (false, false) => DataType::Float64,
    }
}

/// All columns in the order in which they come first, and whether they hold texts.
fn columns(items: &[Item<'_>]) -> Vec<(String, bool)> {
    let mut seen = BTreeSet::new();
    let mut all = Vec::new();
    let named = items
        .iter()
        .flat_map(|i| i.names().into_iter().zip(i.channels()));
    for (name, channel) in named {
        let parts: &[&str] = match channel.stored {
            StoredType::Complex(_) => &[".re", ".im"],
            _ => &[""],
        };
        for part in parts {
            let name = heading(&format!("{name}{part}"), channel.unit.as_deref());
            if seen.insert(name.clone()) {
                all.push((name, channel.stored == StoredType::Text));
            }
        }
    }
    all
}

/// Rates, starts and attributes: of the one record plainly, of several as JSON by name.
fn footer(items: &[Item<'_>]) -> Vec<(String, String)> {
    let of = |item: &Item<'_>| item.stated().collect::<BTreeMap<_, _>>();
    if let [item] = items {
        return of(item).into_iter().collect();
    }
    let stated: BTreeMap<&str, _> = items.iter().map(|i| (i.name.as_str(), of(i))).collect();
    let held = items.iter().map(|i| {
        let columns = columns(std::slice::from_ref(i)).into_iter();
        (
            i.name.as_str(),
            columns.map(|(name, _)| name).collect::<Vec<_>>(),
        )
    });
    let held: BTreeMap<&str, _> = held.collect();
    let texts = [
        (RECORDS_KEY, serde_json::to_string(&stated)),
        (COLUMNS_KEY, serde_json::to_string(&held)),
    ];
    let written = texts.into_iter();
    written
        .filter_map(|(key, json)| Some((key.to_owned(), json.ok()?)))
        .collect()
}

type Framed = polars::error::PolarsResult<DataFrame>;

/// One record as a table with all columns of the file.
fn frame(
    item: &Item<'_>,
    columns: &[(String, bool)],
    several: bool,
    single: bool,
) -> Result<Framed, ConvertError> {
    let own = item.columns()?.into_iter();
    let mut own: BTreeMap<String, Samples> = own.map(|c| (c.heading(), c.samples)).collect();
    let rows = own.values().map(Samples::len).max().unwrap_or(0);
    let mut all: Vec<Column> = Vec::new();
    if several {
        all.push(Column::new("record".into(), vec![item.name.as_str(); rows]));
    }
    for (name, text) in columns {
        all.push(column(name, own.remove(name), *text, rows, single));
    }
    Ok(DataFrame::new(rows, all))
}

/// A column of the given length; what is missing at its end, or altogether, is null.
fn column(name: &str, samples: Option<Samples>, text: bool, rows: usize, single: bool) -> Column {
    match samples {
        Some(Samples::Text(values)) if text => Column::new(name.into(), padded(values, rows)),
        Some(Samples::Real(values)) if !text && single => {
            let values = values.into_iter().map(to_f32).collect();
            Column::new(name.into(), padded(values, rows))
        }
        Some(Samples::Real(values)) if !text => Column::new(name.into(), padded(values, rows)),
        _ => Column::full_null(name.into(), rows, &kind(text, single)),
    }
}

/// Values, followed by none up to a number of rows.
fn padded<T>(values: Vec<T>, rows: usize) -> Vec<Option<T>> {
    let mut all: Vec<Option<T>> = values.into_iter().map(Some).collect();
    all.resize_with(rows, || None);
    all
}
