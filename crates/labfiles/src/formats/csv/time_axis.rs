//! Which column of a table is its time axis, and at which rate its rows follow.

use crate::formats::csv::columns::HeadRows;
use crate::formats::csv::header::Header;
use crate::rate;
use crate::text::table::{Kind, Layout};
use crate::text::{clock, decode};
use crate::timing::{
    AxisUnit, StatedUnit, climbs_evenly, is_general, is_time_name, stated_unit, states_unit,
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
    let candidates = (0..layout.kinds.len()).filter_map(|i| candidate(header, layout, i));
    let found = candidates.filter(|c| climbs(&head_of(layout, rows, c.column)));
    let found: Vec<TimeAxis> = found.collect();
    let mut numbers = found
        .iter()
        .take_while(|c| layout.kinds[c.column] == Kind::Number);
    let best = numbers.find(|c| states_unit_of_all(header, c.column));
    let best = best.or(found.first()).cloned();
    let mut axis = best.or_else(|| unnamed(header, layout, rows))?;
    let head = head_of(layout, rows, axis.column);
    let end = last.and_then(|cells| cell_value(layout, cells.get(axis.column)?, axis.column, rows));
    if layout.kinds[axis.column] == Kind::Time {
        let first = rows.first(axis.column);
        axis.start = first.and_then(|c| stamp(layout, c)).map(clock::Stamp::iso);
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
    Some(axis)
}

/// All columns of numbers that may be time axes.
pub(crate) fn candidates(header: &Header, layout: &Layout, rows: &HeadRows<'_>) -> Vec<usize> {
    let columns = (0..layout.kinds.len()).filter(|&i| layout.kinds[i] == Kind::Number);
    let of_time = columns.filter(|&i| candidate(header, layout, i).is_some());
    of_time
        .filter(|&i| climbs(&head_of(layout, rows, i)))
        .collect()
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

/// A first column without a name that climbs evenly and is no mere count of rows.
fn unnamed(header: &Header, layout: &Layout, rows: &HeadRows<'_>) -> Option<TimeAxis> {
    if header.names.first()? != "column_1"
        || layout.kinds[0] != Kind::Number
        || layout.kinds.len() < 2
    {
        return None;
    }
    climbs_evenly(&head_of(layout, rows, 0)).then(|| {
        let note = "first column climbs evenly and has no name: taken as time in seconds";
        TimeAxis {
            column: 0,
            note: Some(note.to_owned()),
            ..TimeAxis::default()
        }
    })
}

/// The values of a column in the rows seen.
fn head_of(layout: &Layout, rows: &HeadRows<'_>, i: usize) -> Vec<f64> {
    rows.column(i)
        .filter_map(|cell| cell_value(layout, cell, i, rows))
        .filter(|v| v.is_finite())
        .collect()
}

fn cell_value(layout: &Layout, cell: &[u8], i: usize, rows: &HeadRows<'_>) -> Option<f64> {
    match layout.kinds[i] {
        Kind::Number => layout.notation.parse(cell),
        Kind::Time => Some(stamp(layout, cell)?.since(stamp(layout, rows.first(i)?)?)),
        Kind::Text => None,
    }
}

fn stamp(layout: &Layout, cell: &[u8]) -> Option<clock::Stamp> {
    clock::parse(&decode(cell), layout.month_first)
}

fn climbs(values: &[f64]) -> bool {
    values.len() > 1
        && values
            .windows(2)
            .all(|w| w[1] >= w[0] || w[0] - w[1] > 43_200.0)
        && values.first() != values.last()
}
