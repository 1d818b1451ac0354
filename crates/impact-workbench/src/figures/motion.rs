//! One motion: time series, phase trajectories, Poincaré map, autocorrelation.

use super::ENGLISH;
use super::keys::sheet;
use impact_oscillator::atlas::portrait::{Portrait, Sample};
use impact_records::signal::robust::range;
use impact_report::kit::axis::Axis;
use impact_report::kit::canvas::{Canvas, Stroke};
use impact_report::kit::dots::{self, DotLook, Dots};
use impact_report::kit::figure::Figure;
use impact_report::kit::legend::{Key, Sign};
use impact_report::kit::look;
use impact_report::kit::marks::mix;
use impact_report::kit::panel::{Panel, Sides};
use impact_report::kit::path::Rect;

/// Room left of the panels, points.
const LEFT: f64 = 36.0;
/// Height of the displacements' panel, points.
const SERIES_HEIGHT: f64 = 96.0;
/// Height of the velocities' panel, points.
const SPEED_HEIGHT: f64 = 74.0;
/// Height of the three panels below, points.
const SQUARE: f64 = 126.0;
/// Times drawn at most; longer series are drawn from their end.
const MOST_SAMPLES: usize = 200_000;

/// Draws a portrait.
pub fn draw(portrait: &Portrait, name: &str, title: &str) -> Figure {
    let keys = keys(portrait);
    let above = SERIES_HEIGHT + 8.0 + SPEED_HEIGHT + 40.0;
    let (mut canvas, top) = sheet(LEFT, &keys, above + SQUARE);
    let squares = top + above;
    let drawing = Drawing {
        portrait,
        samples: with_impacts(portrait),
    };
    drawing.series(&mut canvas, top);
    drawing.speeds(&mut canvas, top + SERIES_HEIGHT + 8.0);
    let step = (look::FULL_WIDTH - LEFT - 4.0 + 34.0) / 3.0;
    drawing.phase_plane(&mut canvas, square(LEFT, squares, step));
    drawing.poincare(&mut canvas, square(LEFT + step, squares, step));
    drawing.autocorrelation(&mut canvas, square(LEFT + 2.0 * step, squares, step));
    Figure::new(name, title, canvas, String::new())
}

/// The time series with the instants just before and after every impact, so that jumps are drawn
/// upright.
fn with_impacts(portrait: &Portrait) -> Vec<Sample> {
    let all = &portrait.samples;
    let samples = &all[all.len().saturating_sub(MOST_SAMPLES)..];
    let first = samples.first().map_or(0.0, |s| s.periods);
    let mut strikes = portrait
        .impacts
        .iter()
        .filter(|i| i.periods >= first)
        .peekable();
    let mut merged = Vec::with_capacity(samples.len());
    for sample in samples {
        while let Some(i) = strikes.next_if(|i| i.periods <= sample.periods) {
            let y = if portrait.two_masses {
                portrait.gap - i.x
            } else {
                0.0
            };
            let speeds = [i.vx_before.zip(i.vy_before), i.vx_after.zip(i.vy_after)];
            merged.extend(speeds.into_iter().flatten().map(|(vx, vy)| Sample {
                periods: i.periods,
                x: i.x,
                vx,
                y,
                vy,
                sticking: false,
            }));
        }
        merged.push(*sample);
    }
    merged
}

fn square(left: f64, top: f64, step: f64) -> Rect {
    Rect::new(left, top, step - 34.0, SQUARE)
}

fn keys(portrait: &Portrait) -> Vec<Key> {
    let line = |colour| Sign::Line(Stroke::solid(colour, look::CURVE_WIDTH));
    let mut keys = vec![Key::new(line(look::BLUE), "$X$, $X$′")];
    if portrait.two_masses {
        keys.push(Key::new(
            line(look::VERMILION),
            "2$ρ$ − $Y$ (top), $Y$, $Y$′",
        ));
    } else {
        keys.push(Key::new(line(look::INK), "stop at $ρ$"));
    }
    if !portrait.impacts.is_empty() {
        keys.push(Key::new(Sign::dot(look::INK), "impact"));
    }
    if portrait.samples.iter().any(|s| s.sticking) {
        keys.push(Key::new(Sign::Patch(look::PALE), "masses together"));
    }
    keys
}

