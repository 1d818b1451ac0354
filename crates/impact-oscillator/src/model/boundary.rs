//! Boundaries of z = 1/n in the (η, ρ) plane: saddle-node s2 and period doubling s1 in closed
//! form, grazing ρ', and the inverse `η_s2(ρ)`. Each point reports whether its orbit exists.

use serde::Serialize;

use super::flight::{Drive, exponent, forced_amplitude};
use super::orbit::{Branch, Existence, Orbit, bisect, orbit_with_speed};
use super::params::{Flight, Machine, Oscillator, Setting};
use super::path::C64;
use super::variation::{free_flow, saltation};

/// A point of a boundary, with the orbit that is marginal there.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BoundaryPoint {
    /// η
    pub eta: f64,
    /// ρ
    pub rho: f64,
    /// Approach speed of the marginal orbit; 0 at grazing.
    pub approach_speed: f64,
    /// Phase of the drive at its impact, rad in [0, 2π).
    pub phase: f64,
    /// Whether the marginal orbit is a motion of the machine.
    pub existence: Existence,
    /// Whether no other multiplier of the orbit is outside the unit circle, so that it is a
    /// stable motion that ends here.
    pub ends_stability: bool,
}

impl BoundaryPoint {
    /// Whether the marginal orbit exists and a stable motion ends there, so that the boundary is
    /// one that a machine shows.
    pub fn is_valid(&self) -> bool {
        self.existence == Existence::Exists && self.ends_stability
    }
}

/// ρ from a gap: half of it for two masses.
fn clearance(machine: &Machine, gap: f64) -> f64 {
    gap / machine.gap(1.0)
}

/// ρ'(η): clearance at which the impactless motion X + Y grazes the contact (or the stop),
/// ρ' = |F|/2 (below eq. (10)). Infinite at an undamped resonance.
///
/// ```
/// use impact_oscillator::{Machine, rho_grazing};
///
/// let machine = Machine::symmetric(0.07, 0.9);
/// assert!((rho_grazing(&machine, 1.3) - 1.401_347).abs() < 1e-6);
/// ```
pub fn rho_grazing(machine: &Machine, eta: f64) -> f64 {
    let drive = Drive { eta, phase: 0.0 };
    let mut forced = forced_amplitude(&machine.x, drive);
    if let Some(y) = &machine.y {
        forced += forced_amplitude(y, drive);
    }
    clearance(machine, forced.norm())
}

/// ρp(η): clearance below which masses that stick together never separate, eq. (12). Sticking
/// masses press with −2k₁k₂ρ/(k₁+k₂) + Re((F₁D₂ + F₂D₁)/(D₁ + D₂) e^{i(ητ+φ)}), Dᵢ = kᵢ − η²mᵢ + iηbᵢ;
/// ρp is where that just never vanishes. Equal masses, or one of them: −F/k for every η.
///
/// ```
/// use impact_oscillator::{Machine, model::boundary::rho_sticking};
///
/// assert!((rho_sticking(&Machine::symmetric(0.07, 0.9), 1.3) + 1.0).abs() < 1e-12);
/// ```
pub fn rho_sticking(machine: &Machine, eta: f64) -> f64 {
    let parts = |o: &Oscillator| {
        let k = o.stiffness_per_mass() * o.mass;
        let dynamic = C64::new(k - eta * eta * o.mass, 2.0 * eta * o.decay_rate() * o.mass);
        (k, o.drive_amplitude, dynamic)
    };
    let (k1, f1, d1) = parts(&machine.x);
    let Some(y) = &machine.y else {
        return -f1 / k1;
    };
    let (k2, f2, d2) = parts(y);
    let swing = (d2 * f1 + d1 * f2) / (d1 + d2);
    -swing.norm() * (k1 + k2) / (2.0 * k1 * k2)
}

/// Clearance and approach speed at s2 for constant R, without a check of existence:
/// G = |F|√(1 + (αη/Q)²), w = Gα/(α² + Q²/η²).
pub fn s2_of_branch(branch: &Branch, restitution: f64) -> (f64, f64) {
    let (alpha, q) = (
        branch.alpha(restitution),
        branch.q(restitution) / branch.eta,
    );
    let gap = branch.forced.norm() * (1.0 + (alpha / q).powi(2)).sqrt();
    (gap, gap * alpha / (alpha * alpha + q * q))
}

