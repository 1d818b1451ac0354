//! A motion that comes to rest without swinging: its damping ratio is about one or more.

use super::watched::{MotionSignal, Watched};
use crate::signal::robust;

/// Part of a record at its end in which the motion is over.
const OVER: usize = 10;
/// The fall to rest over the scatter at rest, from which it is one.
const STANDS_OUT: f64 = 20.0;
/// Greatest excursion beyond rest over the fall: beyond that it swings. β = 0.78 has so much.
const BEYOND: f64 = 0.02;
/// Part of the fall from which the way to rest is watched, and the least and the most of what is left of that after half
/// of the time to a tenth: a half to nearly all of it by then, as e^(−t/τ) leaves a third.
const FROM: f64 = 0.8;
const HALFWAY: [f64; 2] = [0.15, 0.5];
/// Points on the way, and how long it is through them at most, over the fall between: what swings goes to and fro.
const POINTS: usize = 24;
const ASTRAY: f64 = 1.3;
/// Fewest samples on the way.
const FEWEST: usize = 8;

/// Whether a displacement, or a velocity, falls from its greatest excursion to rest as e^(−t/τ) does, and stays there for longer
/// than it fell: about a turn a swing rests for less.
pub fn comes_to_rest(channel: &Watched<'_>) -> bool {
    let values = channel.values;
    let tail = &values[values.len() - values.len() / OVER..];
    let usual = matches!(
        channel.quantity,
        MotionSignal::Displacement | MotionSignal::Velocity
    );
    let (Some(rest), true) = (robust::median(tail), usual && values.len() >= OVER * FEWEST) else {
        return false;
    };
    let scatter = robust::rms(&tail.iter().map(|v| v - rest).collect::<Vec<_>>());
    let size = |v: &f64| (v - rest).abs();
    let Some(greatest) =
        (0..values.len()).max_by(|a, b| size(&values[*a]).total_cmp(&size(&values[*b])))
    else {
        return false;
    };
    let fall = values[greatest] - rest;
    let shares: Vec<f64> = values[greatest..]
        .iter()
        .map(|v| (v - rest) / fall)
        .collect();
    let noise = scatter / fall.abs();
    // the last sample above, so that a hold before the release does not count
    let last_above = |share: f64| shares.iter().rposition(|s| *s > share);
    let (Some(begin), Some(end)) = (last_above(FROM), last_above(0.1 * FROM)) else {
        return false;
    };
    // a ball that bounces is at rest again and again
    let rest_again = 0.1 * FROM - BEYOND - 4.0 * noise;
    let first_at_rest = shares.iter().position(|s| *s < rest_again);
    let halfway = shares[begin + (end - begin) / 2] / FROM;
    let least = shares.iter().copied().fold(f64::INFINITY, f64::min);
    let on_the_way: Vec<f64> = (0..=POINTS)
        .map(|k| shares[begin + (end - begin) * k / POINTS])
        .collect();
    let way: f64 = on_the_way.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
    let straight = way < ASTRAY * (FROM + POINTS as f64 * noise);
    noise * STANDS_OUT < 1.0
        && straight
        && first_at_rest.is_some_and(|first| first > end)
        && end >= begin + FEWEST
        && shares.len() - end > end - begin
        && least > -BEYOND - 4.0 * noise
        && HALFWAY[0] < halfway
        && halfway < HALFWAY[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rests(value: impl Fn(f64) -> f64) -> bool {
        let values: Vec<f64> = (0..1000)
            .map(|i| {
                let i = f64::from(i);
                value(i / 500.0 - 0.2) + 1e-3 * (2.399_963 * i * i).sin()
            })
            .collect();
        comes_to_rest(&Watched::new(&values, MotionSignal::Displacement))
    }

    #[test]
    fn valid_only_a_motion_without_swings_comes_to_rest_so() {
        let released = |t: f64, value: f64| if t < 0.0 { 1.0 } else { value };
        let omega = std::f64::consts::TAU * 4.0;
        // released at β = 1 and 1.6: x = (1 + ωt) e^(−ωt), and two exponentials
        assert!(rests(|t| released(
            t,
            (1.0 + omega * t) * (-omega * t).exp()
        )));
        let root = omega * (1.6_f64 * 1.6 - 1.0).sqrt();
        let slow = |t: f64| {
            (-1.6 * omega * t).exp() * ((root * t).cosh() + 1.6 * omega / root * (root * t).sinh())
        };
        assert!(rests(|t| released(t, slow(t))));
        // a swing, a step, a ramp, noise
        let swing = |t: f64| (-0.3 * omega * t).exp() * (0.954 * omega * t).cos();
        assert!(!rests(|t| released(t, swing(t))));
        assert!(!rests(|t| released(t, 0.0)));
        assert!(!rests(|t| released(t, (1.0 - t).max(0.0))));
        assert!(!rests(|_| 0.0));
        // four tenths of a period, up to a turn
        assert!(!rests(|t| (1.4 * (t + 0.2)).cos()));
    }
}
