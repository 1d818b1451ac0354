//! Periodic orbits z = p/n: Newton on the impact times and approach speeds.
//!
//! Between impacts everything is linear, so the motion of X + Y with p impacts in n drive
//! periods is u(t) = Re(F e^{iηt}) − Σ φₖ Γ(t − tₖ), φₖ = (1+R)wₖ, Γ = Σ μᵢGᵢ the mobility-weighted
//! periodic Green's functions, eq. (7). The orbit is where u(tₖ) = G and u'(tₖ−) = wₖ for every k. Time t
//! is counted so that the drive's phase is ηt.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, Matrix4};

use super::contact::{Impact, impact_pair, is_plastic};
use super::crossing::first_zero;
use super::flight::{Drive, State, exponent, forced_amplitude, free_flight};
use super::orbit::Existence;
use super::params::{Machine, Setting};
use super::path::C64;
use super::variation::{eigenvalues, free_flow, saltation};

/// A periodic orbit with p impacts in n drive periods: the solution of eq. (8).
///
/// ```
/// use impact_oscillator::{Existence, Initial, Machine, PeriodicOrbit, Setting, SettledMotion};
/// use impact_oscillator::{Watch, settle};
///
/// let machine = Machine::symmetric(0.07, 0.9);
/// let setting = Setting::new(1.3, 1.0);
/// let (motion, impacts) = settle(&machine, setting, Initial::rest(), &Watch::default())?;
/// let SettledMotion::Periodic { p: 1, n, .. } = motion else { panic!("{motion}") };
/// let guess = PeriodicOrbit::from_impacts(&impacts[impacts.len() - 1..], setting, n);
/// let orbit = guess.and_then(|o| o.solve(&machine)).expect("an orbit");
/// assert_eq!(orbit.existence(&machine), Existence::Exists);
/// assert!(orbit.is_stable(&machine) && orbit.residual(&machine).amax() < 1e-12);
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PeriodicOrbit {
    /// Drive periods in one period of the motion.
    pub n: u32,
    /// η
    pub eta: f64,
    /// ρ
    pub rho: f64,
    /// Impact times in [0, 2πn/η), rising, the drive's phase being ηt.
    pub times: Vec<f64>,
    /// Approach speeds before the impacts.
    pub speeds: Vec<f64>,
}

/// One mass's part in the response: its mobility, exponent and 1/(ω(1 − e^{λT})).
#[derive(Debug, Clone, Copy)]
struct Part {
    mobility: f64,
    lambda: C64,
    weight: C64,
    forced: C64,
}

impl Part {
    /// Green's function and its first two derivatives at t in [0, T], per unit jump.
    fn green(&self, t: f64) -> [f64; 3] {
        let z = C64::from_polar((self.lambda.re * t).exp(), self.lambda.im * t) * self.weight;
        let z1 = z * self.lambda;
        [z.im, z1.im, (z1 * self.lambda).im]
    }
}

/// The linear response of a machine with impacts every T = 2πn/η.
#[derive(Debug, Clone)]
pub struct LinearResponse {
    eta: f64,
    period: f64,
    forced: C64,
    parts: Vec<Part>,
}

impl LinearResponse {
    /// Of a machine at η with n drive periods.
    pub fn new(machine: &Machine, eta: f64, n: u32) -> Self {
        let period = f64::from(n) * TAU / eta;
        let (mx, my) = machine.mobility();
        let masses = std::iter::once((&machine.x, mx)).chain(machine.y.as_ref().map(|y| (y, my)));
        let parts: Vec<Part> = masses
            .map(|(o, mobility)| {
                let lambda = exponent(o);
                let growth = C64::from_polar((lambda.re * period).exp(), lambda.im * period);
                let weight = (C64::new(1.0, 0.0) - growth).inv() / lambda.im;
                let forced = forced_amplitude(o, Drive { eta, phase: 0.0 });
                Part {
                    mobility,
                    lambda,
                    weight,
                    forced,
                }
            })
            .collect();
        let forced = parts.iter().map(|p| p.forced).sum();
        Self {
            eta,
            period,
            forced,
            parts,
        }
    }

    /// Γ, Γ', Γ'' at t in [0, T].
    fn green(&self, t: f64) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for part in &self.parts {
            for (s, g) in sum.iter_mut().zip(part.green(t)) {
                *s += part.mobility * g;
            }
        }
        sum
    }

    /// Forced response Re(F e^{iηt}) and its first two derivatives.
    fn drive(&self, t: f64) -> [f64; 3] {
        let f = self.forced * C64::from_polar(1.0, self.eta * t);
        [f.re, -self.eta * f.im, -self.eta * self.eta * f.re]
    }
}

