//! How far R of rows of flights may be off: by errors of the times, and as R itself scatters from impact to impact.
//! Errors of heights stand for those of the times where heights are listed.
//!
//! The logarithm of each flight over the one before is ln R + ρ + e. ρ is independent from impact to impact; e follows
//! from the errors of three times, so that e of neighbours are correlated. In these correlations it shows which is
//! which, in a short row hardly. So R is an average over the ratio of their variances, each with its restricted
//! likelihood (Harville 1974) with the variances' scale integrated out: what rows do not tell is in its error.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::methods::flight_times::fall::Fall;
use crate::methods::flight_times::rows::{Fitted, Listed, Row, fitted_times};
use impact_records::signal::{columns, robust};

/// Standard error of a time that neither its source nor the scatter states, s.
const USUAL_ERROR_S: f64 = 2e-3;
/// That of a height, m: one read beside a rule.
const USUAL_ERROR_M: f64 = 1e-2;
/// Degrees of freedom from which a trend is looked at.
const ENOUGH: f64 = 2.0;
/// Ratios of the variances in a factor of ten.
const PER_DECADE: f64 = 4.0;
/// How far beyond the variances of the times' errors those of R are tried, to where the other no longer counts.
const BEYOND: f64 = 10.0;
/// Probability from which it is R that scatters.
const SURE: f64 = 0.95;

/// What is known of the errors of what is listed, s or m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known {
    /// The least that each may be off: by its last digit, or as it is stated.
    pub(super) least: Option<f64>,
    /// Whether `least` is its standard error as the laboratory states it.
    pub(super) told: bool,
    /// Whether heights are listed.
    pub(super) heights: bool,
}

impl Known {
    /// Of times with so great an error by their last digit, s.
    pub(super) fn of_times(least: Option<f64>) -> Self {
        Self {
            least,
            told: false,
            heights: false,
        }
    }

    /// The error of one row that nothing else tells, and its degrees of freedom.
    fn of_one_row(self) -> f64 {
        let usual = if self.heights {
            USUAL_ERROR_M
        } else {
            USUAL_ERROR_S
        };
        let least = self.least.unwrap_or(0.0);
        if self.told { least } else { least.max(usual) }
    }
}

/// What rows tell of R.
pub(super) struct Scatter {
    /// Each row's.
    pub(super) rows: Vec<RowEstimate>,
    /// Degrees of freedom of their errors, the scatter between rows where none is left in them; infinite where nothing
    /// tells the errors of the times.
    pub(super) freedom: f64,
    /// Scatter of the times, s, or of the heights, m; not known where it is R that scatters.
    pub(super) listed: Option<f64>,
    /// Whether anything tells the errors of what is listed.
    pub(super) told: bool,
    /// Relative standard deviation of R from impact to impact, where it is R that scatters.
    pub(super) own: Option<f64>,
}

/// What a row tells of R.
pub(super) struct RowEstimate {
    /// R.
    pub(super) restitution: f64,
    /// Its standard error.
    pub(super) error: f64,
    /// Relative standard error of each ratio.
    pub(super) ratio_errors: Vec<f64>,
    /// Weights of the ratios' logarithms in that of R; their sum is one.
    pub(super) weights: Vec<f64>,
}

impl Scatter {
    /// Of rows with their fits.
    pub(super) fn of(fits: &[(&Row, Fitted)], known: Known) -> Self {
        let stated = known.least;
        let ratios = Ratios::of(fits.iter().map(|(row, _)| *row));
        let mix = |with_slope| ratios.mixed(with_slope, stated);
        let least = stated.unwrap_or(0.0);
        let Some(mixed) = mix(false) else {
            // three times in each row: what a source prints is the least that they may be off
            let error = match fits.len() {
                1 => (known.of_one_row(), f64::INFINITY),
                rows => (least, (rows - 1) as f64),
            };
            return Self::by_errors(fits, &ratios, error, known.told);
        };
        let within = fits.iter().enumerate().all(|(i, (_, fit))| {
            let (_, error) = mixed.logarithm(i);
            fit.restitution * error <= fit.error_per_unit * least
        });
        if within {
            // digits are the least that the times may be off, and a scatter within them may be one by chance
            let freedom = if known.told {
                f64::INFINITY
            } else {
                mixed.freedom
            };
            return Self::by_errors(fits, &ratios, (least, freedom), true);
        }
        let rows = fits.iter().enumerate().map(|(i, (_, fit))| {
            let (mean, error) = mixed.logarithm(i);
            // the fit of the times takes curvature into account that logarithms do not
            let restitution = fit.restitution * (mean - ratios.by_errors(i)).exp();
            RowEstimate {
                restitution,
                error: (restitution * error).max(fit.error_per_unit * least),
                ratio_errors: mixed.ratio_errors(&ratios, i),
                weights: mixed.weights(i),
            }
        });
        // a change along the bounces is neither
        let beside = mix(true);
        let beside = beside.as_ref().unwrap_or(&mixed);
        let own = beside.own();
        Self {
            rows: rows.collect(),
            freedom: mixed.freedom,
            listed: own.is_none().then(|| beside.listed(&ratios)),
            told: true,
            own,
        }
    }

