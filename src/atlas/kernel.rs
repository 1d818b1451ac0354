//! The marching kernel: one cell of a map per lane, each lane at its own time, a lane refilled
//! as soon as its cell is done. Same safe step as `model::crossing`, written for vectors.
//!
//! One mass of unit frequency, mass and drive against a stop at ρ (the symmetric double
//! oscillator's x = U/2), constant R. Impacts are applied by masks; the loop branches only for
//! a cell that is done, a mass that comes to rest at the stop and an orbit that recurs.

use super::lanes::Lanes;
use crate::model::SettledMotion;

/// One cell: where and from what start the motion is marched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// η
    pub eta: f64,
    /// ρ
    pub rho: f64,
    /// x at the start; at most ρ.
    pub x: f64,
    /// x' at the start.
    pub v: f64,
    /// Phase of the drive at the start, rad.
    pub phase: f64,
}

/// What became of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// The motion it settled on.
    pub motion: SettledMotion,
    /// The state at its end, by which a neighbour can be started.
    pub end: Cell,
}

/// What all cells of a march share.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// β, 0 ≤ β < 1.
    pub damping_ratio: f64,
    /// R, 0 ≤ R ≤ 1.
    pub restitution: f64,
    /// Drive periods before the watch.
    pub settle_periods: f64,
    /// Drive periods watched.
    pub watch_periods: f64,
    /// Leave a cell when no impact can come again, or when its orbit recurs.
    pub leave_early: bool,
    /// Closure by which an orbit recurs while settling.
    pub tight: f64,
    /// Closure by which an orbit recurs in the watch.
    pub loose: f64,
}

/// Source of cells and receiver of outcomes.
pub trait Feed {
    /// The next cell with its number, until there is none.
    fn next(&mut self) -> Option<(usize, Cell)>;
    /// A cell is done.
    fn done(&mut self, index: usize, outcome: Outcome);
}

const SIN: [f64; 6] = [
    -0.16666666666666663,
    0.008333333333330467,
    -0.00019841269836043575,
    2.7557315738586845e-06,
    -2.5051057394492127e-08,
    1.5912864224903485e-10,
];
const COS: [f64; 6] = [
    -0.4999999999999996,
    0.04166666666662371,
    -0.0013888888881056654,
    2.4801582078024058e-05,
    -2.755574396426964e-07,
    2.0657616391477202e-09,
];
/// Longest step in units of the faster of both rates: a quarter of it is where the polynomials
/// end.
const LONGEST: f64 = 3.2;
/// Longest first step after an impact, likewise: a shorter one has a tighter bound.
const FIRST: f64 = 1.6;
/// Displacement resolution below which a bounce is not told from rest (as in `model::contact`).
const RESOLUTION: f64 = 1e-13;

/// Constants in every lane.
struct Constants<V> {
    beta: V,
    minus_beta: V,
    minus_two_beta: V,
    omega: V,
    minus_inverse_omega: V,
    minus_restitution: V,
    quarter_omega: V,
    quarter_beta: V,
}

/// The state of `V::WIDTH` cells.
#[derive(Clone, Copy)]
struct Group<V> {
    eta: V,
    eta2: V,
    eta3: V,
    quarter_eta: V,
    rho: V,
    /// ρ where the impactless exit is open, else −∞.
    exit_rho: V,
    forced: V,
    /// η⁴|F|
    k4: V,
    longest: V,
    least: V,
    first: V,
    near: V,
    rest: V,
    zr: V,
    zi: V,
    zm: V,
    fr: V,
    fi: V,
    t: V,
    t_next: V,
    hm: V,
    hits: V,
    /// z's imaginary part after the anchor's impact.
    anchor: V,
    /// Impacts at which the anchor is set anew.
    reach: V,
    tolerance: V,
}

/// What the loop asks the slow path for, and the step just made.
struct Events<V: Lanes> {
    due: V::Mask,
    rest: V::Mask,
    /// An impact that looks like the anchor's.
    recurs: V::Mask,
    /// An impact that is to be the anchor.
    anew: V::Mask,
    never: V::Mask,
    step: V,
    /// z's imaginary part after an impact.
    after: V,
}

impl<V: Lanes> Events<V> {
    /// Lanes with any event, a bit each.
    #[inline(always)]
    fn any(&self) -> u32 {
        let impact = V::or(self.rest, V::or(self.recurs, self.anew));
        V::bits(V::or(impact, V::or(self.due, self.never)))
    }
}

