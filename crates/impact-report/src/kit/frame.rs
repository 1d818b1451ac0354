//! A drawing as a frame of typst's pages: its paths and texts become part of the page without a
//! picture file between them, which would be written only to be read again.

use std::collections::HashMap;

use rustybuzz::{Direction, Script, ShapePlan, UnicodeBuffer, script};
use typst::layout::{Abs, Angle, Em, Frame, FrameItem, GroupItem, Point, Size, Transform};
use typst::syntax::Span;
use typst::text::{FontInstance, Glyph, Lang, TextItem};
use typst::visualize::{
    Color, Curve, CurveItem, FixedStroke, Geometry, LineCap, LineJoin, Paint, Shape as PageShape,
};

use super::drawing::{
    Colour, Drawing, Shape, TextShape, UNITS_PER_POINT, at, line_units, twice_the_area, units,
};
use super::fonts;

/// The drawing in its own size, its texts marked as of a language.
pub(crate) fn frame(drawing: &Drawing, lang: Lang) -> Frame {
    let size = Size::new(Abs::pt(drawing.width), Abs::pt(drawing.height));
    let mut frame = Frame::hard(size);
    let (mut path, mut shaper) = (Path::default(), Shaper::default());
    for shape in &drawing.shapes {
        match shape {
            Shape::Text(text) => {
                path.close(&mut frame);
                text_items(text, lang, &mut shaper, &mut frame);
            }
            shape => path.add(shape, &mut frame),
        }
    }
    path.close(&mut frame);
    frame
}

/// How a path is painted.
#[derive(Clone, Copy, PartialEq)]
enum Look {
    Area(Colour),
    Line { colour: Colour, width: u32 },
    // lines without length whose ends are round
    Dot { colour: Colour, width: u32 },
}

impl Look {
    fn of(shape: &Shape) -> Option<Self> {
        Some(match shape {
            Shape::Fill(_, colour) => Self::Area(*colour),
            Shape::Line(_, stroke) | Shape::Ring(_, _, stroke) => Self::Line {
                colour: stroke.colour,
                width: line_units(stroke),
            },
            Shape::Disc(_, radius, colour) => Self::Dot {
                colour: *colour,
                width: 2 * units(*radius).unsigned_abs(),
            },
            Shape::Text(_) => return None,
        })
    }

    fn painted(self, curve: Curve) -> PageShape {
        let (colour, width, cap) = match self {
            Self::Area(colour) => return Geometry::Curve(curve).filled(paint(colour)),
            Self::Line { colour, width } => (colour, width, LineCap::Butt),
            Self::Dot { colour, width } => match only_place(&curve) {
                // a path without any extent is not exported
                Some(centre) => return disc(centre, width).filled(paint(colour)),
                None => (colour, width, LineCap::Round),
            },
        };
        Geometry::Curve(curve).stroked(FixedStroke {
            paint: paint(colour),
            thickness: length(width),
            cap,
            join: LineJoin::Round,
            ..FixedStroke::default()
        })
    }
}

fn paint(colour: Colour) -> Paint {
    Color::from_u8(colour.0, colour.1, colour.2, 255).into()
}

/// Neighbours of one look are one path.
#[derive(Default)]
struct Path {
    look: Option<Look>,
    curve: Curve,
}

impl Path {
    fn add(&mut self, shape: &Shape, frame: &mut Frame) {
        let look = Look::of(shape);
        if self.look != look {
            self.close(frame);
            self.look = look;
        }
        match shape {
            Shape::Line(points, _) => self.line(points.iter().map(|&p| at(p))),
            Shape::Fill(points, _) => self.area(points.iter().map(|&p| at(p)).collect()),
            Shape::Disc(centre, _, _) => self.line([at(*centre); 2].into_iter()),
            Shape::Ring(centre, radius, _) => self.ring(at(*centre), units(*radius)),
            Shape::Text(_) => {}
        }
    }

    fn line(&mut self, mut points: impl Iterator<Item = (i32, i32)>) {
        if let Some(first) = points.next() {
            self.curve.move_(point(first));
        }
        points.for_each(|p| self.curve.line(point(p)));
    }

    /// All areas turn the same way, so that where two overlap nothing is cut out.
    fn area(&mut self, mut points: Vec<(i32, i32)>) {
        if twice_the_area(&points) < 0 {
            points.reverse();
        }
        self.line(points.into_iter());
        self.curve.close();
    }

    fn ring(&mut self, centre: (i32, i32), radius: i32) {
        self.curve
            .0
            .append(&mut circle(point(centre), length(radius)).0);
    }