    /// With errors of what is listed, of so many degrees of freedom, and one R.
    fn by_errors(
        fits: &[(&Row, Fitted)],
        ratios: &Ratios,
        (error, freedom): (f64, f64),
        told: bool,
    ) -> Self {
        let rows = fits.iter().enumerate().map(|(i, (_, fit))| RowEstimate {
            restitution: fit.restitution,
            error: fit.error_per_unit * error,
            ratio_errors: ratios.rows[i]
                .by_errors
                .diagonal()
                .iter()
                .map(|v| error * v.sqrt())
                .collect(),
            weights: ratios.rows[i].weights_by_errors().data.into(),
        });
        Self {
            rows: rows.collect(),
            freedom,
            listed: Some(error),
            told: told || freedom.is_finite(),
            own: None,
        }
    }
}

/// A change of R along the bounces.
pub(super) struct Trend {
    /// In standard errors.
    pub(super) deviates: f64,
    /// Degrees of freedom of that error.
    pub(super) freedom: f64,
    /// R's change over the longest row.
    pub(super) change: f64,
    /// R at the least and at the greatest of what it is a line over: the bounce, or the height.
    pub(super) ends: [f64; 2],
}

/// Least ratio of the greatest height of a fall to the least one over which R may be a line: falls from one height scatter
/// with the rebounds, whose R goes with them.
const HEIGHTS_DIFFER: f64 = 1.2;

/// Whether all falls are from one height.
fn from_one_height(fits: &[(&Row, Fitted)]) -> bool {
    let falls = fits.iter().filter_map(|(row, _)| row.falls()).flatten();
    let heights: Vec<f64> = falls.map(|fall| fall.before_m).collect();
    let (least, greatest) = columns::extremes(&heights);
    !heights.is_empty() && greatest < HEIGHTS_DIFFER * least
}

/// How R changes along the bounces of rows, its logarithm a line over their number, or over the height, with one slope
/// for all.
pub(super) fn trend(fits: &[(&Row, Fitted)], stated_s: Option<f64>) -> Option<Trend> {
    if from_one_height(fits) {
        return None;
    }
    let ratios = Ratios::of(fits.iter().map(|(row, _)| *row));
    let mixed = ratios
        .mixed(true, stated_s)
        .filter(|m| m.freedom >= ENOUGH)?;
    let (slope, error) = mixed.average(|share| share.slope);
    let places = |row: &RatioRow| columns::extremes(row.places.as_slice());
    let spans = ratios.rows.iter().map(places);
    let longest = spans
        .clone()
        .map(|(low, high)| high - low)
        .fold(0.0, f64::max);
    let typical = robust::median(&fits.iter().map(|(_, f)| f.restitution).collect::<Vec<_>>())?;
    let all = ratios.rows.iter().flat_map(|r| r.places.iter().copied());
    let all: Vec<f64> = all.collect();
    let centre = robust::mean(&all);
    let (low, high) = columns::extremes(&all);
    Some(Trend {
        deviates: slope / error,
        freedom: mixed.freedom,
        ends: [low, high].map(|place| typical * (slope * (place - centre)).exp()),
        change: (typical * slope * longest).abs(),
    })
}

/// R by the errors of what is listed alone.
pub(super) fn fitted(row: &Row) -> Option<Fitted> {
    match &row.listed {
        Listed::Times(times_s) => fitted_times(times_s),
        Listed::Heights(_) => RatioRow::of(row).fitted(),
    }
}

