//! Undoing the first-order high-pass of an integrator, and the drift this leaves.

/// Undo a first-order high-pass of the given corner: x = y + ω_c ∫ y dt.
///
/// The high-pass takes x to y by y' + ω_c y = x', so the inverse is exact but for one constant
/// (the filter's state at the first sample); an offset b of the samples becomes the ramp ω_c b t.
/// Both are left in the result: see [`remove_line`].
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

/// Subtract `offset + slope · i` from sample i.
pub fn remove_line(samples: &mut [f64], offset: f64, slope_per_sample: f64) {
    for (i, sample) in samples.iter_mut().enumerate() {
        *sample -= offset + slope_per_sample * i as f64;
    }
}

/// Value between samples by a cubic through the four samples around it (linear at the edges);
/// `None` outside the samples.
pub fn interpolate(samples: &[f64], position: f64) -> Option<f64> {
    let last = samples.len().checked_sub(1)?;
    if !(0.0..=last as f64).contains(&position) {
        return None;
    }
    let index = (position as usize).min(last.saturating_sub(1));
    let u = position - index as f64;
    if index == 0 || index + 2 > last {
        let next = samples[(index + 1).min(last)];
        return Some(samples[index] + u * (next - samples[index]));
    }
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| samples[index - 1 + k]);
    let (outer, inner) = (u * (1.0 - u) / 6.0, 0.5 * (1.0 - u) * u);
    // Lagrange's cubic through −1, 0, 1, 2.
    Some(
        -a * outer * (2.0 - u)
            + b * (1.0 - u * u) * (2.0 - u) * 0.5
            + c * u * (1.0 + u) * (2.0 - u) * 0.5
            - d * inner * (1.0 + u) / 3.0,
    )
}

/// Variance of [`interpolate`]'s value per variance of white noise on the samples, at a fraction
/// of the step beyond a sample.
pub fn interpolation_noise(fraction: f64) -> f64 {
    let impulse = |k: usize| {
        let mut samples = [0.0; 4];
        samples[k] = 1.0;
        interpolate(&samples, 1.0 + fraction).unwrap_or(0.0).powi(2)
    };
    (0..4).map(impulse).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_cubic_interpolation_is_exact_for_cubics() {
        let cubic = |t: f64| 0.3 - t + 0.4 * t * t - 0.05 * t.powi(3);
        let samples: Vec<f64> = (0..12).map(|i| cubic(f64::from(i))).collect();
        for position in [1.0, 1.25, 4.5, 7.9, 9.99] {
            assert!((interpolate(&samples, position).unwrap() - cubic(position)).abs() < 1e-12);
        }
        assert_eq!(interpolate(&samples, 11.5), None);
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
