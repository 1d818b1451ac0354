//! Boundaries and regions of the fitted model in the (η, ρ) plane of the campaign.

use rayon::prelude::*;

use super::input::Input;
use crate::identify::replay::LIVELY_SPEED;
use crate::identify::uncertainty::band::Spread;
use impact_fit::parameters::Coordinate;
use impact_oscillator::SettledMotion;
use impact_oscillator::atlas::coexisting::beside;
use impact_oscillator::atlas::map::even;
use impact_oscillator::atlas::{MapGrid, MapSettings, region_map as simulate_map};
use impact_oscillator::model::boundary::{rho_grazing, rho_s1, rho_s2};
use impact_oscillator::model::params::{Initial, Machine};
use impact_records::motion::{BoundaryKind, Motion};
use impact_records::signal::robust::range;

/// A simulated boundary in the (η, ρ) plane.
#[derive(Debug, Clone, PartialEq)]
pub struct BoundaryCurve {
    /// Which boundary.
    pub kind: BoundaryKind,
    /// n of the z = 1/n motion it bounds; 1 for grazing.
    pub periods_n: u32,
    /// Points (η, ρ) in order along the curve.
    pub points: Vec<[f64; 2]>,
    /// (η, lowest ρ, highest ρ) of the 95 % band; empty if none was computed.
    pub band95: Vec<[f64; 3]>,
}

/// Simulated motions on an even grid of a plane: (η, ρ), or the start (X, X′) of basins.
#[derive(Debug, Clone, PartialEq)]
pub struct RegionMap {
    /// Coordinate of the columns, ascending and evenly spaced.
    pub x: Vec<f64>,
    /// Coordinate of the rows, ascending and evenly spaced.
    pub y: Vec<f64>,
    /// The motions that occur; `cells` are indices into it.
    pub motions: Vec<Motion>,
    /// Motion of each cell, row by row: that of (`x_i`, `y_j`) at j · `x.len()` + i.
    pub cells: Vec<u16>,
    /// The same from other initial conditions: a difference means hysteresis. May be empty.
    pub second: Vec<u16>,
}

impl RegionMap {
    /// A map from the motion of each cell, row by row, and, if `second` is not empty, from its motion
    /// from other initial conditions.
    pub fn new(x: Vec<f64>, y: Vec<f64>, first: &[Motion], second: &[Motion]) -> Self {
        let mut motions = Vec::new();
        let (cells, second) = (indices(first, &mut motions), indices(second, &mut motions));
        Self {
            x,
            y,
            motions,
            cells,
            second,
        }
    }
}

/// Motions as indices into those that occurred so far.
fn indices(motions: &[Motion], known: &mut Vec<Motion>) -> Vec<u16> {
    let index = |motion: &Motion| {
        let found = known.iter().position(|m| m == motion);
        let index = found.unwrap_or_else(|| {
            known.push(motion.clone());
            known.len() - 1
        });
        // a map has fewer cells than a u16 counts
        u16::try_from(index).unwrap_or(u16::MAX)
    };
    motions.iter().map(index).collect()
}

/// Columns and rows of the region map.
const MAP: (usize, usize) = (180, 130);
/// Points of a boundary curve.
const CURVE_POINTS: usize = 220;
/// Clearance, times β, beyond which nothing touches: the resonance reaches ρ = 1/(2β). Wider gaps
/// contribute nothing to the regions.
const REACH: f64 = 0.55;
/// Largest n of the z = 1/n boundaries.
const MOST_PERIODS: u32 = 3;
/// Fewer records than these have no plane.
const FEWEST_RECORDS: usize = 3;

/// The part of the plane that the campaign visited, with a margin: ranges of η and ρ.
#[derive(Debug, Clone, Copy, PartialEq)]
struct View {
    eta: (f64, f64),
    rho: (f64, f64),
}

impl View {
    /// Of records, and of proposed settings, at (η, ρ); `reach` is the largest ρ at which anything touches.
    fn of(places: &[(f64, f64)], proposed: &[(f64, f64)], reach: f64) -> Option<Self> {
        if places.len() < FEWEST_RECORDS {
            return None;
        }
        let span = |(low, high): (f64, f64), margin: f64| {
            let room = margin * (high - low).max(0.1);
            (low - room, high + room)
        };
        let all = || places.iter().chain(proposed);
        let eta = span(range(all().map(|p| p.0))?, 0.05);
        let touching = all().map(|p| p.1).filter(|r| *r <= reach);
        let (low, high) = range(touching)?;
        // A single clearance is shown with as much of the plane about it as a figure shows.
        let rho = if high - low < 0.1 * high {
            (0.8 * low, 1.2 * high)
        } else {
            span((low, high), 0.12)
        };
        Some(Self {
            eta: (eta.0.max(0.05), eta.1),
            rho: (rho.0.min(0.05).max(rho.0 - 0.1).max(0.0), rho.1),
        })
    }
}

