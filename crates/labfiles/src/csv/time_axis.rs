//! Which column of a table is its time axis, and at which rate its rows follow.

use crate::attribute::is_time_name;
use crate::csv::columns::HeadRows;
use crate::csv::header::Header;
use crate::rate;
use crate::text::table::{Kind, Layout};
use crate::text::{clock, decode, number};
use crate::units::{Dimension, parse_unit};

/// The time axis of a table.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct TimeAxis {
    /// The column.
    pub column: usize,
    /// Its unit, if it is a number.
    pub unit: Option<String>,
    /// Rows per second, Hz, if the axis gives them.
    pub rate_hz: Option<f64>,
    /// The first point in time, where the axis holds points in time.
    pub start: Option<String>,
    /// What was assumed.
    pub note: Option<String>,
}

/// Find the time axis: a column of points in time, one whose name or unit is of time, or an
/// unnamed first column that climbs evenly. It must never go back in the rows seen.
pub(crate) fn find(
    header: &Header,
    layout: &Layout,
    rows: &HeadRows<'_>,
    last: Option<&[Vec<u8>]>,
    count: u64,
) -> Option<TimeAxis> {
    let candidates = (0..layout.kinds.len()).filter_map(|i| candidate(header, layout, i));
    let mut found = candidates.filter(|c| climbs(&head_of(layout, rows, c.column)));
    let mut axis = found.next().or_else(|| unnamed(header, layout, rows))?;
    let head = head_of(layout, rows, axis.column);
    let end = last.and_then(|cells| cell_value(layout, cells.get(axis.column)?, axis.column, rows));
    axis.rate_hz = rate::from_axis(&head, end, count, axis.unit.as_deref());
    if layout.kinds[axis.column] == Kind::Time {
        let first = rows.first(axis.column);
        axis.start = first.and_then(|c| stamp(layout, c)).map(clock::Stamp::iso);
        axis.unit = axis.unit.or_else(|| Some("s".to_owned()));
    }
    Some(axis)
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
            let unit = header.units[column].clone().or_else(|| unit_in_name(name));
            let known = unit.as_deref().and_then(parse_unit);
            if known.is_some_and(|u| u.dimension == Dimension::Time) {
                return Some(sure(unit));
            }
            (unit.is_none() && is_time_name(name)).then(|| TimeAxis {
                column,
                unit: Some("s".to_owned()),
                note: Some(format!("time axis '{name}' has no unit: taken as seconds")),
                ..TimeAxis::default()
            })
        }
    }
}

/// The unit that a name such as `time_ms` ends in.
fn unit_in_name(name: &str) -> Option<String> {
    let (word, unit) = name.rsplit_once('_')?;
    let time = parse_unit(unit).is_some_and(|u| u.dimension == Dimension::Time);
    (time && is_time_name(word)).then(|| unit.to_owned())
}

/// A first column without a name that climbs evenly and is no mere count of rows.
fn unnamed(header: &Header, layout: &Layout, rows: &HeadRows<'_>) -> Option<TimeAxis> {
    if header.names.first()? != "column_1"
        || layout.kinds[0] != Kind::Number
        || layout.kinds.len() < 2
    {
        return None;
    }
    let head = head_of(layout, rows, 0);
    let step = rate::median_step(&head)?;
    let even = head
        .windows(2)
        .all(|w| (w[1] - w[0] - step).abs() < 0.5 * step);
    let counts = head.iter().all(|v| v.fract() == 0.0);
    (head.len() > 2 && even && !counts).then(|| {
        let note = "first column climbs evenly and has no name: taken as time in seconds";
        TimeAxis {
            column: 0,
            unit: Some("s".to_owned()),
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
        Kind::Number => number::parse_cell(cell, layout.decimal),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_time() {
        for name in ["time_s", "Time", "t", "X_Value", "Time (Run 1)", "Zeit"] {
            assert!(is_time_name(name), "{name}");
        }
        for name in ["times", "velocity", "tone"] {
            assert!(!is_time_name(name), "{name}");
        }
        assert_eq!(unit_in_name("time_ms").as_deref(), Some("ms"));
    }
}