/// s2: the saddle-node boundary of z = 1/n at η, eq. (10), with the marginal orbit and whether it
/// exists. `None`: no saddle-node at a finite clearance.
///
/// ```
/// use impact_oscillator::{Machine, rho_s2};
///
/// let machine = Machine::symmetric(0.07, 0.9);
/// for (eta, rho) in [(1.1, 6.351_142), (1.3, 4.151_754), (1.6, 1.812_702)] {
///     let point = rho_s2(&machine, eta, 1).expect("a saddle-node");
///     assert!((point.rho - rho).abs() < 1e-6);
///     assert!(point.is_valid());
/// }
/// ```
pub fn rho_s2(machine: &Machine, eta: f64, n: u32) -> Option<BoundaryPoint> {
    let branch = harmonic_branch(machine, eta, n)?;
    let (gap, w) = match machine.restitution().constant() {
        Some(r) => s2_of_branch(&branch, r),
        None => s2_speed_dependent(machine, &branch)?,
    };
    point(machine, eta, n, (clearance(machine, gap), w))
}

fn harmonic_branch(machine: &Machine, eta: f64, n: u32) -> Option<Branch> {
    let ok = machine.flight == Flight::Harmonic && n > 0 && eta > 0.0 && eta.is_finite();
    ok.then(|| Branch::new(machine, eta, n))
}

fn point(machine: &Machine, eta: f64, n: u32, at: (f64, f64)) -> Option<BoundaryPoint> {
    let (rho, approach_speed) = at;
    if !rho.is_finite() || !approach_speed.is_finite() {
        return None;
    }
    let mut p = BoundaryPoint {
        eta,
        rho,
        approach_speed,
        phase: 0.0,
        existence: Existence::NotClosing,
        ends_stability: false,
    };
    if approach_speed > 0.0 {
        let orbit = orbit_with_speed(machine, Setting::new(eta, rho), n, approach_speed);
        (p.phase, p.existence) = (orbit.phase_at_impact, orbit.existence);
        let within = |m: &C64| m.norm() < 1.0 + 1e-6;
        p.ends_stability = orbit.multipliers.iter().all(within);
    }
    Some(p)
}

/// Greatest gap along the branch G(w) = α(w)w + √(|F|² − (Q(w)w/η)²) for R(w).
fn s2_speed_dependent(machine: &Machine, branch: &Branch) -> Option<(f64, f64)> {
    let law = machine.restitution();
    let gap = |w: f64| {
        let (alpha, q) = (branch.alpha(law.at(w)), branch.q(law.at(w)));
        let rest = branch.forced.norm_sqr() - (q * w / branch.eta).powi(2);
        (rest >= 0.0).then(|| alpha * w + rest.sqrt())
    };
    let top = (0..=20)
        .map(|i| branch.eta * branch.forced.norm() / branch.q(f64::from(i) / 20.0).abs())
        .fold(0.0, f64::max);
    let grid = (1..2000).map(|i| top * f64::from(i) / 2000.0);
    let best = grid.filter(|w| gap(*w).is_some()).max_by(|a, b| {
        gap(*a)
            .unwrap_or(f64::MIN)
            .total_cmp(&gap(*b).unwrap_or(f64::MIN))
    })?;
    let step = top / 2000.0;
    let w = golden_maximum(|w| gap(w).unwrap_or(f64::MIN), best - step, best + step);
    Some((gap(w)?, w))
}

/// Argument of the maximum of a function with one maximum between two arguments.
fn golden_maximum(f: impl Fn(f64) -> f64, mut lo: f64, mut hi: f64) -> f64 {
    const SHARE: f64 = 0.618_033_988_749_895;
    for _ in 0..80 {
        let (a, b) = (hi - SHARE * (hi - lo), lo + SHARE * (hi - lo));
        if f(a) < f(b) { lo = a } else { hi = b }
    }
    0.5 * (lo + hi)
}

