//! Figures of the theory alone: motions, characteristics, basins, regions.

pub mod basins;
pub mod motion;
pub mod regions;
pub mod sweep;

use super::figures::canvas::Canvas;
use super::figures::legend::{self, Key, Sign};
use super::figures::look;
use super::figures::marks;
use super::speech::Speech;
use crate::compare::RegionMap;
use crate::motion::Motion;

/// Draws keys over the whole width of the figure's top; gives the height they take.
fn keys_on_top(canvas: &mut Canvas, left: f64, keys: &[Key], speech: Speech) {
    let width = look::FULL_WIDTH - left;
    legend::draw(canvas, (left, 1.0), width, keys, speech);
}

/// Height of keys on the figure's top.
fn keys_height(left: f64, keys: &[Key], speech: Speech) -> f64 {
    legend::height(keys, look::FULL_WIDTH - left, speech) + 4.0
}

/// Keys of the motions that a map shows, each with its tint; the rare ones last and left out
/// beyond a number.
fn tint_keys(map: &RegionMap, most: usize) -> Vec<Key> {
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
            Motion::Undetermined { reason } => reason.clone(),
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
