//! `LabVIEW` measurement files (LVM): a header, then one or more tables with headers of their own.

mod header;
pub(crate) mod scan;

use std::collections::BTreeMap;
use std::path::Path;

use crate::bytes::to_usize;
use crate::formats::lvm::header::Column;
use crate::formats::lvm::scan::{Keys, Scan, Segment};
use crate::rate;
use crate::source::{
    ChannelInfo, Clock, DatasetInfo, ReadError, Reader, Samples, Source, StoredType, opened,
};
use crate::text::TextFile;
use crate::text::cells::{Cells, Lines, Separator};
use crate::text::number::{self, Notation};
use crate::text::table::{self, Kind, Layout};

/// Bytes of a table's head from which its rate is found.
const HEAD_BYTES: usize = 1 << 15;

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

/// A `LabVIEW` measurement file begins with words of its own.
pub(crate) fn recognises(front: &[u8]) -> bool {
    let text = front.strip_prefix(&[0xEF, 0xBB, 0xBF]).unwrap_or(front);
    text.starts_with(scan::FIRST_WORDS.as_bytes())
}

/// Open a `LabVIEW` measurement file.
///
/// # Errors
/// If the file cannot be read, a header does not end, or there are no rows.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let text = TextFile::open(path)?;
    let scan = scan::scan(&text)?;
    let (mut datasets, mut tables) = (Vec::new(), Vec::new());
    for (i, segment) in scan.segments.iter().enumerate() {
        let name = match scan.segments.len() {
            1 => String::new(),
            _ => format!("segment_{}", i + 1),
        };
        let (dataset, table) = read_segment(&text, &scan, segment, name)?;
        datasets.push(dataset);
        tables.push(table);
    }
    opened(
        "lvm",
        path,
        datasets,
        scan.notes,
        LvmReader { text, tables },
    )
}

fn read_segment(
    text: &TextFile,
    scan: &Scan,
    segment: &Segment,
    name: String,
) -> Result<(DatasetInfo, Table), ReadError> {
    let (keys, separator) = (&scan.keys, scan.separator);
    let bytes = segment.end - segment.start;
    let head = text.range(segment.start, HEAD_BYTES.min(to_usize(bytes)))?;
    let columns = columns(keys, segment, &head, separator);
    table::refuse_ragged(text, segment.rows, columns.len(), bytes)
        .map_err(|e| e.at(segment.start))?;
    let layout = layout(keys, separator, segment, &columns, &head);
    let remarks = has_remarks(&layout, &columns, &head);
    let x_columns = keys.get("X_Columns").and_then(|v| v.first());
    let shown: Vec<(usize, Column)> = columns
        .into_iter()
        .enumerate()
        .filter(|(_, column)| match column {
            Column::X(_) => x_columns.is_none_or(|v| v != "No"),
            Column::Y(_) => true,
            Column::Comment => remarks,
        })
        .collect();
    let rates = rates(text, segment, &layout, &shown, &head)?;
    let is_time = |(_, c): &(usize, Column)| *c == Column::X(0) && header::x_is_time(segment, 0);
    let starts = header::starts_s(keys, segment, &shown);
    let dataset = DatasetInfo {
        name,
        time_axis: shown.iter().position(is_time),
        channels: shown
            .iter()
            .zip(rates.into_iter().zip(starts))
            .map(|(&(i, column), (rate, start_s))| ChannelInfo {
                sample_rate_hz: rate,
                start_s,
                clock: clock(segment, &shown, column),
                ..channel(keys, segment, &layout, column, i)
            })
            .collect(),
        attributes: header::attributes(keys, segment),
    };
    let table = Table {
        layout,
        columns: shown.into_iter().map(|(i, _)| i).collect(),
        rows: to_usize(segment.rows),
    };
    Ok((dataset, table))
}

/// The rate of each channel: of the X column before it, else of the step that the header states.
fn rates(
    text: &TextFile,
    segment: &Segment,
    layout: &Layout,
    shown: &[(usize, Column)],
    head: &[u8],
) -> Result<Vec<Option<f64>>, ReadError> {
    let tail = text.range(segment.last, HEAD_BYTES)?;
    let end = Lines::new(&tail, false).next();
    let end: Vec<&[u8]> = end.map_or_else(Vec::new, |(_, line)| {
        Cells::new(line, layout.separator).collect()
    });
    let mut measured = BTreeMap::new();
    for &(i, column) in shown {
        if let Column::X(first) = column {
            let values = x_values(layout, head, i);
            let last = end.get(i);
            let last = last.and_then(|c| number::parse_cell(c, layout.notation.decimal));
            measured.insert(first, rate::from_axis(&values, last, segment.rows, 1.0));
        }
    }
    let rate = |&(_, column): &(usize, Column)| {
        let (Column::X(n) | Column::Y(n)) = column else {
            return None;
        };
        let own = measured.range(..=n).next_back().and_then(|(_, r)| *r);
        let step =
            header::value_for(&segment.keys, "Delta_X", n).and_then(|s| header::decimal_any(&s));
        let own = own.filter(|_| measured.contains_key(&n) || !header::has_own_step(segment, n));
        own.or(step.map(|s| 1.0 / s))
            .filter(|r| r.is_finite() && *r > 0.0 && header::x_is_time(segment, n))
    };
    Ok(shown.iter().map(rate).collect())
}

/// Where a channel's times are: in the X column before it, which may be its own, or in a step of its own.
fn clock(segment: &Segment, shown: &[(usize, Column)], column: Column) -> Clock {
    let Column::Y(n) = column else {
        return Clock::Shared;
    };
    let own = shown.iter().position(|(_, c)| *c == Column::X(n));
    match own.filter(|_| n > 0) {
        Some(axis) => Clock::Axis(axis),
        None if header::has_own_step(segment, n) => Clock::Rate,
        None => Clock::Shared,
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
        notation: Notation::plain(header::decimal(keys, separator, head)),
        kinds: kinds.collect(),
        names: names.collect(),
        start: segment.start,
        end: segment.end,
        quotes: false,
        month_first: false,
        fraction: None,
        comments: b"",
        headings: Vec::new(),
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
        .filter_map(|c| number::parse_cell(c, layout.notation.decimal))
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
        clock: Clock::Shared,
        start_s: None,
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
