//! Text tables: comma-, tab-, semicolon- or blank-separated, with or without a header.
//!
//! Opening reads the first and the last lines and counts the rows; reading goes through the
//! file block by block and keeps only the columns that are asked for.

mod clock_columns;
mod columns;
mod commas;
mod dialect;
mod front;
pub(crate) mod header;
pub(crate) mod parts;
mod rewritten;
mod summary;
mod time_axis;
mod turned;

use std::path::Path;

use crate::bytes::to_usize;
use crate::formats::csv::front::Front;
use crate::formats::csv::header::Header;
use crate::formats::csv::parts::{Block, Makeup, Part};
use crate::formats::csv::time_axis::TimeAxis;
use crate::rate;
use crate::source::{
    ChannelInfo, Clock, DatasetInfo, ReadError, Reader, Samples, Source, StoredType, opened,
};
use crate::text::TextFile;
use crate::text::cells::{Cells, Lines};
use crate::text::table::{self, Kind, Layout};
use crate::timing::{self, AxisUnit};

/// Bytes at the front of a file from which its dialect is found.
const HEAD_BYTES: usize = 1 << 16;

pub(crate) struct CsvReader {
    text: TextFile,
    layout: Layout,
    /// Of each dataset the columns, and the number of rows.
    parts: Vec<(Vec<usize>, usize)>,
}

/// A table of text that was opened: one dataset, or one for each run beside others.
pub(crate) struct OpenedTable {
    pub(crate) datasets: Vec<DatasetInfo>,
    pub(crate) notes: Vec<String>,
    pub(crate) reader: CsvReader,
}

/// Whether bytes are text: no control characters but blanks and line ends, or a UTF-16 mark.
pub(crate) fn recognises(front: &[u8]) -> bool {
    let utf16 = front.starts_with(&[0xFF, 0xFE]) || front.starts_with(&[0xFE, 0xFF]);
    utf16
        || !front
            .iter()
            .any(|&b| b < b' ' && !matches!(b, b'\t' | b'\n' | b'\r' | 0x0C))
}

/// Open a text table.
///
/// # Errors
/// If the file cannot be read, is empty, or no separator makes a table of numbers of it.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Source>, ReadError> {
    let table = open_text(rewritten::plain(TextFile::open(path)?)?, "")?;
    opened("csv", path, table.datasets, table.notes, table.reader)
}

/// Open the table in a text, as datasets under a name.
///
/// # Errors
/// As [`open`].
pub(crate) fn open_text(text: TextFile, name: &str) -> Result<OpenedTable, ReadError> {
    let mut head = text.head(HEAD_BYTES)?;
    let quotes = memchr::memchr(b'"', &head).is_some();
    let mut notes = Vec::new();
    let end = summary::begins(&text)?;
    if let Some(found) = &end {
        head.truncate(to_usize(found.at.saturating_sub(text.start())));
        notes.push(found.note());
    }
    let front = Front::read(&text, &head, quotes)?;
    let rows = front.rows(&head, quotes);
    let mut layout = front.layout(&text, &rows, quotes);
    layout.end = end.map_or(layout.end, |found| found.at);
    refuse_ambiguous(&text, &layout, &rows, &front.header)?;
    let counted = table::count_rows(&text, &layout)?;
    let count = counted.rows;
    table::refuse_ragged(&text, count, layout.kinds.len(), text.length())?;
    notes.extend(headings_again(counted.headings));
    let last_row = last_row(&text, &layout, counted.last, &mut notes)?;
    layout.names.clone_from(&front.header.names);
    let own = front.is_own();
    if !own {
        layout.fraction = time_axis::fraction(&front.header, &layout, &rows, last_row.as_deref());
    }
    let mut header = front.header;
    let times = time_axis::candidates(&header, &layout, &rows);
    let (mut datasets, mut parts) = (Vec::new(), Vec::new());
    let makeup = if own {
        Makeup::One
    } else {
        parts::find(&header, &layout, &rows, &times)
    };
    match makeup {
        Makeup::Runs(runs) => {
            for run in runs {
                let (dataset, rows) = run_of(&text, &layout, &header, &run, to_usize(count))?;
                notes.extend(dataset.1);
                datasets.push(dataset.0);
                parts.push((run.columns, rows));
            }
        }
        makeup => {
            let from = usize::from(header.empty_first);
            let mut columns: Vec<usize> = (from..layout.kinds.len()).collect();
            if let Makeup::BesideRemarks(blocks) = &makeup {
                blocks.iter().for_each(|b| name_beside(&mut header, b));
                columns = blocks.iter().flat_map(Block::kept).copied().collect();
            }
            let axis = time_axis::find(&header, &layout, &rows, last_row.as_deref(), count);
            notes.extend(axis.iter().flat_map(|a| a.note.clone()));
            let mut dataset = dataset(header, &layout, count, axis.as_ref());
            if !own && !matches!(makeup, Makeup::BesideRemarks(_)) {
                give_axes(&mut dataset, &makeup, &times);
                notes.extend(time_axis::unused(&dataset, &layout, &rows, &times));
            }
            keep_columns(&mut dataset, &columns);
            if let Makeup::BesideRemarks(blocks) = &makeup {
                give_own_times(&mut dataset, &columns, blocks);
            }
            datasets.push(dataset);
            parts.push((columns, to_usize(count)));
        }
    }
    for dataset in &mut datasets {
        let own = dataset.name.as_str();
        dataset.name = match (name, own) {
            ("", own) => own.to_owned(),
            (name, "") => name.to_owned(),
            (name, own) => format!("{name}/{own}"),
        };
    }
    Ok(OpenedTable {
        datasets,
        notes,
        reader: CsvReader {
            text,
            layout,
            parts,
        },
    })
}

