//! What the brackets give.

use crate::estimate::{self, Estimate};
use crate::messages::Remark;
use crate::methods::answer::MethodResult;
use crate::methods::blocks::Blocks;
use crate::methods::boundaries::midpoints;
use crate::methods::boundaries::posterior::Posterior;
use crate::methods::fit::{self, FitResult};
use crate::parameters::{Coordinate, Parameters};
use crate::statistics::quantile::NORMAL_975;

/// All four parameters from the brackets, where no resonance curve is beside them.
pub(super) fn by_least_squares(blocks: &Blocks, fitted: &FitResult) -> MethodResult {
    let brackets = blocks.boundary.brackets.len();
    let tells = match fitted {
        Ok(found) => found.fit.free.clone(),
        Err(_) => Coordinate::PHYSICAL.to_vec(),
    };
    fit::result(fitted, &tells, brackets, 2 * brackets)
}

/// R from the brackets by its posterior, the rest as the resonance curve has it: that is the curve's to say.
pub fn by_posterior(blocks: &Blocks, posterior: &Posterior, curve: &Parameters) -> MethodResult {
    let brackets = blocks.boundary.brackets.len();
    let (value, error) = posterior.restitution;
    let mut estimate = estimate::estimate(Coordinate::Restitution, value, error);
    estimate.interval95 = estimate.interval95.map(|_| posterior.interval95);
    let about = Parameters {
        restitution: value,
        ..*curve
    };
    let midpoints = midpoints::restitution(&blocks.boundary, &about);
    let early = posterior.early;
    let mut result = MethodResult {
        observations: brackets,
        records: 2 * brackets,
        ..MethodResult::default()
    };
    result.parameters.restitution = Some(estimate);
    result
        .remarks
        .extend(midpoints.as_ref().and_then(by_midpoints));
    result
        .remarks
        .extend(early.map(|distance| Remark::EarlyJumps { distance }));
    result.restitution_by_midpoints = midpoints;
    result
}

fn by_midpoints(estimate: &Estimate) -> Option<Remark> {
    Some(Remark::BracketMidpoints {
        restitution: estimate.value?,
        half_width: NORMAL_975 * estimate.standard_error?,
    })
}
