//! Quasi-stationary sweeps: the frequency or the clearance moves in small steps, the motion is
//! carried along, and at every step its amplitude, closing speeds and Lyapunov exponent are
//! taken (Figs. 4 and 6 of the paper).

use serde::{Deserialize, Serialize};

use super::lyapunov::Lyapunov;
use crate::model::recurrence::observe;
use crate::model::simulate::{Arc, Sink};
use crate::model::{
    Initial, Machine, ModelError, ModelImpact, Setting, SettledMotion, Simulator, Watch,
};

/// What a sweep goes through.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// (η, ρ) step by step, in the order in which the motion is carried along.
    pub steps: Vec<(f64, f64)>,
    /// Start of the first step.
    #[serde(default)]
    pub start: Initial,
    /// Settling and watch at every step, in drive periods.
    #[serde(default)]
    pub watch: Watch,
}

/// The motion at one step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepPoint {
    /// η
    pub eta: f64,
    /// ρ
    pub rho: f64,
    /// The motion.
    pub motion: SettledMotion,
    /// Greatest displacement X in the watch.
    pub x_max: f64,
    /// Greatest displacement Y in the watch.
    pub y_max: f64,
    /// Closing speeds of the last impacts: one period's of a periodic motion, else up to 64.
    pub closing_speeds: Vec<f64>,
    /// X'₋ of the same impacts.
    pub x_speeds: Vec<f64>,
    /// Phases of the drive at the same impacts, rad.
    pub phases: Vec<f64>,
    /// Largest Lyapunov exponent per unit of τ; `None` where a dead zone wipes it out.
    pub lyapunov: Option<f64>,
}

/// Greatest displacements over arcs, from samples refined where the velocity turns.
#[derive(Debug, Default)]
struct Extremes {
    x: f64,
    y: f64,
}

impl Extremes {
    fn new() -> Self {
        Self {
            x: f64::NEG_INFINITY,
            y: f64::NEG_INFINITY,
        }
    }
}

impl Sink for Extremes {
    fn arc(&mut self, arc: &Arc) {
        self.x = self.x.max(maximum(&arc.paths.x, arc.duration));
        self.y = self.y.max(maximum(&arc.paths.y, arc.duration));
    }
}

/// Greatest value of a path over [0, duration].
fn maximum(path: &crate::model::path::Path, duration: f64) -> f64 {
    let steps = (duration * path.rate() * 8.0).ceil().clamp(2.0, 1e5);
    let at = |k: f64| path.at(duration * k / steps);
    let mut best = at(0.0)[0].max(at(steps)[0]);
    for k in 0..(steps as usize) {
        let (mut lo, mut hi) = (k as f64, k as f64 + 1.0);
        if at(lo)[1] > 0.0 && at(hi)[1] <= 0.0 {
            for _ in 0..50 {
                let mid = 0.5 * (lo + hi);
                if at(mid)[1] > 0.0 { lo = mid } else { hi = mid }
            }
            best = best.max(at(hi)[0]);
        }
    }
    best
}

/// Most impacts told of a motion without a period.
const MOST_IMPACTS: usize = 64;

/// Carry a motion through a sweep; `told` hears every point as it is done and may end the sweep
/// by giving false.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range or the start lies beyond the contact.
pub fn sweep(
    machine: &Machine,
    plan: &Sweep,
    mut told: impl FnMut(&SweepPoint) -> bool,
) -> Result<Vec<SweepPoint>, ModelError> {
    let mut points = Vec::with_capacity(plan.steps.len());
    let Some(&(eta, rho)) = plan.steps.first() else {
        return Ok(points);
    };
    for &(eta, rho) in &plan.steps {
        Setting::new(eta, rho).check()?;
    }
    let start = super::map::clear_of(machine, rho, plan.start);
    let mut simulator = Simulator::new(machine, Setting::new(eta, rho), start)?;
    for &(eta, rho) in &plan.steps {
        simulator.set(eta, rho);
        let point = one_step(machine, &mut simulator, Setting::new(eta, rho), &plan.watch);
        let go_on = told(&point);
        points.push(point);
        if !go_on {
            break;
        }
    }
    Ok(points)
}

fn one_step(
    machine: &Machine,
    simulator: &mut Simulator,
    setting: Setting,
    watch: &Watch,
) -> SweepPoint {
    let period = setting.period();
    simulator.advance(watch.settle_periods * period, &mut |_: &ModelImpact| {});
    let mut follower = simulator.clone();
    let (motion, impacts) = observe(simulator, setting, watch);
    let mut extremes = Extremes::new();
    follower
        .clone()
        .advance(watch.watch_periods * period, &mut extremes);
    let mut lyapunov = Lyapunov::new(machine, setting.frequency_ratio);
    follower.advance(watch.watch_periods * period, &mut lyapunov);
    let count = match motion {
        SettledMotion::Periodic {
            p, chatter: false, ..
        } => usize::from(p),
        _ => MOST_IMPACTS,
    };
    let last = &impacts[impacts.len().saturating_sub(count)..];
    let of = |f: fn(&ModelImpact) -> f64| last.iter().map(f).collect();
    SweepPoint {
        eta: setting.frequency_ratio,
        rho: setting.clearance,
        motion,
        x_max: extremes.x,
        y_max: extremes.y,
        closing_speeds: of(|i| i.closing_before),
        x_speeds: of(|i| i.vx_before),
        phases: of(|i| i.phase),
        lyapunov: Some(lyapunov.exponent()).filter(|l| l.is_finite()),
    }
}

/// Autocorrelation of a uniformly sampled signal at lags 0 … `lags`, mean removed, 1 at lag 0.
pub fn autocorrelation(samples: &[f64], lags: usize) -> Vec<f64> {
    let mean = samples.iter().sum::<f64>() / samples.len().max(1) as f64;
    let centred: Vec<f64> = samples.iter().map(|x| x - mean).collect();
    let at = |lag: usize| -> f64 {
        centred
            .iter()
            .zip(&centred[lag..])
            .map(|(a, b)| a * b)
            .sum()
    };
    let lags = lags.min(samples.len().saturating_sub(1));
    let zero = if samples.is_empty() { 0.0 } else { at(0) };
    let scale = if zero > 0.0 { 1.0 / zero } else { 0.0 };
    (0..=lags)
        .filter(|l| *l < samples.len())
        .map(|l| at(l) * scale)
        .collect()
}