/// A note on lines among the rows that head the table once more.
fn headings_again(lines: u64) -> Option<String> {
    let again = "the table's heading again, and left out: its rows are read as those of one table";
    match lines {
        0 => None,
        1 => Some(format!("a line among the rows is {again}")),
        lines => Some(format!("{lines} lines among the rows are {again}")),
    }
}

/// Refuse a table in which a mark may be that of decimals or of thousands.
fn refuse_ambiguous(
    text: &TextFile,
    layout: &Layout,
    rows: &columns::HeadRows<'_>,
    header: &Header,
) -> Result<(), ReadError> {
    let decimal = layout.notation.decimal;
    let Some((column, cell)) = columns::ambiguous(rows, &layout.kinds, decimal) else {
        return Ok(());
    };
    let mark = char::from(decimal);
    let cell = crate::text::decode(cell);
    Err(ReadError::new(
        text.path(),
        "numbers with a decimal mark, or with their thousands separated",
        format!("'{cell}' beside whole numbers of hundreds, where '{mark}' may be either"),
        "export the table without separators of thousands",
    )
    .channel(header.names[column].clone()))
}

/// A run beside others as a dataset with its notes, and the number of its rows.
type Run = ((DatasetInfo, Vec<String>), usize);

/// A run beside others: its rows end with its last time, or where a shared time goes on with its last number.
fn run_of(
    text: &TextFile,
    layout: &Layout,
    header: &Header,
    run: &Part,
    count: usize,
) -> Result<Run, ReadError> {
    let ends = [
        run.columns[0],
        run.columns.get(1).copied().unwrap_or(run.columns[0]),
    ];
    let read = table::read_columns(text, layout, &ends, count)?;
    let mut read = read.into_iter().filter_map(Samples::into_real);
    let (times, values) = (
        read.next().unwrap_or_default(),
        read.next().unwrap_or_default(),
    );
    let end = |values: &[f64]| {
        values
            .iter()
            .rposition(|v| v.is_finite())
            .map_or(0, |i| i + 1)
    };
    let rows = end(&times).min(end(&values).max(1));
    let unit = header.units[run.columns[0]].as_deref();
    let head = &times[..rows.min(rate::HEAD_SAMPLES)];
    let known = AxisUnit::of(unit, &run.names[0], head);
    let last = times[..rows].last().copied();
    let rate = known
        .seconds()
        .and_then(|s| rate::from_axis(head, last, rows as u64, s));
    let axis = TimeAxis {
        column: 0,
        rate_hz: rate,
        ..TimeAxis::default()
    };
    let own = Header {
        names: run.names.clone(),
        units: run
            .columns
            .iter()
            .map(|&c| header.units[c].clone())
            .collect(),
        attributes: header.attributes.clone(),
        empty_first: false,
    };
    let kinds = run.columns.iter().map(|&c| layout.kinds[c]).collect();
    let part = Layout {
        kinds,
        ..layout.clone()
    };
    let info = DatasetInfo {
        name: run.name.clone(),
        ..dataset(own, &part, rows as u64, Some(&axis))
    };
    // a list alone is no axis of others
    let note = known.note(&run.names[0]).filter(|_| run.columns.len() > 1);
    Ok(((info, note.into_iter().collect()), rows))
}

/// Name the columns of a table beside its remarks, which become attributes: of several tables those of the first.
fn name_beside(header: &mut Header, block: &Block) {
    let stated = |key: &str| {
        let mut all = block.remarks.iter();
        all.find(|(k, _)| k == key).map(|(_, v)| v.clone())
    };
    for (k, (&column, name)) in block.part.columns.iter().zip(&block.part.names).enumerate() {
        header.names[column].clone_from(name);
        header.units[column] = match k {
            0 => stated("Horizontal Units").or_else(|| Some("s".to_owned())),
            _ => stated("Vertical Units"),
        };
    }
    for (key, value) in &block.remarks {
        let known = header.attributes.entry(key.clone());
        known.or_insert_with(|| value.clone());
    }
}

