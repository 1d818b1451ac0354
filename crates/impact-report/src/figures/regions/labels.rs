//! The labels of the regions.

use super::{LEAST_SHARE, Regions};
use crate::kit::canvas::{Anchor, Canvas, Point, TextLook};
use crate::kit::fonts::{self, Face};
use crate::kit::look;
use crate::kit::path::Rect;
use crate::kit::placing::Occupancy;
use crate::locale::Locale;

impl Regions<'_> {
    /// Draws a label in each region that is large enough, where nothing else is drawn.
    pub fn draw_labels(
        &self,
        canvas: &mut Canvas,
        occupancy: &mut Occupancy,
        size: f64,
        locale: Locale<'_>,
    ) {
        let mut order: Vec<usize> = (0..self.areas.len()).collect();
        order.sort_by_key(|&r| std::cmp::Reverse(self.areas[r]));
        let least = LEAST_SHARE * self.region.len() as f64;
        let large = order
            .into_iter()
            .take_while(|&r| self.areas[r] as f64 >= least);
        for region in large {
            for size in [size, 0.8 * size] {
                if let Some((text, (x, y))) = self.label(region, locale, occupancy, size) {
                    let bold = TextLook::new(size, Anchor::Middle).face(Face::Bold);
                    canvas.text((x, y + 0.33 * size), &text, bold.colour(look::INK));
                    break;
                }
            }
        }
    }

    /// The text of a region's label and the middle of its place.
    fn label(
        &self,
        region: usize,
        locale: Locale<'_>,
        occupancy: &mut Occupancy,
        size: f64,
    ) -> Option<(String, Point)> {
        let first_cell = self.region.iter().position(|&r| r == region)?;
        let text = self.name(first_cell, locale);
        let half = (
            0.5 * fonts::width(&text, Face::Bold, size) + 3.0,
            0.5 * size + 1.5,
        );
        let (x, y) = self.roomiest(region, half, occupancy)?;
        occupancy.take_rect(&Rect::new(
            x - half.0,
            y - half.1,
            2.0 * half.0,
            2.0 * half.1,
        ));
        Some((text, (x, y)))
    }

    /// Where a region has most room for a text of a half size.
    fn roomiest(&self, region: usize, half: Point, taken: &Occupancy) -> Option<Point> {
        let columns = self.map.x.len();
        let here = self
            .region
            .iter()
            .enumerate()
            .filter(|(_, r)| **r == region);
        let mut best: Option<(f64, Point)> = None;
        for (index, _) in here {
            let at = self.centre((index % columns) as isize, (index / columns) as isize);
            let least = best.map_or(f64::NEG_INFINITY, |(room, _)| room);
            if let Some(room) = self.room(region, at, half, taken, least) {
                best = Some((room, at));
            }
        }
        best.map(|(_, at)| at)
    }

    fn name(&self, cell: usize, locale: Locale<'_>) -> String {
        let (first, second) = self.kind(cell);
        let label = |k: u16| locale.motion(&self.map.motions[usize::from(k)]);
        if first == second {
            label(first)
        } else {
            format!("{}, {}", label(first), label(second))
        }
    }

    /// How much free area surrounds a text of a half size at a place: `None` if it leaves the region,
    /// or if the area is below the least.
    fn room(
        &self,
        region: usize,
        at: Point,
        half: Point,
        taken: &Occupancy,
        least: f64,
    ) -> Option<f64> {
        const STEPS: [f64; 5] = [3.0, 6.0, 10.0, 15.0, 22.0];
        // the corners of the text's box and the middles of its sides
        let inside = |grow: f64| {
            let (w, h) = (half.0 + grow, half.1 + grow);
            let columns = [-w, 0.0, w].map(|dx| self.column_at(at.0 + dx));
            let rows = [-h, 0.0, h].map(|dy| self.row_at(at.1 + dy));
            let is_here = |i: usize, j: usize| {
                let (Some(column), Some(row)) = (columns[i], rows[j]) else {
                    return false;
                };
                self.region[self.cell(column, row)] == region
            };
            (0..9).all(|k| k == 4 || is_here(k % 3, k / 3))
        };
        // most places fail at the step that would be needed
        let steps = STEPS.iter().zip(0..);
        let needed = steps.take_while(|(_, k)| f64::from(*k) < least).last();
        if needed.is_some_and(|(step, _)| !inside(*step)) || !inside(0.0) {
            return None;
        }
        let free = STEPS.into_iter().take_while(|g| inside(*g)).count();
        let rect = Rect::new(at.0 - half.0, at.1 - half.1, 2.0 * half.0, 2.0 * half.1);
        let covered = taken.taken(&rect) as f64;
        let room = free as f64 - 0.5 * covered;
        (covered <= 0.08 * rect.width() * rect.height() && room >= least).then_some(room)
    }
}
