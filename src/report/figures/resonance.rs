//! The impactless resonance curve: amplitude and phase, measured with errors, and the fit.

use super::axis::Axis;
use super::canvas::{Canvas, Stroke};
use super::csv::Csv;
use super::dots::{self, DotLook, Dots};
use super::legend::{self, Key, Sign};
use super::look;
use super::panel::{PAIR_LEFT, Panel, Sides, pair};
use super::path::Rect;
use super::units::{PrintUnit, print_unit};
use super::{Figure, Spot};
use crate::report::content::{ResonanceCurve, ResonancePoint};
use crate::report::speech::Speech;

/// Height of the panels, points.
const HEIGHT: f64 = 128.0;
/// Room above the panels for the keys, points.
const TOP: f64 = 15.0;

/// Draws one curve; `None` where it has no points.
pub fn draw(curve: &ResonanceCurve, name: &str, speech: Speech) -> Option<Figure> {
    if curve.points.is_empty() {
        return None;
    }
    let mut canvas = Canvas::new(look::FULL_WIDTH, TOP + HEIGHT + look::BELOW_PANEL);
    let has_phase = curve.points.iter().any(|p| p.phase_rad.is_some());
    let [left, right] = pair(TOP, HEIGHT);
    let whole = Rect::new(PAIR_LEFT, TOP, look::FULL_WIDTH - PAIR_LEFT - 4.9, HEIGHT);
    let unit = amplitude_unit(curve);
    let amplitude = amplitude_panel(curve, &unit, if has_phase { left } else { whole });
    let mut spots = Vec::new();
    let value =
        |p: &ResonancePoint| Some((p.amplitude * unit.0, p.amplitude_error.map(|e| e * unit.0)));
    let fit = curve.fitted.iter().map(|f| (f[0], f[1] * unit.0)).collect();
    Series {
        curve,
        panel: amplitude,
        fit,
    }
    .draw(&mut canvas, value, speech, &mut spots);
    if has_phase {
        let panel = phase_panel(curve, right);
        let value = |p: &ResonancePoint| {
            Some((
                p.phase_rad?.to_degrees(),
                p.phase_error_rad.map(f64::to_degrees),
            ))
        };
        let fit = curve
            .fitted
            .iter()
            .map(|f| (f[0], f[2].to_degrees()))
            .collect();
        Series { curve, panel, fit }.draw(&mut canvas, value, speech, &mut spots);
    }
    legend::draw(
        &mut canvas,
        (PAIR_LEFT, 0.0),
        look::FULL_WIDTH - PAIR_LEFT,
        &keys(curve),
        speech,
    );
    let title = speech.say("Resonance curve without impacts");
    Some(Figure::new(name, &title, canvas, csv(curve)).with_spots(spots))
}

/// Factor and symbol of the amplitude's unit as printed.
fn amplitude_unit(curve: &ResonanceCurve) -> (f64, String) {
    match &curve.unit {
        Some(unit) => (1.0, unit.clone()),
        None => {
            let peak = curve.points.iter().map(|p| p.amplitude).fold(0.0, f64::max);
            let PrintUnit { factor, symbol } = print_unit(curve.dimension, peak);
            (factor, symbol.to_owned())
        }
    }
}

fn frequency_axis(curve: &ResonanceCurve) -> Axis {
    Axis::around(
        curve.points.iter().map(|p| p.frequency_hz),
        0.04,
        "drive frequency $f$ (Hz)",
    )
}

fn amplitude_panel(curve: &ResonanceCurve, unit: &(f64, String), rect: Rect) -> Panel {
    let x = frequency_axis(curve);
    let within = curve
        .fitted
        .iter()
        .filter(|f| f[0] >= x.low && f[0] <= x.high)
        .map(|f| f[1]);
    let values: Vec<f64> = curve
        .points
        .iter()
        .map(|p| p.amplitude)
        .chain(within)
        .collect();
    let title = format!("amplitude ({})", unit.1);
    let (low, high) = super::axis::range(values.iter().copied()).unwrap_or((0.0, 1.0));
    let y = if low > 0.0 && high / low > 12.0 {
        Axis::new(0.8 * low * unit.0, 1.25 * high * unit.0, title).logarithmic()
    } else {
        Axis::new(0.0, 1.08 * high * unit.0, title)
    };
    Panel::new(rect, x, y)
}

