//! First-order response of a periodic motion to a small extra acceleration of its masses.
//!
//! Where a force that the model does not contain adds the acceleration p(t) to a mass, evaluated
//! along the known orbit of period T, its displacement changes by the T-periodic solution of
//!
//! P'' + 2δP' + Ω²P = p(t),   P = Im z/ω,   z' = λz + p,   λ = −δ + iω.
//!
//! P and P' pass the impact unchanged. What the impact itself changes follows from P and P' there:
//! they enter the conditions of the orbit beside the gap ([`Change`](super::sensitivity::Change)).
//! One complex recurrence with p taken as linear between nodes; the error is of second order in
//! the nodes' distance. Several forces are taken at once: their recurrences do not wait for each
//! other.

use nalgebra::ComplexField;

use super::flight::exponent;
use super::motion::count;
use super::params::Oscillator;
use super::path::C64;
use super::sensitivity::MassMotion;

/// Nodes of a period that begin and end at the impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Time between two nodes.
    pub step: f64,
    /// Number of intervals: nodes less one.
    pub intervals: usize,
}

impl Grid {
    /// Of a period T.
    pub fn new(period: f64, intervals: usize) -> Self {
        Self {
            step: period / intervals.max(1) as f64,
            intervals: intervals.max(1),
        }
    }

    /// The times of the nodes since the impact.
    pub fn times(&self) -> impl Iterator<Item = f64> + '_ {
        (0..=self.intervals).map(|k| k as f64 * self.step)
    }

    /// Displacement and velocity of a mass at the nodes; `phase` is the drive's at the impact.
    pub fn states(&self, motion: &MassMotion, phase: f64, eta: f64) -> Vec<[f64; 2]> {
        let turn = C64::from_polar(1.0, eta * self.step);
        let decay = (motion.exponent * self.step).exp();
        let rate = C64::new(0.0, eta);
        let mut forced = motion.force * C64::from_polar(1.0, phase);
        let mut free = motion.mode;
        (0..=self.intervals)
            .map(|_| {
                let state = [
                    forced.re + free.re,
                    (rate * forced).re + (motion.exponent * free).re,
                ];
                forced *= turn;
                free *= decay;
                state
            })
            .collect()
    }
}

/// The periodic solutions of z' = λz + p at the nodes, each p linear between them.
fn periodic<T: ComplexField<RealField = f64> + Copy, const N: usize>(
    lambda: T,
    grid: Grid,
    p: &[[f64; N]],
) -> Vec<[T; N]> {
    let h = grid.step;
    let decay = lambda.scale(h).exp();
    let whole = (decay - T::one()) / lambda;
    let later = (whole - T::from_real(h)) / lambda.scale(h);
    let earlier = whole - later;
    // From rest, and what a start elsewhere adds, so that the end is the start again.
    let mut out = Vec::with_capacity(p.len());
    let mut z = [T::zero(); N];
    out.push(z);
    for pair in p.windows(2) {
        for (z, (a, b)) in z.iter_mut().zip(pair[0].iter().zip(&pair[1])) {
            *z = decay * *z + (earlier.scale(*a) + later.scale(*b));
        }
        out.push(z);
    }
    let returned = lambda.scale(h * grid.intervals as f64).exp();
    let mut start = z.map(|z| z / (T::one() - returned));
    for z in &mut out {
        for (z, start) in z.iter_mut().zip(&mut start) {
            *z += *start;
            *start *= decay;
        }
    }
    out
}

/// Functions of time over one period: values and slopes at the nodes, cubic between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Sampled<const N: usize> {
    grid: Grid,
    values: Vec<[f64; N]>,
    slopes: Vec<[f64; N]>,
}

