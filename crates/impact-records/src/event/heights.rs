//! Impacts that are listed by the heights before and after them.

use crate::event::impact::{DetectionSource, Impact};
use crate::record::ListedTimes;

/// Gravity, m/s², by which heights stand for speeds and times: R does not depend on it.
pub const GRAVITY_M_S2: f64 = 9.81;

/// Between a last top and the next drop, s: impacts so far apart beyond their flight are not of one drop.
const BETWEEN_DROPS_S: f64 = 1.0;

/// Impacts between heights, with NaN between drops, as one drop after the other would have them.
pub(super) fn by_heights(heights_m: &[f64], known: ListedTimes) -> Vec<Impact> {
    let (mut impacts, mut drop_s) = (Vec::new(), 0.0);
    for drop in heights_m.split(|h| h.is_nan()) {
        let speed = |height_m: f64| (2.0 * GRAVITY_M_S2 * height_m).sqrt();
        for pair in drop.windows(2) {
            let [before, after] = [pair[0], pair[1]].map(speed);
            let fall_s = before / GRAVITY_M_S2;
            let by_digit_s = known.digit_m / before;
            let stated = Some(GRAVITY_M_S2 * known.height_m / before);
            impacts.push(Impact {
                approach_speed_before_m_s: Some(before),
                approach_speed_after_m_s: Some(-after),
                speed_errors_m_s: stated
                    .filter(|_| known.height_m > 0.0)
                    .map(|error| [error; 2]),
                source: DetectionSource::Heights,
                ..Impact::timed(drop_s + fall_s, by_digit_s)
            });
            // the rise, and the fall of the next one
            drop_s += fall_s + after / GRAVITY_M_S2;
        }
        drop_s += BETWEEN_DROPS_S;
    }
    impacts
}
