//! Profile likelihoods of the parameters, four to a row.

use crate::figures::correlation::name;
use crate::kit::axis::Axis;
use crate::kit::canvas::{Anchor, Canvas, Stroke, TextLook};
use crate::kit::csv::Csv;
use crate::kit::figure::Figure;
use crate::kit::look;
use crate::kit::panel::{Panel, Sides};
use crate::kit::path::Rect;
use crate::locale::Locale;
use crate::parameters::parameter;
use crate::phrase::{Phrase, Text};
use impact_identification::identify::Identification;
use impact_identification::identify::uncertainty::ProfileCurve;

/// Rise of χ² at the ends of a 95 % interval of one parameter.
const RISE_95: f64 = 3.841_458_820_694_124;
/// Panels in a row.
const COLUMNS: usize = 4;
/// Height of a panel, points.
const HEIGHT: f64 = 80.0;
/// Height of a row with its headings and numbers, points.
const ROW: f64 = HEIGHT + 36.0;

/// Draws all profiles; `None` for none.
pub(crate) fn draw(id: &Identification, locale: Locale<'_>) -> Option<Figure> {
    let profiles = id.uncertainty.profiles.iter();
    let drawn: Vec<&ProfileCurve> = profiles.filter(|p| p.values.len() > 2).collect();
    if drawn.is_empty() {
        return None;
    }
    let rows = drawn.len().div_ceil(COLUMNS);
    let columns = drawn.len().min(COLUMNS);
    let step = ((look::FULL_WIDTH - 2.0) / columns as f64).min(160.0);
    let mut canvas = Canvas::new(look::FULL_WIDTH, rows as f64 * ROW);
    for (i, profile) in drawn.iter().enumerate() {
        let left = 28.0 + (i % COLUMNS) as f64 * step;
        let top = 11.0 + (i / COLUMNS) as f64 * ROW;
        let rect = Rect::new(left, top, step - 36.0, HEIGHT);
        let best = id.joint.parameters.get(profile.parameter);
        let best = best.and_then(|e| e.value);
        one(&mut canvas, profile, best, rect, locale);
    }
    let title = locale.translate(Phrase::ProfileLikelihoods);
    Some(Figure::new("profiles", &title, canvas, csv(&drawn)))
}

fn one(
    canvas: &mut Canvas,
    profile: &ProfileCurve,
    best: Option<f64>,
    rect: Rect,
    locale: Locale<'_>,
) {
    let shown = parameter(profile.parameter);
    let factor = shown.map_or(1.0, |p| p.factor);
    let title = shown.map_or_else(
        || Text::from(name(profile.parameter, locale)),
        |p| p.axis_title().into(),
    );
    let x = Axis::around(profile.values.iter().map(|v| v * factor), 0.02, title).with_ticks(3);
    let panel = Panel::new(
        rect,
        x,
        Axis::new(0.0, 9.0, (Phrase::RiseOfChiSquared, "1")).with_ticks(5),
    );
    if let Some([low, high]) = profile.interval95 {
        let low = panel.at((low * factor).max(panel.x.low), 0.0).0;
        let high = panel.at((high * factor).min(panel.x.high), 0.0).0;
        canvas.rectangle((low, rect.top), (high, rect.bottom), look::BAND);
    }
    panel.level(
        canvas,
        RISE_95,
        Stroke::dashed(look::QUIET, 0.5, &[2.0, 2.0]),
    );
    let data = profile
        .values
        .iter()
        .zip(&profile.delta_chi2)
        .map(|(v, d)| (v * factor, *d));
    panel.curve(canvas, data, Stroke::solid(look::BLUE, 1.1));
    if let Some(best) = best {
        panel.upright(canvas, best * factor, Stroke::solid(look::INK, 0.5));
    }
    panel.frame(canvas, Sides::BOTH, locale);
    let quiet = TextLook::new(look::NOTE_SIZE, Anchor::Middle).colour(look::QUIET);
    canvas.text(
        (0.5 * (rect.left + rect.right), rect.top - 3.5),
        &locale.translate(Phrase::Joint),
        quiet,
    );
}

fn csv(profiles: &[&ProfileCurve]) -> String {
    let mut csv = Csv::new(&["parameter", "method", "value_si", "delta_chi2"]);
    for p in profiles {
        for (v, d) in p.values.iter().zip(&p.delta_chi2) {
            csv.row()
                .texts(&[p.parameter.name(), ""])
                .numbers(&[Some(*v), Some(*d)]);
        }
    }
    csv.finish()
}
