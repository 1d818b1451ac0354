//! Identification: parameters fitted to what was measured, with uncertainty and a verdict.
//!
//! The result is plain data ([`Identification`]), written as `identification.json`. [`run`] leads from what was
//! observed over the methods' fits (`impact-fit`) to [`uncertainty`] and [`diagnostics`] (does the model fit, do the
//! methods agree, was there a mistake).

pub mod boundary_plan;
pub mod diagnostics;
mod first_values;
mod identification;
pub mod plan;
pub mod published;
pub mod replay;
pub mod residuals;
mod restated;
pub mod results;
pub mod run;
pub mod specimens;
pub mod uncertainty;
mod widening;

pub use identification::{Identification, Provenance, SpecimenResult};
pub use specimens::identify_campaign;
