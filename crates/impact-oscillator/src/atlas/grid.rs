//! Grids of (η, ρ), how they are marched, and what a cell starts from and settles on.

use serde::{Deserialize, Serialize};

use super::kernel::Kernel;
use crate::model::{Initial, Machine, SettledMotion, Watch};

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
