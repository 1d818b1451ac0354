//! On which motion a simulated rig has settled.

use super::engine::{Engine, repeats};
use impact_oscillator::model::params::Setting;
use impact_records::motion::{Motion, Undetermined};

/// Largest period looked for in the noiseless motion, drive periods.
const LONGEST: usize = 16;
/// Drive periods over which the noiseless motion must repeat itself.
const WATCHED: usize = 96;
/// Relative closure of a periodic noiseless motion.
const CLOSED: f64 = 1e-3;

/// The motion after a record according to the noiseless simulation itself: states strobed once a
/// drive period must repeat after n periods within a thousandth of the motion's size.
pub(super) fn true_motion(mut engine: Engine, setting: Setting) -> Motion {
    let mut states = Vec::with_capacity(WATCHED);
    let mut counts = Vec::with_capacity(WATCHED);
    let mut dead_zones = 0;
    for _ in 0..WATCHED {
        let [count, dead] = engine.advance(setting.period());
        dead_zones += dead;
        states.push(engine.state());
        counts.push(count);
        if !engine.is_exact() && repeats(&states) {
            break;
        }
    }
    let watched = states.len();
    let size = states
        .iter()
        .flatten()
        .fold(0.0f64, |m, v| m.max(v.abs()))
        .max(1e-9);
    let closes = |n: usize| {
        n < watched
            && (n..watched).all(|i| {
                states[i]
                    .iter()
                    .zip(states[i - n])
                    .all(|(a, b)| (a - b).abs() < CLOSED * size)
                    && counts[i] == counts[i - n]
            })
    };
    let impacts: usize = counts.iter().sum();
    match (1..=LONGEST.min(watched)).find(|n| closes(*n)) {
        Some(1) if impacts == 0 => Motion::Impactless,
        Some(n) => Motion::Periodic {
            impacts_p: u32::try_from(counts[..n].iter().sum::<usize>()).unwrap_or(u32::MAX),
            periods_n: u32::try_from(n).unwrap_or(u32::MAX),
            dead_zone: 2 * dead_zones >= impacts.max(1),
        },
        None => Motion::Undetermined {
            reason: Undetermined::NotPeriodic,
        },
    }
}
