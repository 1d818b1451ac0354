//! Brackets of boundaries against the closed-form s2, s1 and ρ'.

use crate::event::RigKind;
use crate::identify::fit::Block;
use crate::identify::fit::parameters::{Coordinate, Parameters};
use crate::motion::{BoundaryKind, Bracket};
use impact_oscillator::model::boundary::{rho_grazing, s1_of_branch, s2_of_branch};
use impact_oscillator::model::orbit::Branch;

/// Brackets that the fit uses, with the likelihood of each.
#[derive(Debug, Clone)]
pub struct BoundaryBlock {
    /// One or two masses.
    pub rig: RigKind,
    /// The brackets: s2, s1 and grazing.
    pub brackets: Vec<Bracket>,
    /// Typical distance of an early jump from the boundary, as a fraction of the frequency.
    pub early_scale: f64,
}

impl BoundaryBlock {
    /// Collect the brackets of boundaries that have a closed form.
    pub fn new(rig: RigKind, brackets: &[Bracket]) -> Self {
        let brackets = brackets
            .iter()
            .filter(|b| b.kind != BoundaryKind::Other)
            .cloned()
            .collect();
        Self {
            rig,
            brackets,
            early_scale: 0.01,
        }
    }

    /// Whether any bracket determines R.
    pub fn determines_restitution(&self) -> bool {
        self.brackets
            .iter()
            .any(|b| b.kind != BoundaryKind::Grazing)
    }

    /// Set the scale of early jumps to the one that makes the brackets most likely at given
    /// parameters.
    pub fn fit_early_scale(&mut self, parameters: &Parameters) {
        let places: Vec<(Bracket, f64)> = self
            .brackets
            .iter()
            .filter_map(|b| Some((b.clone(), predicted_hz(b, parameters, self.rig)?)))
            .collect();
        let cost = |scale: f64| -> f64 {
            places
                .iter()
                .map(|(b, f)| -Jump::of(b, scale).probability(*f).ln())
                .sum()
        };
        let scales = (0..24).map(|i| 1e-3 * 1.25f64.powi(i));
        if let Some(best) = scales.min_by(|a, b| cost(*a).total_cmp(&cost(*b))) {
            self.early_scale = best;
        }
    }
}

/// Where a motion jumps as a sweep nears a boundary: disturbances make it jump early, by an
/// exponentially distributed distance, never late but for a small error of the setting.
#[derive(Debug, Clone, Copy)]
struct Jump {
    low: f64,
    high: f64,
    early: f64,
    setting: f64,
    rising: bool,
    /// Probability that the bracket holds no such boundary at all, over its width.
    stray: f64,
}

/// How often a change of z = 1/n is not that of the nearest s1 (other doubled motions lie beside it)
/// or, for n > 1, not that of the nearest s2 (an impact more may end it first).
const STRAY: f64 = 0.3;
/// Frequencies over which such a change may lie, relative.
const STRAY_RANGE: f64 = 0.6;
/// How far from s1, relative to the frequency, a record may still show the motion of the other side:
/// it settles there as slowly as a multiplier near −1 lets it.
const SLOW_DOUBLING: f64 = 5e-3;
/// Relative error of a frequency setting.
const SETTING_ERROR: f64 = 2e-4;

impl Jump {
    fn of(bracket: &Bracket, early_scale: f64) -> Self {
        let middle = bracket.middle_hz();
        let known = (SETTING_ERROR * middle).max(0.02 * bracket.width_hz());
        let (setting, stray) = match (bracket.kind, bracket.periods_n) {
            (BoundaryKind::PeriodDoubling, _) => (SLOW_DOUBLING * middle, STRAY),
            (BoundaryKind::SaddleNode, 2..) => (known, STRAY),
            _ => (known, 0.0),
        };
        Self {
            low: bracket.frequency_low_hz,
            high: bracket.frequency_high_hz,
            early: early_scale * middle,
            setting,
            rising: bracket.sweep != crate::record::Sweep::Down,
            stray,
        }
    }

    /// Probability that the jump falls into the bracket when the boundary lies at a frequency, or
    /// is none of this boundary.
    fn probability(&self, boundary: f64) -> f64 {
        let (near, far) = if self.rising {
            (self.low - boundary, self.high - boundary)
        } else {
            (boundary - self.high, boundary - self.low)
        };
        let held = self.cumulative(far) - self.cumulative(near);
        let middle = 0.5 * (self.low + self.high);
        let anywhere = (self.high - self.low) / (STRAY_RANGE * middle);
        ((1.0 - self.stray) * held + self.stray * anywhere).max(1e-280)
    }

