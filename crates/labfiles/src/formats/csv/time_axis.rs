//! Which column of a table is its time axis, and at which rate its rows follow.

use crate::formats::csv::columns::HeadRows;
use crate::formats::csv::header::{Header, without_number};
use crate::rate;
use crate::source::{Clock, DatasetInfo};
use crate::text::table::{Fraction, Kind, Layout, Times};
use crate::text::{clock, decode};
use crate::timing::{
    AxisUnit, StatedUnit, climbs_evenly, is_general, is_time_name, stated_unit, states_unit,
    steps_evenly, ticks_evenly,
};
use crate::units::symbol_of;

/// The time axis of a table.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct TimeAxis {
    /// The column.
    pub column: usize,
    /// Its unit, as its name states it, or s of points in time.
    pub unit: Option<String>,
    /// Rows per second, Hz, if the axis gives them.
    pub rate_hz: Option<f64>,
    /// The first point in time, where the axis holds points in time.
    pub start: Option<String>,
    /// What was assumed.
    pub note: Option<String>,
}

/// Find the time axis: a column of points in time, one whose name or unit is of time, or an
/// unnamed first column that climbs evenly. It must never go back in the rows seen; of several columns of numbers
/// one that is called time and states its unit wins over those that do not.
pub(crate) fn find(
    header: &Header,
    layout: &Layout,
    rows: &HeadRows<'_>,
    last: Option<&[Vec<u8>]>,
    count: u64,
) -> Option<TimeAxis> {
    let (dates, parts) = (dates(layout, rows), layout.fraction);
    let of_clock = |i: &usize| parts.is_none_or(|f| f.clock == *i);
    let columns = (0..layout.kinds.len()).filter(|i| Some(*i) != dates && of_clock(i));
    let candidates = columns.filter_map(|i| candidate(header, layout, i));
    let found = candidates.filter(|c| parts.is_some() || climbs(&head_of(layout, rows, c.column)));
    let found: Vec<TimeAxis> = found.collect();
    let mut numbers = found
        .iter()
        .take_while(|c| layout.kinds[c.column] == Kind::Number);
    let best = numbers.find(|c| states_unit_of_all(header, c.column));
    let best = best.or(found.first()).cloned();
    let mut axis = best.or_else(|| unnamed(header, layout, rows))?;
    let head = head_of(layout, rows, axis.column);
    let end = last.and_then(|cells| end_of(layout, cells, axis.column, rows));
    if layout.kinds[axis.column] == Kind::Time {
        axis.start = start(layout, rows, axis.column, dates).map(clock::Stamp::iso);
        axis.unit = Some("s".to_owned());
    }
    let name = &header.names[axis.column];
    // points in time are given in s, whatever stands below their heading
    let unit = axis.unit.as_ref().or(header.units[axis.column].as_ref());
    let unit = AxisUnit::of(unit.map(String::as_str), name, &head);
    axis.rate_hz = unit
        .seconds()
        .and_then(|s| rate::from_axis(&head, end, count, s));
    axis.note = axis.note.or_else(|| unit.note(name));
    let slow = layout.kinds[axis.column] == Kind::Number;
    axis.note = axis
        .note
        .or_else(|| slow.then(|| unit.slow_note(name, &head))?);
    Some(axis)
}

/// The point in time of the first row; `dates` is the column of the dates of a clock without.
fn start(
    layout: &Layout,
    rows: &HeadRows<'_>,
    column: usize,
    dates: Option<usize>,
) -> Option<clock::Stamp> {
    let first = |column: usize| clock::parse(&decode(rows.first(column)?), layout.month_first);
    let mut start = first(column)?;
    start.days = start.days.or_else(|| first(dates?)?.days);
    if let Some(parts) = layout.fraction.filter(|f| f.clock == column) {
        start.seconds += parts.to_s * layout.notation.parse(rows.first(parts.column)?)?;
    }
    Some(start)
}

