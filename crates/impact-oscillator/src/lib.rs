//! Exact simulation, periodic orbits, boundaries and region maps of impact oscillators: two
//! driven masses on springs that hit each other when their displacements fill the gap (Peterka's
//! double impact oscillator), or one mass against a stop.
//!
//! Everything is dimensionless: displacement X = `x/x_st` in units of the static deflection
//! `x_st` = F0/k, time τ = Ωt, frequency ratio η = ω/Ω, clearance ρ = `r/x_st`, damping ratio
//! β = b/(2√(km)), coefficient of restitution R; the drive is cos(ητ + φ). Speeds are in units of
//! `x_st` Ω. The approach speed at an impact is w = X'₋ + Y'₋ (X'₋ against a stop), the separation
//! speed after it Rw. A motion z = p/n has p impacts in n drive periods.
//!
//! Between impacts a motion is a closed form, and the next impact is found by steps that cannot
//! pass one, so there is no integration error and no missed impact ([`simulate`], [`Simulator`]).
//! Orbits with one impact per period and their saddle-node, period-doubling and grazing
//! boundaries are closed forms too ([`rho_s2`], [`rho_s1`], [`rho_grazing`]); all others are found
//! by Newton's method and followed by continuation ([`PeriodicOrbit`], [`atlas::atlas`]).
//! [`model`] is one oscillator, [`atlas`] runs many: region maps, sweeps, basins of attraction.
//!
//! ```
//! use impact_oscillator::{
//!     Initial, Machine, MapGrid, MapSettings, Setting, region_map, rho_s2, simulate,
//! };
//!
//! // two equal masses with β = 0.07 and R = 0.9, driven at η = 1.3 with the clearance ρ = 1
//! let machine = Machine::symmetric(0.07, 0.9);
//! let setting = Setting::new(1.3, 1.0);
//!
//! // 300 drive periods from rest: the motion settles on z = 1, one impact per drive period
//! let motion = simulate(&machine, setting, Initial::rest(), 300.0 * setting.period())?;
//! let [.., before, last] = motion.impacts.as_slice() else { unreachable!() };
//! assert!((last.tau - before.tau - setting.period()).abs() < 1e-6);
//! assert!((last.separation_speed / last.approach_speed - 0.9).abs() < 1e-12);
//!
//! // z = 1 exists up to its saddle-node
//! let s2 = rho_s2(&machine, 1.3, 1).expect("a saddle-node");
//! assert!((s2.rho - 4.151_754).abs() < 1e-6);
//!
//! // so brute force finds it below, and z = 0 above
//! let grid = MapGrid::even((1.3, 1.3, 1), (1.0, 4.2, 2));
//! let map = region_map(&machine, &grid, &MapSettings::default())?;
//! assert_eq!(map.at(0, 0).label(), "1");
//! assert_eq!(map.at(0, 1).label(), "0");
//! # Ok::<(), impact_oscillator::ModelError>(())
//! ```
//!
//! Equation numbers in round brackets are those of `docs/theory.md` in the repository, which also
//! names the paper.
//!
//! # Features
//! `rayon` (default): region maps, basins and atlases use all threads of the current rayon pool.
//! Results are the same bytes with any number of threads and without the feature.

pub mod atlas;
pub mod model;
mod parallel;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use model::patience::Patience;

pub use atlas::{MapGrid, MapSettings, region_map};
pub use model::{
    BoundaryPoint, Existence, Flight, Impact, ImpactKind, Initial, Machine, ModelError, Orbit,
    Oscillator, PeriodicOrbit, Restitution, Setting, SettledMotion, Simulator, Trajectory, Watch,
    eta_s2, periodic_label, rho_grazing, rho_s1, rho_s2, settle, simulate,
};
