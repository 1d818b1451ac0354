//! campaign.toml: as written ([`written`]), then resolved ([`resolved`]) with every default made
//! explicit, or every problem at once ([`diagnostic`]).

pub mod check;
mod context;
pub mod diagnostic;
mod discovery;
pub mod infer;
pub mod keys;
mod lines;
mod named_files;
mod names;
mod nearest;
mod read;
mod records;
mod resolve;
pub mod resolved;
mod run_table;
pub mod sections;
mod settings;
pub(crate) mod slashes;
pub mod sources;
mod statement;
pub mod template;
pub mod values;
pub mod written;

pub use discovery::{Opener, Taken, matching};
pub use named_files::NamedFiles;
pub use nearest::nearest;
pub use read::not_a_description;
pub use resolve::{LoadOutcome, load, load_taken};
