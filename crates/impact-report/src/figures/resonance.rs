//! The impactless resonance curve: amplitude and phase, measured with errors, and the fit.

use crate::kit::axis::Axis;
use crate::kit::canvas::{Canvas, Stroke};
use crate::kit::csv::Csv;
use crate::kit::dots::{self, DotLook, Dots};
use crate::kit::figure::Figure;
use crate::kit::legend::{self, Key, Sign};
use crate::kit::look;
use crate::kit::panel::{PAIR_LEFT, Panel, Sides, pair};
use crate::kit::path::Rect;
use crate::kit::units::{PrintUnit, print_unit};
use crate::locale::Locale;
use crate::phrase::Phrase;
use impact_identification::replay::{MeasuredAmplitude, ResonanceCurve};

/// Height of the panels, points.
const HEIGHT: f64 = 128.0;
/// Room above the panels for the keys, points.
const TOP: f64 = 15.0;

/// Draws one curve, and whether one degree of freedom fits it; `None` without points.
pub(crate) fn draw(
    (curve, fits): (&ResonanceCurve, Option<bool>),
    name: &str,
    locale: Locale<'_>,
) -> Option<Figure> {
    if curve.points.is_empty() {
        return None;
    }
    let mut canvas = Canvas::new(look::FULL_WIDTH, TOP + HEIGHT + look::BELOW_PANEL);
    let [left, right] = pair(TOP, HEIGHT);
    let peak = curve.points.iter().map(|p| p.amplitude).fold(0.0, f64::max);
    let unit = print_unit(curve.dimension, peak);
    let panel = amplitude_panel(curve, unit, left);
    let value = |p: &MeasuredAmplitude| [p.amplitude, p.amplitude_error].map(|v| v * unit.factor);
    let fitted = curve.fitted.iter();
    let fit = fitted.map(|f| (f[0], f[1] * unit.factor)).collect();
    Series { curve, panel, fit }.draw(&mut canvas, value, locale);
    let panel = phase_panel(curve, right);
    let value = |p: &MeasuredAmplitude| [p.phase_rad, p.phase_error_rad].map(f64::to_degrees);
    let fitted = curve.fitted.iter();
    let fit = fitted.map(|f| (f[0], f[2].to_degrees())).collect();
    Series { curve, panel, fit }.draw(&mut canvas, value, locale);
    legend::draw(
        &mut canvas,
        (PAIR_LEFT, 0.0),
        look::FULL_WIDTH - PAIR_LEFT,
        &keys(curve, fits),
        locale,
    );
    let title = locale.translate(Phrase::ResonanceCurve);
    Some(Figure::new(name, &title, canvas, csv(curve)))
}

fn frequency_axis(curve: &ResonanceCurve) -> Axis {
    Axis::around(
        curve.points.iter().map(|p| p.frequency_hz),
        0.04,
        (Phrase::DriveFrequency, "Hz"),
    )
}

fn amplitude_panel(curve: &ResonanceCurve, unit: PrintUnit, rect: Rect) -> Panel {
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
    let title = (Phrase::Amplitude, unit.symbol);
    let (low, high) =
        impact_records::signal::robust::range(values.iter().copied()).unwrap_or((0.0, 1.0));
    let y = if low > 0.0 && high / low > 12.0 {
        Axis::new(0.8 * low * unit.factor, 1.25 * high * unit.factor, title).logarithmic()
    } else {
        Axis::new(0.0, 1.08 * high * unit.factor, title)
    };
    Panel::new(rect, x, y)
}

fn phase_panel(curve: &ResonanceCurve, rect: Rect) -> Panel {
    let phases = curve.points.iter().map(|p| p.phase_rad);
    let phases = phases.filter(|phase| phase.is_finite());
    let values = phases
        .chain(curve.fitted.iter().map(|f| f[2]))
        .map(f64::to_degrees);
    let y = Axis::around(values, 0.06, (Phrase::PhaseBehindTheDrive, "°"));
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
        value: impl Fn(&MeasuredAmplitude) -> [f64; 2],
        locale: Locale<'_>,
    ) {
        let radius = dots::radius(self.curve.points.len()) + 0.2;
        let colour = |point: &MeasuredAmplitude| if point.used { look::BLUE } else { look::QUIET };
        let all = self.curve.points.iter();
        let known: Vec<&MeasuredAmplitude> = all.filter(|p| value(p)[0].is_finite()).collect();
        canvas.layer(1);
        for point in &known {
            let [y, error] = value(point);
            let low = if self.panel.y.log {
                (y - error).max(self.panel.y.low)
            } else {
                y - error
            };
            let bar = Stroke::solid(colour(point), 0.4);
            self.panel
                .error_bar(canvas, point.frequency_hz, (low, y + error), bar);
        }
        let mut taken = Dots::default();
        for point in known {
            let [y, _] = value(point);
            let colour = colour(point);
            let dot = DotLook {
                radius,
                colour,
                open: !point.used,
            };
            if let Some(at) = taken.put(canvas, &self.panel, (point.frequency_hz, y), dot) {
                let f = locale.fixed(point.frequency_hz, 3);
                canvas.spot(at, format!("{}\nf = {f} Hz", point.record));
            }
        }
        canvas.layer(2);
        self.panel.curve(
            canvas,
            self.fit.iter().copied(),
            Stroke::solid(look::VERMILION, 1.0),
        );
        canvas.layer(3);
        self.panel.frame(canvas, Sides::BOTH, locale);
    }
}

fn keys(curve: &ResonanceCurve, fits: Option<bool>) -> Vec<Key> {
    let mut keys = vec![
        Key::new(Sign::Nothing, curve.role),
        Key::new(Sign::dot(look::BLUE), Phrase::MeasuredWithStandardError),
    ];
    if curve.points.iter().any(|p| !p.used) {
        keys.push(Key::new(Sign::ring(look::QUIET), Phrase::NotUsed));
    }
    if !curve.fitted.is_empty() {
        let text = match fits {
            Some(false) => Phrase::FitOfOneDegreeFails,
            _ => Phrase::FitOfOneDegree,
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
            Some(p.amplitude_error),
            Some(p.phase_rad).filter(|phase| phase.is_finite()),
            Some(p.phase_error_rad).filter(|error| error.is_finite()),
        ]);
    }
    for f in &curve.fitted {
        let row = csv.row().texts(&["fitted", "", ""]);
        row.numbers(&[Some(f[0]), Some(f[1]), None, Some(f[2])]);
    }
    csv.finish()
}
