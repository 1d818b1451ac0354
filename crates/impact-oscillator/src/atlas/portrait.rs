//! One motion in full: time series, impacts, Poincaré map at a phase of the drive, and
//! autocorrelation.

use std::f64::consts::TAU;
use std::iter::successors;

use serde::{Deserialize, Serialize};

use super::sweep::autocorrelation;
use crate::model::flight::State;
use crate::model::motion::count;
use crate::model::soft::{SoftContact, simulate_soft};
use crate::model::{Impact, Initial, Machine, ModelError, Setting, Simulator, Trajectory};

/// What is looked at, and for how long.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PortraitPlan {
    /// η, ρ and the drive's phase at τ = 0.
    pub setting: Setting,
    /// The start.
    #[serde(default)]
    pub start: Initial,
    /// Drive periods left out first.
    #[serde(default)]
    pub skip_periods: f64,
    /// Drive periods of the time series.
    pub periods: f64,
    /// Samples of the time series in a drive period.
    #[serde(default = "two_hundred")]
    pub samples_per_period: usize,
    /// Drive periods of the Poincaré map and the autocorrelation, which follow the skipped ones.
    #[serde(default = "five_hundred")]
    pub poincare_periods: usize,
    /// Phase of the drive at which the map is taken, rad.
    #[serde(default)]
    pub poincare_phase: f64,
    /// A contact of finite stiffness instead of Newton's law.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub soft: Option<Soft>,
}

fn two_hundred() -> usize {
    200
}

fn five_hundred() -> usize {
    500
}

/// A Kelvin–Voigt contact whose short impacts have the machine's constant R.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Soft {
    /// Stiffness of the contact over the nominal spring's.
    pub stiffness: f64,
}

/// An instant of a time series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Drive periods since the start.
    pub periods: f64,
    /// X
    pub x: f64,
    /// X'
    pub vx: f64,
    /// Y
    pub y: f64,
    /// Y'
    pub vy: f64,
    /// Whether the masses stick together.
    pub sticking: bool,
}

/// An impact of a time series; a soft contact's begins and ends at different times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Strike {
    /// Drive periods since the start.
    pub periods: f64,
    /// X there.
    pub x: f64,
    /// Phase of the drive, rad in [0, 2π).
    pub phase: f64,
    /// X' + Y' before.
    pub approach_speed: f64,
    /// −(X' + Y') after the impact.
    pub separation_speed: f64,
    /// X' before; `None` for a soft contact.
    pub vx_before: Option<f64>,
    /// X' after.
    pub vx_after: Option<f64>,
    /// Y' before.
    pub vy_before: Option<f64>,
    /// Y' after.
    pub vy_after: Option<f64>,
    /// How long the masses are together, in drive periods.
    pub together_periods: f64,
    /// What kind of impact.
    pub kind: &'static str,
}

/// A motion in full.
#[derive(Debug, Clone, PartialEq)]
pub struct Portrait {
    /// Whether there are two masses.
    pub two_masses: bool,
    /// X + Y at contact.
    pub gap: f64,
    /// The time series.
    pub samples: Vec<Sample>,
    /// Its impacts.
    pub impacts: Vec<Strike>,
    /// (X, X', Y, Y') once a drive period.
    pub poincare: Vec<[f64; 4]>,
    /// Phase of the drive there, rad.
    pub poincare_phase: f64,
    /// (lag in drive periods, autocorrelation of X).
    pub autocorrelation: Vec<(f64, f64)>,
}

/// Samples of X per drive period in its autocorrelation.
const CORRELATED: usize = 24;
/// Longest lag of the autocorrelation, drive periods.
pub const LONGEST_LAG: usize = 20;

/// Simulate a motion and sample it.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range or the start is beyond the contact.
///
/// ```
/// use impact_oscillator::atlas::portrait::{PortraitPlan, portrait};
/// use impact_oscillator::{Initial, Machine, Setting};
///
/// let plan = PortraitPlan {
///     setting: Setting::new(1.3, 1.0),
///     start: Initial::rest(),
///     skip_periods: 300.0,
///     periods: 2.0,
///     samples_per_period: 50,
///     poincare_periods: 40,
///     poincare_phase: 0.0,
///     soft: None,
/// };
/// let motion = portrait(&Machine::symmetric(0.07, 0.9), &plan)?;
/// assert_eq!((motion.samples.len(), motion.impacts.len()), (101, 2));
/// // z = 1: the Poincaré map is one point
/// let [first, .., last] = motion.poincare.as_slice() else { unreachable!() };
/// assert!((first[0] - last[0]).abs() < 1e-6);
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
pub fn portrait(machine: &Machine, plan: &PortraitPlan) -> Result<Portrait, ModelError> {
    let setting = plan.setting;
    let period = setting.period();
    let skip = plan.skip_periods * period;
    let (trajectory, impacts, later) = match plan.soft {
        None => rigid(machine, plan, skip)?,
        Some(soft) => pressed(machine, plan, soft, skip)?,
    };
    let steps = count((plan.periods * plan.samples_per_period as f64).round());
    let taus = super::map::even((skip, skip + plan.periods * period, steps as usize + 1));
    let states = trajectory.sample(taus.iter().copied());
    let sample = |(tau, s): (&f64, &State)| Sample {
        periods: tau / period,
        x: s.x,
        vx: s.vx,
        y: s.y,
        vy: s.vy,
        sticking: trajectory.arc_at(*tau).is_some_and(|arc| arc.sticking),
    };
    Ok(Portrait {
        two_masses: machine.y.is_some(),
        gap: machine.gap(setting.clearance),
        samples: taus.iter().zip(&states).map(sample).collect(),
        impacts,
        poincare: later.poincare,
        poincare_phase: plan.poincare_phase,
        autocorrelation: later.autocorrelation,
    })
}

