//! All four parameters from folded waveforms.

use crate::evidence::Nominal;
use crate::methods::blocks::Blocks;
use crate::methods::fit::{FitResult, alone};
use crate::parameters::{Coordinate, Parameters};
use crate::solver::Precision;

/// All four parameters from the folded waveforms.
pub fn from(
    blocks: &Blocks,
    nominal: &Nominal,
    start: Parameters,
    precision: Precision,
) -> Option<FitResult> {
    if blocks.trajectory.records.is_empty() {
        return None;
    }
    let (block, tells) = (&blocks.trajectory, &Coordinate::PHYSICAL);
    Some(alone(block, blocks, nominal, tells, start, precision))
}
