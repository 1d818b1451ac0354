//! Simulated campaigns on an impact oscillator, with known truth and with the faults of a real rig.
//!
//! A [`Laboratory`] is the truth, the rig's faults and effects beyond the ideal model, and the plan of
//! settings; [`records`] acquires it: the same [`Record`](impact_records::record::Record)s that a real
//! campaign gives. Detection, classification and identification are tested with them. Effects without a
//! closed form are integrated numerically; the same seed gives the same bytes on any number of threads.
//!
//! ```
//! use impact_records::record::Sweep;
//! use simulated_rig::run::calibrated;
//! use simulated_rig::{RigEffects, Faults, Laboratory, Plan, Step, Truth, records};
//!
//! let step = |i: u32| Step {
//!     frequency_hz: 9.0 + 0.5 * f64::from(i),
//!     clearance_m: 2e-3,
//!     sweep: Sweep::Up,
//!     from_rest: i == 0,
//! };
//! let laboratory = Laboratory {
//!     // R, f0 in Hz, β and x_st in m
//!     truth: Truth::symmetric(0.8, 12.0, 0.05, 1e-3),
//!     faults: Faults::default(),
//!     effects: RigEffects::default(),
//!     clearance_uncertainty_m: None,
//!     plan: Plan { steps: (0..4).map(step).collect() },
//!     rig_seed: 1,
//!     seed: 1,
//! };
//! let raw = records(&laboratory)?;
//! assert_eq!(raw.len(), 4);
//! let record = calibrated(&raw[3], &laboratory.truth, &laboratory.faults);
//! assert_eq!(record.setting.stated_frequency_hz, Some(10.5));
//! # Ok::<(), impact_oscillator::ModelError>(())
//! ```

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

pub use effects::RigEffects;
pub use laboratory::{Laboratory, Reach, draw};
pub use plan::{Plan, Step};
pub use rig_spec::{Effect, RigError, RigSpec};
pub use run::{RawChannel, RawRecord, blocks, records};
pub use truth::{Differences, Faults, TrueImpact, TrueMass, Truth};

/// The examples of the README, checked as the others are.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
