//! Brute-force maps: every cell from rest, and continued from its neighbour in rising and in
//! falling η, so that coexisting motions appear.

use serde::{Deserialize, Serialize};

use super::grid::{End, MapGrid, MapSettings, Start};
use super::kernel::{Cell, Feed, Outcome, run};
use super::map::{check, march_from, march_grid};
use super::threads::available;
use super::unit_mass::UnitMass;
use super::watched::{Follow, watch_again};
use crate::model::{Initial, Machine, ModelError, patience};
use crate::parallel;

/// How the cells of a map are started.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Seeding {
    /// Every cell from the settings' start.
    FromStart,
    /// Each from its neighbour of lower η.
    Rising,
    /// Each from its neighbour of higher η.
    Falling,
}

impl Seeding {
    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::FromStart => "from_start",
            Self::Rising => "rising",
            Self::Falling => "falling",
        }
    }
}

/// All seedings, in the order of [`brute_maps`].
pub(super) const SEEDINGS: [Seeding; 3] = [Seeding::FromStart, Seeding::Rising, Seeding::Falling];

/// The three maps of a grid, in the order of [`SEEDINGS`].
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
    let start = march_grid(machine, grid, settings)?;
    // both directions in one march, so that all lanes have work
    let [rising, falling] = carried_maps(machine, grid, settings)?;
    Ok([start, rising, falling])
}

/// Rows that the marching kernel continues from column to column, each on its own: a lane whose
/// cell is done takes any row that can go on.
struct Chains<'a> {
    unit: UnitMass,
    grid: &'a MapGrid,
    ready: Vec<(usize, Cell)>,
    done: Vec<(usize, Outcome)>,
}

/// Which of the carried maps (rising, falling), and which cell of it, a numbered step is; steps are
/// numbered (map · rows + row) · columns + step.
fn place(grid: &MapGrid, number: usize) -> (usize, usize) {
    let (columns, rows) = (grid.eta.len(), grid.rho.len());
    let (chain, step) = (number / columns, number % columns);
    let column = if chain < rows {
        step
    } else {
        columns - 1 - step
    };
    (chain / rows, (chain % rows) * columns + column)
}

impl Feed for Chains<'_> {
    fn next(&mut self) -> Option<(usize, Cell)> {
        self.ready.pop().filter(|_| !patience::is_over())
    }
    fn done(&mut self, number: usize, outcome: Outcome) {
        self.done.push((number, outcome));
        let next = number + 1;
        if !next.is_multiple_of(self.grid.eta.len()) {
            let end = self.unit.end(&outcome);
            let start = Start {
                at: self.grid.at(place(self.grid, next).1),
                initial: end.initial,
                phase: end.phase,
            };
            self.ready.push((next, self.unit.cell(&start)));
        }
    }
}

/// Continue motions from column to column in the marching kernel.
fn carried_in_lanes(
    unit: UnitMass,
    grid: &MapGrid,
    settings: &MapSettings,
) -> Result<[Vec<End>; 2], ModelError> {
    let (columns, course) = (grid.eta.len(), unit.course(settings));
    let kernel = available(settings.kernel);
    let first = |number: usize| Start {
        at: grid.at(place(grid, number).1),
        initial: settings.start,
        phase: 0.0,
    };
    let rows: Vec<(usize, Cell)> = (0..2 * grid.rho.len())
        .map(|chain| (chain * columns, unit.cell(&first(chain * columns))))
        .collect();
    let share = rows.len().div_ceil(parallel::threads()).max(1);
    let march = |ready: &&[(usize, Cell)]| {
        let mut chains = Chains {
            unit,
            grid,
            ready: ready.to_vec(),
            done: Vec::new(),
        };
        run(kernel, &course, &mut chains);
        chains.done
    };
    let chunks: Vec<&[(usize, Cell)]> = rows.chunks(share).collect();
    let mut done: Vec<(usize, Outcome)> = parallel::map(&chunks, march).concat();
    patience::still_wanted()?;
    done.sort_unstable_by_key(|d| place(grid, d.0));
    let mut outcomes: Vec<Outcome> = done.into_iter().map(|d| d.1).collect();
    watch_again(&unit, &mut outcomes, settings, Follow::Decision);
    let mut rising: Vec<End> = outcomes.iter().map(|o| unit.end(o)).collect();
    let falling = rising.split_off(grid.len());
    Ok([rising, falling])
}

/// Motions carried from column to column in rising and in falling η, both at once.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range, or nobody wants the cells any longer.
pub fn carried_maps(
    machine: &Machine,
    grid: &MapGrid,
    settings: &MapSettings,
) -> Result<[Vec<End>; 2], ModelError> {
    let (columns, rows) = (grid.eta.len(), grid.rho.len());
    let together = |i: &Initial| machine.y.is_none() || (i.x == i.y && i.vx == i.vy);
    if let Some(unit) = UnitMass::of(machine).filter(|_| together(&settings.start)) {
        return carried_in_lanes(unit, grid, settings);
    }
    let mut maps = [0, 1].map(|_| vec![None; grid.len()]);
    let mut before: Option<Vec<End>> = None;
    for step in 0..columns {
        let place = |chain: usize| place(grid, chain * columns + step);
        let start = |chain: usize| {
            let last = before.as_ref().map(|ends| ends[chain]);
            Start {
                at: grid.at(place(chain).1),
                initial: last.map_or(settings.start, |end| end.initial),
                phase: last.map_or(0.0, |end| end.phase),
            }
        };
        let starts: Vec<Start> = (0..2 * rows).map(start).collect();
        let ends = march_from(machine, &starts, settings)?;
        for (chain, end) in ends.iter().enumerate() {
            let (map, cell) = place(chain);
            maps[map][cell] = Some(*end);
        }
        before = Some(ends);
    }
    Ok(maps.map(|map| map.into_iter().flatten().collect()))
}
