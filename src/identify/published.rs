//! The damping ratio from published closing speeds of the z = 1 motion, where R, ρ and η are
//! given: a small identification problem with real published numbers.

use std::collections::BTreeMap;

use argmin::core::{CostFunction, Executor};
use argmin::solver::brent::BrentOpt;
use serde::Deserialize;

use crate::identify::estimate::{NORMAL_975, estimate};
use crate::identify::fit::parameters::Coordinate;
use crate::identify::{Agreement, MethodResult, Verdict, VerdictKind};
use impact_oscillator::model::orbit::Branch;
use impact_oscillator::model::params::Machine;

/// Where a published speed belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Where {
    /// The greatest on the branch over η.
    Greatest,
    /// At the printed η.
    At,
}

/// One published closing speed, dimensionless.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PublishedSpeed {
    /// R
    pub restitution: f64,
    /// ρ
    pub clearance_ratio: f64,
    /// η as printed.
    pub frequency_ratio: f64,
    /// X'₋ + Y'₋ as printed.
    pub closing_speed_ratio: f64,
    /// Step of the printed number's last digit.
    pub printed_step: f64,
    /// Where it belongs.
    #[serde(rename = "where")]
    pub place: Where,
}

/// Range of η about the printed one that is searched for the greatest speed.
const SEARCH: f64 = 0.12;
const SEARCH_POINTS: usize = 600;

/// Closing speed of the z = 1 branch at η; `None` beyond its saddle-node.
fn speed_at(published: &PublishedSpeed, damping_ratio: f64, eta: f64) -> Option<f64> {
    let machine = Machine::symmetric(damping_ratio, published.restitution);
    let branch = Branch::new(&machine, eta, 1);
    let gap = machine.gap(published.clearance_ratio);
    branch
        .approach_speeds(published.restitution, gap)
        .map(|[_, larger]| larger)
}

/// The speed that the model has for a published one; `None` where there is no such motion.
pub fn predicted(published: &PublishedSpeed, damping_ratio: f64) -> Option<f64> {
    match published.place {
        Where::At => speed_at(published, damping_ratio, published.frequency_ratio),
        Where::Greatest => (0..=SEARCH_POINTS)
            .map(|i| 2.0 * i as f64 / SEARCH_POINTS as f64 - 1.0)
            .map(|u| published.frequency_ratio * (1.0 + SEARCH * u))
            .filter_map(|eta| speed_at(published, damping_ratio, eta))
            .reduce(f64::max),
    }
}

/// Standard deviation of a printed number: rounding, and a thousandth for how it was read off.
fn deviation(published: &PublishedSpeed) -> f64 {
    (published.printed_step / 12f64.sqrt()).hypot(1e-3 * published.closing_speed_ratio)
}

/// Sum of squared weighted deviations; `None` where a speed has no motion.
fn cost(speeds: &[PublishedSpeed], damping_ratio: f64) -> Option<f64> {
    speeds
        .iter()
        .map(|s| {
            let apart = predicted(s, damping_ratio)? - s.closing_speed_ratio;
            Some((apart / deviation(s)).powi(2))
        })
        .sum()
}

/// The cost over ln β.
struct OverLogDamping<'a>(&'a [PublishedSpeed]);

impl CostFunction for OverLogDamping<'_> {
    type Param = f64;
    type Output = f64;

    fn cost(&self, log: &f64) -> Result<f64, argmin::core::Error> {
        Ok(cost(self.0, log.exp()).unwrap_or(NO_MOTION))
    }
}

/// Cost where a speed has no motion: finite, so that a parabola through it means something.
const NO_MOTION: f64 = 1e30;
/// Damping ratios that are searched, and how finely.
const DAMPING_RATIOS: [f64; 2] = [1e-4, 0.3];
const DAMPING_POINTS: u32 = 160;
/// Steps of Brent's method at most; it takes about ten.
const BRENT_STEPS: u64 = 100;
/// How far from the optimum it may end, in ln β.
const BRENT_TOLERANCE: f64 = 1e-9;

/// Damping ratio with the least cost: a logarithmic grid, then Brent's method.
fn best(speeds: &[PublishedSpeed]) -> Option<f64> {
    let [first, last] = DAMPING_RATIOS.map(f64::ln);
    let step = (last - first) / f64::from(DAMPING_POINTS);
    let grid = (0..=DAMPING_POINTS).map(|i| first + step * f64::from(i));
    let (start, _) = grid
        .filter_map(|log| Some((log, cost(speeds, log.exp())?)))
        .min_by(|a, b| a.1.total_cmp(&b.1))?;
    let brent = BrentOpt::new(start - step, start + step).set_tolerance(0.0, BRENT_TOLERANCE);
    let found = Executor::new(OverLogDamping(speeds), brent)
        .configure(|state| state.max_iters(BRENT_STEPS))
        .timer(false)
        .run();
    let log = found.ok()?.state.best_param?;
    Some(log.exp())
}

/// What the published speeds tell, and whether printed damping ratios fit them.
#[derive(Debug, Clone)]
pub struct PublishedOutcome {
    /// The method's result.
    pub result: MethodResult,
    /// The verdict.
    pub verdict: Verdict,
    /// Sentences on each hypothesis.
    pub hypotheses: Vec<String>,
}

