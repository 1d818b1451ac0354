//! One oscillator, dimensionless: exact flights between impacts, impacts by Newton's law, dead
//! zones, periodic orbits and their boundaries.
//!
//! Quantities as in Peterka's paper: X = `x/x_st`, τ = Ωt, η = ω/Ω, ρ = `r/x_st`. Equation numbers in
//! round brackets are those of `docs/theory.md` in the repository.

pub mod boundary;
pub(crate) mod contact;
mod crossing;
mod error;
pub mod flight;
pub(crate) mod motion;
pub mod orbit;
pub mod params;
pub mod path;
pub mod patience;
pub mod periodic;
pub mod perturbation;
pub(crate) mod recurrence;
mod restitution;
pub mod sensitivity;
pub mod simulate;
pub mod soft;
pub mod variation;

pub use boundary::{BoundaryPoint, eta_s2, rho_grazing, rho_s1, rho_s2};
pub use contact::{Impact, ImpactKind};
pub use error::range;
pub use motion::{SettledMotion, periodic_label};
pub use orbit::{Existence, Orbit};
pub use params::{Contact, Flight, Initial, Machine, ModelError, Oscillator, Restitution, Setting};
pub use periodic::PeriodicOrbit;
pub use recurrence::{Watch, settle};
pub use simulate::{Simulator, Trajectory, simulate};

#[cfg(test)]
mod accuracy;
#[cfg(test)]
mod invariants;
#[cfg(test)]
mod tests;
