//! How good estimates are over many campaigns with known truth: bias, root-mean-square error
//! against the Cramér–Rao bound, and coverage of the 95 % intervals.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::identify::uncertainty::bound::Bound;
use impact_fit::parameters::{Coordinate, Parameters};
use impact_fit::statistics::quantile::NORMAL_975;
use impact_fit::{Estimator, Method, MethodResult, ParameterSet, Status};

/// How one parameter came out of one method over all campaigns. Errors of R are absolute, those
/// of the others relative.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Campaigns that gave a value.
    pub estimates: usize,
    /// Campaigns that called it not identifiable.
    pub refused: usize,
    /// Refusals although the bound says that the data tell it well.
    pub refused_without_reason: usize,
    /// Values called identified although the bound says that the data cannot tell it.
    pub claimed_without_reason: usize,
    /// Mean error.
    pub bias: f64,
    /// Root-mean-square error.
    pub rms_error: f64,
    /// Root mean square of the Cramér–Rao bounds.
    pub bound: f64,
    /// Root mean square of each campaign's error over its own bound.
    pub rms_error_over_bound: f64,
    /// Median of |error| over the bound; 0.674 for normal errors at the bound.
    pub median_error_over_bound: f64,
    /// Share of the 95 % intervals that hold the truth.
    pub coverage95: f64,
    /// Median of half their widths.
    pub median_half_width95: f64,
    /// Campaign with the greatest error over its bound, counted from 0.
    pub worst_campaign: Option<usize>,
}

/// One campaign's outcome: estimates and bounds of each method and of the joint fit.
#[derive(Debug, Clone)]
pub struct Trial {
    /// The true parameters.
    pub truth: Parameters,
    /// Estimates by method.
    pub estimates: BTreeMap<Estimator, ParameterSet>,
    /// Bounds by method.
    pub bounds: BTreeMap<Estimator, Bound>,
}

impl Trial {
    /// Collect a campaign's results.
    pub fn new(
        truth: Parameters,
        joint: &MethodResult,
        methods: &BTreeMap<Method, MethodResult>,
        bounds: BTreeMap<Estimator, Bound>,
    ) -> Self {
        let mut estimates: BTreeMap<Estimator, ParameterSet> = methods
            .iter()
            .map(|(method, m)| (Estimator::Method(*method), m.parameters.clone()))
            .collect();
        estimates.insert(Estimator::Joint, joint.parameters.clone());
        Self {
            truth,
            estimates,
            bounds,
        }
    }
}

/// Bound below which a refusal has no reason, as a fraction of what counts as weak, and above
/// which a claim has none, as a multiple.
const CLEAR: f64 = 3.0;

/// Scores by method and name of the parameter.
pub fn scores(trials: &[Trial]) -> BTreeMap<Estimator, BTreeMap<&'static str, Score>> {
    let mut all: BTreeMap<_, BTreeMap<_, _>> = BTreeMap::new();
    let estimators: BTreeSet<Estimator> = trials
        .iter()
        .flat_map(|t| t.estimates.keys().copied())
        .collect();
    for estimator in estimators {
        for coordinate in Coordinate::PHYSICAL {
            if let Some(score) = score(trials, estimator, coordinate) {
                let scores = all.entry(estimator).or_default();
                scores.insert(coordinate.name(), score);
            }
        }
    }
    all
}

/// Score of one parameter; `None` where no campaign's method estimates it.
fn score(trials: &[Trial], estimator: Estimator, coordinate: Coordinate) -> Option<Score> {
    let weak = impact_fit::estimate::limits(coordinate).0 / NORMAL_975;
    let mut score = Score::default();
    let (mut errors, mut ratios, mut bounds, mut covered) = (vec![], vec![], vec![], 0);
    let mut half_widths = vec![];
    let mut worst = 0.0;
    for (number, trial) in trials.iter().enumerate() {
        let estimates = trial.estimates.get(&estimator);
        let Some(estimate) = estimates.and_then(|p| p.get(coordinate)) else {
            continue;
        };
        let bound = trial
            .bounds
            .get(&estimator)
            .and_then(|b| b.error(coordinate));
        let Some((value, [low, high])) = estimate.value.zip(estimate.interval95) else {
            score.refused += 1;
            score.refused_without_reason += usize::from(bound.is_some_and(|b| b < weak / CLEAR));
            continue;
        };
        let (truth, unit) = true_value(&trial.truth, coordinate);
        let claimed = estimate.status == Status::Identified;
        score.claimed_without_reason +=
            usize::from(claimed && bound.is_some_and(|b| b > weak * CLEAR));
        errors.push((value - truth) / unit);
        covered += usize::from(low <= truth && truth <= high);
        half_widths.push((high - low) / 2.0 / unit);
        if let Some(bound) = bound.filter(|b| *b > 0.0) {
            let ratio = (value - truth) / unit / bound;
            if ratio.abs() > worst {
                (worst, score.worst_campaign) = (ratio.abs(), Some(number));
            }
            ratios.push(ratio);
            bounds.push(bound);
        }
    }
    if errors.is_empty() && score.refused == 0 {
        return None;
    }
    let count = errors.len().max(1) as f64;
    score.estimates = errors.len();
    score.bias = errors.iter().sum::<f64>() / count;
    score.rms_error = impact_records::signal::robust::rms(&errors);
    score.bound = impact_records::signal::robust::rms(&bounds);
    score.rms_error_over_bound = impact_records::signal::robust::rms(&ratios);
    let sizes: Vec<f64> = ratios.iter().map(|r| r.abs()).collect();
    score.median_error_over_bound = impact_records::signal::robust::median(&sizes).unwrap_or(0.0);
    score.coverage95 = covered as f64 / count;
    score.median_half_width95 = impact_records::signal::robust::median(&half_widths).unwrap_or(0.0);
    Some(score)
}

/// What one method found of one parameter in one campaign: of R absolute, errors of the others relative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimated {
    /// The campaign, counted from 0.
    pub campaign: usize,
    /// The method, or the joint fit.
    pub estimator: Estimator,
    /// The parameter.
    pub coordinate: Coordinate,
    /// Its true value.
    pub truth: f64,
    /// Its estimate.
    pub value: Option<f64>,
    /// Its 95 % interval.
    pub interval95: Option<[f64; 2]>,
    /// The Cramér–Rao bound of its standard error.
    pub bound: Option<f64>,
}

/// All estimates, campaign by campaign.
pub fn all_estimates(trials: &[Trial]) -> Vec<Estimated> {
    let of_campaign = |(campaign, trial): (usize, &Trial)| {
        let of_method = |(estimator, estimates): (&Estimator, &ParameterSet)| {
            let bound = trial.bounds.get(estimator);
            let of_parameter = |coordinate: Coordinate| {
                let estimate = estimates.get(coordinate)?;
                Some(Estimated {
                    campaign,
                    estimator: *estimator,
                    coordinate,
                    truth: true_value(&trial.truth, coordinate).0,
                    value: estimate.value,
                    interval95: estimate.interval95,
                    bound: bound.and_then(|b| b.error(coordinate)),
                })
            };
            let all = Coordinate::PHYSICAL.into_iter();
            all.filter_map(of_parameter).collect::<Vec<_>>()
        };
        trial
            .estimates
            .iter()
            .flat_map(of_method)
            .collect::<Vec<_>>()
    };
    trials.iter().enumerate().flat_map(of_campaign).collect()
}

/// True value of a parameter and the unit of its errors.
fn true_value(truth: &Parameters, coordinate: Coordinate) -> (f64, f64) {
    let value = coordinate.physical(truth.coordinate(coordinate));
    (value, coordinate.slope(value))
}
