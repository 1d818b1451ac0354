//! `LabVIEW` measurement files (LVM): a header, then one or more tables with headers of their own.

mod header;
pub(crate) mod scan;

use std::collections::BTreeMap;
use std::path::Path;

use crate::bytes::to_usize;
use crate::lvm::scan::{Keys, Scan, Segment};
use crate::rate;
use crate::source::{
    ChannelInfo, DatasetInfo, Opened, ReadError, Reader, Samples, Source, StoredType,
};
use crate::text::cells::{Cells, Lines, Separator};
use crate::text::table::{self, Kind, Layout};
use crate::text::{TextFile, number};

/// Bytes of a table's head from which its rate is found.
const HEAD_BYTES: usize = 1 << 15;

/// The tables of a file, as far as they are described.
struct Builder {
    text: TextFile,
    tables: Vec<Table>,
    datasets: Vec<DatasetInfo>,
}

struct LvmReader {
    text: TextFile,
    tables: Vec<Table>,
}

/// A table: how it is written and which of its columns are channels.
struct Table {
    layout: Layout,
    columns: Vec<usize>,
    rows: usize,
}

/// A table as it was recognised: its layout, its columns, those shown, and its first rows.
struct Made<'a> {
    layout: &'a Layout,
    columns: &'a [Column],
    shown: &'a [usize],
    head: &'a [u8],
}

/// What a column of a table holds.
#[derive(Clone, Copy, PartialEq)]
enum Column {
    /// X values for the channels from this number on.
    X(usize),
    /// The channel of this number.
    Y(usize),
    /// Remarks.
    Comment,
}

/// Open a `LabVIEW` measurement file.
///
/// # Errors
/// If the file cannot be read, a header does not end, or there are no rows.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let text = TextFile::open(path)?;
    let Scan {
        keys,
        separator,
        segments,
        notes,
    } = scan::scan(&text)?;
    let many = segments.len() > 1;
    let mut source = Builder {
        text,
        tables: Vec::new(),
        datasets: Vec::new(),
    };
    for (i, segment) in segments.iter().enumerate() {
        let name = if many {
            format!("segment_{}", i + 1)
        } else {
            String::new()
        };
        source.add(name, &keys, separator, segment)?;
    }
    Ok(Box::new(Opened {
        format: "lvm",
        path: path.to_path_buf(),
        datasets: source.datasets,
        notes,
        reader: LvmReader {
            text: source.text,
            tables: source.tables,
        },
    }))
}

impl Builder {
    fn add(
        &mut self,
        name: String,
        keys: &Keys,
        separator: Separator,
        segment: &Segment,
    ) -> Result<(), ReadError> {
        let head = self.text.range(
            segment.start,
            HEAD_BYTES.min(to_usize(segment.end - segment.start)),
        )?;
        let columns = columns(keys, segment, &head, separator);
        self.refuse_ragged(segment, columns.len())?;
        let layout = layout(keys, separator, segment, &columns, &head);
        let remarks = has_remarks(&layout, &columns, &head);
        let shown: Vec<usize> = (0..columns.len())
            .filter(|&i| match columns[i] {
                Column::X(_) => keys
                    .get("X_Columns")
                    .and_then(|v| v.first())
                    .is_none_or(|v| v != "No"),
                Column::Y(_) => true,
                Column::Comment => remarks,
            })
            .collect();
        let mut info = DatasetInfo {
            name,
            time_axis: shown
                .iter()
                .position(|&i| columns[i] == Column::X(0) && header::x_is_time(segment, 0)),
            channels: shown
                .iter()
                .map(|&i| channel(keys, segment, &layout, columns[i], i))
                .collect(),
            attributes: header::attributes(keys, segment),
        };
        let made = Made {
            layout: &layout,
            columns: &columns,
            shown: &shown,
            head: &head,
        };
        self.rates(&mut info, segment, &made)?;
        self.datasets.push(info);
        self.tables.push(Table {
            layout,
            columns: shown,
            rows: to_usize(segment.rows),
        });
        Ok(())
    }

    fn refuse_ragged(&self, segment: &Segment, columns: usize) -> Result<(), ReadError> {
        if segment.rows.saturating_mul(columns as u64) <= 2 * (segment.end - segment.start) + 1024 {
            return Ok(());
        }
        let found = format!("{} rows that are much shorter", segment.rows);
        let remedy = "Split the file where its number of columns changes.";
        Err(ReadError::new(
            self.text.path(),
            format!("rows of {columns} cells"),
            found,
            remedy,
        )
        .at(segment.start))
    }