    /// Distribution function of (jump − boundary) for a rising sweep: a normal error less an
    /// exponential one.
    fn cumulative(&self, x: f64) -> f64 {
        let (s, e) = (self.setting, self.early);
        let tail = x / e + 0.5 * (s / e).powi(2);
        let mixed = if tail > 600.0 {
            0.0
        } else {
            tail.exp() * normal(-x / s - s / e)
        };
        normal(x / s) + mixed
    }

    /// Boundary frequency at which the bracket is most likely, and that probability.
    fn best(&self) -> (f64, f64) {
        let count = 60;
        let span = self.high - self.low + 4.0 * self.setting;
        (0..=count)
            .map(|i| self.low - 2.0 * self.setting + span * f64::from(i) / f64::from(count))
            .map(|f| (f, self.probability(f)))
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .unwrap_or((0.5 * (self.low + self.high), 1.0))
    }
}

fn normal(x: f64) -> f64 {
    0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)
}

/// Probability that a motion jumps within a bracket when its boundary lies at a frequency, for a
/// scale of early jumps relative to the frequency.
pub fn bracket_probability(bracket: &Bracket, early_scale: f64, boundary_hz: f64) -> f64 {
    Jump::of(bracket, early_scale).probability(boundary_hz)
}

/// Frequency of the boundary of a bracket according to the model, Hz: the crossing nearest to it.
/// `None` where the boundary does not reach this clearance.
pub fn predicted_hz(bracket: &Bracket, parameters: &Parameters, rig: RigKind) -> Option<f64> {
    let machine = match bracket.kind {
        // Exchanged masses double at the same place: an asymmetry changes it in second order only.
        BoundaryKind::PeriodDoubling => parameters.without_asymmetry().machine(rig),
        _ => parameters.machine(rig),
    };
    let middle = parameters.setting(
        bracket.middle_hz(),
        bracket.clearance_m,
        bracket.drive_amplitude,
    );
    let restitution = parameters.restitution.clamp(0.0, 1.0);
    let branch = |eta: f64| Branch::new(&machine, eta, bracket.periods_n);
    let rho = |eta: f64| match bracket.kind {
        BoundaryKind::Grazing => rho_grazing(&machine, eta),
        // not a number where the orbits do not double
        BoundaryKind::PeriodDoubling => {
            s1_of_branch(&machine, &branch(eta), restitution).map_or(f64::NAN, |at| at.0)
        }
        _ => s2_of_branch(&branch(eta), restitution).0 / machine.gap(1.0),
    };
    let eta = nearest_crossing(rho, middle.clearance, middle.frequency_ratio)?;
    Some(eta * parameters.natural_frequency_hz)
}

/// Crossing of ρ(η) with a level nearest to η0: scanned outward, then closed in on.
fn nearest_crossing(rho: impl Fn(f64) -> f64, level: f64, eta0: f64) -> Option<f64> {
    let excess = |eta: f64| rho(eta) - level;
    let here = excess(eta0);
    let step = 0.01;
    // Between two points of opposite sign; where the curve leaps there instead, it crosses nothing.
    let crossing = |low: (f64, f64), high: (f64, f64)| {
        let finite = low.1.is_finite() && high.1.is_finite();
        let root = (finite && low.1.signum() != high.1.signum())
            .then(|| root_between(&excess, low, high))?;
        (excess(root).abs() < 1e-6 * (1.0 + level.abs())).then_some(root)
    };
    let (mut low, mut high) = ((eta0, here), (eta0, here));
    for _ in 0..60 {
        let below = low.0 - step;
        if below > 0.05 {
            let next = (below, excess(below));
            if let Some(root) = crossing(next, low) {
                return Some(root);
            }
            low = next;
        }
        let above = high.0 + step;
        let next = (above, excess(above));
        if let Some(root) = crossing(high, next) {
            return Some(root);
        }
        high = next;
    }
    None
}

/// Root between two points of opposite sign, given with their values: the secant between them, whose older
/// end counts half where it stays (the Illinois rule).
fn root_between(excess: &impl Fn(f64) -> f64, mut old: (f64, f64), mut new: (f64, f64)) -> f64 {
    for _ in 0..100 {
        let eta = new.0 - new.1 * (new.0 - old.0) / (new.1 - old.1);
        let value = excess(eta);
        let step = (eta - new.0).abs();
        if value.signum() == new.1.signum() {
            old.1 *= 0.5;
        } else {
            old = new;
        }
        new = (eta, value);
        if value == 0.0 || step < 1e-13 * eta || (new.0 - old.0).abs() < 1e-13 * eta {
            break;
        }
    }
    new.0
}

