//! Separable least squares of a free decay in noise that need not be white: the rates of the decay, a
//! background and two amplitudes.

use nalgebra::{Complex, DMatrix, DVector};

use super::descent::{self, Projected, equations};
use super::noise::Noise;
use super::response::{self, Means};
use super::shape::{Rates, Shape};
use super::watched::MotionSignal;
use crate::signal::columns::dot;

/// Samples of a decay with what is known of them beside it.
#[derive(Debug, Clone)]
pub(super) struct Series {
    pub(super) values: Vec<f64>,
    /// Degree of the polynomial under the decay: 0 for an offset.
    pub(super) degree: usize,
    pub(super) noise: Noise,
    /// What of the motion the values are.
    pub(super) quantity: MotionSignal,
    /// Samples that each value is the mean of.
    pub(super) factor: usize,
    /// Rates, per value, of oscillations that were taken from the values: what their errors leave is fitted too.
    pub(super) taken: Vec<[f64; 2]>,
    /// When dry friction begins, a column of a fit for each: swings after the turning point near the first value, none if it acts
    /// all the time, which is the last one.
    pub(super) frictions: Vec<usize>,
}

/// A fit: the best linear part at given rates.
#[derive(Debug, Clone)]
pub(super) struct Point {
    pub(super) shape: Shape,
    pub(super) rates: Rates,
    /// Background and what is left of oscillations that were taken, then friction where it has columns, that which begins later
    /// first, then the factors of cosine and sine.
    linear: DVector<f64>,
    /// Whitened residuals and the sum of their squares.
    rest: Vec<f64>,
    pub(super) squares: f64,
}

