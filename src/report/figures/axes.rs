//! Axes and panels: from data to points on paper, ticks, titles, frames.

use super::canvas::{Anchor, Canvas, Point, Stroke, TextLook};
use super::fonts::{self, Face};
use super::look::{self, NumberLook};
use super::path::{self, Rect};
use super::richtext;

/// How far in points a number below may reach beyond the panel's sides.
const MOST_OVERHANG: f64 = 5.5;

/// One axis: its range in data and its title with unit, in the report's markup.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Least value shown.
    pub low: f64,
    /// Greatest value shown.
    pub high: f64,
    /// Title with unit; empty for none.
    pub title: String,
    /// Whether it counts in powers of ten.
    pub log: bool,
    /// Wanted number of ticks; none at all for 0.
    pub ticks: usize,
}

impl Axis {
    /// A linear axis.
    pub fn new(low: f64, high: f64, title: impl Into<String>) -> Self {
        let (low, high) = if high > low {
            (low, high)
        } else {
            (low - 0.5, low + 0.5)
        };
        Self {
            low,
            high,
            title: title.into(),
            log: false,
            ticks: 5,
        }
    }

    /// An axis that shows all values with a margin (a share of their range) at either end.
    pub fn around(
        values: impl IntoIterator<Item = f64>,
        margin: f64,
        title: impl Into<String>,
    ) -> Self {
        let (low, high) = range(values).unwrap_or((0.0, 1.0));
        let alone = if high == 0.0 { 1.0 } else { 0.05 * high.abs() };
        let pad = if high > low {
            margin * (high - low)
        } else {
            alone
        };
        Self::new(low - pad, high + pad, title)
    }

    /// With another wanted number of ticks.
    pub fn with_ticks(self, ticks: usize) -> Self {
        Self { ticks, ..self }
    }

    /// Counting in powers of ten; both ends must be positive.
    pub fn logarithmic(self) -> Self {
        let log = self.low > 0.0;
        Self { log, ..self }
    }

    /// Share of the way from low to high.
    pub fn share(&self, value: f64) -> f64 {
        if self.log {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// Values of the labelled ticks, and the decimals their labels need.
    pub fn major(&self) -> (Vec<f64>, usize) {
        if self.log {
            return (self.decades(), 0);
        }
        let span = self.high - self.low;
        let wanted = self.ticks.max(1);
        let tries = (wanted..=wanted + 4).map(|ticks| nice_step(span / ticks as f64));
        let ticks = tries.map(|step| (multiples(self.low, self.high, step), decimals_of(step)));
        // One number alone does not tell a scale.
        let mut best = (Vec::new(), 0);
        for found in ticks {
            best = found;
            if best.0.len() >= 2 {
                break;
            }
        }
        best
    }

    fn decades(&self) -> Vec<f64> {
        let span = (self.high / self.low).log10();
        let per: &[f64] = if span > 3.0 {
            &[1.0]
        } else if span > 1.5 {
            &[1.0, 3.0]
        } else {
            &[1.0, 2.0, 5.0]
        };
        let first = self.low.log10().floor() as i32;
        let last = self.high.log10().ceil() as i32;
        (first..=last)
            .flat_map(|e| per.iter().map(move |m| m * 10f64.powi(e)))
            .filter(|v| *v >= self.low * (1.0 - 1e-9) && *v <= self.high * (1.0 + 1e-9))
            .collect()
    }

    /// Label of a tick.
    pub fn label(&self, value: f64, decimals: usize, numbers: NumberLook) -> String {
        if self.log {
            numbers.significant(value, 1)
        } else {
            numbers.fixed(value, decimals)
        }
    }
}

/// Least and greatest of the finite values.
pub fn range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values
        .into_iter()
        .filter(|v| v.is_finite())
        .fold(None, |seen, v| match seen {
            None => Some((v, v)),
            Some((low, high)) => Some((low.min(v), high.max(v))),
        })
}

/// The next of 1, 2, 5 times a power of ten.
fn nice_step(rough: f64) -> f64 {
    let power = 10f64.powf(rough.log10().floor());
    let multiple = rough / power;
    let nice = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|m| multiple <= m * 1.000_001)
        .unwrap_or(10.0);
    nice * power
}

fn multiples(low: f64, high: f64, step: f64) -> Vec<f64> {
    let slack = 1e-9 * (high - low);
    let first = ((low - slack) / step).ceil() as i64;
    let last = ((high + slack) / step).floor() as i64;
    (first..=last).map(|i| i as f64 * step).collect()
}