/// The logarithms of a row's ratios, with their covariance for independent errors of 1 s of each time, or of 1 m of each
/// height.
pub(super) struct RatioRow {
    pub(super) values: DVector<f64>,
    /// What R may change along: the number of the bounce in the row, or the mean height before and after it, m.
    pub(super) places: DVector<f64>,
    by_errors: DMatrix<f64>,
}

/// Those of all rows.
pub(super) struct Ratios {
    pub(super) rows: Vec<RatioRow>,
    /// Least, median and greatest variance of a logarithm for errors of 1 s.
    variances: [f64; 3],
}

impl Ratios {
    pub(super) fn of<'a>(rows: impl Iterator<Item = &'a Row>) -> Self {
        let rows: Vec<RatioRow> = rows.map(RatioRow::of).collect();
        let diagonals = rows
            .iter()
            .flat_map(|r| r.by_errors.diagonal().data.as_vec().clone());
        let all: Vec<f64> = diagonals.collect();
        let (least, greatest) = columns::extremes(&all);
        let median = robust::median(&all).unwrap_or(1.0);
        Self {
            rows,
            variances: [least, median, greatest],
        }
    }

    /// The mean of a row's logarithms as errors of the times weigh them.
    fn by_errors(&self, row: usize) -> f64 {
        let row = &self.rows[row];
        row.weights_by_errors().dot(&row.values)
    }

    /// Degrees of freedom about one R of each row.
    pub(super) fn freedom(&self) -> f64 {
        let count: usize = self.rows.iter().map(|r| r.values.len()).sum();
        count.saturating_sub(self.rows.len()) as f64
    }

    /// Variances of R's logarithm that are tried, over that of the median logarithm by errors of the times.
    pub(super) fn own_variances(&self) -> impl Iterator<Item = f64> + use<> {
        let [least, median, greatest] = self.variances;
        let [low, high] = [least / BEYOND / median, greatest * BEYOND / median].map(f64::log10);
        let steps = whole_steps(low, high);
        (0..=steps).map(move |k| 10f64.powf(low + k as f64 / PER_DECADE))
    }

    /// Covariance of a row's logarithms over the variance of the median one by errors of the times.
    pub(super) fn covariance(&self, row: &RatioRow, own: f64) -> DMatrix<f64> {
        let count = row.values.len();
        &row.by_errors / self.variances[1] + DMatrix::identity(count, count) * own
    }

    /// Variance of the median logarithm for so large an error of each time, s.
    pub(super) fn of_times(&self, error_s: f64) -> f64 {
        self.variances[1] * error_s * error_s
    }

    /// −ln of how likely a variance of the median logarithm is: errors of the times far beyond those that their source
    /// states are less so, by Cauchy's distribution about these.
    pub(super) fn beyond(&self, variance: f64, stated_s: Option<f64>) -> f64 {
        stated_s.map_or(0.0, |s| (variance / self.of_times(s)).ln_1p())
    }

    /// The estimates for each ratio of the variances; `None` without one that can be computed.
    fn mixed(&self, with_slope: bool, stated_s: Option<f64>) -> Option<Mixed> {
        let freedom = self.freedom() - f64::from(u8::from(with_slope));
        if freedom <= 0.0 {
            return None;
        }
        let own = self.own_variances();
        let shares = own.filter_map(|own| Share::of(self, own, (freedom, with_slope)));
        let mut shares: Vec<Share> = shares.collect();
        for share in &mut shares {
            share.weight -= self.beyond(share.scale, stated_s);
        }
        let best = shares
            .iter()
            .map(|s| s.weight)
            .fold(f64::NEG_INFINITY, f64::max);
        for share in &mut shares {
            share.weight = (share.weight - best).exp();
        }
        best.is_finite().then_some(Mixed { shares, freedom })
    }
}

fn whole_steps(low: f64, high: f64) -> usize {
    impact_records::signal::whole::index(((high - low) * PER_DECADE).ceil())
}

impl RatioRow {
    pub(super) fn of(row: &Row) -> Self {
        match &row.listed {
            Listed::Times(times_s) => Self::of_times(times_s),
            Listed::Heights(falls) => Self::of_heights(falls),
        }
    }

