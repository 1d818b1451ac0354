//! Distributions and their quantiles, and what the scatter between groups of observations adds to an error.

pub mod distribution;
pub mod quantile;
pub mod scatter;
pub mod shared_gains;
pub mod weighted;
