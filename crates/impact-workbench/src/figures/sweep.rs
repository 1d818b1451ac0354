//! Quasi-stationary characteristics: amplitude, approach speed, Lyapunov exponent,
//! autocorrelation, and amplitude and phase of the impactless motion.

use super::ENGLISH;
use super::keys::sheet;
use impact_oscillator::atlas::SweepPoint;
use impact_oscillator::atlas::sweep::Impactless;
use impact_records::signal::robust::range;
use impact_report::kit::axis::Axis;
use impact_report::kit::canvas::{Canvas, Colour, Stroke};
use impact_report::kit::dots::{self, DotLook, Dots};
use impact_report::kit::figure::Figure;
use impact_report::kit::legend::{Key, Sign};
use impact_report::kit::look;
use impact_report::kit::panel::{Panel, Sides};
use impact_report::kit::path::Rect;

/// Room left of the panels, points.
const LEFT: f64 = 42.0;
/// Room between the panels, points.
const GAP: f64 = 7.0;

/// A characteristic: title, height, values of a point.
struct Row {
    title: &'static str,
    height: f64,
    values: fn(&SweepPoint) -> Vec<f64>,
    zero: bool,
    ticks: usize,
}

/// The characteristics from above.
const ROWS: [Row; 4] = [
    Row {
        title: "greatest\n$X_m$ (1)",
        height: 96.0,
        values: |p| vec![p.x_max],
        zero: false,
        ticks: 4,
    },
    Row {
        title: "approach speed\n$X$′₋ + $Y$′₋ (1)",
        height: 110.0,
        values: |p| p.approach_speeds.clone(),
        zero: true,
        ticks: 6,
    },
    Row {
        title: "Lyapunov\nexponent (1)",
        height: 62.0,
        values: |p| p.lyapunov.into_iter().collect(),
        zero: true,
        ticks: 3,
    },
    Row {
        title: "autocorrelation\nafter one period",
        height: 62.0,
        values: |p| p.autocorrelation.first().copied().into_iter().collect(),
        zero: true,
        ticks: 3,
    },
];
/// Height of the last panel, the phase of the impactless motion, points.
const PHASE_HEIGHT: f64 = 62.0;

/// A sweep in both directions.
pub struct Characteristics<'a> {
    /// Steps of the sweep there, in its own order.
    pub forward: &'a [SweepPoint],
    /// Steps of the sweep back.
    pub backward: &'a [SweepPoint],
    /// The motion without impacts at every step of the sweep there.
    pub impactless: &'a [Impactless],
}

/// Draws the characteristics over the quantity that moves.
pub fn draw(data: &Characteristics<'_>, name: &str, title: &str) -> Figure {
    let keys = keys(data.impactless.iter().any(|i| i.y.is_some()));
    let rows: f64 = ROWS.iter().map(|r| r.height + GAP).sum();
    let (mut canvas, top) = sheet(LEFT, &keys, rows + PHASE_HEIGHT);
    let drawing = Drawing { data };
    let mut y = top;
    for (i, row) in ROWS.iter().enumerate() {
        drawing.row(&mut canvas, y, row, i == 0);
        y += row.height + GAP;
    }
    drawing.phase(&mut canvas, y);
    Figure::new(name, title, canvas, String::new())
}

fn keys(two: bool) -> Vec<Key> {
    let mut keys = vec![
        Key::new(
            Sign::dot(look::BLUE),
            "there (in the sweep's own direction)",
        ),
        Key::new(Sign::dot(look::VERMILION), "back"),
        Key::new(
            Sign::Line(Stroke::solid(IMPACTLESS, 0.8)),
            "impactless motion of $X$",
        ),
    ];
    if two {
        let stroke = Stroke::dashed(IMPACTLESS, 0.8, look::DASH);
        keys.push(Key::new(Sign::Line(stroke), "of $Y$"));
    }
    keys
}

/// Colour of the impactless motion.
const IMPACTLESS: Colour = look::QUIET;

struct Drawing<'a> {
    data: &'a Characteristics<'a>,
}

impl Drawing<'_> {
    fn moves_eta(&self) -> bool {
        let span = |f: fn(&SweepPoint) -> f64| {
            range(self.data.forward.iter().map(f)).map_or(0.0, |(a, b)| b - a)
        };
        span(|p| p.eta) >= span(|p| p.rho)
    }

    fn at(&self, p: &SweepPoint) -> f64 {
        if self.moves_eta() { p.eta } else { p.rho }
    }

    fn axis(&self, titled: bool) -> Axis {
        let title = match (titled, self.moves_eta()) {
            (false, _) => "",
            (true, true) => "frequency ratio $η$ (1)",
            (true, false) => "clearance ratio $ρ$ (1)",
        };
        let values = self.data.forward.iter().map(|p| self.at(p));
        Axis::around(values, 0.01, title).with_ticks(8)
    }

    fn panel(&self, top: f64, height: f64, y: Axis, titled: bool) -> Panel {
        let rect = Rect::new(LEFT, top, look::FULL_WIDTH - LEFT - 5.0, height);
        Panel::new(rect, self.axis(titled), y).with_title_reach(26.0)
    }

    fn row(&self, canvas: &mut Canvas, top: f64, row: &Row, amplitude: bool) {
        let all = || self.data.forward.iter().chain(self.data.backward);
        let values = all().flat_map(row.values);
        let zero = row.zero.then_some(0.0);
        let y = Axis::around(values.chain(zero), 0.05, row.title).with_ticks(row.ticks);
        let panel = self.panel(top, row.height, y, false);
        canvas.layer(0);
        if row.zero {
            panel.level(canvas, 0.0, look::ZERO_STROKE);
        }
        if amplitude {
            self.impactless(canvas, &panel, |p| p.0);
        }
        canvas.layer(2);
        let count = all().map(|p| (row.values)(p).len()).sum();
        for (points, colour) in [
            (self.data.backward, look::VERMILION),
            (self.data.forward, look::BLUE),
        ] {
            let mut taken = Dots::default();
            let dot = DotLook::full(0.8 * dots::radius(count), colour);
            for p in points {
                for v in (row.values)(p) {
                    taken.put(canvas, &panel, (self.at(p), v), dot);
                }
            }
        }
        canvas.layer(4);
        let sides = Sides {
            below: false,
            left: true,
        };
        panel.frame(canvas, sides, ENGLISH);
    }

    /// The impactless motion's curve of X, and of Y where there is one.
    fn impactless(&self, canvas: &mut Canvas, panel: &Panel, of: fn((f64, f64)) -> f64) {
        let points = |value: fn(&Impactless) -> Option<(f64, f64)>| -> Vec<(f64, f64)> {
            let pairs = self.data.forward.iter().zip(self.data.impactless);
            let points = pairs.map(|(p, i)| Some((self.at(p), of(value(i)?))));
            points.flatten().collect()
        };
        let dashed = Stroke::dashed(IMPACTLESS, 0.8, look::DASH);
        panel.curve(canvas, points(|i| i.y), dashed);
        let solid = Stroke::solid(IMPACTLESS, 0.8);
        panel.curve(canvas, points(|i| Some(i.x)), solid);
    }

    fn phase(&self, canvas: &mut Canvas, top: f64) {
        let y = Axis::new(-8.0, 188.0, "impactless\nphase (°)").with_ticks(4);
        let panel = self.panel(top, PHASE_HEIGHT, y, true);
        self.impactless(canvas, &panel, |p| p.1.to_degrees());
        canvas.layer(4);
        panel.frame(canvas, Sides::BOTH, ENGLISH);
    }
}
