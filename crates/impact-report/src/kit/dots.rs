//! Many small points: those that would cover one another are drawn once.

use impact_records::signal::whole;
use std::collections::HashSet;

use super::canvas::{Canvas, Colour, Stroke};
use super::look;
use super::panel::Panel;

/// Side in points of the squares that hold at most one dot.
const CELL: f64 = 0.55;

/// The squares that hold a dot.
#[derive(Default)]
pub struct Dots {
    taken: HashSet<(i32, i32)>,
}

impl Dots {
    /// Draws a dot at data unless its square is taken; returns its position, `None` outside the panel.
    pub fn put(
        &mut self,
        canvas: &mut Canvas,
        panel: &Panel,
        (x, y): (f64, f64),
        look: DotLook,
    ) -> Option<(f64, f64)> {
        if !panel.shows(x, y) {
            return None;
        }
        let at = panel.at(x, y);
        let cell = (whole::integer(at.0 / CELL), whole::integer(at.1 / CELL));
        if self.taken.insert(cell) {
            if look.open {
                canvas.disc(at, look.radius, look::PAPER);
                canvas.ring(at, look.radius, Stroke::solid(look.colour, 0.5));
            } else {
                canvas.disc(at, look.radius, look.colour);
            }
        }
        Some(at)
    }
}

/// How a dot looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DotLook {
    /// Radius, points.
    pub radius: f64,
    /// Colour.
    pub colour: Colour,
    /// Whether it is open: not used in the fit.
    pub open: bool,
}

impl DotLook {
    /// A full dot.
    pub const fn full(radius: f64, colour: Colour) -> Self {
        Self {
            radius,
            colour,
            open: false,
        }
    }
}

/// Radius for a number of dots.
pub fn radius(count: usize) -> f64 {
    match count {
        0..=60 => 1.6,
        61..=400 => 1.15,
        401..=2000 => 0.8,
        _ => 0.6,
    }
}
