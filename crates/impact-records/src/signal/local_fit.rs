//! Polynomials fitted to a few samples beside an instant and extrapolated to it.

use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::Arc;

use nalgebra::DMatrix;

/// A polynomial in (t − origin)/scale fitted by least squares.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalFit {
    /// By power; those above the degree are zero.
    coefficients: Row,
    basis: Arc<Basis>,
    origin: f64,
    /// Number of samples.
    pub samples: usize,
    /// Sum of squared residuals.
    pub residual_squares: f64,
}

impl LocalFit {
    /// Fit a polynomial of at most `degree` to samples `first..last` (index = time in steps).
    ///
    /// The degree is at most 4; it is lowered if the samples are too few for it (at least one more sample
    /// than coefficients, except for a constant). `None` for an empty range.
    ///
    /// ```
    /// use impact_records::signal::local_fit::LocalFit;
    ///
    /// let squares: Vec<f64> = (0..10).map(|i| f64::from(i).powi(2)).collect();
    /// let fit = LocalFit::new(&squares, 2, 8, 2).unwrap();
    /// assert!((fit.value(9.5) - 90.25).abs() < 1e-9);
    /// assert!((fit.slope(3.0) - 6.0).abs() < 1e-9);
    /// assert!(fit.residual_squares < 1e-18);
    /// ```
    pub fn new(samples: &[f64], first: usize, last: usize, degree: usize) -> Option<Self> {
        let last = last.min(samples.len());
        Self::through(samples.get(first..last)?, first, degree)
    }

    /// The same of samples of which the first is at a time.
    pub fn through(values: &[f64], first: usize, degree: usize) -> Option<Self> {
        let count = Some(values.len()).filter(|n| *n > 0)?;
        let degree = degree.min(count.saturating_sub(2)).min(MOST);
        let basis = basis(count, degree)?;
        let mut right = Row::default();
        for (powers, value) in basis.powers.iter().zip(values) {
            for (sum, power) in right.iter_mut().zip(powers) {
                *sum += power * value;
            }
        }
        let rows = basis.covariance.each_ref();
        let coefficients = rows.map(|row| product(row, &right));
        let residual = |(powers, value): (&Row, &f64)| value - product(&coefficients, powers);
        let residuals = basis.powers.iter().zip(values).map(residual);
        let residual_squares = residuals.map(|r| r * r).sum();
        Some(Self {
            coefficients,
            basis,
            origin: 0.5 * (2 * first + count - 1) as f64,
            samples: count,
            residual_squares,
        })
    }

    fn place(&self, time: f64) -> f64 {
        (time - self.origin) / self.basis.scale
    }

    /// Value at a time in steps.
    pub fn value(&self, time: f64) -> f64 {
        product(&self.coefficients, &powers(self.place(time)))
    }

    /// Slope per step at a time in steps.
    pub fn slope(&self, time: f64) -> f64 {
        product(&self.coefficients, &slopes(self.place(time))) / self.basis.scale
    }

    /// Standard error of the value at a time, per unit of noise deviation.
    pub fn error_factor(&self, time: f64) -> f64 {
        self.spread(&powers(self.place(time)))
    }

    /// Standard error of the slope per step at a time, per unit of noise deviation.
    pub fn slope_error_factor(&self, time: f64) -> f64 {
        self.spread(&slopes(self.place(time))) / self.basis.scale
    }

    /// Samples beyond those that determine the polynomial.
    pub fn freedom(&self) -> usize {
        self.samples - self.basis.degree - 1
    }

    /// Standard error of a sum of multiples of the coefficients.
    fn spread(&self, row: &Row) -> f64 {
        let along = self.basis.covariance.map(|of| product(&of, row));
        product(&along, row).max(0.0).sqrt()
    }
}

/// Highest degree of a polynomial.
const MOST: usize = 4;

/// A number for each power.
type Row = [f64; MOST + 1];

fn powers(u: f64) -> Row {
    let square = u * u;
    [1.0, u, square, square * u, square * square]
}