fn decimals_of(step: f64) -> usize {
    (-(step * 1.000_001).log10().floor()).max(0.0) as usize
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
    /// How far left of the frame the title of the upward axis stands; `None`: beside its numbers.
    pub title_reach: Option<f64>,
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
    pub fn with_title_reach(self, reach: f64) -> Self {
        Self {
            title_reach: Some(reach),
            ..self
        }
    }

    /// Where a pair of values lies on paper.
    pub fn at(&self, x: f64, y: f64) -> Point {
        (
            self.rect.left + self.x.share(x) * self.rect.width(),
            self.rect.bottom - self.y.share(y) * self.rect.height(),
        )
    }

    /// Whether a pair of values lies within the axes.
    pub fn shows(&self, x: f64, y: f64) -> bool {
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
    pub fn upright(&self, canvas: &mut Canvas, x: f64, stroke: Stroke) {
        self.curve(canvas, [(x, self.y.low), (x, self.y.high)], stroke);
    }

    /// An error bar: upright from low to high at x.
    pub fn error_bar(&self, canvas: &mut Canvas, x: f64, (low, high): (f64, f64), stroke: Stroke) {
        self.curve(canvas, [(x, low), (x, high)], stroke);
    }

    /// A pale grid at the labelled ticks.
    pub fn grid(&self, canvas: &mut Canvas) {
        for v in self.x.major().0 {
            self.upright(canvas, v, look::GRID_STROKE);
        }
        for v in self.y.major().0 {
            self.level(canvas, v, look::GRID_STROKE);
        }
    }

    /// Frame, ticks, numbers and titles.
    pub fn frame(&self, canvas: &mut Canvas, sides: Sides, numbers: NumberLook) {
        let r = &self.rect;
        let corners = [
            (r.left, r.top),
            (r.right, r.top),
            (r.right, r.bottom),
            (r.left, r.bottom),
            (r.left, r.top),
            (r.right, r.top),
        ];
        canvas.line(&corners, look::FRAME_STROKE);
        self.ticks_below(canvas, sides.below, numbers);
        self.ticks_left(canvas, sides.left, numbers);
    }

    fn ticks_below(&self, canvas: &mut Canvas, labels: bool, numbers: NumberLook) {
        let (ticks, decimals) = self.x.major();
        let bottom = self.rect.bottom;
        let mut taken = f64::NEG_INFINITY;
        for v in ticks {
            let (x, _) = self.at(v, self.y.low);
            canvas.segment((x, bottom), (x, bottom - 2.5), look::FRAME_STROKE);
            let text = self.x.label(v, decimals, numbers);
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
            let title = numbers.say_title(&self.x.title);
            canvas.text((middle, bottom + 19.5), &title, text_look);
        }
    }

    fn ticks_left(&self, canvas: &mut Canvas, labels: bool, numbers: NumberLook) {
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
                let text = self.y.label(v, decimals, numbers);
                let text_look = TextLook::new(look::TICK_SIZE, Anchor::Right).colour(look::INK);
                canvas.text((left - 3.0, y + 0.33 * look::TICK_SIZE), &text, text_look);
            }
        }
        if labels {
            self.title_left(canvas, numbers);
        }
    }

    /// Where numbers on the left would stand on each other: those that are multiples of this are
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
    fn title_left(&self, canvas: &mut Canvas, numbers: NumberLook) {
        let reach = self.title_reach.unwrap_or(7.0 + self.widest_label(numbers));
        let middle = 0.5 * (self.rect.top + self.rect.bottom);
        let title = numbers.say_title(&self.y.title);
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
    pub fn widest_label(&self, numbers: NumberLook) -> f64 {
        let (ticks, decimals) = self.y.major();
        ticks
            .iter()
            .map(|&v| {
                fonts::width(
                    &self.y.label(v, decimals, numbers),
                    Face::Regular,
                    look::TICK_SIZE,
                )
            })
            .fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn valid_ticks_are_round_numbers() {
        let (ticks, decimals) = Axis::new(0.93, 2.07, "").major();
        assert_eq!(decimals, 1);
        let labels: Vec<_> = ticks.iter().map(|t| format!("{t:.1}")).collect();
        assert_eq!(labels, ["1.0", "1.5", "2.0"]);
    }

    proptest! {
        #[test]
        fn prop_ticks_lie_within_and_are_few(low in -1e3..1e3f64, span in 1e-6..1e4f64) {
            let axis = Axis::new(low, low + span, "");
            let (ticks, _) = axis.major();
            prop_assert!((2..=6).contains(&ticks.len()), "{ticks:?}");
            prop_assert!(ticks.iter().all(|t| *t >= low - 1e-6 * span && *t <= low + span * 1.000_001));
        }
    }
}
