//! The map's keys.

use crate::content::ReportContent;
use crate::figures::boundaries;
use crate::figures::plane::{Plane, edges};
use crate::figures::regions::commonest;
use crate::kit::axis::Axis;
use crate::kit::legend::{Key, Sign};
use crate::kit::{look, marks};
use crate::phrase::{Phrase, motion_text};
use impact_identification::replay::{Compared, RegionMap};
use impact_records::motion::{BoundaryKind, Motion};

/// Keys of the motions that were measured.
pub(super) fn motions(compared: &Compared) -> Vec<Key> {
    let met = marks::met(compared.records.iter().map(|r| &r.motion));
    met.into_iter()
        .map(|m| Key::new(Sign::Mark(marks::of(m)), motion_text(m)))
        .collect()
}

/// The tints of the regions; those of the rarest motions, a few cells here and there, have no key.
fn regions(map: &RegionMap) -> Vec<Key> {
    const MOST: usize = 14;
    let key = |m: &Motion| Key::new(Sign::Patch(marks::of(m).tint), motion_text(m));
    commonest(map, MOST).into_iter().map(key).collect()
}

/// All keys of the large map.
pub(super) fn full(content: &ReportContent, plane: Plane) -> Vec<Key> {
    let compared = &content.compared;
    let mut keys = vec![Key::new(Sign::Nothing, Phrase::MeasuredMotions)];
    keys.extend(motions(compared));
    if !compared.brackets.is_empty() {
        keys.push(Key::new(Sign::Bracket(look::INK), Phrase::MeasuredBracket));
        if compared.brackets.iter().any(|b| b.left_out.is_some()) {
            keys.push(Key::new(
                Sign::Bracket(look::UNUSED),
                Phrase::BracketNotUsed,
            ));
        }
    }
    if plane.dimensionless {
        keys.extend(curve_keys(compared));
        if let Some(map) = &compared.region_map {
            keys.push(Key::new(Sign::Nothing, Phrase::SimulatedRegions));
            keys.extend(regions(map));
        }
    }
    if is_wider(content, plane) {
        keys.push(Key::new(Sign::Patch(look::BLANK), Phrase::NotComputed));
    }
    if !content.proposals.is_empty() {
        keys.push(Key::new(Sign::Nothing, Phrase::ProposedSetting));
    }
    keys
}

/// Whether the map shows more than was simulated.
fn is_wider(content: &ReportContent, plane: Plane) -> bool {
    let map = content.compared.region_map.as_ref();
    let Some(map) = map.filter(|_| plane.dimensionless) else {
        return false;
    };
    let view = plane.view(content);
    let beyond = |axis: &Axis, cells: &[f64]| {
        let room = 0.005 * (axis.high - axis.low);
        edges(cells).is_some_and(|(low, high)| axis.low < low - room || axis.high > high + room)
    };
    beyond(&view.x, &map.x) || beyond(&view.y, &map.y)
}

fn curve_keys(compared: &Compared) -> Vec<Key> {
    let kinds = [
        (BoundaryKind::SaddleNode, Phrase::SaddleNodeSimulated),
        (
            BoundaryKind::PeriodDoubling,
            Phrase::PeriodDoublingSimulated,
        ),
        (BoundaryKind::Grazing, Phrase::GrazingSimulated),
        (BoundaryKind::Other, Phrase::OtherEdgeSimulated),
    ];
    let mut keys: Vec<Key> = kinds
        .into_iter()
        .filter(|(kind, _)| compared.curves.iter().any(|c| c.kind == *kind))
        .map(|(kind, text)| Key::new(Sign::Line(boundaries::stroke(kind, 1.1)), text))
        .collect();
    if compared.curves.iter().any(|c| !c.band95.is_empty()) {
        keys.push(Key::new(Sign::Patch(look::BOUNDARY_BAND), Phrase::Band95));
    }
    keys
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_region_of_the_map_has_a_key_of_its_tint() {
        let motions = [
            Motion::Impactless,
            Motion::periodic(1, 1),
            Motion::periodic(1, 2),
            Motion::Chaotic,
        ];
        let map = RegionMap {
            x: vec![0.5, 1.0],
            y: vec![1.0, 2.0],
            motions: motions.to_vec(),
            cells: vec![0, 1, 1, 3],
            second: vec![0, 1, 0, 3],
        };
        let keys = regions(&map);
        let signs: Vec<Sign> = keys.iter().map(|k| k.sign).collect();
        let tint = |k: usize| Sign::Patch(marks::of(&motions[k]).tint);
        assert_eq!(signs, [tint(0), tint(1), tint(3)]);
    }
}