/// sin and cos of an angle up to [`LONGEST`], from a quarter of it.
#[inline(always)]
fn sin_cos<V: Lanes>(quarter: V) -> (V, V) {
    let u = quarter.mul(quarter);
    let (mut p, mut q) = (V::splat(SIN[5]), V::splat(COS[5]));
    for k in (0..5).rev() {
        p = p.mul_add(u, V::splat(SIN[k]));
        q = q.mul_add(u, V::splat(COS[k]));
    }
    let s = quarter.mul(u).mul_add(p, quarter);
    let c = u.mul_add(q, V::splat(1.0));
    double(double((s, c)))
}

/// sin and cos of twice the angle.
#[inline(always)]
fn double<V: Lanes>((s, c): (V, V)) -> (V, V) {
    let s2 = s.add(s);
    (s2.mul(c), s2.neg_mul_add(s, V::splat(1.0)))
}

/// e^(−4y), from the series of e^(−y).
#[inline(always)]
fn decay<V: Lanes, const DEGREE: usize>(y: V) -> V {
    let mut p = V::splat(SERIES[DEGREE]);
    for k in (0..DEGREE).rev() {
        p = p.mul_add(y, V::splat(SERIES[k]));
    }
    let p2 = p.mul(p);
    p2.mul(p2)
}

/// (−1)^k/k!
const SERIES: [f64; 18] = {
    let mut c = [1.0; 18];
    let mut k = 1;
    while k < 18 {
        c[k] = -c[k - 1] / k as f64;
        k += 1;
    }
    c
};

/// Upper bound of |z|, at most 12 % too great: greater part + half the smaller.
#[inline(always)]
fn modulus_above<V: Lanes>(re: V, im: V) -> V {
    let (re, im) = (re.abs(), im.abs());
    re.min(im).mul_add(V::splat(0.5), re.max(im))
}

/// One step of all lanes of a group.
#[inline(always)]
fn step<V: Lanes, const DEGREE: usize>(c: &Constants<V>, s: &mut Group<V>) -> Events<V> {
    let zero = V::splat(0.0);
    // where the mass is
    let vh = c.omega.neg_mul_add(s.zi, c.minus_beta.mul(s.zr));
    let v = s.eta.neg_mul_add(s.fi, vh);
    let g = s.rho.sub(s.zr.add(s.fr));
    let a = s.eta2.neg_mul_add(s.fr, c.minus_two_beta.mul_sub(vh, s.zr));
    let near = g.le(V::splat(1e-13)
        .mul(v)
        .max(V::splat(4e-15).mul_add(s.zm, s.near)));
    let hit = V::and(near, zero.lt(v));
    // the impact, applied where it hits
    let dt = g.mul(v.reciprocal_rough());
    let turn = s.eta.mul(dt);
    let fr_hit = turn.neg_mul_add(s.fi, s.fr);
    let fi_hit = turn.mul_add(s.fr, s.fi);
    let v_hit = a.mul_add(dt, v);
    let after = c.minus_restitution.mul(v_hit);
    let zr_hit = s.rho.sub(fr_hit);
    let vh_hit = s.eta.mul_add(fi_hit, after);
    let zi_hit = c.beta.mul_add(zr_hit, vh_hit).mul(c.minus_inverse_omega);
    let zm_hit = modulus_above(zr_hit, zi_hit);
    let (recurs, anew) = recurrence(s, hit, zi_hit, zm_hit);
    let fr = fr_hit.or_else(hit, s.fr);
    let fi = fi_hit.or_else(hit, s.fi);
    let zr = zr_hit.or_else(hit, s.zr);
    let zi = zi_hit.or_else(hit, s.zi);
    let zm = zm_hit.or_else(hit, s.zm);
    let vh = vh_hit.or_else(hit, vh);
    let v = after.or_else(hit, v);
    let g = zero.or_else(hit, g.max(zero));
    let t = s.t.add(dt).or_else(hit, s.t);
    let hm = s.first.or_else(hit, s.hm);
    let ah = c.minus_two_beta.mul_sub(vh, zr);
    let a = s.eta2.neg_mul_add(fr, ah);
    let v2 = v.mul(v);
    let rest = V::and(hit, v2.le(s.rest.mul(a.abs())));
    // the safe step
    let j = s.eta3.mul_add(fi, c.minus_two_beta.mul_sub(ah, vh));
    let k = zm.add(s.k4);
    let bulge = k
        .mul(hm)
        .mul_add(V::splat(1.0 / 12.0), j.mul(V::splat(1.0 / 3.0)));
    let m = hm.mul_add(bulge.max(zero), a);
    let two_g = g.add(g);
    let d = m.mul_add(two_g, v2);
    let root = d.max(zero).sqrt();
    let closing = zero.lt(v);
    let no_root = V::or(d.lt(zero), V::and_not(m.le(zero), closing));
    let up = two_g.or_else(closing, root.sub(v));
    let down = v.add(root).or_else(closing, m);
    let h = hm.or_else(no_root, up.div(down).min(hm));
    // the exact motion over it
    let e = decay::<V, DEGREE>(c.quarter_beta.mul(h));
    let (sw, cw) = sin_cos(c.quarter_omega.mul(h));
    let (se, ce) = sin_cos(s.quarter_eta.mul(h));
    let (er, ei) = (e.mul(cw), e.mul(sw));
    s.zr = er.mul_sub(zr, ei.mul(zi));
    s.zi = er.mul_add(zi, ei.mul(zr));
    s.zm = zm.mul(e);
    s.fr = ce.mul_sub(fr, se.mul(fi));
    s.fi = ce.mul_add(fi, se.mul(fr));
    s.t = t.add(h);
    s.hm = h.mul(V::splat(1.5)).min(s.longest).max(s.least);
    let (due, never) = (s.t_next.le(s.t), s.zm.add(s.forced).lt(s.exit_rho));
    Events {
        due,
        rest,
        recurs,
        anew,
        never,
        step: h,
        after: zi,
    }
}

