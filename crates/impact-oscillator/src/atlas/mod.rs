//! Many simulations: region maps over (η, ρ), diagrams, basins. This room knows no files.

pub mod agreement;
pub mod basins;
pub mod brute;
pub mod continuation;
pub mod curves;
pub mod kernel;
pub mod lanes;
pub mod line;
pub mod lyapunov;
pub mod map;
pub mod portrait;
pub mod regions;
pub mod release;
pub mod resting;
pub mod shard;
pub mod sweep;

pub use curves::Curve;
pub use map::{CellMotion, MapGrid, MapSettings, RegionMap, region_map};
pub use regions::{Atlas, AtlasSettings, atlas};

#[cfg(test)]
mod tests;
