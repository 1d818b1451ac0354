//! Identification: parameters fitted to what was measured, with uncertainty and a verdict.
//!
//! The result is plain data ([`Identification`]), written as `identification.json`. [`run`] leads from
//! [`evidence`] over [`methods`] (what was measured, as residuals of the model, and fits of it by [`solver`]) to
//! [`uncertainty`] and [`diagnostics`] (does the model fit, do the methods agree, was there a mistake). What it states is typed
//! ([`messages`]); sentences are made when it is printed.

pub mod boundary_plan;
pub mod diagnostics;
pub mod estimate;
pub mod evidence;
mod first_values;
#[cfg(test)]
mod fixture;
mod identification;
pub mod messages;
pub mod method;
pub mod method_fit;
pub mod methods;
pub mod parameters;
pub mod plan;
pub mod published;
pub mod replay;
pub mod residuals;
pub mod results;
pub mod run;
pub mod solver;
pub mod specimens;
pub mod statistics;
pub mod uncertainty;
mod widening;

pub use estimate::{Estimate, ParameterSet, Status};
pub use identification::{Identification, Provenance, SpecimenResult};
pub use messages::{Finding, Item, LeftOut, Note, PairAgreement, Reason, Remark, Sentence};
pub use method::{Estimator, Method};
pub use methods::answer::{Agreement, Allowed, JointFit, MethodResult, Verdict, VerdictKind};
pub use parameters::GAIN_ROLES;
pub use parameters::effect::Effect;
pub use specimens::identify_campaign;
