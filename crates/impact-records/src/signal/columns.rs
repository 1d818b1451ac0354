//! Arithmetic on columns of numbers.
//!
//! The same arithmetic, in the same order, on vectors of any width: no bit depends on the processor.

use multiversion::multiversion;

/// Sum, in sixteen parts that do not wait for each other.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn sum(values: &[f64]) -> f64 {
    let (wide, rest) = values.as_chunks::<16>();
    let mut sums = [0.0; 16];
    for x in wide {
        for (sum, x) in sums.iter_mut().zip(x) {
            *sum += x;
        }
    }
    let (fours, last) = rest.as_chunks::<4>();
    let mut sums = folded(sums);
    for x in fours {
        for (sum, x) in sums.iter_mut().zip(x) {
            *sum += x;
        }
    }
    let mut sum = total(sums);
    for x in last {
        sum += x;
    }
    sum
}

/// Inner product, as far as both columns go, in sixteen sums that do not wait for each other.
#[multiversion(targets("x86_64+avx2"))]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let common = a.len().min(b.len());
    let (a, b) = (&a[..common], &b[..common]);
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<16>(), b.as_chunks::<16>());
    let mut sums = [0.0; 16];
    for (x, y) in a.iter().zip(b) {
        add_products(&mut sums, x, y);
    }
    let ((a, last_a), (b, last_b)) = (rest_a.as_chunks::<4>(), rest_b.as_chunks::<4>());
    let mut sums = folded(sums);
    for (x, y) in a.iter().zip(b) {
        add_products(&mut sums, x, y);
    }
    let mut sum = total(sums);
    for (x, y) in last_a.iter().zip(last_b) {
        sum += x * y;
    }
    sum
}

// a closure here would at times be compiled without the vectors of the processor
#[inline(always)]
fn add_products<const N: usize>(sums: &mut [f64; N], a: &[f64; N], b: &[f64; N]) {
    for (sum, (x, y)) in sums.iter_mut().zip(a.iter().zip(b)) {
        *sum += x * y;
    }
}

/// Four sums of sixteen.
#[inline(always)]
fn folded(sums: [f64; 16]) -> [f64; 4] {
    // opaque, so that the sums stay in vectors as wide as the processor's while they are formed
    let sums = std::hint::black_box(sums);
    let mut fours = [0.0; 4];
    for (i, sum) in fours.iter_mut().enumerate() {
        *sum = (sums[i] + sums[i + 8]) + (sums[i + 4] + sums[i + 12]);
    }
    fours
}

#[inline(always)]
fn total([a, b, c, d]: [f64; 4]) -> f64 {
    (a + c) + (b + d)
}

/// Subtract a multiple of another column.
#[multiversion(targets("x86_64+avx2"))]
pub fn subtract(from: &mut [f64], share: f64, column: &[f64]) {
    for (x, y) in from.iter_mut().zip(column) {
        *x -= share * y;
    }
}

/// Subtract a multiple of the product of a column with itself, each with each, from a square matrix given column by column.
#[multiversion(targets("x86_64+avx2"))]
pub fn subtract_outer(from: &mut [f64], share: f64, column: &[f64]) {
    for (to, own) in from.chunks_exact_mut(column.len().max(1)).zip(column) {
        let share = share * own;
        for (x, y) in to.iter_mut().zip(column) {
            *x -= share * y;
        }
    }
}

/// Add a multiple of the difference of two columns.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn add_difference(to: &mut [f64], share: f64, [more, less]: [&[f64]; 2]) {
    for ((sum, a), b) in to.iter_mut().zip(more).zip(less) {
        *sum += share * (a - b);
    }
}

/// Product of two columns, element by element.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn products(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut products = a[..a.len().min(b.len())].to_vec();
    for (x, y) in products.iter_mut().zip(b) {
        *x *= y;
    }
    products
}

/// Whether all are numbers, none infinite.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn all_finite(values: &[f64]) -> bool {
    let (wide, rest) = values.as_chunks::<8>();
    let finite = |x: &[f64; 8]| x.iter().fold(true, |all, v| all & v.is_finite());
    wide.iter().all(finite) && rest.iter().all(|v| v.is_finite())
}