/// s1: the period-doubling boundary of z = 1/n at η (multiplier −1). With equal masses and constant
/// R it is a closed form; otherwise the root is found along the branch of orbits. `None`: the
/// branch has no doubling.
///
/// ```
/// use impact_oscillator::{Machine, rho_s1};
///
/// let point = rho_s1(&Machine::symmetric(0.07, 0.9), 0.9, 1).expect("a doubling");
/// assert!((point.rho - 1.760_461).abs() < 1e-6);
/// ```
pub fn rho_s1(machine: &Machine, eta: f64, n: u32) -> Option<BoundaryPoint> {
    let branch = harmonic_branch(machine, eta, n)?;
    let equal = machine.y.is_none() || machine.is_symmetric();
    match machine.restitution().constant() {
        Some(r) if equal => {
            let at = s1_of_branch(machine, &branch, r)?;
            point(machine, eta, n, at)
        }
        Some(r) => s1_along_branch(machine, &branch, r, n),
        None => None,
    }
}

/// Clearance and approach speed at s1 of one mass (or of equal ones) for constant R, without a check of existence.
pub fn s1_of_branch(machine: &Machine, branch: &Branch, r: f64) -> Option<(f64, f64)> {
    alternating_of_branch(machine, branch, r, 1.0)
}

/// Clearance and approach speed at which an alternation between impacts of z = 1/n keeps the share `kept` (above 0; 1 at
/// s1) over a cycle, of one mass (or of equal ones) for constant R: the multiplier is −`kept` where
/// trace = −(`kept` + determinant/`kept`). Without a check of existence.
pub fn alternating_of_branch(
    machine: &Machine,
    branch: &Branch,
    r: f64,
    kept: f64,
) -> Option<(f64, f64)> {
    let masses = machine.gap(1.0);
    let (o, eta) = (&machine.x, branch.eta);
    let lambda = exponent(o);
    let C64 { re: ec, im: es } = branch.returned;
    let determinant = r * r * branch.returned.norm_sqr();
    let g = (2.0 * r * ec - (kept + determinant / kept)) * lambda.im / es;
    let (f, p) = (branch.forced / masses, o.drive_per_mass());
    let (alpha, q) = (branch.alpha(r), branch.q(r) / eta);
    let f2 = f.norm_sqr();
    let kappa = (g / (1.0 + r) + p * (alpha * f.re + q * f.im) / f2)
        / (p * f.re / f2 - o.stiffness_per_mass());
    let v = f.norm() / (kappa - alpha).hypot(q);
    (v.is_finite() && kappa.is_finite()).then_some((kappa * v, v * masses))
}

