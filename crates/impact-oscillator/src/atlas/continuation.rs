//! Pseudo-arclength continuation of periodic orbits p/n along ρ or η, to the edge where they
//! lose stability or cease to exist, and the orbits that branch off at a period doubling.

use nalgebra::{DMatrix, DVector};

use super::edge::{Edge, EdgeKind};
use crate::model::{Existence, Machine, PeriodicOrbit};

/// The parameter along which an orbit is continued; the other one stays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Along {
    /// ρ
    Clearance,
    /// η
    FrequencyRatio,
}

impl Along {
    /// The parameter's value at an orbit.
    pub(super) fn of(self, orbit: &PeriodicOrbit) -> f64 {
        match self {
            Self::Clearance => orbit.rho,
            Self::FrequencyRatio => orbit.eta,
        }
    }

    fn set(self, orbit: &mut PeriodicOrbit, value: f64) {
        match self {
            Self::Clearance => orbit.rho = value,
            Self::FrequencyRatio => orbit.eta = value,
        }
    }
}

/// Longest step in arclength.
const LONGEST: f64 = 0.3;
/// Length to which an edge is located.
const RESOLUTION: f64 = 1e-7;
/// Most steps.
const STEPS: usize = 400;

/// A point of a branch with its direction in (times, speeds, parameter).
#[derive(Debug, Clone)]
struct Point {
    orbit: PeriodicOrbit,
    tangent: DVector<f64>,
}

/// Follows one branch.
struct Follower<'a> {
    machine: &'a Machine,
    along: Along,
    /// +1: rising parameter, −1: falling.
    direction: f64,
}

impl Follower<'_> {
    /// Jacobian by unknowns and parameter, and residual.
    fn extended(&self, orbit: &PeriodicOrbit) -> (DVector<f64>, DMatrix<f64>) {
        let (residual, jacobian) = orbit.linearised(self.machine);
        let n = residual.len();
        let by_parameter = match self.along {
            Along::Clearance => {
                let gap = self.machine.gap(1.0);
                DVector::from_fn(n, |i, _| if i < n / 2 { -gap } else { 0.0 })
            }
            Along::FrequencyRatio => {
                let h = 1e-6;
                let at = |eta| {
                    PeriodicOrbit {
                        eta,
                        ..orbit.clone()
                    }
                    .residual(self.machine)
                };
                (at(orbit.eta + h) - at(orbit.eta - h)) / (2.0 * h)
            }
        };
        let mut wide = jacobian.insert_column(n, 0.0);
        wide.set_column(n, &by_parameter);
        (residual, wide)
    }

    /// Unit tangent, oriented like a reference.
    fn tangent(&self, orbit: &PeriodicOrbit, like: &DVector<f64>) -> Option<DVector<f64>> {
        let (_, wide) = self.extended(orbit);
        let n = wide.nrows();
        let mut square = wide.insert_row(n, 0.0);
        square.set_row(n, &like.transpose());
        let mut right = DVector::zeros(n + 1);
        right[n] = 1.0;
        square.lu().solve(&right).map(|t| t.normalize())
    }

    /// The branch's point at arclength ds from a point (its tangent is the point's own still).
    fn at(&self, from: &Point, ds: f64) -> Option<PeriodicOrbit> {
        let start = self.unknowns(&from.orbit) + &from.tangent * ds;
        let mut z = start.clone();
        for _ in 0..12 {
            let orbit = self.orbit(&from.orbit, &z);
            let (residual, wide) = self.extended(&orbit);
            let n = residual.len();
            let mut square = wide.insert_row(n, 0.0);
            square.set_row(n, &from.tangent.transpose());
            let right = residual.insert_row(n, from.tangent.dot(&(&z - &start)));
            let change = square.lu().solve(&right)?;
            z -= &change;
            if change.amax() < 1e-11 {
                let orbit = self.orbit(&from.orbit, &z);
                return orbit.is_ordered().then_some(orbit);
            }
            if change.amax().is_nan() || change.amax() >= 1.0 {
                return None;
            }
        }
        None
    }

    fn unknowns(&self, orbit: &PeriodicOrbit) -> DVector<f64> {
        let z = orbit.unknowns();
        let n = z.len();
        z.insert_row(n, self.along.of(orbit))
    }

    fn orbit(&self, like: &PeriodicOrbit, z: &DVector<f64>) -> PeriodicOrbit {
        let mut orbit = like.with_unknowns(z);
        self.along.set(&mut orbit, z[z.len() - 1]);
        orbit
    }

    /// Whether an orbit is a stable motion; if not, why.
    fn fault(&self, orbit: &PeriodicOrbit) -> Option<EdgeKind> {
        match orbit.existence(self.machine) {
            Existence::Exists => {}
            Existence::FurtherImpact => return Some(EdgeKind::Grazing),
            Existence::NotClosing => return Some(EdgeKind::ImpactVanishes),
            Existence::DeadZone => return Some(EdgeKind::DeadZone),
        }
        let largest = orbit.multipliers(self.machine)[0];
        if largest.norm() < 1.0 {
            None
        } else if largest.im.abs() > 1e-9 {
            Some(EdgeKind::Torus)
        } else if largest.re < 0.0 {
            Some(EdgeKind::PeriodDoubling)
        } else {
            Some(EdgeKind::SaddleNode)
        }
    }

    /// What ends the motion before or at a point reached from another. A branch that turns back
    /// although it stays stable has passed the doubling at which it was born, and is now its
    /// own copy shifted by half its period.
    fn ends(&self, from: &Point, orbit: &PeriodicOrbit) -> Option<EdgeKind> {
        self.fault(orbit).or_else(|| {
            let tangent = self.tangent(orbit, &from.tangent)?;
            (tangent[tangent.len() - 1] * self.direction < 0.0).then_some(EdgeKind::PeriodDoubling)
        })
    }

    /// Between a good point and a step that is too far, the last good orbit and what ends it.
    fn locate(&self, from: &Point, mut too_far: f64, mut kind: EdgeKind) -> Edge {
        let (mut good, mut orbit) = (0.0, from.orbit.clone());
        while too_far - good > RESOLUTION {
            let middle = 0.5 * (good + too_far);
            let found = self.at(from, middle);
            match found.as_ref().map(|o| self.ends(from, o)) {
                Some(None) => {
                    good = middle;
                    orbit = found.unwrap_or(orbit);
                }
                Some(Some(k)) => (too_far, kind) = (middle, k),
                None => (too_far, kind) = (middle, EdgeKind::Lost),
            }
        }
        named(kind, orbit)
    }

    /// The branch's edge; parameter and greatest approach speed of every orbit on the way.
    fn walk(
        &self,
        seed: &PeriodicOrbit,
        (least, greatest): (f64, f64),
        passed: &mut Vec<(f64, f64)>,
    ) -> Edge {
        let n = 2 * seed.times.len() + 1;
        let mut towards = DVector::zeros(n);
        towards[n - 1] = self.direction;
        let lost = |orbit: &PeriodicOrbit| named(EdgeKind::Lost, orbit.clone());
        let Some(tangent) = self.tangent(seed, &towards) else {
            return lost(seed);
        };
        let mut point = Point {
            orbit: seed.clone(),
            tangent,
        };
        let mut ds = 0.1 * LONGEST;
        for _ in 0..STEPS {
            passed.push((self.along.of(&point.orbit), point.orbit.greatest_speed()));
            let Some(next) = self.at(&point, ds) else {
                passed.pop();
                ds *= 0.4;
                if ds < RESOLUTION {
                    return lost(&point.orbit);
                }
                continue;
            };
            if let Some(kind) = self.ends(&point, &next) {
                return self.locate(&point, ds, kind);
            }
            let value = self.along.of(&next);
            if value <= least || value >= greatest {
                return Edge {
                    kind: EdgeKind::Bound,
                    orbit: next,
                };
            }
            let Some(tangent) = self.tangent(&next, &point.tangent) else {
                return lost(&next);
            };
            // a sharp turn needs shorter steps
            let turn = tangent.dot(&point.tangent);
            ds = if turn < 0.9 {
                0.5 * ds
            } else {
                (1.5 * ds).min(LONGEST)
            };
            point = Point {
                orbit: next,
                tangent,
            };
        }
        lost(&point.orbit)
    }
}