/// The stamps of a column of points in time in the rows seen; `None` of any other column.
fn stamps(layout: &Layout, rows: &HeadRows<'_>, column: usize) -> Option<Vec<clock::Stamp>> {
    let is_time = layout.kinds.get(column) == Some(&Kind::Time);
    let cells = rows.column(column).filter_map(|cell| stamp(layout, cell));
    is_time.then(|| cells.collect())
}

/// The column of dates that stands beside one of times of day.
fn dates(layout: &Layout, rows: &HeadRows<'_>) -> Option<usize> {
    let all = |column: usize, is: &dyn Fn(&clock::Stamp) -> bool| {
        let stamps = stamps(layout, rows, column);
        stamps.is_some_and(|s| !s.is_empty() && s.iter().all(is))
    };
    let columns = 0..layout.kinds.len();
    let of_day = |column: usize| all(column, &|s| s.days.is_none());
    let mut dates = columns
        .clone()
        .filter(|&column| all(column, &|s| s.days.is_some() && s.seconds == 0.0));
    let dates = dates.next()?;
    columns.into_iter().any(of_day).then_some(dates)
}

/// The column of parts of a second, `ms` or `us`, beside a clock that shows whole ones; `last` is the last row.
pub(crate) fn fraction(
    header: &Header,
    layout: &Layout,
    rows: &HeadRows<'_>,
    last: Option<&[Vec<u8>]>,
) -> Option<Fraction> {
    let whole = |&column: &usize| {
        let stamps = stamps(layout, rows, column).unwrap_or_default();
        let of_day = stamps.iter().any(|s| s.seconds != 0.0);
        of_day && stamps.iter().all(|s| s.seconds.fract() == 0.0)
    };
    let mut columns = 0..layout.kinds.len();
    let clock = columns.clone().find(whole)?;
    columns.find_map(|column| {
        let name = &header.names[column];
        let StatedUnit::Known(unit) = stated_unit(header.units[column].as_deref(), name) else {
            return None;
        };
        let fits = layout.kinds[column] == Kind::Number && is_time_name(name) && unit.to_si < 1.0;
        let to_s = unit.to_si;
        let found = Fraction {
            clock,
            column,
            to_s,
        };
        (fits && begins_again(layout, rows, found, last?)).then_some(found)
    })
}

/// Whether a column of parts of a second begins again with each second of the clock beside it: both together climb, and the
/// parts alone fall, in the rows seen or by the last one.
fn begins_again(layout: &Layout, rows: &HeadRows<'_>, found: Fraction, last: &[Vec<u8>]) -> bool {
    let mut parts = head_of(layout, rows, found.column);
    let whole = head_of(layout, rows, found.clock);
    let of_last = |column: usize| cell_value(layout, last.get(column)?, column, rows);
    let (Some(part), Some(end)) = (of_last(found.column), of_last(found.clock)) else {
        return false;
    };
    parts.push(part);
    let within = parts.iter().all(|p| (0.0..1.0).contains(&(p * found.to_s)));
    let falls = parts.windows(2).any(|w| w[1] < w[0]) || end > 1.0;
    let mut times = whole;
    found.add(&mut times, &parts);
    within && falls && times.windows(2).all(|w| w[1] >= w[0]) && end > 0.0
}

/// All columns of numbers that may be time axes.
pub(crate) fn candidates(header: &Header, layout: &Layout, rows: &HeadRows<'_>) -> Vec<usize> {
    let of_clock = |i: usize| layout.fraction.is_some_and(|f| f.column == i);
    let columns = 0..layout.kinds.len();
    let columns = columns.filter(|&i| layout.kinds[i] == Kind::Number && !of_clock(i));
    let of_time = columns.filter(|&i| candidate(header, layout, i).is_some());
    of_time
        .filter(|&i| climbs(&head_of(layout, rows, i)))
        .collect()
}

