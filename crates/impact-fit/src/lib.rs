//! The model of an impact oscillator fitted to what was observed: by each method of identification alone, and by
//! all together.
//!
//! [`parameters`] are the coordinates of a fit, with the effects beyond the model. A method states what it
//! observes as a block of residuals ([`solver::Block`]), which [`solver`] minimises; [`methods`] has a folder for each
//! and the joint fit of all. [`evidence`] is what a fit starts from. What a fit states is typed ([`messages`]).
//! What follows from the fits (uncertainty, diagnostics, the verdict) is in `impact-identification`.
//!
//! Records of a simulated rig whose masses never touch have a resonance curve, which determines f0:
//!
//! ```
//! use impact_fit::evidence::{Evidence, Nominal};
//! use impact_fit::methods::selection::Selection;
//! use impact_records::event::{DetectSettings, RigKind};
//! use impact_records::motion::{ClassifySettings, observe};
//! use impact_records::record::Sweep;
//! use simulated_rig::run::calibrated;
//! use simulated_rig::{Faults, Laboratory, Plan, RigEffects, Step, Truth, records};
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
//! let evidence = Evidence {
//!     rig: RigKind::Double,
//!     observations: &observations,
//!     brackets: &[],
//!     nominal: Nominal { gain_uncertainty: 5e-3, corner_uncertainty: 2e-2, ..Nominal::default() },
//!     uncertainty: Default::default(),
//!     progress: None,
//! };
//! let mut selection = Selection::new(&evidence);
//! let curve = selection.fit_resonance().expect("records without impacts")?;
//! assert!((curve.fit.parameters.natural_frequency_hz - 12.0).abs() < 0.05);
//! assert!(curve.fit.cost.is_finite());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod estimate;
pub mod evidence;
pub mod messages;
pub mod method;
pub mod method_fit;
pub mod methods;
pub mod parameters;
pub mod solver;
pub mod statistics;

pub use estimate::{Estimate, ParameterSet, Status};
pub use messages::{Finding, Item, LeftOut, Note, PairAgreement, Reason, Remark, Sentence};
pub use method::{Estimator, Method};
pub use methods::answer::{Agreement, Allowed, JointFit, MethodResult, Verdict, VerdictKind};
pub use parameters::GAIN_ROLES;
pub use parameters::effect::Effect;

#[cfg(any(test, feature = "fixture"))]
pub mod fixture;

/// The examples of the README, checked as the others are.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
