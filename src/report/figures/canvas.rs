//! A drawing in points, recorded in layers and rendered through plotters' SVG backend.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::compact;
use super::fonts::{FAMILY, Face};
pub(crate) use super::path::Point;
use super::richtext;
use crate::signal::whole;

/// Drawing units in a point: plotters counts in whole units, these are fine enough for a curve.
const UNITS_PER_POINT: f64 = 20.0;

/// A colour.
pub(crate) type Colour = RGBColor;

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stroke {
    /// Colour.
    pub colour: Colour,
    /// Width in points.
    pub width: f64,
    /// Lengths of dash and gap in points, by turns; empty: solid.
    pub dash: &'static [f64],
}

impl Stroke {
    /// A solid line.
    pub(crate) const fn solid(colour: Colour, width: f64) -> Self {
        Self {
            colour,
            width,
            dash: &[],
        }
    }

    /// A dashed line.
    pub(crate) const fn dashed(colour: Colour, width: f64, dash: &'static [f64]) -> Self {
        Self {
            colour,
            width,
            dash,
        }
    }
}

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

enum Shape {
    Line(Vec<Point>, Stroke),
    Fill(Vec<Point>, Colour),
    Disc(Point, f64, Colour),
    Ring(Point, f64, Stroke),
    Text {
        at: Point,
        text: String,
        size: f64,
        face: Face,
        colour: Colour,
        upward: bool,
    },
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
pub(crate) struct Canvas {
    /// Width, points.
    pub width: f64,
    /// Height, points.
    pub height: f64,
    /// Points with a text that is shown on hovering.
    pub spots: Vec<Spot>,
    layer: i32,
    shapes: Vec<(i32, Shape)>,
}

impl Canvas {
    /// An empty drawing.
    pub(crate) fn new(width: f64, height: f64) -> Self {
        Self {
            width,
            height,
            spots: Vec::new(),
            layer: 0,
            shapes: Vec::new(),
        }
    }

    /// What follows is drawn in this layer; higher layers cover lower ones.
    pub(crate) fn layer(&mut self, layer: i32) -> &mut Self {
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
    pub(crate) fn rectangle(&mut self, (x0, y0): Point, (x1, y1): Point, colour: Colour) {
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
            let (colour, upward) = (look.colour, look.upward);
            // SVG drops spaces at either end of a text, but not those that do not break.
            let text = run.text.replace(' ', "\u{a0}");
            self.push(Shape::Text {
                at,
                text,
                size,
                face,
                colour,
                upward,
            });
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
        let inside = |x: f64, y: f64| {
            (-0.5..=self.width + 0.5).contains(&x) && (-0.5..=self.height + 0.5).contains(&y)
        };
        let texts = self.shapes.iter().filter_map(|(_, shape)| match shape {
            Shape::Text {
                at,
                text,
                size,
                face,
                upward,
                ..
            } => {
                let along = super::fonts::width(text, *face, *size);
                let (rise, drop) = (0.72 * size, 0.22 * size);
                let (x, y) = *at;
                let corners = if *upward {
                    [(x - rise, y), (x + drop, y - along)]
                } else {
                    [(x, y - rise), (x + along, y + drop)]
                };
                (!corners.iter().all(|c| inside(c.0, c.1))).then(|| text.clone())
            }
            _ => None,
        });
        texts.collect()
    }

    /// The drawing as SVG text: its width and height in points, its fonts by name.
    pub(crate) fn into_svg(mut self, title: &str) -> String {
        self.shapes.sort_by_key(|(layer, _)| *layer);
        let size = (
            units(self.width).unsigned_abs(),
            units(self.height).unsigned_abs(),
        );
        let mut svg = String::new();
        {
            let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
            for (_, shape) in &self.shapes {
                draw(&root, shape);
            }
            // A string buffer cannot fail to be written.
            let _ = root.present();
        }
        self.finish_root(&svg, size, title)
    }

    /// Puts the size in points and what all elements share on the root element.
    fn finish_root(&self, svg: &str, size: (u32, u32), title: &str) -> String {
        let old = format!("<svg width=\"{}\" height=\"{}\"", size.0, size.1);
        let new = format!(
            "<svg width=\"{}pt\" height=\"{}pt\" stroke-linejoin=\"round\" role=\"img\"",
            self.width, self.height
        );
        let title = escape(&richtext::plain(title));
        let svg = svg
            .replacen(&old, &new, 1)
            .replacen(">\n", &format!("><title>{title}</title>\n"), 1)
            .replace(" opacity=\"1\"", "");
        compact::marks(&svg)
    }
}

/// Text made safe for XML.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

fn units(points: f64) -> i32 {
    whole::integer((points * UNITS_PER_POINT).round())
}

fn at((x, y): Point) -> (i32, i32) {
    (units(x), units(y))
}

fn line_style(stroke: &Stroke) -> ShapeStyle {
    let width = whole::count((stroke.width * UNITS_PER_POINT).round().max(1.0));
    ShapeStyle {
        color: stroke.colour.to_rgba(),
        filled: false,
        stroke_width: width,
    }
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Draws one shape; a string buffer cannot fail to be written, so there is no error to pass on.
fn draw(root: &Area<'_>, shape: &Shape) {
    let _ = match shape {
        Shape::Line(points, stroke) => root.draw(&PathElement::new(
            points.iter().map(|&p| at(p)).collect::<Vec<_>>(),
            line_style(stroke),
        )),
        Shape::Fill(points, colour) => root.draw(&Polygon::new(
            points.iter().map(|&p| at(p)).collect::<Vec<_>>(),
            colour.filled(),
        )),
        Shape::Disc(centre, radius, colour) => {
            root.draw(&Circle::new(at(*centre), units(*radius), colour.filled()))
        }
        Shape::Ring(centre, radius, stroke) => root.draw(&Circle::new(
            at(*centre),
            units(*radius),
            line_style(stroke),
        )),
        Shape::Text {
            at: position,
            text,
            size,
            face,
            colour,
            upward,
        } => root.draw(&text_element(
            *position,
            text,
            (*size, *face),
            (*colour, *upward),
        )),
    };
}

/// The backend divides sizes by 1.24 and hangs a text's top 0.76 em above its baseline.
fn text_element(
    (x, y): Point,
    text: &str,
    (size, face): (f64, Face),
    (colour, upward): (Colour, bool),
) -> Text<'static, (i32, i32), String> {
    let style = match face {
        Face::Regular => FontStyle::Normal,
        Face::Italic => FontStyle::Italic,
        Face::Bold => FontStyle::Bold,
    };
    let font = (FAMILY, size * UNITS_PER_POINT * 1.24)
        .into_font()
        .style(style);
    let rise = 0.76 * size;
    let (font, position) = if upward {
        (font.transform(FontTransform::Rotate270), (x - rise, y))
    } else {
        (font, (x, y - rise))
    };
    let mut style = TextStyle::from(font).pos(Pos::new(HPos::Left, VPos::Top));
    style.color = colour.to_backend_color();
    Text::new(text.to_owned(), at(position), style)
}