struct Drawing<'a> {
    portrait: &'a Portrait,
    samples: Vec<Sample>,
}

impl Drawing<'_> {
    fn times(&self) -> (f64, f64) {
        let (first, last) = (self.samples.first(), self.samples.last());
        (
            first.map_or(0.0, |s| s.periods),
            last.map_or(1.0, |s| s.periods),
        )
    }

    fn across(&self, top: f64, height: f64, y: Axis, titled: bool) -> Panel {
        let (first, last) = self.times();
        let title = if titled { "time $τ$/$T$ (1)" } else { "" };
        let rect = Rect::new(LEFT, top, look::FULL_WIDTH - LEFT - 7.0, height);
        Panel::new(rect, Axis::new(first, last, title).with_ticks(8), y).with_title_reach(27.0)
    }

    /// The other mass's face seen from the first.
    fn face(&self, s: &Sample) -> f64 {
        self.portrait.gap - s.y
    }

    fn series(&self, canvas: &mut Canvas, top: f64) {
        let values = self.samples.iter().flat_map(|s| [s.x, self.face(s)]);
        let y = Axis::around(values, 0.06, "displacement (1)");
        let panel = self.across(top, SERIES_HEIGHT, y, false);
        self.shade(canvas, &panel);
        canvas.layer(2);
        let colour = if self.portrait.two_masses {
            look::VERMILION
        } else {
            look::INK
        };
        let thick = Stroke::solid(colour, look::CURVE_WIDTH);
        let data = |f: &dyn Fn(&Sample) -> f64| -> Vec<(f64, f64)> {
            self.samples.iter().map(|s| (s.periods, f(s))).collect()
        };
        panel.curve(canvas, data(&|s| self.face(s)), thick);
        let thick = Stroke::solid(look::BLUE, look::CURVE_WIDTH);
        panel.curve(canvas, data(&|s| s.x), thick);
        canvas.layer(3);
        let mut taken = Dots::default();
        let dot = DotLook::full(dots::radius(self.portrait.impacts.len()), look::INK);
        for i in &self.portrait.impacts {
            taken.put(canvas, &panel, (i.periods, i.x), dot);
        }
        canvas.layer(4);
        let sides = Sides {
            below: false,
            left: true,
        };
        panel.frame(canvas, sides, ENGLISH);
    }

    /// Shades the times at which the masses are together.
    fn shade(&self, canvas: &mut Canvas, panel: &Panel) {
        canvas.layer(0);
        let mut first: Option<f64> = None;
        let mut band = |from: f64, to: f64| {
            let (a, b) = (panel.at(from, panel.y.low), panel.at(to, panel.y.high));
            canvas.rectangle((a.0, b.1), (b.0, a.1), look::PALE);
        };
        for s in &self.samples {
            match (s.sticking, first) {
                (true, None) => first = Some(s.periods),
                (false, Some(from)) => {
                    band(from, s.periods);
                    first = None;
                }
                _ => {}
            }
        }
        if let Some(from) = first {
            band(from, self.times().1);
        }
    }

    fn speeds(&self, canvas: &mut Canvas, top: f64) {
        let two = self.portrait.two_masses;
        let values = self
            .samples
            .iter()
            .flat_map(|s| [s.vx, if two { s.vy } else { s.vx }]);
        let y = Axis::around(values, 0.06, "velocity (1)").with_ticks(4);
        let panel = self.across(top, SPEED_HEIGHT, y, true);
        self.shade(canvas, &panel);
        canvas.layer(2);
        panel.level(canvas, 0.0, look::ZERO_STROKE);
        if two {
            let data: Vec<_> = self.samples.iter().map(|s| (s.periods, s.vy)).collect();
            panel.curve(canvas, data, Stroke::solid(look::VERMILION, 0.8));
        }
        let data: Vec<_> = self.samples.iter().map(|s| (s.periods, s.vx)).collect();
        panel.curve(canvas, data, Stroke::solid(look::BLUE, 0.8));
        canvas.layer(4);
        panel.frame(canvas, Sides::BOTH, ENGLISH);
    }

    fn phase_plane(&self, canvas: &mut Canvas, rect: Rect) {
        let two = self.portrait.two_masses;
        let title = if two { "$X$, $Y$ (1)" } else { "$X$ (1)" };
        let up = if two {
            "$X$′, $Y$′ (1)"
        } else {
            "$X$′ (1)"
        };
        let of = |x: &dyn Fn(&Sample) -> [f64; 2]| -> Vec<f64> {
            self.samples
                .iter()
                .flat_map(|s| if two { x(s).to_vec() } else { vec![x(s)[0]] })
                .collect()
        };
        let x = Axis::around(of(&|s| [s.x, s.y]), 0.05, title).with_ticks(4);
        let y = Axis::around(of(&|s| [s.vx, s.vy]), 0.05, up);
        let panel = Panel::new(rect, x, y).with_title_reach(27.0);
        if two {
            let data: Vec<_> = self.samples.iter().map(|s| (s.y, s.vy)).collect();
            panel.curve(canvas, data, Stroke::solid(look::VERMILION, 0.6));
        }
        let data: Vec<_> = self.samples.iter().map(|s| (s.x, s.vx)).collect();
        panel.curve(canvas, data, Stroke::solid(look::BLUE, 0.6));
        canvas.layer(4);
        panel.frame(canvas, Sides::BOTH, ENGLISH);
    }

    fn poincare(&self, canvas: &mut Canvas, rect: Rect) {
        let points = &self.portrait.poincare;
        let phase = ENGLISH.fixed(self.portrait.poincare_phase, 2);
        let title = format!("$X$ at drive phase {phase} (1)");
        let wide = |values: Vec<f64>| {
            let (low, high) = range(values).unwrap_or((0.0, 1.0));
            let size = 1e-3 * (low.abs() + high.abs() + 1e-3);
            let pad = (0.06 * (high - low)).max(size);
            (low - pad, high + pad)
        };
        let (a, b) = wide(points.iter().map(|p| p[0]).collect());
        let (c, d) = wide(points.iter().map(|p| p[1]).collect());
        let panel = Panel::new(
            rect,
            Axis::new(a, b, title).with_ticks(3),
            Axis::new(c, d, "$X$′ (1)").with_ticks(4),
        );
        let mut taken = Dots::default();
        let dot = DotLook::full(dots::radius(points.len()), look::BLUE);
        for p in points {
            taken.put(canvas, &panel, (p[0], p[1]), dot);
        }
        canvas.layer(4);
        panel.frame(canvas, Sides::BOTH, ENGLISH);
    }

    fn autocorrelation(&self, canvas: &mut Canvas, rect: Rect) {
        let values = &self.portrait.autocorrelation;
        let last = values.last().map_or(1.0, |v| v.0);
        let x = Axis::new(0.0, last, "lag in drive periods (1)").with_ticks(4);
        let y = Axis::new(-1.08, 1.08, "autocorrelation of $X$ (1)").with_ticks(4);
        let panel = Panel::new(rect, x, y);
        panel.level(canvas, 0.0, look::ZERO_STROKE);
        let stroke = Stroke::solid(mix(look::BLUE, 0.9), 0.6);
        panel.curve(canvas, values.iter().copied(), stroke);
        canvas.layer(4);
        panel.frame(canvas, Sides::BOTH, ENGLISH);
    }
}
