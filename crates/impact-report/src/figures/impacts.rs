//! Speeds after over before each impact, and their ratio over the closing speed.

use crate::kit::axis::Axis;
use crate::kit::canvas::{Canvas, Stroke};
use crate::kit::csv::Csv;
use crate::kit::dots::{self, DotLook, Dots};
use crate::kit::figure::Figure;
use crate::kit::legend::{self, Key, Sign};
use crate::kit::look;
use crate::kit::panel::{PAIR_LEFT, Panel, Sides, pair};
use crate::kit::units::{PrintUnit, print_unit};
use crate::locale::Locale;
use crate::phrase::Phrase;
use impact_identification::replay::{ImpactPoint, ImpactScatter};
use impact_records::signal::robust::range;
use labfiles::units::Dimension;

/// Height of the panels, points.
const HEIGHT: f64 = 150.0;
/// Room above the panels for the keys, points.
const TOP: f64 = 15.0;

/// Draws one group of impacts; `None` if it is empty.
pub(crate) fn draw(scatter: &ImpactScatter, name: &str, locale: Locale<'_>) -> Option<Figure> {
    let peak = scatter
        .points
        .iter()
        .map(|p| p.before_m_s)
        .fold(0.0, f64::max);
    if scatter.points.is_empty() || peak <= 0.0 {
        return None;
    }
    let unit = print_unit(Dimension::Velocity, peak);
    let mut canvas = Canvas::new(look::FULL_WIDTH, TOP + HEIGHT + look::BELOW_PANEL);
    let panels = panels(scatter, unit);
    lines(&mut canvas, &panels, scatter, unit);
    points(&mut canvas, &panels, scatter, unit, locale);
    for panel in &panels {
        panel.frame(&mut canvas, Sides::BOTH, locale);
    }
    legend::draw(
        &mut canvas,
        (PAIR_LEFT, 0.0),
        look::FULL_WIDTH - PAIR_LEFT,
        &keys(scatter, locale),
        locale,
    );
    let title = locale.translate(Phrase::SpeedsAfterOverBeforeImpact);
    Some(Figure::new(name, &title, canvas, csv(scatter)))
}

/// The two panels: speed after, and restitution, over speed before.
fn panels(scatter: &ImpactScatter, unit: PrintUnit) -> [Panel; 2] {
    let peak = |f: fn(&ImpactPoint) -> f64| {
        scatter.points.iter().map(f).fold(0.0, f64::max) * unit.factor * 1.04
    };
    let before = || {
        let title = (Phrase::ClosingSpeedBeforeImpact, unit.symbol);
        Axis::new(0.0, peak(|p| p.before_m_s), title)
    };
    let after = Axis::new(
        0.0,
        peak(|p| p.after_m_s),
        (Phrase::PartingSpeedAfter, unit.symbol),
    );
    let ratio = ratio_axis(scatter);
    let [left, right] = pair(TOP, HEIGHT);
    [
        Panel::new(left, before(), after),
        Panel::new(right, before(), ratio),
    ]
}

/// The ratios without the few wildest at low speed, and always the fitted value.
fn ratio_axis(scatter: &ImpactScatter) -> Axis {
    let mut ratios: Vec<f64> = scatter
        .points
        .iter()
        .map(|p| p.after_m_s / p.before_m_s)
        .filter(|r| r.is_finite())
        .collect();
    ratios.sort_by(f64::total_cmp);
    let n = ratios.len();
    let trimmed = ratios.iter().skip(n / 100).take(n - 2 * (n / 100)).copied();
    let fitted = scatter.restitution.into_iter();
    let fitted = fitted.chain(scatter.restitution_of_speed.iter().map(|p| p[1]));
    let (low, high) = range(trimmed.chain(fitted)).unwrap_or((0.0, 1.0));
    let (low, high) = (low.max(-0.1), high.min(1.5));
    let pad = (0.1 * (high - low)).max(0.01);
    Axis::new(low - pad, high + pad, (Phrase::Restitution, "1"))
}

fn lines(canvas: &mut Canvas, panels: &[Panel; 2], scatter: &ImpactScatter, unit: PrintUnit) {
    let [speeds, ratios] = panels;
    let end = speeds.x.high;
    if let Some([low, high]) = scatter.interval95 {
        let inside = |ratio: f64| ratio.clamp(ratios.y.low, ratios.y.high);
        let (a, b) = (ratios.at(0.0, inside(high)), ratios.at(end, inside(low)));
        canvas.rectangle(a, b, look::BAND);
    }
    canvas.layer(2);
    let stroke = Stroke::solid(look::VERMILION, 1.0);
    if let Some(r) = scatter.restitution {
        speeds.curve(canvas, [(0.0, 0.0), (end, r * end)], stroke);
        ratios.level(canvas, r, stroke);
    }
    let dashed = Stroke::dashed(look::VERMILION, 1.0, look::DASH);
    let of_speed = || {
        scatter
            .restitution_of_speed
            .iter()
            .map(|p| (p[0] * unit.factor, p[1]))
    };
    ratios.curve(canvas, of_speed(), dashed);
    speeds.curve(canvas, of_speed().map(|(v, r)| (v, v * r)), dashed);
}

/// Draws the impacts, with their texts for hovering.
fn points(
    canvas: &mut Canvas,
    panels: &[Panel; 2],
    scatter: &ImpactScatter,
    unit: PrintUnit,
    locale: Locale<'_>,
) {
    canvas.layer(1);
    let radius = dots::radius(scatter.points.len());
    let mut taken = [Dots::default(), Dots::default()];
    let dot = DotLook::full(radius, look::BLUE);
    for p in &scatter.points {
        let before = p.before_m_s * unit.factor;
        let values = [p.after_m_s * unit.factor, p.after_m_s / p.before_m_s];
        for ((panel, dots), value) in panels.iter().zip(&mut taken).zip(values) {
            if let Some(at) = dots.put(canvas, panel, (before, value), dot) {
                let ratio = p.after_m_s / p.before_m_s;
                let text = format!("{}\nR = {}", p.record, locale.fixed(ratio, 3));
                canvas.spot(at, text);
            }
        }
    }
    canvas.layer(3);
}

fn keys(scatter: &ImpactScatter, locale: Locale<'_>) -> Vec<Key> {
    let mut keys = Vec::new();
    if let Some(specimen) = &scatter.specimen {
        keys.push(Key::new(Sign::Nothing, specimen.as_str()));
    }
    keys.push(Key::new(
        Sign::dot(look::BLUE),
        (Phrase::ImpactsUsed, scatter.total.to_string().as_str()),
    ));
    if let Some(r) = scatter.restitution {
        let stroke = Stroke::solid(look::VERMILION, 1.0);
        keys.push(Key::new(
            Sign::Line(stroke),
            format!("$R$ = {}", locale.fixed(r, 4)),
        ));
    }
    if scatter.interval95.is_some() {
        keys.push(Key::new(Sign::Patch(look::BAND), Phrase::Interval95));
    }
    if !scatter.restitution_of_speed.is_empty() {
        let stroke = Stroke::dashed(look::VERMILION, 1.0, look::DASH);
        keys.push(Key::new(Sign::Line(stroke), Phrase::RestitutionOverSpeed));
    }
    keys
}

fn csv(scatter: &ImpactScatter) -> String {
    let mut csv = Csv::new(&["record", "used", "before_m_s", "after_m_s", "error_m_s"]);
    for p in &scatter.points {
        csv.row().texts(&[&p.record, "yes"]).numbers(&[
            Some(p.before_m_s),
            Some(p.after_m_s),
            Some(p.error_m_s),
        ]);
    }
    csv.finish()
}