/// What is taken from the motion's long run.
struct Later {
    poincare: Vec<[f64; 4]>,
    autocorrelation: Vec<(f64, f64)>,
}

type Run = (Trajectory, Vec<Strike>, Later);

fn rigid(machine: &Machine, plan: &PortraitPlan, skip: f64) -> Result<Run, ModelError> {
    let period = plan.setting.period();
    let mut simulator = Simulator::new(machine, plan.setting, plan.start)?;
    simulator.advance(skip, &mut |_: &Impact| {});
    let mut trajectory = Trajectory::default();
    let mut whole = Trajectory::default();
    let long = (plan.poincare_periods as f64 + 0.5) * period;
    let last = first_strobe(plan, skip) - skip + long;
    simulator.clone().advance(last, &mut whole);
    simulator.advance(plan.periods * period, &mut trajectory);
    let strike = |i: &Impact| Strike {
        periods: i.tau / period,
        x: trajectory.at(i.tau).x,
        phase: i.phase,
        approach_speed: i.approach_speed,
        separation_speed: i.separation_speed,
        vx_before: Some(i.vx_before),
        vx_after: Some(i.vx_after),
        vy_before: Some(i.vy_before),
        vy_after: Some(i.vy_after),
        together_periods: i.dead_zone / period,
        kind: i.kind.name(),
    };
    let impacts = trajectory.impacts.iter().map(strike).collect();
    let next = |step: f64| move |tau: &f64| Some(tau + step);
    let times = |from, step, count| successors(Some(from), next(step)).take(count).collect();
    let later = Later::of(plan, skip, &whole, times);
    Ok((trajectory, impacts, later))
}

impl Later {
    /// From a run that is long enough; `times`: even ones by the first, the step and their number.
    fn of(
        plan: &PortraitPlan,
        skip: f64,
        run: &Trajectory,
        times: impl Fn(f64, f64, usize) -> Vec<f64>,
    ) -> Self {
        let (period, count) = (plan.setting.period(), plan.poincare_periods);
        let poincare = times(first_strobe(plan, skip), period, count);
        let even = times(skip, period / CORRELATED as f64, CORRELATED * count);
        let states = run.sample(poincare).into_iter();
        Self {
            poincare: states.map(|s| [s.x, s.vx, s.y, s.vy]).collect(),
            autocorrelation: correlated(&run.sample(even)),
        }
    }
}

/// τ of the first instant at or after the skipped time at which the drive has the map's phase.
fn first_strobe(plan: &PortraitPlan, skip: f64) -> f64 {
    let s = &plan.setting;
    let now = s.phase + s.frequency_ratio * skip;
    let mut lead = (plan.poincare_phase - now).rem_euclid(TAU);
    if TAU - lead < 1e-9 {
        lead = 0.0;
    }
    skip + lead / s.frequency_ratio
}

fn correlated(states: &[State]) -> Vec<(f64, f64)> {
    let x: Vec<f64> = states.iter().map(|s| s.x).collect();
    let lags = (LONGEST_LAG * CORRELATED).min(x.len() / 2);
    let lag = |i: usize| i as f64 / CORRELATED as f64;
    autocorrelation(&x, 0..=lags)
        .into_iter()
        .enumerate()
        .map(|(i, c)| (lag(i), c))
        .collect()
}

fn pressed(
    machine: &Machine,
    plan: &PortraitPlan,
    soft: Soft,
    skip: f64,
) -> Result<Run, ModelError> {
    let period = plan.setting.period();
    let restitution = machine
        .restitution()
        .constant()
        .ok_or(ModelError::Unsupported(
            "a soft contact's damper is chosen from a constant R",
        ))?;
    let contact = SoftContact::with_restitution(machine, soft.stiffness, restitution)?;
    let long = plan.periods.max(plan.poincare_periods as f64 + 1.0) * period;
    let motion = simulate_soft(machine, contact, plan.setting, plan.start, skip + long)?;
    let end = skip + plan.periods * period;
    let strike = |c: &crate::model::soft::SoftImpact| Strike {
        periods: c.tau / period,
        x: motion.trajectory.at(c.tau).x,
        phase: (plan.setting.phase + plan.setting.frequency_ratio * c.tau).rem_euclid(TAU),
        approach_speed: c.approach_speed,
        separation_speed: c.separation_speed,
        vx_before: None,
        vx_after: None,
        vy_before: None,
        vy_after: None,
        together_periods: c.duration / period,
        kind: "soft",
    };
    let within = motion
        .contacts
        .iter()
        .filter(|c| c.tau >= skip && c.tau <= end);
    let impacts = within.map(strike).collect();
    let times = |from: f64, step: f64, count: usize| {
        let even = (0..count).map(|k| from + step * k as f64);
        even.collect()
    };
    let later = Later::of(plan, skip, &motion.trajectory, times);
    Ok((motion.trajectory, impacts, later))
}
