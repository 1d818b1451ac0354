//! Brute-force maps: every cell from rest, and continued from its neighbour in rising and in
//! falling η, so that coexisting motions appear.

use serde::{Deserialize, Serialize};

use super::kernel::{Cell, Feed, Outcome, run};
use super::map::{
    End, Kernel, MapGrid, MapSettings, Start, UnitMass, check, march_from, march_grid,
};
use crate::model::{Initial, Machine, ModelError};
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
    let start = brute_map(machine, grid, settings, Seeding::FromStart)?;
    // both seedings in one march, so that all lanes have work
    let mut carried = carried(
        machine,
        grid,
        settings,
        &[Seeding::Rising, Seeding::Falling],
    )?;
    let falling = carried.pop().unwrap_or_default();
    let rising = carried.pop().unwrap_or_default();
    Ok([start, rising, falling])
}

/// What every cell settles on, row by row as in [`RegionMap`](super::RegionMap).
///
/// # Errors
/// [`ModelError`] where a parameter is out of range.
pub(super) fn brute_map(
    machine: &Machine,
    grid: &MapGrid,
    settings: &MapSettings,
    seeding: Seeding,
) -> Result<Vec<End>, ModelError> {
    if seeding != Seeding::FromStart {
        let mut carried = carried(machine, grid, settings, &[seeding])?;
        return Ok(carried.pop().unwrap_or_default());
    }
    march_grid(machine, grid, settings)
}

/// Rows that the marching kernel continues from column to column, each on its own: a lane whose
/// cell is done takes any row that can go on.
struct Chains<'a> {
    unit: UnitMass,
    grid: &'a MapGrid,
    seedings: &'a [Seeding],
    ready: Vec<(usize, Cell)>,
    done: Vec<(usize, Outcome)>,
}

/// Which seeding's map, and which cell of it, a numbered step is; steps are numbered
/// (seeding · rows + row) · columns + step.
fn place(grid: &MapGrid, seedings: &[Seeding], number: usize) -> (usize, usize) {
    let (columns, rows) = (grid.eta.len(), grid.rho.len());
    let (chain, step) = (number / columns, number % columns);
    let column = match seedings[chain / rows] {
        Seeding::Falling => columns - 1 - step,
        _ => step,
    };
    (chain / rows, (chain % rows) * columns + column)
}

impl Feed for Chains<'_> {
    fn next(&mut self) -> Option<(usize, Cell)> {
        self.ready.pop()
    }
    fn done(&mut self, number: usize, outcome: Outcome) {
        self.done.push((number, outcome));
        let next = number + 1;
        if !next.is_multiple_of(self.grid.eta.len()) {
            let end = self.unit.end(&outcome);
            let start = Start {
                at: self.grid.at(place(self.grid, self.seedings, next).1),
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
    seedings: &[Seeding],
) -> Vec<Vec<End>> {
    let (columns, course) = (grid.eta.len(), unit.course(settings));
    let kernel = settings.kernel.filter(|k| k.is_available());
    let kernel = kernel.unwrap_or_else(Kernel::of_this_machine);
    let first = |number: usize| Start {
        at: grid.at(place(grid, seedings, number).1),
        initial: settings.start,
        phase: 0.0,
    };
    let rows: Vec<(usize, Cell)> = (0..seedings.len() * grid.rho.len())
        .map(|chain| (chain * columns, unit.cell(&first(chain * columns))))
        .collect();
    let share = rows.len().div_ceil(parallel::threads()).max(1);
    let march = |ready: &&[(usize, Cell)]| {
        let mut chains = Chains {
            unit,
            grid,
            seedings,
            ready: ready.to_vec(),
            done: Vec::new(),
        };
        run(kernel, &course, &mut chains);
        chains.done
    };
    let chunks: Vec<&[(usize, Cell)]> = rows.chunks(share).collect();
    let mut done: Vec<(usize, Outcome)> = parallel::map(&chunks, march).concat();
    done.sort_unstable_by_key(|d| place(grid, seedings, d.0));
    let judged = |(_, outcome): &(usize, Outcome)| End {
        motion: unit.judge(outcome, &settings.watch),
        ..unit.end(outcome)
    };
    let ends: Vec<End> = parallel::map(&done, judged);
    ends.chunks(grid.len().max(1))
        .map(<[End]>::to_vec)
        .collect()
}

/// Carry motions from column to column, in one or both directions at once.
fn carried(
    machine: &Machine,
    grid: &MapGrid,
    settings: &MapSettings,
    seedings: &[Seeding],
) -> Result<Vec<Vec<End>>, ModelError> {
    let (columns, rows) = (grid.eta.len(), grid.rho.len());
    let together = |i: &Initial| machine.y.is_none() || (i.x == i.y && i.vx == i.vy);
    if let Some(unit) = UnitMass::of(machine).filter(|_| together(&settings.start)) {
        return Ok(carried_in_lanes(unit, grid, settings, seedings));
    }
    let mut cells: Vec<Vec<Option<End>>> = vec![vec![None; grid.len()]; seedings.len()];
    let mut before: Option<Vec<End>> = None;
    for step in 0..columns {
        let column = |seeding: Seeding| match seeding {
            Seeding::Falling => columns - 1 - step,
            _ => step,
        };
        let number = |k: usize| (k % rows) * columns + column(seedings[k / rows]);
        let start = |k: usize| {
            let last = before.as_ref().map(|ends| ends[k]);
            Start {
                at: grid.at(number(k)),
                initial: last.map_or(settings.start, |end| end.initial),
                phase: last.map_or(0.0, |end| end.phase),
            }
        };
        let starts: Vec<Start> = (0..seedings.len() * rows).map(start).collect();
        let ends = march_from(machine, &starts, settings)?;
        for (k, end) in ends.iter().enumerate() {
            cells[k / rows][number(k)] = Some(*end);
        }
        before = Some(ends);
    }
    let whole = |map: Vec<Option<End>>| map.into_iter().flatten().collect();
    Ok(cells.into_iter().map(whole).collect())
}
