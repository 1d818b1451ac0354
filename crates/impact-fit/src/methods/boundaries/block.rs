//! Brackets of boundaries against the closed-form s2, s1 and ρ'.

use crate::methods::boundaries::jump::{Early, Jump};
use crate::parameters::effect::Effect;
use crate::parameters::own::Circumstances;
use crate::parameters::{Coordinate, Parameters};
use crate::solver::Block;
use impact_oscillator::model::boundary::{alternating_of_branch, rho_grazing, s2_of_branch};
use impact_oscillator::model::orbit::Branch;
use impact_records::event::RigKind;
use impact_records::motion::{BoundaryKind, Bracket};
use impact_records::record::Sweep;

/// Share that an alternation between impacts keeps over a cycle up to which records may still show it as a motion: in the
/// twelve cycles of a usual record half of it is left, from which it is hardly told to die away.
const ALTERNATES: f64 = 0.95;

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
                .map(|(b, f)| -Jump::of(b, Early::all(scale)).probability(*f).ln())
                .sum()
        };
        let scales = (0..24).map(|i| 1e-3 * 1.25f64.powi(i));
        if let Some(best) = scales.min_by(|a, b| cost(*a).total_cmp(&cost(*b))) {
            self.early_scale = best;
        }
    }
}

/// Frequency of the boundary of a bracket according to the model, Hz: the crossing nearest to it at which the motion
/// before ends in the direction of the sweep. `None` where the boundary has none at this clearance.
pub fn predicted_hz(bracket: &Bracket, parameters: &Parameters, rig: RigKind) -> Option<f64> {
    BoundaryPlace::of(bracket, parameters, rig).nearest_hz()
}

/// How far above s1 (below where negative), which [`predicted_hz`] gives, records of z = 1/n may still alternate, Hz: up to where
/// an alternation keeps `ALTERNATES` over a cycle. Zero of other boundaries, and where no such place is at the clearance.
pub fn alternating_hz(
    bracket: &Bracket,
    parameters: &Parameters,
    rig: RigKind,
    boundary_hz: f64,
) -> f64 {
    if bracket.kind != BoundaryKind::PeriodDoubling {
        return 0.0;
    }
    let last = BoundaryPlace {
        kept: ALTERNATES,
        ..BoundaryPlace::of(bracket, parameters, rig)
    };
    last.nearest_hz().map_or(0.0, |last| last - boundary_hz)
}

/// A boundary of the model beside a bracket's clearance, with all that acts on its records.
pub struct BoundaryPlace<'a> {
    bracket: &'a Bracket,
    parameters: Parameters,
    rig: RigKind,
    /// What the bracket's clearance is taken to be off, m.
    pub clearance_error_m: f64,
    /// Share that an alternation between impacts keeps over a cycle, where s1 is meant: 1 at s1.
    kept: f64,
}

impl<'a> BoundaryPlace<'a> {
    /// Of a bracket at given parameters.
    pub fn of(bracket: &'a Bracket, parameters: &Parameters, rig: RigKind) -> Self {
        let parameters = match bracket.kind {
            // Exchanged masses double at the same place: an asymmetry changes it in second order only.
            BoundaryKind::PeriodDoubling => parameters.without_asymmetry(),
            _ => *parameters,
        };
        Self {
            bracket,
            parameters,
            rig,
            clearance_error_m: 0.0,
            kept: 1.0,
        }
    }

    /// Its crossing of the clearance nearest to the bracket, Hz.
    fn nearest_hz(&self) -> Option<f64> {
        let natural_hz = self.parameters.natural_frequency_hz;
        let excess = |eta: f64| self.excess(eta * natural_hz);
        let bracket = self.bracket;
        let middle = self.parameters.setting(
            bracket.middle_hz(),
            bracket.clearance_m,
            bracket.drive_amplitude,
        );
        let (level, eta) = (middle.clearance, middle.frequency_ratio);
        let eta = nearest_crossing(excess, level, eta, self.passes())?;
        Some(eta * natural_hz)
    }

    /// How ρ of the boundary passes the clearance as the frequency rises: a motion with impacts is below its s2, one without
    /// them above ρ'.
    fn passes(&self) -> Passes {
        let falls_forward = match self.bracket.kind {
            BoundaryKind::SaddleNode => true,
            BoundaryKind::Grazing => false,
            BoundaryKind::PeriodDoubling | BoundaryKind::Other => return Passes::Either,
        };
        let falls = match self.bracket.sweep {
            Sweep::Up => falls_forward,
            Sweep::Down => !falls_forward,
            Sweep::Unknown => return Passes::Either,
        };
        if falls {
            Passes::Falling
        } else {
            Passes::Rising
        }
    }

