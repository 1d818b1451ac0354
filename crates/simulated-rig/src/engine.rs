//! The motion of a virtual rig: exact flights and Newton's impacts where the model holds,
//! integration in small steps where an effect goes beyond it.

use impact_oscillator::model::Impact;
use impact_oscillator::model::params::{Initial, ModelError, Setting};
use impact_oscillator::model::simulate::{Simulator, Trajectory};

use super::equations::{ContactModel, Equations, Phase4};
use super::integrate::{Hit, Integrator, Recording};
use super::laboratory::Laboratory;
use super::plan::Step;
use impact_records::signal::whole;

/// A motion that goes on through a sweep, in units of the nominal `x_st` and 1/Ω.
#[derive(Debug, Clone)]
pub enum Engine {
    /// Of the model.
    Exact(Box<Simulator>),
    /// With effects beyond the model.
    Integrated(Box<Integrator>),
}

/// A recorded stretch of motion.
#[derive(Debug, Clone)]
pub enum Recorded {
    /// Of the model.
    Exact(Trajectory),
    /// Of an integration.
    Integrated(Recording),
}

impl Laboratory {
    /// A motion from rest at the first setting of a sweep, number `index` of the campaign.
    ///
    /// # Errors
    /// [`ModelError`] if a parameter is out of range.
    pub fn at_rest(&self, index: usize, step: &Step) -> Result<Engine, ModelError> {
        let machine = self.truth.machine();
        let exact = Simulator::new(&machine, self.setting(step), Initial::rest())?;
        if self.effects.motion_is_exact() {
            return Ok(Engine::Exact(Box::new(exact)));
        }
        self.integrated(index, step)
    }

    /// The same by integration, whatever the effects.
    ///
    /// # Errors
    /// [`ModelError`] if a contact of finite duration cannot have the restitution.
    pub fn integrated(&self, index: usize, step: &Step) -> Result<Engine, ModelError> {
        let equations = self.equations(self.law()?, index, step);
        Ok(Engine::Integrated(Box::new(Integrator::at_rest(equations))))
    }

    /// η and ρ of a step, the gap as it is.
    pub fn setting(&self, step: &Step) -> Setting {
        Setting::new(
            step.frequency_hz / self.truth.natural_frequency_hz(),
            self.effects.true_clearance_m(step.clearance_m) / self.truth.static_deflection_m(),
        )
    }

    fn law(&self) -> Result<ContactModel, ModelError> {
        ContactModel::new(&self.truth, &self.effects)
    }

    fn equations(&self, law: ContactModel, index: usize, step: &Step) -> Equations {
        let last = self.plan.steps.len().saturating_sub(1);
        let elapsed = if last > 0 {
            index as f64 / last as f64
        } else {
            0.5
        };
        Equations::new(&self.truth, &self.effects, law, step, elapsed)
    }

    /// Change a motion's setting to step number `index`.
    pub fn set(&self, engine: &mut Engine, index: usize, step: &Step) {
        match engine {
            Engine::Exact(simulator) => {
                let setting = self.setting(step);
                simulator.set(setting.frequency_ratio, setting.clearance);
            }
            Engine::Integrated(integrator) => {
                let law = integrator.law();
                integrator.set(self.equations(law, index, step));
                if let Some(restarts) = self.effects.restarts {
                    integrator.shift_phase(restarts.jump_rad(index));
                }
            }
        }
    }
}

/// Longest period, in drive periods, of a motion whose settling is ended early.
const SHORT_PERIOD: usize = 4;
/// Relative closure of a motion that has settled.
const SETTLED: f64 = 1e-8;

/// Whether states strobed once in a drive period repeat to rounding: after one to four periods,
/// and that three times in a row.
pub fn repeats(states: &[Phase4]) -> bool {
    let size = states.iter().flatten().fold(1e-9f64, |m, v| m.max(v.abs()));
    let close = |a: &Phase4, b: &Phase4| {
        let mut pairs = a.iter().zip(b);
        pairs.all(|(a, b)| (a - b).abs() < SETTLED * size)
    };
    (1..=SHORT_PERIOD).any(|n| {
        let Some(first) = states.len().checked_sub(4 * n) else {
            return false;
        };
        (first + n..states.len()).all(|i| close(&states[i], &states[i - n]))
    })
}

