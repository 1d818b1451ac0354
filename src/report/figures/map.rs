//! The map of motions: regions, boundaries with their bands, records, brackets, chosen points.

use super::axes::{Axis, Panel, Sides};
use super::canvas::{Anchor, Canvas, Point, Stroke, TextLook};
use super::csv::Csv;
use super::fonts::Face;
use super::legend::{self, Key, Sign};
use super::look::{self, NumberLook};
use super::marks;
use super::path::{self, Rect};
use super::placing::Occupancy;
use super::plane::Plane;
use super::regions::Regions;
use super::{Figure, Spot};
use crate::record::Sweep;
use crate::report::content::{BoundaryCurve, BoundaryKind, RecordRow, ReportContent};

/// Which of the two maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapSize {
    /// The large one over the whole width, with keys, points and both unit systems.
    Full,
    /// The small one of the first page.
    Small,
}

const BAND: plotters::style::RGBColor = plotters::style::RGBColor(0xbd, 0xc3, 0xca);
const UNUSED: plotters::style::RGBColor = plotters::style::RGBColor(0x9a, 0x9f, 0xa5);

/// Draws the map; `None` where the records have no place in a plane.
pub fn draw(content: &ReportContent, size: MapSize, numbers: NumberLook) -> Option<Figure> {
    let plane = Plane::of(content)?;
    let keys = if size == MapSize::Full {
        keys(content, plane)
    } else {
        small_keys(content)
    };
    let mut map = Map::new(content, plane, size, &keys);
    // Labels go where records and curves leave room.
    map.take_records_and_curves();
    map.regions();
    map.curves();
    map.brackets();
    map.records(numbers);
    if size == MapSize::Full {
        map.letters();
    }
    map.frame(numbers, &keys);
    Some(map.finish())
}

struct Map<'a> {
    content: &'a ReportContent,
    plane: Plane,
    size: MapSize,
    canvas: Canvas,
    panel: Panel,
    occupancy: Occupancy,
    spots: Vec<Spot>,
}

impl<'a> Map<'a> {
    fn new(content: &'a ReportContent, plane: Plane, size: MapSize, keys: &[Key]) -> Self {
        let full = size == MapSize::Full;
        let flat = content.region_map.is_none() && heights(content, plane) <= 3;
        let (width, height) = match (full, flat) {
            (true, false) => (look::FULL_WIDTH, 370.0),
            (true, true) => (look::FULL_WIDTH, 200.0),
            (false, false) => (236.0, 205.0),
            (false, true) => (236.0, 130.0),
        };
        let keys_height = legend::height(keys, width) + if keys.is_empty() { 0.0 } else { 3.0 };
        let (left, right) = (
            33.0,
            if full && plane.dimensionless {
                30.0
            } else {
                4.0
            },
        );
        let top = keys_height
            + if full && plane.dimensionless {
                26.0
            } else {
                3.0
            };
        let rect = Rect::new(left, top, width - left - right, height - 24.0);
        let total = top + height;
        let (x, y) = plane.axes(content);
        let (x, y) = if full {
            (x, y)
        } else {
            (x.with_ticks(5), y.with_ticks(4))
        };
        let panel = Panel::new(rect, x, y);
        Self {
            content,
            plane,
            size,
            canvas: Canvas::new(width, total),
            panel,
            occupancy: Occupancy::new(width, total),
            spots: Vec::new(),
        }
    }

    fn full(&self) -> bool {
        self.size == MapSize::Full
    }

    fn regions(&mut self) {
        let Some(map) = self
            .content
            .region_map
            .as_ref()
            .filter(|_| self.plane.dimensionless)
        else {
            return;
        };
        let panel = self.panel.clone();
        let Some(regions) = Regions::new(map, &panel) else {
            return;
        };
        self.canvas.layer(0);
        regions.draw(&mut self.canvas);
        let size = if self.full() { 10.0 } else { 8.0 };
        self.canvas.layer(6);
        for label in regions.labels(&mut self.occupancy, size) {
            let text_look = TextLook::new(label.size, Anchor::Middle).face(Face::Bold);
            let (x, y) = label.at;
            let baseline = (x, y + 0.33 * label.size);
            self.canvas
                .text(baseline, &label.text, text_look.colour(look::INK));
        }
    }

