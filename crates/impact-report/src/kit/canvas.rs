//! Where a figure is drawn, in points and in layers.

use plotters::style::BLACK;

pub use super::drawing::{Colour, Stroke};
use super::drawing::{Drawing, Shape, TextShape};
use super::fonts::Face;
pub(crate) use super::path::Point;
use super::richtext;

/// Which point of a text its position names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// The left end.
    Left,
    /// The middle.
    Middle,
    /// The right end.
    Right,
}

/// How a text is set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TextLook {
    /// Size in points.
    pub size: f64,
    /// Face.
    pub face: Face,
    /// Colour.
    pub colour: Colour,
    /// Anchor.
    pub anchor: Anchor,
    /// Whether it runs upward.
    pub upward: bool,
}

impl TextLook {
    /// Upright text of a size.
    pub(crate) const fn new(size: f64, anchor: Anchor) -> Self {
        Self {
            size,
            face: Face::Regular,
            colour: BLACK,
            anchor,
            upward: false,
        }
    }

    /// In another colour.
    pub(crate) const fn colour(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }

    /// In another face.
    pub(crate) const fn face(self, face: Face) -> Self {
        Self { face, ..self }
    }
}

/// A point of a figure with a text.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub(crate) struct Spot {
    /// From the left, points.
    pub x: f64,
    /// From the top, points.
    pub y: f64,
    /// The text; line feeds separate its lines.
    pub text: String,
}

/// A drawing of a given size in points.
pub struct Canvas {
    /// Width, points.
    pub width: f64,
    /// Height, points.
    pub height: f64,
    /// Points with a text that is shown on hovering.
    pub(crate) spots: Vec<Spot>,
    layer: i32,
    shapes: Vec<(i32, Shape)>,
}

impl Canvas {
    /// An empty drawing.
    pub fn new(width: f64, height: f64) -> Self {
        Self {
            width,
            height,
            spots: Vec::new(),
            layer: 0,
            shapes: Vec::new(),
        }
    }

    /// What follows is drawn in this layer; higher layers cover lower ones.
    pub fn layer(&mut self, layer: i32) -> &mut Self {
        self.layer = layer;
        self
    }

    /// An open line through points.
    pub(crate) fn line(&mut self, points: &[Point], stroke: Stroke) {
        if points.len() < 2 {
            return;
        }
        if stroke.dash.is_empty() {
            self.push(Shape::Line(points.to_vec(), stroke));
        } else {
            for piece in super::path::dashes(points, stroke.dash) {
                self.push(Shape::Line(piece, stroke));
            }
        }
    }

    /// A line between two points.
    pub(crate) fn segment(&mut self, from: Point, to: Point, stroke: Stroke) {
        self.line(&[from, to], stroke);
    }

    /// A filled polygon.
    pub(crate) fn fill(&mut self, points: &[Point], colour: Colour) {
        if points.len() >= 3 {
            self.push(Shape::Fill(points.to_vec(), colour));
        }
    }

    /// The outline of a polygon.
    pub(crate) fn outline(&mut self, points: &[Point], stroke: Stroke) {
        let mut closed = points.to_vec();
        closed.extend(points.iter().take(2));
        self.line(&closed, stroke);
    }

    /// A filled rectangle from corner to corner.
    pub fn rectangle(&mut self, (x0, y0): Point, (x1, y1): Point, colour: Colour) {
        self.fill(&[(x0, y0), (x1, y0), (x1, y1), (x0, y1)], colour);
    }

    /// A filled disc.
    pub(crate) fn disc(&mut self, centre: Point, radius: f64, colour: Colour) {
        self.push(Shape::Disc(centre, radius, colour));
    }

    /// A circle.
    pub(crate) fn ring(&mut self, centre: Point, radius: f64, stroke: Stroke) {
        self.push(Shape::Ring(centre, radius, stroke));
    }

    /// A marked-up text with its baseline at a position.
    pub(crate) fn text(&mut self, (x, y): Point, markup: &str, look: TextLook) {
        let total = richtext::width(markup, look.face, look.size);
        let start = match look.anchor {
            Anchor::Left => 0.0,
            Anchor::Middle => -0.5 * total,
            Anchor::Right => -total,
        };
        let mut along = start;
        for run in richtext::parse(markup) {
            let (size, face) = (run.size(look.size), run.face(look.face));
            let down = run.shift(look.size);
            let at = if look.upward {
                (x + down, y - along)
            } else {
                (x + along, y + down)
            };
            along += super::fonts::width(&run.text, face, size);
            self.push(Shape::Text(TextShape {
                at,
                text: run.text,
                size,
                face,
                colour: look.colour,
                upward: look.upward,
            }));
        }
    }

    /// A point with a text that is shown on hovering.
    pub(crate) fn spot(&mut self, (x, y): Point, text: String) {
        self.spots.push(Spot { x, y, text });
    }

    fn push(&mut self, shape: Shape) {
        self.shapes.push((self.layer, shape));
    }

    /// Texts that reach beyond the drawing's edges: there should be none.
    pub(crate) fn overfull(&self) -> Vec<String> {
        let inside = |(x, y): Point| {
            (-0.5..=self.width + 0.5).contains(&x) && (-0.5..=self.height + 0.5).contains(&y)
        };
        let texts = self.shapes.iter().filter_map(|(_, shape)| match shape {
            Shape::Text(text) => {
                (!text.corners().into_iter().all(inside)).then(|| text.text.clone())
            }
            _ => None,
        });
        texts.collect()
    }

    /// What was drawn, lower layers first.
    pub(crate) fn finish(mut self) -> Drawing {
        self.shapes.sort_by_key(|(layer, _)| *layer);
        Drawing {
            width: self.width,
            height: self.height,
            shapes: self.shapes.into_iter().map(|(_, shape)| shape).collect(),
        }
    }
}
