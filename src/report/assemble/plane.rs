//! Boundaries and regions of the fitted model in the (η, ρ) plane of the campaign.

use rayon::prelude::*;

use super::{Gathered, rows};
use crate::identify::fit::parameters::Coordinate;
use crate::identify::replay::LIVELY_SPEED;
use crate::identify::uncertainty::band::Spread;
use crate::motion::Motion;
use crate::report::content::{BoundaryCurve, BoundaryKind, RegionMap};
use impact_oscillator::SettledMotion;
use impact_oscillator::atlas::map::even;
use impact_oscillator::atlas::{MapGrid, MapSettings, region_map as simulate_map};
use impact_oscillator::model::boundary::{rho_grazing, rho_s1, rho_s2};
use impact_oscillator::model::orbit::stable_orbit;
use impact_oscillator::model::params::{Initial, Machine, Setting};

/// Columns and rows of the region map.
const MAP: (usize, usize) = (180, 130);
/// Points of a boundary curve.
const CURVE_POINTS: usize = 220;
/// Clearance, times β, beyond which nothing touches: the resonance reaches ρ = 1/(2β). Gaps so wide
/// say nothing about the regions.
const REACH: f64 = 0.55;
/// Largest n whose z = 1/n boundaries are drawn.
const MOST_PERIODS: u32 = 3;

/// The part of the plane that the campaign visited, with a margin.
struct View {
    eta: (f64, f64),
    rho: (f64, f64),
}

impl View {
    fn of(gathered: &Gathered) -> Option<Self> {
        let places: Vec<(f64, f64)> = gathered
            .observations
            .iter()
            .filter(|o| !o.excluded())
            .map(|o| rows::place(gathered, o))
            .filter_map(|(eta, rho)| Some((eta?, rho?)))
            .collect();
        if places.len() < 3 {
            return None;
        }
        let span = |values: Vec<f64>, margin: f64| {
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let room = margin * (high - low).max(0.1);
            (low - room, high + room)
        };
        let eta = span(places.iter().map(|p| p.0).collect(), 0.05);
        let reach = gathered
            .parameters()
            .map_or(f64::INFINITY, |p| REACH / p.damping_ratio);
        let touching: Vec<f64> = places.iter().map(|p| p.1).filter(|r| *r <= reach).collect();
        if touching.is_empty() {
            return None;
        }
        let (low, high) = span(touching.clone(), 0.0);
        // A single clearance is shown with as much of the plane about it as a figure shows.
        let rho = if high - low < 0.1 * high {
            (0.8 * low, 1.2 * high)
        } else {
            span(touching, 0.12)
        };
        Some(Self {
            eta: (eta.0.max(0.05), eta.1),
            rho: (rho.0.min(0.05).max(rho.0 - 0.1).max(0.0), rho.1),
        })
    }
}

/// The fitted machine without its asymmetry: the plane is drawn as the paper does.
fn machine(gathered: &Gathered) -> Option<Machine> {
    let fitted = gathered.parameters()?;
    (fitted.in_range() && tells_restitution(gathered))
        .then(|| fitted.without_asymmetry().machine(gathered.campaign.rig))
}

/// Without a fitted R there are no regions of impact motion to draw.
fn tells_restitution(gathered: &Gathered) -> bool {
    gathered
        .fit()
        .is_some_and(|fit| fit.free.contains(&Coordinate::Restitution))
}

/// s2 and s1 of z = 1/n and the grazing boundary, each with its 95 % band.
pub(super) fn curves(gathered: &Gathered) -> Vec<BoundaryCurve> {
    let (Some(view), Some(machine), Some(joint)) = (
        View::of(gathered),
        machine(gathered),
        &gathered.identification.joint_fit,
    ) else {
        return Vec::new();
    };
    let etas = even((view.eta.0, view.eta.1, CURVE_POINTS));
    let spread = Spread::of(&joint.fit, joint.variance_factor, gathered.campaign.rig);
    let mut wanted = vec![(BoundaryKind::Grazing, 1)];
    for n in 1..=MOST_PERIODS {
        wanted.extend([(BoundaryKind::S2, n), (BoundaryKind::S1, n)]);
    }
    let drawn: Vec<Vec<BoundaryCurve>> = wanted
        .into_par_iter()
        .map(|(kind, periods_n)| {
            let place = |machine: &Machine, eta: f64| place(machine, eta, kind, periods_n);
            pieces(&etas, |eta| place(&machine, eta))
                .into_iter()
                .map(|points| BoundaryCurve {
                    kind,
                    periods_n,
                    band95: band(&spread, &points, &place),
                    points,
                })
                .collect()
        })
        .collect();
    drawn.into_iter().flatten().collect()
}