    /// ρ of the boundary less that of the bracket's clearance at a drive frequency; not a number where there is
    /// no boundary.
    pub fn excess(&self, frequency_hz: f64) -> f64 {
        let at = self.circumstances(frequency_hz);
        let (own, clearance_m) = self.parameters.own(&at);
        let amplitude = self.bracket.drive_amplitude;
        let setting = own.setting(frequency_hz, clearance_m, amplitude);
        let marginal = self.marginal(&own, setting.frequency_ratio);
        marginal.map_or(f64::NAN, |m| m.rho - setting.clearance)
    }

    /// Where and when the boundary is met. A contact that lasts moves it by what it makes of the marginal orbit's
    /// impact: at a saddle-node the clearance is stationary over the orbits, so that to first order this orbit counts.
    fn circumstances(&self, frequency_hz: f64) -> Circumstances {
        let mut at = Circumstances {
            frequency_hz,
            clearance_m: self.bracket.clearance_m + self.clearance_error_m,
            place: self.bracket.place,
            masses: if self.rig == RigKind::Double {
                2.0
            } else {
                1.0
            },
            ..Circumstances::default()
        };
        if self.parameters.effect(Effect::ContactDuration) != 0.0 {
            let (own, _) = self.parameters.own(&at);
            let eta = frequency_hz / own.natural_frequency_hz;
            if let Some(m) = self.marginal(&own, eta).filter(|m| m.approach_speed > 0.0) {
                let length_m = own.static_deflection_m * self.bracket.drive_amplitude;
                at.approach_m_s = m.approach_speed * length_m * own.natural_rate();
                at.press_per_s = m.press / m.approach_speed * own.natural_rate();
            }
        }
        at
    }

    fn marginal(&self, own: &Parameters, eta: f64) -> Option<Marginal> {
        let machine = own.machine(self.rig);
        let masses = machine.gap(1.0);
        if self.bracket.kind == BoundaryKind::Grazing {
            return Some(Marginal {
                rho: rho_grazing(&machine, eta),
                approach_speed: 0.0,
                press: 0.0,
            });
        }
        let branch = Branch::new(&machine, eta, self.bracket.periods_n);
        let r = own.restitution;
        let (rho, w) = match self.bracket.kind {
            BoundaryKind::PeriodDoubling => alternating_of_branch(&machine, &branch, r, self.kept)?,
            _ => {
                let (gap, w) = s2_of_branch(&branch, r);
                (gap / masses, w)
            }
        };
        let gap = masses * rho;
        let driven = masses * branch.phase(r, gap, w).cos();
        Some(Marginal {
            rho,
            approach_speed: w,
            press: driven - 2.0 * own.damping_ratio * w - gap,
        })
    }
}

/// The orbit at a boundary, dimensionless.
struct Marginal {
    rho: f64,
    approach_speed: f64,
    /// Acceleration toward each other before the impact; of unlike masses as if they were alike.
    press: f64,
}

/// How a curve passes a level.
#[derive(Clone, Copy)]
enum Passes {
    Falling,
    Rising,
    Either,
}