/// Greatest difference of the rates of two time axes of the same samples, relative.
const SAME_RATE: f64 = 1e-2;

/// A note on a further time axis that goes by other steps than the table's own, and is that of no column.
pub(crate) fn unused(
    dataset: &DatasetInfo,
    layout: &Layout,
    rows: &HeadRows<'_>,
    times: &[usize],
) -> Option<String> {
    let channels = &dataset.channels;
    let rate = |column: usize| {
        let (name, unit) = (&channels[column].name, channels[column].unit.as_deref());
        let head = head_of(layout, rows, column);
        let stated = states_unit(unit, name) && steps_evenly(&head);
        let to_s = AxisUnit::of(unit, name, &head)
            .seconds()
            .filter(|_| stated)?;
        rate::from_axis(&head, None, head.len() as u64, to_s)
    };
    let axis = dataset.time_axis?;
    let own = rate(axis)?;
    let free = |column: &usize| {
        *column != axis && !channels.iter().any(|c| c.clock == Clock::Axis(*column))
    };
    let unlike = |column: &usize| rate(*column).is_some_and(|r| (r / own - 1.0).abs() > SAME_RATE);
    let found = times.iter().copied().filter(free).find(unlike)?;
    Some(format!(
        "'{}' is taken as the time of all columns, and '{}' goes by other steps: where it is the time of some, put it before \
         them, or name it after them, as 't_x' for 'x'",
        channels[axis].name, channels[found].name
    ))
}

/// Whether a column is called the time of all columns and states its unit.
fn states_unit_of_all(header: &Header, column: usize) -> bool {
    let name = &header.names[column];
    is_time_name(name) && is_general(name) && states_unit(header.units[column].as_deref(), name)
}

/// Whether a column is called `t` with a number, and is the time of the next column of that number, in a table that
/// has several such pairs: `t1,y1,t2,y2`.
pub(crate) fn heads_pair(header: &Header, column: usize) -> bool {
    let pair = |at: usize| {
        let number = header.names[at].strip_prefix('t')?;
        let bare = header.names.get(at + 1)?.strip_suffix(number)?;
        let digits = !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
        let word = !bare.is_empty() && bare != "t" && !bare.ends_with(|c: char| c.is_ascii_digit());
        (digits && word).then_some(())
    };
    let pairs = (0..header.names.len()).filter(|at| pair(*at).is_some());
    pairs.count() > 1 && pair(column).is_some()
}

/// Whether a column with a unit of time, beside an axis, is the time of the columns after it: it is called as the axis is but
/// for a number (`t1 (s)`, `t2 (s)`), or climbs evenly.
pub(crate) fn is_further(
    header: &Header,
    layout: &Layout,
    rows: &HeadRows<'_>,
    [axis, column]: [usize; 2],
) -> bool {
    let [first, own] = [axis, column].map(|c| without_number(&header.names[c]).0);
    let stated = states_unit(header.units[column].as_deref(), &header.names[column]);
    stated && (first == own || steps_evenly(&head_of(layout, rows, column)))
}

/// A column whose kind, name or unit is of time.
fn candidate(header: &Header, layout: &Layout, column: usize) -> Option<TimeAxis> {
    let sure = |unit| TimeAxis {
        column,
        unit,
        ..TimeAxis::default()
    };
    match layout.kinds[column] {
        Kind::Text => None,
        Kind::Time => Some(sure(None)),
        Kind::Number => {
            let name = &header.names[column];
            let own = header.units[column].as_deref();
            match stated_unit(own, name) {
                StatedUnit::Known(_) if own.is_some() => Some(sure(None)),
                _ if !is_time_name(name) && !heads_pair(header, column) => None,
                StatedUnit::Known(unit) => Some(sure(symbol_of(unit).map(str::to_owned))),
                StatedUnit::Nothing => Some(sure(None)),
                StatedUnit::Other(_) => None,
            }
        }
    }
}

