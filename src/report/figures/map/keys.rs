//! The map's keys and how its boundaries are drawn.

use crate::report::content::{BoundaryKind, ReportContent};
use crate::report::figures::canvas::Stroke;
use crate::report::figures::legend::{Key, Sign};
use crate::report::figures::plane::Plane;
use crate::report::figures::{look, marks};

/// Keys of the motions that were measured.
pub fn motions(content: &ReportContent) -> Vec<Key> {
    let met = marks::met(content.records.iter().map(|r| &r.motion));
    met.into_iter()
        .map(|m| Key::new(Sign::Mark(marks::of(m)), m.label()))
        .collect()
}

/// All keys of the large map.
pub fn full(content: &ReportContent, plane: Plane) -> Vec<Key> {
    let mut keys = vec![Key::new(Sign::Nothing, "measured $z$ = $p$/$n$:")];
    keys.extend(motions(content));
    if !content.brackets.is_empty() {
        keys.push(Key::new(Sign::Bracket(look::INK), "measured bracket"));
        if content.brackets.iter().any(|b| b.left_out.is_some()) {
            keys.push(Key::new(Sign::Bracket(look::UNUSED), "bracket not used"));
        }
    }
    if plane.dimensionless {
        keys.extend(curve_keys(content));
    }
    keys
}

fn curve_keys(content: &ReportContent) -> Vec<Key> {
    let kinds = [
        (BoundaryKind::S2, "saddle-node $s_2$, simulated"),
        (BoundaryKind::S1, "period doubling $s_1$, simulated"),
        (BoundaryKind::Grazing, "grazing $ρ$′, simulated"),
        (BoundaryKind::Edge, "other edge, simulated"),
    ];
    let mut keys: Vec<Key> = kinds
        .into_iter()
        .filter(|(kind, _)| content.curves.iter().any(|c| c.kind == *kind))
        .map(|(kind, text)| Key::new(Sign::Line(boundary_stroke(kind, 1.1)), text))
        .collect();
    if content.curves.iter().any(|c| !c.band95.is_empty()) {
        keys.push(Key::new(Sign::Patch(look::BOUNDARY_BAND), "95 % band"));
    }
    keys
}

/// How a boundary is drawn.
pub fn boundary_stroke(kind: BoundaryKind, width: f64) -> Stroke {
    match kind {
        BoundaryKind::S2 => Stroke::solid(look::INK, width),
        BoundaryKind::S1 => Stroke::dashed(look::INK, width, &[5.0, 2.2]),
        BoundaryKind::Grazing => Stroke::dashed(look::INK, width, &[1.3, 1.7]),
        BoundaryKind::Edge => Stroke::dashed(look::INK, 0.7 * width, &[6.0, 2.0, 1.3, 2.0]),
    }
}