/// ρ of a boundary at η; `None` where no motion of the machine ends there.
fn place(machine: &Machine, eta: f64, kind: BoundaryKind, n: u32) -> Option<f64> {
    let point = match kind {
        BoundaryKind::S2 => rho_s2(machine, eta, n),
        BoundaryKind::S1 => rho_s1(machine, eta, n),
        BoundaryKind::Grazing => return Some(rho_grazing(machine, eta)),
        // has no closed form
        BoundaryKind::Edge => None,
    }?;
    (point.is_valid() && point.rho > 0.0).then_some(point.rho)
}

/// Unbroken pieces of a curve: a jump or a missing value ends one.
fn pieces(etas: &[f64], rho: impl Fn(f64) -> Option<f64>) -> Vec<Vec<[f64; 2]>> {
    let mut out: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut broken = true;
    for eta in etas {
        match rho(*eta) {
            Some(value) => {
                if broken {
                    out.push(Vec::new());
                }
                if let Some(piece) = out.last_mut() {
                    piece.push([*eta, value]);
                }
                broken = false;
            }
            None => broken = true,
        }
    }
    out.retain(|piece| piece.len() > 2);
    out
}

/// Band of a curve; where it ends for a machine nearby, the band ends.
fn band(
    spread: &Spread,
    points: &[[f64; 2]],
    place: &impl Fn(&Machine, f64) -> Option<f64>,
) -> Vec<[f64; 3]> {
    let points = points.iter().filter_map(|[eta, rho]| {
        let half = spread.half95(|machine| place(machine, *eta))?;
        (half > 0.0).then_some([*eta, rho - half, rho + half])
    });
    points.collect()
}

/// Regions of motion: every cell from rest; where hysteresis lies, the other motion beside it.
pub(super) fn region_map(gathered: &Gathered) -> Option<RegionMap> {
    let (view, machine) = (View::of(gathered)?, machine(gathered)?);
    let grid = MapGrid::even(
        (view.eta.0, view.eta.1, MAP.0),
        (view.rho.0.max(0.02), view.rho.1, MAP.1),
    );
    let settings = MapSettings::default();
    let rest = motions(&simulate_map(&machine, &grid, &settings).ok()?.cells);
    let lively = MapSettings {
        start: Initial::both(0.0, LIVELY_SPEED),
        ..settings
    };
    let lively = motions(&simulate_map(&machine, &grid, &lively).ok()?.cells);
    let other = |i: usize| match rest[i] == lively[i] {
        true => coexisting(&machine, grid.at(i), &rest[i]).unwrap_or_else(|| rest[i].clone()),
        false => lively[i].clone(),
    };
    let second: Vec<Motion> = (0..grid.len()).into_par_iter().map(other).collect();
    Some(RegionMap::of_motions(
        grid.eta,
        grid.rho,
        &rest,
        &second,
        "every cell simulated from rest and from a lively start, and the stable orbits z = 1/n in \
         closed form; where they differ, both motions exist",
    ))
}

fn motions(cells: &[SettledMotion]) -> Vec<Motion> {
    cells.iter().map(|cell| Motion::from(*cell)).collect()
}

/// A stable z = 1/n motion that exists beside another one.
fn coexisting(machine: &Machine, (eta, rho): (f64, f64), beside: &Motion) -> Option<Motion> {
    let setting = Setting {
        frequency_ratio: eta,
        clearance: rho,
        phase: 0.0,
    };
    let stable = |n: &u32| {
        let orbit = stable_orbit(machine, setting, *n).ok().flatten();
        orbit.is_some()
    };
    (1..=MOST_PERIODS)
        .filter(|n| *beside != Motion::periodic(1, *n))
        .find(stable)
        .map(|n| Motion::periodic(1, n))
}
