//! Columns of a Parquet file as samples, through polars.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use polars::prelude::{ArrowField, PlSmallStr, PolarsResult, Series, polars_bail};
use polars_io::SerReader;
use polars_io::parquet::read::{_internal::to_deserializer, FileMetadata, ParquetReader};
use polars_parquet::parquet::page::CompressedPage;
use polars_parquet::read::PageReader;

use crate::bytes::{read_exact_at, to_usize};
use crate::formats::parquet::field::{Field, plain, samples};
use crate::formats::parquet::{footer, guard};
use crate::source::{ReadError, Samples, StoredType};
use crate::text::clock::Stamp;

/// The first and the last four bytes of a Parquet file.
pub(crate) const SIGNATURE: [u8; 4] = *b"PAR1";
/// First row and number of rows.
pub(crate) type Range = (u64, u64);
/// A column that is asked for in parts is kept whole up to this size.
const KEPT_BYTES: u64 = 1 << 28;
/// More rows than this for each byte of the file are no data.
const MOST_ROWS_PER_BYTE: u64 = 64;

/// More unpacked bytes than this for each byte of the file are no data.
const MOST_BYTES_PER_BYTE: u64 = 512;

/// A file's columns.
pub(crate) struct Columns {
    path: PathBuf,
    file: File,
    length: u64,
    metadata: Arc<FileMetadata>,
    pub(crate) fields: Vec<Field>,
    pub(crate) rows: u64,
    pub(crate) attributes: BTreeMap<String, String>,
    kept: Vec<OnceLock<Arc<Samples>>>,
}

