//! The estimates of all methods beside the joint one, a panel for each parameter.

use crate::content::ReportContent;
use crate::kit::axis::Axis;
use crate::kit::canvas::{Anchor, Canvas, Stroke, TextLook};
use crate::kit::csv::Csv;
use crate::kit::dots::{DotLook, Dots};
use crate::kit::figure::Figure;
use crate::kit::fonts::{self, Face};
use crate::kit::look;
use crate::kit::panel::{Panel, Sides};
use crate::kit::path::Rect;
use crate::locale::Locale;
use crate::parameters::{PARAMETERS, ParameterLook, interval95};
use crate::phrase::Phrase;
use impact_fit::{Estimate, Status};
use impact_records::signal::robust::range;

/// Height of a method's line, points.
const ROW: f64 = 14.5;

/// One method's estimates by their names.
struct Line<'a> {
    key: String,
    name: String,
    joint: bool,
    estimates: [Option<&'a Estimate>; 4],
}

impl Line<'_> {
    /// In which its name is set.
    fn face(&self) -> Face {
        if self.joint {
            Face::Bold
        } else {
            Face::Regular
        }
    }
}

/// Draws the estimates; `None` if no parameter has a value.
pub(crate) fn draw(content: &ReportContent, locale: Locale<'_>) -> Option<Figure> {
    let lines = lines(content, locale);
    let shown: Vec<usize> = (0..PARAMETERS.len())
        .filter(|&k| lines.iter().any(|l| value(l.estimates[k]).is_some()))
        .collect();
    if shown.is_empty() {
        return None;
    }
    let names = lines
        .iter()
        .map(|l| fonts::width(&l.name, l.face(), look::TICK_SIZE));
    let left = names.fold(0.0, f64::max) + 6.0;
    let columns = if shown.len() > 1 { 2 } else { 1 };
    let gap = 15.0;
    let width = (look::FRONT_WIDTH - left - 9.0 - gap * (columns - 1) as f64) / columns as f64;
    let height = ROW * lines.len() as f64 + 4.0;
    let rows = shown.len().div_ceil(columns);
    let mut canvas = Canvas::new(look::FRONT_WIDTH, rows as f64 * (height + 27.0) + 1.0);
    for (i, &k) in shown.iter().enumerate() {
        let (column, row) = (i % columns, i / columns);
        let x = left + column as f64 * (width + gap);
        let rect = Rect::new(x, 2.0 + row as f64 * (height + 27.0), width, height);
        parameter(&mut canvas, rect, &PARAMETERS[k], k, &lines, locale);
        if column == 0 {
            labels(&mut canvas, &rect, &lines);
        }
    }
    Some(Figure::new(
        "estimates",
        &locale.translate(Phrase::EstimatesOfAllMethods),
        canvas,
        csv(&lines),
    ))
}

fn lines<'a>(content: &'a ReportContent, locale: Locale<'_>) -> Vec<Line<'a>> {
    let id = &content.identification;
    let methods = id
        .methods
        .iter()
        .map(|(method, m)| (Some(*method), &m.parameters));
    let all = methods.chain([(None, &id.joint.parameters)]);
    all.map(|(method, parameters)| Line {
        name: method.map_or_else(
            || locale.translate(Phrase::JointTitle),
            |m| locale.message(&m),
        ),
        key: method.map_or_else(|| "Joint".to_owned(), |m| m.to_string()),
        joint: method.is_none(),
        estimates: std::array::from_fn(|k| parameters.get(PARAMETERS[k].parameter)),
    })
    .filter(|l| l.joint || l.estimates.iter().any(Option::is_some))
    .collect()
}

fn value(estimate: Option<&Estimate>) -> Option<f64> {
    estimate.and_then(|e| e.value)
}

