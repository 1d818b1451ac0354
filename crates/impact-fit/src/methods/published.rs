//! The damping ratio from published closing speeds of the z = 1 motion, where R, ρ and η are
//! given: a small identification problem with real published numbers.

use serde::Deserialize;

use crate::estimate::{estimate, not_identifiable};
use crate::messages::{Finding, Note, PublishedSetting, Remark, Sentence};
use crate::method::Method;
use crate::methods::answer::{MethodResult, Verdict, VerdictKind};
use crate::parameters::Coordinate;
use crate::solver::scalar;
use crate::statistics::quantile::NORMAL_975;
use impact_oscillator::model::orbit::Branch;
use impact_oscillator::model::params::Machine;

/// The method.
pub const METHOD: Method = Method::PublishedSpeeds;

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

/// Cost where a speed has no motion: finite, so that a parabola through it means something.
const NO_MOTION: f64 = 1e30;
/// Damping ratios that are searched, and how finely.
const DAMPING_RATIOS: [f64; 2] = [1e-4, 0.3];
const DAMPING_POINTS: u32 = 160;
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
    let over_log = |log: f64| cost(speeds, log.exp()).unwrap_or(NO_MOTION);
    let log = scalar::least(over_log, [start - step, start + step], BRENT_TOLERANCE)?;
    Some(log.exp())
}

/// Greatest relative deviation of a speed at which a damping ratio fits them.
const FITTING: f64 = 0.01;

/// β from published speeds, and the verdict on them and on printed values of it.
pub fn fit(speeds: &[PublishedSpeed], printed: &[f64]) -> (MethodResult, Verdict) {
    let mut result = MethodResult {
        observations: speeds.len(),
        ..MethodResult::default()
    };
    let Some(beta) = best(speeds) else {
        result.parameters.damping_ratio = Some(not_identifiable(Note::NoPublishedMotion));
        let verdict = Verdict {
            kind: VerdictKind::DoesNotFit,
            sentences: vec![Sentence::NoPublishedDamping],
            findings: Vec::new(),
        };
        return (result, verdict);
    };
    let squares = cost(speeds, beta).unwrap_or(f64::INFINITY);
    let factor = (squares / speeds.len().saturating_sub(1).max(1) as f64).max(1.0);
    let error = log_error(speeds, beta) * factor.sqrt();
    let estimate = estimate(Coordinate::Damping, beta.ln(), error);
    let sentence = match estimate.value {
        Some(damping_ratio) => Sentence::PublishedDamping { damping_ratio },
        None => Sentence::NoPublishedDamping,
    };
    result.parameters.damping_ratio = Some(estimate);
    result.reduced_residual = Some(factor.sqrt());
    // `best` finds only ratios with which every speed has a motion
    let deviation = worst_deviation(speeds, beta).unwrap_or(f64::MAX);
    let fits = deviation < FITTING;
    result.fits = Some(fits);
    result.remarks.push(Remark::PublishedSpeedsMet {
        damping_ratio: beta,
        deviation,
    });
    let judged = printed.iter().map(|p| judge(speeds, *p, beta, error));
    let verdict = Verdict {
        kind: if fits {
            VerdictKind::Identified
        } else {
            VerdictKind::DoesNotFit
        },
        sentences: vec![sentence],
        findings: judged.collect(),
    };
    (result, verdict)
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

/// Greatest relative deviation of a speed; `None` where one has no motion.
fn worst_deviation(speeds: &[PublishedSpeed], beta: f64) -> Option<f64> {
    let deviation =
        |s: &PublishedSpeed| Some((predicted(s, beta)? / s.closing_speed_ratio - 1.0).abs());
    speeds
        .iter()
        .map(deviation)
        .try_fold(0.0, |worst: f64, d| Some(worst.max(d?)))
}

/// Whether a printed damping ratio fits.
fn judge(speeds: &[PublishedSpeed], printed: f64, beta: f64, error: f64) -> Finding {
    let settings: Vec<PublishedSetting> = speeds
        .iter()
        .filter(|s| speed_at(s, printed, s.frequency_ratio).is_none())
        .map(|s| PublishedSetting {
            restitution: s.restitution,
            frequency_ratio: s.frequency_ratio,
        })
        .collect();
    let far = (printed / beta).ln().abs() > NORMAL_975 * error;
    match worst_deviation(speeds, printed) {
        Some(deviation) if settings.is_empty() => {
            if far {
                Finding::PrintedDampingDoesNotFit { printed, deviation }
            } else {
                Finding::PrintedDampingFits { printed }
            }
        }
        deviation => Finding::PrintedDampingWithoutMotion {
            printed,
            deviation,
            settings,
        },
    }
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
        let (result, verdict) = fit(&paper(), &[0.02, 0.002]);
        let beta = result.parameters.damping_ratio.unwrap();
        assert!((beta.value.unwrap() - 0.005).abs() < 5e-4, "{beta:?}");
        assert_eq!(verdict.kind, VerdictKind::Identified);
        let findings = &verdict.findings;
        assert!(
            matches!(findings[0], Finding::PrintedDampingWithoutMotion { .. }),
            "{findings:?}"
        );
        assert!(
            !matches!(findings[1], Finding::PrintedDampingFits { .. }),
            "{findings:?}"
        );
    }
}
