//! Periodic orbits z = 1/n in closed form, for one mass, the symmetric and the asymmetric double
//! oscillator and unequal masses alike.
//!
//! With one impact in n drive periods, each mass is its forced response plus the velocity jump
//! −μᵢφ, φ = (1+R)w, times its periodic Green's function. At the impact the gap closes with the
//! approach speed w, so with F = F₁+F₂ the complex forced amplitudes, ψ the drive's phase there:
//!
//! Re(F e^{iψ}) = G − αw,  −Im(F e^{iψ}) = Qw/η,  hence (G − αw)² + (Qw/η)² = |F|²,
//!
//! a quadratic for w, eq. (9). With Pᵢ, Dᵢ the Green's functions' position and velocity just before the
//! impact, α = −(1+R)Σ μᵢPᵢ and Q = 1 + (1+R)Σ μᵢDᵢ.

use super::contact::{impact_pair, is_plastic};
use super::crossing::first_zero;
use super::flight::{Drive, FlightPaths, State, exponent, forced_amplitude, free_flight};
use super::params::{Flight, Machine, ModelError, Oscillator, Setting};
use super::path::C64;
use super::variation::{eigenvalues, free_flow, saltation};

/// Why an orbit that solves the equations is no motion of the machine, or that it is one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Existence {
    /// It is a motion of the machine.
    Exists,
    /// The approach speed is not positive.
    NotClosing,
    /// The flight meets the contact before the period is over.
    FurtherImpact,
    /// The masses would stay together after the impact.
    DeadZone,
}

/// A periodic orbit with one impact in n drive periods.
#[derive(Debug, Clone)]
pub struct Orbit {
    /// Drive periods in one period of the motion.
    pub n: u32,
    /// η and ρ; the phase is the drive's at the impact.
    pub setting: Setting,
    /// Phase of the drive at the impact, rad in [0, 2π).
    pub phase_at_impact: f64,
    /// Approach speed before the impact: X'₋ + Y'₋, against a stop X'₋.
    pub approach_speed: f64,
    /// State just before the impact.
    pub before: State,
    /// State just after the impact.
    pub after: State,
    /// Multipliers of the period map, largest modulus first: four for two masses, two for one.
    pub multipliers: Vec<C64>,
    /// Whether it is a motion of the machine.
    pub existence: Existence,
    flight: FlightPaths,
}

impl Orbit {
    /// The motion at a time since the impact, continued periodically: exact.
    pub fn at(&self, tau_since_impact: f64) -> State {
        self.flight.at(tau_since_impact.rem_euclid(self.period()))
    }

    /// Both displacements in closed form over the flight after the impact.
    pub fn paths(&self) -> &FlightPaths {
        &self.flight
    }

    /// Period 2πn/η.
    pub fn period(&self) -> f64 {
        f64::from(self.n) * self.setting.period()
    }

    /// Whether every multiplier is inside the unit circle.
    pub fn is_stable(&self) -> bool {
        self.multipliers.iter().all(|m| m.norm() < 1.0)
    }

    /// Whether it is a motion of the machine.
    pub fn exists(&self) -> bool {
        self.existence == Existence::Exists
    }
}

/// Periodic response of one mass to a unit velocity jump once per period T: the free mode just
/// after the jump, and displacement and velocity just before it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Green {
    /// Displacement at the jump.
    pub(crate) position: f64,
    /// Velocity just before the jump (just after: + 1).
    pub(crate) velocity_before: f64,
}

/// Green's function of a mass for a jump every `period`.
///
/// The response to one jump is Im(e^{λt})/ω; all past ones sum up geometrically.
pub(crate) fn green(o: &Oscillator, period: f64) -> Green {
    green_of(o, returned(o, period))
}

/// e^{λT}
fn returned(o: &Oscillator, period: f64) -> C64 {
    let lambda = exponent(o);
    let (sin, cos) = (lambda.im * period).sin_cos();
    let e = (lambda.re * period).exp();
    C64::new(e * cos, e * sin)
}

