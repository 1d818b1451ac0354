//! The report: its content as plain data first, then the figures, then the document.
//!
//! No result is computed here; what is drawn was found in the rooms to the left.

pub mod content;

pub use content::ReportContent;
