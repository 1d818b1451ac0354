//! Differences between campaigns: what changed of R, f0, β and `x_st`, with intervals in which the errors
//! that campaigns have in common cancel instead of adding.
//!
//! Each joint fit of campaign k is, at its optimum, a Gaussian of its coordinates: parameters and
//! nuisances (gains, corners, delays, errors of clearances, asymmetries, effects) with the information
//! `A_k` = `Λ_k` + `P_k`, the likelihood's and the priors'. A nuisance that campaigns share is one unknown with
//! one prior, so that all of them together have the information
//!
//! A = `Σ_k` `Λ_k` + P                                                                           (21)
//!
//! with one row for each nuisance that is shared; shared clearances enter by their logarithms (module
//! `chart`). Its inverse holds the correlation between the campaigns'
//! parameters, from which the differences follow. What the intervals of each campaign allow for beyond
//! its covariance (scatter between groups, first order of the effects, disagreement of methods) is taken
//! as independent: that is wider, never narrower.

mod campaign;
mod chart;
mod common;
mod comparison;
mod decision;
mod message;
mod share;
mod stack;

#[cfg(test)]
mod tests;

pub use campaign::Campaign;
pub use common::Common;
pub use comparison::{
    Comparison, ComparisonError, ComparisonSummary, Difference, EqualityTest, compare,
};
pub use message::{ComparisonOutcome, ComparisonRemark, NotShared, WhyShared, kinds};
pub use share::{AcrossCampaigns, SeparateNuisance, SharedNuisance};
