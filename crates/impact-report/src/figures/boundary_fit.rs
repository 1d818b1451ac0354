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
use impact_records::record::Sweep;

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
    let drawn: Vec<&BracketRow> = rows.iter().map(|r| r.0).collect();
    for ((row, low, high), lift) in rows.iter().zip(lifts(&drawn)) {
        let (from, y) = panel.at(*low, 1e3 * row.clearance_m);
        let (to, _) = panel.at(*high, 0.0);
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

/// How far above its clearance each bracket is drawn, points: those of upward sweeps above it, those of downward ones below,
/// others about it.
fn lifts(rows: &[&BracketRow]) -> Vec<f64> {
    let rank = |i: usize| {
        let kind = rows[i].kind;
        (boundaries::ALL.iter().position(|k| *k == kind), i)
    };
    let alike = |i: usize| {
        let own = rows[i];
        let others = (0..rows.len()).filter(move |k| {
            let other = rows[*k];
            same(other.clearance_m, own.clearance_m) && other.sweep == own.sweep
        });
        others.collect::<Vec<_>>()
    };
    let lift = |i: usize| {
        let beside = alike(i);
        let place = beside.iter().filter(|k| rank(**k) < rank(i)).count() as f64;
        let steps = match rows[i].sweep {
            Sweep::Up => place + 0.5,
            Sweep::Down => -place - 0.5,
            Sweep::Unknown => place - 0.5 * (beside.len() as f64 - 1.0),
        };
        STACK_STEP * steps
    };
    (0..rows.len()).map(lift).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use impact_records::motion::Motion;

    #[test]
    fn brackets_of_upward_sweeps_are_above_their_clearance_and_of_downward_ones_below() {
        let row = |kind, sweep| BracketRow {
            kind,
            motion: Motion::periodic(1, 1),
            clearance_m: 1e-3,
            rho: None,
            frequency_low_hz: 9.0,
            frequency_high_hz: 10.0,
            eta: None,
            sweep,
            simulated_hz: Some(9.5),
            left_out: None,
        };
        let rows = [
            row(BoundaryKind::SaddleNode, Sweep::Up),
            row(BoundaryKind::PeriodDoubling, Sweep::Down),
            row(BoundaryKind::Grazing, Sweep::Up),
            row(BoundaryKind::Grazing, Sweep::Unknown),
        ];
        let found = lifts(&rows.iter().collect::<Vec<_>>());
        assert!(
            found[0] > 0.0 && found[2] > 0.0 && found[0] != found[2],
            "{found:?}"
        );
        assert!(found[1] < 0.0, "{found:?}");
        assert_eq!(found[3], 0.0);
    }
}