fn phase_panel(curve: &ResonanceCurve, rect: Rect) -> Panel {
    let phases = curve.points.iter().filter_map(|p| p.phase_rad);
    let values = phases
        .chain(curve.fitted.iter().map(|f| f[2]))
        .map(f64::to_degrees);
    let y = Axis::around(values, 0.06, "phase behind the drive (°)");
    Panel::new(rect, frequency_axis(curve), y)
}

struct Series<'a> {
    curve: &'a ResonanceCurve,
    panel: Panel,
    fit: Vec<(f64, f64)>,
}

impl Series<'_> {
    fn draw(
        &self,
        canvas: &mut Canvas,
        value: impl Fn(&ResonancePoint) -> Option<(f64, Option<f64>)>,
        speech: Speech,
        spots: &mut Vec<Spot>,
    ) {
        let radius = dots::radius(self.curve.points.len()) + 0.2;
        let mut taken = Dots::default();
        canvas.layer(1);
        for point in &self.curve.points {
            let Some((y, error)) = value(point) else {
                continue;
            };
            let colour = if point.used { look::BLUE } else { look::QUIET };
            if let Some(e) = error {
                let bar = Stroke::solid(colour, 0.4);
                let low = if self.panel.y.log {
                    (y - e).max(self.panel.y.low)
                } else {
                    y - e
                };
                self.panel
                    .error_bar(canvas, point.frequency_hz, (low, y + e), bar);
            }
            let dot = DotLook {
                radius,
                colour,
                open: !point.used,
            };
            if let Some((x, y)) = taken.put(canvas, &self.panel, (point.frequency_hz, y), dot) {
                let f = speech.fixed(point.frequency_hz, 3);
                spots.push(Spot {
                    x,
                    y,
                    text: format!("{}\nf = {f} Hz", point.record),
                });
            }
        }
        canvas.layer(2);
        self.panel.curve(
            canvas,
            self.fit.iter().copied(),
            Stroke::solid(look::VERMILION, 1.0),
        );
        canvas.layer(3);
        self.panel.frame(canvas, Sides::BOTH, speech);
    }
}

fn keys(curve: &ResonanceCurve) -> Vec<Key> {
    let mut keys = Vec::new();
    if !curve.name.is_empty() {
        keys.push(Key::new(Sign::Nothing, curve.name.clone()));
    }
    keys.push(Key::new(
        Sign::dot(look::BLUE),
        "measured, with standard error",
    ));
    if curve.points.iter().any(|p| !p.used) {
        keys.push(Key::new(Sign::ring(look::QUIET), "not used"));
    }
    if !curve.fitted.is_empty() {
        let text = match curve.fits {
            Some(false) => "fit of one degree of freedom (does not fit)",
            _ => "fit of one degree of freedom",
        };
        keys.push(Key::new(
            Sign::Line(Stroke::solid(look::VERMILION, 1.0)),
            text,
        ));
    }
    keys
}

fn csv(curve: &ResonanceCurve) -> String {
    let header = [
        "source",
        "record",
        "used",
        "frequency_hz",
        "amplitude",
        "amplitude_error",
        "phase_rad",
        "phase_error_rad",
    ];
    let mut csv = Csv::new(&header);
    for p in &curve.points {
        let used = if p.used { "yes" } else { "no" };
        csv.row().texts(&["measured", &p.record, used]).numbers(&[
            Some(p.frequency_hz),
            Some(p.amplitude),
            p.amplitude_error,
            p.phase_rad,
            p.phase_error_rad,
        ]);
    }
    for f in &curve.fitted {
        let row = csv.row().texts(&["fitted", "", ""]);
        row.numbers(&[Some(f[0]), Some(f[1]), None, Some(f[2])]);
    }
    csv.finish()
}
