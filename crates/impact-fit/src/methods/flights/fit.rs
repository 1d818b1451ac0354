//! All four parameters by multiple shooting.

use crate::evidence::Nominal;
use crate::methods::blocks::Blocks;
use crate::methods::fit::{FitResult, alone};
use crate::parameters::{Coordinate, Parameters};
use crate::solver::Precision;

/// All four parameters from the states at the impacts of records without a closed-form orbit.
pub(super) fn from(
    blocks: &Blocks,
    nominal: &Nominal,
    start: Parameters,
    precision: Precision,
) -> Option<FitResult> {
    if blocks.flight.records.is_empty() {
        return None;
    }
    Some(alone(
        &blocks.flight,
        blocks,
        nominal,
        &Coordinate::PHYSICAL,
        start,
        precision,
    ))
}
