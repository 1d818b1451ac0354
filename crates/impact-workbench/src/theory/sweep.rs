//! A quasi-stationary sweep, there and back, with its characteristics and their figure.

use std::sync::atomic::{AtomicU64, Ordering};

use serde::{Deserialize, Serialize};

use super::context::StudyContext;
use super::plan::SweepPlan;
use crate::figures::sweep::{Characteristics, draw};
use impact_campaign::pipeline::PipelineError;
use impact_campaign::pipeline::table::Table;
use impact_oscillator::atlas::map::even;
use impact_oscillator::atlas::sweep::{Carried, Impactless, LONGEST_LAG, SweepPoint, impactless};
use impact_oscillator::model::Machine;
use impact_oscillator::model::patience::carry;
use impact_oscillator::model::simulate::Snapshot;

/// Steps after which a sweep saves its points.
const KEEP_EVERY: usize = 16;

/// A sweep as far as it has come.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
struct Walked {
    points: Vec<SweepPoint>,
    at: Option<Snapshot>,
}

/// Sweep there and back and write tables and figure.
///
/// # Errors
/// [`PipelineError`] where a parameter is out of range or an output cannot be written.
pub fn run(
    machine: &Machine,
    name: &str,
    plan: &SweepPlan,
    context: &StudyContext<'_>,
) -> Result<(), PipelineError> {
    let (eta, rho) = (
        even((plan.eta.0, plan.eta.1, plan.steps)),
        even((plan.rho.0, plan.rho.1, plan.steps)),
    );
    let steps: Vec<(f64, f64)> = eta.into_iter().zip(rho).collect();
    let back: Vec<(f64, f64)> = steps.iter().rev().copied().collect();
    let (done, all) = (AtomicU64::new(0), 2 * steps.len() as u64);
    let tick = |count: u64| {
        (context.progress)(done.fetch_add(count, Ordering::Relaxed) + count, all);
    };
    let walk = |way: &str, steps: &[(f64, f64)]| {
        let walk = Walk {
            machine,
            name,
            plan,
            context,
        };
        walk.go(way, steps, &tick)
    };
    let (forward, backward) = rayon::join(
        carry(|| walk("forward", &steps)),
        carry(|| walk("backward", &back)),
    );
    let (forward, backward) = (forward?, backward?);
    let impactless: Vec<Impactless> = steps.iter().map(|s| impactless(machine, s.0)).collect();
    context.table(name, &characteristics(machine, &forward, &backward))?;
    context.table(&format!("{name}-impacts"), &impacts(&forward, &backward))?;
    let data = Characteristics {
        forward: &forward,
        backward: &backward,
        impactless: &impactless,
    };
    let title = "Quasi-stationary characteristics";
    context.figure(Some(&draw(&data, name, title)))
}

struct Walk<'a> {
    machine: &'a Machine,
    name: &'a str,
    plan: &'a SweepPlan,
    context: &'a StudyContext<'a>,
}

impl Walk<'_> {
    /// One direction, from where an interrupted run stopped.
    fn go(
        &self,
        way: &str,
        steps: &[(f64, f64)],
        tick: &(dyn Fn(u64) + Sync),
    ) -> Result<Vec<SweepPoint>, PipelineError> {
        let block = format!("{} {way}", self.name);
        let refused = PipelineError::in_study(self.name);
        let mut walked: Walked = self.context.blocks.load(&block).unwrap_or_default();
        tick(walked.points.len() as u64);
        let Some(&first) = steps.first() else {
            return Ok(Vec::new());
        };
        let watch = self.plan.watch;
        let mut carried = match &walked.at {
            Some(snapshot) => Carried::resume(self.machine, snapshot, watch),
            None => Carried::start(self.machine, first, self.plan.start, watch),
        }
        .map_err(&refused)?;
        for &at in &steps[walked.points.len()..] {
            walked.points.push(carried.step(at).map_err(&refused)?);
            tick(1);
            if walked.points.len().is_multiple_of(KEEP_EVERY) {
                walked.at = Some(carried.snapshot());
                self.context.blocks.save(&block, &walked)?;
            }
        }
        Ok(walked.points)
    }
}

type Directed<'a> = (&'static str, &'a SweepPoint);

fn directed<'a>(
    forward: &'a [SweepPoint],
    backward: &'a [SweepPoint],
) -> impl Iterator<Item = Directed<'a>> + Clone {
    let mark = |way: &'static str| move |p| (way, p);
    let back = backward.iter().map(mark("backward"));
    forward.iter().map(mark("forward")).chain(back)
}

fn characteristics(machine: &Machine, forward: &[SweepPoint], backward: &[SweepPoint]) -> Table {
    let all = directed(forward, backward);
    let of = |f: fn(&SweepPoint) -> f64| all.clone().map(move |(_, p)| f(p));
    let maybe = |f: fn(&SweepPoint) -> Option<f64>| all.clone().map(move |(_, p)| f(p));
    let free: Vec<Impactless> = all
        .clone()
        .map(|(_, p)| impactless(machine, p.eta))
        .collect();
    let greatest = |v: &[f64]| v.iter().copied().reduce(f64::max);
    let least = |v: &[f64]| v.iter().copied().reduce(f64::min);
    let speeds = all.clone().map(|(_, p)| &p.approach_speeds);
    let mut table = Table::new()
        .texts("direction", all.clone().map(|(way, _)| way))
        .numbers("eta", of(|p| p.eta))
        .numbers("rho", of(|p| p.rho))
        .texts("motion", all.clone().map(|(_, p)| p.motion.label()))
        .numbers("x_max", of(|p| p.x_max));
    if machine.y.is_some() {
        table = table.numbers("y_max", of(|p| p.y_max));
    }
    table = table
        .missing("closing_speed_least", speeds.clone().map(|v| least(v)))
        .missing("closing_speed_greatest", speeds.map(|v| greatest(v)))
        .missing("lyapunov_exponent", maybe(|p| p.lyapunov))
        .missing("lyapunov_standard_error", maybe(|p| p.lyapunov_error));
    for lag in 0..LONGEST_LAG {
        let values = all
            .clone()
            .map(|(_, p)| p.autocorrelation.get(lag).copied());
        table = table.missing(&format!("autocorrelation_{}_periods", lag + 1), values);
    }
    table = table
        .numbers("impactless_amplitude_x", free.iter().map(|f| f.x.0))
        .numbers("impactless_phase_x_rad", free.iter().map(|f| f.x.1));
    if machine.y.is_some() {
        table = table
            .missing("impactless_amplitude_y", free.iter().map(|f| Some(f.y?.0)))
            .missing("impactless_phase_y_rad", free.iter().map(|f| Some(f.y?.1)));
    }
    table
}

/// One row for every impact: one period's of a periodic motion, else the last ones.
fn impacts(forward: &[SweepPoint], backward: &[SweepPoint]) -> Table {
    let rows: Vec<(Directed<'_>, usize)> = directed(forward, backward)
        .flat_map(|d| (0..d.1.approach_speeds.len()).map(move |i| (d, i)))
        .collect();
    let of = |f: fn(&SweepPoint, usize) -> f64| rows.iter().map(move |((_, p), i)| f(p, *i));
    Table::new()
        .texts("direction", rows.iter().map(|((way, _), _)| *way))
        .numbers("eta", of(|p, _| p.eta))
        .numbers("rho", of(|p, _| p.rho))
        .numbers("phase_rad", of(|p, i| p.phases[i]))
        .numbers("closing_speed", of(|p, i| p.approach_speeds[i]))
        .numbers("x_velocity_before", of(|p, i| p.x_speeds[i]))
}
