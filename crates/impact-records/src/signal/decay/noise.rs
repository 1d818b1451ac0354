//! Noise beside a decay: white, or autoregressive of a low order.

use nalgebra::DMatrix;

use crate::signal::columns::dot;

/// Highest order.
const HIGHEST: usize = 8;
/// Highest order of short series, whose fit takes part of the noise with it.
const HIGHEST_RESTRICTED: usize = 3;
/// Samples up to which the order is fitted by restricted likelihood.
const RESTRICTED: usize = 600;
/// Samples from which an order is fitted, one for each.
const PER_ORDER: usize = 10;

/// Autoregressive noise by its partial autocorrelations.
#[derive(Debug, Clone, Default)]
pub(super) struct Noise {
    /// Predictors of the orders 1, 2 … (Levinson and Durbin).
    predictors: Vec<Vec<f64>>,
    /// Standard deviation of what each predictor leaves, over that of the last; the first is of none.
    deviations: Vec<f64>,
    /// Noise that the samples would allow too, of a short series, with its likelihood.
    pub(super) others: Vec<(f64, Self)>,
}

impl Noise {
    fn of(partial: &[f64]) -> Self {
        let mut predictors: Vec<Vec<f64>> = Vec::with_capacity(partial.len());
        for (order, p) in partial.iter().enumerate() {
            let before = order.checked_sub(1).map_or(&[][..], |o| &predictors[o]);
            let mut own: Vec<f64> = (0..order)
                .map(|k| before[k] - p * before[order - 1 - k])
                .collect();
            own.push(*p);
            predictors.push(own);
        }
        let mut deviations = vec![1.0; partial.len()];
        let mut product = 1.0;
        for (k, p) in partial.iter().enumerate().rev() {
            product /= (1.0 - p * p).sqrt();
            deviations[k] = product;
        }
        Self {
            predictors,
            deviations,
            others: Vec::new(),
        }
    }

    /// A series whose noise is white of the variance of the innovations.
    pub(super) fn whiten(&self, series: &[f64]) -> Vec<f64> {
        let order = self.predictors.len();
        let mut out = Vec::with_capacity(series.len());
        for (i, value) in series.iter().enumerate() {
            let known = i.min(order);
            let Some(predictor) = known.checked_sub(1).map(|k| &self.predictors[k]) else {
                out.push(value / self.deviations.first().copied().unwrap_or(1.0));
                continue;
            };
            let before = series[i - known..i].iter().rev();
            let predicted: f64 = predictor.iter().zip(before).map(|(p, v)| p * v).sum();
            let scale = self.deviations.get(i).copied().unwrap_or(1.0);
            out.push((value - predicted) / scale);
        }
        out
    }

    /// Spectral density at a frequency, rad per sample, over that of white noise of the same variance.
    pub(super) fn density(&self, omega: f64) -> f64 {
        let (mut re, mut im) = (1.0, 0.0);
        for (k, p) in self.predictors.last().into_iter().flatten().enumerate() {
            let (sin, cos) = (omega * (k + 1) as f64).sin_cos();
            re -= p * cos;
            im += p * sin;
        }
        let variance = self.deviations.first().map_or(1.0, |d| d * d);
        1.0 / (re * re + im * im) / variance
    }

    /// Density at a frequency over that at half the rate, as a ratio of standard deviations; one or more.
    pub(super) fn slow(&self, omega: f64) -> f64 {
        (self.density(omega) / self.density(std::f64::consts::PI))
            .max(1.0)
            .sqrt()
    }

    /// The noise that residuals show, of a fit with the given columns (which take part of it with them).
    pub(super) fn fitted(residuals: &[f64], columns: &[Vec<f64>]) -> Self {
        let highest = (residuals.len() / PER_ORDER).min(HIGHEST);
        if residuals.len() > RESTRICTED {
            return Self::of(&burg(residuals, highest));
        }
        restricted(residuals, columns, highest.min(HIGHEST_RESTRICTED))
    }

    /// Order of the regression.
    pub(super) fn order(&self) -> usize {
        self.predictors.len()
    }

    /// Half the logarithm of the determinant of the noise's covariance, of innovations of variance one.
    pub(super) fn logarithm(&self) -> f64 {
        self.deviations.iter().map(|d| d.ln()).sum()
    }

    /// −2 ln of the restricted likelihood (Patterson and Thompson 1971), but for a constant, of residuals beside
    /// columns by their lagged products.
    fn criterion(&self, lagged: &Lagged) -> Option<f64> {
        let white = lagged.whitened(self);
        let count = white.nrows() - 1;
        let normal = white.view((0, 0), (count, count)).into_owned();
        let right = white.view((0, count), (count, 1)).into_owned();
        let factor = normal.cholesky()?;
        let explained = right.dot(&factor.solve(&right));
        let squares = white[(count, count)] - explained;
        let of_columns: f64 = factor.l_dirty().diagonal().iter().map(|d| d.ln()).sum();
        let freedom = lagged.samples.checked_sub(count).filter(|f| *f > 0)? as f64;
        let value =
            freedom * squares.max(f64::MIN_POSITIVE).ln() + 2.0 * (of_columns + self.logarithm());
        value.is_finite().then_some(value)
    }
}