/// Give the channels of tables beside each other the times of their own tables.
fn give_own_times(dataset: &mut DatasetInfo, columns: &[usize], blocks: &[Block]) {
    let place = |column: usize| columns.iter().position(|c| *c == column);
    for block in blocks.iter().skip(1).filter(|b| b.own_time) {
        let Some((&time, others)) = block.part.columns.split_first() else {
            continue;
        };
        for channel in others.iter().filter_map(|c| place(*c)) {
            let clock = place(time).map_or(Clock::Shared, Clock::Axis);
            dataset.channels[channel].clock = clock;
        }
    }
}

/// Give the channels of a table with several time axes theirs: by their place, or where all axes are before the channels by
/// name, `t_x,t_y,x,y`.
fn give_axes(dataset: &mut DatasetInfo, makeup: &Makeup, times: &[usize]) {
    match makeup {
        Makeup::OwnTimes(own) => {
            for (channel, axis) in dataset.channels.iter_mut().zip(own) {
                channel.clock = axis.map_or(Clock::Shared, Clock::Axis);
            }
        }
        Makeup::One => timing::own_axes(&mut dataset.channels),
        Makeup::Runs(_) | Makeup::BesideRemarks(_) => {}
    }
    let shared = dataset.time_axis;
    for channel in &mut dataset.channels {
        let is_own = |axis| Some(axis) != shared && times.contains(&axis);
        if matches!(channel.clock, Clock::Axis(axis) if !is_own(axis)) {
            channel.clock = Clock::Shared;
        }
    }
}

/// Keep some of a dataset's channels, by their columns.
fn keep_columns(dataset: &mut DatasetInfo, columns: &[usize]) {
    if columns.len() == dataset.channels.len() {
        return;
    }
    let place = |column: usize| columns.iter().position(|c| *c == column);
    dataset.time_axis = dataset.time_axis.and_then(place);
    let kept = columns.iter().map(|&column| {
        let mut channel = dataset.channels[column].clone();
        let number = (column + 1).to_string();
        channel.properties.insert("column".to_owned(), number);
        channel
    });
    dataset.channels = kept.collect();
}

/// The cells of the last row; a last line without all its cells is noted as cut off.
fn last_row(
    text: &TextFile,
    layout: &Layout,
    at: Option<u64>,
    notes: &mut Vec<String>,
) -> Result<Option<Vec<Vec<u8>>>, ReadError> {
    let Some(at) = at else { return Ok(None) };
    let bytes = text.range(at, HEAD_BYTES)?;
    let Some((_, line)) = Lines::new(&bytes, layout.quotes).next() else {
        return Ok(None);
    };
    let cells: Vec<Vec<u8>> = Cells::new(line, layout.separator)
        .map(<[u8]>::to_vec)
        .collect();
    if cells.len() < layout.kinds.len() && !bytes.ends_with(b"\n") {
        notes.push(format!(
            "the last row has {} of {} cells and no line end: the file may be cut off",
            cells.len(),
            layout.kinds.len()
        ));
    }
    Ok(Some(cells))
}

fn dataset(header: Header, layout: &Layout, rows: u64, axis: Option<&TimeAxis>) -> DatasetInfo {
    let decimal = Some(layout.notation.decimal);
    let stated = crate::attribute::sample_rate_beside(&header.attributes, decimal);
    let rate = axis.and_then(|a| a.rate_hz).or(stated);
    let start = axis
        .and_then(|a| a.start.clone())
        .or_else(|| crate::attribute::start_time(&header.attributes));
    let channel = |(i, (name, unit)): (usize, (String, Option<String>))| ChannelInfo {
        name,
        unit: axis
            .filter(|a| a.column == i)
            .and_then(|a| a.unit.clone())
            .or(unit),
        stored: match layout.kinds[i] {
            Kind::Number => StoredType::Float(64),
            Kind::Time => StoredType::Time,
            Kind::Text => StoredType::Text,
        },
        samples: rows,
        sample_rate_hz: rate,
        start_time: start.clone(),
        clock: Clock::Shared,
        start_s: None,
        properties: Default::default(),
    };
    let columns = header.names.into_iter().zip(header.units);
    DatasetInfo {
        name: String::new(),
        channels: columns.enumerate().map(channel).collect(),
        time_axis: axis.map(|a| a.column),
        attributes: header.attributes,
    }
}

impl Reader for CsvReader {
    fn read(&self, dataset: usize, channels: &[usize]) -> Result<Vec<Samples>, ReadError> {
        let (columns, rows) = &self.parts[dataset];
        let wanted: Vec<usize> = channels.iter().map(|&c| columns[c]).collect();
        table::read_columns(&self.text, &self.layout, &wanted, *rows)
    }
}

#[cfg(test)]
mod tests;
