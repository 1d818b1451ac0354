//! A cell of a march, what all cells share, and what becomes of a cell.

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
    /// Watch from the start, to the end, and hand over every impact; nothing is recognised.
    pub every_impact: bool,
}

/// An impact of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::atlas) struct Strike {
    /// Time since the cell's start.
    pub(in crate::atlas) t: f64,
    /// x' after it.
    pub(in crate::atlas) v_after: f64,
}

/// Source of cells and receiver of outcomes.
pub(in crate::atlas) trait Feed {
    /// The next cell with its number, until there is none.
    fn next(&mut self) -> Option<(usize, Cell)>;
    /// A cell is done.
    fn done(&mut self, index: usize, outcome: Outcome);
    /// A cell has an impact, where [`Course::every_impact`] asks for them.
    fn impact(&mut self, _index: usize, _strike: Strike) {}
    /// The mass of a cell comes to rest at the stop.
    fn rests(&mut self, _index: usize) {}
}
