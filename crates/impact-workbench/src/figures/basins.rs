//! Basins of attraction in the plane of the starts.

use super::ENGLISH;
use super::keys::{sheet, tint_keys};
use impact_identification::replay::RegionMap;
use impact_report::figures::regions::Regions;
use impact_report::kit::axis::Axis;
use impact_report::kit::figure::Figure;
use impact_report::kit::look;
use impact_report::kit::panel::{Panel, Sides};
use impact_report::kit::path::Rect;

/// Room left of the panel, points.
const LEFT: f64 = 36.0;
/// Height of the panel, points.
const HEIGHT: f64 = 300.0;
/// Motions named in the keys at most.
const MOST_KEYS: usize = 12;

/// Draws the motion to which each start (X, X′) leads; `None` if the grid has no area.
pub fn draw(basins: &RegionMap, name: &str, title: &str) -> Option<Figure> {
    let keys = tint_keys(basins, MOST_KEYS);
    let (mut canvas, top) = sheet(LEFT, &keys, HEIGHT);
    let axis = |v: &[f64], title: &str| {
        let half = 0.5 * (v.get(1)? - v.first()?);
        Some(Axis::new(v.first()? - half, v.last()? + half, title).with_ticks(7))
    };
    let panel = Panel::new(
        Rect::new(LEFT, top, look::FULL_WIDTH - LEFT - 4.0, HEIGHT),
        axis(&basins.x, "start $X$(0) (1)")?,
        axis(&basins.y, "start $X$′(0) (1)")?,
    );
    canvas.layer(0);
    Regions::new(basins, &panel)?.draw(&mut canvas);
    canvas.layer(4);
    panel.frame(&mut canvas, Sides::BOTH, ENGLISH);
    Some(Figure::new(name, title, canvas, String::new()))
}
