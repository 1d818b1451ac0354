//! Least squares: blocks of residuals, and the fit that minimises them.

pub mod block;
mod evaluation;
pub mod factor;
mod fit;
pub mod group;
pub mod least_squares;
pub mod normal;
pub mod placed_rows;
pub mod problem;
mod progress;
mod reflection;
mod report;
pub mod rows;
pub mod scalar;

pub use block::{Block, mean_squares};
pub use fit::{Fit, FitError};
pub use problem::{Precision, Prior, Problem};
pub use progress::FitProgress;
pub use report::FitReport;