/// Linearise the orbit's equations about (times, speeds): residuals (gap closure, speed) of all impacts and
/// their Jacobian by times and speeds, times (closures) first.
fn linearise(
    machine: &Machine,
    response: &LinearResponse,
    orbit: &PeriodicOrbit,
) -> (DVector<f64>, DMatrix<f64>) {
    let p = orbit.times.len();
    let gap = machine.gap(orbit.rho);
    let law = machine.restitution();
    let mut residual = DVector::zeros(2 * p);
    let mut jacobian = DMatrix::zeros(2 * p, 2 * p);
    for k in 0..p {
        let [u, du, ddu] = response.drive(orbit.times[k]);
        residual[k] = u - gap;
        residual[p + k] = du - orbit.speeds[k];
        jacobian[(k, k)] += du;
        jacobian[(p + k, k)] += ddu;
        jacobian[(p + k, p + k)] -= 1.0;
        for j in 0..p {
            let w = orbit.speeds[j];
            let r = law.at(w);
            let (phi, slope) = ((1.0 + r) * w, 1.0 + r + w * law.slope_at(w));
            let lag = (orbit.times[k] - orbit.times[j]).rem_euclid(response.period);
            // just before the impact itself: Γ'(T), not Γ'(0)
            let [g, dg, ddg] = response.green(if j == k { response.period } else { lag });
            residual[k] -= phi * g;
            residual[p + k] -= phi * dg;
            jacobian[(k, p + j)] -= slope * g;
            jacobian[(p + k, p + j)] -= slope * dg;
            if j != k {
                jacobian[(k, k)] -= phi * dg;
                jacobian[(k, j)] += phi * dg;
                jacobian[(p + k, k)] -= phi * ddg;
                jacobian[(p + k, j)] += phi * ddg;
            }
        }
    }
    (residual, jacobian)
}

impl PeriodicOrbit {
    /// From the impacts of one period of a simulated motion (p impacts, the last ones).
    pub fn from_impacts(impacts: &[Impact], setting: Setting, n: u32) -> Option<Self> {
        let first = impacts.first()?;
        let period = f64::from(n) * setting.period();
        let start = first.phase / setting.frequency_ratio - first.tau;
        let mut pairs: Vec<(f64, f64)> = impacts
            .iter()
            .map(|i| ((i.tau + start).rem_euclid(period), i.approach_speed))
            .collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (times, speeds) = pairs.into_iter().unzip();
        Some(Self {
            n,
            eta: setting.frequency_ratio,
            rho: setting.clearance,
            times,
            speeds,
        })
    }

    /// Impacts in one period.
    pub fn p(&self) -> u32 {
        u32::try_from(self.times.len()).unwrap_or(u32::MAX)
    }

    /// Greatest approach speed.
    pub fn greatest_speed(&self) -> f64 {
        self.speeds.iter().fold(0.0, |m: f64, w| m.max(*w))
    }

    /// Period 2πn/η.
    pub fn period(&self) -> f64 {
        f64::from(self.n) * TAU / self.eta
    }

    /// Unknowns of Newton's method: times, then speeds.
    pub fn unknowns(&self) -> DVector<f64> {
        DVector::from_iterator(
            2 * self.times.len(),
            self.times.iter().chain(&self.speeds).copied(),
        )
    }

    /// The orbit with other unknowns.
    #[must_use]
    pub fn with_unknowns(&self, z: &DVector<f64>) -> Self {
        let p = self.times.len();
        Self {
            times: z.iter().take(p).copied().collect(),
            speeds: z.iter().skip(p).take(p).copied().collect(),
            ..*self
        }
    }

    /// Residual of the orbit's equations, times' closures first.
    pub fn residual(&self, machine: &Machine) -> DVector<f64> {
        self.linearised(machine).0
    }

    /// Residual and Jacobian by the unknowns.
    pub fn linearised(&self, machine: &Machine) -> (DVector<f64>, DMatrix<f64>) {
        linearise(
            machine,
            &LinearResponse::new(machine, self.eta, self.n),
            self,
        )
    }

    /// Newton's method at fixed η and ρ. `None`: it does not converge, or impacts change their
    /// order on the way.
    pub fn solve(mut self, machine: &Machine) -> Option<Self> {
        let response = LinearResponse::new(machine, self.eta, self.n);
        for _ in 0..30 {
            let (residual, jacobian) = linearise(machine, &response, &self);
            let size = 1.0 + self.speeds.iter().fold(0.0, |m: f64, w| m.max(w.abs()));
            let done = residual.amax() <= 1e-13 * size;
            let change = jacobian.lu().solve(&residual)?;
            let z = self.unknowns() - &change;
            self = self.with_unknowns(&z);
            if done || change.amax() <= 1e-15 * size {
                return self.is_ordered().then_some(self);
            }
            if change.amax().is_nan() || change.amax() > 0.5 * self.period() {
                return None;
            }
        }
        None
    }

    /// Whether the impacts still come in their order.
    pub fn is_ordered(&self) -> bool {
        let rising = self.times.windows(2).all(|w| w[0] < w[1]);
        let (first, last) = (self.times.first(), self.times.last());
        rising && matches!((first, last), (Some(a), Some(b)) if b - a < self.period())
    }

