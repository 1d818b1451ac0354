//! Which motion a simulated motion settles on, from its exact impacts, without noise: period
//! p/n by recurrence of the state at impacts, dead zones, chatter, joined masses, chaos.

use serde::{Deserialize, Serialize};

use super::boundary::rho_grazing;
use super::contact::{Impact, ImpactKind};
use super::motion::{SettledMotion, count};
use super::params::{Flight, Initial, Machine, ModelError, Setting};
use super::simulate::{Arc, Simulator, Sink};

/// How long a simulation settles and is watched.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Watch {
    /// Drive periods before the watch.
    pub settle_periods: f64,
    /// Drive periods watched.
    pub watch_periods: f64,
    /// Closure of a recurring state, relative to the motion's size, that counts as settled.
    pub tolerance: f64,
}

impl Default for Watch {
    fn default() -> Self {
        Self {
            settle_periods: 200.0,
            watch_periods: 60.0,
            tolerance: 1e-5,
        }
    }
}

/// Settle a motion from a start and classify it; with it come its impacts while watched.
///
/// # Errors
/// [`ModelError`] where a parameter is out of range or the start is beyond the contact.
///
/// ```
/// use impact_oscillator::{Initial, Machine, Setting, Watch, settle};
///
/// let machine = Machine::symmetric(0.07, 0.9);
/// let watch = Watch::default();
/// let (motion, impacts) = settle(&machine, Setting::new(1.3, 1.0), Initial::rest(), &watch)?;
/// assert_eq!(motion.label(), "1");
/// assert_eq!(impacts.len(), 60); // one in each drive period of the watch
/// # Ok::<(), impact_oscillator::ModelError>(())
/// ```
pub fn settle(
    machine: &Machine,
    setting: Setting,
    initial: Initial,
    watch: &Watch,
) -> Result<(SettledMotion, Vec<Impact>), ModelError> {
    let mut simulator = Simulator::new(machine, setting, initial)?;
    simulator.advance(
        watch.settle_periods * setting.period(),
        &mut |_: &Impact| {},
    );
    Ok(observe(&mut simulator, setting, watch))
}

/// An impact with the displacement at which it came, which closes the state of two masses.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Return {
    pub(crate) impact: Impact,
    pub(crate) x: f64,
}

/// Impacts of a watch that are kept, some 150 MB: what strikes more often is all but at rest.
const MOST_IMPACTS: usize = 1_000_000;
/// Most impacts of a period that is looked for.
const MOST_OF_A_PERIOD: usize = 5_000;

#[derive(Default)]
struct Returns {
    list: Vec<Return>,
    x: f64,
}

impl Sink for Returns {
    fn arc(&mut self, arc: &Arc) {
        self.x = arc.paths.x.at(arc.duration)[0];
    }
    fn impact(&mut self, impact: &Impact) {
        if self.list.len() < MOST_IMPACTS {
            self.list.push(Return {
                impact: *impact,
                x: self.x,
            });
        }
    }
}

/// Watch a motion that has settled and classify it.
pub(crate) fn observe(
    simulator: &mut Simulator,
    setting: Setting,
    watch: &Watch,
) -> (SettledMotion, Vec<Impact>) {
    let (start, stuck_before) = (simulator.tau(), simulator.is_sticking());
    let mut returns = Returns::default();
    simulator.advance(watch.watch_periods * setting.period(), &mut returns);
    let impacts: Vec<Impact> = returns.list.iter().map(|r| r.impact).collect();
    let still = match impacts.last() {
        None => stuck_before,
        Some(last) => last.dead_zone.is_infinite(),
    };
    let motion = if still && simulator.is_sticking() {
        SettledMotion::Sticking
    } else {
        let interval = (start, simulator.tau());
        of_returns(&returns.list, simulator.machine(), setting, interval, watch)
    };
    (motion, impacts)
}

