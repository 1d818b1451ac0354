//! Samples of the velocities that were taken while a contact lasted.

use crate::event::arcs::{Arcs, DEGREE, Instant, flights};
use crate::event::kinematics::{Body, Series};
use crate::record::Role;

/// Least height of a jump, in noise deviations, from which its samples are used.
const CLEAR_JUMP: f64 = 25.0;
/// Error of a sample's share beside the noise: what the flights' extrapolation leaves open.
const SHARE_ERROR: f64 = 0.01;
/// Greatest error of an impact's time, in samples, with which its samples are used.
const LEAST_PLACED: f64 = 0.6;

/// A sample beside an impact: when, from the contact's centre, and how far the velocity has gone.
#[derive(Debug, Clone, Copy)]
pub(super) struct Passage {
    pub offset: f64,
    pub share: f64,
    pub share_error: f64,
}

/// The samples of both bodies (x: 0, y: 1) beside one impact.
#[derive(Debug, Clone)]
pub(super) struct Samples {
    pub time_error: f64,
    pub passages: Vec<(Passage, usize)>,
}

/// A body's velocity if it was measured as such: differentiated displacements smear every jump.
pub(super) fn measured_velocity(body: &Body) -> Option<&Series> {
    let velocity = body.velocity.as_ref()?;
    matches!(velocity.role, Role::VelocityX | Role::VelocityY).then_some(velocity)
}

/// The samples of one impact, with the error of its time; `None` if it is too weak or its time
/// too uncertain.
pub(super) fn samples(
    bodies: [Option<&Series>; 2],
    arcs: Arcs<'_>,
    index: usize,
    instant: Instant,
) -> Option<Samples> {
    if arcs.candidates[index].dead_samples > 0.0 || instant.error > LEAST_PLACED {
        return None;
    }
    let mut out = Samples {
        time_error: instant.error,
        passages: Vec::new(),
    };
    for (body, velocity) in bodies.into_iter().enumerate() {
        let Some(velocity) = velocity else { continue };
        let [before, after] = flights(velocity, arcs, index)?;
        let height = before.value(instant.time) - after.value(instant.time);
        let full = before.samples.min(after.samples) > DEGREE + 1;
        if !full || height < CLEAR_JUMP * velocity.noise {
            return None;
        }
        let found = beside(velocity, arcs, index, instant);
        out.passages.extend(found.into_iter().map(|p| (p, body)));
    }
    (!out.passages.is_empty()).then_some(out)
}

/// Samples within the jump of one impact.
pub(super) fn beside(
    velocity: &Series,
    arcs: Arcs<'_>,
    index: usize,
    instant: Instant,
) -> Vec<Passage> {
    let jump = arcs.candidates[index].jump;
    let Some([before, after]) = flights(velocity, arcs, index) else {
        return Vec::new();
    };
    let height = before.value(instant.time) - after.value(instant.time);
    let last = (jump.left + jump.gap).min(velocity.values.len());
    (jump.left + 1..last)
        .map(|k| {
            let at = k as f64;
            let (b, a) = (before.value(at), after.value(at));
            let spread = 1f64.hypot(before.error_factor(at).max(after.error_factor(at)));
            Passage {
                offset: at - instant.time,
                share: (b - velocity.values[k]) / (b - a),
                share_error: (velocity.noise * spread / height).hypot(SHARE_ERROR),
            }
        })
        .collect()
}
