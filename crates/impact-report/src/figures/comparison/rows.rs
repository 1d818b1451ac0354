//! Which channels of a comparison share a row of panels, and in which unit.

use crate::kit::canvas::Colour;
use crate::kit::look;
use crate::kit::units::{PrintUnit, print_unit};
use crate::phrase::{Phrase, Text};
use impact_identification::replay::{ReplayedRecord, Signal, Trace};
use impact_records::record::Role;

/// A row of panels: which channels, how tall, how titled.
pub(super) struct Row<'a> {
    /// The channels with their colours.
    pub traces: Vec<(&'a Trace, Colour)>,
    /// Height of its panels, points.
    pub height: f64,
    /// The unit in which they are printed.
    pub unit: PrintUnit,
    /// Title of the upward axis.
    pub title: Text,
    /// Whether it shows residuals.
    pub residual: bool,
}

/// The rows of a comparison, those with anything to show; residuals last.
pub(super) fn rows(comparison: &ReplayedRecord) -> Vec<Row<'_>> {
    let pairs = [
        ([Role::DisplacementX, Role::DisplacementY], None, 38.0),
        ([Role::VelocityX, Role::VelocityY], None, 38.0),
        ([Role::AccelerationX, Role::AccelerationY], None, 38.0),
        ([Role::Drive, Role::Drive], Some(Phrase::Drive), 22.0),
        ([Role::Contact, Role::Contact], Some(Phrase::Contact), 21.0),
        ([Role::FrameX, Role::FrameY], Some(Phrase::Frame), 21.0),
    ];
    let mut rows: Vec<Row<'_>> = pairs
        .iter()
        .filter_map(|(roles, name, height)| row(comparison, roles, *name, *height))
        .collect();
    rows.extend(residual_row(comparison));
    rows
}

fn row<'a>(
    comparison: &'a ReplayedRecord,
    roles: &[Role; 2],
    name: Option<Phrase>,
    height: f64,
) -> Option<Row<'a>> {
    let traces = pick(comparison, roles, |_| true);
    let dimension = traces.first()?.0.dimension;
    // An open contact's noise is not to be blown up.
    let least = if roles[0] == Role::Contact { 1.0 } else { 0.0 };
    let peak = traces
        .iter()
        .flat_map(|(t, _)| shown(t))
        .map(|s| peak(&s.values))
        .fold(least, f64::max);
    let unit = print_unit(dimension, peak);
    let between = if height < 30.0 { "\n" } else { " " };
    let symbols: Vec<&str> = traces.iter().map(|(t, _)| symbol(t.role)).collect();
    let unit_text = format!("{between}({})", unit.symbol);
    let title = match name {
        Some(name) => Text::Followed(name, unit_text),
        None => Text::Plain(symbols.join(", ") + &unit_text),
    };
    Some(Row {
        traces,
        height,
        title,
        unit,
        residual: false,
    })
}

/// The residual of the best channel that has one: velocity first.
fn residual_row(comparison: &ReplayedRecord) -> Option<Row<'_>> {
    Role::OF_BOTH.iter().find_map(|roles| {
        let traces = pick(comparison, roles, |t| t.residual.is_some());
        let dimension = traces.first()?.0.dimension;
        let peak = traces
            .iter()
            .filter_map(|(t, _)| t.clear_residual())
            .map(|values| peak(&values))
            .fold(0.0, f64::max);
        let unit = print_unit(dimension, peak);
        let title = Text::Followed(Phrase::Residual, format!("\n({})", unit.symbol));
        Some(Row {
            traces,
            height: 30.0,
            title,
            unit,
            residual: true,
        })
    })
}

fn pick<'a>(
    comparison: &'a ReplayedRecord,
    roles: &[Role; 2],
    wanted: impl Fn(&Trace) -> bool,
) -> Vec<(&'a Trace, Colour)> {
    let colour = |role: Role| {
        if role == roles[0] {
            look::BLUE
        } else {
            look::VERMILION
        }
    };
    comparison
        .traces
        .iter()
        .filter(|t| roles.contains(&t.role) && wanted(t))
        .map(|t| (t, colour(t.role)))
        .collect()
}

fn peak(values: &[f64]) -> f64 {
    values
        .iter()
        .filter(|v| v.is_finite())
        .fold(0.0, |m, v| m.max(v.abs()))
}

/// Symbol of a channel, with markup; its name where it has none.
pub(super) fn symbol(role: Role) -> &'static str {
    match role {
        Role::VelocityX => "$v_x$",
        Role::VelocityY => "$v_y$",
        Role::DisplacementX => "$x$",
        Role::DisplacementY => "$y$",
        Role::AccelerationX => "$a_x$",
        Role::AccelerationY => "$a_y$",
        other => other.name(),
    }
}

/// The measured and the simulated signal of a trace.
pub(super) fn shown(trace: &Trace) -> impl Iterator<Item = &Signal> {
    std::iter::once(&trace.measured).chain(&trace.simulated)
}
