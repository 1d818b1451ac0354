//! Brackets of boundaries against the closed-form s2 and ρ'.

use crate::event::Rig;
use crate::identify::parameters::{Coordinate, Parameters};
use crate::identify::solver::Block;
use crate::model::orbit::Branch;
use crate::model::boundary::s2_of_branch;
use crate::model::params::Machine;
use crate::motion::bracket::{BoundaryKind, Bracket};

/// Brackets that the fit uses.
#[derive(Debug, Clone)]
pub struct BoundaryBlock {
    /// One or two masses.
    pub rig: Rig,
    /// The brackets: s2 and grazing.
    pub brackets: Vec<Bracket>,
}

/// How much weaker a bracket pulls when the motion jumped before the boundary: disturbances make
/// it jump early, never late.
const EARLY: f64 = 4.0;

impl BoundaryBlock {
    /// Collect the brackets of boundaries that have a closed form.
    pub fn new(rig: Rig, brackets: &[Bracket]) -> Self {
        let brackets = brackets
            .iter()
            .filter(|b| matches!(b.kind, BoundaryKind::SaddleNode | BoundaryKind::Grazing))
            .cloned()
            .collect();
        Self { rig, brackets }
    }

    /// Whether any bracket tells R.
    pub fn tells_restitution(&self) -> bool {
        self.brackets.iter().any(|b| b.kind == BoundaryKind::SaddleNode)
    }
}

/// Frequency of the boundary of a bracket according to the model, Hz: the crossing nearest to it.
/// `None` where the boundary does not reach this clearance.
pub fn predicted_hz(bracket: &Bracket, parameters: &Parameters, rig: Rig) -> Option<f64> {
    let machine = parameters.machine(rig);
    let middle =
        parameters.setting(bracket.middle_hz(), bracket.clearance_m, bracket.drive_amplitude);
    let rho = |eta: f64| match bracket.kind {
        BoundaryKind::Grazing => grazing(&machine, eta),
        _ => saddle_node(&machine, parameters.restitution, eta, bracket.periods_n),
    };
    let eta = nearest_crossing(rho, middle.clearance, middle.frequency_ratio)?;
    Some(eta * parameters.natural_frequency_hz)
}

/// ρ' in units of half the gap for either rig.
fn grazing(machine: &Machine, eta: f64) -> f64 {
    half_gap(machine, Branch::new(machine, eta, 1).forced.norm())
}

fn saddle_node(machine: &Machine, restitution: f64, eta: f64, n: u32) -> f64 {
    let branch = Branch::new(machine, eta, n);
    half_gap(machine, s2_of_branch(&branch, restitution.clamp(0.0, 1.0)).0)
}

/// Clearance ρ that belongs to a whole gap.
fn half_gap(machine: &Machine, gap: f64) -> f64 {
    gap / machine.gap(1.0)
}

/// Crossing of ρ(η) with a level nearest to η0: scanned outward, then bisected.
fn nearest_crossing(rho: impl Fn(f64) -> f64, level: f64, eta0: f64) -> Option<f64> {
    let excess = |eta: f64| rho(eta) - level;
    let here = excess(eta0);
    let step = 0.01;
    let (mut low, mut high) = ((eta0, here), (eta0, here));
    for _ in 0..60 {
        let below = low.0 - step;
        if below > 0.05 {
            let next = (below, excess(below));
            if next.1.signum() != low.1.signum() {
                return Some(bisected(&excess, next.0, low.0));
            }
            low = next;
        }
        let above = high.0 + step;
        let next = (above, excess(above));
        if next.1.signum() != high.1.signum() {
            return Some(bisected(&excess, high.0, next.0));
        }
        high = next;
    }
    None
}

/// Root between two points of opposite sign, by the ITP-like mix of bisection and secant.
fn bisected(excess: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let (mut at_low, mut at_high) = (excess(low), excess(high));
    for k in 0..80 {
        let secant = (low * at_high - high * at_low) / (at_high - at_low);
        let inside = secant > low && secant < high;
        let eta = if k % 3 == 2 || !inside { 0.5 * (low + high) } else { secant };
        let value = excess(eta);
        if value == 0.0 || high - low < 1e-13 * high {
            return eta;
        }
        if value.signum() == at_low.signum() {
            (low, at_low) = (eta, value);
        } else {
            (high, at_high) = (eta, value);
        }
    }
    0.5 * (low + high)
}

impl Block for BoundaryBlock {
    fn items(&self) -> usize {
        self.brackets.len()
    }

    fn residuals(&self, item: usize, parameters: &Parameters) -> Option<Vec<f64>> {
        let bracket = &self.brackets[item];
        let frequency = predicted_hz(bracket, parameters, self.rig)?;
        let deviation = bracket.width_hz() / 12f64.sqrt() + 2e-4 * bracket.middle_hz();
        let residual = (frequency - bracket.middle_hz()) / deviation;
        let late = residual.abs() <= 3f64.sqrt() || !jumped_early(bracket, residual);
        let residual = if late {
            residual
        } else {
            let edge = 3f64.sqrt() * residual.signum();
            edge + (residual - edge) / EARLY
        };
        Some(vec![residual])
    }

    fn touches(&self, coordinate: Coordinate) -> bool {
        !matches!(coordinate, Coordinate::Gain(_))
    }
}

/// Whether the motion changed before the sweep had reached the predicted boundary.
fn jumped_early(bracket: &Bracket, residual: f64) -> bool {
    match bracket.sweep {
        crate::record::Sweep::Up => residual > 0.0,
        crate::record::Sweep::Down => residual < 0.0,
        crate::record::Sweep::Unknown => false,
    }
}
