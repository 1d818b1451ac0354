//! R alone from the speeds at impacts.

use crate::evidence::Nominal;
use crate::methods::blocks::Blocks;
use crate::methods::fit::{FitResult, fit_blocks};
use crate::methods::impacts::block::FirstValueOnly;
use crate::parameters::{Coordinate, Parameters};
use crate::solver::{Block, FitError};

/// R alone from the speeds at impacts, with the corners of the velocities' high-pass as nuisances. The
/// speeds of one of two masses do not tell it: an unlike drive of the other one moves their ratio by
/// (1 + R)/2 times its share, which waveforms take into account. Nor do differentiated displacements.
pub fn from(blocks: &Blocks, nominal: &Nominal, start: Parameters) -> Option<FitResult> {
    if blocks.impact.pairs.len() < blocks.impact.fewest() {
        return None;
    }
    match blocks.impact.first_value_only {
        Some(FirstValueOnly::OneOfTwo) => return Some(Err(FitError::OneOfTwo)),
        Some(FirstValueOnly::Differentiated) => return Some(Err(FitError::Differentiated)),
        Some(FirstValueOnly::Ringing) => return Some(Err(FitError::Ringing)),
        Some(FirstValueOnly::Clipped) => return Some(Err(FitError::Clipped)),
        None => {}
    }
    let list: Vec<(&dyn Block, f64)> = vec![(&blocks.impact, 1.0)];
    let (mut free, mut priors) = (vec![Coordinate::Restitution], Vec::new());
    blocks.add_nuisances(nominal, &list, &mut free, &mut priors);
    Some(fit_blocks(blocks.problem(list, free, priors), start))
}
