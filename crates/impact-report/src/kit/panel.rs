//! A panel: a rectangle on paper with two axes, from data to points, with frame, numbers and titles.

use super::axis::Axis;
use super::canvas::{Anchor, Canvas, Point, Stroke, TextLook};
use super::fonts::{self, Face};
use super::look;
use super::path::{self, Rect};
use super::richtext;
use crate::locale::Locale;

/// How far in points a number below may reach beyond the panel's sides.
const MOST_OVERHANG: f64 = 5.5;

/// Room left of the first panel of two beside each other, points.
pub(crate) const PAIR_LEFT: f64 = 36.0;

/// Two panels beside each other over the whole width.
pub(crate) fn pair(top: f64, height: f64) -> [Rect; 2] {
    [
        Rect::new(PAIR_LEFT, top, 196.0, height),
        Rect::new(280.0, top, 198.0, height),
    ]
}

/// Which sides of a panel carry ticks and labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sides {
    /// Numbers and title below.
    pub below: bool,
    /// Numbers and title on the left.
    pub left: bool,
}

impl Sides {
    /// Both.
    pub const BOTH: Self = Self {
        below: true,
        left: true,
    };
}

/// A rectangle on paper with two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// The plotted area.
    pub rect: Rect,
    /// Across.
    pub x: Axis,
    /// Upward.
    pub y: Axis,
    /// Distance of the title of the upward axis from the frame; `None`: beside its numbers.
    title_reach: Option<f64>,
}

impl Panel {
    /// A panel.
    pub fn new(rect: Rect, x: Axis, y: Axis) -> Self {
        Self {
            rect,
            x,
            y,
            title_reach: None,
        }
    }

    /// With the title of the upward axis at a distance, in line with other panels' titles.
    #[must_use]
    pub fn with_title_reach(self, reach: f64) -> Self {
        Self {
            title_reach: Some(reach),
            ..self
        }
    }

    /// Position of a pair of values on paper.
    pub fn at(&self, x: f64, y: f64) -> Point {
        (
            self.rect.left + self.x.share(x) * self.rect.width(),
            self.rect.bottom - self.y.share(y) * self.rect.height(),
        )
    }

    /// Whether a pair of values is within the axes.
    pub(crate) fn shows(&self, x: f64, y: f64) -> bool {
        x >= self.x.low && x <= self.x.high && y >= self.y.low && y <= self.y.high
    }

    /// A curve through data, clipped and thinned; gives what was drawn, in points.
    pub fn curve(
        &self,
        canvas: &mut Canvas,
        data: impl IntoIterator<Item = (f64, f64)>,
        stroke: Stroke,
    ) -> Vec<Vec<Point>> {
        let points: Vec<Point> = data.into_iter().map(|(x, y)| self.at(x, y)).collect();
        let pieces: Vec<_> = path::clip(&points, &self.rect)
            .iter()
            .map(|p| path::thin(p))
            .collect();
        for piece in &pieces {
            canvas.line(piece, stroke);
        }
        pieces
    }

    /// A horizontal line at a value.
    pub fn level(&self, canvas: &mut Canvas, y: f64, stroke: Stroke) {
        self.curve(canvas, [(self.x.low, y), (self.x.high, y)], stroke);
    }

    /// A vertical line at a value.
    pub(crate) fn upright(&self, canvas: &mut Canvas, x: f64, stroke: Stroke) {
        self.curve(canvas, [(x, self.y.low), (x, self.y.high)], stroke);
    }

    /// An error bar: upright from low to high at x.
    pub(crate) fn error_bar(
        &self,
        canvas: &mut Canvas,
        x: f64,
        (low, high): (f64, f64),
        stroke: Stroke,
    ) {
        self.curve(canvas, [(x, low), (x, high)], stroke);
    }

    /// Frame, ticks, numbers and titles.
    pub fn frame(&self, canvas: &mut Canvas, sides: Sides, locale: Locale<'_>) {
        let r = &self.rect;
        canvas.outline(&r.corners(), look::FRAME_STROKE);
        self.ticks_below(canvas, sides.below, locale);
        self.ticks_left(canvas, sides.left, locale);
    }

