//! The simulator against an independent integration: Taylor series of order 24 in double-double
//! arithmetic (about 31 digits), impacts by bisection of the series.

use std::ops::{Add, Mul, Neg, Sub};

use super::params::Asymmetry;
use super::*;

/// Unevaluated sum of two doubles.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Dd(f64, f64);

fn two_sum(a: f64, b: f64) -> Dd {
    let s = a + b;
    let bb = s - a;
    Dd(s, (a - (s - bb)) + (b - bb))
}

impl Add for Dd {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let (s, t) = (two_sum(self.0, o.0), two_sum(self.1, o.1));
        let u = two_sum(s.0, s.1 + t.0);
        two_sum(u.0, u.1 + t.1)
    }
}
impl Neg for Dd {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }
}
impl Sub for Dd {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}
impl Mul for Dd {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let p = self.0 * o.0;
        let e = self.0.mul_add(o.0, -p) + (self.0 * o.1 + self.1 * o.0);
        two_sum(p, e)
    }
}

fn dd(a: f64) -> Dd {
    Dd(a, 0.0)
}

/// 1/k to double-double.
fn inverse(k: f64) -> Dd {
    let q = 1.0 / k;
    let rest = dd(1.0) - dd(q) * dd(k);
    dd(q) + dd(rest.0 / k)
}

/// X, X', Y, Y', cos and sin of the drive's phase.
type Z = [Dd; 6];
const ORDER: usize = 24;

/// m₁, δ, Ω², drive per mass of both masses and η.
struct System {
    eta: f64,
    mass: [[f64; 3]; 2],
}

impl System {
    fn new(machine: &Machine, eta: f64) -> Self {
        let of = |o: &Oscillator| {
            [
                2.0 * o.decay_rate(),
                o.stiffness_per_mass(),
                o.drive_per_mass(),
            ]
        };
        let y = machine.y.as_ref().unwrap();
        Self {
            eta,
            mass: [of(&machine.x), of(y)],
        }
    }

    /// Coefficients of the solution's series about a state.
    fn series(&self, z: &Z) -> Vec<Z> {
        let mut c = vec![*z];
        for k in 0..ORDER {
            let (a, f) = (c[k], inverse((k + 1) as f64));
            let mut next = [dd(0.0); 6];
            for (m, [damping, stiffness, drive]) in self.mass.iter().enumerate() {
                let (x, v) = (a[2 * m], a[2 * m + 1]);
                next[2 * m] = v * f;
                next[2 * m + 1] = (dd(*drive) * a[4] - dd(*damping) * v - dd(*stiffness) * x) * f;
            }
            next[4] = -(dd(self.eta) * a[5]) * f;
            next[5] = dd(self.eta) * a[4] * f;
            c.push(next);
        }
        c
    }
}

fn evaluate(c: &[Z], h: Dd) -> Z {
    let mut z = c[c.len() - 1];
    for a in c.iter().rev().skip(1) {
        for (s, b) in z.iter_mut().zip(a) {
            *s = *s * h + *b;
        }
    }
    z
}

/// Times and approach speeds of the first impacts, constant R.
fn reference(
    machine: &Machine,
    eta: f64,
    rho: f64,
    start: Initial,
    count: usize,
) -> Vec<(f64, f64)> {
    let system = System::new(machine, eta);
    let r = machine.restitution().constant().unwrap();
    let (mx, my) = machine.mobility();
    let (mut z, mut t) = (
        [
            dd(start.x),
            dd(start.vx),
            dd(start.y),
            dd(start.vy),
            dd(1.0),
            dd(0.0),
        ],
        dd(0.0),
    );
    let gap = |z: &Z| dd(2.0 * rho) - z[0] - z[2];
    let step = dd(1.0 / 128.0);
    let mut found = Vec::new();
    while found.len() < count {
        let c = system.series(&z);
        let next = evaluate(&c, step);
        if gap(&next).0 > 0.0 {
            (z, t) = (next, t + step);
            continue;
        }
        let (mut lo, mut hi) = (dd(0.0), step);
        for _ in 0..110 {
            let mid = (lo + hi) * dd(0.5);
            if gap(&evaluate(&c, mid)).0 > 0.0 {
                lo = mid;
            } else {
                hi = mid;
            }
        }
        (z, t) = (evaluate(&c, hi), t + hi);
        let w = z[1] + z[3];
        found.push((t.0, w.0));
        z[1] = z[1] - dd(mx) * dd(1.0 + r) * w;
        z[3] = z[3] - dd(my) * dd(1.0 + r) * w;
        // off the contact, where the gap is rounding
        let c = system.series(&z);
        (z, t) = (evaluate(&c, dd(1.0 / 1024.0)), t + dd(1.0 / 1024.0));
    }
    found
}

