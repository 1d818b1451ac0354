//! A drawing as SVG: plotters draws its shapes, and the backend here writes them.
//!
//! Thousands of rectangles make a region map, thousands of dots and short lines what was measured: neighbours of one
//! kind and look are one path, whose points but the first are relative to the one before.

use std::convert::Infallible;
use std::fmt::{self, Display, Formatter, Write};

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingErrorKind,
};

use super::drawing::{
    Drawing, Shape, Stroke, TextShape, UNITS_PER_POINT, at, line_units, twice_the_area, units,
};
use super::fonts::{FAMILY, Face};
use super::richtext;

/// The drawing as SVG text: its width and height in points, its fonts by name.
pub(super) fn svg(drawing: &Drawing, title: &str) -> String {
    let mut text = String::new();
    {
        let root = Writer::new(&mut text, drawing, title).into_drawing_area();
        for shape in &drawing.shapes {
            draw(&root, shape);
        }
        // A string buffer cannot fail to be written.
        let _ = root.present();
    }
    text
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

type Area<'a> = DrawingArea<Writer<'a>, Shift>;

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

/// A text that begins at its baseline.
fn text_element(text: &TextShape) -> Text<'static, (i32, i32), String> {
    let style = match text.face {
        Face::Regular => FontStyle::Normal,
        Face::Italic => FontStyle::Italic,
        Face::Bold => FontStyle::Bold,
    };
    let font = (FAMILY, text.size * UNITS_PER_POINT)
        .into_font()
        .style(style);
    let font = if text.upward {
        font.transform(FontTransform::Rotate270)
    } else {
        font
    };
    let mut style = TextStyle::from(font).pos(Pos::new(HPos::Left, VPos::Bottom));
    style.color = text.colour.to_backend_color();
    Text::new(text.text.clone(), at(text.at), style)
}

/// What plotters draws on.
struct Writer<'a> {
    text: &'a mut String,
    size: (u32, u32),
    /// The look of the path that is open.
    look: Option<Look>,
    closed: bool,
}

impl<'a> Writer<'a> {
    /// Begins a drawing.
    fn new(text: &'a mut String, drawing: &Drawing, title: &str) -> Self {
        let size = (drawing.width, drawing.height);
        let [across, down] = [size.0, size.1].map(|points| units(points).unsigned_abs());
        let title = escape(&richtext::plain(title));
        text.push_str(&format!(
            "<svg width=\"{}pt\" height=\"{}pt\" stroke-linejoin=\"round\" role=\"img\" \
             viewBox=\"0 0 {across} {down}\" xmlns=\"http://www.w3.org/2000/svg\"><title>{title}</title>\n",
            size.0, size.1
        ));
        Self {
            text,
            size: (across, down),
            look: None,
            closed: false,
        }
    }

    /// Where marks of a look are written.
    fn path(&mut self, look: Look) -> &mut String {
        if self.look != Some(look) {
            self.end_path();
            self.text.push_str(&format!("<path {look} d=\""));
            self.look = Some(look);
        }
        self.text
    }

    fn end_path(&mut self) {
        if self.look.take().is_some() {
            self.text.push_str("\"/>\n");
        }
    }
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

impl DrawingBackend for Writer<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        self.end_path();
        if !std::mem::replace(&mut self.closed, true) {
            self.text.push_str("</svg>\n");
        }
        Ok(())
    }

    fn draw_pixel(&mut self, point: BackendCoord, colour: BackendColor) -> Drawn {
        let corners = [(0, 0), (1, 0), (1, 1), (0, 1)];
        let corners = corners.map(|(x, y)| (point.0 + x, point.1 + y));
        self.fill_polygon(corners, &colour)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        let look = Look::Line {
            stroke: Ink::of(style.color()),
            width: style.stroke_width(),
        };
        append(self.path(look), path);
        Ok(())
    }

    /// All turn the same way, so that where two overlap nothing is cut out.
    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn {
        let mut corners: Vec<BackendCoord> = corners.into_iter().collect();
        if twice_the_area(&corners) < 0 {
            corners.reverse();
        }
        let fill = Ink::of(style.color());
        let path = self.path(Look::Area { fill });
        append(path, corners);
        path.push('z');
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        centre: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let ((x, y), ink) = (centre, Ink::of(style.color()));
        // a string cannot fail to be written
        let _ = if fill {
            write!(self.path(Look::Dot { fill: ink, radius }), "M{x} {y}h0")
        } else {
            let look = Look::Line {
                stroke: ink,
                width: style.stroke_width(),
            };
            let (r, across) = (radius, 2 * radius);
            let left = i64::from(x) - i64::from(r);
            write!(
                self.path(look),
                "M{left} {y}a{r} {r} 0 0 1 {across} 0a{r} {r} 0 0 1 -{across} 0z"
            )
        };
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        (x, y): BackendCoord,
    ) -> Drawn {
        self.end_path();
        let ink = Ink::of(style.color());
        let face = match style.style() {
            FontStyle::Normal => "",
            FontStyle::Bold => " font-weight=\"bold\"",
            FontStyle::Italic | FontStyle::Oblique => " font-style=\"italic\"",
        };
        let turned = match style.transform() {
            FontTransform::Rotate270 => format!(" transform=\"rotate(270, {x}, {y})\""),
            _ => String::new(),
        };
        // SVG drops spaces at either end of a text, but not those that do not break.
        let text = escape(text).replace(' ', "\u{a0}");
        self.text.push_str(&format!(
            "<text x=\"{x}\" y=\"{y}\" font-family=\"{}\" font-size=\"{}\" fill=\"{ink}\"{face}{turned}>{text}</text>\n",
            style.family().as_str(),
            style.size(),
        ));
        Ok(())
    }
}

