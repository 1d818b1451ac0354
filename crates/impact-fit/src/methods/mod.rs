//! The methods of identification, a folder each: the block of residuals, which records it rests on, its fit and
//! its result. [`registry::REGISTRY`] lists them in the order in which they depend on each other; a run is a loop over it.
//!
//! What they have in common: all blocks of a campaign ([`blocks`]), the selection of records ([`selection`]), a
//! fit of some blocks ([`fit`]) and of all ([`joint`]), what was found so far ([`fits`]).

pub mod answer;
pub mod blocks;
pub mod boundaries;
pub mod decays;
pub mod fit;
pub mod fits;
pub mod flight_times;
pub mod flights;
mod groups;
pub mod identifier;
pub mod impacts;
pub mod influence;
pub mod joint;
pub mod published;
pub mod registry;
pub mod resonance;
pub mod selection;
pub mod thinning;
pub mod trajectories;
pub mod weighing;
