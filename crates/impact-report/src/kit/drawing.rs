//! A finished drawing: lines, areas and texts with their positions in points.

use plotters::style::RGBColor;

use super::fonts::Face;
use super::path::Point;
use impact_records::signal::whole;

/// A colour.
pub type Colour = RGBColor;

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Colour.
    pub colour: Colour,
    /// Width in points.
    pub width: f64,
    /// Lengths of dash and gap in points, by turns; empty: solid.
    pub dash: &'static [f64],
}

impl Stroke {
    /// A solid line.
    pub const fn solid(colour: Colour, width: f64) -> Self {
        Self {
            colour,
            width,
            dash: &[],
        }
    }

    /// A dashed line.
    pub const fn dashed(colour: Colour, width: f64, dash: &'static [f64]) -> Self {
        Self {
            colour,
            width,
            dash,
        }
    }
}

/// A text in one face and size.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TextShape {
    /// Left end of its baseline; the lower end where it runs upward.
    pub at: Point,
    /// The characters.
    pub text: String,
    /// Size, points.
    pub size: f64,
    /// Face.
    pub face: Face,
    /// Colour.
    pub colour: Colour,
    /// Whether it runs upward.
    pub upward: bool,
}

impl TextShape {
    /// Opposite corners of the room that it takes.
    pub(super) fn corners(&self) -> [Point; 2] {
        let along = super::fonts::width(&self.text, self.face, self.size);
        let (rise, drop) = (0.72 * self.size, 0.22 * self.size);
        let (x, y) = self.at;
        if self.upward {
            [(x - rise, y), (x + drop, y - along)]
        } else {
            [(x, y - rise), (x + along, y + drop)]
        }
    }
}

/// What is drawn at once.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Shape {
    /// An open line.
    Line(Vec<Point>, Stroke),
    /// A filled polygon.
    Fill(Vec<Point>, Colour),
    /// A filled disc of a radius.
    Disc(Point, f64, Colour),
    /// A circle of a radius.
    Ring(Point, f64, Stroke),
    /// A text.
    Text(TextShape),
}

/// A finished drawing, its lower shapes first.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Drawing {
    /// Width, points.
    pub width: f64,
    /// Height, points.
    pub height: f64,
    /// The shapes.
    pub(super) shapes: Vec<Shape>,
}

/// Whole drawing units in a point: fine enough for a curve, and short to write.
pub(super) const UNITS_PER_POINT: f64 = 20.0;

/// A length in drawing units.
pub(super) fn units(points: f64) -> i32 {
    whole::integer((points * UNITS_PER_POINT).round())
}

/// A position in drawing units.
pub(super) fn at((x, y): Point) -> (i32, i32) {
    (units(x), units(y))
}

/// Width of a line in drawing units, one at least.
pub(super) fn line_units(stroke: &Stroke) -> u32 {
    whole::count((stroke.width * UNITS_PER_POINT).round().max(1.0))
}

/// Twice the area within points, negative where they turn the other way.
pub(super) fn twice_the_area(points: &[(i32, i32)]) -> i64 {
    let next = points.iter().cycle().skip(1);
    let sides = points.iter().zip(next);
    sides
        .map(|(a, b)| i64::from(a.0) * i64::from(b.1) - i64::from(b.0) * i64::from(a.1))
        .sum()
}
