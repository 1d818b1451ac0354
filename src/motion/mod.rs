//! Types of motion z = p/n (p impacts in n drive periods), each with its evidence. This room
//! sees no parameter of the model.

pub mod aperiodic;
pub mod bracket;
pub mod classify;
pub mod closure;
pub mod fold;
pub mod kind;
pub mod observation;
pub mod response;

pub use bracket::{BoundaryKind, Bracket, brackets};
pub use classify::{Classification, ClassifySettings, Evidence, classify};
pub use kind::Motion;
pub use observation::{Observation, observe, scale_drives};
