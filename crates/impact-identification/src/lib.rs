//! The coefficient of restitution R, the natural frequency f0 and the damping ratio β of an impact
//! oscillator from its records, each with a 95 % interval, and whether the model describes the rig.
//!
//! [`identify`] fits what was observed by several methods and together. [`compare`] says what changed
//! between campaigns and what they share. [`replay`] simulates the fitted model beside the records.
//! Results are typed; sentences are made where they are printed. Nothing is drawn and no file is read.
//!
//! Records of a simulated rig whose masses never touch determine f0, β and `x_st`, but not R:
//!
//! ```
//! use impact_records::event::{DetectSettings, RigKind};
//! use impact_fit::evidence::{Evidence, Nominal};
//! use impact_identification::identify::run::identify;
//! use impact_fit::{Method, Status};
//! use impact_records::motion::{ClassifySettings, observe};
//! use impact_records::record::Sweep;
//! use simulated_rig::run::calibrated;
//! use simulated_rig::{RigEffects, Faults, Laboratory, Plan, Step, Truth, records};
//!
//! let step = |i: u32| Step {
//!     frequency_hz: 9.0 + 0.5 * f64::from(i),
//!     clearance_m: 20e-3,
//!     sweep: Sweep::Up,
//!     from_rest: i == 0,
//! };
//! let laboratory = Laboratory {
//!     truth: Truth::symmetric(0.8, 12.0, 0.05, 1e-3),
//!     faults: Faults::default(),
//!     effects: RigEffects::default(),
//!     clearance_uncertainty_m: None,
//!     plan: Plan { steps: (0..14).map(step).collect() },
//!     rig_seed: 1,
//!     seed: 1,
//! };
//! let observations: Vec<_> = records(&laboratory)?
//!     .iter()
//!     .map(|raw| calibrated(raw, &laboratory.truth, &laboratory.faults))
//!     .map(|record| {
//!         let (detect, classify) = (DetectSettings::default(), ClassifySettings::default());
//!         observe(&record, RigKind::Double, &detect, &classify)
//!     })
//!     .collect();
//! let found = identify(&Evidence {
//!     rig: RigKind::Double,
//!     observations: &observations,
//!     brackets: &[],
//!     nominal: Nominal { gain_uncertainty: 5e-3, corner_uncertainty: 2e-2, ..Nominal::default() },
//!     uncertainty: Default::default(),
//!     progress: None,
//! });
//! assert_eq!(found.used_by[&Method::Resonance].len(), 14);
//! let f0 = found.joint.parameters.natural_frequency_hz.as_ref().expect("an estimate");
//! assert_eq!(f0.status, Status::Identified);
//! assert!((f0.value.expect("f0") - 12.0).abs() < 0.05);
//! let r = found.joint.parameters.restitution.and_then(|r| r.value);
//! assert_eq!(r, None);
//! # Ok::<(), impact_oscillator::model::params::ModelError>(())
//! ```

pub mod compare;
pub mod identify;
pub mod replay;

/// The examples of the README, checked as the others are.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
