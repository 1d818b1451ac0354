//! Mistakes of the laboratory that the data give away: a gap stated wrongly, a corner
//! far off, the channels of the two masses interchanged.
//!
//! A gap or an interchange is tested as an alternative: what would change if it were so, and how
//! much better would all data then fit.

use nalgebra::DVector;

use crate::identify::diagnostics::off_stated;
use impact_fit::evidence::Nominal;
use impact_fit::messages::Finding;
use impact_fit::method_fit::MethodFit;
use impact_fit::methods::blocks::Blocks;
use impact_fit::methods::trajectories::block::TrajectoryBlock;
use impact_fit::methods::trajectories::record::TrajectoryRecord;
use impact_fit::parameters::{Coordinate, GAIN_ROLES, Parameters};
use impact_fit::solver::{Block, Fit, Prior, mean_squares};
use impact_records::signal::columns::dot;

/// Standard errors from which a deviation is named.
pub(super) const SURE: f64 = 6.0;
/// Standard uncertainties of corners and of differences between both sides from which one is named.
const FAR_OFF: f64 = 4.0;
/// Least relative deviation of a gap that is named.
const GAP_LIMIT: f64 = 2e-3;
/// Standard uncertainties, those of the clearances and of the fit combined, from which a gap is named
/// whose uncertainty is stated.
pub(super) const GAP_SURE: f64 = 3.4;

/// Whether a gap is so far off that it is named, where clearances have a standard uncertainty.
fn is_named(odd: &OddGap, uncertainty_m: f64) -> bool {
    if uncertainty_m > 0.0 {
        odd.z_score.abs() > GAP_SURE
    } else {
        let relative = (odd.fitting_m / odd.stated_m - 1.0).abs();
        odd.z_score.abs() > SURE && relative > GAP_LIMIT
    }
}

/// Corners of channels that are far outside what the laboratory states of them.
pub fn corners(fit: &Fit, factor: f64, nominal: &Nominal) -> Vec<Finding> {
    let of = |coordinate: &Coordinate| {
        let Coordinate::Corner(index) = *coordinate else {
            return None;
        };
        let off = fit.parameters.coordinate(*coordinate);
        let error = fit.error(*coordinate)? * factor.sqrt();
        let allowed = nominal.corner_uncertainty.hypot(error);
        let z_score = off / allowed.max(f64::MIN_POSITIVE);
        let odd = z_score.abs() > FAR_OFF && off.abs() > SURE * error;
        let channel = *GAIN_ROLES.get(index).filter(|_| odd)?;
        Some(Finding::WrongCorner {
            channel,
            deviation: off.exp_m1(),
            z_score,
        })
    };
    fit.free.iter().filter_map(of).collect()
}

/// Differences of both sides that are far outside what is stated or assumed of them.
pub fn sides(fit: &Fit, priors: &[Prior]) -> Vec<Finding> {
    let of = |prior: &Prior| {
        let coordinate = prior.coordinate;
        let side = matches!(
            coordinate,
            Coordinate::DriveAsymmetry
                | Coordinate::StiffnessAsymmetry
                | Coordinate::DampingAsymmetry
                | Coordinate::MassAsymmetry
        );
        let difference = fit.parameters.coordinate(coordinate);
        let deviations = (difference - prior.centre) / prior.deviation;
        let odd = side && deviations.abs() > FAR_OFF;
        odd.then_some(Finding::SidesUnlike {
            coordinate,
            difference,
            deviations,
        })
    };
    priors.iter().filter_map(of).collect()
}

/// A gap that fits the other records only with another clearance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OddGap {
    /// The clearance as stated, m.
    pub stated_m: f64,
    /// The clearance that fits, m.
    pub fitting_m: f64,
    /// Its difference over its standard error.
    pub z_score: f64,
}

impl From<OddGap> for Finding {
    fn from(odd: OddGap) -> Self {
        Self::WrongClearance {
            stated_m: odd.stated_m,
            fitting_m: odd.fitting_m,
            z_score: odd.z_score,
        }
    }
}

/// The clearances that records have, each once, in rising order.
fn stated_gaps(records: &[TrajectoryRecord]) -> Vec<f64> {
    let mut gaps: Vec<f64> = records.iter().map(|r| r.clearance_m).collect();
    gaps.sort_by(f64::total_cmp);
    gaps.dedup();
    gaps
}

