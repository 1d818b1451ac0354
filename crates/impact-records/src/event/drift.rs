//! Offset and ramp of a velocity signal from kinematics: the bodies touch at every impact, so the
//! mean approach velocity between two impacts is zero.

use crate::event::drive::DriveTone;
use crate::event::kinematics::Series;
use crate::signal::whole;
use crate::signal::{drift, robust};

/// Remove the offset (and the ramp, if a high-pass was undone) of an approach velocity.
///
/// From the arcs between impacts (`times` in samples) if there are any, else from whole drive
/// periods.
pub(super) fn remove_drift(
    velocity: &mut Series,
    times: &[f64],
    drive: Option<&DriveTone>,
    rate_hz: f64,
) {
    let arcs = arc_offsets(&velocity.values, times);
    let line = if arcs.is_empty() {
        period_line(velocity, drive, rate_hz)
    } else {
        weighted_line(&arcs, velocity.high_pass_hz.is_some() && arcs.len() >= 4)
    };
    if let Some((offset, slope)) = line {
        drift::remove_line(&mut velocity.values, offset, slope);
    }
}

/// Mean velocity of each arc: (middle in samples, mean, duration in samples).
fn arc_offsets(values: &[f64], times: &[f64]) -> Vec<(f64, f64, f64)> {
    times
        .windows(2)
        .filter(|w| w[1] - w[0] > 4.0)
        .filter_map(|w| {
            let area = integral(values, w[0], w[1])?;
            Some((0.5 * (w[0] + w[1]), area / (w[1] - w[0]), w[1] - w[0]))
        })
        .collect()
}

/// Integral of samples (step 1) between two instants; `None` with fewer than three samples inside.
///
/// No sample outside the interval enters, so a jump at its ends does no harm.
pub(super) fn integral(values: &[f64], from: f64, to: f64) -> Option<f64> {
    let first = whole::index(from.ceil().max(0.0));
    let last = whole::index(to.floor());
    if last >= values.len() || first + 1 >= last {
        return None;
    }
    let inside = &values[first..=last];
    let trapezoid = inside.iter().sum::<f64>() - 0.5 * (inside[0] + inside[inside.len() - 1]);
    let slope_first = values[first + 1] - values[first];
    let slope_last = values[last] - values[last - 1];
    let (head, tail) = (first as f64 - from, to - last as f64);
    let head_area = head * (values[first] - 0.5 * head * slope_first);
    let tail_area = tail * (values[last] + 0.5 * tail * slope_last);
    Some(trapezoid + head_area + tail_area)
}

fn weighted_line(points: &[(f64, f64, f64)], with_slope: bool) -> Option<(f64, f64)> {
    let weight: f64 = points.iter().map(|p| p.2).sum();
    let centre = points.iter().map(|p| p.0 * p.2).sum::<f64>() / weight;
    let mean = points.iter().map(|p| p.1 * p.2).sum::<f64>() / weight;
    if !with_slope {
        return Some((mean, 0.0));
    }
    let spread: f64 = points.iter().map(|p| p.2 * (p.0 - centre).powi(2)).sum();
    let shear: f64 = points
        .iter()
        .map(|p| p.2 * (p.0 - centre) * (p.1 - mean))
        .sum();
    let slope = if spread > 0.0 { shear / spread } else { 0.0 };
    Some((mean - slope * centre, slope))
}

/// Offset and ramp from samples a whole drive period apart, else the plain mean.
fn period_line(velocity: &Series, drive: Option<&DriveTone>, rate_hz: f64) -> Option<(f64, f64)> {
    let values = &velocity.values;
    let period = drive
        .map(|d| rate_hz / d.frequency_hz)
        .filter(|p| 2.0 * p < values.len() as f64);
    let Some(period) = period else {
        return Some((robust::mean(values), 0.0));
    };
    let slope = if velocity.high_pass_hz.is_some() {
        drift::strobed_slope(values, period)
    } else {
        0.0
    };
    let level: Vec<f64> = values
        .iter()
        .enumerate()
        .map(|(i, v)| v - slope * i as f64)
        .collect();
    let whole = (level.len() as f64 / period - 1e-9).floor() * period;
    let offset = integral(&level, 0.0, whole.min(level.len() as f64 - 2.0))? / whole;
    Some((offset, slope))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Flights of 20.3 samples, each a line from −1 to 1, so that its mean is zero.
    const FLIGHT: f64 = 20.3;

    fn flights() -> (Vec<f64>, Vec<f64>) {
        let value = |i: usize| 2.0 * (i as f64 / FLIGHT).fract() - 1.0;
        let times = (1..10).map(|k| FLIGHT * f64::from(k)).collect();
        ((0..210).map(value).collect(), times)
    }

    #[test]
    fn valid_the_integral_of_a_line_is_exact_between_any_instants() {
        let line: Vec<f64> = (0..20).map(|i| 3.0 + 2.0 * f64::from(i)).collect();
        // ∫ 3 + 2t from 2.25 to 9.5 = 3 · 7.25 + 9.5² − 2.25² = 106.9375.
        assert!((integral(&line, 2.25, 9.5).unwrap() - 106.9375).abs() < 1e-12);
        assert_eq!(integral(&line, 2.25, 20.0), None);
        assert_eq!(integral(&line, 2.2, 3.8), None);
    }

    #[test]
    fn valid_offset_and_ramp_between_impacts_are_removed() {
        let (clean, times) = flights();
        let mut velocity = Series::clean(clean.iter().map(|v| v + 0.3).collect());
        remove_drift(&mut velocity, &times, None, 2000.0);
        let worst = |v: &[f64]| {
            let apart = v.iter().zip(&clean).map(|(a, b)| (a - b).abs());
            apart.fold(0.0, f64::max)
        };
        assert!(worst(&velocity.values) < 1e-12);
        // A ramp is looked for only if a high-pass was undone.
        let drifted = clean
            .iter()
            .enumerate()
            .map(|(i, v)| v + 0.3 - 2e-3 * i as f64);
        let mut velocity = Series::clean(drifted.collect());
        velocity.high_pass_hz = Some(0.5);
        remove_drift(&mut velocity, &times, None, 2000.0);
        assert!(worst(&velocity.values) < 1e-12);
    }

    #[test]
    fn valid_without_impacts_whole_drive_periods_give_the_offset() {
        let drive = DriveTone::at(20.0, 1.0);
        // 2.5 periods of 100 samples: the plain mean would be off by the half period.
        let tone = |i: usize| (std::f64::consts::TAU * i as f64 / 100.0).sin();
        let mut velocity = Series::clean((0..250).map(|i| tone(i) + 0.7).collect());
        remove_drift(&mut velocity, &[], Some(&drive), 2000.0);
        for i in [0, 60, 240] {
            assert!((velocity.values[i] - tone(i)).abs() < 1e-3, "{i}");
        }
    }
}
