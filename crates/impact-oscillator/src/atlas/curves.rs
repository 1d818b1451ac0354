//! The boundaries as curves: edges of neighbouring columns chained where their motions' intervals
//! overlap, and the grazing of the impactless motion.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::edge::EdgeKind;
use super::line::Slice;
use super::resting::RestingSlice;
use crate::model::orbit::stable_orbit;
use crate::model::{BoundaryPoint, Machine, Orbit, Setting, rho_grazing, rho_s1, rho_s2};
use crate::parallel;

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PointOfCurve {
    /// η
    pub eta: f64,
    /// ρ
    pub rho: f64,
    /// Greatest approach speed of the marginal orbit.
    pub approach_speed: f64,
}

/// A boundary as a curve in the (η, ρ) plane, η rising.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Which boundary.
    pub kind: EdgeKind,
    /// Impacts of the motion that it bounds.
    pub p: u32,
    /// Drive periods of the motion.
    pub n: u32,
    /// Whether the motion has a dead zone.
    pub dead_zone: bool,
    /// Whether the motion lies below the curve.
    pub upper: bool,
    /// Its points.
    pub points: Vec<PointOfCurve>,
}

/// All boundaries as curves.
pub(super) fn curves(
    machine: &Machine,
    etas: &[f64],
    range: (f64, f64),
    largest_n: u32,
    columns: &[Vec<Slice>],
    resting: &[Vec<RestingSlice>],
) -> Vec<Curve> {
    let fine = refined(etas);
    let mut curves = vec![grazing_curve(machine, &fine)];
    curves.extend(closed_forms(machine, &fine, largest_n, range));
    let marks = columns.iter().map(|slices| {
        let followed = slices.iter().flat_map(slice_marks);
        let more = |m: &Mark| !is_closed_form(machine, m);
        followed.filter(more).collect()
    });
    curves.extend(chains(marks.collect()));
    let marks = resting
        .iter()
        .map(|slices| slices.iter().flat_map(resting_marks).collect());
    curves.extend(chains(marks.collect()));
    curves
}

/// Points of a closed form between two columns.
const REFINEMENT: usize = 6;

/// The columns' η with further ones evenly between them.
fn refined(etas: &[f64]) -> Vec<f64> {
    let mut fine: Vec<f64> = etas
        .windows(2)
        .flat_map(|w| {
            (0..REFINEMENT).map(move |k| w[0] + (w[1] - w[0]) * k as f64 / REFINEMENT as f64)
        })
        .collect();
    fine.extend(etas.last());
    fine
}

/// Whether a boundary is one that closed forms give: s2 of z = 1/n, with constant R s1 too.
fn is_closed_form(machine: &Machine, mark: &Mark) -> bool {
    let constant = machine.restitution().constant().is_some();
    let closed = match mark.kind {
        EdgeKind::SaddleNode => true,
        EdgeKind::PeriodDoubling => constant,
        _ => false,
    };
    mark.key.0 == 1 && closed
}

/// s2 and s1 of z = 1/n: pieces along which the marginal orbit exists.
fn closed_forms(
    machine: &Machine,
    etas: &[f64],
    largest_n: u32,
    (low, high): (f64, f64),
) -> Vec<Curve> {
    type Form = fn(&Machine, f64, u32) -> Option<BoundaryPoint>;
    let forms: [(EdgeKind, Form); 2] = [
        (EdgeKind::SaddleNode, rho_s2),
        (EdgeKind::PeriodDoubling, rho_s1),
    ];
    let all: Vec<(EdgeKind, Form, u32)> = (1..=largest_n)
        .flat_map(|n| forms.map(|(kind, form)| (kind, form, n)))
        .collect();
    let pieces = |&(kind, form, n): &(EdgeKind, Form, u32)| -> Vec<Curve> {
        let shown = |p: &BoundaryPoint| p.is_valid() && p.rho >= low && p.rho <= high;
        let points: Vec<Option<BoundaryPoint>> = etas
            .iter()
            .map(|&eta| form(machine, eta, n).filter(shown))
            .collect();
        let pieces = points.split(Option::is_none).filter(|p| !p.is_empty());
        let curve = |piece: &[Option<BoundaryPoint>]| Curve {
            kind,
            p: 1,
            n,
            dead_zone: false,
            upper: kind == EdgeKind::SaddleNode || stable_below(machine, piece, n),
            points: piece.iter().flatten().map(curve_point).collect(),
        };
        pieces.map(curve).collect()
    };
    parallel::map(&all, pieces).into_iter().flatten().collect()
}