    fn ticks_below(&self, canvas: &mut Canvas, labels: bool, locale: Locale<'_>) {
        let (ticks, decimals) = self.x.major();
        let bottom = self.rect.bottom;
        let mut taken = f64::NEG_INFINITY;
        for v in ticks {
            let (x, _) = self.at(v, self.y.low);
            canvas.segment((x, bottom), (x, bottom - 2.5), look::FRAME_STROKE);
            let text = self.x.label(v, decimals, locale);
            let half = 0.5 * fonts::width(&text, Face::Regular, look::TICK_SIZE);
            let (least, most) = (
                self.rect.left - MOST_OVERHANG + half,
                self.rect.right + MOST_OVERHANG - half,
            );
            let middle = x.min(most).max(least);
            if labels && middle - half > taken {
                let text_look = TextLook::new(look::TICK_SIZE, Anchor::Middle).colour(look::INK);
                canvas.text((middle, bottom + look::TICK_SIZE + 1.5), &text, text_look);
                taken = middle + half + 3.0;
            }
        }
        if labels {
            let middle = 0.5 * (self.rect.left + self.rect.right);
            let text_look = TextLook::new(look::TITLE_SIZE, Anchor::Middle).colour(look::INK);
            let title = locale.text(&self.x.title);
            canvas.text((middle, bottom + 19.5), &title, text_look);
        }
    }

    fn ticks_left(&self, canvas: &mut Canvas, labels: bool, locale: Locale<'_>) {
        if self.y.ticks == 0 {
            return;
        }
        let (ticks, decimals) = self.y.major();
        let left = self.rect.left;
        let stride = self.label_stride(&ticks);
        for v in ticks {
            let (_, y) = self.at(self.x.low, v);
            canvas.segment((left, y), (left + 2.5, y), look::FRAME_STROKE);
            if labels && stride.is_none_or(|s| (v / s - (v / s).round()).abs() < 1e-6) {
                let text = self.y.label(v, decimals, locale);
                let text_look = TextLook::new(look::TICK_SIZE, Anchor::Right).colour(look::INK);
                canvas.text((left - 3.0, y + 0.33 * look::TICK_SIZE), &text, text_look);
            }
        }
        if labels {
            self.title_left(canvas, locale);
        }
    }

    /// If numbers on the left would overlap: those that are multiples of this are
    /// printed.
    fn label_stride(&self, ticks: &[f64]) -> Option<f64> {
        let [first, second, ..] = ticks else {
            return None;
        };
        let apart = self.rect.height() * (self.y.share(*second) - self.y.share(*first));
        // digits are lower than their type is high
        let fold = (0.8 * look::TICK_SIZE / apart).ceil();
        (!self.y.log && fold > 1.0).then_some(fold * (second - first))
    }

    /// The title of the upward axis; line feeds part it into lines.
    fn title_left(&self, canvas: &mut Canvas, locale: Locale<'_>) {
        let reach = self.title_reach.unwrap_or(7.0 + self.widest_label(locale));
        let middle = 0.5 * (self.rect.top + self.rect.bottom);
        let title = locale.text(&self.y.title);
        let lines: Vec<&str> = title.lines().collect();
        let title_look = TextLook {
            upward: true,
            ..TextLook::new(self.title_size(&lines), Anchor::Middle)
        };
        for (i, line) in lines.iter().enumerate() {
            let x = self.rect.left - reach - 8.5 * (lines.len() - 1 - i) as f64;
            canvas.text((x, middle), line, title_look.colour(look::INK));
        }
    }

    /// Size of the title of the upward axis: that of a low panel, whose title is in lines, may not
    /// reach into the next one's.
    fn title_size(&self, lines: &[&str]) -> f64 {
        /// How far a title may reach beyond its panel, points.
        const SLACK: f64 = 3.5;
        let room = self.rect.height() + SLACK;
        let widths = lines
            .iter()
            .map(|l| richtext::width(l, Face::Regular, look::TITLE_SIZE));
        match widths.fold(0.0, f64::max) {
            widest if lines.len() > 1 && widest > room => look::TITLE_SIZE * room / widest,
            _ => look::TITLE_SIZE,
        }
    }

    /// Width of the widest number on the left.
    fn widest_label(&self, locale: Locale<'_>) -> f64 {
        let (ticks, decimals) = self.y.major();
        ticks
            .iter()
            .map(|&v| {
                fonts::width(
                    &self.y.label(v, decimals, locale),
                    Face::Regular,
                    look::TICK_SIZE,
                )
            })
            .fold(0.0, f64::max)
    }
}
