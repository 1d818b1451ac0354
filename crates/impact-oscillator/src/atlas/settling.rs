//! A motion that still converges is no chaos: it settles on until it recurs.

use super::lyapunov::Lyapunov;
use crate::model::recurrence::observe;
use crate::model::{Impact, Machine, Setting, SettledMotion, Simulator, Watch};

/// How often a converging motion settles on, each time twice as long as before.
const MOST_ROUNDS: i32 = 5;

/// A motion that was settled and watched.
pub(super) struct Settled {
    /// It where the watch began.
    pub begin: Simulator,
    /// What it is.
    pub motion: SettledMotion,
    /// Its impacts while it was watched.
    pub impacts: Vec<Impact>,
}

/// Settle a motion and watch it; one without recurrence whose variations decay is still converging and settles on.
pub(super) fn settle_on(
    machine: &Machine,
    simulator: &mut Simulator,
    setting: Setting,
    watch: &Watch,
) -> Settled {
    let mut round = 0;
    loop {
        let settle = watch.settle_periods * 2_f64.powi(round);
        simulator.advance(settle * setting.period(), &mut |_: &Impact| {});
        let begin = simulator.clone();
        let (motion, impacts) = observe(simulator, setting, watch);
        let last = round == MOST_ROUNDS || settle <= 0.0 || motion != SettledMotion::Chaotic;
        if last || !converges(machine, begin.clone(), setting, watch) {
            return Settled {
                begin,
                motion,
                impacts,
            };
        }
        round += 1;
    }
}

/// Whether variations decay while a motion is watched.
fn converges(machine: &Machine, mut from: Simulator, setting: Setting, watch: &Watch) -> bool {
    let mut lyapunov = Lyapunov::new(machine, setting.frequency_ratio);
    from.advance(watch.watch_periods * setting.period(), &mut lyapunov);
    lyapunov.decays()
}
