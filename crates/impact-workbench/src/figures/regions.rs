//! Regions of existence and stability of all motions in the (η, ρ) plane: the brute-force maps as
//! tints (hatched where they differ), the boundaries as curves.

use super::ENGLISH;
use super::keys::sheet;
use impact_identification::replay::RegionMap;
use impact_oscillator::atlas::Curve;
use impact_report::figures::regions::Regions;
use impact_report::kit::axis::Axis;
use impact_report::kit::canvas::{Canvas, Stroke};
use impact_report::kit::figure::Figure;
use impact_report::kit::legend::{Key, Sign};
use impact_report::kit::look;
use impact_report::kit::panel::{Panel, Sides};
use impact_report::kit::path::{self, Rect};
use impact_report::kit::placing::Occupancy;

/// Room left of the panel, points.
const LEFT: f64 = 34.0;
/// Height of the panel, points.
const HEIGHT: f64 = 380.0;
/// Shorter pieces of boundaries are in the table alone.
const FEWEST_POINTS: usize = 3;

/// Draws the plane; `None` if the grid has no area.
pub fn draw((map, curves): (&RegionMap, &[Curve]), name: &str, title: &str) -> Option<Figure> {
    let keys = keys(curves, map.cells != map.second);
    let (mut canvas, top) = sheet(LEFT, &keys, HEIGHT);
    let axis = |v: &[f64], title: &str, ticks| {
        Some(Axis::new(*v.first()?, *v.last()?, title).with_ticks(ticks))
    };
    let panel = Panel::new(
        Rect::new(LEFT, top, look::FULL_WIDTH - LEFT - 7.0, HEIGHT),
        axis(&map.x, "frequency ratio $η$ (1)", 8)?,
        axis(&map.y, "clearance ratio $ρ$ (1)", 7)?,
    );
    let regions = Regions::new(map, &panel)?;
    canvas.layer(0);
    regions.draw(&mut canvas);
    let mut occupancy = Occupancy::new(canvas.width, canvas.height);
    draw_curves(&mut canvas, &panel, curves, &mut occupancy);
    canvas.layer(5);
    regions.draw_labels(&mut canvas, &mut occupancy, 9.5, ENGLISH);
    canvas.layer(6);
    panel.frame(&mut canvas, Sides::BOTH, ENGLISH);
    Some(Figure::new(name, title, canvas, String::new()))
}

fn draw_curves(canvas: &mut Canvas, panel: &Panel, curves: &[Curve], occupancy: &mut Occupancy) {
    canvas.layer(3);
    for curve in curves {
        let points = curve.points.iter().map(|p| panel.at(p.eta, p.rho));
        let points: Vec<_> = points.collect();
        for piece in path::clip(&points, &panel.rect) {
            occupancy.take_line(&piece);
        }
        if curve.points.len() >= FEWEST_POINTS {
            let full = stroke(curve.kind.name());
            // thin: of a motion of more than one impact or of a long period
            let width = if curve.p > 1 || curve.n > 5 {
                0.6 * full.width
            } else {
                full.width
            };
            let points = curve.points.iter().map(|p| (p.eta, p.rho));
            panel.curve(canvas, points, Stroke { width, ..full });
        }
    }
}

/// The boundaries by name, with the text of their key and how they are drawn.
const KINDS: [(&str, &str, Stroke); 8] = [
    ("s2", "saddle-node $s_2$", Stroke::solid(look::INK, 1.0)),
    (
        "s1",
        "period doubling $s_1$",
        Stroke::dashed(look::VERMILION, 0.9, &[4.0, 1.8]),
    ),
    (
        "rho_grazing",
        "grazing $ρ$′ of $z$ = 0",
        Stroke::solid(look::BLUE, 1.1),
    ),
    (
        "grazing",
        "a further impact",
        Stroke::dashed(look::GREEN, 0.9, &[1.4, 1.4]),
    ),
    (
        "impact_vanishes",
        "an impact vanishes",
        Stroke::dashed(look::BLUE, 0.8, &[1.4, 1.4]),
    ),
    (
        "dead_zone",
        "dead zone begins ($p$ | $p$j)",
        Stroke::dashed(look::PLUM, 0.9, &[5.0, 1.6, 1.4, 1.6]),
    ),
    (
        "joined",
        "$ρ_p$: together for ever",
        Stroke::solid(look::QUIET, 1.2),
    ),
    ("torus", "torus", Stroke::solid(look::PLUM, 0.7)),
];

fn stroke(kind: &str) -> Stroke {
    let known = KINDS.iter().find(|k| k.0 == kind);
    known.map_or(Stroke::solid(look::QUIET, 0.5), |k| k.2)
}

fn keys(curves: &[Curve], hysteresis: bool) -> Vec<Key> {
    let mut keys = vec![Key::new(Sign::Nothing, "$z$ = $p$/$n$ in the regions;")];
    let met = KINDS
        .iter()
        .filter(|k| curves.iter().any(|c| c.kind.name() == k.0));
    keys.extend(met.map(|k| Key::new(Sign::Line(k.2), k.1)));
    if hysteresis {
        keys.push(Key::new(Sign::Nothing, "hatched: another motion too"));
    }
    keys
}