/// Products of columns and residuals with each other at all lags of a regression: the likelihood of any noise
/// follows from them whatever the number of samples.
struct Lagged {
    samples: usize,
    /// The first samples of each column and of the residuals, which have fewer than all predecessors.
    heads: Vec<Vec<f64>>,
    /// Sums of products of samples `a` and `b` before those that have all predecessors, by `a` and `b`.
    products: Vec<Vec<DMatrix<f64>>>,
}

impl Lagged {
    fn of(residuals: &[f64], columns: &[Vec<f64>], order: usize) -> Self {
        let all: Vec<&[f64]> = columns
            .iter()
            .map(Vec::as_slice)
            .chain([residuals])
            .collect();
        let samples = residuals.len();
        let delayed = |i: usize, by: usize| &all[i][order - by..samples - by];
        let between = |a: usize, b: usize| {
            DMatrix::from_fn(all.len(), all.len(), |i, k| {
                dot(delayed(i, a), delayed(k, b))
            })
        };
        let lags = 0..=order;
        Self {
            samples,
            heads: all.iter().map(|c| c[..order].to_vec()).collect(),
            products: lags
                .clone()
                .map(|a| lags.clone().map(|b| between(a, b)).collect())
                .collect(),
        }
    }

    /// Products of the columns and the residuals, whitened by a noise of the same order.
    fn whitened(&self, noise: &Noise) -> DMatrix<f64> {
        let predictor = noise.predictors.last().into_iter().flatten();
        let factors: Vec<f64> = std::iter::once(1.0).chain(predictor.map(|p| -p)).collect();
        let heads: Vec<Vec<f64>> = self.heads.iter().map(|h| noise.whiten(h)).collect();
        let size = heads.len();
        let mut out = DMatrix::from_fn(size, size, |i, k| dot(&heads[i], &heads[k]));
        for (a, row) in factors.iter().zip(&self.products) {
            for (b, product) in factors.iter().zip(row) {
                out += product * (a * b);
            }
        }
        out
    }
}

/// Partial autocorrelations by Burg's recursion, of the order with the least corrected criterion of Akaike.
fn burg(residuals: &[f64], highest: usize) -> Vec<f64> {
    let count = residuals.len() as f64;
    let mut forward = residuals.to_vec();
    let mut backward = residuals.to_vec();
    let mut variance = dot(residuals, residuals) / count;
    let mut partial: Vec<f64> = Vec::with_capacity(highest);
    let mut best = (count * variance.max(f64::MIN_POSITIVE).ln(), 0);
    for order in 1..=highest {
        let ahead = &forward[order..];
        let behind = &backward[order - 1..backward.len() - 1];
        let power = dot(ahead, ahead) + dot(behind, behind);
        if !(power > 0.0) {
            break;
        }
        let p = (2.0 * dot(ahead, behind) / power).clamp(-GREATEST, GREATEST);
        partial.push(p);
        variance *= 1.0 - p * p;
        for i in (order..forward.len()).rev() {
            let (f, b) = (forward[i], backward[i - 1]);
            forward[i] = f - p * b;
            backward[i] = b - p * f;
        }
        let own = (order + 1) as f64;
        let criterion = count * variance.max(f64::MIN_POSITIVE).ln()
            + 2.0 * own * count / (count - own - 1.0).max(1.0);
        if criterion < best.0 {
            best = (criterion, order);
        }
    }
    partial.truncate(best.1);
    partial
}

/// Root mean square of the part of residuals that neighbours share. White noise has a mean squared
/// difference of neighbours of twice its variance (von Neumann's ratio); what is above that is structure.
pub(super) fn structured(residuals: &[f64]) -> f64 {
    let count = residuals.len().max(2) as f64;
    let all = dot(residuals, residuals) / count;
    let steps: f64 = residuals.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum();
    (all - 0.5 * steps / (count - 1.0)).max(0.0).sqrt()
}

/// Greatest partial autocorrelation.
const GREATEST: f64 = 0.9999;

/// What −2 ln of the likelihood must gain for a further order: its 95 % point by chance.
const DEARER: f64 = 3.84;

