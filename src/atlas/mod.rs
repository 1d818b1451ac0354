//! Many simulations: region maps over (η, ρ), diagrams, basins. This room knows no files.

pub mod basins;
pub mod brute;
pub mod continuation;
pub mod kernel;
pub mod lanes;
pub mod lyapunov;
pub mod map;
pub mod regions;
pub mod resting;
pub mod shard;
pub mod sweep;

pub use map::{CellMotion, MapGrid, MapSettings, RegionMap, region_map};
pub use regions::{Atlas, AtlasSettings, Curve, atlas};

#[cfg(test)]
mod tests;
