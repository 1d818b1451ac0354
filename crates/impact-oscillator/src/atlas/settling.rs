//! A motion that does not recur is chaos only where its variations grow: else it settles on. One that seems to recur
//! after many periods is chaos where they do.

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
        let (mut motion, impacts) = observe(simulator, setting, watch);
        if is_hardly_seen(&motion, watch) {
            let long = Watch {
                watch_periods: watch.watch_periods.max(CHAOTIC_PERIODS),
                ..*watch
            };
            if variations(machine, begin.clone(), setting, &long) == Variations::Grow {
                motion = SettledMotion::Chaotic;
            }
        }
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

/// Whether a motion repeats so late that a watch shows it fewer than four times: weak chaos comes as near. One with a
/// dead zone, which wipes out every variation, is none, and what is only watched is not judged.
pub(super) fn is_hardly_seen(motion: &SettledMotion, watch: &Watch) -> bool {
    let SettledMotion::Periodic { n, dead_zone, .. } = *motion else {
        return false;
    };
    watch.settle_periods > 0.0 && !dead_zone && 4.0 * f64::from(n) > watch.watch_periods
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
