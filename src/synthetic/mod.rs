//! A virtual laboratory: campaigns simulated with a known truth and with the faults of a real
//! rig, as the same [`Record`](crate::record::Record)s that a real campaign gives. They test
//! detector, classifier and identification alike, and are always labelled as synthetic.

pub mod acquisition;
pub mod draw;
pub mod effects;
pub mod engine;
mod equations;
mod integrate;
pub mod plan;
pub mod rig;
pub mod run;
pub mod truth;

pub use draw::{Draw, Reach, draw};
pub use effects::{Effect, Effects, RigError, RigSpec};
pub use plan::{Plan, Step};
pub use run::{Laboratory, RawChannel, RawRecord, TrueImpact, blocks, records};
pub use truth::{Faults, Truth};