/// Brent's search for a returning impact: each is compared with an anchor that is set anew after
/// 1, 2, 4 … impacts. Here by one number alone, the rest of the comparison and the setting are
/// the slow path's. Gives which impacts look like the anchor's, and which are to be the anchor.
#[inline(always)]
fn recurrence<V: Lanes>(s: &mut Group<V>, hit: V::Mask, zi: V, zm: V) -> (V::Mask, V::Mask) {
    s.hits = s.hits.add(V::splat(1.0)).or_else(hit, s.hits);
    let near = s.tolerance.mul(zm.add(s.forced));
    let same = zi.sub(s.anchor).abs().le(near);
    (V::and(hit, same), V::and(hit, s.reach.le(s.hits)))
}

/// The impact with which later ones are compared.
#[derive(Debug, Clone, Copy)]
struct Anchor {
    /// Time.
    t: f64,
    /// Number of impacts so far.
    hits: f64,
}

/// What the slow path knows of a lane beside the vectors.
#[derive(Clone, Copy)]
struct Lane {
    index: usize,
    cell: Cell,
    period: f64,
    /// Complex forced amplitude at phase 0.
    forced: (f64, f64),
    watching: bool,
    found: Option<SettledMotion>,
    /// Whether a return is being followed once more.
    confirming: bool,
    /// Time and impacts at the last release from the stop.
    released: Option<(f64, f64)>,
    hits_at_watch: f64,
    anchor: Anchor,
}