/// Append a line to a path.
fn append(path: &mut String, points: impl IntoIterator<Item = BackendCoord>) {
    let mut before: Option<BackendCoord> = None;
    for (x, y) in points {
        // a string cannot fail to be written
        let _ = match before.map(|(left, top)| (x - left, y - top)) {
            None => write!(path, "M{x} {y}"),
            Some((across, 0)) => write!(path, "h{across}"),
            Some((0, down)) => write!(path, "v{down}"),
            Some((across, down)) => write!(path, "l{across} {down}"),
        };
        before = Some((x, y));
    }
}

/// A colour of shapes.
#[derive(Clone, Copy, PartialEq)]
struct Ink([u8; 3]);

impl Ink {
    fn of(colour: BackendColor) -> Self {
        let (red, green, blue) = colour.rgb;
        Self([red, green, blue])
    }
}

impl Display for Ink {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [red, green, blue] = self.0;
        write!(f, "#{red:02X}{green:02X}{blue:02X}")
    }
}

/// What the marks of one path have in common.
#[derive(Clone, Copy, PartialEq)]
enum Look {
    Area {
        fill: Ink,
    },
    /// A line without length whose ends are round.
    Dot {
        fill: Ink,
        radius: u32,
    },
    Line {
        stroke: Ink,
        width: u32,
    },
}

impl Display for Look {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Area { fill } => write!(f, "fill=\"{fill}\""),
            Self::Dot { fill, radius } => write!(
                f,
                "fill=\"none\" stroke=\"{fill}\" stroke-width=\"{}\" stroke-linecap=\"round\"",
                2 * radius
            ),
            Self::Line { stroke, width } => {
                write!(
                    f,
                    "fill=\"none\" stroke=\"{stroke}\" stroke-width=\"{width}\""
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RED: RGBColor = RGBColor(200, 0, 0);
    const INK: RGBColor = RGBColor(0, 10, 187);

    #[test]
    fn neighbours_of_one_look_are_one_path_and_texts_stand_on_their_baseline() {
        let line =
            |points: &[(f64, f64)], width| Shape::Line(points.to_vec(), Stroke::solid(INK, width));
        let text = TextShape {
            at: (1.0, 2.0),
            text: "R < 1".to_owned(),
            size: 8.0,
            face: Face::Italic,
            colour: INK,
            upward: true,
        };
        let drawing = Drawing {
            width: 10.0,
            height: 5.0,
            shapes: vec![
                Shape::Fill(vec![(0.0, 0.0), (0.2, 0.0), (0.2, 0.1), (0.0, 0.1)], RED),
                // the other way round
                Shape::Fill(vec![(0.2, 0.1), (0.3, 0.0), (0.2, 0.0)], RED),
                Shape::Disc((0.35, 0.4), 0.15, INK),
                Shape::Disc((0.45, 0.4), 0.15, INK),
                Shape::Disc((0.45, 0.4), 0.2, INK),
                line(&[(0.05, 0.05), (0.15, 0.1), (0.15, 0.45)], 0.3),
                line(&[(0.25, 0.25), (0.2, 0.2)], 0.3),
                Shape::Ring((0.5, 0.5), 0.2, Stroke::solid(INK, 0.3)),
                Shape::Text(text),
            ],
        };
        let expected = "<svg width=\"10pt\" height=\"5pt\" stroke-linejoin=\"round\" role=\"img\" \
             viewBox=\"0 0 200 100\" xmlns=\"http://www.w3.org/2000/svg\"><title>A &lt; B</title>\n\
             <path fill=\"#C80000\" d=\"M0 0h4v2h-4zM4 0h2l-2 2z\"/>\n\
             <path fill=\"none\" stroke=\"#000ABB\" stroke-width=\"6\" stroke-linecap=\"round\" d=\"M7 8h0M9 8h0\"/>\n\
             <path fill=\"none\" stroke=\"#000ABB\" stroke-width=\"8\" stroke-linecap=\"round\" d=\"M9 8h0\"/>\n\
             <path fill=\"none\" stroke=\"#000ABB\" stroke-width=\"6\" \
             d=\"M1 1l2 1v7M5 5l-1 -1M6 10a4 4 0 0 1 8 0a4 4 0 0 1 -8 0z\"/>\n\
             <text x=\"20\" y=\"40\" font-family=\"FAMILY\" font-size=\"160\" fill=\"#000ABB\" font-style=\"italic\" \
             transform=\"rotate(270, 20, 40)\">R\u{a0}&lt;\u{a0}1</text>\n</svg>\n";
        assert_eq!(svg(&drawing, "A < B"), expected.replace("FAMILY", FAMILY));
    }
}