/// Most rounds in which the turning points and the fit follow from each other.
const TURNS: usize = 20;
/// Change of a turning point, of a radian, that moves the motion by less than a thousandth of a part of r.
const TURNED: f64 = 1e-4;

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
            quantity: MotionSignal::default(),
            factor: 1,
            taken: Vec::new(),
            frictions: vec![0],
        }
    }

    /// What its values are.
    fn means(&self) -> Means {
        Means {
            count: self.values.len(),
            factor: self.factor,
            quantity: self.quantity,
        }
    }

    /// When dry friction begins under a shape.
    fn frictions(&self, shape: Shape) -> &[usize] {
        if shape == Shape::Rubbed {
            &self.frictions
        } else {
            &[]
        }
    }

    /// The first values, or others, in white noise.
    pub(super) fn part(&self, values: std::ops::Range<usize>) -> Self {
        Self {
            quantity: self.quantity,
            factor: self.factor,
            ..Self::white(self.values[values].to_vec(), self.degree)
        }
    }

    /// What errors of amplitude, phase, frequency and rate of decay of the oscillations that were taken leave.
    fn left_of_taken(&self) -> Vec<Vec<f64>> {
        let count = self.values.len();
        let of = |[omega, sigma]: &[f64; 2]| {
            let rates = [*omega, *sigma, 0.0, 0.0];
            let both = self.oscillation(Shape::Viscous, &rates);
            let rising = both.each_ref().map(|column| {
                let scaled = column.iter().enumerate();
                scaled.map(|(i, v)| v * i as f64 / count as f64).collect()
            });
            both.into_iter().chain(rising)
        };
        self.taken.iter().flat_map(of).collect()
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

    /// The squares that the background alone leaves.
    pub(super) fn squares_about_background(&self) -> Option<f64> {
        let columns = self.background();
        let (normal, right) = equations(&columns, &self.values);
        let factors = normal.cholesky()?.solve(&right);
        let mut rest = self.values.clone();
        for (column, factor) in columns.iter().zip(factors.iter()) {
            crate::signal::columns::subtract(&mut rest, *factor, column);
        }
        Some(dot(&rest, &rest))
    }

    /// Background, friction where it has a column, cosine and sine at given rates.
    pub(super) fn linear_columns(&self, shape: Shape, rates: &Rates) -> Vec<Vec<f64>> {
        let mut columns = self.background();
        columns.extend(self.left_of_taken());
        let of = |swings: &usize| response::column(&self.means(), *rates, *swings);
        columns.extend(self.frictions(shape).iter().map(of));
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
        let first = columns.len();
        columns.extend(self.slopes(point.shape, &point.rates, point.amplitudes()));
        let frictions = self.frictions(point.shape);
        for (swings, rest) in frictions.iter().zip(point.last(frictions.len())) {
            let of_response = response::slopes(&self.means(), point.rates, *swings);
            for (column, slopes) in columns[first..].iter_mut().zip(&of_response) {
                crate::signal::columns::subtract(column, -rest, slopes);
            }
        }
        columns
    }

    /// Slopes over the free rates of a cosine and a sine of given factors.
    pub(super) fn slopes(&self, shape: Shape, rates: &Rates, [a, b]: [f64; 2]) -> Vec<Vec<f64>> {
        let slopes: Vec<[f64; 4]> = (0..self.values.len())
            .map(|i| {
                let t = i as f64;
                let envelope = shape.envelope(rates, t);
                let (sin, cos) = phase(rates, t).sin_cos();
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
        (0..shape.free()).map(of).collect()
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

    /// Independent values of the noise about the decay's frequency that a fit leaves.
    pub(super) fn freedom(&self, point: &Point) -> f64 {
        let density = self.noise.density(point.rates[0]).max(1.0);
        let independent = self.values.len() as f64 / density;
        (independent - point.parameters() as f64).max(2.0)
    }

    /// Inverse of the normal matrix of the free rates, all linear parts free; that of friction before them where it
    /// has a column.
    pub(super) fn inverse(&self, point: &Point) -> Option<DMatrix<f64>> {
        let columns = self.whitened(&self.columns(point));
        let (normal, _) = equations(&columns, &columns[0]);
        let inverse = normal.cholesky()?.inverse();
        let first = columns.len() - point.shape.free();
        // the friction that is last is before the cosine, the sine and the rates
        let of_friction = point.friction().map(|_| first - 3);
        let wanted: Vec<usize> = of_friction
            .into_iter()
            .chain(first..columns.len())
            .collect();
        Some(inverse.select_rows(&wanted).select_columns(&wanted))
    }

    /// Covariance of the free rates: its mean over the noise that the samples allow.
    pub(super) fn covariance(&self, point: &Point) -> Option<DMatrix<f64>> {
        let of = |noise: &Noise| {
            let own = Self {
                noise: noise.clone(),
                ..self.clone()
            };
            let again = own.project(point.shape, point.rates)?;
            let freedom = self.values.len().checked_sub(point.parameters())?;
            Some(own.inverse(&again)? * (again.squares / freedom.max(1) as f64))
        };
        if self.noise.others.is_empty() {
            return of(&self.noise);
        }
        let size = point.shape.free() + usize::from(point.friction().is_some());
        let zero = DMatrix::zeros(size, size);
        let others = self.noise.others.iter();
        let weighed = others.filter_map(|(weight, noise)| Some((*weight, of(noise)?)));
        let (weight, sum) = weighed.fold((0.0, zero), |(all, sum), (weight, one)| {
            (all + weight, sum + one * weight)
        });
        (weight > 0.0).then(|| sum / weight)
    }

    /// The rates with the least squares. The turning points under friction follow from the fit before: an error of
    /// theirs moves those of the next fit by a part of r/A of it.
    pub(super) fn descend(&self, shape: Shape, start: Rates) -> Option<Point> {
        let mut rates = [0.0; 4];
        if shape != Shape::Rubbed {
            rates[..shape.free()].copy_from_slice(&start[..shape.free()]);
            return self.converge(shape, rates);
        }
        rates[..2].copy_from_slice(&start[..2]);
        let mut point = self.project(Shape::Viscous, rates)?;
        for _ in 0..TURNS {
            let [omega, sigma, _, before] = point.rates;
            let turn = response::turning(point.amplitudes(), &point.rates, self.quantity);
            let settled = point.shape == shape && (turn - before).abs() * omega < TURNED;
            if settled {
                break;
            }
            point = self.converge(shape, [omega, sigma, 0.0, turn])?;
        }
        Some(point)
    }

    /// The rates with the least squares from a start.
    fn converge(&self, shape: Shape, start: Rates) -> Option<Point> {
        let point = self.project(shape, start)?;
        let found = descent::descend(Fit {
            series: self,
            point,
        })?;
        Some(found.point)
    }
}

/// A fit of a series.
struct Fit<'a> {
    series: &'a Series,
    point: Point,
}

impl Projected for Fit<'_> {
    fn rest(&self) -> &[f64] {
        &self.point.rest
    }

    fn squares(&self) -> f64 {
        self.point.squares
    }

    fn columns(&self) -> Vec<Vec<f64>> {
        self.series.whitened(&self.series.columns(&self.point))
    }

    fn free(&self) -> usize {
        self.point.shape.free()
    }

    fn moved(&self, step: &[f64]) -> Option<Self> {
        let mut rates = self.point.rates;
        for (rate, step) in rates.iter_mut().zip(step) {
            *rate += step;
        }
        let oscillates = rates[0] > 0.0 && rates[1].abs() < 2.0 * rates[0];
        let point = self.series.project(self.point.shape, rates);
        let point = point.filter(|_| oscillates)?;
        Some(Self { point, ..*self })
    }
}

fn phase(rates: &Rates, t: f64) -> f64 {
    (rates[0] + 0.5 * rates[2] * t) * t
}

impl Point {
    /// Complex amplitude at the first sample of the displacement whose derivative a fit describes.
    pub(super) fn displacement(&self, quantity: MotionSignal) -> Complex<f64> {
        response::displacement(self.amplitudes(), &self.rates, quantity)
    }

    /// Factors of cosine and sine at the first sample.
    pub(super) fn amplitudes(&self) -> [f64; 2] {
        let count = self.linear.len();
        [self.linear[count - 2], self.linear[count - 1]]
    }

    /// Friction over stiffness that begins first, where it has a column.
    pub(super) fn friction(&self) -> Option<f64> {
        (self.shape == Shape::Rubbed).then(|| self.last(1)[0])
    }

    /// Friction that begins last of a number of them, over stiffness.
    pub(super) fn later_friction(&self, frictions: usize) -> f64 {
        self.last(frictions)[0]
    }

    /// The last factors before those of cosine and sine.
    fn last(&self, count: usize) -> &[f64] {
        let end = self.linear.len() - 2;
        &self.linear.as_slice()[end - count..end]
    }

    /// Constant part of the background.
    pub(super) fn offset(&self) -> f64 {
        self.linear[0]
    }

    /// Range of a background of a degree but for its constant part.
    pub(super) fn drift(&self, degree: usize) -> f64 {
        let powers = self.linear.iter().skip(1).take(degree);
        2.0 * powers.map(|c| c.abs()).sum::<f64>()
    }

    /// The rates per sample of a fit to means of a number of samples.
    pub(super) fn per_sample(&self, factor: usize) -> Rates {
        let factor = factor as f64;
        let [omega, sigma, change, strength] = self.rates.map(|r| r / factor);
        match self.shape {
            // the first mean lies in the middle of its samples
            Shape::Rubbed => [
                omega,
                sigma,
                0.0,
                factor * self.rates[3] + 0.5 * (factor - 1.0),
            ],
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