fn parameter(
    canvas: &mut Canvas,
    rect: Rect,
    shown: &ParameterLook,
    k: usize,
    lines: &[Line<'_>],
    locale: Locale<'_>,
) {
    let ends = lines.iter().filter_map(|l| interval95(l.estimates[k]?));
    let ends: Vec<f64> = ends
        .flat_map(|(a, b)| [a * shown.factor, b * shown.factor])
        .collect();
    let x = Axis::around(view(&ends), 0.08, shown.axis_title()).with_ticks(3);
    let panel = Panel::new(
        rect,
        x,
        Axis::new(0.0, lines.len() as f64, "").with_ticks(0),
    );
    if let Some((low, high)) = lines
        .iter()
        .filter(|l| l.joint)
        .find_map(|l| interval95(l.estimates[k]?))
    {
        let low = panel.at((low * shown.factor).max(panel.x.low), 0.0).0;
        let high = panel.at((high * shown.factor).min(panel.x.high), 0.0).0;
        canvas.rectangle(
            (low, rect.top),
            (high.max(low + 0.3), rect.bottom),
            look::BAND,
        );
    }
    for (i, line) in lines.iter().enumerate() {
        let y = (lines.len() - i) as f64 - 0.5;
        if let Some(estimate) = line.estimates[k] {
            mark(
                canvas,
                &panel,
                estimate,
                shown.factor,
                y,
                line.joint,
                locale,
            );
        }
    }
    panel.frame(
        canvas,
        Sides {
            below: true,
            left: false,
        },
        locale,
    );
}

/// The range to show: the widest interval may not squeeze the others out of sight.
fn view(ends: &[f64]) -> Vec<f64> {
    let widths = ends.chunks(2).map(|e| e[1] - e[0]);
    let mut sorted: Vec<f64> = widths.collect();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    let middles = ends.chunks(2).map(|e| 0.5 * (e[0] + e[1]));
    let Some((low, high)) = range(middles) else {
        return Vec::new();
    };
    let least = low - 3.0 * usual;
    let most = high + 3.0 * usual;
    ends.iter().map(|e| e.clamp(least, most)).collect()
}

fn mark(
    canvas: &mut Canvas,
    panel: &Panel,
    e: &Estimate,
    factor: f64,
    y: f64,
    joint: bool,
    locale: Locale<'_>,
) {
    let colour = if joint { look::BLUE } else { look::INK };
    let Some((low, high)) = interval95(e) else {
        let (x, y) = panel.at(0.5 * (panel.x.low + panel.x.high), y);
        let quiet = TextLook::new(6.5, Anchor::Middle).colour(look::QUIET);
        canvas.text(
            (x, y + 2.2),
            &locale.translate(Phrase::NotIdentifiable),
            quiet,
        );
        return;
    };
    let ends = [(low * factor, y), (high * factor, y)];
    panel.curve(
        canvas,
        ends,
        Stroke::solid(colour, if joint { 1.3 } else { 0.8 }),
    );
    let open = e.status == Status::Weak;
    let dot = DotLook {
        radius: if joint { 2.1 } else { 1.6 },
        colour,
        open,
    };
    if let Some(v) = e.value {
        Dots::default().put(canvas, panel, (v * factor, y), dot);
    }
}

fn labels(canvas: &mut Canvas, rect: &Rect, lines: &[Line<'_>]) {
    let step = rect.height() / lines.len() as f64;
    for (i, line) in lines.iter().enumerate() {
        let y = rect.top + (i as f64 + 0.5) * step + 2.3;
        let text_look = TextLook::new(look::TICK_SIZE, Anchor::Right)
            .face(line.face())
            .colour(look::INK);
        canvas.text((rect.left - 4.0, y), &line.name, text_look);
    }
}

fn csv(lines: &[Line<'_>]) -> String {
    let mut csv = Csv::new(&["method", "parameter", "value_si", "low95_si", "high95_si"]);
    for line in lines {
        for (shown, estimate) in PARAMETERS.iter().zip(line.estimates) {
            let Some(e) = estimate else { continue };
            let (low, high) = (interval95(e).map(|i| i.0), interval95(e).map(|i| i.1));
            csv.row()
                .texts(&[&line.key, shown.parameter.name()])
                .numbers(&[e.value, low, high]);
        }
    }
    csv.finish()
}
