//! Placing labels where nothing else is drawn.

use std::ops::Range;

use super::canvas::Point;
use super::path::Rect;
use impact_records::signal::whole;

/// Which square points of a drawing are taken.
pub struct Occupancy {
    columns: usize,
    rows: usize,
    taken: Vec<bool>,
}

impl Occupancy {
    /// An empty drawing of a size in points.
    pub fn new(width: f64, height: f64) -> Self {
        let (columns, rows) = (
            whole::index(width.ceil()) + 1,
            whole::index(height.ceil()) + 1,
        );
        Self {
            columns,
            rows,
            taken: vec![false; columns * rows],
        }
    }

    /// Takes a rectangle.
    pub(crate) fn take_rect(&mut self, rect: &Rect) {
        for row in self.rows_of(rect) {
            for cell in &mut self.taken[row] {
                *cell = true;
            }
        }
    }

    /// Takes a disc's square.
    pub(crate) fn take_spot(&mut self, (x, y): Point, radius: f64) {
        self.take_rect(&Rect::new(
            x - radius,
            y - radius,
            2.0 * radius,
            2.0 * radius,
        ));
    }

    /// Takes what a line covers.
    pub fn take_line(&mut self, points: &[Point]) {
        for pair in points.windows(2) {
            let length = (pair[1].0 - pair[0].0).hypot(pair[1].1 - pair[0].1);
            let steps = whole::index(length.ceil().max(1.0));
            for i in 0..=steps {
                let t = i as f64 / steps as f64;
                let x = pair[0].0 + t * (pair[1].0 - pair[0].0);
                let y = pair[0].1 + t * (pair[1].1 - pair[0].1);
                self.take_rect(&Rect::new(x - 0.5, y - 0.5, 0.9, 0.9));
            }
        }
    }

    /// How many square points of a rectangle are taken.
    pub(crate) fn taken(&self, rect: &Rect) -> usize {
        let taken = |row: Range<usize>| self.taken[row].iter().filter(|taken| **taken).count();
        self.rows_of(rect).map(taken).sum()
    }

    /// The points of a rectangle, row by row.
    fn rows_of(&self, rect: &Rect) -> impl Iterator<Item = Range<usize>> + use<> {
        let clamp = |v: f64, most: usize| whole::index(v.max(0.0)).min(most);
        let columns = self.columns;
        let x = clamp(rect.left, columns)..clamp(rect.right + 1.0, columns);
        let y = clamp(rect.top, self.rows)..clamp(rect.bottom + 1.0, self.rows);
        y.map(move |row| row * columns + x.start..row * columns + x.end)
    }

    /// The best place for a box of a size near a point: its cost (covered area and distance) and
    /// its middle, or `None` if all places within reach are outside the bounds.
    pub(crate) fn near(
        &self,
        point: Point,
        (width, height): (f64, f64),
        bounds: &Rect,
    ) -> Option<(f64, Point)> {
        let candidates = (0..10).flat_map(|ring| {
            (0..16).map(move |turn| (5.0 + 4.0 * f64::from(ring), f64::from(turn) / 16.0))
        });
        let mut best: Option<(f64, Point)> = None;
        for (distance, turn) in candidates {
            // no place costs less than its distance
            if best.is_some_and(|(least, _)| distance >= least) {
                break;
            }
            let angle = std::f64::consts::TAU * (turn + 0.125);
            let x = point.0 + (distance + 0.5 * width) * angle.cos();
            let y = point.1 - (distance + 0.5 * height) * angle.sin();
            let rect = Rect::new(x - 0.5 * width, y - 0.5 * height, width, height);
            let corners = [(rect.left, rect.top), (rect.right, rect.bottom)];
            if !corners.iter().all(|&c| bounds.contains(c)) {
                continue;
            }
            let cost = 3.0 * self.taken(&rect) as f64 + distance;
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, (x, y)));
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_avoids_what_is_taken() {
        let mut occupancy = Occupancy::new(200.0, 200.0);
        occupancy.take_rect(&Rect::new(100.0, 0.0, 100.0, 200.0));
        let bounds = Rect::new(0.0, 0.0, 200.0, 200.0);
        let (_, (x, _)) = occupancy
            .near((98.0, 100.0), (20.0, 8.0), &bounds)
            .expect("a place");
        assert!(x + 10.0 <= 101.0, "{x}");
    }
}