    /// Ends the path and hands it to the frame.
    fn close(&mut self, frame: &mut Frame) {
        let curve = std::mem::take(&mut self.curve);
        if let Some(look) = self.look.take() {
            let shape = look.painted(curve);
            frame.push(Point::zero(), FrameItem::Shape(shape, Span::detached()));
        }
    }
}

/// The place of dots that lie in one place.
fn only_place(dots: &Curve) -> Option<Point> {
    let mut places = dots.0.iter().filter_map(|item| match item {
        CurveItem::Move(place) => Some(*place),
        _ => None,
    });
    let first = places.next()?;
    places.all(|place| place == first).then_some(first)
}

fn disc(centre: Point, width: u32) -> Geometry {
    Geometry::Curve(circle(centre, length(width) / 2.0))
}

fn circle(centre: Point, radius: Abs) -> Curve {
    let mut circle = Curve::ellipse(Size::splat(2.0 * radius));
    circle.translate(centre - Point::splat(radius));
    circle.close();
    circle
}

/// A length in drawing units.
fn length(units: impl Into<f64>) -> Abs {
    Abs::pt(units.into() / UNITS_PER_POINT)
}

/// A position in drawing units.
fn point((x, y): (i32, i32)) -> Point {
    Point::new(length(x), length(y))
}

/// A text, in as many items as it needs fonts.
fn text_items(shape: &TextShape, lang: Lang, shaper: &mut Shaper, frame: &mut Frame) {
    let size = Abs::pt(shape.size);
    let mut line = Frame::soft(Size::zero());
    let mut along = Abs::zero();
    for (font, text) in fonts::runs(&shape.text, shape.face) {
        let item = TextItem {
            glyphs: shaper.glyphs(&font, text),
            font,
            size,
            fill: paint(shape.colour),
            stroke: None,
            lang,
            region: None,
            text: text.into(),
        };
        let width = item.width();
        line.push(Point::with_x(along), FrameItem::Text(item));
        along += width;
    }
    let start = point(at(shape.at));
    if shape.upward {
        let mut group = GroupItem::new(line);
        group.transform = Transform::rotate(Angle::deg(-90.0));
        frame.push(start, FrameItem::Group(group));
    } else {
        frame.push_frame(start, line);
    }
}

/// Sets texts with the kerning and ligatures of their fonts. How a font sets a script is worked out
/// once: that takes longer than a label.
#[derive(Default)]
struct Shaper(HashMap<(FontInstance, Script, Direction), ShapePlan>);

impl Shaper {
    /// The glyphs of a text in one font.
    fn glyphs(&mut self, font: &FontInstance, text: &str) -> Vec<Glyph> {
        let mut buffer = UnicodeBuffer::new();
        buffer.push_str(text);
        buffer.guess_segment_properties();
        let plan = self.plan(font, &buffer);
        let shaped = rustybuzz::shape_with_plan(font.rusty(), plan, buffer);
        let starts: Vec<u32> = shaped.glyph_infos().iter().map(|i| i.cluster).collect();
        let ends = |start: u32| starts.iter().copied().filter(|s| *s > start).min();
        let narrow = |byte: usize| u16::try_from(byte).unwrap_or(u16::MAX);
        let each = shaped.glyph_infos().iter().zip(shaped.glyph_positions());
        each.map(|(info, position)| {
            let end = ends(info.cluster).map_or(text.len(), |end| end as usize);
            Glyph {
                id: narrow(info.glyph_id as usize),
                x_advance: font.to_em(position.x_advance),
                x_offset: font.to_em(position.x_offset),
                y_advance: Em::zero(),
                y_offset: font.to_em(position.y_offset),
                range: narrow(info.cluster as usize)..narrow(end),
                span: (Span::detached(), 0),
            }
        })
        .collect()
    }

