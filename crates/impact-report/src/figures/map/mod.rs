//! The map of motions: regions, boundaries with their bands, records, brackets, chosen points.

mod data;
mod keys;
mod labels;

use std::collections::{BTreeMap, HashSet};

use crate::content::ReportContent;
use crate::figures::boundaries;
use crate::figures::plane::{Plane, View, edges, same};
use crate::figures::regions::Regions;
use crate::kit::canvas::{Canvas, Point};
use crate::kit::figure::Figure;
use crate::kit::legend::{self, Key};
use crate::kit::look;
use crate::kit::marks;
use crate::kit::panel::{Panel, Sides};
use crate::kit::path::{self, Rect};
use crate::kit::placing::Occupancy;
use crate::locale::Locale;
use crate::phrase::Phrase;
use impact_identification::replay::{BoundaryCurve, BracketRow, RecordRow, RegionMap};
use impact_records::motion::Motion;
use impact_records::record::Sweep;
use impact_records::signal::whole;

/// Which of the two maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MapSize {
    /// The large one over the whole width, with keys, points and both unit systems.
    Full,
    /// The small one of the first page.
    Small,
}

/// Height of a strip with its gap, points.
const STRIP_STEP: f64 = 15.0;
/// Least width of what is drawn as not simulated, points.
const LEAST_BLANK: f64 = 1.0;
/// Half the height of a strip's frame, points.
const STRIP_HALF: f64 = 5.5;

/// Draws the map; `None` if the records have no place in a plane.
pub(crate) fn draw(content: &ReportContent, size: MapSize, locale: Locale<'_>) -> Option<Figure> {
    let plane = Plane::of(content)?;
    let keys = if size == MapSize::Full {
        keys::full(content, plane)
    } else {
        keys::motions(&content.compared)
    };
    let mut map = Map::new(content, plane, size, (&keys, locale));
    // Labels go where records and curves leave room.
    map.take_records_and_curves();
    map.take_brackets();
    map.regions(locale);
    map.curves(locale);
    map.draw_brackets();
    map.records(locale);
    if size == MapSize::Full {
        map.letters();
    }
    map.frame(locale, &keys);
    Some(map.finish(locale))
}

struct Map<'a> {
    content: &'a ReportContent,
    plane: Plane,
    size: MapSize,
    canvas: Canvas,
    panel: Panel,
    /// Clearances above the panel, each in a strip of its own.
    strips: Vec<f64>,
    /// Radius of the marks, points.
    radius: f64,
    occupancy: Occupancy,
}

/// Every other column and row of a region map: enough for a small figure.
fn every_other(map: &RegionMap) -> RegionMap {
    let columns = map.x.len().max(1);
    let kept = |i: usize| (i / columns).is_multiple_of(2) && (i % columns).is_multiple_of(2);
    let of = |cells: &[u16]| -> Vec<u16> {
        let cells = cells.iter().enumerate();
        cells.filter(|(i, _)| kept(*i)).map(|(_, c)| *c).collect()
    };
    RegionMap {
        x: map.x.iter().copied().step_by(2).collect(),
        y: map.y.iter().copied().step_by(2).collect(),
        motions: map.motions.clone(),
        cells: of(&map.cells),
        second: of(&map.second),
    }
}

