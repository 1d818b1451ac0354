//! The regions of motion of a simulated grid: tints with smoothed edges, hatched where two motions
//! are possible.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "cells are counted in isize, which holds the few of a map; negative ones are tested for"
)]

mod labels;

use crate::kit::canvas::{Canvas, Colour, Point, Stroke};
use crate::kit::look;
use crate::kit::marks;
use crate::kit::panel::Panel;
use crate::kit::path;
use impact_identification::replay::RegionMap;
use impact_records::motion::Motion;
use impact_records::signal::whole;

/// Regions smaller than this share of the map get no label and no outline.
const LEAST_SHARE: f64 = 0.0025;

/// The motions of a map in the order of legends; the rarest left out beyond a number.
pub fn commonest(map: &RegionMap, most: usize) -> Vec<&Motion> {
    let mut counts = vec![0_usize; map.motions.len()];
    for &cell in map.cells.iter().chain(&map.second) {
        if let Some(count) = counts.get_mut(usize::from(cell)) {
            *count += 1;
        }
    }
    let mut order: Vec<usize> = (0..counts.len()).filter(|&k| counts[k] > 0).collect();
    order.sort_by_key(|&k| std::cmp::Reverse(counts[k]));
    order.truncate(most);
    order.sort_by_key(|&k| marks::order(&map.motions[k]));
    order.into_iter().map(|k| &map.motions[k]).collect()
}

/// A map laid on a panel, with its connected regions.
pub struct Regions<'a> {
    map: &'a RegionMap,
    panel: &'a Panel,
    /// Region of each cell, and each region's number of cells.
    region: Vec<usize>,
    areas: Vec<usize>,
}

/// A run of cells of one motion: its tint, its lower left and its upper right corner.
type Run = (Colour, Point, Point);

impl<'a> Regions<'a> {
    /// Lays a map on a panel. `None` if its axes and cells contradict each other.
    pub fn new(map: &'a RegionMap, panel: &'a Panel) -> Option<Self> {
        let cells = map.x.len() * map.y.len();
        let in_range = map
            .cells
            .iter()
            .all(|&c| usize::from(c) < map.motions.len());
        if map.x.len() < 2 || map.y.len() < 2 || map.cells.len() != cells || !in_range {
            return None;
        }
        let mut regions = Self {
            map,
            panel,
            region: vec![usize::MAX; cells],
            areas: Vec::new(),
        };
        for start in 0..cells {
            if regions.region[start] == usize::MAX {
                let area = regions.flood(start);
                regions.areas.push(area);
            }
        }
        Some(regions)
    }

    /// What a cell is: the motion from the first start, and from the second where it differs.
    fn kind(&self, index: usize) -> (u16, u16) {
        let first = self.map.cells[index];
        let second = self.map.second.get(index).copied().unwrap_or(first);
        let known = usize::from(second) < self.map.motions.len();
        (first, if known { second } else { first })
    }

    fn flood(&mut self, start: usize) -> usize {
        let (columns, rows) = (self.map.x.len(), self.map.y.len());
        let (number, kind) = (self.areas.len(), self.kind(start));
        let mut open = vec![start];
        let mut area = 0;
        while let Some(index) = open.pop() {
            if self.region[index] != usize::MAX || self.kind(index) != kind {
                continue;
            }
            self.region[index] = number;
            area += 1;
            let (i, j) = (index % columns, index / columns);
            let next = [(i > 0, -1), (i + 1 < columns, 1)];
            let beside = next
                .iter()
                .filter(|n| n.0)
                .map(|n| index.wrapping_add_signed(n.1));
            open.extend(beside);
            if j > 0 {
                open.push(index - columns);
            }
            if j + 1 < rows {
                open.push(index + columns);
            }
        }
        area
    }

    /// Draws tints, outlines and the hatching of hysteresis.
    pub fn draw(&self, canvas: &mut Canvas) {
        let (columns, rows) = (self.map.x.len() as isize, self.map.y.len() as isize);
        let mut runs: Vec<Run> = Vec::new();
        for j in -1..rows {
            self.even_runs(&mut runs, j, columns);
        }
        runs.sort_by_key(|run| order(run.0));
        for (tint, lower, upper) in runs {
            self.patch(canvas, lower, upper, tint);
        }
        let mut mixed = Mixed::default();
        for j in -1..rows {
            for i in -1..columns {
                self.add_mixed(&mut mixed, i, j);
            }
        }
        mixed.draw(canvas);
        self.hatch(canvas);
    }

