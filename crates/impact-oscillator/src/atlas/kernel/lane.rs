//! A lane and its cell: loaded, parked, placed at a state and read off again.

use super::cell::{Cell, Course};
use super::step::Group;
use crate::atlas::lanes::Lanes;
use crate::model::SettledMotion;

/// Longest step in units of the faster of both rates: a quarter of it is where the polynomials
/// end.
pub(super) const LONGEST: f64 = 3.2;
/// Longest first step after an impact, likewise: a shorter one has a tighter bound.
pub(super) const FIRST: f64 = 1.6;
/// Displacement resolution below which a bounce is not distinguished from rest (as in `model::contact`).
pub(super) const RESOLUTION: f64 = 1e-13;

/// The impact with which later ones are compared.
#[derive(Debug, Clone, Copy)]
pub(super) struct Anchor {
    /// Time.
    pub(super) t: f64,
    /// Number of impacts so far.
    pub(super) hits: f64,
}

/// What the slow path knows of a lane beside the vectors.
#[derive(Clone, Copy)]
pub(super) struct Lane {
    pub(super) index: usize,
    pub(super) cell: Cell,
    pub(super) period: f64,
    /// Complex forced amplitude at phase 0.
    pub(super) forced: (f64, f64),
    pub(super) watching: bool,
    pub(super) found: Option<SettledMotion>,
    /// Whether a return is being followed once more.
    pub(super) confirming: bool,
    /// Time and impacts at the last release from the stop.
    pub(super) released: Option<(f64, f64)>,
    pub(super) hits_at_watch: f64,
    pub(super) anchor: Anchor,
}

impl Lane {
    /// The forced response at a phase of the drive, complex.
    pub(super) fn forced_at(&self, phase: f64) -> (f64, f64) {
        let (sin, cos) = phase.sin_cos();
        let (re, im) = self.forced;
        (re * cos - im * sin, re * sin + im * cos)
    }
}

pub(super) const IDLE: Lane = Lane {
    index: 0,
    cell: Cell {
        eta: 1.0,
        rho: 1.0,
        x: 0.0,
        v: 0.0,
        phase: 0.0,
    },
    period: 1.0,
    forced: (0.0, 0.0),
    watching: false,
    found: None,
    confirming: false,
    released: None,
    hits_at_watch: 0.0,
    anchor: Anchor { t: 0.0, hits: 0.0 },
};

pub(super) fn empty_group<V: Lanes>() -> Group<V> {
    let (zero, one) = (V::splat(0.0), V::splat(1.0));
    let far = V::splat(f64::INFINITY);
    Group {
        eta: one,
        eta2: one,
        eta3: one,
        quarter_eta: V::splat(0.25),
        rho: V::splat(1e6),
        exit_rho: V::splat(f64::NEG_INFINITY),
        forced: one,
        k4: one,
        longest: one,
        least: zero,
        first: one,
        near: zero,
        rest: zero,
        zr: zero,
        zi: zero,
        zm: zero,
        fr: zero,
        fi: zero,
        t: zero,
        t_next: far,
        hm: one,
        hits: zero,
        anchor: far,
        reach: one,
        tolerance: zero,
    }
}

/// Load a cell into a lane.
pub(super) fn load<V: Lanes>(
    course: &Course,
    s: &mut Group<V>,
    info: &mut Lane,
    lane: usize,
    (index, cell): (usize, Cell),
) {
    let eta = cell.eta;
    let (re, im) = (1.0 - eta * eta, 2.0 * course.damping_ratio * eta);
    let d = re * re + im * im;
    let period = std::f64::consts::TAU / eta;
    *info = Lane {
        index,
        cell,
        period,
        forced: (re / d, -im / d),
        ..IDLE
    };
    let amplitude = 1.0 / d.sqrt();
    let open = course.leave_early;
    let values = [
        (&mut s.eta, eta),
        (&mut s.eta2, eta * eta),
        (&mut s.eta3, eta * eta * eta),
        (&mut s.quarter_eta, 0.25 * eta),
        (&mut s.rho, cell.rho),
        (
            &mut s.exit_rho,
            if open { cell.rho } else { f64::NEG_INFINITY },
        ),
        (&mut s.forced, amplitude),
        (&mut s.k4, eta.powi(4) * amplitude),
        (&mut s.longest, LONGEST / eta.max(1.0)),
        (&mut s.least, 1e-3 * LONGEST / eta.max(1.0)),
        (&mut s.first, FIRST / eta.max(1.0)),
        (&mut s.near, 4e-15 * (amplitude + 1.0)),
        (
            &mut s.rest,
            2.0 * RESOLUTION * (amplitude + cell.rho.abs() + 1.0),
        ),
        (&mut s.t_next, course.settle_periods * period),
        (&mut s.hits, 0.0),
        (&mut s.tolerance, course.tight),
    ];
    for (vector, value) in values {
        vector.set(lane, value);
    }
    forget(s, info, lane, 0.0);
    if course.every_impact {
        info.watching = true;
        s.t_next.set(lane, course.watch_periods * period);
        s.tolerance.set(lane, -1.0);
        s.reach.set(lane, 0.0);
    }
    place(
        course,
        s,
        info,
        lane,
        (0.0, cell.x.min(cell.rho), cell.v, cell.phase),
    );
}

/// A lane without a cell goes on unseen; without a free vibration its numbers stay normal.
pub(super) fn park<V: Lanes>(s: &mut Group<V>, lane: usize) {
    for vector in [&mut s.zr, &mut s.zi, &mut s.zm] {
        vector.set(lane, 0.0);
    }
}

/// Restart the search for a recurrence.
pub(super) fn forget<V: Lanes>(s: &mut Group<V>, info: &mut Lane, lane: usize, t: f64) {
    let hits = s.hits.get(lane);
    info.anchor = Anchor { t, hits };
    s.anchor.set(lane, f64::INFINITY);
    s.reach.set(lane, hits + 1.0);
}

/// Put a lane at (t, x, v, phase), with libm's precision.
pub(super) fn place<V: Lanes>(
    course: &Course,
    s: &mut Group<V>,
    info: &Lane,
    lane: usize,
    at: (f64, f64, f64, f64),
) {
    let (t, x, v, phase) = at;
    let (fr, fi) = info.forced_at(phase);
    let beta = course.damping_ratio;
    let omega = (1.0 - beta * beta).sqrt();
    let (zr, vh) = (x - fr, v + info.cell.eta * fi);
    let zi = -(beta * zr + vh) / omega;
    let longest = s.longest.get(lane);
    let values = [
        (&mut s.fr, fr),
        (&mut s.fi, fi),
        (&mut s.zr, zr),
        (&mut s.zi, zi),
        (&mut s.zm, zr.hypot(zi) * (1.0 + 1e-15)),
        (&mut s.t, t),
        (&mut s.hm, longest),
    ];
    for (vector, value) in values {
        vector.set(lane, value);
    }
}

/// (x, v, phase) of a lane now.
pub(super) fn where_is<V: Lanes>(
    course: &Course,
    s: &Group<V>,
    info: &Lane,
    lane: usize,
) -> (f64, f64, f64) {
    let beta = course.damping_ratio;
    let omega = (1.0 - beta * beta).sqrt();
    let (zr, zi, fr, fi) = (
        s.zr.get(lane),
        s.zi.get(lane),
        s.fr.get(lane),
        s.fi.get(lane),
    );
    let v = -beta * zr - omega * zi - info.cell.eta * fi;
    let phase = fi.atan2(fr) - info.forced.1.atan2(info.forced.0);
    (zr + fr, v, phase.rem_euclid(std::f64::consts::TAU))
}
