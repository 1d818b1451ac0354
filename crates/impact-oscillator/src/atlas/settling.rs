//! A motion that does not recur is chaos only where its variations grow: else it settles on.

use super::lyapunov::{Lyapunov, Variations};
use crate::model::recurrence::observe;
use crate::model::{Impact, Machine, Setting, SettledMotion, Simulator, Watch};

/// How often a motion that is no chaos settles on, each time twice as long as before.
pub(super) const MOST_ROUNDS: i32 = 5;

/// Drive periods that the exponent of a motion is followed that may be chaotic.
pub(super) const CHAOTIC_PERIODS: f64 = 1000.0;

/// A motion that was settled and watched.
pub(super) struct Settled {
    /// It where the watch began.
    pub begin: Simulator,
    /// What it is.
    pub motion: SettledMotion,
    /// Its impacts while it was watched.
    pub impacts: Vec<Impact>,
}

/// Settle a motion and watch it; one without recurrence whose variations do not grow settles on. A watch without
/// settling is of what is now, which is not judged.
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
        let open = motion == SettledMotion::Chaotic
            && settle > 0.0
            && variations(machine, begin.clone(), setting, watch) != Variations::Grow;
        if !open || round == MOST_ROUNDS {
            let motion = if open {
                SettledMotion::NotSettled
            } else {
                motion
            };
            return Settled {
                begin,
                motion,
                impacts,
            };
        }
        round += 1;
    }
}

/// What becomes of a motion's variations while it is watched, and longer where that leaves it open.
pub(super) fn variations(
    machine: &Machine,
    mut from: Simulator,
    setting: Setting,
    watch: &Watch,
) -> Variations {
    let mut lyapunov = Lyapunov::new(machine, setting.frequency_ratio);
    from.advance(watch.watch_periods * setting.period(), &mut lyapunov);
    if lyapunov.variations() == Variations::Open {
        let more = (CHAOTIC_PERIODS - watch.watch_periods).max(0.0);
        from.advance(more * setting.period(), &mut lyapunov);
    }
    lyapunov.variations()
}
