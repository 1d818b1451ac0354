//! A region map by brute force from one start, block of rows by block of rows, and its figure.

use super::plan::MapPlan;
use super::table::Table;
use super::{StudyContext, StudyError};
use crate::compare::RegionMap;
use crate::motion::Motion;
use crate::report::locale::Locale;
use crate::report::theory::regions as figure;
use impact_oscillator::atlas::map::even;
use impact_oscillator::{Machine, MapGrid, SettledMotion, region_map};

/// Rows of a block.
const BLOCK: usize = 8;

/// Compute the map and write table and figure.
///
/// # Errors
/// [`StudyError`] where a parameter is out of range or an output cannot be written.
pub fn run(
    machine: &Machine,
    name: &str,
    plan: &MapPlan,
    context: &StudyContext<'_>,
) -> Result<(), StudyError> {
    let (eta, rho) = (even(plan.eta), even(plan.rho));
    let mut cells: Vec<SettledMotion> = Vec::with_capacity(eta.len() * rho.len());
    for (number, rows) in rho.chunks(BLOCK).enumerate() {
        let found: Vec<SettledMotion> =
            context.blocks.block(&format!("{name} rows {number}"), || {
                let grid = MapGrid {
                    eta: eta.clone(),
                    rho: rows.to_vec(),
                };
                let map = region_map(machine, &grid, &plan.map);
                map.map(|m| m.cells).map_err(StudyError::of(name))
            })?;
        cells.extend(found);
        let done = (number * BLOCK + rows.len()) as u64;
        (context.progress)(done, rho.len() as u64);
    }
    let grid = MapGrid { eta, rho };
    context.table(name, &table(&grid, &cells))?;
    let motions: Vec<Motion> = cells.iter().map(|cell| Motion::from(*cell)).collect();
    let map = RegionMap::new(grid.eta, grid.rho, &motions, &motions);
    match figure::draw((&map, &[]), name, "Regions of motion", Locale::default()) {
        Some(figure) => context.figure(&figure),
        None => Ok(()),
    }
}

fn table(grid: &MapGrid, cells: &[SettledMotion]) -> Table {
    Table::new()
        .numbers("eta", (0..grid.len()).map(|i| grid.at(i).0))
        .numbers("rho", (0..grid.len()).map(|i| grid.at(i).1))
        .texts("motion", cells.iter().map(|m| m.label()))
}