/// The sum over all past jumps: G(t) = Im(e^{λt}/(1 − e^{λT}))/ω.
fn green_of(o: &Oscillator, returned: C64) -> Green {
    let lambda = exponent(o);
    let one_minus = C64::new(1.0, 0.0) - returned;
    let z = one_minus.conj() / one_minus.norm_sqr();
    let before = returned * lambda * z;
    Green {
        position: z.im / lambda.im,
        velocity_before: before.im / lambda.im,
    }
}

/// Everything of a z = 1/n orbit that does not depend on ρ: the forced amplitude F and the
/// combined Green's functions.
#[derive(Debug, Clone, Copy)]
pub struct Branch {
    /// F, complex amplitude of the impactless motion X + Y for drive phase 0.
    pub forced: C64,
    /// Σ μᵢ·position of the Green's functions.
    pub position: f64,
    /// Σ μᵢ·velocity before.
    pub velocity: f64,
    /// e^{λT}: what is left of a free vibration of the first mass after the period.
    pub returned: C64,
    /// η
    pub eta: f64,
    /// Drive periods in one period of the motion.
    pub n: u32,
    /// What small extra accelerations add to X + Y at the impact and to X' + Y' just before it.
    pub extra: [f64; 2],
}

impl Branch {
    /// For a machine at η and n.
    pub fn new(machine: &Machine, eta: f64, n: u32) -> Self {
        let period = f64::from(n) * std::f64::consts::TAU / eta;
        let (mx, my) = machine.mobility();
        let drive = Drive { eta, phase: 0.0 };
        let returned = returned(&machine.x, period);
        let gx = green_of(&machine.x, returned);
        let mut forced = forced_amplitude(&machine.x, drive);
        let (mut position, mut velocity) = (mx * gx.position, mx * gx.velocity_before);
        match &machine.y {
            // equal masses: the second's part is the first's
            Some(y) if *y == machine.x => {
                forced *= 2.0;
                (position, velocity) = (gx.position, gx.velocity_before);
            }
            Some(y) => {
                let gy = green(y, period);
                forced += forced_amplitude(y, drive);
                position += my * gy.position;
                velocity += my * gy.velocity_before;
            }
            None => {}
        }
        Self {
            forced,
            position,
            velocity,
            returned,
            eta,
            n,
            extra: [0.0; 2],
        }
    }

    /// The same with small extra accelerations that add to X + Y at the impact and to X' + Y' just
    /// before it.
    #[must_use]
    pub fn with_extra(self, extra: [f64; 2]) -> Self {
        Self { extra, ..self }
    }

    /// The stable, existing orbit at a clearance, if there is one (at most one of the two roots is).
    pub fn stable_orbit(&self, machine: &Machine, clearance: f64) -> Option<Orbit> {
        let judged = |w: f64| {
            let mut orbit = self.unjudged_orbit(machine, clearance, w);
            orbit.multipliers = multipliers(machine, &orbit);
            if !orbit.is_stable() {
                return None;
            }
            orbit.existence = existence(machine, &orbit);
            orbit.exists().then_some(orbit)
        };
        let speeds = approach_speeds(machine, self, machine.gap(clearance));
        speeds.into_iter().find_map(judged)
    }

    /// The orbit that closes at a clearance with a speed w solving the quadratic.
    fn orbit(&self, machine: &Machine, clearance: f64, w: f64) -> Orbit {
        let mut orbit = self.unjudged_orbit(machine, clearance, w);
        orbit.multipliers = multipliers(machine, &orbit);
        orbit.existence = existence(machine, &orbit);
        orbit
    }

    /// As [`Self::orbit`], without its multipliers and with its existence assumed.
    fn unjudged_orbit(&self, machine: &Machine, clearance: f64, w: f64) -> Orbit {
        let (eta, n) = (self.eta, self.n);
        let r = machine.restitution().at(w);
        let phase = self.phase(r, machine.gap(clearance), w);
        let drive = Drive { eta, phase };
        let (before, after) = states_at_impact(machine, drive, n, (1.0 + r) * w);
        Orbit {
            n,
            setting: Setting::new(eta, clearance).at_phase(phase),
            phase_at_impact: phase,
            approach_speed: w,
            before,
            after,
            multipliers: Vec::new(),
            existence: Existence::Exists,
            flight: free_flight(machine, drive, &after),
        }
    }