impl Engine {
    /// Whether it is the motion of the model.
    pub fn is_exact(&self) -> bool {
        matches!(self, Self::Exact(_))
    }

    /// Go on for a time; an integration ends sooner, by whole drive periods, if the motion repeats
    /// to rounding before.
    pub fn settle(&mut self, duration: f64, period: f64) {
        if self.is_exact() {
            self.advance(duration);
            return;
        }
        let periods = (duration / period).floor();
        let mut states = Vec::new();
        for _ in 0..whole::index(periods) {
            self.advance(period);
            states.push(self.state());
            if repeats(&states) {
                break;
            }
        }
        self.advance(duration - periods * period);
    }

    /// Time reached.
    pub fn tau(&self) -> f64 {
        match self {
            Self::Exact(s) => s.tau(),
            Self::Integrated(i) => i.tau(),
        }
    }

    /// Phase of the drive, rad in [0, 2π).
    pub fn phase(&self) -> f64 {
        match self {
            Self::Exact(s) => s.phase(),
            Self::Integrated(i) => i.phase(),
        }
    }

    /// [X, X', Y, Y'].
    pub fn state(&self) -> Phase4 {
        match self {
            Self::Exact(s) => {
                let s = s.state();
                [s.x, s.vx, s.y, s.vy]
            }
            Self::Integrated(i) => i.state(),
        }
    }

    /// Go on for a time; gives the number of impacts and of those with a dead zone.
    pub fn advance(&mut self, duration: f64) -> [usize; 2] {
        match self {
            Self::Exact(simulator) => {
                let mut counts = [0; 2];
                simulator.advance(duration, &mut |impact: &Impact| {
                    counts[0] += 1;
                    counts[1] += usize::from(impact.dead_zone > 0.0);
                });
                counts
            }
            Self::Integrated(integrator) => {
                let before = integrator.counts();
                integrator.advance(duration);
                let after = integrator.counts();
                [after[0] - before[0], after[1] - before[1]]
            }
        }
    }

    /// Go on for a time and record it.
    pub fn record(&mut self, duration: f64) -> Recorded {
        match self {
            Self::Exact(simulator) => {
                let mut trajectory = Trajectory::default();
                simulator.advance(duration, &mut trajectory);
                Recorded::Exact(trajectory)
            }
            Self::Integrated(integrator) => Recorded::Integrated(integrator.record(duration)),
        }
    }
}

impl Recorded {
    /// The motion at many times in rising order.
    pub fn sample(&self, taus: impl IntoIterator<Item = f64>) -> Vec<Phase4> {
        match self {
            Self::Exact(trajectory) => {
                let states = trajectory.sample(taus).into_iter();
                states.map(|s| [s.x, s.vx, s.y, s.vy]).collect()
            }
            Self::Integrated(recording) => recording.sample(taus),
        }
    }

