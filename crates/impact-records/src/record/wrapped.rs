//! Channels whose readings begin again at the other end of their range, made to go on.

use super::{Excitation, Flag, Problem, Role};
use crate::signal::wrapped;

/// Make readings that begin again go on, if they do. `role`: what they show; where masses may strike each other, velocities jump.
pub(super) fn go_on(
    values: &mut [f64],
    name: &str,
    role: Role,
    excitation: Excitation,
) -> Option<Flag> {
    let place = matches!(role, Role::DisplacementX | Role::DisplacementY);
    let decays = role.is_motion() && excitation == Excitation::FreeDecay;
    if !place && !decays {
        return None;
    }
    let found = wrapped::go_on(values)?;
    values.copy_from_slice(&found.values);
    let problem = Problem::ReadingsGoOn {
        channel: name.to_owned(),
        range: found.range,
        count: found.count,
        first: found.first,
    };
    Some(Flag::new(Some(name), problem).excluding(false))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::FlagCode;

    /// A decay of 5 Hz with β = 0.02 at 250 Hz about a rest.
    fn motion(amplitude: f64, rest: f64) -> Vec<f64> {
        let omega = std::f64::consts::TAU * 5.0;
        (0..1500)
            .map(|i| {
                let t = f64::from(i) / 250.0;
                rest + amplitude * (-0.02 * omega * t).exp() * (omega * t).cos()
            })
            .collect()
    }

    fn read(values: &mut [f64], role: Role) -> Option<Flag> {
        go_on(values, "encoder", role, Excitation::FreeDecay)
    }

    #[test]
    fn valid_counters_and_angles_that_begin_again_go_on() {
        let turn = std::f64::consts::TAU;
        for (range, amplitude, rest) in [
            (65_536.0, 30_000.0, 60_000.0),
            (4096.0, 1900.0, 1100.0),
            (360.0, 170.0, 20.0),
            (turn, 3.0, 5.5),
        ] {
            let whole = motion(amplitude, rest);
            for signed in [false, true] {
                let shift = if signed { 0.5 * range } else { 0.0 };
                let reading = |v: &f64| (v + shift).rem_euclid(range) - shift;
                let mut values: Vec<f64> = whole.iter().map(reading).collect();
                let flag = read(&mut values, Role::DisplacementX).unwrap();
                assert_eq!((flag.code, flag.excludes), (FlagCode::Wrapped, false));
                let apart = values[0] - whole[0];
                let off = values.iter().zip(&whole).map(|(v, w)| v - w - apart);
                assert!(off.into_iter().all(|o| o.abs() < 1e-9 * range), "{range}");
            }
        }
    }

    #[test]
    fn what_does_not_begin_again_stays_as_it_is() {
        let within = motion(170.0, 180.0);
        let fast: Vec<f64> = (0..400)
            .map(|i| 180.0 + 170.0 * (2.2 * f64::from(i)).cos())
            .collect();
        // a ball's velocity at its bounces
        let bounces: Vec<f64> = (0..900).map(|i| 150.0 - f64::from(i % 300)).collect();
        for values in [within, fast] {
            let mut read_as = values.clone();
            assert!(read(&mut read_as, Role::DisplacementX).is_none());
            assert_eq!(read_as, values);
        }
        let mut read_as = bounces.clone();
        let flag = go_on(&mut read_as, "v", Role::VelocityX, Excitation::Harmonic);
        assert!(flag.is_none() && read_as == bounces);
    }
}