/// The fitted machine without its asymmetry, as the paper draws the plane, and the part that is
/// shown; `None` without a fitted R, which the regions of impact motion need.
fn plane(input: &Input<'_>) -> Option<(Machine, View)> {
    let fit = &input.identification.joint_fit.as_ref()?.fit;
    let fitted = &fit.parameters;
    if !fitted.in_range() || !fit.free.contains(&Coordinate::Restitution) {
        return None;
    }
    let usable = input.observations.iter().filter(|o| !o.excluded());
    let places = usable.filter_map(|o| {
        let (eta, rho) = input.place(o);
        Some((eta?, rho?))
    });
    let places: Vec<(f64, f64)> = places.collect();
    let proposed = input.proposals.iter();
    let proposed = proposed.map(|p| (p.frequency_ratio, p.clearance_ratio));
    let proposed: Vec<(f64, f64)> = proposed.collect();
    let view = View::of(&places, &proposed, REACH / fitted.damping_ratio)?;
    Some((fitted.without_asymmetry().machine(input.rig), view))
}

/// s2 and s1 of z = 1/n and the grazing boundary, each with its 95 % band.
pub(super) fn curves(input: &Input<'_>) -> Vec<BoundaryCurve> {
    let joint = input.identification.joint_fit.as_ref();
    let (Some((machine, view)), Some(joint)) = (plane(input), joint) else {
        return Vec::new();
    };
    let etas = even((view.eta.0, view.eta.1, CURVE_POINTS));
    let spread = Spread::of(&joint.fit, joint.variance_factor, input.rig);
    let mut wanted = vec![(BoundaryKind::Grazing, 1)];
    for n in 1..=MOST_PERIODS {
        wanted.extend([
            (BoundaryKind::SaddleNode, n),
            (BoundaryKind::PeriodDoubling, n),
        ]);
    }
    let of_kind = |(kind, periods_n)| -> Vec<BoundaryCurve> {
        let rho = |machine: &Machine, eta: f64| boundary_rho(machine, eta, kind, periods_n);
        let curve = |points: Vec<[f64; 2]>| BoundaryCurve {
            kind,
            periods_n,
            band95: band(&spread, &points, &rho),
            points,
        };
        let pieces = pieces(&etas, |eta| rho(&machine, eta));
        pieces.into_iter().map(curve).collect()
    };
    let drawn: Vec<Vec<BoundaryCurve>> = wanted.into_par_iter().map(of_kind).collect();
    drawn.into_iter().flatten().collect()
}

/// ρ of a boundary at η; `None` if no motion of the machine ends there.
fn boundary_rho(machine: &Machine, eta: f64, kind: BoundaryKind, n: u32) -> Option<f64> {
    let point = match kind {
        BoundaryKind::SaddleNode => rho_s2(machine, eta, n),
        BoundaryKind::PeriodDoubling => rho_s1(machine, eta, n),
        BoundaryKind::Grazing => return Some(rho_grazing(machine, eta)),
        // has no closed form
        BoundaryKind::Other => None,
    }?;
    (point.is_valid() && point.rho > 0.0).then_some(point.rho)
}

/// Unbroken pieces (η, ρ) of three points or more of a curve: a missing value ends one.
fn pieces(etas: &[f64], rho: impl Fn(f64) -> Option<f64>) -> Vec<Vec<[f64; 2]>> {
    let points: Vec<Option<[f64; 2]>> = etas.iter().map(|e| Some([*e, rho(*e)?])).collect();
    let runs = points.split(Option::is_none);
    let pieces = runs.map(|run| run.iter().copied().flatten().collect::<Vec<_>>());
    pieces.filter(|piece| piece.len() > 2).collect()
}

/// Band of a curve; it ends if the curve of a machine nearby ends.
fn band(
    spread: &Spread,
    points: &[[f64; 2]],
    rho_of: &impl Fn(&Machine, f64) -> Option<f64>,
) -> Vec<[f64; 3]> {
    let points = points.iter().filter_map(|[eta, rho]| {
        let half = spread.half95(|machine| rho_of(machine, *eta))?;
        (half > 0.0).then_some([*eta, rho - half, rho + half])
    });
    points.collect()
}

