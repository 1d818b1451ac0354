//! Many simulations: region maps over (η, ρ), diagrams, basins. This room knows no files.

pub mod kernel;
pub mod lanes;
pub mod map;

pub use map::{CellMotion, MapGrid, MapSettings, RegionMap, region_map};

#[cfg(test)]
mod tests;
