//! Events of a lane between its steps: an orbit that recurs, a mass that rests at the stop, the
//! end of settling and watch, a cell that is done.

use super::cell::{Cell, Course, Feed, Outcome, Strike};
use super::lane::{Anchor, Lane, forget, place, where_is};
use super::step::{Events, Group};
use crate::atlas::lanes::Lanes;
use crate::model::SettledMotion;
use crate::model::motion::count;

/// The mass has no relative speed left at the stop, at (t, phase): it rests there until the
/// drive lets go (cos φ = ρ, falling), then leaves; or it leaves at once. Returns whether it
/// stays for all time.
pub(super) fn come_to_rest<V: Lanes>(
    course: &Course,
    s: &mut Group<V>,
    info: &mut Lane,
    lane: usize,
    at: (f64, f64),
) -> bool {
    let (mut t, mut phase) = at;
    let rho = info.cell.rho;
    if phase.cos() - rho > 0.0 {
        if rho <= -1.0 {
            info.found = Some(SettledMotion::Sticking);
            return true;
        }
        let release = rho.acos();
        t += (release - phase).rem_euclid(std::f64::consts::TAU) / info.cell.eta;
        phase = release;
        let hits = s.hits.get(lane);
        if let Some((t0, hits0)) = info.released
            && info.found.is_none()
        {
            info.found = Some(resting_orbit(course, (t - t0) / info.period, hits - hits0));
        }
        info.released = Some((t, hits));
    }
    leave(course, s, info, lane, (t, phase));
    false
}

/// Between two releases at the same phase the motion is one and the same: periodic.
fn resting_orbit(course: &Course, periods: f64, hits: f64) -> SettledMotion {
    let chatter = course.restitution > 0.0;
    SettledMotion::Periodic {
        p: if chatter { 1 } else { count(hits) },
        n: count(periods.round()),
        dead_zone: true,
        chatter,
    }
}

/// First step off the stop from x = ρ, v = 0: the longest with a + jh/3 + Kh²/12 ≤ 0.
fn leave<V: Lanes>(course: &Course, s: &mut Group<V>, info: &Lane, lane: usize, at: (f64, f64)) {
    let (t, phase) = at;
    let (rho, eta, beta) = (info.cell.rho, info.cell.eta, course.damping_ratio);
    place(course, s, info, lane, (t, rho, 0.0, phase));
    let a = (phase.cos() - rho).min(0.0);
    let j = -eta * phase.sin() - 2.0 * beta * a;
    let k = s.zm.get(lane) + s.k4.get(lane);
    let longest = s.longest.get(lane);
    let root = j * j / 9.0 - k * a / 3.0;
    let h = ((root.max(0.0).sqrt() - j / 3.0) * 6.0 / k).clamp(1e-6 * longest, longest);
    let omega = (1.0 - beta * beta).sqrt();
    let (e, (sin, cos)) = ((-beta * h).exp(), (omega * h).sin_cos());
    let (zr, zi) = (s.zr.get(lane), s.zi.get(lane));
    let (fr, fi) = (s.fr.get(lane), s.fi.get(lane));
    let (se, ce) = (eta * h).sin_cos();
    let values = [
        (&mut s.zr, e * (zr * cos - zi * sin)),
        (&mut s.zi, e * (zr * sin + zi * cos)),
        (&mut s.fr, fr * ce - fi * se),
        (&mut s.fi, fr * se + fi * ce),
        (&mut s.t, t + h),
        (&mut s.hm, 1.5 * h),
    ];
    for (vector, value) in values {
        vector.set(lane, value);
    }
    let hm = s.hm.get(lane).min(longest);
    s.hm.set(lane, hm);
}

/// Serve a lane that raised an event. Returns whether its cell is done (and was handed over).
#[inline(never)]
pub(super) fn serve<V: Lanes>(
    course: &Course,
    feed: &mut impl Feed,
    s: &mut Group<V>,
    info: &mut Lane,
    (lane, e): (usize, &Events<V>),
) -> bool {
    let raised = |mask: V::Mask| V::bits(mask) & (1 << lane) != 0;
    let h = e.step.get(lane);
    if raised(e.recurs) || raised(e.anew) {
        let here = Anchor {
            t: s.t.get(lane) - h,
            hits: s.hits.get(lane),
        };
        if course.every_impact {
            feed.impact(info.index, strike(course, info, here.t, e.after.get(lane)));
        } else if raised(e.recurs) && is_same(s, info, lane, &here) {
            recognise(s, info, lane, &here);
        } else if raised(e.anew) {
            set_anchor(s, info, lane, here, e.after.get(lane));
        }
    }
    let mut finished = info.found.is_some() && course.leave_early;
    if raised(e.rest) && !finished {
        feed.rests(info.index);
        let phase = where_is(course, s, info, lane).2;
        let at = (s.t.get(lane) - h, phase - info.cell.eta * h);
        let stays = come_to_rest(course, s, info, lane, at);
        finished = stays || (info.found.is_some() && course.leave_early);
    }
    if raised(e.never) && !finished {
        info.found = Some(SettledMotion::Impactless);
        finished = true;
    }
    if !finished && s.t.get(lane) >= s.t_next.get(lane) {
        finished = info.watching;
        if !info.watching {
            start_watch(course, s, info, lane);
        }
    }
    if finished {
        let motion = info.found.unwrap_or_else(|| unrecognised(s, info, lane));
        let (x, v, phase) = where_is(course, s, info, lane);
        feed.done(
            info.index,
            Outcome {
                motion,
                end: Cell {
                    x,
                    v,
                    phase,
                    ..info.cell
                },
            },
        );
    }
    finished
}