/// Crossing of ρ(η) with a level nearest to η0, by what ρ exceeds it, at which it passes as it is meant to:
/// scanned outward, then closed in on.
fn nearest_crossing(
    excess: impl Fn(f64) -> f64,
    level: f64,
    eta0: f64,
    passes: Passes,
) -> Option<f64> {
    let here = excess(eta0);
    let step = 0.01;
    // Between two points of opposite sign; where the curve leaps there instead, it crosses nothing.
    let crossing = |low: (f64, f64), high: (f64, f64)| {
        let finite = low.1.is_finite() && high.1.is_finite();
        let crosses = low.1.signum() != high.1.signum();
        let meant = match passes {
            Passes::Falling => low.1 > high.1,
            Passes::Rising => low.1 < high.1,
            Passes::Either => true,
        };
        let root = (finite && crosses && meant).then(|| root_between(&excess, low, high))?;
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
        let jump = Jump::of(bracket, Early::all(self.early_scale));
        let (best, most) = jump.best();
        // The signed root of twice the loss of log-likelihood: least squares then maximise it.
        let loss = (most.ln() - jump.probability(frequency).ln()).max(0.0);
        Some(vec![(2.0 * loss).sqrt() * (frequency - best).signum()])
    }

    fn touches(&self, coordinate: Coordinate) -> bool {
        match coordinate {
            Coordinate::DriveAsymmetry
            | Coordinate::StiffnessAsymmetry
            | Coordinate::DampingAsymmetry
            | Coordinate::MassAsymmetry
            | Coordinate::ScrewZero => true,
            // R that a boundary is met with counts as that at the typical speed
            Coordinate::Effect(Effect::RestitutionSpeed) => false,
            Coordinate::Effect(effect) => !effect.is_perturbation(),
            other => Coordinate::PHYSICAL.contains(&other),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::bracket;
    use crate::methods::boundaries::midpoints;
    use impact_oscillator::model::boundary::eta_s2;
    use impact_oscillator::model::orbit::stable_orbit;
    use impact_oscillator::model::params::{Initial, Machine, Setting};
    use impact_oscillator::model::soft::{SoftContact, simulate_soft};

    #[test]
    fn valid_boundaries_lie_where_the_model_has_them() {
        let p = Parameters::symmetric(0.9, 12.6, 0.07, 1e-3);
        let cases = [
            (BoundaryKind::SaddleNode, 1.3),
            (BoundaryKind::Grazing, 0.8),
            (BoundaryKind::PeriodDoubling, 0.85),
        ];
        for (kind, eta) in cases {
            let found = predicted_hz(&bracket(kind, eta, &p, 0.0), &p, RigKind::Double);
            let found = found.expect("a boundary") / p.natural_frequency_hz;
            assert!((found - eta).abs() < 1e-9, "{kind:?} {found}");
        }
    }

    /// Without impacts z = 0 ends at ρ' as the frequency rises below resonance and as it falls above it.
    #[test]
    fn valid_a_motion_ends_where_its_boundary_passes_the_clearance_in_the_direction_of_the_sweep() {
        let p = Parameters::symmetric(0.9, 12.6, 0.07, 1e-3);
        let of = |eta: f64, sweep: Sweep| {
            let mut held = bracket(BoundaryKind::Grazing, eta, &p, 0.0);
            held.sweep = sweep;
            let found = predicted_hz(&held, &p, RigKind::Double).expect("a boundary");
            found / p.natural_frequency_hz
        };
        for (eta, ends_in) in [(0.8, Sweep::Up), (1.2, Sweep::Down)] {
            let other = match ends_in {
                Sweep::Up => Sweep::Down,
                _ => Sweep::Up,
            };
            assert!((of(eta, ends_in) - eta).abs() < 1e-9);
            assert!((of(eta, Sweep::Unknown) - eta).abs() < 1e-9);
            assert!((of(eta, other) - 1.0).signum() != (eta - 1.0f64).signum());
        }
    }

    /// η up to which z = 1 with contacts that last is found in an upward sweep of exact flights and contacts, and the
    /// contacts' duration in natural radians.
    fn simulated_end(machine: &Machine, contact: SoftContact, rho: f64, from: f64) -> [f64; 2] {
        let begin = stable_orbit(machine, Setting::new(from, rho), 1).expect("a setting");
        let begin = begin.expect("z = 1");
        let half = 0.5 * begin.period();
        let mut state = Initial::from(begin.at(half));
        let (mut eta, mut phase) = (from, begin.phase_at_impact + from * half);
        let mut lasting = 0.0;
        loop {
            let setting = Setting::new(eta, rho).at_phase(phase);
            let settled = 250.0 * setting.period();
            let motion =
                simulate_soft(machine, contact, setting, state, settled).expect("a motion");
            let late: Vec<_> = motion
                .contacts
                .iter()
                .filter(|c| c.tau > 0.8 * settled)
                .collect();
            let Some(last) = late.last().filter(|_| late.len() > 40) else {
                return [eta - 0.5 * SWEEP_STEP, lasting];
            };
            lasting = last.duration;
            let end = last.tau - 0.5 * setting.period();
            state = Initial::from(motion.trajectory.at(end));
            phase += eta * end;
            eta += SWEEP_STEP;
        }
    }

    const SWEEP_STEP: f64 = 5e-4;

    #[test]
    fn valid_contacts_that_last_move_the_end_of_z_1_as_far_as_simulated_ones() {
        for (r, rho, stiffness) in [(0.8, 2.0, 5000.0), (0.6, 1.2, 8000.0)] {
            let machine = Machine::symmetric(0.05, r);
            let contact = SoftContact::with_restitution(&machine, stiffness, r).expect("a contact");
            let rigid = eta_s2(&machine, rho, 1).expect("an s2").eta;
            let [end, lasting] = simulated_end(&machine, contact, rho, 0.98 * rigid);
            let p = Parameters::symmetric(r, 12.0, 0.05, 1e-3);
            let length_ms = 1e3 * lasting / p.natural_rate();
            let p = p.with(Coordinate::Effect(Effect::ContactDuration), length_ms);
            let held = Bracket {
                clearance_m: rho * 1e-3,
                ..bracket(BoundaryKind::SaddleNode, rigid, &p, 0.0)
            };
            let found = predicted_hz(&held, &p, RigKind::Double).expect("an end") / 12.0;
            // the contact moves it by 0.4 to 0.6 %
            assert!(rigid - end > 4e-3 * rigid, "{rigid} {end}");
            assert!((found - end).abs() < 1e-3 * end, "{found} {end} {lasting}");
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
            let found = midpoints::restitution(&of(BoundaryKind::SaddleNode, off), &wrong);
            found.and_then(|e| e.value).expect("R")
        };
        assert!((r(0.0) - 0.7).abs() < 1e-6);
        // Jumps earlier than s2 by a fifth of a bracket take R down with them.
        assert!(r(0.4) < 0.695);
        assert!(of(BoundaryKind::PeriodDoubling, 0.0).determines_restitution());
        assert!(!of(BoundaryKind::Grazing, 0.0).determines_restitution());
    }
}