    /// Rates from the X columns, which are more exact than the printed step; else from the step.
    fn rates(
        &self,
        info: &mut DatasetInfo,
        segment: &Segment,
        made: &Made<'_>,
    ) -> Result<(), ReadError> {
        let Made {
            layout,
            columns,
            shown,
            head,
        } = made;
        let tail = self.text.range(segment.last, HEAD_BYTES)?;
        let end: Vec<&[u8]> = Lines::new(&tail, false)
            .next()
            .map_or(Vec::new(), |(_, l)| {
                Cells::new(l, layout.separator).collect()
            });
        let mut measured = BTreeMap::new();
        for &i in *shown {
            if let Column::X(first) = columns[i] {
                let values = x_values(layout, head, i);
                let last = end
                    .get(i)
                    .and_then(|c| number::parse_cell(c, layout.decimal));
                measured.insert(first, rate::from_axis(&values, last, segment.rows));
            }
        }
        for (channel, &i) in info.channels.iter_mut().zip(shown.iter()) {
            let (Column::X(n) | Column::Y(n)) = columns[i] else {
                continue;
            };
            let own = measured.range(..=n).next_back().and_then(|(_, r)| *r);
            let step = header::value_for(&segment.keys, "Delta_X", n)
                .and_then(|s| header::decimal_any(&s));
            let rate = own
                .or(step.map(|s| 1.0 / s))
                .filter(|r| r.is_finite() && *r > 0.0);
            channel.sample_rate_hz = rate.filter(|_| header::x_is_time(segment, n));
        }
        Ok(())
    }
}

/// The columns that the headings, or else the number of channels, make.
fn columns(keys: &Keys, segment: &Segment, head: &[u8], separator: Separator) -> Vec<Column> {
    let multi = keys
        .get("X_Columns")
        .and_then(|v| v.first())
        .is_some_and(|v| v == "Multi");
    let first_row = Lines::new(head, false).find(|(_, l)| !l.trim_ascii().is_empty());
    let cells = first_row.map_or(0, |(_, l)| Cells::new(l, separator).count());
    let filled = segment
        .headings
        .iter()
        .rposition(|h| !h.is_empty())
        .map_or(0, |i| i + 1);
    let stated = header::stated_channels(segment).map_or(0, |n| if multi { 2 * n } else { n + 1 });
    let comment = filled > 0 && segment.headings[filled - 1] == "Comment";
    let numbers = if filled > 0 {
        filled - usize::from(comment)
    } else {
        stated.max(cells)
    };
    let mut columns: Vec<Column> = (0..numbers)
        .map(|i| match (multi, i) {
            (true, i) if i % 2 == 0 => Column::X(i / 2),
            (true, i) => Column::Y(i / 2),
            (false, 0) => Column::X(0),
            (false, i) => Column::Y(i - 1),
        })
        .collect();
    columns.push(Column::Comment);
    columns
}

fn layout(
    keys: &Keys,
    separator: Separator,
    segment: &Segment,
    columns: &[Column],
    head: &[u8],
) -> Layout {
    let kinds = columns.iter().map(|c| {
        if *c == Column::Comment {
            Kind::Text
        } else {
            Kind::Number
        }
    });
    let names = (0..columns.len()).map(|i| segment.headings.get(i).cloned().unwrap_or_default());
    Layout {
        separator,
        decimal: header::decimal(keys, separator, head),
        kinds: kinds.collect(),
        names: names.collect(),
        start: segment.start,
        end: segment.end,
        quotes: false,
        month_first: false,
        comments: b"",
    }
}

/// Whether a row in the head of the table has a remark.
fn has_remarks(layout: &Layout, columns: &[Column], head: &[u8]) -> bool {
    let Some(at) = columns.iter().position(|c| *c == Column::Comment) else {
        return false;
    };
    Lines::new(head, false).any(|(_, l)| {
        Cells::new(l, layout.separator)
            .nth(at)
            .is_some_and(|c| !c.is_empty())
    })
}

fn x_values(layout: &Layout, head: &[u8], column: usize) -> Vec<f64> {
    Lines::new(head, false)
        .filter_map(|(_, l)| Cells::new(l, layout.separator).nth(column))
        .filter_map(|c| number::parse_cell(c, layout.decimal))
        .filter(|v| v.is_finite())
        .take(rate::HEAD_SAMPLES)
        .collect()
}

fn channel(
    keys: &Keys,
    segment: &Segment,
    layout: &Layout,
    column: Column,
    i: usize,
) -> ChannelInfo {
    let own = |key: &str, n: usize| header::value_for(&segment.keys, key, n);
    let (unit, stored, n) = match column {
        Column::X(n) => (header::x_unit(segment, n), StoredType::Float(64), Some(n)),
        Column::Y(n) => (own("Y_Unit_Label", n), StoredType::Float(64), Some(n)),
        Column::Comment => (None, StoredType::Text, None),
    };
    let name = match (&layout.names[i], column) {
        (name, _) if !name.is_empty() => name.clone(),
        (_, Column::X(_)) => "X_Value".to_owned(),
        (_, Column::Y(n)) => format!("column_{}", n + 1),
        (_, Column::Comment) => "Comment".to_owned(),
    };
    let properties = ["Samples", "X_Dimension", "X0", "Delta_X"]
        .iter()
        .filter_map(|k| Some(((*k).to_owned(), own(k, n?)?)))
        .collect();
    let start = n
        .and_then(|n| header::start_time(&segment.keys, n))
        .or_else(|| header::start_time(keys, 0));
    ChannelInfo {
        name,
        unit,
        stored,
        samples: segment.rows,
        sample_rate_hz: None,
        start_time: start,
        properties,
    }
}

impl Reader for LvmReader {
    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        let table = &self.tables[dataset];
        let wanted: Vec<usize> = channels.iter().map(|&c| table.columns[c]).collect();
        table::read_columns(&self.text, &table.layout, &wanted, table.rows)
    }
}

#[cfg(test)]
mod tests;