/// An edge by what it is: at the doubling where it was born an orbit is twice its half, and
/// neither the multiplier +1 nor a continuation that breaks off there is more than that.
fn named(kind: EdgeKind, orbit: PeriodicOrbit) -> Edge {
    let unclear = matches!(kind, EdgeKind::SaddleNode | EdgeKind::Lost);
    let born = unclear && orbit.reduced_within(1e-3).n < orbit.n;
    let kind = if born { EdgeKind::PeriodDoubling } else { kind };
    Edge { kind, orbit }
}

/// An edge and the branch up to it.
#[derive(Debug, Clone)]
pub(super) struct Followed {
    /// What ends the motion, and where.
    pub(super) edge: Edge,
    /// The parameter and the greatest approach speed of the orbits on the way, the edge's last.
    pub(super) passed: Vec<(f64, f64)>,
}

/// Continue a stable orbit in one direction (+1: rising parameter) to its edge, or to the least or
/// greatest value of the parameter.
pub(super) fn follow(
    machine: &Machine,
    seed: &PeriodicOrbit,
    along: Along,
    direction: f64,
    bounds: (f64, f64),
) -> Followed {
    let follower = Follower {
        machine,
        along,
        direction,
    };
    let mut passed = Vec::new();
    let edge = follower.walk(seed, bounds, &mut passed);
    passed.push((along.of(&edge.orbit), edge.orbit.greatest_speed()));
    Followed { edge, passed }
}

/// The stable orbit of doubled period that branches from an orbit at its period doubling (in
/// the direction of `along` in which it is found first), by a start displaced alternately.
pub(super) fn branch_at_doubling(
    machine: &Machine,
    edge: &PeriodicOrbit,
    along: Along,
) -> Option<PeriodicOrbit> {
    let value = along.of(edge);
    [3e-3, -3e-3, 3e-2, -3e-2].into_iter().find_map(|step| {
        let mut twice = edge.doubled();
        along.set(&mut twice, value + step * (0.1 + value.abs()));
        let mode = alternating_mode(machine, edge)?;
        [0.3, 0.1, 0.03].into_iter().find_map(|size| {
            let z = twice.unknowns() + &mode * (size * step.abs().sqrt() / 0.05);
            let orbit = twice.with_unknowns(&z).solve(machine)?;
            let fresh = orbit.reduced().n == twice.n;
            let good = fresh && orbit.existence(machine) == Existence::Exists;
            (good && orbit.is_stable(machine)).then_some(orbit)
        })
    })
}

/// Direction of the doubled orbit's unknowns that alternates between both runs: the null
/// vector of the doubled orbit's Jacobian at the doubling.
fn alternating_mode(machine: &Machine, edge: &PeriodicOrbit) -> Option<DVector<f64>> {
    let (_, jacobian) = edge.doubled().linearised(machine);
    let svd = jacobian.svd(false, true);
    let least = svd.singular_values.argmin().0;
    Some(svd.v_t?.row(least).transpose())
}