impl Columns {
    /// Read a file's footer.
    ///
    /// # Errors
    /// If it is damaged or states more rows than the file can hold.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let file = File::open(path).map_err(|e| ReadError::io(path, &e))?;
        let length = file.metadata().map_err(|e| ReadError::io(path, &e))?.len();
        let handle = file.try_clone().map_err(|e| ReadError::io(path, &e))?;
        check_footer(path, &file, length)?;
        let (fields, metadata) = guarded(path, || {
            let mut reader = ParquetReader::new(handle);
            let schema = reader.schema()?;
            let fields = schema
                .iter_values()
                .map(|f| Field::new(f.name.to_string(), &f.dtype));
            Ok((
                fields.collect::<Vec<_>>(),
                Arc::clone(reader.get_metadata()?),
            ))
        })?;
        let rows: u64 = metadata
            .row_groups
            .iter()
            .map(|g| g.num_rows() as u64)
            .sum();
        let pairs = metadata.key_value_metadata().iter().flatten();
        let attributes = pairs
            .filter(|p| p.key != "ARROW:schema")
            .filter_map(|p| Some((p.key.clone(), p.value.clone()?)))
            .collect();
        if rows > length.saturating_mul(MOST_ROWS_PER_BYTE) {
            let expected = format!(
                "at most {} rows in {length} bytes",
                length.saturating_mul(MOST_ROWS_PER_BYTE)
            );
            return Err(ReadError::new(
                path,
                expected,
                format!("{rows} rows"),
                "copy the file again",
            ));
        }
        let kept = fields.iter().map(|_| OnceLock::new()).collect();
        Ok(Self {
            path: path.to_path_buf(),
            file,
            length,
            metadata,
            fields,
            rows,
            attributes,
            kept,
        })
    }

    /// The first point in time of a column as ISO 8601, if it holds dates.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "whole days; beyond 64 bits they saturate"
    )]
    pub(crate) fn first_time(&self, column: usize, rows: &[Range]) -> Option<String> {
        let field = &self.fields[column];
        let row = rows.first()?.0;
        if field.stored != Some(StoredType::Time) {
            return None;
        }
        let mut first = 0;
        let number = self.metadata.row_groups.iter().position(|g| {
            let here = (first..first + g.num_rows() as u64).contains(&row);
            first += if here { 0 } else { g.num_rows() as u64 };
            here
        })?;
        let values = self.group(field, number).ok()?.into_real()?;
        let seconds = values.get(to_usize(row - first))? / field.ticks_per_second;
        let days = (seconds / 86_400.0).floor();
        Some(
            Stamp {
                days: Some(days as i64),
                seconds: seconds - days * 86_400.0,
                ..Stamp::default()
            }
            .iso(),
        )
    }

    /// A note for each column that is not read.
    pub(crate) fn left_out(&self) -> Vec<String> {
        let unread = self.fields.iter().filter(|f| f.stored.is_none());
        unread
            .map(|f| format!("column '{}' left out: its type is not read", f.name))
            .collect()
    }

    /// The samples of a column in some ranges of rows.
    ///
    /// # Errors
    /// If the file's pages are damaged.
    pub(crate) fn read(&self, column: usize, ranges: &[Range]) -> Result<Samples, ReadError> {
        if ranges == [(0, self.rows)] {
            return self.load(column, (0, self.rows));
        }
        if self.rows * 8 > KEPT_BYTES
            && let [range] = ranges
        {
            return self.load(column, *range);
        }
        let whole = match self.kept[column].get() {
            Some(whole) => Arc::clone(whole),
            None => {
                let loaded = Arc::new(self.load(column, (0, self.rows))?);
                Arc::clone(self.kept[column].get_or_init(|| loaded))
            }
        };
        Ok(pick(&whole, ranges))
    }

    /// The texts of a column; numbers are written out.
    pub(crate) fn texts(&self, column: usize) -> Result<Vec<String>, ReadError> {
        Ok(match self.load(column, (0, self.rows))? {
            Samples::Text(texts) => texts,
            Samples::Real(values) => values.iter().map(f64::to_string).collect(),
            Samples::Complex(_) => Vec::new(),
        })
    }

    /// Decode the row groups that a range of rows touches, one after the other.
    fn load(&self, column: usize, range: Range) -> Result<Samples, ReadError> {
        let field = &self.fields[column];
        let mut parts = Vec::new();
        let mut first = 0;
        for number in 0..self.metadata.row_groups.len() {
            let rows = self.metadata.row_groups[number].num_rows() as u64;
            if first < range.0 + range.1 && first + rows > range.0 {
                let group = self
                    .group(field, number)
                    .map_err(|e| e.channel(&field.name))?;
                let from = range.0.saturating_sub(first);
                let to = (range.0 + range.1 - first).min(rows);
                parts.push(pick(&group, &[(from, to - from)]));
            }
            first += rows;
        }
        Ok(joined(parts, field))
    }

    /// One column of one row group.
    fn group(&self, field: &Field, number: usize) -> Result<Samples, ReadError> {
        let group = &self.metadata.row_groups[number];
        let damaged = |found: String| damaged(&self.path, found);
        let chunks: Vec<_> = group
            .columns_under_root_iter(&field.name)
            .into_iter()
            .flatten()
            .collect();
        let mut pages = Vec::new();
        for chunk in chunks {
            // Offsets and sizes are signed in the footer; a damaged one may be negative.
            let first = chunk
                .dictionary_page_offset()
                .unwrap_or(chunk.data_page_offset());
            let (first, size) = (u64::try_from(first), u64::try_from(chunk.compressed_size()));
            let (Ok(first), Ok(size)) = (first, size) else {
                return Err(damaged("pages at negative offsets".to_owned()));
            };
            if first.checked_add(size).is_none_or(|end| end > self.length) {
                return Err(damaged(format!("{size} bytes of pages from byte {first}")).at(first));
            }
            let values = u64::try_from(chunk.num_values()).unwrap_or(u64::MAX);
            let unpacked = u64::try_from(chunk.uncompressed_size()).unwrap_or(u64::MAX);
            if values > group.num_rows() as u64 || unpacked > MOST_BYTES_PER_BYTE * self.length {
                return Err(damaged(format!("{values} values in {unpacked} bytes")).at(first));
            }
            let mut bytes = vec![0; to_usize(size)];
            read_exact_at(&self.file, &mut bytes, first)
                .map_err(|e| ReadError::io(&self.path, &e))?;
            if footer::first_claim(&bytes).is_some_and(|n| n > MOST_BYTES_PER_BYTE * self.length) {
                return Err(damaged("a first page far larger than the file".to_owned()).at(first));
            }
            pages.push((chunk, bytes.into()));
        }
        let samples = guarded(&self.path, || {
            let name = PlSmallStr::from_str(&field.name);
            let arrow = ArrowField::new(name.clone(), field.physical.clone(), true);
            for (chunk, bytes) in &pages {
                let limit = to_usize(self.length);
                let bytes = Cursor::new(Clone::clone(bytes));
                self.check_pages(
                    PageReader::new(bytes, chunk, Vec::new(), limit),
                    group.num_rows(),
                )?;
            }
            let (arrays, _) = to_deserializer(pages, arrow, None)?;
            let arrays: Vec<_> = arrays.into_iter().map(plain).collect();
            samples(&Series::try_from((name, arrays))?)
        })?;
        if samples.len() == group.num_rows() {
            Ok(samples)
        } else {
            Err(damaged(format!(
                "{} rows where the footer states {}",
                samples.len(),
                group.num_rows()
            )))
        }
    }

    /// Refuse pages that claim to unpack to far more than the file, or to hold more values than
    /// the row group has rows, before they are unpacked.
    fn check_pages(&self, pages: PageReader, rows: usize) -> PolarsResult<()> {
        let (mut unpacked, mut values) = (0u64, 0u64);
        for page in pages {
            if let CompressedPage::Data(page) = page? {
                unpacked = unpacked.saturating_add(page.uncompressed_size() as u64);
                values = values.saturating_add(page.num_values() as u64);
            }
        }
        if unpacked > MOST_BYTES_PER_BYTE * self.length || values > rows as u64 {
            polars_bail!(ComputeError: "pages that claim {unpacked} bytes and {values} values");
        }
        Ok(())
    }
}