/// The gap that deviates most from the others: the largest mean shift in units of its error, to
/// first order about a fit. `weight` is that of the trajectories in the fit.
///
/// With the residuals' slopes J over the free coordinates and c over the gap, the shift is
/// −cᵀr / (cᵀc − cᵀJ(JᵀJ)⁻¹Jᵀc), (15). Where clearances have a stated uncertainty, the fit carries the
/// gap's error itself.
pub fn odd_gap(
    blocks: &Blocks,
    weight: f64,
    found: &MethodFit,
    uncertainty_m: f64,
) -> Option<OddGap> {
    let block = &blocks.trajectory;
    let odd: Vec<OddGap> = if uncertainty_m > 0.0 {
        gaps_beyond_stated(&blocks.gaps_m, found, uncertainty_m)
    } else {
        let gaps = stated_gaps(&block.records);
        let shifts = gaps.iter();
        shifts
            .filter_map(|gap| shift(block, weight, &found.fit, found.factor, *gap))
            .collect()
    };
    odd.into_iter()
        .max_by(|a, b| a.z_score.abs().total_cmp(&b.z_score.abs()))
        .filter(|odd| is_named(odd, uncertainty_m))
}

/// What the data alone say of the errors of all gaps that a fit carries with their priors.
pub(super) fn gaps_beyond_stated(
    gaps_m: &[f64],
    found: &MethodFit,
    uncertainty_m: f64,
) -> Vec<OddGap> {
    let gaps = gaps_m.iter().enumerate();
    gaps.filter_map(|(i, gap)| beyond_stated(found, i, *gap, uncertainty_m))
        .collect()
}

/// What the data alone say of the error of a gap that a fit carries with a prior.
fn beyond_stated(found: &MethodFit, i: usize, gap: f64, uncertainty_m: f64) -> Option<OddGap> {
    let stated = Prior::new(Coordinate::Gap(i), 0.0, 1e3 * uncertainty_m);
    let off = off_stated::alone(found, stated)?;
    Some(OddGap {
        stated_m: gap,
        fitting_m: gap + 1e-3 * off.by,
        z_score: off.z_score,
    })
}

fn shift(block: &TrajectoryBlock, weight: f64, fit: &Fit, factor: f64, gap: f64) -> Option<OddGap> {
    let (mut own, mut score) = (0.0, 0.0);
    let mut cross = DVector::zeros(fit.free.len());
    let mut seen = 0;
    // an error of the zero of all clearances is in one record the error of its gap
    let coordinates = [&fit.free[..], &[Coordinate::ScrewZero]].concat();
    // from a slope over millimetres to that over the logarithm of the clearance
    let relative = 1e3 * gap;
    for (item, record) in block.records.iter().enumerate() {
        if record.clearance_m != gap {
            continue;
        }
        let Some((residuals, mut columns)) = block.slopes(item, &fit.parameters, &coordinates)
        else {
            continue;
        };
        let Some(mut slope) = columns.pop() else {
            continue;
        };
        slope.iter_mut().for_each(|s| *s *= relative);
        own += weight * dot(&slope, &slope);
        score += weight * dot(&slope, &residuals);
        for (sum, column) in cross.iter_mut().zip(&columns) {
            *sum += weight * dot(column, &slope);
        }
        seen += 1;
    }
    if seen < 2 {
        return None;
    }
    let left = own - cross.dot(&(&fit.covariance * &cross));
    (left > 1e-9 * own).then(|| {
        let relative = -score / left;
        OddGap {
            stated_m: gap,
            fitting_m: gap * (1.0 + relative),
            z_score: relative * (left / factor).sqrt(),
        }
    })
}

/// Records of a gap that the model reaches only with another clearance: of the gaps whose records
/// a fit mostly lost, the first that another clearance within a third brings back.
pub fn lost_gap(
    block: &TrajectoryBlock,
    lost: &[TrajectoryRecord],
    parameters: &Parameters,
    typical: f64,
) -> Option<OddGap> {
    stated_gaps(lost).into_iter().find_map(|gap| {
        let records: Vec<TrajectoryRecord> = lost
            .iter()
            .filter(|r| r.clearance_m == gap)
            .cloned()
            .collect();
        let kept = block
            .records
            .iter()
            .filter(|r| r.clearance_m == gap)
            .count();
        if records.len() < 2 || kept > records.len() / 2 {
            return None;
        }
        recover(block, records, parameters, typical)
    })
}

