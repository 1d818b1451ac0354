//! Types of motion z = p/n (p impacts in n drive periods), each with its evidence. This module uses
//! no parameter of the model.
//!
//! Times become sample indices by `as usize`, which saturates (negative and NaN give 0); an index is
//! bounded by the number of samples before it is used.

mod aperiodic;
mod bracket;
mod classify;
mod closure;
mod fold;
mod kind;
mod observation;
mod response;

pub use bracket::{BoundaryKind, Bracket, brackets};
pub use classify::{Classification, ClassifySettings, Evidence, classify};
pub use fold::{Folded, FoldedChannel, FoldedPoint};
pub use kind::Motion;
pub use observation::{Amplitude, Observation, observe, scale_drives};
pub use response::Response;
