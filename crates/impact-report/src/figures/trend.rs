//! The estimates of several campaigns, a panel for each parameter: each alone, and against the first.

use crate::kit::axis::Axis;
use crate::kit::canvas::{Canvas, Stroke};
use crate::kit::csv::Csv;
use crate::kit::dots::{DotLook, Dots};
use crate::kit::figure::Figure;
use crate::kit::legend::{self, Key, Sign};
use crate::kit::look;
use crate::kit::panel::{Panel, Sides};
use crate::kit::path::Rect;
use crate::locale::Locale;
use crate::parameters::{PARAMETERS, ParameterLook, interval95, short};
use crate::phrase::Phrase;
use impact_fit::ParameterSet;
use impact_identification::compare::{Comparison, Difference};

/// Height of a panel, points.
const HEIGHT: f64 = 96.0;
/// Height of a row with its numbers and title, points.
const ROW: f64 = HEIGHT + 30.0;
/// Room before a panel, points: numbers of seven digits fit into it.
const LEFT: f64 = 50.0;
/// Room behind a panel, points.
const RIGHT: f64 = 7.0;
/// Up to how many campaigns all panels have room in one row.
const FEW_CAMPAIGNS: usize = 4;
/// Where a difference stands beside its campaign, in campaigns.
const BESIDE: f64 = 0.16;

/// Draws the estimates; `None` if no parameter has a value.
pub(crate) fn draw(comparison: &Comparison, locale: Locale<'_>) -> Option<Figure> {
    let shown: Vec<&ParameterLook> = PARAMETERS
        .iter()
        .filter(|look| {
            comparison
                .campaigns
                .iter()
                .any(|c| has(look, &c.parameters))
        })
        .collect();
    if shown.is_empty() {
        return None;
    }
    let keys = [
        Key::new(Sign::dot(look::GREY), Phrase::EachAlone),
        Key::new(Sign::dot(look::BLUE), Phrase::AgainstTheFirst),
    ];
    let width = look::FULL_WIDTH - LEFT;
    let top = legend::height(&keys, width, locale) + 6.0;
    let few = comparison.campaigns.len() <= FEW_CAMPAIGNS;
    let columns = if few { shown.len().max(2) } else { 2 };
    let rows = shown.len().div_ceil(columns);
    let mut canvas = Canvas::new(look::FULL_WIDTH, top + rows as f64 * ROW);
    legend::draw(&mut canvas, (LEFT, 0.0), width, &keys, locale);
    let pitch = look::FULL_WIDTH / columns as f64;
    for (i, look) in shown.iter().enumerate() {
        let x = LEFT + (i % columns) as f64 * pitch;
        let y = top + (i / columns) as f64 * ROW;
        let rect = Rect::new(x, y, pitch - LEFT - RIGHT, HEIGHT);
        parameter(&mut canvas, rect, comparison, look, locale);
    }
    let title = locale.translate(Phrase::Trend);
    Some(Figure::new("trend", &title, canvas, csv(comparison)))
}

fn has(look: &ParameterLook, set: &ParameterSet) -> bool {
    set.get(look.parameter).is_some_and(|e| e.value.is_some())
}

fn difference<'a>(
    comparison: &'a Comparison,
    campaign: usize,
    look: &ParameterLook,
) -> Option<&'a Difference> {
    let mut all = comparison.differences.iter();
    all.find(|d| d.campaign == campaign && d.parameter == look.parameter)
}

/// The first campaign's value plus a difference: value, low, high, in the look's unit.
fn against_first(
    comparison: &Comparison,
    campaign: usize,
    look: &ParameterLook,
) -> Option<[f64; 3]> {
    let first = &comparison.campaigns.first()?.parameters;
    let first = first.get(look.parameter)?.value?;
    let found = difference(comparison, campaign, look)?;
    let [low, high] = found.interval95;
    Some([found.value, low, high].map(|v| (first + v) * look.factor))
}

/// A campaign's own estimate: value, low, high, in the look's unit.
fn alone(set: &ParameterSet, look: &ParameterLook) -> Option<[f64; 3]> {
    let estimate = set.get(look.parameter)?;
    let (low, high) = interval95(estimate)?;
    Some([estimate.value?, low, high].map(|v| v * look.factor))
}

fn parameter(
    canvas: &mut Canvas,
    rect: Rect,
    comparison: &Comparison,
    look: &ParameterLook,
    locale: Locale<'_>,
) {
    let count = comparison.campaigns.len();
    let own = |i: usize| alone(&comparison.campaigns[i].parameters, look);
    let against = |i: usize| against_first(comparison, i, look);
    let ends = (0..count).flat_map(|i| [own(i), against(i)]).flatten();
    let ends: Vec<f64> = ends.flat_map(|[_, low, high]| [low, high]).collect();
    let y = Axis::around(ends, 0.08, look.axis_title()).with_ticks(4);
    let x = Axis::new(0.4, count as f64 + 0.6, Phrase::Campaign).with_ticks(count.min(10));
    let panel = Panel::new(rect, x, y);
    if let Some([first, ..]) = own(0) {
        panel.level(canvas, first, Stroke::dashed(look::QUIET, 0.5, &[2.0, 2.0]));
    }
    let mut dots = Dots::default();
    for i in 0..count {
        let number = (i + 1) as f64;
        let marks = [
            (own(i), number, look::GREY, 0.8),
            (against(i), number + BESIDE, look::BLUE, 1.3),
        ];
        for (found, at, colour, width) in marks {
            let Some([value, low, high]) = found else {
                continue;
            };
            panel.error_bar(canvas, at, (low, high), Stroke::solid(colour, width));
            let dot = DotLook::full(1.8, colour);
            let campaign = &comparison.campaigns[i];
            let estimate = short(look, campaign.parameters.get(look.parameter), locale);
            if let Some(at) = dots.put(canvas, &panel, (at, value), dot) {
                canvas.spot(at, format!("{}\n{estimate}", campaign.name));
            }
        }
    }
    panel.frame(canvas, Sides::BOTH, locale);
}

fn csv(comparison: &Comparison) -> String {
    let mut csv = Csv::new(&[
        "campaign",
        "parameter",
        "value_si",
        "low95_si",
        "high95_si",
        "difference_si",
        "difference_low95_si",
        "difference_high95_si",
        "independent_low95_si",
        "independent_high95_si",
        "p_value",
    ]);
    for (i, campaign) in comparison.campaigns.iter().enumerate() {
        for look in &PARAMETERS {
            let Some([value, low, high]) = alone(&campaign.parameters, look) else {
                continue;
            };
            let own = [value, low, high].map(|v| Some(v / look.factor));
            let found = difference(comparison, i, look);
            let of = |pick: &dyn Fn(&Difference) -> f64| found.map(pick);
            csv.row()
                .texts(&[&campaign.name, look.parameter.name()])
                .numbers(&own)
                .numbers(&[
                    of(&|d| d.value),
                    of(&|d| d.interval95[0]),
                    of(&|d| d.interval95[1]),
                    of(&|d| d.independent_interval95[0]),
                    of(&|d| d.independent_interval95[1]),
                    of(&|d| d.p_value),
                ]);
        }
    }
    csv.finish()
}