/// Derivative of the stroboscopic map over one drive period that holds one impact, by central
/// differences of 1e-9 in double-double arithmetic.
fn reference_map(machine: &Machine, eta: f64, rho: f64, start: Initial) -> nalgebra::Matrix4<f64> {
    let base = [start.x, start.vx, start.y, start.vy].map(dd);
    let h = 1e-9;
    let mut map = nalgebra::Matrix4::zeros();
    for k in 0..4 {
        let moved = |by: f64| {
            let mut z = base;
            z[k] = z[k] + dd(by);
            over_one_period(machine, eta, rho, z)
        };
        let (up, down) = (moved(h), moved(-h));
        for i in 0..4 {
            map[(i, k)] = (up[i] - down[i]).0 / (2.0 * h);
        }
    }
    map
}

fn over_one_period(machine: &Machine, eta: f64, rho: f64, start: [Dd; 4]) -> [Dd; 4] {
    let system = System::new(machine, eta);
    let r = machine.restitution().constant().unwrap();
    let (mx, my) = machine.mobility();
    let [a, b, c, d] = start;
    let mut z = [a, b, c, d, dd(1.0), dd(0.0)];
    let mut left = Dd(6.283_185_307_179_586, 2.449_293_598_294_706_4e-16) * inverse(eta);
    let gap = |z: &Z| dd(2.0 * rho) - z[0] - z[2];
    while left.0 > 0.0 {
        let step = if left.0 > 1.0 / 128.0 {
            dd(1.0 / 128.0)
        } else {
            left
        };
        let c = system.series(&z);
        let next = evaluate(&c, step);
        if gap(&next).0 > 0.0 || (z[1] + z[3]).0 < 0.0 {
            (z, left) = (next, left - step);
            continue;
        }
        let (mut lo, mut hi) = (dd(0.0), step);
        for _ in 0..110 {
            let mid = (lo + hi) * dd(0.5);
            if gap(&evaluate(&c, mid)).0 > 0.0 {
                lo = mid;
            } else {
                hi = mid;
            }
        }
        (z, left) = (evaluate(&c, hi), left - hi);
        let w = z[1] + z[3];
        z[1] = z[1] - dd(mx) * dd(1.0 + r) * w;
        z[3] = z[3] - dd(my) * dd(1.0 + r) * w;
    }
    [z[0], z[1], z[2], z[3]]
}

fn machines() -> [Machine; 2] {
    let asymmetry = Asymmetry {
        drive_amplitude: 0.95,
        stiffness: 0.97,
        mass: 1.1,
    };
    [
        Machine::symmetric(0.07, 0.75),
        Machine::asymmetric(0.07, 0.75, asymmetry),
    ]
}

#[test]
fn valid_first_twenty_impacts_to_twelve_digits() {
    for m in machines() {
        for (eta, rho) in [(1.25, 1.0), (0.75, 0.9), (2.3, 0.15)] {
            let start = Initial {
                x: -0.25,
                vx: 0.5,
                y: 0.125,
                vy: -0.25,
            };
            let want = reference(&m, eta, rho, start, 20);
            let setting = Setting::new(eta, rho);
            let t = simulate(&m, setting, start, want[19].0 + 0.1).unwrap();
            for (k, (tau, w)) in want.iter().enumerate() {
                let got = &t.impacts[k];
                assert!(
                    (got.tau - tau).abs() <= 1e-12 * tau,
                    "{eta} {rho} {k}: {} {tau}",
                    got.tau
                );
                assert!(
                    (got.approach_speed - w).abs() <= 1e-11 * w,
                    "{eta} {rho} {k}"
                );
            }
        }
    }
}

#[test]
fn valid_periodic_orbit_and_multipliers() {
    for m in machines() {
        let orbit = orbit::stable_orbit(&m, Setting::new(1.25, 1.0), 1)
            .unwrap()
            .unwrap();
        // from the orbit's own state, shifted to phase 0, the reference comes back to it
        let lead = (-orbit.phase_at_impact).rem_euclid(std::f64::consts::TAU) / 1.25;
        let s = orbit.at(lead);
        let start = Initial {
            x: s.x,
            vx: s.vx,
            y: s.y,
            vy: s.vy,
        };
        let times = reference(&m, 1.25, 1.0, start, 4);
        for (k, (tau, w)) in times.iter().enumerate() {
            let want = orbit.period() * (k + 1) as f64 - lead;
            assert!((tau - want).abs() < 1e-10, "{tau} {want}");
            assert!((w - orbit.approach_speed).abs() < 1e-10);
        }
        let want = variation::eigenvalues(&m, &reference_map(&m, 1.25, 1.0, start));
        for (a, b) in want.iter().zip(&orbit.multipliers) {
            assert!((a.norm() - b.norm()).abs() < 1e-8, "{a} {b}");
            assert!((a.re - b.re).abs() < 1e-8, "{a} {b}");
        }
    }
}
