//! The marching kernel: one cell of a map per lane, each lane at its own time, a lane refilled
//! as soon as its cell is done. Same safe step as `model::crossing`, written for vectors.
//!
//! One mass of unit frequency, mass and drive against a stop at ρ (the symmetric double
//! oscillator's x = U/2), constant R. Impacts are applied by masks; the loop branches only for
//! a cell that is done, a mass that comes to rest at the stop and an orbit that recurs.
//!
//! `march` is the loop, `step` what it does to all lanes at once, `lane` loads a cell into a
//! lane, `exits` serves a lane that raised an event, `dispatch` chooses the instruction set.

mod dispatch;
mod exits;
mod lane;
mod march;
mod step;

pub use dispatch::{Kernel, run};
pub use march::march;

use crate::model::SettledMotion;

/// One cell: where and from what start the motion is marched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// η
    pub eta: f64,
    /// ρ
    pub rho: f64,
    /// x at the start; at most ρ.
    pub x: f64,
    /// x' at the start.
    pub v: f64,
    /// Phase of the drive at the start, rad.
    pub phase: f64,
}

/// What became of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// The motion it settled on.
    pub motion: SettledMotion,
    /// The state at its end, by which a neighbour can be started.
    pub end: Cell,
}

/// What all cells of a march share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// β, 0 ≤ β < 1.
    pub damping_ratio: f64,
    /// R, 0 ≤ R ≤ 1.
    pub restitution: f64,
    /// Drive periods before the watch.
    pub settle_periods: f64,
    /// Drive periods watched.
    pub watch_periods: f64,
    /// Leave a cell when no impact can come again, or when its orbit recurs.
    pub leave_early: bool,
    /// Closure by which an orbit recurs while settling.
    pub tight: f64,
    /// Closure by which an orbit recurs in the watch.
    pub loose: f64,
}

/// Source of cells and receiver of outcomes.
pub trait Feed {
    /// The next cell with its number, until there is none.
    fn next(&mut self) -> Option<(usize, Cell)>;
    /// A cell is done.
    fn done(&mut self, index: usize, outcome: Outcome);
}
