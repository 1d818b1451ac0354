//! Keys of a figure, set in lines outside the plotted area.

use super::canvas::{Anchor, Canvas, Colour, Point, Stroke, TextLook};
use super::fonts::Face;
use super::look;
use super::marks::{self, MotionLook, Shape};
use super::richtext;
use crate::locale::Locale;
use crate::phrase::Text;

/// The sign before a key's text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sign {
    /// A mark of a motion.
    Mark(MotionLook),
    /// A line.
    Line(Stroke),
    /// A patch of colour.
    Patch(Colour),
    /// A bar with ends, as brackets are drawn.
    Bracket(Colour),
    /// Nothing: a heading.
    Nothing,
}

impl Sign {
    /// A filled dot.
    pub fn dot(colour: Colour) -> Self {
        Self::shape(Shape::Dot, colour)
    }

    /// An open circle.
    pub(crate) fn ring(colour: Colour) -> Self {
        Self::shape(Shape::Circle, colour)
    }

    fn shape(shape: Shape, colour: Colour) -> Self {
        Self::Mark(MotionLook {
            shape,
            colour,
            tint: look::PAPER,
        })
    }

    /// Its width, points; that of a heading takes back the gap after a sign.
    fn width(self) -> f64 {
        match self {
            Self::Mark(_) => 7.0,
            Self::Line(_) => 15.0,
            Self::Patch(_) => 10.0,
            Self::Bracket(_) => 11.0,
            Self::Nothing => -SIGN_GAP,
        }
    }
}

/// A key: sign and text.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    /// The sign.
    pub sign: Sign,
    /// The text, with markup.
    pub text: Text,
}

impl Key {
    /// A key.
    pub fn new(sign: Sign, text: impl Into<Text>) -> Self {
        Self {
            sign,
            text: text.into(),
        }
    }

    fn width(&self, locale: Locale<'_>) -> f64 {
        let text = locale.text(&self.text);
        self.sign.width() + SIGN_GAP + richtext::width(&text, Face::Regular, look::NOTE_SIZE)
    }
}

/// Distance of the keys' lines, points.
const LINE_HEIGHT: f64 = 11.0;
/// Room between two keys of a line, points.
const GAP: f64 = 11.0;
/// Room between a key's sign and its text, points.
const SIGN_GAP: f64 = 3.0;

/// Lays keys in lines of a width: (key, left, line).
fn flow<'a>(keys: &'a [Key], width: f64, locale: Locale<'_>) -> Vec<(&'a Key, f64, usize)> {
    let (mut x, mut line) = (0.0, 0);
    keys.iter()
        .map(|key| {
            let wide = key.width(locale);
            if x > 0.0 && x + wide > width {
                x = 0.0;
                line += 1;
            }
            let place = (key, x, line);
            x += wide + GAP;
            place
        })
        .collect()
}

/// Height that the keys need at a width.
pub fn height(keys: &[Key], width: f64, locale: Locale<'_>) -> f64 {
    flow(keys, width, locale)
        .last()
        .map_or(0.0, |(_, _, line)| (*line + 1) as f64 * LINE_HEIGHT)
}

/// Draws the keys from an upper left corner.
pub fn draw(
    canvas: &mut Canvas,
    (left, top): (f64, f64),
    width: f64,
    keys: &[Key],
    locale: Locale<'_>,
) {
    for (key, x, line) in flow(keys, width, locale) {
        let y = top + (line as f64 + 0.5) * LINE_HEIGHT;
        sign(canvas, (left + x, y), key.sign);
        let at = (
            left + x + key.sign.width() + SIGN_GAP,
            y + 0.33 * look::NOTE_SIZE,
        );
        let text_look = TextLook::new(look::NOTE_SIZE, Anchor::Left).colour(look::INK);
        canvas.text(at, &locale.text(&key.text), text_look);
    }
}

fn sign(canvas: &mut Canvas, (x, y): (f64, f64), sign: Sign) {
    let end = x + sign.width();
    match sign {
        Sign::Mark(mark) => marks::draw(canvas, (x + 3.5, y), 2.6, mark),
        Sign::Line(stroke) => canvas.segment((x, y), (end, y), stroke),
        Sign::Patch(colour) => patch(canvas, ((x, y - 3.5), (end, y + 3.5)), colour),
        Sign::Bracket(colour) => bracket(canvas, (x, end), y, colour),
        Sign::Nothing => {}
    }
}

/// A patch of colour with a hair line about it, so that a white one is seen.
fn patch(canvas: &mut Canvas, (from, to): (Point, Point), colour: Colour) {
    canvas.rectangle(from, to, colour);
    let corners = [from, (to.0, from.1), to, (from.0, to.1), from];
    canvas.line(&corners, Stroke::solid(look::FRAME, 0.3));
}

/// A measured bracket: a bar with ends.
pub(crate) fn bracket(canvas: &mut Canvas, (from, to): (f64, f64), y: f64, colour: Colour) {
    let casing = Stroke::solid(look::PAPER, 2.4);
    canvas.segment((from - 0.6, y), (to + 0.6, y), casing);
    canvas.segment((from, y), (to, y), Stroke::solid(colour, 1.3));
    for x in [from, to] {
        canvas.segment((x, y - 2.4), (x, y + 2.4), Stroke::solid(colour, 0.8));
    }
}