/// Mean squares beyond this times the typical one count the same.
const CAP: f64 = 400.0;

/// Records of one gap with the clearance, within a third of the stated one, with which they fit like
/// typical ones at given parameters; `None` where none brings them there.
pub(super) fn recover(
    block: &TrajectoryBlock,
    records: Vec<TrajectoryRecord>,
    parameters: &Parameters,
    typical: f64,
) -> Option<OddGap> {
    let stated = records[0].clearance_m;
    let mut moved = Moved::of(block, records, parameters, typical);
    let centre = moved.best()?;
    let (before, after) = (moved.cost(1.0), moved.cost(centre));
    let z_score = (before - after).max(0.0).sqrt() * (centre - 1.0).signum();
    let better = after < 0.25 * before && after < 0.25 * CAP;
    (better && (centre - 1.0).abs() > GAP_LIMIT).then_some(OddGap {
        stated_m: stated,
        fitting_m: stated * centre,
        z_score,
    })
}

/// The clearance, within a third of the stated one, with which records of one gap fit best at given parameters.
pub fn fitting_clearance(
    block: &TrajectoryBlock,
    records: Vec<TrajectoryRecord>,
    parameters: &Parameters,
    typical: f64,
) -> Option<f64> {
    let stated = records.first()?.clearance_m;
    let mut moved = Moved::of(block, records, parameters, typical);
    let best = moved.best()?;
    (moved.cost(best) < CAP).then_some(stated * best)
}

/// Records of one gap at given parameters, whose clearance is moved.
struct Moved<'a> {
    block: TrajectoryBlock,
    parameters: &'a Parameters,
    typical: f64,
    stated_m: f64,
}

impl<'a> Moved<'a> {
    /// There is one record or more.
    fn of(
        block: &TrajectoryBlock,
        records: Vec<TrajectoryRecord>,
        parameters: &'a Parameters,
        typical: f64,
    ) -> Self {
        Self {
            stated_m: records[0].clearance_m,
            block: block.with_records(records),
            parameters,
            typical,
        }
    }

    /// The mean of the capped mean squares over the typical one with the stated clearance times a factor.
    fn cost(&mut self, factor: f64) -> f64 {
        for record in &mut self.block.records {
            record.clearance_m = self.stated_m * factor;
        }
        let scores = mean_squares(&self.block, self.parameters);
        let capped = scores
            .iter()
            .map(|score| score.map_or(CAP, |s| (s / self.typical).min(CAP)));
        capped.sum::<f64>() / scores.len() as f64
    }

    /// The factor within a third of one at which the cost is least.
    fn best(&mut self) -> Option<f64> {
        let (mut centre, mut width) = (1.0, 0.34);
        for _ in 0..4 {
            let (best, _) = (-60..=60)
                .map(|i| centre + width * f64::from(i) / 60.0)
                .map(|factor| (factor, self.cost(factor)))
                .min_by(|a, b| a.1.total_cmp(&b.1))?;
            (centre, width) = (best, width / 20.0);
        }
        Some(centre)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use impact_fit::fixture::fitted;

    #[test]
    fn sides_that_differ_by_more_than_is_stated_are_named() {
        let parameters = Parameters::symmetric(0.8, 12.0, 0.05, 1e-3);
        let parameters = parameters.with(Coordinate::MassAsymmetry, -0.041);
        let found = fitted(parameters, Vec::new(), DMatrix::zeros(0, 0)).fit;
        let of = |coordinate, deviation| sides(&found, &[Prior::new(coordinate, 0.0, deviation)]);
        assert_eq!(of(Coordinate::MassAsymmetry, 0.02), []);
        assert_eq!(of(Coordinate::Gap(0), 1e-6), []);
        let named = of(Coordinate::MassAsymmetry, 0.01);
        assert_eq!(
            named[0].to_string(),
            "the fit needs a mass asymmetry of −4.1 %, 4.1 times its uncertainty off what is stated \
             or assumed: weigh both masses and state mass_x and mass_y in [rig], and check springs, \
             dashpots and drives of both sides"
        );
    }
}