impl Block for BoundaryBlock {
    fn items(&self) -> usize {
        self.brackets.len()
    }

    fn residuals(&self, item: usize, parameters: &Parameters) -> Option<Vec<f64>> {
        let bracket = &self.brackets[item];
        let frequency = predicted_hz(bracket, parameters, self.rig)?;
        let jump = Jump::of(bracket, self.early_scale);
        let (best, most) = jump.best();
        // The signed root of twice the loss of log-likelihood: least squares then maximise it.
        let loss = (most.ln() - jump.probability(frequency).ln()).max(0.0);
        Some(vec![(2.0 * loss).sqrt() * (frequency - best).signum()])
    }

    fn touches(&self, coordinate: Coordinate) -> bool {
        Coordinate::PHYSICAL.contains(&coordinate)
            || matches!(
                coordinate,
                Coordinate::DriveAsymmetry | Coordinate::StiffnessAsymmetry
            )
    }
}

#[cfg(test)]
pub(in crate::identify) mod tests {
    use super::*;
    use crate::identify::bracket_midpoints;
    use crate::record::Sweep;
    use impact_oscillator::model::boundary::{rho_s1, rho_s2};

    /// A bracket 2 % wide about the boundary of a kind at η, as the model itself has it; `off_middle`: how far
    /// its middle lies below, in half widths.
    pub(in crate::identify) fn bracket(
        kind: BoundaryKind,
        eta: f64,
        p: &Parameters,
        off_middle: f64,
    ) -> Bracket {
        let machine = p.machine(RigKind::Double);
        let rho = match kind {
            BoundaryKind::SaddleNode => rho_s2(&machine, eta, 1).expect("an s2").rho,
            BoundaryKind::PeriodDoubling => rho_s1(&machine, eta, 1).expect("an s1").rho,
            _ => rho_grazing(&machine, eta),
        };
        let frequency_hz = eta * p.natural_frequency_hz;
        Bracket {
            kind,
            periods_n: 1,
            clearance_m: rho * p.static_deflection_m,
            drive_amplitude: 1.0,
            frequency_low_hz: frequency_hz * (1.0 - 0.01 * (1.0 + off_middle)),
            frequency_high_hz: frequency_hz * (1.0 + 0.01 * (1.0 - off_middle)),
            sweep: Sweep::Up,
            from: "1".into(),
            to: "0".into(),
            records: ["a".into(), "b".into()],
        }
    }

    #[test]
    fn valid_boundaries_lie_where_the_model_has_them() {
        let p = Parameters::symmetric(0.9, 12.6, 0.07, 1e-3);
        let cases = [
            (BoundaryKind::SaddleNode, 1.3),
            (BoundaryKind::Grazing, 1.2),
            (BoundaryKind::PeriodDoubling, 0.85),
        ];
        for (kind, eta) in cases {
            let found = predicted_hz(&bracket(kind, eta, &p, 0.0), &p, RigKind::Double);
            let found = found.expect("a boundary") / p.natural_frequency_hz;
            assert!((found - eta).abs() < 1e-9, "{kind:?} {found}");
        }
    }

    #[test]
    fn valid_a_doubling_determines_restitution_and_middles_do_where_they_are_the_boundary() {
        let p = Parameters::symmetric(0.7, 12.6, 0.05, 1e-3);
        let etas = [1.15, 1.25, 1.35];
        let of = |kind, off: f64| {
            BoundaryBlock::new(
                RigKind::Double,
                &etas.map(|eta| bracket(kind, eta, &p, off)),
            )
        };
        let wrong = Parameters {
            restitution: 0.62,
            ..p
        };
        let r = |off| {
            let found = bracket_midpoints::restitution(&of(BoundaryKind::SaddleNode, off), &wrong);
            found.and_then(|e| e.value).expect("R")
        };
        assert!((r(0.0) - 0.7).abs() < 1e-6);
        // Jumps earlier than s2 by a fifth of a bracket take R down with them.
        assert!(r(0.4) < 0.695);
        assert!(of(BoundaryKind::PeriodDoubling, 0.0).determines_restitution());
        assert!(!of(BoundaryKind::Grazing, 0.0).determines_restitution());
    }
}
