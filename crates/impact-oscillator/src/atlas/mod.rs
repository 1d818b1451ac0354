//! Many simulations: region maps over (η, ρ), sweeps, basins, and the atlas of all motions.

mod agreement;
pub mod basins;
mod brute;
pub mod coexisting;
mod continuation;
pub mod curves;
mod edge;
mod grid;
pub mod kernel;
mod lanes;
mod line;
mod lyapunov;
pub mod map;
mod points;
pub mod portrait;
pub mod regions;
mod release;
mod resting;
mod settings;
mod settling;
pub mod shard;
pub mod sweep;
mod threads;
mod unit_mass;
mod watched;

pub use agreement::{Agreement, Cause, Differing};
pub use basins::{BasinGrid, Basins, Starts, basins};
pub use brute::{Maps, Seeding, brute_maps, carried_maps};
pub use curves::Curve;
pub use edge::{Edge, EdgeKind};
pub use line::Slice;
pub use lyapunov::Lyapunov;
pub use map::{MapGrid, MapSettings, RegionMap, region_map};
pub use points::{At, Boundary, BoundaryQuery, Point, boundary_points};
pub use regions::{Atlas, atlas};
pub use resting::RestingSlice;
pub use settings::AtlasSettings;
pub use sweep::{Sweep, SweepPoint, sweep};

#[cfg(test)]
mod tests;
