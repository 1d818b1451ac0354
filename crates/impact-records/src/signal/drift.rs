//! Undoing the first-order high-pass of an integrator, and the drift this leaves.

use super::interpolation::later;
use super::robust;

/// Undo a first-order high-pass of the given corner: x = y + `ω_c` ∫ y dt.
///
/// The high-pass takes x to y by y' + `ω_c` y = x', so the inverse is exact but for one constant
/// (the filter's state at the first sample); an offset b of the samples becomes the ramp `ω_c` b t.
/// Both are left in the result: see [`remove_line`].
///
/// ```
/// use impact_records::signal::drift::undo_high_pass;
///
/// // The step response e^{−ω_c t} becomes a step again, up to the constant.
/// let (rate_hz, corner_hz) = (2000.0, 0.5);
/// let decay = |i: i32| (-std::f64::consts::TAU * corner_hz * f64::from(i) / rate_hz).exp();
/// let samples: Vec<f64> = (0..2000).map(decay).collect();
/// let step = undo_high_pass(&samples, rate_hz, corner_hz);
/// assert!(step.iter().all(|v| (v - step[0]).abs() < 1e-6));
/// ```
pub fn undo_high_pass(samples: &[f64], rate_hz: f64, corner_hz: f64) -> Vec<f64> {
    let half_step = std::f64::consts::PI * corner_hz / rate_hz;
    let mut integral = 0.0;
    let mut previous = samples.first().copied().unwrap_or(0.0);
    samples
        .iter()
        .map(|&sample| {
            integral += half_step * (previous + sample);
            previous = sample;
            sample + integral
        })
        .collect()
}

/// Offset and slope of the straight line through values over times, by least squares; the slope is
/// zero if all times are equal.
pub fn fitted_line(times: &[f64], values: &[f64]) -> (f64, f64) {
    let (mean_time, mean) = (robust::mean(times), robust::mean(values));
    let (mut shear, mut spread) = (0.0, 0.0);
    for (t, v) in times.iter().zip(values) {
        shear += (t - mean_time) * (v - mean);
        spread += (t - mean_time).powi(2);
    }
    let slope = if spread > 0.0 { shear / spread } else { 0.0 };
    (mean - slope * mean_time, slope)
}

/// Slope per sample of what a signal that repeats after a period (in samples) has beside it: the median change over
/// one period, which jumps do not move.
pub fn strobed_slope(values: &[f64], period: f64) -> f64 {
    let later = later(values, period);
    let differences: Vec<f64> = later.iter().zip(values).map(|(a, b)| a - b).collect();
    robust::median(&differences).unwrap_or(0.0) / period
}

/// Subtract `offset + slope · i` from sample i.
pub fn remove_line(samples: &mut [f64], offset: f64, slope_per_sample: f64) {
    for (i, sample) in samples.iter_mut().enumerate() {
        *sample -= offset + slope_per_sample * i as f64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_a_line_is_found_again() {
        let times = [0.0, 0.5, 1.5, 4.0];
        let (offset, slope) = fitted_line(&times, &times.map(|t| 2.0 - 3.0 * t));
        assert!((offset - 2.0).abs() < 1e-12 && (slope + 3.0).abs() < 1e-12);
        assert_eq!(fitted_line(&[1.0, 1.0], &[2.0, 4.0]), (3.0, 0.0));
    }

    #[test]
    fn valid_high_pass_of_a_sine_is_undone() {
        let (rate, corner, frequency) = (2000.0, 0.5, 12.6);
        let w = std::f64::consts::TAU * frequency;
        let wc = std::f64::consts::TAU * corner;
        // Steady response of jω/(jω + ω_c) to sin.
        let (gain, lead) = (w / w.hypot(wc), (wc / w).atan());
        let filtered: Vec<f64> = (0..4000)
            .map(|i| gain * (w * f64::from(i) / rate + lead).sin())
            .collect();
        let restored = undo_high_pass(&filtered, rate, corner);
        let constant = restored[0];
        for (i, value) in restored.iter().enumerate() {
            let truth = (w * i as f64 / rate).sin();
            assert!(
                (value - constant - truth).abs() < 1e-4,
                "{i}: {value} {truth}"
            );
        }
    }
}
