//! How long a contact lasts, from how the velocity falls from one flight to the next.

use crate::event::free_flight::stretch::Stretch;
use crate::event::kinematics::Body;

/// Variance of the press of a linear contact over time, in squares of its duration: that of half a sine.
const HALF_SINE: f64 = 0.047_36;
/// Variance that a central difference adds, in squares of a sample.
const CENTRAL_DIFFERENCE: f64 = 1.0 / 3.0;
/// Variance that lines between the samples add.
const BETWEEN_SAMPLES: f64 = 1.0 / 12.0;
/// Duration from which a contact is resolved, samples.
const RESOLVED: f64 = 2.0;
/// Relative difference up to which a velocity is the central difference of a displacement.
const DIFFERENTIATED: f64 = 0.02;

/// A contact that the samples resolve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Contact {
    /// Duration, samples.
    pub duration: f64,
    /// From first touch to the centre of the impulse, samples.
    pub to_centre: f64,
}

impl Contact {
    /// Standard error of either end, samples.
    pub(super) fn error(&self) -> f64 {
        (0.15 * self.duration).max(0.3)
    }
}

/// The contact between two flights whose displacements cross at `time`; `None` if its duration cannot be
/// told from an instant.
pub(super) fn contact(
    relative: &[f64],
    (before, after): (&[Stretch], &[Stretch]),
    time: f64,
    smoothed: bool,
) -> Option<Contact> {
    let from = before.iter().map(|s| s.samples.1.saturating_sub(1)).min()?;
    let to = after.iter().map(|s| s.samples.0).max()?;
    let speed = |flights: &[Stretch], t: f64| flights.iter().map(|s| s.speed(t)).sum::<f64>();
    // The share of the fall that is still to come; twice its first moment about the centre, folded there,
    // is the variance of the press.
    let mut variance = 0.0;
    for i in from..=to {
        let t = i as f64;
        let (early, late) = (speed(before, t), speed(after, t));
        let left = ((relative[i] - late) / (early - late)).clamp(-0.1, 1.1);
        let share = if t < time { 1.0 - left } else { left };
        variance += 2.0 * share * (t - time).abs();
    }
    let added = BETWEEN_SAMPLES + if smoothed { CENTRAL_DIFFERENCE } else { 0.0 };
    let duration = ((variance - added).max(0.0) / HALF_SINE).sqrt();
    let ratio = (-speed(after, time) / speed(before, time)).clamp(0.0, 1.0);
    (duration >= RESOLVED).then_some(Contact {
        duration,
        // Half of it for an elastic contact, less for a damped one, which presses early.
        to_centre: 0.5 * ratio.powf(0.38) * duration,
    })
}

/// Whether a velocity is the central difference of a displacement: derived here, or by the instrument.
pub(super) fn is_smoothed(body: &Body, rate_hz: f64) -> bool {
    let (Some(velocity), Some(displacement)) = (&body.velocity, &body.displacement) else {
        return false;
    };
    if velocity.role == displacement.role {
        return true;
    }
    let x = &displacement.values;
    let (mut apart, mut all) = (0.0, 0.0);
    for (i, v) in velocity.values.iter().enumerate() {
        let (Some(next), Some(last)) = (x.get(i + 1), i.checked_sub(1).and_then(|i| x.get(i)))
        else {
            continue;
        };
        apart += (v - 0.5 * (next - last) * rate_hz).powi(2);
        all += v * v;
    }
    apart <= DIFFERENTIATED * DIFFERENTIATED * all
}
