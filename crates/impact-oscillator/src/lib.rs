//! Theory of the impact oscillator: two masses on springs, driven toward each other, that hit
//! when their displacements fill the gap (Peterka's double impact oscillator), or one mass
//! against a stop.
//!
//! [`model`] is one oscillator: exact flights, impacts, periodic orbits and their boundaries.
//! [`atlas`] runs many: region maps over (η, ρ), diagrams, basins.

pub mod atlas;
pub mod model;
mod motion;

pub use motion::Motion;
