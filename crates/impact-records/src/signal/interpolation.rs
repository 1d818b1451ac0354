//! Values between samples.

use super::whole;

/// Value between samples by a cubic through the four samples around it (linear at the edges);
/// `None` outside the samples.
///
/// ```
/// use impact_records::signal::interpolation::interpolate;
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
    let around = [0, 1, 2, 3].map(|k| samples[index - 1 + k]);
    Some(weighted(cubic(u), around))
}

/// Value at the place of a sample by the polynomial through the samples at other places (Lagrange).
///
/// ```
/// use impact_records::signal::interpolation::through;
///
/// let cubes = [0.0, 1.0, f64::NAN, 27.0, 64.0];
/// assert!((through(&cubes, &[0, 1, 3, 4], 2) - 8.0).abs() < 1e-12);
/// ```
pub fn through(samples: &[f64], places: &[usize], at: usize) -> f64 {
    polynomial(|i| i as f64, samples, places, at as f64)
}

/// Value at a time by the polynomial through the samples at some places, whose times need not be even (Lagrange).
///
/// ```
/// use impact_records::signal::interpolation::at;
///
/// let times = [0.0, 1.0, 1.5, 4.0];
/// let cubes = times.map(|t: f64| t.powi(3));
/// assert!((at(&times, &cubes, &[0, 1, 2, 3], 2.0) - 8.0).abs() < 1e-12);
/// ```
pub fn at(times: &[f64], samples: &[f64], places: &[usize], time: f64) -> f64 {
    polynomial(|i| times[i], samples, places, time)
}

/// Value at a time by Lagrange's polynomial through the samples at some places, of which `time_of` tells the times.
fn polynomial(time_of: impl Fn(usize) -> f64, samples: &[f64], places: &[usize], time: f64) -> f64 {
    let term = |i: &usize| {
        let others = places.iter().filter(|k| *k != i);
        let factor = others.map(|k| (time - time_of(*k)) / (time_of(*i) - time_of(*k)));
        samples[*i] * factor.product::<f64>()
    };
    places.iter().map(term).sum()
}

/// Weights of the samples at −1, 0, 1, 2 in the value at a place between 0 and 1 (Lagrange's cubic).
fn cubic(u: f64) -> [f64; 4] {
    let outer = u * (1.0 - u) / 6.0;
    [
        -outer * (2.0 - u),
        (1.0 - u * u) * (2.0 - u) * 0.5,
        u * (1.0 + u) * (2.0 - u) * 0.5,
        -outer * (1.0 + u),
    ]
}

fn weighted(weights: [f64; 4], around: [f64; 4]) -> f64 {
    let [a, b, c, d] = around;
    weights[0] * a + weights[1] * b + weights[2] * c + weights[3] * d
}

/// Values a lag after each sample, as [`interpolate`] has them, as far as the
/// samples reach.
pub fn later(samples: &[f64], lag: f64) -> Vec<f64> {
    let (whole, weights) = (whole::index(lag), cubic(lag.fract()));
    let first = whole.checked_sub(1);
    let inside = first.and_then(|first| samples.get(first..));
    let inside = inside
        .unwrap_or_default()
        .windows(4)
        .map(|around| match around {
            [a, b, c, d] => weighted(weights, [*a, *b, *c, *d]),
            _ => f64::NAN,
        });
    let mut values: Vec<f64> = inside.collect();
    let rest = values.len()..;
    values.extend(rest.map_while(|i| interpolate(samples, i as f64 + lag)));
    values
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
    fn regress_later_values_are_those_between_the_samples() {
        let samples: Vec<f64> = (0..40).map(|i| (0.7 * f64::from(i)).sin()).collect();
        for lag in [0.4, 1.0, 1.3, 7.5, 20.0, 36.2, 37.0, 38.4, 39.0, 39.5, 80.0] {
            let places = (0..40).map(|i| f64::from(i) + lag);
            let want: Vec<f64> = places.map_while(|p| interpolate(&samples, p)).collect();
            let found = later(&samples, lag);
            assert_eq!(found.len(), want.len(), "{lag}");
            for (f, w) in found.iter().zip(want) {
                assert!((f - w).abs() < 1e-13, "{lag}");
            }
        }
    }

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
