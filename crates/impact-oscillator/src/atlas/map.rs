//! Region map: the motion that each cell of an (η, ρ) grid settles on, marched in parallel.
//!
//! Machines that reduce to one mass of constant R (a single mass, the symmetric double
//! oscillator) march in the vector kernel; all others in the exact simulator, cell by cell.

use std::sync::atomic::{AtomicUsize, Ordering};

use serde::{Deserialize, Serialize};

pub use super::kernel::Kernel;
use super::kernel::{Cell, Course, Feed, Outcome, run};
use super::settling::settle_on;
use super::watched::watch_again;
use crate::model::patience;
use crate::model::{
    Flight, Initial, Machine, ModelError, Oscillator, Setting, SettledMotion, Simulator, Watch,
};
use crate::parallel;

/// The grid: cell (i, k) lies at (`eta[i]`, `rho[k]`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapGrid {
    /// η of the columns.
    pub eta: Vec<f64>,
    /// ρ of the rows.
    pub rho: Vec<f64>,
}

impl MapGrid {
    /// Evenly spaced, both ends included: (first, last, count) of η and of ρ.
    pub fn even(eta: (f64, f64, usize), rho: (f64, f64, usize)) -> Self {
        Self {
            eta: even(eta),
            rho: even(rho),
        }
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.eta.len() * self.rho.len()
    }

    /// Whether there is no cell.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// (η, ρ) of a cell by its number, row by row.
    pub fn at(&self, index: usize) -> (f64, f64) {
        (
            self.eta[index % self.eta.len()],
            self.rho[index / self.eta.len()],
        )
    }
}

/// Evenly spaced numbers (first, last, count).
pub fn even((first, last, count): (f64, f64, usize)) -> Vec<f64> {
    let steps = count.saturating_sub(1).max(1) as f64;
    (0..count)
        .map(|i| first + (last - first) * (i as f64 / steps))
        .collect()
}

/// How a map is marched.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MapSettings {
    /// Settling and watch, in drive periods.
    pub watch: Watch,
    /// Leave a cell when no impact can come again, or when its orbit recurs.
    pub leave_early: bool,
    /// Start of every cell; a start beyond the contact is moved to it.
    pub start: Initial,
    /// Kernel to use; `None`: the widest this processor runs.
    pub kernel: Option<Kernel>,
}

impl Default for MapSettings {
    fn default() -> Self {
        Self {
            watch: Watch::default(),
            leave_early: true,
            start: Initial::rest(),
            kernel: None,
        }
    }
}

/// A region map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RegionMap {
    /// η of the columns.
    pub eta: Vec<f64>,
    /// ρ of the rows.
    pub rho: Vec<f64>,
    /// The motions, row by row: cell (i, k) is `cells[k * eta.len() + i]`.
    pub cells: Vec<SettledMotion>,
}

impl RegionMap {
    /// The motion at column i (η) and row k (ρ).
    pub fn at(&self, i: usize, k: usize) -> SettledMotion {
        self.cells[k * self.eta.len() + i]
    }
}

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
    let ends = march_grid(machine, grid, settings)?;
    Ok(RegionMap {
        eta: grid.eta.clone(),
        rho: grid.rho.clone(),
        cells: ends.iter().map(|end| end.motion).collect(),
    })
}

/// March every cell of a grid from the settings' start, row by row.
pub(super) fn march_grid(
    machine: &Machine,
    grid: &MapGrid,
    settings: &MapSettings,
) -> Result<Vec<End>, ModelError> {
    let start = |i: usize| Start {
        at: grid.at(i),
        initial: settings.start,
        phase: 0.0,
    };
    let starts: Vec<Start> = (0..grid.len()).map(start).collect();
    march_from(machine, &starts, settings)
}

/// A cell with its own start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    /// (η, ρ)
    pub at: (f64, f64),
    /// Displacements and velocities; beyond the contact they are moved to it.
    pub initial: Initial,
    /// Phase of the drive, rad.
    pub phase: f64,
}