impl<'a> Map<'a> {
    fn new(
        content: &'a ReportContent,
        plane: Plane,
        size: MapSize,
        (keys, locale): (&[Key], Locale<'_>),
    ) -> Self {
        let full = size == MapSize::Full;
        let flat = content.compared.region_map.is_none() && heights(content, plane) <= 3;
        let (width, height) = match (full, flat) {
            (true, false) => (look::FULL_WIDTH, 370.0),
            (true, true) => (look::FULL_WIDTH, 200.0),
            (false, false) => (look::FRONT_WIDTH, 235.0),
            (false, true) => (look::FRONT_WIDTH, 130.0),
        };
        let keys_height =
            legend::height(keys, width, locale) + if keys.is_empty() { 0.0 } else { 3.0 };
        let both_units = full && plane.dimensionless;
        let (left, right) = (33.0, if both_units { 30.0 } else { 4.0 });
        let View { x, y, strips } = plane.view(content);
        let strips_height = STRIP_STEP * strips.len() as f64;
        let top = keys_height + strips_height + if both_units { 26.0 } else { 3.0 };
        let rect = Rect::new(left, top, width - left - right, height - look::BELOW_PANEL);
        let total = top + height;
        let (x, y) = if full {
            (x, y)
        } else {
            (x.with_ticks(5), y.with_ticks(4))
        };
        let mut map = Self {
            content,
            plane,
            size,
            canvas: Canvas::new(width, total),
            panel: Panel::new(rect, x, y),
            strips,
            radius: 0.0,
            occupancy: Occupancy::new(width, total),
        };
        map.radius = map.fitting_radius();
        map
    }

    fn full(&self) -> bool {
        self.size == MapSize::Full
    }

    fn regions(&mut self, locale: Locale<'_>) {
        let Some(map) = self
            .content
            .compared
            .region_map
            .as_ref()
            .filter(|_| self.plane.dimensionless)
        else {
            return;
        };
        let panel = self.panel.clone();
        let coarse;
        let map = if self.full() {
            map
        } else {
            coarse = every_other(map);
            &coarse
        };
        let Some(regions) = Regions::new(map, &panel) else {
            return;
        };
        self.canvas.layer(0);
        self.blank_around(map);
        regions.draw(&mut self.canvas);
        let size = if self.full() { 10.0 } else { 8.0 };
        self.canvas.layer(6);
        regions.draw_labels(&mut self.canvas, &mut self.occupancy, size, locale);
    }

    /// What the simulated grid does not reach is grey: white is z = 0.
    fn blank_around(&mut self, map: &RegionMap) {
        let r = self.panel.rect;
        let Some(((x0, x1), (y0, y1))) = edges(&map.x).zip(edges(&map.y)) else {
            return;
        };
        let (left, low) = self.panel.at(x0, y0);
        let (right, high) = self.panel.at(x1, y1);
        let around = [
            ((r.left, r.top), (left, r.bottom)),
            ((right, r.top), (r.right, r.bottom)),
            ((left, r.top), (right, high)),
            ((left, low), (right, r.bottom)),
        ];
        for (from, to) in around {
            if to.0 - from.0 > LEAST_BLANK && to.1 - from.1 > LEAST_BLANK {
                self.canvas.rectangle(from, to, look::BLANK);
            }
        }
    }

    fn take_records_and_curves(&mut self) {
        let radius = self.radius;
        for record in &self.content.compared.records {
            if let Some(at) = self.place(record) {
                self.occupancy.take_spot(at, radius + 0.5);
            }
        }
        for curve in &self.content.compared.curves {
            let points: Vec<Point> = curve
                .points
                .iter()
                .map(|p| self.panel.at(p[0], p[1]))
                .collect();
            for piece in path::clip(&points, &self.panel.rect) {
                self.occupancy.take_line(&piece);
            }
        }
    }

    fn curves(&mut self, locale: Locale<'_>) {
        if !self.plane.dimensionless {
            return;
        }
        for curve in &self.content.compared.curves {
            self.canvas.layer(1);
            self.band(curve);
        }
        for curve in &self.content.compared.curves {
            self.canvas.layer(2);
            let stroke = boundaries::stroke(curve.kind, if self.full() { 1.1 } else { 0.8 });
            let data = curve.points.iter().map(|p| (p[0], p[1]));
            let pieces = self.panel.curve(&mut self.canvas, data, stroke);
            if self.full() {
                self.curve_label(curve, &pieces, locale);
            }
        }
    }

    fn band(&mut self, curve: &BoundaryCurve) {
        let upper = curve.band95.iter().map(|b| self.panel.at(b[0], b[2]));
        let lower = curve.band95.iter().rev().map(|b| self.panel.at(b[0], b[1]));
        let outline: Vec<Point> = upper.chain(lower).collect();
        if outline.len() >= 4 {
            let polygon = path::clip_polygon(&outline, &self.panel.rect);
            self.canvas.fill(&path::thin(&polygon), look::BOUNDARY_BAND);
        }
    }

    /// The brackets that the panel shows, with their ends and their height on paper.
    fn brackets(&self) -> Vec<(&'a BracketRow, (f64, f64), f64)> {
        let lift = self.lift();
        let shown = self.content.compared.brackets.iter().filter_map(|bracket| {
            let ((low, high), height) = self.plane.bracket(bracket)?;
            if !self.panel.shows(low, height) || !self.panel.shows(high, height) {
                return None;
            }
            let (from, to) = (self.panel.at(low, height), self.panel.at(high, height));
            let y = from.1 - lift * direction(bracket.sweep);
            Some((bracket, (from.0, to.0), y))
        });
        shown.collect()
    }

    fn take_brackets(&mut self) {
        for (_, (from, to), y) in self.brackets() {
            let rect = Rect::new(from, y - 2.5, to - from, 5.0);
            self.occupancy.take_rect(&rect);
        }
    }

    fn draw_brackets(&mut self) {
        for (bracket, ends, y) in self.brackets() {
            let colour = if bracket.left_out.is_none() {
                look::INK
            } else {
                look::UNUSED
            };
            self.canvas.layer(3);
            legend::bracket(&mut self.canvas, ends, y, colour);
        }
    }

    /// Radius of the marks: smaller where there are many, or where they follow closely.
    fn fitting_radius(&self) -> f64 {
        let area = self.panel.rect.width() * self.panel.rect.height();
        let records = &self.content.compared.records;
        let (least, most) = if self.full() { (1.2, 2.9) } else { (0.6, 1.8) };
        let mut steps: Vec<f64> = records
            .windows(2)
            .filter_map(|pair| Some((self.plane.record(&pair[0])?, self.plane.record(&pair[1])?)))
            .filter(|(a, b)| same(a.1, b.1) && a.0 != b.0)
            .map(|(a, b)| (self.panel.at(a.0, a.1).0 - self.panel.at(b.0, b.1).0).abs())
            .collect();
        steps.sort_by(f64::total_cmp);
        let usual = steps.get(steps.len() / 4).copied().unwrap_or(f64::INFINITY);
        let by_area = 0.13 * (area / records.len().max(1) as f64).sqrt();
        by_area.min(0.44 * usual).clamp(least, most)
    }

    /// Offset of upward sweeps above their clearance, of downward sweeps below.
    fn lift(&self) -> f64 {
        0.95 * self.radius
    }

    fn place(&self, record: &RecordRow) -> Option<Point> {
        let (x, y) = self.plane.record(record)?;
        let lift = self.lift() * direction(record.sweep);
        if let Some(strip) = self.strips.iter().position(|s| same(*s, y)) {
            let room = (STRIP_HALF - self.radius - 0.5).max(0.0);
            let lift = lift.clamp(-room, room);
            return Some((self.panel.at(x, 0.0).0, self.strip_middle(strip) - lift));
        }
        let at = self.panel.at(x, y);
        self.panel.shows(x, y).then_some((at.0, at.1 - lift))
    }

    fn strip_middle(&self, index: usize) -> f64 {
        self.panel.rect.top - STRIP_STEP * (index as f64 + 0.5) - 1.0
    }

    fn records(&mut self, locale: Locale<'_>) {
        let radius = self.radius;
        // marks of one motion that would cover each other are drawn once
        let side = 0.5 * radius;
        let mut taken = HashSet::new();
        let mut drawn: BTreeMap<_, (&Motion, Vec<Point>)> = BTreeMap::new();
        for record in &self.content.compared.records {
            let Some(at) = self.place(record) else {
                continue;
            };
            self.canvas.spot(at, data::describe(record, locale));
            let order = (marks::order(&record.motion), record.motion.label());
            let cell = [at.0, at.1].map(|v| whole::integer((v / side).floor()));
            let (_, places) = drawn
                .entry(order.clone())
                .or_insert((&record.motion, Vec::new()));
            if taken.insert((order, cell)) {
                places.push(at);
            }
        }
        self.canvas.layer(4);
        for (motion, places) in drawn.values() {
            marks::draw_all(&mut self.canvas, places, radius, marks::of(motion));
        }
    }

    fn frame(&mut self, locale: Locale<'_>, keys: &[Key]) {
        self.canvas.layer(7);
        self.panel.frame(&mut self.canvas, Sides::BOTH, locale);
        if self.full() && self.plane.dimensionless {
            self.laboratory_axes(locale);
        }
        self.strip_frames(locale);
        let width = self.canvas.width;
        legend::draw(&mut self.canvas, (0.0, 0.0), width, keys, locale);
    }

    fn finish(self, locale: Locale<'_>) -> Figure {
        let (name, title, csv) = match self.size {
            MapSize::Full => {
                let csv = data::csv(&self.content.compared);
                ("map", Phrase::RegionsSimulatedAndMeasured, csv)
            }
            // shows the data of the full one
            MapSize::Small => ("map_small", Phrase::MotionsAndBoundaries, String::new()),
        };
        Figure::new(name, &locale.translate(title), self.canvas, csv)
    }
}

/// How many clearances the records have.
fn heights(content: &ReportContent, plane: Plane) -> usize {
    let mut seen: Vec<f64> = Vec::new();
    for (_, y) in content
        .compared
        .records
        .iter()
        .filter_map(|r| plane.record(r))
    {
        if !seen.iter().any(|s| (s - y).abs() <= 1e-6 * y.abs()) {
            seen.push(y);
        }
    }
    seen.len()
}

/// +1 above the clearance's own height, −1 below.
fn direction(sweep: Sweep) -> f64 {
    match sweep {
        Sweep::Up => 1.0,
        Sweep::Down => -1.0,
        Sweep::Unknown => 0.0,
    }
}
