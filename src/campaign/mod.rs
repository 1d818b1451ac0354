//! campaign.toml: as written ([`written`]), then resolved ([`resolved`]) with every default made
//! explicit, or every fault at once ([`faults`]).

pub mod faults;
pub mod read;
pub mod written;
