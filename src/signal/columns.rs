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
        sums = std::array::from_fn(|i| sums[i] + x[i]);
    }
    total(sums) + rest.iter().sum::<f64>()
}

/// Inner product, in sixteen sums that do not wait for each other.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<16>(), b.as_chunks::<16>());
    let mut sums = [0.0; 16];
    for (x, y) in a.iter().zip(b) {
        sums = std::array::from_fn(|i| sums[i] + x[i] * y[i]);
    }
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(x, y)| x * y).sum();
    total(sums) + rest
}

#[inline(always)]
fn total(sums: [f64; 16]) -> f64 {
    let fours: [f64; 4] =
        std::array::from_fn(|i| (sums[i] + sums[i + 8]) + (sums[i + 4] + sums[i + 12]));
    (fours[0] + fours[2]) + (fours[1] + fours[3])
}

/// Subtract a multiple of another column.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn subtract(from: &mut [f64], share: f64, column: &[f64]) {
    let ((wide, rest), (others, other_rest)) = (from.as_chunks_mut::<8>(), column.as_chunks::<8>());
    for (x, y) in wide.iter_mut().zip(others) {
        *x = std::array::from_fn(|i| x[i] - share * y[i]);
    }
    for (x, y) in rest.iter_mut().zip(other_rest) {
        *x -= share * y;
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
    a.iter().zip(b).map(|(x, y)| x * y).collect()
}
