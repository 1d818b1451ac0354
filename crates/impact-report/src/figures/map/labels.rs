//! The map's labels: names of curves, letters of points, axes in laboratory
//! units.

use super::{Map, STRIP_HALF, STRIP_STEP};
use crate::kit::axis::Axis;
use crate::kit::canvas::{Anchor, Point, Stroke, TextLook};
use crate::kit::fonts::{self, Face};
use crate::kit::look;
use crate::kit::path::Rect;
use crate::kit::richtext;
use crate::locale::Locale;
use crate::phrase::Phrase;
use impact_identification::replay::BoundaryCurve;

impl Map<'_> {
    /// Names a curve beside the middle of its longest visible piece.
    pub(super) fn curve_label(
        &mut self,
        curve: &BoundaryCurve,
        pieces: &[Vec<Point>],
        locale: Locale<'_>,
    ) {
        let length = |p: &[Point]| -> f64 {
            p.windows(2)
                .map(|s| (s[1].0 - s[0].0).hypot(s[1].1 - s[0].1))
                .sum()
        };
        let Some(piece) = pieces.iter().max_by(|a, b| length(a).total_cmp(&length(b))) else {
            return;
        };
        if length(piece) < 30.0 {
            return;
        }
        let symbol = locale.message(&curve.kind);
        let text = match curve.periods_n {
            1 => symbol,
            n => format!("{symbol} (1/{n})"),
        };
        let width = richtext::width(&text, Face::Regular, 8.5) + 2.0;
        let bounds = self.panel.rect;
        let best = (1..20)
            .map(|i| along(piece, 0.05 * f64::from(i) * length(piece)))
            .filter_map(|anchor| self.occupancy.near(anchor, (width, 9.0), &bounds))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, (x, y))) = best {
            self.occupancy
                .take_rect(&Rect::new(x - 0.5 * width, y - 4.5, width, 9.0));
            self.canvas.layer(6);
            let text_look = TextLook::new(8.5, Anchor::Middle).colour(look::INK);
            self.canvas.text((x, y + 2.8), &text, text_look);
        }
    }

    pub(super) fn letters(&mut self) {
        let bounds = self.panel.rect;
        for comparison in &self.content.compared.comparisons {
            let Some(record) = self
                .content
                .compared
                .records
                .iter()
                .find(|r| r.id == comparison.record)
            else {
                continue;
            };
            let Some(at) = self.place(record) else {
                continue;
            };
            self.letter(at, &format!("({})", comparison.letter), &bounds);
        }
        for (i, proposed) in self.content.proposals.iter().enumerate() {
            let (x, y) = self.plane.proposed(proposed);
            if self.panel.shows(x, y) {
                let at = self.panel.at(x, y);
                self.letter(at, &format!("P{}", i + 1), &bounds);
            }
        }
    }

    /// A ring about a point and its letter beside it, if there is a free place.
    fn letter(&mut self, at: Point, text: &str, bounds: &Rect) {
        let size = (fonts::width(text, Face::Bold, 8.5) + 2.0, 9.0);
        let Some((_, place)) = self.occupancy.near(at, size, bounds) else {
            return;
        };
        self.canvas.layer(5);
        self.canvas
            .ring(at, self.radius + 2.0, Stroke::solid(look::INK, 0.7));
        self.leader(at, place, size);
        self.canvas.layer(6);
        let text_look = TextLook::new(8.5, Anchor::Middle)
            .face(Face::Bold)
            .colour(look::INK);
        self.canvas.text((place.0, place.1 + 2.8), text, text_look);
        let rect = Rect::new(place.0 - 0.5 * size.0, place.1 - 4.5, size.0, size.1);
        self.occupancy.take_rect(&rect);
    }

    /// A thin line from a mark to its letter, if they are apart.
    fn leader(&mut self, at: Point, place: Point, size: (f64, f64)) {
        let (dx, dy) = (place.0 - at.0, place.1 - at.1);
        let distance = dx.hypot(dy);
        let stop = (0.5 * size.0 / dx.abs().max(1e-9)).min(0.5 * size.1 / dy.abs().max(1e-9));
        let start = (self.radius + 2.0) / distance;
        if 1.0 - stop - start > 2.0 / distance {
            let point = |t: f64| (at.0 + t * dx, at.1 + t * dy);
            let stroke = Stroke::solid(look::INK, 0.5);
            self.canvas.segment(point(start), point(1.0 - stop), stroke);
        }
    }

    /// Frames and values of the strips above the panel.
    pub(super) fn strip_frames(&mut self, locale: Locale<'_>) {
        let r = self.panel.rect;
        for (i, value) in self.strips.clone().into_iter().enumerate() {
            let middle = self.strip_middle(i);
            let (top, bottom) = (middle - STRIP_HALF, middle + STRIP_HALF);
            let strip = Rect { top, bottom, ..r };
            self.canvas.outline(&strip.corners(), look::FRAME_STROKE);
            let text_look = TextLook::new(look::TICK_SIZE, Anchor::Right).colour(look::INK);
            self.canvas.text(
                (r.left - 3.0, middle + 2.3),
                &locale.fixed(value, 1),
                text_look,
            );
            let x_st = self.plane.static_deflection_m.filter(|_| self.full());
            if let Some(x_st) = x_st.filter(|_| self.plane.dimensionless) {
                let millimetres = locale.fixed(1e3 * x_st * value, 1);
                let text_look = TextLook::new(look::TICK_SIZE, Anchor::Left).colour(look::QUIET);
                self.canvas
                    .text((r.right + 3.0, middle + 2.3), &millimetres, text_look);
            }
        }
    }

    /// Frequency in Hz above and clearance in mm on the right.
    pub(super) fn laboratory_axes(&mut self, locale: Locale<'_>) {
        let r = self.panel.rect;
        let top = r.top - STRIP_STEP * self.strips.len() as f64;
        let small = TextLook::new(look::TICK_SIZE, Anchor::Middle).colour(look::QUIET);
        let title = TextLook::new(look::TITLE_SIZE, Anchor::Middle).colour(look::QUIET);
        if let Some(f0) = self.plane.natural_frequency_hz {
            let axis = Axis::new(self.panel.x.low * f0, self.panel.x.high * f0, "").with_ticks(8);
            let (ticks, decimals) = axis.major();
            for v in ticks {
                let (x, _) = self.panel.at(v / f0, 0.0);
                self.canvas
                    .segment((x, top), (x, top + 2.5), look::FRAME_STROKE);
                self.canvas
                    .text((x, top - 3.0), &locale.fixed(v, decimals), small);
            }
            let at = (0.5 * (r.left + r.right), top - 14.0);
            let name = locale.text(&(Phrase::DriveFrequency, "Hz").into());
            self.canvas.text(at, &name, title);
        }
        if let Some(x_st) = self.plane.static_deflection_m.map(|x| 1e3 * x) {
            let axis =
                Axis::new(self.panel.y.low * x_st, self.panel.y.high * x_st, "").with_ticks(7);
            let (ticks, decimals) = axis.major();
            let left = TextLook {
                anchor: Anchor::Left,
                ..small
            };
            for v in ticks {
                let (_, y) = self.panel.at(0.0, v / x_st);
                self.canvas
                    .segment((r.right, y), (r.right - 2.5, y), look::FRAME_STROKE);
                self.canvas
                    .text((r.right + 3.0, y + 2.3), &locale.fixed(v, decimals), left);
            }
            let at = (r.right + 24.0, 0.5 * (r.top + r.bottom));
            self.canvas.text(
                at,
                &locale.text(&(Phrase::Clearance, "mm").into()),
                TextLook {
                    upward: true,
                    ..title
                },
            );
        }
    }
}

/// The point at a length along a line.
fn along(points: &[Point], mut length: f64) -> Point {
    for pair in points.windows(2) {
        let step = (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1);
        if step >= length && step > 0.0 {
            let t = length / step;
            return (
                pair[0].0 + t * (pair[1].0 - pair[0].0),
                pair[0].1 + t * (pair[1].1 - pair[0].1),
            );
        }
        length -= step;
    }
    points[points.len() - 1]
}
