//! What multiple shooting gives.

use crate::messages::Remark;
use crate::methods::answer::MethodResult;
use crate::methods::blocks::Blocks;
use crate::methods::fit::{self, FitResult};
use crate::parameters::Coordinate;

/// Scatter of R over it from which it is named: less changes nothing that a text shows.
const LEAST_NOTICED: f64 = 1e-3;

/// All four parameters from records that are shot from impact to impact.
pub(super) fn result(blocks: &Blocks, fitted: &FitResult) -> MethodResult {
    let records = &blocks.flight.records;
    let impacts = records.iter().map(|r| r.nodes.len()).sum();
    let mut result = fit::result(fitted, &Coordinate::PHYSICAL, impacts, records.len());
    if let Some(ratio) = result.reduced_residual {
        result.remarks.push(Remark::StatesDeviate { ratio });
    }
    let restitution = result.parameters.get(Coordinate::Restitution);
    let share = restitution.and_then(|r| Some(blocks.flight.scatter() / r.value?));
    let noticed = share.filter(|share| *share > LEAST_NOTICED);
    result
        .remarks
        .extend(noticed.map(|share| Remark::RestitutionScatters { share }));
    result
}
