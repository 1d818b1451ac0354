//! Separable least squares of a free decay in noise that need not be white: the rates of the decay, a
//! background and two amplitudes.

use nalgebra::{DMatrix, DVector};

use super::noise::Noise;
use super::shape::{Rates, Shape};
use crate::signal::columns::dot;

/// Samples of a decay with what is known of them beside it.
#[derive(Debug, Clone)]
pub(super) struct Series {
    pub(super) values: Vec<f64>,
    /// Degree of the polynomial under the decay: 0 for an offset.
    pub(super) degree: usize,
    pub(super) noise: Noise,
}

/// A fit: the best linear part at given rates.
#[derive(Debug, Clone)]
pub(super) struct Point {
    pub(super) shape: Shape,
    pub(super) rates: Rates,
    /// Background, then the factors of cosine and sine.
    linear: DVector<f64>,
    /// Whitened residuals and the sum of their squares.
    rest: Vec<f64>,
    pub(super) squares: f64,
}

/// Change of χ² that no longer matters: a thousandth of a standard error.
const SETTLED: f64 = 1e-6;

impl Series {
    /// Samples of which nothing is known but an offset and white noise.
    pub(super) fn plain(values: Vec<f64>) -> Self {
        Self::white(values, 0)
    }

    /// Samples in white noise over a background of a degree.
    pub(super) fn white(values: Vec<f64>, degree: usize) -> Self {
        Self {
            values,
            degree,
            noise: Noise::default(),
        }
    }

    /// Legendre's polynomials over the series, up to the third.
    fn background(&self) -> Vec<Vec<f64>> {
        let middle = 0.5 * (self.values.len() as f64 - 1.0);
        let at = |i: usize| (i as f64 - middle) / middle.max(1.0);
        let power = |degree: usize| {
            let value = move |x: f64| match degree {
                0 => 1.0,
                1 => x,
                2 => 1.5 * x * x - 0.5,
                _ => 2.5 * x * x * x - 1.5 * x,
            };
            (0..self.values.len()).map(|i| value(at(i))).collect()
        };
        (0..=self.degree).map(power).collect()
    }

    /// Background, cosine and sine at given rates.
    pub(super) fn linear_columns(&self, shape: Shape, rates: &Rates) -> Vec<Vec<f64>> {
        let mut columns = self.background();
        columns.extend(self.oscillation(shape, rates));
        columns
    }

    /// Cosine and sine at given rates.
    pub(super) fn oscillation(&self, shape: Shape, rates: &Rates) -> [Vec<f64>; 2] {
        let (cosine, sine) = (0..self.values.len())
            .map(|i| {
                let t = i as f64;
                let envelope = shape.envelope(rates, t).value;
                let (sin, cos) = phase(rates, t).sin_cos();
                (envelope * cos, envelope * sin)
            })
            .unzip();
        [cosine, sine]
    }

    /// The best linear part at given rates.
    pub(super) fn project(&self, shape: Shape, rates: Rates) -> Option<Point> {
        let columns = self.whitened(&self.linear_columns(shape, &rates));
        let values = self.noise.whiten(&self.values);
        let (normal, right) = equations(&columns, &values);
        let linear = normal.cholesky()?.solve(&right);
        let mut rest = values;
        for (column, factor) in columns.iter().zip(linear.iter()) {
            crate::signal::columns::subtract(&mut rest, *factor, column);
        }
        let squares = dot(&rest, &rest);
        squares.is_finite().then_some(Point {
            shape,
            rates,
            linear,
            rest,
            squares,
        })
    }

    fn whitened(&self, columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
        columns.iter().map(|c| self.noise.whiten(c)).collect()
    }

    /// All columns of the linearised fit: the linear ones, then the slopes over the free rates.
    pub(super) fn columns(&self, point: &Point) -> Vec<Vec<f64>> {
        let mut columns = self.linear_columns(point.shape, &point.rates);
        let [a, b] = point.amplitudes();
        let slopes: Vec<[f64; 4]> = (0..self.values.len())
            .map(|i| {
                let t = i as f64;
                let envelope = point.shape.envelope(&point.rates, t);
                let (sin, cos) = phase(&point.rates, t).sin_cos();
                let along = a * cos + b * sin;
                let across = envelope.value * (b * cos - a * sin);
                [
                    t * across,
                    envelope.of_sigma * along,
                    0.5 * t * t * across,
                    envelope.of_strength * along,
                ]
            })
            .collect();
        let of = |k: usize| slopes.iter().map(|s| s[k]).collect();
        columns.extend((0..point.shape.free()).map(of));
        columns
    }

    /// Residuals of a fit, not whitened.
    pub(super) fn residuals(&self, point: &Point) -> Vec<f64> {
        let mut rest = self.values.clone();
        let columns = self.linear_columns(point.shape, &point.rates);
        for (column, factor) in columns.iter().zip(point.linear.iter()) {
            crate::signal::columns::subtract(&mut rest, *factor, column);
        }
        rest
    }

    /// Bayes' criterion of a fit with this background and noise (Schwarz 1978).
    pub(super) fn criterion(&self, point: &Point) -> f64 {
        let count = self.values.len() as f64;
        let parameters = (point.parameters() + self.noise.order()) as f64;
        count * point.squares.max(f64::MIN_POSITIVE).ln()
            + 2.0 * self.noise.logarithm()
            + parameters * count.ln()
    }