/// Doubling along the branch w = (η|F|/|Q|) sin θ, G = αw + |F| cos θ of an asymmetric machine:
/// the root of det(M + 1) of largest approach speed whose orbit exists, else of largest speed.
fn s1_along_branch(machine: &Machine, branch: &Branch, r: f64, n: u32) -> Option<BoundaryPoint> {
    let (f, eta) = (branch.forced.norm(), branch.eta);
    let at = |theta: f64| {
        let w = eta * f / branch.q(r).abs() * theta.sin();
        (clearance(machine, branch.alpha(r) * w + f * theta.cos()), w)
    };
    let determinant = |theta: f64| {
        let (rho, w) = at(theta);
        let orbit = orbit_with_speed(machine, Setting::new(eta, rho), n, w);
        doubling_determinant(machine, &orbit)
    };
    let grid: Vec<f64> = (1..400)
        .map(|i| f64::from(i) * std::f64::consts::PI / 400.0)
        .collect();
    let values: Vec<f64> = grid.iter().map(|t| determinant(*t)).collect();
    let mut found: Vec<BoundaryPoint> = (1..grid.len())
        .filter(|&i| values[i - 1] * values[i] < 0.0)
        .filter_map(|i| {
            point(
                machine,
                eta,
                n,
                at(bisect(determinant, grid[i - 1], grid[i])),
            )
        })
        .collect();
    found.sort_by(|a, b| {
        (b.is_valid(), b.approach_speed)
            .partial_cmp(&(a.is_valid(), a.approach_speed))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    found.first().copied()
}

/// det(M + 1) of an orbit's period map: zero where a multiplier is −1.
fn doubling_determinant(machine: &Machine, orbit: &Orbit) -> f64 {
    let flow = free_flow(machine, orbit.period());
    let map = saltation(machine, &orbit.before, &orbit.after) * flow;
    (map + nalgebra::Matrix4::identity()).determinant()
}

/// All η at which the saddle-node boundary of z = 1/n passes a clearance with an orbit that
/// exists, rising. The search covers 0 < η ≤ 2.5 n.
pub fn etas_s2(machine: &Machine, rho: f64, n: u32) -> Vec<BoundaryPoint> {
    let Some(r) = machine.restitution().constant() else {
        return Vec::new();
    };
    let miss = |eta: f64| s2_of_branch(&Branch::new(machine, eta, n), r).0 - machine.gap(rho);
    points_at(rho, n, miss, |eta| rho_s2(machine, eta, n))
}

/// The same for the period doubling of z = 1/n.
pub fn etas_s1(machine: &Machine, rho: f64, n: u32) -> Vec<BoundaryPoint> {
    let miss = |eta: f64| rho_s1(machine, eta, n).map_or(f64::NAN, |p| p.rho - rho);
    points_at(rho, n, miss, |eta| rho_s1(machine, eta, n))
}

/// All η at which the impactless motion grazes at a clearance, rising.
pub fn etas_grazing(machine: &Machine, rho: f64) -> Vec<f64> {
    roots(2.5, |eta| rho_grazing(machine, eta) - rho)
}

/// All η at which ρp passes a clearance, rising; none where ρp does not depend on η: one mass, equal
/// forces on both, or masses of equal natural frequency and damping ratio.
///
/// ```
/// use impact_oscillator::model::boundary::etas_sticking;
/// use impact_oscillator::model::params::{Asymmetry, Machine};
///
/// assert!(etas_sticking(&Machine::symmetric(0.07, 0.9), -1.0).is_empty());
/// let differing = Asymmetry { mass: 1.2, drive_amplitude: 0.9, ..Asymmetry::default() };
/// let machine = Machine::asymmetric(0.07, 0.9, differing);
/// let etas = etas_sticking(&machine, -0.95);
/// assert!((etas[0] - 0.952_324).abs() < 1e-6 && etas.len() == 1);
/// ```
pub fn etas_sticking(machine: &Machine, rho: f64) -> Vec<f64> {
    let level = rho_sticking(machine, 1.0);
    let same = |eta: f64| (rho_sticking(machine, eta) - level).abs() < 1e-12 * level.abs();
    if [0.5, 1.5, 2.0].into_iter().all(same) {
        return Vec::new();
    }
    roots(2.5, |eta| rho_sticking(machine, eta) - rho)
}

fn points_at(
    rho: f64,
    n: u32,
    miss: impl Fn(f64) -> f64,
    point: impl Fn(f64) -> Option<BoundaryPoint>,
) -> Vec<BoundaryPoint> {
    roots(2.5 * f64::from(n), miss)
        .into_iter()
        .filter_map(point)
        .filter(|p| p.is_valid() && (p.rho - rho).abs() < 1e-9 * (1.0 + rho.abs()))
        .collect()
}

/// Roots of a function over (0, top] that a fixed grid separates.
fn roots(top: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let grid: Vec<f64> = (1..=1000).map(|i| top * f64::from(i) / 1000.0).collect();
    let values: Vec<f64> = grid.iter().map(|eta| f(*eta)).collect();
    (1..grid.len())
        .filter(|&i| values[i - 1] * values[i] <= 0.0)
        .map(|i| bisect(&f, grid[i - 1], grid[i]))
        .collect()
}

/// The greatest η at which z = 1/n ends in a saddle-node at a clearance: where a rising sweep
/// of the frequency jumps. `None`: the boundary does not pass this clearance with an orbit.
///
/// ```
/// use impact_oscillator::{Machine, eta_s2};
///
/// let point = eta_s2(&Machine::symmetric(0.07, 0.9), 2.0, 1).expect("a saddle-node");
/// assert!((point.eta - 1.568_813).abs() < 1e-6);
/// ```
pub fn eta_s2(machine: &Machine, rho: f64, n: u32) -> Option<BoundaryPoint> {
    etas_s2(machine, rho, n).pop()
}
