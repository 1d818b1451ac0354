//! What may be wrong with a record: one variant for each sentence, with its values in SI.
//!
//! The sentences are in the table `problem` of the texts, what the user can do in the table `remedy`.

#[macro_use]
mod row;
mod kind;
mod parts;
mod texts;

pub use kind::Problem;
pub use parts::{MeasuredQuantity, MistakenUnits, parts};
pub use texts::Remedy;