/// A first column without a name that climbs evenly and is no mere count of rows, or the second beside such a count.
fn unnamed(header: &Header, layout: &Layout, rows: &HeadRows<'_>) -> Option<TimeAxis> {
    let free = |column: usize| {
        header.names.get(column) == Some(&format!("column_{}", column + 1))
            && layout.kinds[column] == Kind::Number
            && layout.kinds.len() > column + 1
    };
    let climbs = |column: usize| free(column) && climbs_evenly(&head_of(layout, rows, column));
    let ticks = |column: usize| free(column) && ticks_evenly(&head_of(layout, rows, column));
    let counts = || {
        let counted = head_of(layout, rows, 0);
        counted.windows(2).all(|w| w[1] - w[0] == 1.0)
    };
    let (column, which) = if climbs(0) {
        (0, "first column")
    } else if ticks(0) {
        // in which unit it counts is not known
        return Some(TimeAxis::default());
    } else if free(0) && counts() && climbs(1) {
        (1, "second column, beside the numbers of the rows,")
    } else {
        return None;
    };
    Some(TimeAxis {
        column,
        note: Some(format!(
            "{which} climbs evenly and has no name: taken as time in seconds"
        )),
        ..TimeAxis::default()
    })
}

/// The values of a column in the rows seen; of a clock with the parts of a second beside it.
pub(crate) fn head_of(layout: &Layout, rows: &HeadRows<'_>, i: usize) -> Vec<f64> {
    let mut values: Vec<f64> = match layout.kinds[i] {
        Kind::Number => numbers(layout, rows, i).collect(),
        Kind::Time => times(layout, rows, i),
        Kind::Text => Vec::new(),
    };
    if let Some(parts) = layout.fraction.filter(|f| f.clock == i) {
        let column: Vec<f64> = numbers(layout, rows, parts.column).collect();
        parts.add(&mut values, &column);
    }
    values.retain(|v| v.is_finite());
    values
}

fn numbers<'a>(
    layout: &'a Layout,
    rows: &'a HeadRows<'a>,
    column: usize,
) -> impl Iterator<Item = f64> + 'a {
    let value = |cell| layout.notation.parse(cell).unwrap_or(f64::NAN);
    rows.column(column).map(value)
}

/// Points in time as they are read, s since the first.
fn times(layout: &Layout, rows: &HeadRows<'_>, column: usize) -> Vec<f64> {
    let mut times = Times::default();
    for cell in rows.column(column) {
        // what is no point in time is refused when the column is read
        let _ = times.push(cell, layout.month_first);
    }
    times.values
}

/// The value of a column in the last row, with its parts of a second.
fn end_of(layout: &Layout, last: &[Vec<u8>], i: usize, rows: &HeadRows<'_>) -> Option<f64> {
    let value = cell_value(layout, last.get(i)?, i, rows)?;
    let Some(parts) = layout.fraction.filter(|f| f.clock == i) else {
        return Some(value);
    };
    let of = |cell: &[u8]| layout.notation.parse(cell);
    let more = of(last.get(parts.column)?)? - of(rows.first(parts.column)?)?;
    Some(value + more * parts.to_s)
}

fn cell_value(layout: &Layout, cell: &[u8], i: usize, rows: &HeadRows<'_>) -> Option<f64> {
    match layout.kinds[i] {
        Kind::Number => layout.notation.parse(cell),
        Kind::Time => Some(stamp(layout, cell)?.since(stamp(layout, rows.first(i)?)?)),
        Kind::Text => None,
    }
}

fn stamp(layout: &Layout, cell: &[u8]) -> Option<clock::Stamp> {
    clock::parse_cell(&decode(cell), layout.month_first)
}

fn climbs(values: &[f64]) -> bool {
    values.len() > 1
        && values
            .windows(2)
            .all(|w| w[1] >= w[0] || w[0] - w[1] > 43_200.0)
        && values.first() != values.last()
}