fn curve_point(p: &BoundaryPoint) -> PointOfCurve {
    PointOfCurve {
        eta: p.eta,
        rho: p.rho,
        approach_speed: p.approach_speed,
    }
}

/// Whether the stable motion lies below a piece of s1.
fn stable_below(machine: &Machine, piece: &[Option<BoundaryPoint>], n: u32) -> bool {
    let Some(p) = piece[piece.len() / 2] else {
        return true;
    };
    let below = Setting::new(p.eta, p.rho - 1e-4 * (0.1 + p.rho.abs()));
    let near = |o: &Orbit| (o.approach_speed - p.approach_speed).abs() < 0.1 * p.approach_speed;
    stable_orbit(machine, below, n).is_ok_and(|o| o.is_some_and(|o| near(&o)))
}

fn grazing_curve(machine: &Machine, etas: &[f64]) -> Curve {
    let at = |eta: &f64| PointOfCurve {
        eta: *eta,
        rho: rho_grazing(machine, *eta),
        approach_speed: 0.0,
    };
    Curve {
        kind: EdgeKind::ImpactlessGrazing,
        p: 0,
        n: 1,
        dead_zone: false,
        upper: false,
        points: etas.iter().map(at).collect(),
    }
}

/// p, n, whether there is a dead zone, whether it is an upper edge, the boundary's name.
type Key = (u32, u32, bool, bool, &'static str);

/// A point of a curve, with the interval of its motion by which points of neighbouring columns
/// are found to belong to the same curve.
#[derive(Debug, Clone)]
struct Mark {
    key: Key,
    kind: EdgeKind,
    point: PointOfCurve,
    interval: (f64, f64),
}

fn slice_marks(s: &Slice) -> Vec<Mark> {
    let interval = (s.low.orbit.rho, s.high.orbit.rho);
    [(&s.low, false), (&s.high, true)]
        .into_iter()
        .filter(|(edge, _)| edge.kind != EdgeKind::Bound)
        .map(|(edge, upper)| {
            let point = PointOfCurve {
                eta: s.eta,
                rho: edge.orbit.rho,
                approach_speed: edge.orbit.greatest_speed(),
            };
            Mark {
                key: (s.p, s.n, false, upper, edge.kind.name()),
                kind: edge.kind,
                point,
                interval,
            }
        })
        .collect()
}

fn resting_marks(s: &RestingSlice) -> Vec<Mark> {
    [(s.low, false), (s.high, true)]
        .into_iter()
        .filter_map(|(edge, upper)| {
            let (rho, kind) = edge?;
            let point = PointOfCurve {
                eta: s.eta,
                rho,
                approach_speed: 0.0,
            };
            Some(Mark {
                key: (s.p, s.n, true, upper, kind.name()),
                kind,
                point,
                interval: s.interval,
            })
        })
        .collect()
}

/// Chain marks of neighbouring columns whose motions' intervals overlap.
fn chains(columns: Vec<Vec<Mark>>) -> Vec<Curve> {
    let mut done: Vec<Curve> = Vec::new();
    let mut open: BTreeMap<Key, Vec<(Mark, Curve)>> = BTreeMap::new();
    for marks in columns {
        let mut next: BTreeMap<Key, Vec<(Mark, Curve)>> = BTreeMap::new();
        for mark in marks {
            let list = open.entry(mark.key).or_default();
            let fits = |(last, _): &(Mark, Curve)| {
                last.interval.0 <= mark.interval.1 && mark.interval.0 <= last.interval.1
            };
            let mut curve = match list.iter().position(fits) {
                Some(at) => list.swap_remove(at).1,
                None => {
                    let (p, n, dead_zone, upper, _) = mark.key;
                    Curve {
                        kind: mark.kind,
                        p,
                        n,
                        dead_zone,
                        upper,
                        points: Vec::new(),
                    }
                }
            };
            curve.points.push(mark.point);
            next.entry(mark.key).or_default().push((mark, curve));
        }
        done.extend(open.into_values().flatten().map(|(_, curve)| curve));
        open = next;
    }
    done.extend(open.into_values().flatten().map(|(_, curve)| curve));
    done.sort_by_key(|a| (a.n, a.p, a.dead_zone, a.upper));
    done
}
