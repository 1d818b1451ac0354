//! Readings that begin again at the other end of their range: angles after a turn, counters that run over.

use super::{Excitation, Flag, Problem, Role};
use crate::signal::columns;

/// What an angle counts until it begins again: degrees, radians, gon.
const TURNS: [f64; 3] = [360.0, std::f64::consts::TAU, 400.0];
/// Bits of counters.
const BITS: [i32; 7] = [8, 10, 12, 14, 16, 24, 32];
/// Share of their range that readings which begin again go through, at least.
const GOES_THROUGH: f64 = 0.75;
/// Share of the range by which they jump there, at least, and by which the motion goes on from sample to sample, at most.
const JUMPS: f64 = 0.7;
const GOES_ON: f64 = 0.25;

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
    let of_bits = BITS.map(|bits| 2f64.powi(bits));
    let ranges = TURNS.into_iter().chain(of_bits);
    let found = ranges.filter_map(|range| Unwrapped::of(values, range));
    let found = found.min_by(|a, b| a.farthest.total_cmp(&b.farthest))?;
    values.copy_from_slice(&found.values);
    let problem = Problem::ReadingsGoOn {
        channel: name.to_owned(),
        range: found.range,
        count: found.count,
        first: found.first,
    };
    Some(Flag::new(Some(name), problem).excluding(false))
}

/// Readings made to go on.
struct Unwrapped {
    range: f64,
    values: Vec<f64>,
    /// How often they begin again, and after which sample first.
    count: usize,
    first: usize,
    /// The greatest step between them.
    farthest: f64,
}

impl Unwrapped {
    /// Readings that begin again after a range; `None` if they do not.
    fn of(values: &[f64], range: f64) -> Option<Self> {
        let (low, high) = columns::extremes(values);
        let span = high - low;
        let begins = low >= 0.0 || low >= -0.5 * range && high <= 0.5 * range;
        if !begins || span > range || high > range || span < GOES_THROUGH * range {
            return None;
        }
        let mut turns = 0.0;
        let mut out = Vec::with_capacity(values.len());
        let (mut count, mut first, mut farthest) = (0, 0, 0.0f64);
        let mut last: Option<(f64, f64)> = None;
        for (i, value) in values.iter().enumerate() {
            if let Some((reading, place)) = last.filter(|_| value.is_finite()) {
                let jump = value - reading;
                if jump.abs() > JUMPS * range {
                    turns -= jump.signum();
                    first = if count == 0 { i - 1 } else { first };
                    count += 1;
                }
                farthest = farthest.max((value + turns * range - place).abs());
            }
            let place = value + turns * range;
            if value.is_finite() {
                last = Some((*value, place));
            }
            out.push(place);
        }
        (count > 0 && farthest < GOES_ON * range).then_some(Self {
            range,
            values: out,
            count,
            first,
            farthest,
        })
    }
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