    /// Inverse of the normal matrix of the free rates, all linear parts free.
    pub(super) fn inverse(&self, point: &Point) -> Option<DMatrix<f64>> {
        let columns = self.whitened(&self.columns(point));
        let (normal, _) = equations(&columns, &columns[0]);
        let inverse = normal.cholesky()?.inverse();
        let (first, free) = (columns.len() - point.shape.free(), point.shape.free());
        Some(inverse.view((first, first), (free, free)).into_owned())
    }

    /// Covariance of the free rates: its mean over the noise that the samples allow.
    pub(super) fn covariance(&self, point: &Point) -> Option<DMatrix<f64>> {
        let of = |noise: &Noise| {
            let own = Self {
                values: self.values.clone(),
                degree: self.degree,
                noise: noise.clone(),
            };
            let again = own.project(point.shape, point.rates)?;
            let freedom = self.values.len().checked_sub(point.parameters())?;
            Some(own.inverse(&again)? * (again.squares / freedom.max(1) as f64))
        };
        if self.noise.others.is_empty() {
            return of(&self.noise);
        }
        let zero = DMatrix::zeros(point.shape.free(), point.shape.free());
        let others = self.noise.others.iter();
        let weighed = others.filter_map(|(weight, noise)| Some((*weight, of(noise)?)));
        let (weight, sum) = weighed.fold((0.0, zero), |(all, sum), (weight, one)| {
            (all + weight, sum + one * weight)
        });
        (weight > 0.0).then(|| sum / weight)
    }

    /// The rates with the least squares, by Levenberg and Marquardt.
    pub(super) fn descend(&self, shape: Shape, start: Rates) -> Option<Point> {
        let mut rates = [0.0; 4];
        rates[..shape.free()].copy_from_slice(&start[..shape.free()]);
        let mut point = self.project(shape, rates)?;
        let mut damping = 1e-3;
        for _ in 0..40 {
            let columns = self.whitened(&self.columns(&point));
            let (mut normal, right) = equations(&columns, &point.rest);
            let first = columns.len() - shape.free();
            for k in first..columns.len() {
                normal[(k, k)] *= 1.0 + damping;
            }
            let step = normal.cholesky()?.solve(&right);
            let mut rates = point.rates;
            for (k, rate) in rates.iter_mut().take(shape.free()).enumerate() {
                *rate += step[first + k];
            }
            let next = self.project(shape, rates).filter(|n| {
                n.squares <= point.squares
                    && n.rates[0] > 0.0
                    && n.rates[1].abs() < 2.0 * n.rates[0]
            });
            match next {
                Some(next) => {
                    let gained = point.squares - next.squares;
                    point = next;
                    damping *= 0.2;
                    if gained <= SETTLED * point.squares / self.values.len() as f64 {
                        break;
                    }
                }
                None if damping > 1e6 => break,
                None => damping = (damping * 10.0).max(1e-5),
            }
        }
        Some(point)
    }
}

fn phase(rates: &Rates, t: f64) -> f64 {
    (rates[0] + 0.5 * rates[2] * t) * t
}

/// Normal matrix and right side.
pub(super) fn equations(columns: &[Vec<f64>], values: &[f64]) -> (DMatrix<f64>, DVector<f64>) {
    let count = columns.len();
    let mut normal = DMatrix::zeros(count, count);
    for i in 0..count {
        for k in 0..=i {
            let product = dot(&columns[i], &columns[k]);
            normal[(i, k)] = product;
            normal[(k, i)] = product;
        }
    }
    let right = DVector::from_iterator(count, columns.iter().map(|c| dot(c, values)));
    (normal, right)
}

impl Point {
    /// Factors of cosine and sine at the first sample.
    pub(super) fn amplitudes(&self) -> [f64; 2] {
        let count = self.linear.len();
        [self.linear[count - 2], self.linear[count - 1]]
    }

    /// Constant part of the background.
    pub(super) fn offset(&self) -> f64 {
        self.linear[0]
    }

    /// Range of the background but for its constant part.
    pub(super) fn drift(&self) -> f64 {
        let beyond = self.linear.len() - 3;
        2.0 * self
            .linear
            .iter()
            .skip(1)
            .take(beyond)
            .map(|c| c.abs())
            .sum::<f64>()
    }

    /// The rates per sample of a fit to means of a number of samples.
    pub(super) fn per_sample(&self, factor: usize) -> Rates {
        let factor = factor as f64;
        let [omega, sigma, change, strength] = self.rates.map(|r| r / factor);
        match self.shape {
            Shape::Bent => [omega, sigma, change / factor, strength / factor],
            _ => [omega, sigma, change / factor, strength],
        }
    }

    /// The decay at each of a number of samples, without the background.
    pub(super) fn values(&self, count: usize) -> Vec<f64> {
        let [a, b] = self.amplitudes();
        let value = |i: usize| {
            let t = i as f64;
            let (sin, cos) = phase(&self.rates, t).sin_cos();
            self.shape.envelope(&self.rates, t).value * (a * cos + b * sin)
        };
        (0..count).map(value).collect()
    }

    /// Root mean square of the decay over a number of samples.
    pub(super) fn level(&self, count: usize) -> f64 {
        crate::signal::robust::rms(&self.values(count))
    }

    /// Degrees of freedom that the fit takes.
    pub(super) fn parameters(&self) -> usize {
        self.linear.len() + self.shape.free()
    }
}