/// The motion of a machine that had these impacts in an interval of time, and does not stay at rest.
pub(crate) fn of_returns(
    list: &[Return],
    machine: &Machine,
    setting: Setting,
    interval: (f64, f64),
    watch: &Watch,
) -> SettledMotion {
    match list {
        [] if stays_clear(machine, setting) => SettledMotion::Impactless,
        [] => SettledMotion::Beat,
        _ => recurring(list, setting.period(), watch)
            .unwrap_or_else(|| irregular(list, interval, setting.period())),
    }
}

/// Whether the impactless motion never strikes: else a watch without impacts lay between two.
fn stays_clear(machine: &Machine, setting: Setting) -> bool {
    let reach = rho_grazing(machine, setting.frequency_ratio);
    machine.flight != Flight::Harmonic || setting.clearance >= reach * (1.0 - 1e-9)
}

/// Impacts that matter for recurrence: with complete chatters only their ends.
fn essential(list: &[Return]) -> (Vec<Return>, bool) {
    let chatter = list.iter().any(|r| r.impact.kind == ImpactKind::ChatterEnd);
    let sticks = |r: &&Return| {
        !chatter || matches!(r.impact.kind, ImpactKind::ChatterEnd | ImpactKind::Stick)
    };
    (list.iter().filter(sticks).copied().collect(), chatter)
}

/// Smallest lag p at which the last impacts repeat, a whole number of drive periods apart. A
/// motion that still converges, turning, may close first after several of its periods: once
/// any lag closes, the smallest that closes 100 times less tightly counts.
fn recurring(list: &[Return], period: f64, watch: &Watch) -> Option<SettledMotion> {
    let (list, chatter) = essential(list);
    let size = list
        .iter()
        .map(|r| r.impact.approach_speed + r.x.abs())
        .fold(0.0, f64::max);
    let last = list.len() - 1;
    let lag = |tolerance: f64, least: usize| {
        (1..list.len().min(MOST_OF_A_PERIOD)).find(|&p| {
            let checks = p.max(least).min(last - p + 1);
            let cycles = (list[last].impact.tau - list[last - p].impact.tau) / period;
            (0..checks).all(|k| closure(&list[last - k], &list[last - k - p], period) <= tolerance)
                && cycles.round() >= 1.0
        })
    };
    let closed = lag(watch.tolerance * size, 2)?;
    let p = lag(100.0 * watch.tolerance * size, closed)?;
    let n = ((list[last].impact.tau - list[last - p].impact.tau) / period).round();
    Some(SettledMotion::Periodic {
        p: u32::try_from(p).unwrap_or(u32::MAX),
        n: count(n),
        dead_zone: list[last + 1 - p..]
            .iter()
            .any(|r| r.impact.dead_zone > 0.0),
        chatter,
    })
}

/// Distance of two impacts in displacement, velocities and drive phase.
fn closure(a: &Return, b: &Return, period: f64) -> f64 {
    let cycles = (a.impact.tau - b.impact.tau) / period;
    let phase = (cycles - cycles.round()).abs() * std::f64::consts::TAU;
    // at the end of a chatter the speeds are rounding, its place and time are not
    let speeds = if a.impact.kind == ImpactKind::ChatterEnd {
        (a.impact.vx_after - b.impact.vx_after).abs()
    } else {
        (a.impact.vx_before - b.impact.vx_before).abs()
            + (a.impact.vy_before - b.impact.vy_before).abs()
    };
    speeds + (a.x - b.x).abs() + phase * a.impact.approach_speed.max(b.impact.approach_speed)
}

/// Chaotic, or a beat where runs of impacts are separated by long impactless stretches.
fn irregular(list: &[Return], (start, end): (f64, f64), period: f64) -> SettledMotion {
    let mut times = vec![start];
    times.extend(list.iter().map(|r| r.impact.tau));
    times.push(end);
    let quiet = times
        .windows(2)
        .filter(|w| w[1] - w[0] > 5.0 * period)
        .count();
    let runs = times
        .windows(3)
        .filter(|w| w[2] - w[0] < 2.5 * period)
        .count();
    if quiet >= 1 && runs >= 3 {
        SettledMotion::Beat
    } else {
        SettledMotion::Chaotic
    }
}