/// The impact at a time, from z's imaginary part after it.
fn strike(course: &Course, info: &Lane, t: f64, zi: f64) -> Strike {
    let beta = course.damping_ratio;
    let (fr, fi) = info.forced_at(info.cell.phase + info.cell.eta * t);
    let omega = (1.0 - beta * beta).sqrt();
    Strike {
        t,
        v_after: -beta * (info.cell.rho - fr) - omega * zi - info.cell.eta * fi,
    }
}

/// Least difference of phases, rad, that the times of impacts resolve.
const TIMING: f64 = 1e-9;

/// Whether an impact that looks like the anchor's is: whole drive periods lie between them.
fn is_same<V: Lanes>(s: &Group<V>, info: &Lane, lane: usize, here: &Anchor) -> bool {
    let periods = (here.t - info.anchor.t) / info.period;
    let turned = std::f64::consts::TAU * (periods - periods.round()).abs();
    turned <= s.tolerance.get(lane).max(TIMING)
}

/// Have later impacts compared with this one, until twice as many as since the last anchor.
fn set_anchor<V: Lanes>(s: &mut Group<V>, info: &mut Lane, lane: usize, here: Anchor, zi: f64) {
    s.anchor.set(lane, zi);
    let count = here.hits - info.anchor.hits;
    s.reach.set(lane, here.hits + 2.0 * count);
    info.anchor = here;
}

/// An orbit has come back to its anchor. With complex multipliers a motion that still converges
/// comes back first after several turns, so a return of p > 1 impacts is followed once more
/// with a wider tolerance, and the first return then counts.
fn recognise<V: Lanes>(s: &mut Group<V>, info: &mut Lane, lane: usize, here: &Anchor) {
    let anchor = info.anchor;
    if info.found.is_some() || info.released.is_some_and(|(t, _)| t >= anchor.t) {
        return; // an orbit that rests at the stop is identified by its releases
    }
    let p = here.hits - anchor.hits;
    let n = ((here.t - anchor.t) / info.period).round();
    if n < 1.0 {
        return;
    }
    if p == 1.0 || info.confirming {
        info.found = Some(SettledMotion::periodic(count(p), count(n)));
        s.tolerance.set(lane, -1.0);
        s.reach.set(lane, f64::INFINITY);
        return;
    }
    info.confirming = true;
    (info.anchor.hits, info.anchor.t) = (here.hits, here.t);
    s.reach.set(lane, f64::INFINITY);
    let wider = s.tolerance.get(lane) * if info.watching { 100.0 } else { 1000.0 };
    s.tolerance.set(lane, wider);
}

fn start_watch<V: Lanes>(course: &Course, s: &mut Group<V>, info: &mut Lane, lane: usize) {
    (info.watching, info.confirming) = (true, false);
    info.hits_at_watch = s.hits.get(lane);
    let t = s.t.get(lane);
    s.t_next.set(
        lane,
        (course.settle_periods + course.watch_periods) * info.period,
    );
    forget(s, info, lane, t);
    let known = info.found.is_some();
    s.tolerance
        .set(lane, if known { -1.0 } else { course.loose });
    if known {
        s.reach.set(lane, f64::INFINITY);
    }
}

/// Motion of a cell whose orbit did not recur; chaos is a guess that `watched` follows up. Without an
/// impact in the watch it is impactless where that motion stays clear of the stop, else between
/// two impacts that are farther apart than the watch is long.
fn unrecognised<V: Lanes>(s: &Group<V>, info: &Lane, lane: usize) -> SettledMotion {
    let clear = s.forced.get(lane) * (1.0 - 1e-9) <= info.cell.rho;
    if clear && s.hits.get(lane) == info.hits_at_watch {
        SettledMotion::Impactless
    } else {
        SettledMotion::Chaotic
    }
}
