//! Theory of the impact oscillator.
#![warn(
    unreachable_pub,
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    clippy::missing_errors_doc,
    clippy::missing_panics_doc
)]

pub mod atlas;
pub mod model;
mod parallel;

pub use atlas::{MapGrid, MapSettings, region_map};
pub use model::{
    Flight, Impact, ImpactKind, Initial, Machine, ModelError, Orbit, Oscillator, PeriodicOrbit,
    Restitution, Setting, SettledMotion, Simulator, Trajectory, Watch, eta_s2, periodic_label,
    rho_grazing, rho_s1, rho_s2, settle, simulate,
};
