//! Region map: the motion that each cell of an (η, ρ) grid settles on, marched in parallel.
//!
//! Machines that reduce to one mass of constant R (a single mass, the symmetric double
//! oscillator) march in the vector kernel; all others in the exact simulator, cell by cell.

use super::grid::clear_of;
pub use super::grid::{End, MapGrid, MapSettings, RegionMap, Start, even};
use super::kernel::Cell;
pub use super::kernel::Kernel;
use super::settling::settle_on;
pub use super::threads::march_all;
pub use super::unit_mass::UnitMass;
use super::watched::{Follow, watch_again};
use crate::model::patience;
use crate::model::{Flight, Initial, Machine, ModelError, Setting, Simulator};
use crate::parallel;

/// The map of a machine over a grid. Cells do not depend on each other, nor on the number of
/// threads.
///
/// # Errors
/// [`ModelError`] where a parameter or a grid value is out of range.
///
/// ```
/// use impact_oscillator::{Machine, MapGrid, MapSettings, region_map};
///
/// let grid = MapGrid::even((1.1, 1.5, 3), (1.0, 7.0, 4));
/// let map = region_map(&Machine::symmetric(0.07, 0.9), &grid, &MapSettings::default())?;
/// // at η = 1.3 z = 1 exists for ρ below s2 = 4.152, and from rest it is reached below ρ' = 1.401
/// assert_eq!(map.at(1, 0).label(), "1");
/// assert_eq!(map.at(1, 2).label(), "0");
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
pub fn region_map(
    machine: &Machine,
    grid: &MapGrid,
    settings: &MapSettings,
) -> Result<RegionMap, ModelError> {
    check(machine, grid, settings)?;
    Ok(map_of(grid, &march_grid(machine, grid, settings)?))
}

/// The map of a machine as one watch shows it, in a third of the time: a motion that does not recur within it, and
/// whose variations do not grow beyond doubt, is [`SettledMotion::NotSettled`]. Machines that the exact simulator
/// marches are followed up to a decision, as by [`region_map`].
///
/// # Errors
/// As of [`region_map`].
///
/// ```
/// use impact_oscillator::atlas::map::first_map;
/// use impact_oscillator::{Machine, MapGrid, MapSettings, SettledMotion, region_map};
///
/// let (machine, settings) = (Machine::symmetric(0.07, 0.9), MapSettings::default());
/// let grid = MapGrid::even((0.6, 3.0, 12), (0.2, 6.0, 12));
/// let first = first_map(&machine, &grid, &settings)?.cells;
/// let map = region_map(&machine, &grid, &settings)?.cells;
/// let is_open = |m: &SettledMotion| *m == SettledMotion::NotSettled;
/// assert!(first.iter().zip(&map).all(|(first, map)| is_open(first) || first == map));
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
pub fn first_map(
    machine: &Machine,
    grid: &MapGrid,
    settings: &MapSettings,
) -> Result<RegionMap, ModelError> {
    check(machine, grid, settings)?;
    let ends = march(machine, &starts(grid, settings), settings, Follow::Watch)?;
    Ok(map_of(grid, &ends))
}

fn map_of(grid: &MapGrid, ends: &[End]) -> RegionMap {
    RegionMap {
        eta: grid.eta.clone(),
        rho: grid.rho.clone(),
        cells: ends.iter().map(|end| end.motion).collect(),
    }
}

/// March every cell of a grid from the settings' start, row by row.
pub(super) fn march_grid(
    machine: &Machine,
    grid: &MapGrid,
    settings: &MapSettings,
) -> Result<Vec<End>, ModelError> {
    march_from(machine, &starts(grid, settings), settings)
}

/// Every cell of a grid with the settings' start, row by row.
fn starts(grid: &MapGrid, settings: &MapSettings) -> Vec<Start> {
    let start = |i: usize| Start {
        at: grid.at(i),
        initial: settings.start,
        phase: 0.0,
    };
    (0..grid.len()).map(start).collect()
}

/// March cells, each from its own start, in the fast kernel where machine and starts allow.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range, or nobody wants the cells any longer.
pub fn march_from(
    machine: &Machine,
    starts: &[Start],
    settings: &MapSettings,
) -> Result<Vec<End>, ModelError> {
    march(machine, starts, settings, Follow::Decision)
}

fn march(
    machine: &Machine,
    starts: &[Start],
    settings: &MapSettings,
    follow: Follow,
) -> Result<Vec<End>, ModelError> {
    let together = |i: &Initial| machine.y.is_none() || (i.x == i.y && i.vx == i.vy);
    match UnitMass::of(machine) {
        Some(unit) if starts.iter().all(|s| together(&s.initial)) => {
            let cells: Vec<Cell> = starts.iter().map(|s| unit.cell(s)).collect();
            let mut outcomes = march_all(&unit.course(settings), &cells, settings.kernel);
            watch_again(&unit, &mut outcomes, settings, follow);
            patience::still_wanted()?;
            Ok(outcomes.iter().map(|o| unit.end(o)).collect())
        }
        _ => parallel::map(starts, |s| exact_cell(machine, s, settings))
            .into_iter()
            .collect(),
    }
}

/// Whether machine, grid and settings make a map.
///
/// # Errors
/// [`ModelError`] with the first parameter out of range.
pub(super) fn check(
    machine: &Machine,
    grid: &MapGrid,
    settings: &MapSettings,
) -> Result<(), ModelError> {
    machine.check()?;
    settings.start.check()?;
    if machine.flight != Flight::Harmonic {
        return Err(ModelError::Unsupported(
            "a region map needs the harmonic flight",
        ));
    }
    grid.eta
        .iter()
        .try_for_each(|&eta| Setting::new(eta, 0.0).check())?;
    grid.rho
        .iter()
        .try_for_each(|&rho| Setting::new(1.0, rho).check())
}

/// One cell in the exact simulator.
fn exact_cell(machine: &Machine, s: &Start, settings: &MapSettings) -> Result<End, ModelError> {
    let (eta, rho) = s.at;
    let setting = Setting::new(eta, rho).at_phase(s.phase);
    let mut simulator = Simulator::new(machine, setting, clear_of(machine, rho, s.initial))?;
    let motion = settle_on(machine, &mut simulator, setting, &settings.watch).motion;
    Ok(End {
        motion,
        initial: simulator.state().into(),
        phase: simulator.phase(),
    })
}
