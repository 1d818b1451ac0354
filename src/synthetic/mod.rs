//! A virtual laboratory: campaigns simulated with a known truth and with the faults of a real
//! rig, as the same [`Record`](impact_records::record::Record)s that a real campaign gives. They test
//! detector, classifier and identification alike, and are always labelled as synthetic.

pub mod acquisition;
pub mod effects;
pub mod engine;
mod equations;
mod integrate;
pub mod laboratory;
pub mod plan;
pub mod rig;
pub mod rig_spec;
pub mod run;
mod settled;
pub mod truth;

#[cfg(test)]
mod tests;

pub use effects::Effects;
pub use laboratory::{Laboratory, Reach, draw};
pub use plan::{Plan, Step};
pub use rig_spec::{Effect, RigError, RigSpec};
pub use run::{RawChannel, RawRecord, blocks, records};
pub use truth::{Differences, Faults, TrueImpact, TrueMass, Truth};
