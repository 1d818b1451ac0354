//! All stages: the only module that uses every other. It calls, it does not compute.
//!
//! `run` = [`observe`] every record → brackets → [`identify`] → [`report`]; the stages alone
//! use [`store`].

pub mod block_cache;
pub mod budget;
pub mod campaign_folders;
pub mod campaigns;
pub mod checkpoint;
pub mod error;
mod evidence;
mod gzip_json;
pub mod identify;
pub mod inputs;
mod json;
pub mod layout;
mod memory;
pub mod observe;
pub mod observed;
pub mod plan;
pub mod published;
pub mod report;
pub mod resolved_file;
mod run;
pub mod store;
pub mod summary;
pub mod synthesise;
pub mod table;
pub mod tables;
pub mod watch;

pub use error::{PipelineError, Progress, RefusedRecord};
pub use observed::Observed;
pub use run::{Completed, Destination, run};
