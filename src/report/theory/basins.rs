//! Basins of attraction in the plane of the starts.

use super::{keys_height, keys_on_top, tint_keys};
use crate::motion::Motion;
use crate::report::content::RegionMap;
use crate::report::figures::Figure;
use crate::report::figures::axis::Axis;
use crate::report::figures::canvas::Canvas;
use crate::report::figures::look;
use crate::report::figures::panel::{Panel, Sides};
use crate::report::figures::path::Rect;
use crate::report::figures::regions::Regions;
use crate::report::speech::Speech;
use impact_oscillator::atlas::basins::Basins;

/// Room left of the panel, points.
const LEFT: f64 = 36.0;
/// Height of the panel, points.
const HEIGHT: f64 = 300.0;
/// Motions named in the keys at most.
const MOST_KEYS: usize = 12;

/// Draws the basins; `None` where the grid has no area.
pub fn draw(basins: &Basins, name: &str, title: &str, speech: Speech) -> Option<Figure> {
    let motion = |cell: &Option<_>| match cell {
        Some(motion) => Motion::from(*motion),
        None => Motion::Undetermined {
            reason: "starts beyond the contact".into(),
        },
    };
    let cells: Vec<Motion> = basins.cells.iter().map(motion).collect();
    let map = RegionMap::of_motions(basins.x.clone(), basins.vx.clone(), &cells, &[], "");
    let keys = tint_keys(&map, MOST_KEYS);
    let top = keys_height(LEFT, &keys, speech);
    let mut canvas = Canvas::new(look::FULL_WIDTH, top + HEIGHT + 26.0);
    keys_on_top(&mut canvas, LEFT, &keys, speech);
    let axis = |v: &[f64], title: &str| {
        let half = 0.5 * (v.get(1)? - v.first()?);
        Some(Axis::new(v.first()? - half, v.last()? + half, title).with_ticks(7))
    };
    let panel = Panel::new(
        Rect::new(LEFT, top, look::FULL_WIDTH - LEFT - 4.0, HEIGHT),
        axis(&basins.x, "start $X$(0) (1)")?,
        axis(&basins.vx, "start $X$′(0) (1)")?,
    );
    canvas.layer(0);
    Regions::new(&map, &panel)?.draw(&mut canvas);
    canvas.layer(4);
    panel.frame(&mut canvas, Sides::BOTH, speech);
    Some(Figure::new(name, title, canvas, String::new()))
}