    fn take_records_and_curves(&mut self) {
        let radius = self.radius();
        for record in &self.content.records {
            if let Some(at) = self.place(record) {
                self.occupancy.take_spot(at, radius + 0.5);
            }
        }
        for curve in &self.content.curves {
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

    fn curves(&mut self) {
        if !self.plane.dimensionless {
            return;
        }
        for curve in &self.content.curves {
            self.canvas.layer(1);
            self.band(curve);
        }
        for curve in &self.content.curves {
            self.canvas.layer(2);
            let stroke = boundary_stroke(curve.kind, if self.full() { 1.1 } else { 0.8 });
            let data = curve.points.iter().map(|p| (p[0], p[1]));
            let pieces = self.panel.curve(&mut self.canvas, data, stroke);
            if self.full() {
                self.curve_label(curve, &pieces);
            }
        }
    }

    fn band(&mut self, curve: &BoundaryCurve) {
        let upper = curve.band95.iter().map(|b| self.panel.at(b[0], b[2]));
        let lower = curve.band95.iter().rev().map(|b| self.panel.at(b[0], b[1]));
        let outline: Vec<Point> = upper.chain(lower).collect();
        if outline.len() >= 4 {
            let polygon = path::clip_polygon(&outline, &self.panel.rect);
            self.canvas.fill(&path::thin(&polygon), BAND);
        }
    }

    /// Names a curve beside the middle of its longest visible piece.
    fn curve_label(&mut self, curve: &BoundaryCurve, pieces: &[Vec<Point>]) {
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
        let text = curve_name(curve);
        let width = super::richtext::width(&text, Face::Regular, 8.5) + 2.0;
        let bounds = self.panel.rect;
        let anchors = [0.5, 0.35, 0.65, 0.2, 0.8].map(|share| along(piece, share * length(piece)));
        let best = anchors
            .into_iter()
            .filter_map(|a| self.occupancy.near(a, (width, 9.0), &bounds))
            .min_by_key(|&(x, y)| {
                self.occupancy
                    .taken(&Rect::new(x - 0.5 * width, y - 4.5, width, 9.0))
            });
        if let Some((x, y)) = best {
            self.occupancy
                .take_rect(&Rect::new(x - 0.5 * width, y - 4.5, width, 9.0));
            self.canvas.layer(6);
            let text_look = TextLook::new(8.5, Anchor::Middle).colour(look::INK);
            self.canvas.text((x, y + 2.8), &text, text_look);
        }
    }

    fn brackets(&mut self) {
        let lift = self.lift();
        for bracket in &self.content.brackets {
            let Some(((low, high), height)) = self.plane.bracket(bracket) else {
                continue;
            };
            if !self.panel.shows(low, height) || !self.panel.shows(high, height) {
                continue;
            }
            let (from, to) = (self.panel.at(low, height), self.panel.at(high, height));
            let y = from.1 - lift * direction(bracket.direction);
            let colour = if bracket.left_out.is_none() {
                look::INK
            } else {
                UNUSED
            };
            self.canvas.layer(3);
            legend::bracket(&mut self.canvas, (from.0, to.0), y, colour);
            self.occupancy
                .take_rect(&Rect::new(from.0, y - 2.5, to.0 - from.0, 5.0));
        }
    }

    /// Radius of the marks: smaller where there are many.
    fn radius(&self) -> f64 {
        let area = self.panel.rect.width() * self.panel.rect.height();
        let count = self.content.records.len().max(1) as f64;
        let most = if self.full() { 2.9 } else { 1.8 };
        (0.13 * (area / count).sqrt()).clamp(if self.full() { 1.5 } else { 0.7 }, most)
    }

    /// Up-sweep records stand a little above their clearance, down-sweep ones below.
    fn lift(&self) -> f64 {
        0.95 * self.radius()
    }

    fn place(&self, record: &RecordRow) -> Option<Point> {
        let (x, y) = self.plane.record(record)?;
        let at = self.panel.at(x, y);
        self.panel
            .shows(x, y)
            .then(|| (at.0, at.1 - self.lift() * direction(record.sweep)))
    }

    fn records(&mut self, numbers: NumberLook) {
        let radius = self.radius();
        let mut drawn: Vec<(Point, String)> = Vec::new();
        self.canvas.layer(4);
        for record in &self.content.records {
            let Some(at) = self.place(record) else {
                continue;
            };
            let text = describe(record, numbers);
            self.spots.push(Spot {
                x: at.0,
                y: at.1,
                text,
            });
            let label = record.motion.label();
            let hidden = drawn.iter().any(|(p, l)| {
                (p.0 - at.0).abs() < 0.35 * radius
                    && (p.1 - at.1).abs() < 0.35 * radius
                    && *l == label
            });
            if !hidden {
                marks::draw(&mut self.canvas, at, radius, marks::of(&record.motion));
                drawn.push((at, label));
            }
        }
    }

    fn letters(&mut self) {
        let bounds = self.panel.rect;
        for comparison in &self.content.comparisons {
            let Some(record) = self
                .content
                .records
                .iter()
                .find(|r| r.id == comparison.record)
            else {
                continue;
            };
            let Some(at) = self.place(record) else {
                continue;
            };
            let text = format!("({})", comparison.letter);
            let size = (super::fonts::width(&text, Face::Bold, 8.5) + 2.0, 9.0);
            let Some(place) = self.occupancy.near(at, size, &bounds) else {
                continue;
            };
            self.canvas.layer(5);
            self.canvas
                .ring(at, self.radius() + 2.0, Stroke::solid(look::INK, 0.7));
            self.leader(at, place, size);
            self.canvas.layer(6);
            let text_look = TextLook::new(8.5, Anchor::Middle)
                .face(Face::Bold)
                .colour(look::INK);
            self.canvas.text((place.0, place.1 + 2.8), &text, text_look);
            let rect = Rect::new(place.0 - 0.5 * size.0, place.1 - 4.5, size.0, size.1);
            self.occupancy.take_rect(&rect);
        }
    }

    /// A thin line from a mark to its letter, where they stand apart.
    fn leader(&mut self, at: Point, place: Point, size: (f64, f64)) {
        let (dx, dy) = (place.0 - at.0, place.1 - at.1);
        let distance = dx.hypot(dy);
        let stop = (0.5 * size.0 / dx.abs().max(1e-9)).min(0.5 * size.1 / dy.abs().max(1e-9));
        let start = (self.radius() + 2.0) / distance;
        if 1.0 - stop - start > 2.0 / distance {
            let point = |t: f64| (at.0 + t * dx, at.1 + t * dy);
            let stroke = Stroke::solid(look::INK, 0.5);
            self.canvas.segment(point(start), point(1.0 - stop), stroke);
        }
    }

    fn frame(&mut self, numbers: NumberLook, keys: &[Key]) {
        self.canvas.layer(7);
        self.panel.frame(&mut self.canvas, Sides::BOTH, numbers);
        if self.full() && self.plane.dimensionless {
            self.laboratory_axes(numbers);
        }
        legend::draw(
            &mut self.canvas,
            (self.panel.rect.left, 0.0),
            self.panel.rect.width(),
            keys,
        );
    }

    /// Frequency in Hz above and clearance in mm on the right.
    fn laboratory_axes(&mut self, numbers: NumberLook) {
        let r = self.panel.rect;
        let small = TextLook::new(look::TICK_SIZE, Anchor::Middle).colour(look::QUIET);
        let title = TextLook::new(look::TITLE_SIZE, Anchor::Middle).colour(look::QUIET);
        if let Some(f0) = self.plane.natural_frequency_hz {
            let axis = Axis::new(self.panel.x.low * f0, self.panel.x.high * f0, "").with_ticks(8);
            let (ticks, decimals) = axis.major();
            for v in ticks {
                let (x, _) = self.panel.at(v / f0, 0.0);
                self.canvas
                    .segment((x, r.top), (x, r.top + 2.5), look::FRAME_STROKE);
                self.canvas
                    .text((x, r.top - 3.0), &numbers.fixed(v, decimals), small);
            }
            let at = (0.5 * (r.left + r.right), r.top - 14.0);
            self.canvas.text(at, "drive frequency $f$ (Hz)", title);
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
                    .text((r.right + 3.0, y + 2.3), &numbers.fixed(v, decimals), left);
            }
            let at = (r.right + 24.0, 0.5 * (r.top + r.bottom));
            self.canvas.text(
                at,
                "clearance $r$ (mm)",
                TextLook {
                    upward: true,
                    ..title
                },
            );
        }
    }

    fn finish(self) -> Figure {
        let csv = csv(self.content);
        let (name, title) = match self.size {
            MapSize::Full => ("map", "Regions of motion, simulated and measured"),
            MapSize::Small => ("map_small", "Measured motions and boundaries"),
        };
        Figure::new(name, title, self.canvas, csv).with_spots(self.spots)
    }
}

/// How many clearances the records have.
fn heights(content: &ReportContent, plane: Plane) -> usize {
    let mut seen: Vec<f64> = Vec::new();
    for (_, y) in content.records.iter().filter_map(|r| plane.record(r)) {
        if !seen.iter().any(|s| (s - y).abs() <= 1e-6 * y.abs()) {
            seen.push(y);
        }
    }
    seen.len()
}

/// How a boundary is drawn.
pub fn boundary_stroke(kind: BoundaryKind, width: f64) -> Stroke {
    match kind {
        BoundaryKind::S2 => Stroke::solid(look::INK, width),
        BoundaryKind::S1 => Stroke::dashed(look::INK, width, &[5.0, 2.2]),
        BoundaryKind::Grazing => Stroke::dashed(look::INK, width, &[1.3, 1.7]),
        BoundaryKind::Edge => Stroke::dashed(look::INK, 0.7 * width, &[6.0, 2.0, 1.3, 2.0]),
    }
}

fn curve_name(curve: &BoundaryCurve) -> String {
    match (curve.kind, curve.periods_n) {
        (kind, 1) => kind.symbol().to_owned(),
        (kind, n) => format!("{} (1/{n})", kind.symbol()),
    }
}

/// +1 above the clearance's own height, −1 below.
fn direction(sweep: Sweep) -> f64 {
    match sweep {
        Sweep::Up => 1.0,
        Sweep::Down => -1.0,
        Sweep::Unknown => 0.0,
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

/// What hovering over a record tells.
pub fn describe(record: &RecordRow, numbers: NumberLook) -> String {
    let mut parts = vec![record.id.clone(), format!("z = {}", record.motion.label())];
    if let Some(f) = record.frequency_hz {
        parts.push(format!("f = {} Hz", numbers.fixed(f, 3)));
    }
    if let Some(r) = record.clearance_m {
        parts.push(format!("r = {} mm", numbers.significant(1e3 * r, 4)));
    }
    if let (Some(eta), Some(rho)) = (record.eta, record.rho) {
        parts.push(format!(
            "η = {}, ρ = {}",
            numbers.fixed(eta, 4),
            numbers.fixed(rho, 3)
        ));
    }
    parts.push(format!("sweep {}", record.sweep.name()));
    if let Some(c) = record.confidence {
        parts.push(format!("confidence {}", numbers.fixed(c, 2)));
    }
    parts.join("\n")
}

fn small_keys(content: &ReportContent) -> Vec<Key> {
    let met = marks::met(content.records.iter().map(|r| &r.motion));
    met.into_iter()
        .map(|m| Key::new(Sign::Mark(marks::of(m)), m.label()))
        .collect()
}

fn keys(content: &ReportContent, plane: Plane) -> Vec<Key> {
    let mut keys = vec![Key::new(Sign::Nothing, "measured $z$ = $p$/$n$:")];
    keys.extend(small_keys(content));
    if !content.brackets.is_empty() {
        keys.push(Key::new(Sign::Bracket(look::INK), "measured bracket"));
        if content.brackets.iter().any(|b| b.left_out.is_some()) {
            keys.push(Key::new(Sign::Bracket(UNUSED), "bracket not used"));
        }
    }
    if plane.dimensionless {
        keys.extend(curve_keys(content));
    }
    keys
}

fn curve_keys(content: &ReportContent) -> Vec<Key> {
    let kinds = [
        (BoundaryKind::S2, "saddle-node $s_2$, simulated"),
        (BoundaryKind::S1, "period doubling $s_1$, simulated"),
        (BoundaryKind::Grazing, "grazing $ρ$′, simulated"),
        (BoundaryKind::Edge, "other edge, simulated"),
    ];
    let mut keys: Vec<Key> = kinds
        .into_iter()
        .filter(|(kind, _)| content.curves.iter().any(|c| c.kind == *kind))
        .map(|(kind, text)| Key::new(Sign::Line(boundary_stroke(kind, 1.1)), text))
        .collect();
    if content.curves.iter().any(|c| !c.band95.is_empty()) {
        keys.push(Key::new(Sign::Patch(BAND), "95 % band"));
    }
    keys
}

fn csv(content: &ReportContent) -> String {
    let mut csv = Csv::new(&[
        "layer",
        "name",
        "motion",
        "sweep",
        "eta",
        "rho",
        "frequency_hz",
        "clearance_m",
        "eta_high",
        "rho_high",
        "frequency_high_hz",
    ]);
    for r in &content.records {
        csv.row()
            .texts(&["record", &r.id, &r.motion.label(), r.sweep.name()])
            .numbers(&[r.eta, r.rho, r.frequency_hz, r.clearance_m]);
    }
    for b in &content.brackets {
        csv.row()
            .texts(&[
                "bracket",
                b.kind.name(),
                &b.motion.label(),
                b.direction.name(),
            ])
            .numbers(&[
                b.eta_low,
                b.rho,
                Some(b.frequency_low_hz),
                Some(b.clearance_m),
            ])
            .numbers(&[b.eta_high, b.rho, Some(b.frequency_high_hz)]);
    }
    for c in &content.curves {
        let name = c.kind.name();
        let motion = format!("1/{}", c.periods_n);
        for p in &c.points {
            csv.row()
                .texts(&["curve", name, &motion, ""])
                .numbers(&[Some(p[0]), Some(p[1])]);
        }
        for b in &c.band95 {
            let row = csv.row().texts(&["band95", name, &motion, ""]);
            row.numbers(&[Some(b[0]), Some(b[1]), None, None, Some(b[0]), Some(b[2])]);
        }
    }
    csv.finish()
}
