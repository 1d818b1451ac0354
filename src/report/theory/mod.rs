//! Figures of the theory alone: motions, characteristics, basins, regions.

pub mod basins;
mod keys;
pub mod motion;
pub mod regions;
pub mod sweep;
