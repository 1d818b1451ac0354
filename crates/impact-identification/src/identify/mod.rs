//! Identification: parameters fitted to what was measured, with uncertainty and a verdict.
//!
//! The result is plain data ([`Identification`]), written as `identification.json`. [`run`] leads from
//! [`evidence`] (what was measured, as residuals of the model) over [`fit`] (least squares) to
//! [`uncertainty`] and [`diagnostics`] (does the model fit, do the methods agree, was there a mistake). What it states is typed
//! ([`messages`]); sentences are made when it is printed.

pub mod boundary_plan;
pub mod bracket_midpoints;
pub mod decay;
pub mod diagnostics;
pub mod estimate;
pub mod evidence;
mod first_values;
pub mod fit;
#[cfg(test)]
mod fixture;
pub mod flight_times;
mod identification;
pub mod joint;
pub mod messages;
pub mod method;
pub mod method_fit;
pub mod methods;
pub mod plan;
pub mod published;
pub mod replay;
pub mod residuals;
pub mod results;
pub mod run;
pub mod selection;
pub mod specimens;
mod starts;
pub mod uncertainty;

pub use estimate::{Estimate, ParameterSet, Status};
pub use fit::effect::Effect;
pub use fit::parameters::GAIN_ROLES;
pub use identification::{
    Agreement, Allowed, Identification, JointFit, MethodResult, Provenance, SpecimenResult,
    Verdict, VerdictKind,
};
pub use messages::{Finding, Item, LeftOut, Note, PairAgreement, Reason, Remark, Sentence};
pub use method::{Estimator, Method};
pub use specimens::identify_campaign;
