//! campaign.toml: as written ([`written`]), then resolved ([`resolved`]) with every default made
//! explicit, or every fault at once ([`faults`]).

mod channels;
pub mod check;
pub mod faults;
pub mod guess;
mod listing;
mod names;
mod quantity;
pub mod read;
mod records;
mod resolve;
pub mod resolved;
mod run_table;
mod settings;
pub mod template;
pub mod written;

pub use listing::Opener;
pub use resolve::{Outcome, load};