    /// State just before and just after each impact.
    pub fn impact_states(&self, machine: &Machine) -> Vec<(State, State)> {
        let response = LinearResponse::new(machine, self.eta, self.n);
        (0..self.times.len())
            .map(|k| self.states_at(machine, &response, k))
            .collect()
    }

    fn states_at(&self, machine: &Machine, response: &LinearResponse, k: usize) -> (State, State) {
        let law = machine.restitution();
        let t = self.times[k];
        let of = |part: &Part| {
            let f = part.forced * C64::from_polar(1.0, self.eta * t);
            let (mut x, mut v) = (f.re, -self.eta * f.im);
            for (j, (tj, w)) in self.times.iter().zip(&self.speeds).enumerate() {
                let lag = if j == k {
                    response.period
                } else {
                    (t - tj).rem_euclid(response.period)
                };
                let jump = -part.mobility * (1.0 + law.at(*w)) * w;
                let [g, dg, _] = part.green(lag);
                x += jump * g;
                v += jump * dg;
            }
            (x, v)
        };
        let x = of(&response.parts[0]);
        let y = response.parts.get(1).map_or((0.0, 0.0), of);
        let drive = Drive {
            eta: self.eta,
            phase: self.eta * t,
        };
        impact_pair(machine, drive, [x, y])
    }

    /// Map of a variation over one period, starting just before the first impact: the product
    /// of saltation matrices and free flows.
    pub fn monodromy(&self, machine: &Machine) -> Matrix4<f64> {
        let mut map = Matrix4::identity();
        for (k, (before, after)) in self.impact_states(machine).iter().enumerate() {
            map = free_flow(machine, self.flight_time(k)) * saltation(machine, before, after) * map;
        }
        map
    }

    /// Time from impact k to the next.
    pub fn flight_time(&self, k: usize) -> f64 {
        match self.times.get(k + 1) {
            Some(next) => next - self.times[k],
            None => self.times[0] + self.period() - self.times[k],
        }
    }

    /// Multipliers, largest modulus first.
    pub fn multipliers(&self, machine: &Machine) -> Vec<C64> {
        eigenvalues(machine, &self.monodromy(machine))
    }

    /// Whether every multiplier is inside the unit circle.
    pub fn is_stable(&self, machine: &Machine) -> bool {
        self.multipliers(machine)
            .first()
            .is_some_and(|m| m.norm() < 1.0)
    }

    /// Whether it is a motion of the machine.
    pub fn existence(&self, machine: &Machine) -> Existence {
        if self.speeds.iter().any(|w| *w <= 0.0) {
            return Existence::NotClosing;
        }
        let states = self.impact_states(machine);
        for (k, (before, after)) in states.iter().enumerate() {
            if is_plastic(machine, before.vx + before.vy) && after.ax + after.ay > 0.0 {
                return Existence::DeadZone;
            }
            let drive = Drive {
                eta: self.eta,
                phase: self.eta * self.times[k],
            };
            let gap = free_flight(machine, drive, after).gap(machine.gap(self.rho));
            if first_zero(&gap, self.flight_time(k) * (1.0 - 1e-9)).is_some() {
                return Existence::FurtherImpact;
            }
        }
        Existence::Exists
    }

    /// Smallest p/n that it is: an orbit that repeats itself within its period is divided.
    #[must_use]
    pub fn reduced(&self) -> Self {
        self.reduced_within(1e-7)
    }

    /// The same, where times and speeds may differ by a tolerance between the repetitions.
    #[must_use]
    pub fn reduced_within(&self, tolerance: f64) -> Self {
        let (p, count) = (self.p(), self.times.len());
        let divides = |d: &u32| p.is_multiple_of(*d) && self.n.is_multiple_of(*d);
        for d in (2..=p).rev().filter(divides) {
            let (q, shift) = ((p / d) as usize, self.period() / f64::from(d));
            let repeats = (0..count - q).all(|k| {
                (self.times[k + q] - self.times[k] - shift).abs() < tolerance
                    && (self.speeds[k + q] - self.speeds[k]).abs() < tolerance
            });
            if repeats {
                return Self {
                    n: self.n / d,
                    times: self.times[..q].to_vec(),
                    speeds: self.speeds[..q].to_vec(),
                    ..*self
                };
            }
        }
        self.clone()
    }

    /// The orbit run through twice, which a period doubling branches from.
    #[must_use]
    pub fn doubled(&self) -> Self {
        let period = self.period();
        let times = self
            .times
            .iter()
            .copied()
            .chain(self.times.iter().map(|t| t + period));
        Self {
            n: 2 * self.n,
            times: times.collect(),
            speeds: self.speeds.iter().chain(&self.speeds).copied().collect(),
            ..*self
        }
    }
}