    fn of_heights(falls: &[Fall]) -> Self {
        let count = falls.len();
        let by_errors = DMatrix::from_fn(count, count, |i, k| Fall::covariance(falls, i, k));
        Self {
            values: DVector::from_fn(count, |k, _| {
                0.5 * (falls[k].after_m / falls[k].before_m).ln()
            }),
            places: DVector::from_fn(count, |k, _| 0.5 * (falls[k].after_m + falls[k].before_m)),
            by_errors,
        }
    }

    fn of_times(times_s: &[f64]) -> Self {
        let flights: Vec<f64> = times_s.windows(2).map(|w| w[1] - w[0]).collect();
        let count = flights.len().saturating_sub(1);
        let values = DVector::from_fn(count, |k, _| (flights[k + 1] / flights[k]).ln());
        // slopes over the three times of each
        let slopes = |k: usize| {
            let (before, after) = (flights[k].recip(), flights[k + 1].recip());
            [before, -(before + after), after]
        };
        let by_errors = DMatrix::from_fn(count, count, |i, k| {
            let (a, b) = (slopes(i), slopes(k));
            // time number i + n of the row is number i + n − k of ratio k
            let shared = |n: usize| (n + i).checked_sub(k).and_then(|m| b.get(m)).copied();
            (0..3).map(|n| a[n] * shared(n).unwrap_or(0.0)).sum::<f64>()
        });
        Self {
            values,
            places: DVector::from_fn(count, |k, _| k as f64),
            by_errors,
        }
    }

    pub(super) fn by_errors(&self) -> &DMatrix<f64> {
        &self.by_errors
    }

    /// Its R as errors of what is listed weigh it.
    pub(super) fn fitted(&self) -> Option<Fitted> {
        let weighing = Weighing::of(self.by_errors.clone())?;
        let restitution = weighing.mean(&self.values).exp();
        Some(Fitted {
            restitution,
            error_per_unit: restitution / weighing.information.sqrt(),
        })
    }

    /// The weights of its logarithms in their mean as errors of the times weigh them.
    fn weights_by_errors(&self) -> DVector<f64> {
        let count = self.values.len();
        let weighing = Weighing::of(self.by_errors.clone());
        weighing.map_or_else(
            || DVector::from_element(count, (count as f64).recip()),
            |weighing| weighing.shares(),
        )
    }
}

/// How values with a covariance are weighed in their mean.
pub(super) struct Weighing {
    pub(super) factor: Cholesky<f64, Dyn>,
    /// Weights whose sum is the information.
    weights: DVector<f64>,
    /// Reciprocal variance of the mean.
    information: f64,
}

impl Weighing {
    /// `None` where the covariance is not positive definite.
    pub(super) fn of(covariance: DMatrix<f64>) -> Option<Self> {
        let ones = DVector::from_element(covariance.nrows(), 1.0);
        let factor = covariance.cholesky()?;
        let weights = factor.solve(&ones);
        Some(Self {
            information: weights.sum(),
            weights,
            factor,
        })
    }

    pub(super) fn mean(&self, values: &DVector<f64>) -> f64 {
        self.weights.dot(values) / self.information
    }

    /// Values about their mean.
    pub(super) fn centred(&self, values: &DVector<f64>) -> DVector<f64> {
        values.add_scalar(-self.mean(values))
    }

    /// Weights whose sum is one.
    fn shares(&self) -> DVector<f64> {
        &self.weights / self.information
    }

    /// −½ ln of the determinants of the covariance and of the information.
    pub(super) fn logarithm(&self) -> f64 {
        let diagonal = self.factor.l_dirty().diagonal();
        let halves: f64 = diagonal.iter().map(|d| d.ln()).sum();
        -halves - 0.5 * self.information.ln()
    }
}

/// The estimates for one ratio of the variances.
struct Share {
    /// Logarithm of the restricted likelihood; once compared, the likelihood over the greatest.
    weight: f64,
    /// Variance of R's logarithm over that of the median logarithm by errors of the times.
    own: f64,
    /// The variances' scale.
    scale: f64,
    /// Mean of each row and its variance.
    means: Vec<[f64; 2]>,
    /// Weights of the logarithms in these means.
    weights: Vec<DVector<f64>>,
    /// Slope of all rows over the bounces and its variance; zeros without one.
    slope: [f64; 2],
}