impl<const N: usize> Sampled<N> {
    /// Values at a time in 0 … T since the impact.
    pub fn at(&self, time: f64) -> [f64; N] {
        let place = (time / self.grid.step).clamp(0.0, self.grid.intervals as f64);
        let k = (count(place) as usize).min(self.grid.intervals - 1);
        let (s, h) = (place - k as f64, self.grid.step);
        let ([a, b], [da, db]) = (
            [&self.values[k], &self.values[k + 1]],
            [&self.slopes[k], &self.slopes[k + 1]],
        );
        let mut values = [0.0; N];
        let ends = a.iter().zip(b).zip(da.iter().zip(db));
        for (value, ((a, b), (da, db))) in values.iter_mut().zip(ends) {
            let (da, db) = (h * da, h * db);
            let (c, d) = (3.0 * (b - a) - 2.0 * da - db, 2.0 * (a - b) + da + db);
            *value = a + s * (da + s * (c + s * d));
        }
        values
    }

    /// Behind a first-order high-pass y' + cy = x' of a corner c.
    #[must_use]
    pub fn high_passed(&self, corner: f64) -> Self {
        // y = x − w with w' = −cw + cx.
        let mut fed = self.values.clone();
        fed.as_flattened_mut().iter_mut().for_each(|x| *x *= corner);
        let lost = periodic(-corner, self.grid, &fed);
        let values = less(&self.values, 1.0, &lost);
        Self {
            grid: self.grid,
            slopes: less(&self.slopes, corner, &values),
            values,
        }
    }
}

/// Values less a share of others.
fn less<const N: usize>(values: &[[f64; N]], share: f64, others: &[[f64; N]]) -> Vec<[f64; N]> {
    let mut out = values.to_vec();
    let pairs = out.as_flattened_mut().iter_mut().zip(others.as_flattened());
    pairs.for_each(|(value, other)| *value -= share * other);
    out
}

/// Periodic responses of one mass to N extra accelerations, each alone.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicResponses<const N: usize> {
    grid: Grid,
    positions: Vec<[f64; N]>,
    velocities: Vec<[f64; N]>,
    accelerations: Vec<[f64; N]>,
}

impl<const N: usize> PeriodicResponses<N> {
    /// Of a mass to accelerations at the nodes of a grid.
    pub fn new(oscillator: &Oscillator, grid: Grid, accelerations: &[[f64; N]]) -> Self {
        let lambda = exponent(oscillator);
        let z = periodic(lambda, grid, accelerations);
        let part = |factor: C64| {
            let mut values = vec![[0.0; N]; z.len()];
            let pairs = values.as_flattened_mut().iter_mut().zip(z.as_flattened());
            pairs.for_each(|(value, z)| *value = (factor * z).im / lambda.im);
            values
        };
        Self {
            grid,
            positions: part(C64::new(1.0, 0.0)),
            velocities: part(lambda),
            accelerations: less(&part(lambda * lambda), -1.0, accelerations),
        }
    }

    /// Displacements and velocities at the impact.
    pub fn at_impact(&self) -> [[f64; 2]; N] {
        let (positions, velocities) = (&self.positions[0], &self.velocities[0]);
        std::array::from_fn(|i| [positions[i], velocities[i]])
    }

    /// The displacements over one period.
    pub fn displacements(&self) -> Sampled<N> {
        Sampled {
            grid: self.grid,
            values: self.positions.clone(),
            slopes: self.velocities.clone(),
        }
    }

    /// The velocities over one period.
    pub fn velocities(&self) -> Sampled<N> {
        Sampled {
            grid: self.grid,
            values: self.velocities.clone(),
            slopes: self.accelerations.clone(),
        }
    }

