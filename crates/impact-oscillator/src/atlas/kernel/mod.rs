//! The marching kernel: one cell of a map per lane, each lane at its own time, a lane refilled
//! as soon as its cell is done. Same safe step as `model::crossing`, written for vectors.
//!
//! One mass of unit frequency, mass and drive against a stop at ρ (the symmetric double
//! oscillator's x = U/2), constant R. Impacts are applied by masks; the loop branches only for
//! a cell that is done, a mass that comes to rest at the stop and an orbit that recurs.
//!
//! `cell` is what goes in and comes out, `march` the loop, `step` what it does to all lanes at once, `lane` loads a cell into a
//! lane, `exits` serves a lane that raised an event, `dispatch` chooses the instruction set.

mod cell;
mod dispatch;
mod exits;
mod lane;
mod march;
mod step;

pub use cell::{Cell, Course, Outcome};
pub(super) use cell::{Feed, Strike};
pub use dispatch::Kernel;
pub(super) use dispatch::run;