/// The least and the greatest number; (∞, −∞) if there is none.
#[multiversion(targets("x86_64+avx2"))]
pub fn extremes(values: &[f64]) -> (f64, f64) {
    let (wide, rest) = values.as_chunks::<16>();
    let (mut low, mut high) = ([f64::INFINITY; 16], [f64::NEG_INFINITY; 16]);
    for x in wide {
        low = std::array::from_fn(|i| lesser(x[i], low[i]));
        high = std::array::from_fn(|i| -lesser(-x[i], -high[i]));
    }
    let low = low.iter().chain(rest).copied();
    let high = high.iter().chain(rest).copied();
    (
        low.fold(f64::INFINITY, |least, v| lesser(v, least)),
        high.fold(f64::NEG_INFINITY, |most, v| -lesser(-v, -most)),
    )
}

/// The least step between neighbours that is greater than `still`; ∞ if there is none.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn least_step(values: &[f64], still: f64) -> f64 {
    let next = values.get(1..).unwrap_or_default();
    let ((wide, rest), (others, _)) = (next.as_chunks::<16>(), values.as_chunks::<16>());
    let step = |a: f64, b: f64| {
        let step = (a - b).abs();
        if step > still { step } else { f64::INFINITY }
    };
    let mut least = [f64::INFINITY; 16];
    for (x, y) in wide.iter().zip(others) {
        least = std::array::from_fn(|i| lesser(step(x[i], y[i]), least[i]));
    }
    let rest = rest
        .iter()
        .zip(&values[16 * wide.len()..])
        .map(|(x, y)| step(*x, *y));
    rest.chain(least)
        .fold(f64::INFINITY, |least, v| lesser(v, least))
}

/// `value` if it is less than `least`: what is no number never is.
#[inline(always)]
fn lesser(value: f64, least: f64) -> f64 {
    if value < least { value } else { least }
}

/// The least difference of unlike values, wherever they are: a digit as printed, a step of a converter; zero where all are
/// equal.
pub(crate) fn digit(samples: &[f64]) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let least = 1e-12 * sorted.last().map_or(0.0, |l| l - sorted[0]);
    let steps = sorted.windows(2).map(|w| w[1] - w[0]);
    let least = steps.filter(|s| *s > least).fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn prop_columns_of_any_length_are_added_and_multiplied_as_far_as_both_go() {
        let mut random = ChaCha8Rng::seed_from_u64(11);
        for length in 0..70 {
            let mut column = |more: usize| -> Vec<f64> {
                let values = 0..length + more;
                values.map(|_| random.random_range(-1.0..1.0)).collect()
            };
            for (a, b) in [
                (column(0), column(0)),
                (column(5), column(0)),
                (column(0), column(23)),
            ] {
                let wanted: Vec<f64> = a.iter().zip(&b).map(|(x, y)| x * y).collect();
                assert_eq!(products(&a, &b), wanted);
                let close = |found: f64, wanted: f64| (found - wanted).abs() < 1e-13;
                assert!(close(sum(&wanted), wanted.iter().sum()), "{length}");
                assert!(close(dot(&a, &b), wanted.iter().sum()), "{length}");
                let mut left = a.clone();
                subtract(&mut left, 0.5, &b);
                let apart = |i: usize| a[i] - b.get(i).map_or(0.0, |y| 0.5 * y);
                assert!((0..a.len()).all(|i| left[i] == apart(i)), "{length}");
            }
        }
    }

    #[test]
    fn extremes_and_steps_are_found_wherever_they_lie() {
        for count in [2, 7, 16, 17, 33, 48] {
            for place in 0..count {
                let mut values: Vec<f64> = (0..count).map(|i| (i % 2) as f64).collect();
                values[place] = -3.5;
                let (low, high) = extremes(&values);
                assert_eq!(
                    (low, high),
                    (-3.5, if count > 2 || place == 0 { 1.0 } else { 0.0 })
                );
                assert!(all_finite(&values));
                values[place] = f64::NAN;
                assert!(!all_finite(&values));
                assert!(extremes(&values).0 >= 0.0);
            }
            for place in 1..count {
                let mut values: Vec<f64> = (0..count).map(|i| 2.0 * i as f64).collect();
                values[place..].iter_mut().for_each(|v| *v -= 1.25);
                assert_eq!(least_step(&values, 0.0), 0.75);
                assert_eq!(
                    least_step(&values, 0.75),
                    if count > 2 { 2.0 } else { f64::INFINITY }
                );
            }
        }
        assert_eq!(least_step(&[], 0.0), f64::INFINITY);
    }
}
