//! The boundary fit: measured brackets less the simulated boundary, over the clearance.

use super::boundaries;
use super::plane::same;
use crate::kit::axis::Axis;
use crate::kit::canvas::{Canvas, Colour};
use crate::kit::csv::Csv;
use crate::kit::figure::Figure;
use crate::kit::legend::{self, Key, Sign};
use crate::kit::look;
use crate::kit::marks;
use crate::kit::panel::{Panel, Sides};
use crate::kit::path::Rect;
use crate::locale::Locale;
use crate::phrase::Phrase;
use impact_identification::replay::BracketRow;
use impact_records::motion::BoundaryKind;

/// Height of the panel, points.
const HEIGHT: f64 = 132.0;
/// Room left of the panel, points.
const LEFT: f64 = 34.0;
/// Distance of brackets at one clearance, points.
const STACK_STEP: f64 = 4.4;

/// Draws the brackets against the fit; `None` if none has a simulated value.
pub(crate) fn draw(brackets: &[BracketRow], locale: Locale<'_>) -> Option<Figure> {
    let rows: Vec<(&BracketRow, f64, f64)> = brackets
        .iter()
        .filter_map(|b| {
            let f = b.simulated_hz?;
            Some((b, b.frequency_low_hz - f, b.frequency_high_hz - f))
        })
        .collect();
    if rows.is_empty() {
        return None;
    }
    let keys = keys(&rows);
    let top = legend::height(&keys, look::HALF_WIDTH - LEFT, locale) + 4.0;
    let rect = Rect::new(LEFT, top, look::HALF_WIDTH - LEFT - 4.0, HEIGHT);
    let x = Axis::around(
        rows.iter().flat_map(|r| [r.1, r.2, 0.0]),
        0.08,
        (Phrase::BracketLessSimulatedBoundary, "Hz"),
    );
    let y = Axis::around(
        rows.iter().map(|r| 1e3 * r.0.clearance_m),
        0.10,
        (Phrase::Clearance, "mm"),
    );
    let panel = Panel::new(rect, x, y);
    let mut canvas = Canvas::new(look::HALF_WIDTH, top + HEIGHT + look::BELOW_PANEL);
    panel.upright(&mut canvas, 0.0, look::ZERO_STROKE);
    let mut order: Vec<usize> = (0..rows.len()).collect();
    let rank = |kind| boundaries::ALL.iter().position(|k| *k == kind);
    order.sort_by_key(|&i| (rank(rows[i].0.kind), rows[i].0.sweep));
    for &i in &order {
        let (row, low, high) = &rows[i];
        let (from, y) = panel.at(*low, 1e3 * row.clearance_m);
        let (to, _) = panel.at(*high, 0.0);
        // Those of one clearance are stacked around it.
        let beside = |k: &&usize| same(rows[**k].0.clearance_m, row.clearance_m);
        let count = order.iter().filter(beside).count();
        let place = order
            .iter()
            .filter(beside)
            .position(|&k| k == i)
            .unwrap_or(0);
        let lift = STACK_STEP * (place as f64 - 0.5 * (count as f64 - 1.0));
        let kind = colour(row.kind);
        let shade = if row.left_out.is_some() {
            marks::mix(kind, 0.35)
        } else {
            kind
        };
        legend::bracket(&mut canvas, (from, to), y - lift, shade);
    }
    panel.frame(&mut canvas, Sides::BOTH, locale);
    legend::draw(&mut canvas, (rect.left, 0.0), rect.width(), &keys, locale);
    Some(Figure::new(
        "boundary_fit",
        &locale.translate(Phrase::BracketsAgainstBoundary),
        canvas,
        csv(&rows),
    ))
}

fn colour(kind: BoundaryKind) -> Colour {
    match kind {
        BoundaryKind::SaddleNode => look::INK,
        BoundaryKind::Grazing => look::BLUE,
        BoundaryKind::PeriodDoubling => look::VERMILION,
        BoundaryKind::Other => look::GREEN,
    }
}

fn keys(rows: &[(&BracketRow, f64, f64)]) -> Vec<Key> {
    let kinds = [
        BoundaryKind::SaddleNode,
        BoundaryKind::PeriodDoubling,
        BoundaryKind::Grazing,
        BoundaryKind::Other,
    ];
    let met = kinds
        .into_iter()
        .filter(|k| rows.iter().any(|r| r.0.kind == *k));
    let mut keys: Vec<Key> = met.map(|k| Key::new(Sign::Bracket(colour(k)), k)).collect();
    if rows.iter().any(|r| r.0.left_out.is_some()) {
        keys.push(Key::new(
            Sign::Bracket(marks::mix(look::INK, 0.35)),
            Phrase::PaleNotUsed,
        ));
    }
    keys
}

fn csv(rows: &[(&BracketRow, f64, f64)]) -> String {
    let mut csv = Csv::new(&[
        "kind",
        "motion",
        "sweep",
        "used",
        "clearance_m",
        "low_less_simulated_hz",
        "high_less_simulated_hz",
    ]);
    for (row, low, high) in rows {
        let used = if row.left_out.is_none() { "yes" } else { "no" };
        csv.row()
            .texts(&[
                boundaries::name(row.kind),
                &row.motion.label(),
                row.sweep.name(),
                used,
            ])
            .numbers(&[Some(row.clearance_m), Some(*low), Some(*high)]);
    }
    csv.finish()
}
