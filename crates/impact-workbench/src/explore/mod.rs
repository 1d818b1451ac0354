//! The live explorer: a page in the browser, served on loopback, on which the regions of motion, the
//! motion at a cursor, characteristics, basins and a campaign's records follow the parameters at once.
//!
//! It computes nothing of its own: `impact_oscillator`, `identify`, `compare` and the studies of
//! `pipeline::theory` do. The page sends its whole [`State`] with every request, so that the server keeps
//! none: the same state is the page's address, a step of a demo and, as TOML, a study.

mod answer;
mod beside;
mod campaign;
mod check;
mod demo;
mod error;
mod evidence;
mod export;
mod first_tiles;
mod first_view;
mod frame;
mod job;
mod jobs;
mod limits;
mod maps;
mod motions;
mod pools;
mod server;
mod session;
mod state;
mod stop;
mod wire;

pub use campaign::OpenCampaign;
pub use check::check;
pub use error::ExploreError;
pub use server::Server;
pub use session::Session;
pub use state::State;

#[cfg(test)]
mod tests;
