//! A drawing as SVG, through plotters' backend.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::compact;
use super::drawing::{Drawing, Shape, Stroke, TextShape, UNITS_PER_POINT, at, line_units, units};
use super::fonts::{FAMILY, Face};
use super::richtext;

/// The drawing as SVG text: its width and height in points, its fonts by name.
pub(super) fn svg(drawing: &Drawing, title: &str) -> String {
    let size = (
        units(drawing.width).unsigned_abs(),
        units(drawing.height).unsigned_abs(),
    );
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        for shape in &drawing.shapes {
            draw(&root, shape);
        }
        // A string buffer cannot fail to be written.
        let _ = root.present();
    }
    with_root(drawing, &svg, size, title)
}

/// Puts the size in points and what all elements share on the root element.
fn with_root(drawing: &Drawing, svg: &str, size: (u32, u32), title: &str) -> String {
    let old = format!("<svg width=\"{}\" height=\"{}\"", size.0, size.1);
    let new = format!(
        "<svg width=\"{}pt\" height=\"{}pt\" stroke-linejoin=\"round\" role=\"img\"",
        drawing.width, drawing.height
    );
    let title = escape(&richtext::plain(title));
    let svg = svg
        .replacen(&old, &new, 1)
        .replacen(">\n", &format!("><title>{title}</title>\n"), 1)
        .replace(" opacity=\"1\"", "");
    compact::marks(&svg)
}

/// Text made safe for XML.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

fn line_style(stroke: &Stroke) -> ShapeStyle {
    ShapeStyle {
        color: stroke.colour.to_rgba(),
        filled: false,
        stroke_width: line_units(stroke),
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
        Shape::Text(text) => root.draw(&text_element(text)),
    };
}

/// The backend divides sizes by 1.24 and hangs a text's top 0.76 em above its baseline.
fn text_element(text: &TextShape) -> Text<'static, (i32, i32), String> {
    let style = match text.face {
        Face::Regular => FontStyle::Normal,
        Face::Italic => FontStyle::Italic,
        Face::Bold => FontStyle::Bold,
    };
    let font = (FAMILY, text.size * UNITS_PER_POINT * 1.24)
        .into_font()
        .style(style);
    let (x, y) = text.at;
    let rise = 0.76 * text.size;
    let (font, position) = if text.upward {
        (font.transform(FontTransform::Rotate270), (x - rise, y))
    } else {
        (font, (x, y - rise))
    };
    let mut style = TextStyle::from(font).pos(Pos::new(HPos::Left, VPos::Top));
    style.color = text.colour.to_backend_color();
    // SVG drops spaces at either end of a text, but not those that do not break.
    Text::new(text.text.replace(' ', "\u{a0}"), at(position), style)
}
