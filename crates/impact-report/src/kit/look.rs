//! One set of sizes, widths and colours for all figures.

use plotters::style::RGBColor;

use super::canvas::{Colour, Stroke};

/// Width of the text block, points (170 mm).
pub const FULL_WIDTH: f64 = 481.9;
/// Width of one of two columns, points.
pub(crate) const HALF_WIDTH: f64 = 234.0;
/// Width of the two figures of the first page, points.
pub(crate) const FRONT_WIDTH: f64 = 236.0;
/// Room below a panel for its numbers and title, points.
pub(crate) const BELOW_PANEL: f64 = 24.0;
/// Figures narrower than this are set two in a row, points.
pub(crate) const NARROW: f64 = 300.0;
/// Dashes of a fitted or simulated line, points.
pub const DASH: &[f64] = &[4.0, 2.0];
/// Size of tick labels, points.
pub(crate) const TICK_SIZE: f64 = 7.0;
/// Size of axis titles, points.
pub(crate) const TITLE_SIZE: f64 = 8.0;
/// Size of notes inside a figure, points.
pub(crate) const NOTE_SIZE: f64 = 7.5;
/// Width of frames and ticks, points.
const FRAME_WIDTH: f64 = 0.5;
/// Width of curves, points.
pub const CURVE_WIDTH: f64 = 1.0;

/// Near black, for text and measured lines.
pub const INK: Colour = RGBColor(0x1a, 0x1a, 0x1a);
/// Frames and ticks.
pub(crate) const FRAME: Colour = RGBColor(0x55, 0x55, 0x55);
/// Second text.
pub const QUIET: Colour = RGBColor(0x5f, 0x66, 0x6d);
/// Paper.
pub const PAPER: Colour = RGBColor(0xff, 0xff, 0xff);
/// Okabe and Ito's blue: mass x, first series.
pub const BLUE: Colour = RGBColor(0x00, 0x5f, 0xa3);
/// Okabe and Ito's vermilion: mass y, second series.
pub const VERMILION: Colour = RGBColor(0xd5, 0x5e, 0x00);
/// Okabe and Ito's bluish green: third series.
pub const GREEN: Colour = RGBColor(0x00, 0x8a, 0x66);
/// Sky blue, for motions.
pub(crate) const SKY: Colour = RGBColor(0x2f, 0x9b, 0xd8);
/// Orange, for motions.
pub(crate) const ORANGE: Colour = RGBColor(0xc9, 0x86, 0x00);
/// Purple, for motions.
pub(crate) const PURPLE: Colour = RGBColor(0xb0, 0x52, 0x8a);
/// Plum, for motions and for boundaries that none of the others is.
pub const PLUM: Colour = RGBColor(0x6f, 0x4a, 0x9e);
/// Brown, for motions.
pub(crate) const BROWN: Colour = RGBColor(0x7a, 0x50, 0x30);
/// Dark red: chaos.
pub(crate) const DARK_RED: Colour = RGBColor(0x8c, 0x1d, 0x1d);
/// Slate: motions without impacts.
pub(crate) const SLATE: Colour = RGBColor(0x44, 0x4a, 0x50);
/// Grey, for undetermined motions.
pub(crate) const GREY: Colour = RGBColor(0x77, 0x77, 0x77);
/// Pale grey, for times at which masses are together.
pub const PALE: Colour = RGBColor(0xd9, 0xdd, 0xe2);
/// Grey of what was measured and not used.
pub(crate) const UNUSED: Colour = RGBColor(0x9a, 0x9f, 0xa5);
/// Grey of the bands of simulated boundaries.
pub(crate) const BOUNDARY_BAND: Colour = RGBColor(0xbd, 0xc3, 0xca);
/// Where a number is none.
pub(crate) const BLANK: Colour = RGBColor(0xee, 0xee, 0xee);
/// A pale blue for 95 % bands.
pub(crate) const BAND: Colour = RGBColor(0xc9, 0xdd, 0xee);

/// Frame lines.
pub(crate) const FRAME_STROKE: Stroke = Stroke::solid(FRAME, FRAME_WIDTH);
/// A line at zero.
pub const ZERO_STROKE: Stroke = Stroke::solid(RGBColor(0xb5, 0xb9, 0xbe), 0.4);
