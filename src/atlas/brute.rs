//! Brute-force maps: every cell from rest, and carried along from its neighbour in rising and in
//! falling η, so that coexisting motions show.

use super::map::{End, MapGrid, MapSettings, Start, check, march_from};
use crate::model::{Machine, ModelError};

/// How the cells of a map are started.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// Every cell from the settings' start.
    FromStart,
    /// Each from its neighbour of lower η.
    Rising,
    /// Each from its neighbour of higher η.
    Falling,
}

/// All ways, in the order of [`brute_maps`].
pub const WAYS: [Way; 3] = [Way::FromStart, Way::Rising, Way::Falling];

/// The three maps of a grid, in the order of [`WAYS`].
pub type Maps = [Vec<End>; 3];

/// All three maps; they do not depend on each other, nor one row on another.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range.
pub fn brute_maps(
    machine: &Machine,
    grid: &MapGrid,
    settings: &MapSettings,
) -> Result<Maps, ModelError> {
    check(machine, grid, settings)?;
    let start = brute_map(machine, grid, settings, Way::FromStart)?;
    // both ways in one march, so that all lanes have work
    let mut carried = carried(machine, grid, settings, &[Way::Rising, Way::Falling])?;
    let falling = carried.pop().unwrap_or_default();
    let rising = carried.pop().unwrap_or_default();
    Ok([start, rising, falling])
}

/// What every cell settles on, row by row as in `RegionMap`.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range.
pub fn brute_map(
    machine: &Machine,
    grid: &MapGrid,
    settings: &MapSettings,
    way: Way,
) -> Result<Vec<End>, ModelError> {
    if way != Way::FromStart {
        let mut carried = carried(machine, grid, settings, &[way])?;
        return Ok(carried.pop().unwrap_or_default());
    }
    let start = |i: usize| Start {
        at: grid.at(i),
        initial: settings.start,
        phase: 0.0,
    };
    let starts: Vec<Start> = (0..grid.len()).map(start).collect();
    march_from(machine, &starts, settings)
}

/// Carry motions from column to column, in one or both directions at once.
fn carried(
    machine: &Machine,
    grid: &MapGrid,
    settings: &MapSettings,
    ways: &[Way],
) -> Result<Vec<Vec<End>>, ModelError> {
    let (columns, rows) = (grid.eta.len(), grid.rho.len());
    let mut cells: Vec<Vec<Option<End>>> = vec![vec![None; grid.len()]; ways.len()];
    let mut before: Option<Vec<End>> = None;
    for step in 0..columns {
        let column = |way: Way| match way {
            Way::Falling => columns - 1 - step,
            _ => step,
        };
        let number = |k: usize| (k % rows) * columns + column(ways[k / rows]);
        let start = |k: usize| {
            let last = before.as_ref().map(|ends| ends[k]);
            Start {
                at: grid.at(number(k)),
                initial: last.map_or(settings.start, |end| end.initial),
                phase: last.map_or(0.0, |end| end.phase),
            }
        };
        let starts: Vec<Start> = (0..ways.len() * rows).map(start).collect();
        let ends = march_from(machine, &starts, settings)?;
        for (k, end) in ends.iter().enumerate() {
            cells[k / rows][number(k)] = Some(*end);
        }
        before = Some(ends);
    }
    let whole = |map: Vec<Option<End>>| map.into_iter().flatten().collect();
    Ok(cells.into_iter().map(whole).collect())
}
