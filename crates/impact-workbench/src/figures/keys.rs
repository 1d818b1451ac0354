//! The keys of the theory's figures.

use super::ENGLISH;
use impact_identification::replay::RegionMap;
use impact_records::motion::Motion;
use impact_report::kit::canvas::Canvas;
use impact_report::kit::legend::{self, Key, Sign};
use impact_report::kit::look;
use impact_report::kit::marks;

/// A canvas of the text's width for panels of a height, with keys on its top, and where the panels begin.
pub(super) fn sheet(left: f64, keys: &[Key], height: f64) -> (Canvas, f64) {
    let width = look::FULL_WIDTH - left;
    let top = legend::height(keys, width, ENGLISH) + 4.0;
    let mut canvas = Canvas::new(look::FULL_WIDTH, top + height + 26.0);
    legend::draw(&mut canvas, (left, 1.0), width, keys, ENGLISH);
    (canvas, top)
}

/// Keys of the motions that a map shows, each with its tint; the rare ones last and left out
/// beyond a number.
pub(super) fn tint_keys(map: &RegionMap, most: usize) -> Vec<Key> {
    let mut counts = vec![0_usize; map.motions.len()];
    for &cell in map.cells.iter().chain(&map.second) {
        counts[usize::from(cell)] += 1;
    }
    let mut order: Vec<usize> = (0..counts.len()).collect();
    order.sort_by_key(|&i| std::cmp::Reverse(counts[i]));
    order.truncate(most);
    order.sort_by_key(|&i| marks::order(&map.motions[i]));
    let key = |i: &usize| {
        let motion = &map.motions[*i];
        let text = match motion {
            Motion::Undetermined { reason } => reason.to_string(),
            Motion::Beat | Motion::Chaotic | Motion::Sticking => motion.label(),
            _ => format!("$z$ = {}", motion.label()),
        };
        let tint = marks::of(motion).tint;
        if tint == look::PAPER {
            Key::new(Sign::Nothing, format!("white: {text}"))
        } else {
            Key::new(Sign::Patch(tint), text)
        }
    };
    order.iter().map(key).collect()
}