/// What a cell settled on, and where it ended.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct End {
    /// The motion.
    pub motion: SettledMotion,
    /// A state of that motion.
    pub initial: Initial,
    /// Phase of the drive there, rad.
    pub phase: f64,
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
    let together = |i: &Initial| machine.y.is_none() || (i.x == i.y && i.vx == i.vy);
    match UnitMass::of(machine) {
        Some(unit) if starts.iter().all(|s| together(&s.initial)) => {
            let cells: Vec<Cell> = starts.iter().map(|s| unit.cell(s)).collect();
            let mut outcomes = march_all(&unit.course(settings), &cells, settings.kernel);
            watch_again(&unit, &mut outcomes, settings);
            if patience::is_over() {
                Err(ModelError::GivenUp)
            } else {
                Ok(outcomes.iter().map(|o| unit.end(o)).collect())
            }
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

/// A start moved back to the contact where it is beyond, each mass by its mobility.
pub(super) fn clear_of(machine: &Machine, rho: f64, mut start: Initial) -> Initial {
    if machine.y.is_none() {
        (start.y, start.vy) = (0.0, 0.0);
    }
    let (mx, my) = machine.mobility();
    let depth = (start.x + start.y - machine.gap(rho)).max(0.0);
    (start.x, start.y) = (start.x - mx * depth, start.y - my * depth);
    start
}

/// A machine that is one mass of unit frequency, mass and drive in scaled quantities:
/// η' = η/Ω, lengths in units of (drive per mass)/Ω².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnitMass {
    oscillator: Oscillator,
    restitution: f64,
}

impl UnitMass {
    /// `None` where the machine does not reduce to one mass with constant R.
    pub fn of(machine: &Machine) -> Option<Self> {
        let reduces = machine.y.is_none() || machine.is_symmetric();
        let restitution = machine.restitution().constant()?;
        let driven = machine.x.drive_amplitude > 0.0;
        (reduces && driven && machine.flight == Flight::Harmonic).then_some(Self {
            oscillator: machine.x,
            restitution,
        })
    }

    /// Length and rate by which the quantities are scaled.
    pub fn scales(&self) -> (f64, f64) {
        let o = &self.oscillator;
        (
            o.drive_per_mass() / o.stiffness_per_mass(),
            o.natural_frequency_ratio,
        )
    }

    /// The machine in the scaled quantities: one nominal mass against a stop.
    pub(super) fn machine(&self) -> Machine {
        Machine::single(self.oscillator.damping_ratio, self.restitution)
    }

    /// A cell in the scaled quantities.
    pub fn cell(&self, s: &Start) -> Cell {
        let (length, rate) = self.scales();
        Cell {
            eta: s.at.0 / rate,
            rho: s.at.1 / length,
            x: s.initial.x / length,
            v: s.initial.vx / (length * rate),
            phase: s.phase,
        }
    }

    /// Where an outcome ended, in the machine's own quantities.
    pub(super) fn end(&self, o: &Outcome) -> End {
        let (length, rate) = self.scales();
        let initial = Initial::both(o.end.x * length, o.end.v * length * rate);
        End {
            motion: o.motion,
            initial,
            phase: o.end.phase,
        }
    }

    /// The course of a map.
    pub fn course(&self, settings: &MapSettings) -> Course {
        Course {
            damping_ratio: self.oscillator.damping_ratio,
            restitution: self.restitution,
            settle_periods: settings.watch.settle_periods,
            watch_periods: settings.watch.watch_periods,
            leave_early: settings.leave_early,
            tight: 1e-11,
            loose: settings.watch.tolerance,
            every_impact: false,
        }
    }
}

/// Cells shared by the threads, each of which takes the next.
#[derive(Clone)]
pub(super) struct Shared<'a> {
    cells: &'a [Cell],
    next: &'a AtomicUsize,
    block: std::ops::Range<usize>,
}

/// Cells a thread takes at a time.
const BLOCK: usize = 8;

impl Shared<'_> {
    /// A cell that no thread has taken; none once nobody wants them.
    pub(super) fn take(&mut self) -> Option<(usize, Cell)> {
        if self.block.is_empty() {
            if patience::is_over() {
                return None;
            }
            let first = self.next.fetch_add(BLOCK, Ordering::Relaxed);
            self.block = first..(first + BLOCK).min(self.cells.len());
        }
        self.block.next().map(|i| (i, self.cells[i]))
    }
}

/// A thread's march, and what became of its cells.
struct March<'a> {
    cells: Shared<'a>,
    done: Vec<(usize, Outcome)>,
}

impl Feed for March<'_> {
    fn next(&mut self) -> Option<(usize, Cell)> {
        self.cells.take()
    }
    fn done(&mut self, index: usize, outcome: Outcome) {
        self.done.push((index, outcome));
    }
}

/// March cells on all threads of the pool; outcomes in the cells' order.
pub fn march_all(course: &Course, cells: &[Cell], kernel: Option<Kernel>) -> Vec<Outcome> {
    let kernel = available(kernel);
    on_all_threads(cells, |shared| {
        let mut march = March {
            cells: shared,
            done: Vec::new(),
        };
        run(kernel, course, &mut march);
        march.done
    })
}

/// The kernel that is asked for, or the widest where it is not to be had.
pub(super) fn available(kernel: Option<Kernel>) -> Kernel {
    kernel
        .filter(|k| k.is_available())
        .unwrap_or_else(Kernel::of_this_machine)
}

/// What becomes of cells that all threads share, in the cells' order.
pub(super) fn on_all_threads<T: Send + Clone>(
    cells: &[Cell],
    march: impl Fn(Shared<'_>) -> Vec<(usize, T)> + Sync,
) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let shared = Shared {
        cells,
        next: &next,
        block: 0..0,
    };
    let workers: Vec<usize> = (0..parallel::threads()).collect();
    let mut all = parallel::map(&workers, |_| march(shared.clone())).concat();
    all.sort_unstable_by_key(|p| p.0);
    all.into_iter().map(|p| p.1).collect()
}