const IDLE: Lane = Lane {
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

/// Lanes of the widest kernel.
const MAX_WIDTH: usize = 32;

/// March all cells of a feed.
#[inline(always)]
pub fn march<V: Lanes, const DEGREE: usize>(course: &Course, feed: &mut impl Feed) {
    let omega = (1.0 - course.damping_ratio * course.damping_ratio).sqrt();
    let c = Constants {
        beta: V::splat(course.damping_ratio),
        minus_beta: V::splat(-course.damping_ratio),
        minus_two_beta: V::splat(-2.0 * course.damping_ratio),
        omega: V::splat(omega),
        minus_inverse_omega: V::splat(-1.0 / omega),
        minus_restitution: V::splat(-course.restitution),
        quarter_omega: V::splat(0.25 * omega),
        quarter_beta: V::splat(0.25 * course.damping_ratio),
    };
    let mut group = empty_group::<V>();
    let mut lanes = [IDLE; MAX_WIDTH];
    let mut live = 0u32;
    for (lane, info) in lanes.iter_mut().enumerate().take(V::WIDTH) {
        live |= refill(course, feed, &mut group, info, lane);
    }
    while live != 0 {
        let e = step::<V, DEGREE>(&c, &mut group);
        let mut bits = e.any() & live;
        while bits != 0 {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            let info = &mut lanes[lane];
            if serve(course, feed, &mut group, info, (lane, &e)) {
                live &= !(1 << lane);
                live |= refill(course, feed, &mut group, info, lane);
            }
        }
    }
}

fn empty_group<V: Lanes>() -> Group<V> {
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

/// Load the next cell into a lane; gives the lane's bit, or 0 where no cell is left. A mass
/// that starts at rest at the stop and is never let go is done at once.
#[inline(never)]
fn refill<V: Lanes>(
    course: &Course,
    feed: &mut impl Feed,
    s: &mut Group<V>,
    info: &mut Lane,
    lane: usize,
) -> u32 {
    while let Some((index, cell)) = feed.next() {
        load(course, s, info, lane, (index, cell));
        let rests = cell.x >= cell.rho && cell.v.abs() <= 1e-12;
        if !rests || !come_to_rest(course, s, info, lane, (0.0, cell.phase)) {
            return 1 << lane;
        }
        let end = Cell {
            x: cell.rho,
            v: 0.0,
            ..cell
        };
        feed.done(
            index,
            Outcome {
                motion: SettledMotion::Joined,
                end,
            },
        );
    }
    park(s, lane);
    0
}

/// Load a cell into a lane.
fn load<V: Lanes>(
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
    place(
        course,
        s,
        info,
        lane,
        (0.0, cell.x.min(cell.rho), cell.v, cell.phase),
    );
}

/// A lane without a cell: far from the stop, never due.
fn park<V: Lanes>(s: &mut Group<V>, lane: usize) {
    let idle = empty_group::<V>();
    let pairs = [
        (&mut s.eta, idle.eta),
        (&mut s.quarter_eta, idle.quarter_eta),
        (&mut s.rho, idle.rho),
        (&mut s.exit_rho, idle.exit_rho),
        (&mut s.longest, idle.longest),
        (&mut s.zr, idle.zr),
        (&mut s.zi, idle.zi),
        (&mut s.zm, idle.zm),
        (&mut s.fr, idle.fr),
        (&mut s.fi, idle.fi),
        (&mut s.t_next, idle.t_next),
        (&mut s.hm, idle.hm),
    ];
    for (vector, value) in pairs {
        vector.set(lane, value.get(0));
    }
}

/// Start the search for a recurrence anew.
fn forget<V: Lanes>(s: &mut Group<V>, info: &mut Lane, lane: usize, t: f64) {
    let hits = s.hits.get(lane);
    info.anchor = Anchor { t, hits };
    s.anchor.set(lane, f64::INFINITY);
    s.reach.set(lane, hits + 1.0);
}

/// Put a lane at (t, x, v, phase), with libm's precision.
fn place<V: Lanes>(
    course: &Course,
    s: &mut Group<V>,
    info: &Lane,
    lane: usize,
    at: (f64, f64, f64, f64),
) {
    let (t, x, v, phase) = at;
    let (sin, cos) = phase.sin_cos();
    let (f0r, f0i) = info.forced;
    let (fr, fi) = (f0r * cos - f0i * sin, f0r * sin + f0i * cos);
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
fn where_is<V: Lanes>(course: &Course, s: &Group<V>, info: &Lane, lane: usize) -> (f64, f64, f64) {
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

/// The mass has no relative speed left at the stop, at (t, phase): it rests there until the
/// drive lets go (cos φ = ρ, falling), then leaves; or it leaves at once. Gives whether it
/// stays for ever.
fn come_to_rest<V: Lanes>(
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
            info.found = Some(SettledMotion::Joined);
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
        p: if chatter { 1 } else { hits as u16 },
        n: periods.round() as u16,
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

/// Serve a lane that raised an event. Gives whether its cell is done (and was handed over).
#[inline(never)]
fn serve<V: Lanes>(
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
        if raised(e.recurs) && is_same(s, info, lane, &here) {
            recognise(s, info, lane, &here);
        } else if raised(e.anew) {
            set_anchor(s, info, lane, here, e.after.get(lane));
        }
    }
    let mut finished = info.found.is_some() && course.leave_early;
    if raised(e.rest) && !finished {
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

/// Least difference of phases, rad, that the times of impacts tell.
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
        return; // an orbit that rests at the stop is told by its releases
    }
    let p = here.hits - anchor.hits;
    let n = ((here.t - anchor.t) / info.period).round();
    if n < 1.0 {
        return;
    }
    if p == 1.0 || info.confirming {
        info.found = Some(SettledMotion::Periodic {
            p: p as u16,
            n: n as u16,
            dead_zone: false,
            chatter: false,
        });
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

/// Motion of a cell whose orbit did not recur; chaos is a guess that `map` follows up.
fn unrecognised<V: Lanes>(s: &Group<V>, info: &Lane, lane: usize) -> SettledMotion {
    if s.hits.get(lane) == info.hits_at_watch {
        SettledMotion::Impactless
    } else {
        SettledMotion::Chaotic
    }
}
