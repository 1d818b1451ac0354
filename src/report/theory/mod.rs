//! Figures of the theory alone: motions, characteristics, basins, regions.

pub(crate) mod basins;
mod keys;
pub(crate) mod motion;
pub(crate) mod regions;
pub(crate) mod sweep;
