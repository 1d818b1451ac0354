//! Values between samples.

use super::whole;

/// Value between samples by a cubic through the four samples around it (linear at the edges);
/// `None` outside the samples.
///
/// ```
/// use impactid::signal::interpolation::interpolate;
///
/// let cubes: Vec<f64> = (0..6).map(|i| f64::from(i).powi(3)).collect();
/// assert!((interpolate(&cubes, 2.5).unwrap() - 15.625).abs() < 1e-12);
/// assert_eq!(interpolate(&cubes, 5.1), None);
/// ```
pub fn interpolate(samples: &[f64], position: f64) -> Option<f64> {
    let last = samples.len().checked_sub(1)?;
    if !(0.0..=last as f64).contains(&position) {
        return None;
    }
    let index = whole::index(position).min(last.saturating_sub(1));
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
pub fn noise_gain(fraction: f64) -> f64 {
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
}
