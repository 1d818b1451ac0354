//! What figures are made of: canvas, axes, panels, legends, marks, text and the writers of their files. It knows
//! no campaign and no result; the house test keeps it so.

pub mod axis;
pub mod canvas;
pub mod csv;
pub mod dots;
mod drawing;
pub mod figure;
pub mod fonts;
mod frame;
pub mod legend;
pub mod look;
pub mod marks;
pub mod panel;
pub mod path;
pub mod placing;
pub mod richtext;
mod svg;
pub mod units;

pub use figure::{Figure, numbered};
pub(crate) use svg::escape;