/// Regions of motion: each cell from rest, and the other motion that exists beside it: from a lively
/// start, else a stable z = 1/n in closed form.
pub(super) fn region_map(input: &Input<'_>) -> Option<RegionMap> {
    let (machine, view) = plane(input)?;
    let grid = MapGrid::even(
        (view.eta.0, view.eta.1, MAP.0),
        (view.rho.0.max(0.02), view.rho.1, MAP.1),
    );
    let from = |start| {
        let settings = MapSettings {
            start,
            ..MapSettings::default()
        };
        simulate_map(&machine, &grid, &settings).map(|map| map.cells)
    };
    let rest = from(Initial::rest()).ok()?;
    let lively = from(Initial::both(0.0, LIVELY_SPEED)).ok()?;
    let other = beside(&machine, &grid, &[&rest, &lively]).ok()?;
    let motions = |cells: Vec<SettledMotion>| -> Vec<Motion> {
        cells.into_iter().map(Motion::from).collect()
    };
    let (first, second) = (motions(rest), motions(other));
    Some(RegionMap::new(grid.eta, grid.rho, &first, &second))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_lists_each_motion_once() {
        let (one, half) = (Motion::periodic(1, 1), Motion::periodic(1, 2));
        let first = [
            Motion::Impactless,
            one.clone(),
            one.clone(),
            Motion::Impactless,
        ];
        let second = [Motion::Impactless, half.clone(), one.clone(), one.clone()];
        let map = RegionMap::new(vec![1.0, 2.0], vec![0.5, 0.7], &first, &second);
        assert_eq!(map.motions, [Motion::Impactless, one, half]);
        assert_eq!(map.cells, [0, 1, 1, 0]);
        assert_eq!(map.second, [0, 2, 1, 1]);
    }

    #[test]
    fn a_missing_value_ends_a_piece_and_short_pieces_are_dropped() {
        let etas: Vec<f64> = (0..10).map(f64::from).collect();
        let missing = [3.0, 6.0, 7.0];
        let found = pieces(&etas, |eta| (!missing.contains(&eta)).then_some(2.0 * eta));
        assert_eq!(found, [vec![[0.0, 0.0], [1.0, 2.0], [2.0, 4.0]]]);
    }

    #[test]
    fn the_view_leaves_out_gaps_beyond_all_impacts() {
        let places = [(0.8, 0.5), (1.2, 1.5), (1.6, 9.0)];
        let view = View::of(&places, &[], 7.0).expect("a view");
        assert!((view.eta.0 - 0.76).abs() < 1e-12 && (view.eta.1 - 1.64).abs() < 1e-12);
        // 12 % of 1.0 above; below it is widened to the axis by a tenth
        assert!((view.rho.1 - 1.62).abs() < 1e-12 && (view.rho.0 - 0.28).abs() < 1e-12);
        assert_eq!(View::of(&places[..2], &places, 7.0), None);
        assert_eq!(View::of(&places, &[], 0.1), None);
    }

    #[test]
    fn the_view_reaches_to_proposed_settings() {
        let places = [(0.8, 0.5), (1.2, 1.5), (1.6, 0.9)];
        let view = View::of(&places, &[(2.0, 2.5)], 7.0).expect("a view");
        assert!(view.eta.1 > 2.0 && view.rho.1 > 2.5, "{view:?}");
    }

    #[test]
    fn one_clearance_is_shown_with_a_fifth_of_it_about() {
        let places = [(0.8, 2.0), (1.2, 2.0), (1.6, 2.0)];
        let view = View::of(&places, &[], 7.0).expect("a view");
        assert!((view.rho.0 - 1.5).abs() < 1e-12 && (view.rho.1 - 2.4).abs() < 1e-12);
    }

    /// `ρ_s2(1.1)` = 6.351142, `ρ_s2(1.6)` = 1.812702 and `ρ_s1(0.9)` = 1.760461 of R = 0.9, β = 0.07,
    /// from an independent program in Python.
    #[test]
    fn valid_boundaries_are_the_published_ones() {
        let machine = Machine::symmetric(0.07, 0.9);
        let rho = |eta, kind| boundary_rho(&machine, eta, kind, 1).expect("a boundary");
        assert!((rho(1.1, BoundaryKind::SaddleNode) - 6.351_142).abs() < 1e-6);
        assert!((rho(1.6, BoundaryKind::SaddleNode) - 1.812_702).abs() < 1e-6);
        assert!((rho(0.9, BoundaryKind::PeriodDoubling) - 1.760_461).abs() < 1e-6);
        assert_eq!(boundary_rho(&machine, 1.1, BoundaryKind::Other, 1), None);
    }
}
