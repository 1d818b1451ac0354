//! What multiple shooting gives.

use crate::messages::Remark;
use crate::methods::answer::MethodResult;
use crate::methods::blocks::Blocks;
use crate::methods::fit::{self, FitResult};
use crate::parameters::Coordinate;

/// All four parameters from records that are shot from impact to impact.
pub(super) fn result(blocks: &Blocks, fitted: &FitResult) -> MethodResult {
    let records = &blocks.flight.records;
    let impacts = records.iter().map(|r| r.nodes.len()).sum();
    let mut result = fit::result(fitted, &Coordinate::PHYSICAL, impacts, records.len());
    if let Some(reduced) = result.reduced_residual {
        result
            .remarks
            .push(Remark::StatesDeviate { ratio: reduced });
    }
    result
}