    /// α: gap = Re(F e^{iψ}) + αw at the impact, without extra accelerations.
    pub fn alpha(&self, restitution: f64) -> f64 {
        -(1.0 + restitution) * self.position
    }

    /// Q: −Im(F e^{iψ}) η = Qw, without extra accelerations.
    pub fn q(&self, restitution: f64) -> f64 {
        1.0 + (1.0 + restitution) * self.velocity
    }

    /// F e^{iψ} at the impact of an orbit with approach speed w.
    pub(super) fn at_impact(&self, restitution: f64, gap: f64, w: f64) -> C64 {
        C64::new(
            gap - self.extra[0] - self.alpha(restitution) * w,
            (self.extra[1] - self.q(restitution) * w) / self.eta,
        )
    }

    /// (G − αw)² + (Qw/η)² − |F|²: zero on an orbit.
    pub fn mismatch(&self, restitution: f64, gap: f64, w: f64) -> f64 {
        self.at_impact(restitution, gap, w).norm_sqr() - self.forced.norm_sqr()
    }

    /// Phase of the drive at the impact of an orbit with approach speed w.
    pub fn phase(&self, restitution: f64, gap: f64, w: f64) -> f64 {
        let u = self.at_impact(restitution, gap, w);
        (u.arg() - self.forced.arg()).rem_euclid(std::f64::consts::TAU)
    }

    /// Both approach speeds for constant R, smaller first; `None` beyond the saddle-node.
    pub fn approach_speeds(&self, restitution: f64, gap: f64) -> Option<[f64; 2]> {
        let (alpha, q) = (self.alpha(restitution), self.q(restitution) / self.eta);
        let [gap, rate] = [gap - self.extra[0], self.extra[1] / self.eta];
        let a = alpha * alpha + q * q;
        let c = gap * gap - self.forced.norm_sqr() + rate * rate;
        let (own, added) = (gap * alpha, q * rate);
        let disc = gap * gap * alpha * alpha + added * (2.0 * own + added) - a * c;
        if disc < 0.0 || a == 0.0 {
            return None;
        }
        // the stable form of the quadratic's roots
        let s = own + added;
        let large = s + s.signum() * disc.sqrt();
        let roots = if large == 0.0 {
            [0.0, 0.0]
        } else {
            [large / a, c / large]
        };
        Some(if roots[0] <= roots[1] {
            roots
        } else {
            [roots[1], roots[0]]
        })
    }
}

/// All z = 1/n orbits of a machine in a setting (its phase is ignored): those that exist and
/// those that only solve the equations with positive approach speed, smaller speed first.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range or the flight is not harmonic.
pub fn orbits(machine: &Machine, setting: Setting, n: u32) -> Result<Vec<Orbit>, ModelError> {
    let branch = checked_branch(machine, setting, n)?;
    let speeds = approach_speeds(machine, &branch, machine.gap(setting.clearance));
    let orbit = |w: f64| branch.orbit(machine, setting.clearance, w);
    Ok(speeds.into_iter().map(orbit).collect())
}

/// What all z = 1/n orbits at the setting's η have in common.
fn checked_branch(machine: &Machine, setting: Setting, n: u32) -> Result<Branch, ModelError> {
    machine.check()?;
    setting.check()?;
    if machine.flight != Flight::Harmonic || n == 0 {
        return Err(ModelError::Unsupported(
            "periodic orbits z = 1/n need the harmonic flight and n of at least 1",
        ));
    }
    Ok(Branch::new(machine, setting.frequency_ratio, n))
}

/// The stable, existing z = 1/n orbit, if there is one (at most one of the two roots is).
///
/// # Errors
/// As [`orbits`].
///
/// ```
/// use impact_oscillator::{Machine, Setting, model::orbit::stable_orbit};
///
/// let machine = Machine::single(0.07, 0.9);
/// let orbit = stable_orbit(&machine, Setting::new(1.2, 2.0), 1)?.expect("z = 1");
/// assert!((orbit.approach_speed - 2.413_516).abs() < 1e-6);
/// assert!(orbit.multipliers.iter().all(|m| m.norm() < 1.0));
/// // the motion is periodic
/// assert!((orbit.at(0.3).x - orbit.at(0.3 + orbit.period()).x).abs() < 1e-12);
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
pub fn stable_orbit(
    machine: &Machine,
    setting: Setting,
    n: u32,
) -> Result<Option<Orbit>, ModelError> {
    let branch = checked_branch(machine, setting, n)?;
    Ok(branch.stable_orbit(machine, setting.clearance))
}