    /// Its impacts in the order of time.
    pub fn impacts(&self) -> Vec<Hit> {
        match self {
            Self::Exact(trajectory) => {
                let hit = |i: &Impact| Hit {
                    tau: i.tau,
                    approach: i.approach_speed,
                    separation: i.separation_speed,
                    duration: 0.0,
                    dead_zone: i.dead_zone,
                };
                trajectory.impacts.iter().map(hit).collect()
            }
            Self::Integrated(recording) => recording.hits.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Harmonic, RigEffects};
    use crate::plan::Plan;
    use crate::truth::{Differences, Faults, Truth};
    use impact_records::record::Sweep;

    fn step(eta: f64, rho: f64) -> Step {
        Step {
            frequency_hz: 10.0 * eta,
            clearance_m: 1e-3 * rho,
            sweep: Sweep::Up,
            from_rest: true,
        }
    }

    fn laboratory(truth: Truth, effects: RigEffects, steps: Vec<Step>) -> Laboratory {
        Laboratory {
            truth,
            faults: Faults::default(),
            effects,
            clearance_uncertainty_m: None,
            plan: Plan { steps },
            rig_seed: 1,
            seed: 1,
        }
    }

    #[test]
    fn valid_integration_meets_the_exact_motion() {
        // z = 1, a small gap, plastic impacts with dead zones, chatter, nothing touches
        let cases = [
            (0.8, 1.25, 1.0),
            (0.9, 2.9, 0.35),
            (0.0, 0.95, 0.7),
            (0.3, 0.6, 0.3),
            (0.9, 1.1, 30.0),
        ];
        for (r, eta, rho) in cases {
            let truth = Truth::symmetric(r, 10.0, 0.07, 1e-3).with_differences(&Differences {
                force: 0.02,
                stiffness: -0.01,
                dashpot: 0.05,
                mass: 0.03,
            });
            let step = step(eta, rho);
            let laboratory = laboratory(truth, RigEffects::default(), vec![step]);
            let mut exact = laboratory.at_rest(0, &step).unwrap();
            let mut integrated = laboratory.integrated(0, &step).unwrap();
            assert!(matches!(exact, Engine::Exact(_)));
            let pair = [exact.record(40.0), integrated.record(40.0)];
            let taus = || (0..4000).map(|i| 0.01 * f64::from(i));
            let (a, b) = (pair[0].sample(taus()), pair[1].sample(taus()));
            for (i, (a, b)) in a.iter().zip(&b).enumerate() {
                // displacements: a velocity jumps at an impact
                let error = (a[0] - b[0]).abs().max((a[2] - b[2]).abs());
                assert!(error < 2e-6, "{r} {eta} {rho}: {error} at {i}");
            }
            let fast = |i: &Hit| i.approach > 0.05;
            let [a, b] = pair.map(|p| p.impacts().into_iter().filter(fast).collect::<Vec<_>>());
            assert_eq!(a.len(), b.len(), "{r} {eta} {rho}");
            for (a, b) in a.iter().zip(&b) {
                assert!((a.tau - b.tau).abs() < 2e-6 && (a.approach - b.approach).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn valid_drive_harmonics_superpose() {
        // Linear flight: X is the sum of the responses a/(1 − n²η² + 2iβnη) to each harmonic.
        let truth = Truth::symmetric(0.9, 10.0, 0.07, 1e-3);
        let harmonics = [(1.0, 1.0, 0.0), (2.0, 0.02, 0.7), (3.0, 0.01, -2.0)];
        let harmonic = |i: usize| Harmonic {
            amplitude: harmonics[i].1,
            phase_rad: harmonics[i].2,
        };
        let effects = RigEffects {
            second_harmonic: harmonic(1),
            third_harmonic: harmonic(2),
            force_slope: 0.1,
            force_curvature: 0.05,
            ..RigEffects::default()
        };
        let eta = 1.3;
        let step = step(eta, 30.0);
        let mut engine = laboratory(truth, effects, vec![step])
            .at_rest(0, &step)
            .unwrap();
        engine.advance(60.0 * std::f64::consts::TAU);
        let (start, phase) = (engine.tau(), engine.phase());
        let recorded = engine.record(10.0);
        let force = 1.0 + 0.1 * 0.3 + 0.05 * 0.09;
        for i in 0..900 {
            let t = 0.01 * f64::from(i);
            let expected: f64 = harmonics
                .iter()
                .map(|(n, a, p)| {
                    let (re, im) = (1.0 - n * n * eta * eta, 2.0 * 0.07 * n * eta);
                    let angle = n * (phase + eta * t) + p - im.atan2(re);
                    force * a / re.hypot(im) * angle.cos()
                })
                .sum();
            let x = recorded.sample([start + t])[0][0];
            assert!((x - expected).abs() < 1e-6, "{t}: {x} {expected}");
        }
    }

    #[test]
    fn valid_f0_drifts_about_its_mean() {
        // slow drive far below resonance: X = F/κ, κ = (1 + d(s − ½))²
        let truth = Truth::symmetric(0.9, 10.0, 0.3, 1e-3);
        let effects = RigEffects {
            frequency_drift: 0.1,
            ..RigEffects::default()
        };
        let step = step(0.01, 30.0);
        let laboratory = laboratory(truth, effects, vec![step; 3]);
        for (index, ratio) in [(0, 0.95f64), (1, 1.0), (2, 1.05)] {
            let mut engine = laboratory.at_rest(index, &step).unwrap();
            engine.advance(std::f64::consts::TAU / 0.01);
            let expected = 1.0 / (ratio * ratio);
            assert!((engine.state()[0] / expected - 1.0).abs() < 1e-3);
        }
    }
}
