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
    let [start, rising, falling] = WAYS.map(|way| brute_map(machine, grid, settings, way));
    Ok([start?, rising?, falling?])
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
    let columns = grid.eta.len();
    let start = |i: usize| Start {
        at: grid.at(i),
        initial: settings.start,
        phase: 0.0,
    };
    if way == Way::FromStart {
        let starts: Vec<Start> = (0..grid.len()).map(start).collect();
        return march_from(machine, &starts, settings);
    }
    let mut cells: Vec<Option<End>> = vec![None; grid.len()];
    let mut before: Option<Vec<End>> = None;
    for step in 0..columns {
        let column = if way == Way::Rising {
            step
        } else {
            columns - 1 - step
        };
        let numbers: Vec<usize> = (0..grid.rho.len()).map(|k| k * columns + column).collect();
        let starts: Vec<Start> = numbers
            .iter()
            .enumerate()
            .map(|(k, &i)| match &before {
                None => start(i),
                Some(ends) => Start {
                    at: grid.at(i),
                    initial: ends[k].initial,
                    phase: ends[k].phase,
                },
            })
            .collect();
        let ends = march_from(machine, &starts, settings)?;
        for (&i, end) in numbers.iter().zip(&ends) {
            cells[i] = Some(*end);
        }
        before = Some(ends);
    }
    Ok(cells.into_iter().flatten().collect())
}