fn approach_speeds(machine: &Machine, branch: &Branch, gap: f64) -> Vec<f64> {
    match machine.restitution().constant() {
        Some(r) => {
            let roots = branch.approach_speeds(r, gap).unwrap_or([-1.0, -1.0]);
            roots.into_iter().filter(|w| *w > 0.0).collect()
        }
        None => speed_dependent(machine, branch, gap),
    }
}

/// Roots of the mismatch for R(w): bracketed on a fine grid of speeds, then bisected. Speeds
/// cannot exceed those of R anywhere between its extremes, which bounds the grid.
fn speed_dependent(machine: &Machine, branch: &Branch, gap: f64) -> Vec<f64> {
    let law = machine.restitution();
    let f = |w: f64| branch.mismatch(law.at(w), gap, w);
    let top = (0..=20)
        .filter_map(|i| branch.approach_speeds(f64::from(i) / 20.0, gap))
        .fold(branch.forced.norm() * branch.eta, |m, r| m.max(r[1]));
    let grid: Vec<f64> = (0..=2000)
        .map(|i| 1.5 * top * f64::from(i) / 2000.0)
        .collect();
    let crosses = |p: &&[f64]| f(p[0]) * f(p[1]) < 0.0;
    grid.windows(2)
        .filter(crosses)
        .map(|p| bisect(f, p[0], p[1]))
        .collect()
}

/// Root of a function between two arguments at which its signs differ.
pub(super) fn bisect(f: impl Fn(f64) -> f64, mut lo: f64, mut hi: f64) -> f64 {
    let sign = f(lo).signum();
    for _ in 0..200 {
        let mid = 0.5 * (lo + hi);
        if mid <= lo.min(hi) || mid >= lo.max(hi) {
            break;
        }
        if f(mid).signum() == sign {
            lo = mid;
        } else {
            hi = mid;
        }
    }
    0.5 * (lo + hi)
}

/// The orbit that closes with a speed w solving the quadratic.
pub fn orbit_with_speed(machine: &Machine, setting: Setting, n: u32, w: f64) -> Orbit {
    let branch = Branch::new(machine, setting.frequency_ratio, n);
    branch.orbit(machine, setting.clearance, w)
}

/// States just before the impact, forced response plus Green's functions, and just after it.
fn states_at_impact(machine: &Machine, drive: Drive, n: u32, change: f64) -> (State, State) {
    let period = f64::from(n) * std::f64::consts::TAU / drive.eta;
    let (mx, my) = machine.mobility();
    let of = |o: &Oscillator, mobility: f64| {
        let (f, g) = (forced_amplitude(o, drive), green(o, period));
        let jump = -mobility * change;
        (
            f.re + jump * g.position,
            -drive.eta * f.im + jump * g.velocity_before,
        )
    };
    let x = of(&machine.x, mx);
    let y = machine.y.as_ref().map_or((0.0, 0.0), |o| of(o, my));
    impact_pair(machine, drive, [x, y])
}

fn existence(machine: &Machine, orbit: &Orbit) -> Existence {
    if orbit.approach_speed <= 0.0 {
        return Existence::NotClosing;
    }
    let pressed = orbit.after.ax + orbit.after.ay > 0.0;
    if is_plastic(machine, orbit.approach_speed) && pressed {
        return Existence::DeadZone;
    }
    let gap = orbit.flight.gap(machine.gap(orbit.setting.clearance));
    match first_zero(&gap, orbit.period() * (1.0 - 1e-9)) {
        Some(_) => Existence::FurtherImpact,
        None => Existence::Exists,
    }
}

fn multipliers(machine: &Machine, orbit: &Orbit) -> Vec<C64> {
    let flow = free_flow(machine, orbit.period());
    eigenvalues(
        machine,
        &(saltation(machine, &orbit.before, &orbit.after) * flow),
    )
}
