//! campaign.toml: as written ([`written`]), then resolved ([`resolved`]) with every default made
//! explicit, or every problem at once ([`diagnostic`]).

mod channels;
pub mod check;
mod context;
pub mod diagnostic;
mod discovery;
pub mod infer;
mod named_files;
mod names;
mod read;
mod records;
mod resolve;
pub mod resolved;
mod rig;
mod run_table;
mod settings;
pub(crate) mod slashes;
pub mod sources;
pub mod template;
pub mod written;

pub use discovery::{Opener, Taken};
pub use named_files::NamedFiles;
pub use read::nearest;
pub use resolve::{Outcome, load, load_taken};
