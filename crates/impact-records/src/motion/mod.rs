//! Types of motion z = p/n (p impacts in n drive periods), each with its evidence. This module uses
//! no parameter of the model.

mod alternation;
mod aperiodic;
mod bracket;
mod classify;
mod closure;
mod fold;
mod force_law;
mod harmonics;
mod inverted;
mod kind;
mod late;
mod late_channel;
mod no_decay;
mod observation;
mod response;
mod settling;
mod undetermined;

pub use bracket::{BoundaryKind, Bracket, brackets};
pub use classify::{Classification, ClassifySettings, MotionEvidence, classify};
pub use fold::{Folded, FoldedChannel, FoldedPoint};
pub use force_law::ForceLaw;
pub use inverted::{inverted_channels, turned_channels};
pub use kind::Motion;
pub use late::{late_channels, one_pole_hz};
pub use late_channel::LateChannel;
pub use observation::{
    Amplitude, Observation, follow_force_law, observe, scale_drives, state_drives,
};
pub use response::Response;
pub use undetermined::Undetermined;