impl Share {
    fn of(ratios: &Ratios, own: f64, (freedom, with_slope): (f64, bool)) -> Option<Self> {
        let each = ratios.rows.iter();
        let parts: Vec<Part> = each
            .map(|row| Part::of(row, ratios.covariance(row, own)))
            .collect::<Option<_>>()?;
        let information: f64 = parts.iter().map(|p| p.slopes).sum();
        let slope = if with_slope && information > 0.0 {
            parts.iter().map(|p| p.products).sum::<f64>() / information
        } else {
            0.0
        };
        let squares: f64 = parts.iter().map(|p| p.squares).sum();
        let squares = (squares - slope * slope * information).max(f64::MIN_POSITIVE);
        let mut weight: f64 = parts.iter().map(|p| p.weight).sum();
        if with_slope {
            weight -= 0.5 * information.ln();
        }
        let scale = squares / freedom;
        Some(Self {
            weight: weight - 0.5 * freedom * squares.ln(),
            own,
            scale,
            means: parts
                .iter()
                .map(|p| [p.mean, scale / p.information])
                .collect(),
            slope: [slope, scale / information],
            weights: parts.into_iter().map(|p| p.weights).collect(),
        })
    }
}

/// What a row adds to the normal equations, its own mean eliminated.
struct Part {
    mean: f64,
    weights: DVector<f64>,
    information: f64,
    squares: f64,
    /// Bounces' squares and their products with the values.
    slopes: f64,
    products: f64,
    /// −½ ln of the determinants.
    weight: f64,
}

impl Part {
    fn of(row: &RatioRow, covariance: DMatrix<f64>) -> Option<Self> {
        let weighing = Weighing::of(covariance)?;
        let [bounces, values] = [&row.places, &row.values].map(|v| weighing.centred(v));
        let [of_bounces, of_values] = [&bounces, &values].map(|v| weighing.factor.solve(v));
        Some(Self {
            mean: weighing.mean(&row.values),
            information: weighing.information,
            squares: values.dot(&of_values),
            slopes: bounces.dot(&of_bounces),
            products: bounces.dot(&of_values),
            weight: weighing.logarithm(),
            weights: weighing.shares(),
        })
    }
}

/// The estimates for all ratios of the variances.
struct Mixed {
    shares: Vec<Share>,
    freedom: f64,
}

impl Mixed {
    /// Mean of what each has with its variance, and its standard error.
    fn average(&self, of: impl Fn(&Share) -> [f64; 2]) -> (f64, f64) {
        let all: f64 = self.shares.iter().map(|s| s.weight).sum();
        let mean = |value: &dyn Fn(&Share) -> f64| {
            let weighted = self.shares.iter().map(|s| s.weight * value(s));
            weighted.sum::<f64>() / all
        };
        let centre = mean(&|s| of(s)[0]);
        let variance = mean(&|s| of(s)[1] + (of(s)[0] - centre).powi(2));
        (centre, variance.sqrt())
    }

    /// The logarithm of a row's R and its standard error.
    fn logarithm(&self, row: usize) -> (f64, f64) {
        self.average(|share| share.means[row])
    }

    /// Weights of a row's logarithms in its mean.
    fn weights(&self, row: usize) -> Vec<f64> {
        let weight = |k: usize| self.average(|share| [share.weights[row][k], 0.0]).0;
        (0..self.shares[0].weights[row].len()).map(weight).collect()
    }

    /// Relative standard error of each ratio of a row.
    fn ratio_errors(&self, ratios: &Ratios, row: usize) -> Vec<f64> {
        let variances = ratios.rows[row].by_errors.diagonal();
        let of = |variance: &f64| {
            let unit = variance / ratios.variances[1];
            self.average(|s| [0.0, s.scale * (unit + s.own)]).1
        };
        variances.iter().map(of).collect()
    }

    /// Standard error of the times, s, or of the heights, m.
    fn listed(&self, ratios: &Ratios) -> f64 {
        self.average(|s| [0.0, s.scale / ratios.variances[1]]).1
    }

    /// Relative standard deviation of R, where more of the typical logarithm's variance is R's with a probability
    /// near one.
    fn own(&self) -> Option<f64> {
        let all: f64 = self.shares.iter().map(|s| s.weight).sum();
        let more = self.shares.iter().filter(|s| s.own > 1.0);
        let probability = more.map(|s| s.weight).sum::<f64>() / all;
        let deviation = self.average(|s| [0.0, s.scale * s.own]).1;
        (probability > SURE).then_some(deviation)
    }
}
