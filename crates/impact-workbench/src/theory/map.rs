//! A region map by brute force from one start, block of rows by block of rows, and its figure.

use super::context::StudyContext;
use super::plan::MapPlan;
use crate::figures::regions as figure;
use impact_campaign::pipeline::PipelineError;
use impact_campaign::pipeline::table::Table;
use impact_identification::replay::RegionMap;
use impact_oscillator::atlas::map::even;
use impact_oscillator::{Machine, MapGrid, SettledMotion, region_map};
use impact_records::motion::Motion;

/// Rows of a block.
const BLOCK: usize = 8;

/// Compute the map and write table and figure.
///
/// # Errors
/// [`PipelineError`] where a parameter is out of range or an output cannot be written.
pub fn run(
    machine: &Machine,
    name: &str,
    plan: &MapPlan,
    context: &StudyContext<'_>,
) -> Result<(), PipelineError> {
    let (eta, rho) = (even(plan.eta), even(plan.rho));
    let rows = format!("{name} rows");
    let cells = context.in_blocks(&rows, rho.len(), BLOCK, |rows| {
        let grid = MapGrid {
            eta: eta.clone(),
            rho: rho[rows].to_vec(),
        };
        let map = region_map(machine, &grid, &plan.map);
        map.map(|m| m.cells).map_err(PipelineError::in_study(name))
    })?;
    let grid = MapGrid { eta, rho };
    context.table(name, &table(&grid, &cells))?;
    let motions: Vec<Motion> = cells.iter().map(|cell| Motion::from(*cell)).collect();
    let map = RegionMap::new(grid.eta, grid.rho, &motions, &motions);
    context.figure(figure::draw((&map, &[]), name, "Regions of motion").as_ref())
}

fn table(grid: &MapGrid, cells: &[SettledMotion]) -> Table {
    Table::new()
        .numbers("eta", (0..grid.len()).map(|i| grid.at(i).0))
        .numbers("rho", (0..grid.len()).map(|i| grid.at(i).1))
        .texts("motion", cells.iter().map(|m| m.label()))
}
