//! The boundaries as curves: edges of neighbouring columns chained where their motions' intervals
//! overlap, and the grazing of the impactless motion.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::continuation::EdgeKind;
use super::regions::Slice;
use super::resting::RestingSlice;
use crate::model::{Machine, rho_grazing};

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// η
    pub eta: f64,
    /// ρ
    pub rho: f64,
    /// Greatest closing speed of the marginal orbit.
    pub closing_speed: f64,
}

/// A boundary as a curve in the (η, ρ) plane, η rising.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Name of the boundary: s1, s2, grazing, rho_grazing (ρ' of z = 0), joined (ρp), …
    pub kind: String,
    /// Impacts of the motion that it bounds.
    pub p: u32,
    /// Drive periods of the motion.
    pub n: u32,
    /// Whether the motion has a dead zone.
    pub dead_zone: bool,
    /// Whether the motion lies below the curve.
    pub upper: bool,
    /// Its points.
    pub points: Vec<CurvePoint>,
}

/// All boundaries as curves.
pub fn curves(
    machine: &Machine,
    etas: &[f64],
    columns: &[Vec<Slice>],
    resting: &[Vec<RestingSlice>],
) -> Vec<Curve> {
    let mut curves = vec![grazing_curve(machine, etas)];
    let marks = columns
        .iter()
        .map(|slices| slices.iter().flat_map(slice_marks).collect());
    curves.extend(chains(marks.collect()));
    let marks = resting
        .iter()
        .map(|slices| slices.iter().flat_map(resting_marks).collect());
    curves.extend(chains(marks.collect()));
    curves
}

fn grazing_curve(machine: &Machine, etas: &[f64]) -> Curve {
    let at = |eta: &f64| CurvePoint {
        eta: *eta,
        rho: rho_grazing(machine, *eta),
        closing_speed: 0.0,
    };
    Curve {
        kind: "rho_grazing".into(),
        p: 0,
        n: 1,
        dead_zone: false,
        upper: false,
        points: etas.iter().map(at).collect(),
    }
}

/// What a curve is, and the interval of its motion by which neighbours are told to belong.
type Key = (u32, u32, bool, bool, String);

#[derive(Debug, Clone)]
struct Mark {
    key: Key,
    point: CurvePoint,
    interval: (f64, f64),
}

fn slice_marks(s: &Slice) -> Vec<Mark> {
    let interval = (s.low.orbit.rho, s.high.orbit.rho);
    [(&s.low, false), (&s.high, true)]
        .into_iter()
        .filter(|(edge, _)| edge.kind != EdgeKind::Bound)
        .map(|(edge, upper)| {
            let speed = edge.orbit.speeds.iter().fold(0.0, |m: f64, w| m.max(*w));
            let point = CurvePoint {
                eta: s.eta,
                rho: edge.orbit.rho,
                closing_speed: speed,
            };
            Mark {
                key: (s.p, s.n, false, upper, edge.kind.name().into()),
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
            let point = CurvePoint {
                eta: s.eta,
                rho,
                closing_speed: 0.0,
            };
            let key = (s.p, s.n, true, upper, kind.name().into());
            Some(Mark {
                key,
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
            let list = open.entry(mark.key.clone()).or_default();
            let fits = |(last, _): &(Mark, Curve)| {
                last.interval.0 <= mark.interval.1 && mark.interval.0 <= last.interval.1
            };
            let mut curve = match list.iter().position(fits) {
                Some(at) => list.swap_remove(at).1,
                None => {
                    let (p, n, dead_zone, upper, kind) = mark.key.clone();
                    Curve {
                        kind,
                        p,
                        n,
                        dead_zone,
                        upper,
                        points: Vec::new(),
                    }
                }
            };
            curve.points.push(mark.point);
            next.entry(mark.key.clone())
                .or_default()
                .push((mark, curve));
        }
        done.extend(open.into_values().flatten().map(|(_, curve)| curve));
        open = next;
    }
    done.extend(open.into_values().flatten().map(|(_, curve)| curve));
    done.sort_by_key(|a| (a.n, a.p, a.dead_zone, a.upper));
    done
}