    fn plan(&mut self, font: &FontInstance, buffer: &UnicodeBuffer) -> &ShapePlan {
        let (script, direction) = (buffer.script(), buffer.direction());
        let known = (script != script::UNKNOWN).then_some(script);
        let new = || ShapePlan::new(font.rusty(), direction, known, None, &[]);
        let key = (font.clone(), script, direction);
        self.0.entry(key).or_insert_with(new)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kit::canvas::{Anchor, Canvas, Stroke, TextLook};

    const RED: Colour = plotters::style::RGBColor(200, 0, 0);

    fn frame_of(draw: impl FnOnce(&mut Canvas)) -> Frame {
        let mut canvas = Canvas::new(100.0, 50.0);
        draw(&mut canvas);
        frame(&canvas.finish(), Lang::ENGLISH)
    }

    fn shapes(frame: &Frame) -> Vec<&PageShape> {
        let items = frame.items().map(|(_, item)| item);
        items
            .filter_map(|item| match item {
                FrameItem::Shape(shape, _) => Some(shape),
                _ => None,
            })
            .collect()
    }

    #[test]
    fn neighbours_of_one_look_are_one_path() {
        let (thin, thick) = (Stroke::solid(RED, 0.5), Stroke::solid(RED, 1.0));
        let frame = frame_of(|canvas| {
            canvas.segment((0.0, 0.0), (10.0, 0.0), thin);
            canvas.segment((0.0, 5.0), (10.0, 5.0), thin);
            canvas.segment((0.0, 9.0), (10.0, 9.0), thick);
            canvas.segment((0.0, 9.5), (10.0, 9.5), thin);
        });
        let widths = shapes(&frame).into_iter().map(|shape| {
            let stroke = shape.stroke.as_ref().expect("a line");
            (stroke.thickness.to_pt(), shape.bbox(false).size().y.to_pt())
        });
        assert_eq!(
            widths.collect::<Vec<_>>(),
            [(0.5, 5.0), (1.0, 0.0), (0.5, 0.0)]
        );
    }

    /// A path without extent is not exported: a dot by itself would not be seen.
    #[test]
    fn a_dot_by_itself_is_a_disc_and_many_are_one_path() {
        let one = frame_of(|canvas| canvas.disc((20.0, 10.0), 1.5, RED));
        let [disc] = shapes(&one)[..] else {
            panic!("one shape")
        };
        assert!(disc.fill.is_some() && disc.stroke.is_none());
        let size = disc.bbox(false).size();
        assert!((size.x.to_pt() - 3.0).abs() < 1e-9 && (size.y.to_pt() - 3.0).abs() < 1e-9);
        let many = frame_of(|canvas| {
            for x in 0..5 {
                canvas.disc((f64::from(x), 10.0), 1.5, RED);
            }
        });
        let [dots] = shapes(&many)[..] else {
            panic!("one shape")
        };
        let stroke = dots.stroke.as_ref().expect("round ends");
        assert_eq!(
            (stroke.cap, stroke.thickness.to_pt()),
            (LineCap::Round, 3.0)
        );
    }

    #[test]
    fn areas_that_overlap_turn_the_same_way() {
        let frame = frame_of(|canvas| {
            canvas.fill(&[(0.0, 0.0), (8.0, 0.0), (8.0, 8.0), (0.0, 8.0)], RED);
            canvas.fill(&[(4.0, 4.0), (4.0, 9.0), (9.0, 9.0), (9.0, 4.0)], RED);
        });
        let [areas] = shapes(&frame)[..] else {
            panic!("one shape")
        };
        let Geometry::Curve(curve) = &areas.geometry else {
            panic!("a curve")
        };
        let inside = Point::new(Abs::pt(6.0), Abs::pt(6.0));
        assert!(curve.contains(areas.fill_rule, inside));
    }

    #[test]
    fn texts_keep_their_characters_width_and_direction() {
        let frame = frame_of(|canvas| {
            let mut look = TextLook::new(8.0, Anchor::Left);
            canvas.text((10.0, 20.0), "$η$ = $f$/$f_0$ (1)", look);
            look.upward = true;
            canvas.text((5.0, 40.0), "0.25", look);
        });
        let mut text = String::new();
        let mut end = Abs::zero();
        let mut upward = Vec::new();
        for (at, item) in frame.items() {
            match item {
                FrameItem::Text(run) => {
                    text.push_str(&run.text);
                    end = at.x + run.width();
                }
                FrameItem::Group(group) => upward.push(group),
                _ => panic!("nothing else is drawn"),
            }
        }
        assert_eq!(text, "η = f/f0 (1)");
        // advances alone, without kerning
        let plain = super::super::richtext::width("$η$ = $f$/$f_0$ (1)", fonts::Face::Regular, 8.0);
        assert!((end.to_pt() - 10.0 - plain).abs() < 2.0, "{end:?}");
        let [group] = upward[..] else {
            panic!("one text runs upward")
        };
        assert_eq!(group.transform, Transform::rotate(Angle::deg(-90.0)));
    }

    /// A sign that the embedded font for formulas has, and that of the figures has not.
    #[test]
    fn a_character_that_the_face_lacks_is_set_in_a_font_that_has_it() {
        let runs = fonts::runs("a\u{2A00}b", fonts::Face::Regular);
        let texts: Vec<&str> = runs.iter().map(|(_, text)| *text).collect();
        assert_eq!(texts, ["a", "\u{2A00}", "b"]);
        assert!(runs[1].0.ttf().glyph_index('\u{2A00}').is_some());
        assert!(runs[0].0 == runs[2].0 && runs[0].0 != runs[1].0);
    }
}
