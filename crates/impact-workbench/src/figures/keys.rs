//! The keys of the theory's figures.

use super::ENGLISH;
use impact_identification::replay::RegionMap;
use impact_records::motion::Motion;
use impact_report::figures::regions::commonest;
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

/// Keys of the motions that a map shows, each with its tint; the rare ones left out beyond a number.
pub(super) fn tint_keys(map: &RegionMap, most: usize) -> Vec<Key> {
    let key = |motion: &Motion| {
        let text = match motion {
            Motion::Undetermined { reason } => reason.to_string(),
            Motion::Beat | Motion::Chaotic | Motion::Sticking => motion.label(),
            _ => format!("$z$ = {}", motion.label()),
        };
        Key::new(Sign::Patch(marks::of(motion).tint), text)
    };
    commonest(map, most).into_iter().map(key).collect()
}