/// Parts of a column as one; points in time become seconds since the first.
fn joined(parts: Vec<Samples>, field: &Field) -> Samples {
    let mut parts = parts.into_iter();
    let mut all = parts.next().unwrap_or(Samples::Real(Vec::new()));
    for part in parts {
        match (&mut all, part) {
            (Samples::Real(all), Samples::Real(part)) => all.extend(part),
            (Samples::Text(all), Samples::Text(part)) => all.extend(part),
            _ => {}
        }
    }
    if let (Samples::Real(values), Some(StoredType::Time)) = (&mut all, field.stored) {
        let origin = values.iter().copied().find(|v| !v.is_nan()).unwrap_or(0.0);
        values
            .iter_mut()
            .for_each(|v| *v = (*v - origin) / field.ticks_per_second);
    }
    all
}

/// Refuse a footer whose lengths exceed it.
fn check_footer(path: &Path, file: &File, length: u64) -> Result<(), ReadError> {
    let damaged = |found: String, at: u64| damaged(path, found).at(at);
    let mut tail = [0u8; 8];
    let end = length
        .checked_sub(12)
        .ok_or_else(|| damaged(format!("{length} bytes"), 0))?
        + 4;
    read_exact_at(file, &mut tail, end).map_err(|e| ReadError::io(path, &e))?;
    if tail[4..] != SIGNATURE {
        return Err(damaged("no PAR1 at the end".to_owned(), end + 4));
    }
    let size = u64::from(u32::from_le_bytes([tail[0], tail[1], tail[2], tail[3]]));
    let start = end.checked_sub(size).filter(|s| *s >= 4);
    let start = start.ok_or_else(|| damaged(format!("a footer of {size} bytes"), end))?;
    let mut bytes = vec![0; to_usize(size)];
    read_exact_at(file, &mut bytes, start).map_err(|e| ReadError::io(path, &e))?;
    footer::check(&bytes).map_err(|fault| damaged(fault.to_string(), start))
}

fn damaged(path: &Path, found: String) -> ReadError {
    let remedy = "copy the file again, or write it again with the program that made it";
    ReadError::new(path, "a complete Parquet file", found, remedy)
}

/// Run the library; its errors, and its panics on damaged files, become a [`ReadError`].
fn guarded<T>(path: &Path, run: impl FnOnce() -> PolarsResult<T>) -> Result<T, ReadError> {
    match guard::caught(run) {
        Some(result) => result.map_err(|e| damaged(path, e.to_string())),
        None => Err(damaged(path, "pages that contradict each other".to_owned())),
    }
}

fn pick(whole: &Samples, ranges: &[Range]) -> Samples {
    fn parts<T: Clone>(all: &[T], ranges: &[Range]) -> Vec<T> {
        ranges
            .iter()
            .flat_map(|&(from, count)| &all[to_usize(from)..to_usize(from + count)])
            .cloned()
            .collect()
    }
    match whole {
        Samples::Real(all) => Samples::Real(parts(all, ranges)),
        Samples::Complex(all) => Samples::Complex(parts(all, ranges)),
        Samples::Text(all) => Samples::Text(parts(all, ranges)),
    }
}
