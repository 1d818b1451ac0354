//! One step of all lanes of a group: impacts by masks, the safe step, the exact motion over it.

use crate::atlas::lanes::Lanes;

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

/// Constants in every lane.
pub(super) struct Constants<V> {
    pub(super) beta: V,
    pub(super) minus_beta: V,
    pub(super) minus_two_beta: V,
    pub(super) omega: V,
    pub(super) minus_inverse_omega: V,
    pub(super) minus_restitution: V,
    pub(super) quarter_omega: V,
    pub(super) quarter_beta: V,
}

/// The state of `V::WIDTH` cells.
#[derive(Clone, Copy)]
pub(super) struct Group<V> {
    pub(super) eta: V,
    pub(super) eta2: V,
    pub(super) eta3: V,
    pub(super) quarter_eta: V,
    pub(super) rho: V,
    /// ρ where the impactless exit is open, else −∞.
    pub(super) exit_rho: V,
    pub(super) forced: V,
    /// η⁴|F|
    pub(super) k4: V,
    pub(super) longest: V,
    pub(super) least: V,
    pub(super) first: V,
    pub(super) near: V,
    pub(super) rest: V,
    pub(super) zr: V,
    pub(super) zi: V,
    pub(super) zm: V,
    pub(super) fr: V,
    pub(super) fi: V,
    pub(super) t: V,
    pub(super) t_next: V,
    pub(super) hm: V,
    pub(super) hits: V,
    /// z's imaginary part after the anchor's impact.
    pub(super) anchor: V,
    /// Impacts at which the anchor is set again.
    pub(super) reach: V,
    pub(super) tolerance: V,
}

/// What the loop leaves to the slow path, and the step just made.
pub(super) struct Events<V: Lanes> {
    pub(super) due: V::Mask,
    pub(super) rest: V::Mask,
    /// An impact that looks like the anchor's.
    pub(super) recurs: V::Mask,
    /// An impact that is to be the anchor.
    pub(super) anew: V::Mask,
    pub(super) never: V::Mask,
    pub(super) step: V,
    /// z's imaginary part after an impact.
    pub(super) after: V,
}

impl<V: Lanes> Events<V> {
    /// Lanes with any event, a bit each.
    #[inline(always)]
    pub(super) fn any(&self) -> u32 {
        let impact = V::or(self.rest, V::or(self.recurs, self.anew));
        V::bits(V::or(impact, V::or(self.due, self.never)))
    }
}

/// sin and cos of an angle up to the longest step's, from a quarter of it.
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

/// Far below rounding: at a contact that is all but left the next step is still not nothing.
const LEAST_GAP: f64 = 1e-21;

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
pub(super) fn step<V: Lanes, const DEGREE: usize>(c: &Constants<V>, s: &mut Group<V>) -> Events<V> {
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
    let g = zero.or_else(hit, g.max(V::splat(LEAST_GAP)));
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
    let approaching = zero.lt(v);
    let no_root = V::or(d.lt(zero), V::and_not(m.le(zero), approaching));
    let up = two_g.or_else(approaching, root.sub(v));
    let down = v.add(root).or_else(approaching, m);
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

/// Brent's search for a returning impact: each is compared with an anchor that is set again after
/// 1, 2, 4 … impacts. Here by one number alone, the rest of the comparison and the setting are
/// the slow path's. Returns which impacts look like the anchor's, and which are to be the anchor.
#[inline(always)]
fn recurrence<V: Lanes>(s: &mut Group<V>, hit: V::Mask, zi: V, zm: V) -> (V::Mask, V::Mask) {
    s.hits = s.hits.add(V::splat(1.0)).or_else(hit, s.hits);
    let near = s.tolerance.mul(zm.add(s.forced));
    let same = zi.sub(s.anchor).abs().le(near);
    (V::and(hit, same), V::and(hit, s.reach.le(s.hits)))
}