/// Slopes of the powers.
fn slopes(u: f64) -> Row {
    [0.0, 1.0, 2.0 * u, 3.0 * u * u, 4.0 * u * u * u]
}

fn product(a: &Row, b: &Row) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]) + a[4] * b[4]
}

/// What fits of one number of samples and one degree have in common.
#[derive(Debug, PartialEq)]
struct Basis {
    degree: usize,
    /// Of the coefficients, for noise of unit deviation; zero above the degree.
    covariance: [Row; MOST + 1],
    /// Powers of the samples' times about their middle, over the scale.
    powers: Vec<Row>,
    /// Half the number of samples, at least 1.
    scale: f64,
}

impl Basis {
    /// `None` where the samples do not determine the polynomial.
    fn new(count: usize, degree: usize) -> Option<Self> {
        let (middle, scale) = (0.5 * (count - 1) as f64, (0.5 * count as f64).max(1.0));
        let powers: Vec<Row> = (0..count)
            .map(|row| powers((row as f64 - middle) / scale))
            .collect();
        let moment = |i: usize, k: usize| powers.iter().map(|p| p[i] * p[k]).sum();
        let inverse = DMatrix::from_fn(degree + 1, degree + 1, moment).try_inverse()?;
        let of = |i: usize, k: usize| inverse.get((i, k)).copied().unwrap_or(0.0);
        Some(Self {
            degree,
            covariance: std::array::from_fn(|i| std::array::from_fn(|k| of(i, k))),
            powers,
            scale,
        })
    }
}

/// Bases by number of samples and degree.
type Bases = HashMap<(usize, usize), Option<Arc<Basis>>>;

thread_local! {
    /// Those that a thread has found.
    static BASES: RefCell<Bases> = RefCell::default();
}

fn basis(count: usize, degree: usize) -> Option<Arc<Basis>> {
    let find = || Basis::new(count, degree).map(Arc::new);
    let known = |known: &RefCell<Bases>| {
        let mut known = known.borrow_mut();
        known.entry((count, degree)).or_insert_with(find).clone()
    };
    BASES.with(known)
}

/// Time between `low` and `high` (in steps) at which two fits cross, nearest to the middle.
///
/// Newton from the middle; `None` if the fits do not cross within the interval.
pub fn crossing(before: &LocalFit, after: &LocalFit, low: f64, high: f64) -> Option<f64> {
    let mut time = 0.5 * (low + high);
    for _ in 0..20 {
        let gap = before.value(time) - after.value(time);
        let slope = before.slope(time) - after.slope(time);
        if slope == 0.0 {
            return None;
        }
        let next = time - gap / slope;
        if !next.is_finite() || next < low - 1.0 || next > high + 1.0 {
            return None;
        }
        if (next - time).abs() < 1e-9 {
            return Some(next.clamp(low, high));
        }
        time = next;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn valid_a_cubic_is_reproduced_and_extrapolated() {
        let cubic = |t: f64| 1.0 - 0.5 * t + 0.02 * t * t + 1e-3 * t.powi(3);
        let samples: Vec<f64> = (0..30).map(|i| cubic(f64::from(i))).collect();
        let fit = LocalFit::new(&samples, 5, 25, 3).unwrap();
        assert!((fit.value(27.3) - cubic(27.3)).abs() < 1e-9);
        let slope = -0.5 + 0.04 * 10.0 + 3e-3 * 100.0;
        assert!((fit.slope(10.0) - slope).abs() < 1e-9);
    }

    #[test]
    fn valid_crossing_of_a_kink_is_found_between_samples() {
        let kink = 14.37;
        let samples: Vec<f64> = (0..30)
            .map(|i| f64::from(i) - kink)
            .map(|t| if t < 0.0 { t } else { -0.9 * t })
            .collect();
        let before = LocalFit::new(&samples, 4, 15, 2).unwrap();
        let after = LocalFit::new(&samples, 15, 26, 2).unwrap();
        assert!((crossing(&before, &after, 14.0, 15.0).unwrap() - kink).abs() < 1e-8);
    }
}