    /// The accelerations over one period; their slopes at a node are those of the line through its
    /// neighbours.
    pub fn accelerations(&self) -> Sampled<N> {
        let last = self.accelerations.len().saturating_sub(1);
        let slope = |k: usize| {
            let (before, after) = (k.saturating_sub(1), (k + 1).min(last));
            let time = (after - before).max(1) as f64 * self.grid.step;
            let ends = [&self.accelerations[before], &self.accelerations[after]];
            std::array::from_fn(|i| (ends[1][i] - ends[0][i]) / time)
        };
        Sampled {
            grid: self.grid,
            values: self.accelerations.clone(),
            slopes: (0..=last).map(slope).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::orbit::Branch;
    use crate::model::params::Machine;
    use crate::model::sensitivity::{Change, Sensitivity};

    #[test]
    fn valid_the_response_to_a_harmonic_is_the_closed_form() {
        let mass = Oscillator::nominal(0.05);
        let (eta, k) = (1.3, 2.0);
        let grid = Grid::new(std::f64::consts::TAU / eta, 256);
        // beside the cosine, a second force of twice its size with the opposite sign
        let p = grid.times().map(|t| (k * eta * t).cos());
        let p: Vec<[f64; 2]> = p.map(|p| [p, -2.0 * p]).collect();
        let responses = PeriodicResponses::new(&mass, grid, &p);
        let w = k * eta;
        let least = (w * grid.step).powi(2) / 10.0;
        let f = C64::new(1.0 - w * w, 2.0 * 0.05 * w).inv();
        for t in [0.0, 0.37, 2.9, 4.8] {
            let turn = C64::from_polar(1.0, w * t);
            let (x, v) = (responses.displacements(), responses.velocities());
            let a = responses.accelerations();
            let c = 0.04;
            let kept = C64::new(0.0, w) / C64::new(c, w);
            for (i, size) in [1.0, -2.0].into_iter().enumerate() {
                let f = size * f;
                let near = |found: f64, want: C64, scale: f64| {
                    (found - want.re).abs() < least * scale * f.norm()
                };
                assert!(near(x.at(t)[i], f * turn, 1.0));
                assert!(near(v.at(t)[i], f * turn * C64::new(0.0, w), w));
                assert!(near(a.at(t)[i], -f * turn * w * w, w * w));
                assert!(near(x.high_passed(c).at(t)[i], f * turn * kept, 1.0));
            }
        }
    }

    /// Approach speed and drive phase at the impact, after many periods of a simulation in small steps
    /// from a time and a state on (classical Runge–Kutta, the impact by bisection of the step).
    fn simulated(
        [beta, r]: [f64; 2],
        [eta, gap]: [f64; 2],
        (start, mut s): (f64, [f64; 2]),
        extra: &dyn Fn(f64, [f64; 2]) -> f64,
    ) -> [f64; 2] {
        let f = |t: f64, s: [f64; 2]| {
            let a = (eta * t).cos() - 2.0 * beta * s[1] - s[0] + extra(eta * t, s);
            [s[1], a]
        };
        let step = |t: f64, s: [f64; 2], h: f64| {
            let add = |k: [f64; 2], h: f64| [s[0] + h * k[0], s[1] + h * k[1]];
            let a = f(t, s);
            let b = f(t + 0.5 * h, add(a, 0.5 * h));
            let c = f(t + 0.5 * h, add(b, 0.5 * h));
            let d = f(t + h, add(c, h));
            let sum = |i: usize| s[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
            [sum(0), sum(1)]
        };
        let h = std::f64::consts::TAU / eta / 400.0;
        let (mut t, mut last) = (start, [0.0; 2]);
        while t < start + 500.0 {
            let next = step(t, s, h);
            if next[0] <= gap {
                (t, s) = (t + h, next);
                continue;
            }
            let (mut low, mut high) = (0.0, h);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if step(t, s, middle)[0] > gap {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            s = step(t, s, low);
            t += low;
            last = [s[1], (eta * t).rem_euclid(std::f64::consts::TAU)];
            s[1] *= -r;
        }
        last
    }

    #[test]
    fn valid_first_order_changes_of_the_impact_are_those_of_a_simulation() {
        let (beta, r, eta, gap) = (0.06, 0.7, 1.2, 1.1);
        let machine = Machine::single(beta, r);
        let branch = Branch::new(&machine, eta, 1);
        let w = branch.approach_speeds(r, gap).unwrap()[1];
        let sensitivity = Sensitivity::new(&machine, branch, 1, gap, w);
        let orbit = sensitivity.motion();
        let grid = Grid::new(std::f64::consts::TAU / eta, 256);
        let states = grid.states(&orbit.x, orbit.phase, eta);
        type Extra = fn(f64, [f64; 2]) -> f64;
        let extras: [Extra; 3] = [
            |_, s| -s[0].powi(3),
            |_, s| -s[1].signum(),
            |theta, _| (2.0 * theta + 0.4).cos(),
        ];
        for extra in extras {
            let times = grid.times().zip(&states);
            let p: Vec<[f64; 1]> = times
                .map(|(t, s)| [extra(orbit.phase + eta * t, *s)])
                .collect();
            let responses = PeriodicResponses::new(&machine.x, grid, &p);
            let [[displacement, velocity]] = responses.at_impact();
            let change = Change {
                displacement,
                velocity,
                ..Change::default()
            };
            let slope = sensitivity.slope(&change);
            let small = 1e-4;
            let rest = (0.0, [0.0, 0.0]);
            let at =
                |e: f64| simulated([beta, r], [eta, gap], rest, &|theta, s| e * extra(theta, s));
            let (above, below) = (at(small), at(-small));
            let found = [0, 1].map(|i| (above[i] - below[i]) / (2.0 * small));
            assert!(
                (found[0] - slope.approach_speed).abs() < 0.01 * (0.1 + found[0].abs()),
                "{found:?} {slope:?}"
            );
            assert!(
                (found[1] - slope.phase).abs() < 0.01 * (0.1 + found[1].abs()),
                "{found:?} {slope:?}"
            );
        }
    }

    #[test]
    fn valid_extra_accelerations_next_to_the_saddle_node_are_those_of_a_simulation() {
        let (beta, r, eta) = (0.06, 0.7, 1.3);
        let machine = Machine::single(beta, r);
        let branch = Branch::new(&machine, eta, 1);
        let (alpha, q) = (branch.alpha(r), branch.q(r) / eta);
        let end = branch.forced.norm() * (1.0 + (alpha / q).powi(2)).sqrt();
        let gap = 0.996 * end;
        let w = branch.approach_speeds(r, gap).unwrap()[1];
        let sensitivity = Sensitivity::new(&machine, branch, 1, gap, w);
        let orbit = sensitivity.motion();
        let grid = Grid::new(std::f64::consts::TAU / eta, 256);
        let states = grid.states(&orbit.x, orbit.phase, eta);
        let p: Vec<[f64; 1]> = states.iter().map(|s| [-s[1] * s[1].abs()]).collect();
        let [[displacement, velocity]] = PeriodicResponses::new(&machine.x, grid, &p).at_impact();
        let change = Change {
            displacement,
            velocity,
            ..Change::default()
        };
        let first_order = sensitivity.slope(&change).approach_speed;
        // Drag and its opposite that do what 0.4 of the distance to the end does.
        let wider = Change {
            gap: 1.0,
            ..Change::default()
        };
        let strength = 0.4 * (end - gap) * sensitivity.slope(&wider).approach_speed / first_order;
        let by = |e: f64| {
            let drag = |_: f64, s: [f64; 2]| -e * s[1] * s[1].abs();
            let start = (orbit.phase / eta, [gap, -r * w]);
            let [settled, _] = simulated([beta, r], [eta, gap], start, &drag);
            let extra = [e * displacement, e * velocity];
            let exact = branch.with_extra(extra).approach_speeds(r, gap).unwrap()[1];
            [settled - w, exact - w, e * first_order]
        };
        for e in [strength, -strength] {
            let [found, exact, first_order] = by(e);
            assert!(
                (exact - found).abs() < 0.04 * found.abs(),
                "{found} {exact}"
            );
            assert!(
                (first_order - found).abs() > 0.06 * found.abs(),
                "{found} {first_order}"
            );
        }
    }
}
