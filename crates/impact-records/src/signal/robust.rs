//! Robust location and scale, and the range of values.

use crate::signal::columns::{dot, sum};

/// Least and greatest of the finite values; `None` where there are none.
pub fn range(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values
        .into_iter()
        .filter(|v| v.is_finite())
        .fold(None, |seen, v| match seen {
            None => Some((v, v)),
            Some((low, high)) => Some((low.min(v), high.max(v))),
        })
}

/// Median of the values; `None` for an empty slice. NaN must not be among them.
pub fn median(values: &[f64]) -> Option<f64> {
    let mut ranks: Vec<i64> = values.iter().map(|v| rank(*v)).collect();
    median_of_ranks(&mut ranks)
}

/// Median of values by their [`rank`], in any order.
fn median_of_ranks(ranks: &mut [i64]) -> Option<f64> {
    let middle = ranks.len() / 2;
    if ranks.is_empty() {
        return None;
    }
    let even = ranks.len().is_multiple_of(2);
    let (below, &mut upper, _) = ranks.select_nth_unstable(middle);
    let upper = of_rank(upper);
    match below.iter().max() {
        Some(&lower) if even => Some(0.5 * (of_rank(lower) + upper)),
        _ => Some(upper),
    }
}

/// A whole number in the order of the values, [`f64::total_cmp`]: it is compared in one step.
fn rank(value: f64) -> i64 {
    let bits = value.to_bits().cast_signed();
    bits ^ ((bits >> 63) & i64::MAX)
}

/// The value of a rank.
fn of_rank(rank: i64) -> f64 {
    f64::from_bits((rank ^ ((rank >> 63) & i64::MAX)).cast_unsigned())
}

/// Standard deviation from the median absolute deviation, as if normal: 1.4826 · MAD.
pub fn robust_deviation(values: &[f64]) -> Option<f64> {
    median_absolute_deviation(values).map(|mad| 1.4826 * mad)
}

/// Median distance from the median.
pub fn median_absolute_deviation(values: &[f64]) -> Option<f64> {
    let centre = median(values)?;
    let distances = values.iter().map(|v| (v - centre).abs());
    let mut ranks: Vec<i64> = distances.map(rank).collect();
    median_of_ranks(&mut ranks)
}

/// By how much values differ from their neighbours, the mean, by the differences between them: each has √2 times the deviation
/// of a value, and what changes smoothly is no part of it. `None` without a difference.
pub fn apart_from_neighbours(differences: &[f64]) -> Option<f64> {
    let sizes: Vec<f64> = differences.iter().map(|d| d.abs()).collect();
    (!sizes.is_empty()).then(|| mean(&sizes) * std::f64::consts::FRAC_1_SQRT_2)
}

/// Standard deviation of the white noise on a smooth signal with isolated jumps.
///
/// From third differences, which cancel a local parabola and have variance 20 σ², with a robust
/// scale that isolated jumps do not move. A quantised signal at rest gives zero.
///
/// ```
/// use impact_records::signal::robust::{median, noise_deviation};
///
/// assert_eq!(median(&[3.0, 1.0, 2.0, 10.0]), Some(2.5));
/// // A parabola with one jump has no noise.
/// let value = |i: i32| f64::from(i * i) + if i > 50 { 1e3 } else { 0.0 };
/// let samples: Vec<f64> = (0..100).map(value).collect();
/// assert_eq!(noise_deviation(&samples), 0.0);
/// ```
pub fn noise_deviation(samples: &[f64]) -> f64 {
    let thirds: Vec<f64> = samples
        .windows(4)
        .map(|w| w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0])
        .collect();
    robust_deviation(&thirds).map_or(0.0, |d| d / 20f64.sqrt())
}

/// Arithmetic mean; zero for an empty slice.
pub fn mean(values: &[f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    sum(values) / values.len() as f64
}

/// Sum of the squares about the mean.
pub fn squares_about_mean(values: &[f64]) -> f64 {
    let centre = mean(values);
    values.iter().map(|v| (v - centre).powi(2)).sum()
}

/// Root mean square about the mean; of no values NaN.
pub fn rms_about_mean(values: &[f64]) -> f64 {
    (squares_about_mean(values) / values.len() as f64).sqrt()
}

/// Root mean square; zero for an empty slice.
pub fn rms(values: &[f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    (dot(values, values) / values.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_median_of_odd_and_even_counts() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(median(&[]), None);
    }

    #[test]
    fn valid_ranks_are_in_the_order_of_their_values() {
        let ordered = [
            f64::NEG_INFINITY,
            -2.5,
            -f64::MIN_POSITIVE,
            -0.0,
            0.0,
            1e-300,
            1.0,
            f64::INFINITY,
        ];
        assert!(ordered.is_sorted_by(|a, b| rank(*a) < rank(*b)));
        assert!(
            ordered
                .iter()
                .all(|v| of_rank(rank(*v)).to_bits() == v.to_bits())
        );
    }

    #[test]
    fn prop_noise_deviation_ignores_parabola_and_jumps() {
        use rand::{Rng, SeedableRng};
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let samples: Vec<f64> = (0..4000)
            .map(|i| {
                let t = f64::from(i) * 1e-3;
                let jump = if i % 400 > 200 { 1.0 } else { 0.0 };
                let uniform: f64 = rng.random_range(-1.0..1.0);
                3.0 * t * t + jump + 0.01 * uniform
            })
            .collect();
        let expected = 0.01 / 3f64.sqrt();
        assert!((noise_deviation(&samples) / expected - 1.0).abs() < 0.1);
    }
}
