//! Effect of the corner of an integrator's high-pass on the speeds at impacts.
//!
//! With the corner ω_c(1 + ε) in place of the stated ω_c, undoing the high-pass leaves the velocity
//! short by ε ω_c times the displacement (minus its mean, which such a channel does not contain). At
//! impacts the displacement is far from its mean, and both speeds are off by the same amount.

use crate::event::impact::CornerShift;
use crate::event::kinematics::{Body, Kinematics, RelativeSource};
use crate::record::Role;
use crate::signal::interpolation::interpolate;
use crate::signal::{drift, robust};

/// A body's shift at all times.
struct Shift {
    role: Role,
    speeds_m_s: Vec<f64>,
}

/// The shifts of the approach velocity of a record, one per mass.
pub(super) struct Shifts([Option<Shift>; 2]);

impl Shifts {
    /// Of a record whose velocities are free of drift.
    pub(super) fn of(kinematics: &Kinematics) -> Self {
        let rate_hz = kinematics.rate_hz;
        let of = |body: &Body, times: f64| shift(body, times / rate_hz);
        let Kinematics { x, y, .. } = kinematics;
        Self(match kinematics.relative_from {
            Some(RelativeSource::Both) => [of(x, 1.0), of(y, 1.0)],
            Some(RelativeSource::One) => [of(x, 1.0), None],
            Some(RelativeSource::Doubled) => [of(x, 2.0), of(y, 2.0)],
            None => [None, None],
        })
    }

    /// At a time in samples.
    pub(super) fn at(&self, time: f64) -> [Option<CornerShift>; 2] {
        [0, 1].map(|i| {
            let shift = self.0[i].as_ref()?;
            Some(CornerShift {
                role: shift.role,
                speed_m_s: interpolate(&shift.speeds_m_s, time)?,
            })
        })
    }
}

/// ω_c times the displacement by integration, in steps of a time.
fn shift(body: &Body, step_s: f64) -> Option<Shift> {
    let velocity = body.velocity.as_ref()?;
    let corner_hz = velocity.high_pass_hz.filter(|c| *c > 0.0)?;
    let mut sum = 0.0;
    let steps = velocity.values.windows(2).map(|pair| {
        sum += 0.5 * (pair[0] + pair[1]) * step_s * std::f64::consts::TAU * corner_hz;
        sum
    });
    let mut speeds_m_s: Vec<f64> = std::iter::once(0.0).chain(steps).collect();
    let mean = robust::mean(&speeds_m_s);
    drift::remove_line(&mut speeds_m_s, mean, 0.0);
    Some(Shift {
        role: velocity.role,
        speeds_m_s,
    })
}
