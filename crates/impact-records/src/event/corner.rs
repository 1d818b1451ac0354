//! Effect of the corner of an integrator's high-pass on the speeds at impacts.
//!
//! With the corner `ω_c(1` + ε) in place of the stated `ω_c`, undoing the high-pass leaves the velocity
//! short by ε `ω_c` times the displacement (minus its mean, which such a channel does not contain). At
//! impacts the displacement is far from its mean, and both speeds are off by the same amount, less the line that
//! is removed from the velocity with its drift.

use crate::event::drift;
use crate::event::drive::DriveTone;
use crate::event::impact::CornerShift;
use crate::event::kinematics::{Body, Kinematics, RelativeSource, Series};
use crate::signal::interpolation::interpolate;

/// The shifts of the approach velocity of a record at all times, one per mass.
pub(super) struct Shifts([Option<Series>; 2]);

impl Shifts {
    /// Of a record whose velocities are free of drift, with impacts at times in samples.
    pub(super) fn of(kinematics: &Kinematics, times: &[f64], drive: Option<&DriveTone>) -> Self {
        let of = |body: &Body, factor: f64| {
            let velocity = body.velocity.as_ref()?;
            let mut shift = shift(velocity, factor / kinematics.rate_hz)?;
            drift::remove_drift(&mut shift, times, drive, kinematics.rate_hz);
            Some(shift)
        };
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
                speed_m_s: interpolate(&shift.values, time)?,
            })
        })
    }
}

/// `ω_c` times the displacement by integration, in steps of a time.
fn shift(velocity: &Series, step_s: f64) -> Option<Series> {
    let corner_hz = velocity.high_pass_hz.filter(|c| *c > 0.0)?;
    let mut sum = 0.0;
    let steps = velocity.values.windows(2).map(|pair| {
        sum += 0.5 * (pair[0] + pair[1]) * step_s * std::f64::consts::TAU * corner_hz;
        sum
    });
    Some(Series {
        values: std::iter::once(0.0).chain(steps).collect(),
        ..*velocity
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::kinematics::RigKind;
    use crate::record::{Record, Role};

    #[test]
    fn valid_the_shift_of_a_sine_is_its_displacement_times_the_corner() {
        // v = sin ωt over whole periods: displacement −cos(ωt)/ω, so the shift is −(ω_c/ω) cos ωt.
        let (rate_hz, frequency_hz, corner_hz) = (2000.0, 10.0, 0.5);
        let angle = |i: f64| std::f64::consts::TAU * frequency_hz * i / rate_hz;
        let values: Vec<f64> = (0..2000).map(|i| angle(f64::from(i)).sin()).collect();
        let mut kinematics = Kinematics::of(
            &Record::of(rate_hz, &[(Role::VelocityX, &values)]),
            RigKind::Single,
            1,
        );
        assert!(Shifts::of(&kinematics, &[], None).at(700.0)[0].is_none());
        kinematics.x.velocity.as_mut().unwrap().high_pass_hz = Some(corner_hz);
        let shifts = Shifts::of(&kinematics, &[], None);
        for time in [300.0, 450.5, 1234.25] {
            let [of_x, of_y] = shifts.at(time);
            let want = -corner_hz / frequency_hz * angle(time).cos();
            assert!((of_x.unwrap().speed_m_s - want).abs() < 2e-5, "{time}");
            assert!(of_y.is_none());
        }
    }
}
