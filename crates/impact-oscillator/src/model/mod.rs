//! The impact oscillator itself, dimensionless: exact flights between impacts, impacts by
//! Newton's law, dead zones, periodic orbits and their boundaries.
//!
//! Dimensionless quantities as in Peterka's paper: X = x/x_st, τ = Ωt, η = ω/Ω, ρ = r/x_st;
//! docs/theory.md has the numbered equations that the code cites. This room knows no files.

pub mod boundary;
pub mod contact;
pub mod crossing;
pub mod flight;
pub mod orbit;
pub mod params;
pub mod path;
pub mod periodic;
pub mod perturbation;
pub mod recurrence;
pub mod restitution;
pub mod sensitivity;
pub mod simulate;
pub mod soft;
pub mod variation;

pub use boundary::{BoundaryPoint, eta_s2, rho_grazing, rho_s1, rho_s2};
pub use contact::{ImpactKind, ModelImpact};
pub use orbit::{Existence, Orbit};
pub use params::{Contact, Flight, Initial, Machine, ModelError, Oscillator, Restitution, Setting};
pub use periodic::PeriodicOrbit;
pub use recurrence::{SettledMotion, Watch, settle};
pub use simulate::{Simulator, Trajectory, simulate};

#[cfg(test)]
mod accuracy;
#[cfg(test)]
mod invariants;
#[cfg(test)]
mod tests;