    fn tint(&self, cell: usize) -> Colour {
        let (first, _) = self.kind(cell);
        marks::of(&self.map.motions[usize::from(first)]).tint
    }

    /// Index of a grid cell, held to the grid.
    fn cell(&self, i: isize, j: isize) -> usize {
        let (columns, rows) = (self.map.x.len(), self.map.y.len());
        let clamp = |v: isize, n: usize| v.clamp(0, n as isize - 1) as usize;
        clamp(j, rows) * columns + clamp(i, columns)
    }

    /// Centre of a cell on paper; beyond the grid its outer edge.
    fn centre(&self, i: isize, j: isize) -> Point {
        self.panel.at(along(&self.map.x, i), along(&self.map.y, j))
    }

    fn corners(&self, i: isize, j: isize) -> [(usize, Point); 4] {
        [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            .map(|(a, b)| (self.cell(a, b), self.centre(a, b)))
    }

    fn same_motion(&self, corners: &[(usize, Point); 4]) -> bool {
        corners
            .iter()
            .all(|c| self.map.cells[c.0] == self.map.cells[corners[0].0])
    }

    /// Squares between four centres of one motion, run by run along a row.
    fn even_runs(&self, runs: &mut Vec<Run>, j: isize, columns: isize) {
        let mut i = -1;
        while i < columns {
            let first = self.corners(i, j);
            let mut end = i + 1;
            if self.same_motion(&first) {
                while end < columns
                    && self.same_motion(&self.corners(end, j))
                    && self.map.cells[self.cell(end, j)] == self.map.cells[first[0].0]
                {
                    end += 1;
                }
            }
            let (lower, upper) = (self.centre(i, j), self.centre(end, j + 1));
            runs.push((self.tint(first[0].0), lower, upper));
            i = end;
        }
    }

    /// A rectangle, a hair larger than it is so that no seam shows.
    fn patch(&self, canvas: &mut Canvas, lower: Point, upper: Point, tint: Colour) {
        if tint == look::PAPER {
            return;
        }
        let r = &self.panel.rect;
        let (left, right) = ((lower.0 - 0.1).max(r.left), (upper.0 + 0.1).min(r.right));
        let (top, bottom) = ((upper.1 - 0.1).max(r.top), (lower.1 + 0.1).min(r.bottom));
        if right > left && bottom > top {
            canvas.rectangle((left, top), (right, bottom), tint);
        }
    }

    /// A square whose corners differ: each motion gets its corners, cut straight between.
    fn add_mixed(&self, mixed: &mut Mixed, i: isize, j: isize) {
        let corners = self.corners(i, j);
        if self.same_motion(&corners) {
            return;
        }
        let kinds = corners.map(|c| self.map.cells[c.0]);
        let saddle = kinds[0] == kinds[2] && kinds[1] == kinds[3];
        let centre = (saddle || distinct(kinds) > 2).then(|| middle(corners[0].1, corners[2].1));
        for start in (0..4).filter(|&s| kinds[s] != kinds[(s + 3) % 4]) {
            let run = (0..4)
                .take_while(|k| kinds[(start + k) % 4] == kinds[start])
                .count();
            let (last, after) = ((start + run - 1) % 4, (start + run) % 4);
            let mut polygon: Vec<Point> = (0..run).map(|k| corners[(start + k) % 4].1).collect();
            let edge = [
                Some(middle(corners[last].1, corners[after].1)),
                centre,
                Some(middle(corners[(start + 3) % 4].1, corners[start].1)),
            ];
            let edge: Vec<Point> = edge.into_iter().flatten().collect();
            polygon.extend(&edge);
            let polygon = path::clip_polygon(&polygon, &self.panel.rect);
            mixed.parts.push((self.tint(corners[start].0), polygon));
            if kinds[start] > kinds[after]
                && self.is_large(corners[start].0)
                && self.is_large(corners[after].0)
            {
                mixed.outlines.extend(path::clip(&edge, &self.panel.rect));
            }
        }
    }

    fn is_large(&self, cell: usize) -> bool {
        let area = self.areas[self.region[cell]] as f64;
        area >= LEAST_SHARE * self.region.len() as f64
    }

    /// Diagonal lines where two starts give two motions, in the second motion's colour.
    fn hatch(&self, canvas: &mut Canvas) {
        if self.map.second.len() != self.map.cells.len() {
            return;
        }
        let r = self.panel.rect;
        let lines = whole::index((r.width() + r.height()) / 5.0);
        let mut segments = Vec::new();
        for line in 0..lines {
            let start = (r.left + 5.0 * line as f64 - r.height(), r.bottom);
            self.hatch_line(&mut segments, start, r.height());
        }
        segments.sort_by_key(|(colour, _)| order(*colour));
        for (colour, [from, to]) in segments {
            canvas.segment(from, to, Stroke::solid(colour, 0.35));
        }
    }

    fn hatch_line(&self, segments: &mut Vec<(Colour, [Point; 2])>, (x0, y0): Point, length: f64) {
        let steps = whole::index(length.floor());
        let second_at = |k: usize| {
            let cell = self.cell_at((x0 + k as f64, y0 - k as f64))?;
            let (first, second) = self.kind(cell);
            (first != second).then_some(second)
        };
        let mut k = 0;
        while k < steps {
            let Some(second) = second_at(k) else {
                k += 1;
                continue;
            };
            let end = (k..=steps)
                .find(|&e| second_at(e) != Some(second))
                .unwrap_or(steps);
            let colour = marks::mix(
                marks::of(&self.map.motions[usize::from(second)]).colour,
                0.45,
            );
            let point = |k: usize| (x0 + k as f64, y0 - k as f64);
            segments.push((colour, [point(k), point(end)]));
            k = end.max(k + 1);
        }
    }

    fn cell_at(&self, (x, y): Point) -> Option<usize> {
        Some(self.cell(self.column_at(x)?, self.row_at(y)?))
    }

    /// The column of cells at a place across the paper.
    fn column_at(&self, x: f64) -> Option<isize> {
        let (r, axis) = (&self.panel.rect, &self.panel.x);
        let share = (r.left..=r.right)
            .contains(&x)
            .then(|| (x - r.left) / r.width())?;
        nearest(&self.map.x, axis.low + share * (axis.high - axis.low))
    }

    /// The row of cells at a place down the paper.
    fn row_at(&self, y: f64) -> Option<isize> {
        let (r, axis) = (&self.panel.rect, &self.panel.y);
        let share = (r.top..=r.bottom)
            .contains(&y)
            .then(|| (r.bottom - y) / r.height())?;
        nearest(&self.map.y, axis.low + share * (axis.high - axis.low))
    }
}

/// Value of an evenly spaced axis at an index; half a step beyond either end its outer edge.
fn along(values: &[f64], index: isize) -> f64 {
    let last = values.len() as isize - 1;
    if index < 0 {
        values[0] - 0.5 * (values[1] - values[0])
    } else if index > last {
        let n = values.len();
        values[n - 1] + 0.5 * (values[n - 1] - values[n - 2])
    } else {
        values[index as usize]
    }
}

fn nearest(values: &[f64], value: f64) -> Option<isize> {
    let step = (values[values.len() - 1] - values[0]) / (values.len() - 1) as f64;
    let index = ((value - values[0]) / step).round();
    (index >= -0.51 && index <= values.len() as f64 - 0.49).then_some(index.max(0.0) as isize)
}

fn middle(a: Point, b: Point) -> Point {
    (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1))
}

fn distinct(kinds: [u16; 4]) -> usize {
    (0..4).filter(|&i| !kinds[..i].contains(&kinds[i])).count()
}

/// The squares whose corners differ: parts of one tint are drawn together, outlines over all of them.
#[derive(Default)]
struct Mixed {
    parts: Vec<(Colour, Vec<Point>)>,
    outlines: Vec<Vec<Point>>,
}

impl Mixed {
    fn draw(mut self, canvas: &mut Canvas) {
        self.parts.sort_by_key(|part| order(part.0));
        for (tint, polygon) in &self.parts {
            canvas.fill(polygon, *tint);
        }
        for piece in &self.outlines {
            canvas.line(piece, Stroke::solid(marks::mix(look::FRAME, 0.45), 0.3));
        }
    }
}

/// In which order colours are drawn: those of one colour together.
fn order(colour: Colour) -> [u8; 3] {
    [colour.0, colour.1, colour.2]
}