/// The order, one at least, and the partial autocorrelations of the greatest restricted likelihood.
fn restricted(residuals: &[f64], columns: &[Vec<f64>], highest: usize) -> Noise {
    let lagged: Vec<Lagged> = (0..=highest)
        .map(|order| Lagged::of(residuals, columns, order))
        .collect();
    let value = |turned: &[f64]| {
        let partial: Vec<f64> = turned.iter().map(|u| GREATEST * u.tanh()).collect();
        let found = Noise::of(&partial).criterion(&lagged[turned.len()]);
        found.unwrap_or(f64::INFINITY)
    };
    let mut turned: Vec<f64> = Vec::new();
    let mut best = (f64::INFINITY, turned.clone());
    for order in 1..=highest {
        turned.push(0.0);
        let mut reached = f64::INFINITY;
        for round in 0..12 {
            let before = reached;
            for k in 0..order {
                let width = if round == 0 { 3.0 } else { 0.5 };
                reached = line_search(&value, &mut turned, k, width);
            }
            if before - reached < 1e-3 {
                break;
            }
        }
        let criterion = reached + DEARER * order as f64;
        if criterion <= best.0 {
            best = (criterion, turned.clone());
        }
    }
    let noise = |turned: &[f64]| {
        let partial: Vec<f64> = turned.iter().map(|u| GREATEST * u.tanh()).collect();
        Noise::of(&partial)
    };
    let mut found = noise(&best.1);
    let least = value(&best.1);
    // likelihood times the width of a step of the first correlation, which is as likely anywhere
    let other = |step: i32| {
        let mut turned = best.1.clone();
        *turned.first_mut()? += STEP * f64::from(step);
        let width = turned[0].cosh().powi(-2);
        let weight = (0.5 * (least - value(&turned))).exp() * width;
        (weight > 0.0).then(|| (weight, noise(&turned)))
    };
    found.others = (-8..=12).filter_map(other).collect();
    found
}

/// Step between correlations that are tried, of the inverse hyperbolic tangent.
const STEP: f64 = 0.2;

/// Golden section over one coordinate within a width about it; gives the least value.
fn line_search(
    value: &impl Fn(&[f64]) -> f64,
    at: &mut [f64],
    coordinate: usize,
    width: f64,
) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let centre = at[coordinate];
    let mut of = |x: f64| {
        at[coordinate] = x;
        value(at)
    };
    let (mut low, mut high) = (centre - width, centre + width);
    let mut inner = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let mut values = inner.map(&mut of);
    while high - low > 0.02 {
        if values[0] < values[1] {
            high = inner[1];
            inner = [high - GOLDEN * (high - low), inner[0]];
            values = [of(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + GOLDEN * (high - low)];
            values = [values[1], of(inner[1])];
        }
    }
    let best = if values[0] < values[1] { 0 } else { 1 };
    at[coordinate] = inner[best];
    values[best]
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    fn autoregressive(first: f64, second: f64, count: usize, seed: u64) -> Vec<f64> {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let mut out = vec![0.0, 0.0];
        for i in 2..count + 200 {
            let shock: f64 = StandardNormal.sample(&mut rng);
            out.push(first * out[i - 1] + second * out[i - 2] + shock);
        }
        out.split_off(200)
    }

    #[test]
    fn valid_whitened_noise_of_the_second_order_is_white_and_of_the_innovations_variance() {
        let series = autoregressive(1.2, -0.5, 20_000, 3);
        let noise = Noise::fitted(&series, &[]);
        let white = noise.whiten(&series);
        let variance = dot(&white, &white) / white.len() as f64;
        assert!((variance - 1.0).abs() < 0.03, "{variance}");
        let lag: f64 = white.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / dot(&white, &white);
        assert!(lag.abs() < 0.03, "{lag}");
        // |1 − 1.2 e^{−iω} + 0.5 e^{−2iω}|⁻² at ω = 0, over the variance 1.5/(0.5·(1.5² − 1.2²))
        let exact = 1.0 / 0.09 / (1.5 / (0.5 * (1.5f64.powi(2) - 1.2f64.powi(2))));
        assert!((noise.density(0.0) / exact - 1.0).abs() < 0.15);
    }

    #[test]
    fn valid_lagged_products_give_those_of_whitened_series() {
        let residuals = autoregressive(0.7, 0.2, 80, 5);
        let columns = [autoregressive(0.1, 0.0, 80, 6), vec![1.0; 80]];
        for partial in [&[][..], &[0.6], &[0.9, -0.3], &[0.5, 0.4, -0.2]] {
            let noise = Noise::of(partial);
            let found = Lagged::of(&residuals, &columns, partial.len()).whitened(&noise);
            let mut all: Vec<Vec<f64>> = columns.iter().map(|c| noise.whiten(c)).collect();
            all.push(noise.whiten(&residuals));
            for i in 0..3 {
                for k in 0..3 {
                    let direct = dot(&all[i], &all[k]);
                    assert!((found[(i, k)] - direct).abs() < 1e-9 * 80.0, "{partial:?}");
                }
            }
        }
    }

    #[test]
    fn valid_restricted_likelihood_meets_the_order_that_a_fitted_line_takes_with_it() {
        // Over many short series from which a parabola was fitted, the mean of the correlation is nearly unbiased: that of the residuals is below 0.6.
        let count = 60;
        let columns: Vec<Vec<f64>> = (0..3i32)
            .map(|k| {
                (0..count)
                    .map(|i| (i as f64 / 30.0 - 1.0).powi(k))
                    .collect()
            })
            .collect();
        let found: Vec<f64> = (0..200)
            .map(|seed| {
                let series = autoregressive(0.7, 0.0, count, seed);
                restricted(&series, &columns, 1)
                    .predictors
                    .first()
                    .map_or(0.0, |p| p[0])
            })
            .collect();
        let mean = found.iter().sum::<f64>() / 200.0;
        assert!((mean - 0.7).abs() < 0.05, "{mean}");
    }
}