/// Identify β from published speeds and test printed values of it.
pub fn identify(speeds: &[PublishedSpeed], hypotheses: &[f64]) -> PublishedOutcome {
    let mut result = MethodResult {
        observations: speeds.len(),
        ..MethodResult::default()
    };
    let Some(beta) = best(speeds) else {
        result.parameters.damping_ratio = Some(crate::identify::estimate::not_identifiable(
            "no damping ratio gives all of these motions",
        ));
        return outcome(result, VerdictKind::DoesNotFit, Vec::new());
    };
    let squares = cost(speeds, beta).unwrap_or(f64::INFINITY);
    let factor = (squares / speeds.len().saturating_sub(1).max(1) as f64).max(1.0);
    let error = log_error(speeds, beta) * factor.sqrt();
    result.parameters.damping_ratio = Some(estimate(Coordinate::Damping, beta.ln(), error, None));
    result.reduced_residual = Some(factor.sqrt());
    let worst = worst_deviation(speeds, beta);
    result.fits = Some(worst < 0.01);
    result.remarks.push(format!(
        "with β = {beta:.4} the speeds are met within {:.2} %",
        100.0 * worst
    ));
    let hypotheses: Vec<String> = hypotheses
        .iter()
        .map(|h| judge(speeds, *h, (beta, error)))
        .collect();
    let kind = if worst < 0.01 {
        VerdictKind::Identified
    } else {
        VerdictKind::DoesNotFit
    };
    outcome(result, kind, hypotheses)
}

fn outcome(result: MethodResult, kind: VerdictKind, hypotheses: Vec<String>) -> PublishedOutcome {
    let value = result
        .parameters
        .damping_ratio
        .as_ref()
        .and_then(|e| e.value);
    let summary = match value {
        Some(beta) => format!("The published speeds belong to a damping ratio β of {beta:.4}."),
        None => "No damping ratio gives the published speeds.".to_owned(),
    };
    PublishedOutcome {
        verdict: Verdict {
            kind,
            summary,
            findings: hypotheses.clone(),
        },
        result,
        hypotheses,
    }
}

/// Standard error of ln β for unit variance, from the slope of each speed.
fn log_error(speeds: &[PublishedSpeed], beta: f64) -> f64 {
    let step = 1e-3f64;
    let information: f64 = speeds
        .iter()
        .filter_map(|s| {
            let above = predicted(s, beta * step.exp())?;
            let below = predicted(s, beta * (-step).exp())?;
            Some(((above - below) / (2.0 * step) / deviation(s)).powi(2))
        })
        .sum();
    information.sqrt().recip()
}

fn worst_deviation(speeds: &[PublishedSpeed], beta: f64) -> f64 {
    speeds
        .iter()
        .map(|s| match predicted(s, beta) {
            Some(speed) => (speed / s.closing_speed_ratio - 1.0).abs(),
            None => f64::INFINITY,
        })
        .fold(0.0, f64::max)
}

/// Whether a printed damping ratio fits, in one sentence.
fn judge(speeds: &[PublishedSpeed], printed: f64, (beta, error): (f64, f64)) -> String {
    let missing: Vec<String> = speeds
        .iter()
        .filter(|s| speed_at(s, printed, s.frequency_ratio).is_none())
        .map(|s| format!("R = {} at η = {}", s.restitution, s.frequency_ratio))
        .collect();
    let worst = worst_deviation(speeds, printed);
    let far = (printed / beta).ln().abs() > NORMAL_975 * error;
    if missing.is_empty() && !far {
        return format!("The printed β = {printed} fits the speeds.");
    }
    let orbits = match missing.as_slice() {
        [] => String::new(),
        list => format!(
            "; the motion for {} does not exist with it",
            list.join(" and ")
        ),
    };
    format!(
        "The printed β = {printed} does not fit: a speed is off by {:.1} %{orbits}.",
        100.0 * worst
    )
}

/// Methods and agreement as an identification holds them.
pub fn methods(outcome: &PublishedOutcome) -> (BTreeMap<String, MethodResult>, Agreement) {
    let methods = [("published_speeds".to_owned(), outcome.result.clone())].into();
    let agreement = Agreement {
        agree: None,
        summary: "Only one method tells each parameter.".into(),
        pairs: Vec::new(),
    };
    (methods, agreement)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper() -> Vec<PublishedSpeed> {
        let row = |restitution, frequency_ratio, closing_speed_ratio, printed_step, place| {
            PublishedSpeed {
                restitution,
                clearance_ratio: 3.0,
                frequency_ratio,
                closing_speed_ratio,
                printed_step,
                place,
            }
        };
        vec![
            row(0.0, 1.19, 9.26, 0.01, Where::Greatest),
            row(0.3, 1.31, 9.53, 0.01, Where::Greatest),
            row(0.6, 1.47, 11.9, 0.1, Where::Greatest),
            row(0.9, 1.78, 28.16, 0.01, Where::Greatest),
            row(0.9, 1.5, 13.65, 0.01, Where::At),
        ]
    }

    #[test]
    fn valid_the_papers_speeds_belong_to_a_damping_ratio_of_0_005() {
        let found = identify(&paper(), &[0.02, 0.002]);
        let beta = found.result.parameters.damping_ratio.unwrap();
        assert!((beta.value.unwrap() - 0.005).abs() < 5e-4, "{beta:?}");
        assert_eq!(found.verdict.kind, VerdictKind::Identified);
        assert!(
            found.hypotheses.iter().all(|h| h.contains("does not fit")),
            "{:?}",
            found.hypotheses
        );
        assert!(
            found.hypotheses[0].contains("does not exist"),
            "{:?}",
            found.hypotheses
        );
    }
}
