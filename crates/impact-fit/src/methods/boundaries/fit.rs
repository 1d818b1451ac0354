//! The brackets of s2, s1 and grazing, by least squares.

use crate::evidence::Nominal;
use crate::methods::blocks::Blocks;
use crate::methods::fit::{FitResult, fit_blocks, wide_priors};
use crate::parameters::{Coordinate, Parameters};
use crate::solver::Block;

/// s2, s1 and grazing brackets, with f0, β and `x_st` from the impactless records beside them.
pub fn from(blocks: &Blocks, nominal: &Nominal, start: Parameters) -> Option<FitResult> {
    if blocks.boundary.brackets.is_empty() {
        return None;
    }
    let mut free = Coordinate::PHYSICAL.to_vec();
    if !blocks.boundary.determines_restitution() {
        free.retain(|c| *c != Coordinate::Restitution);
    }
    let mut priors = wide_priors(&start, &free);
    let mut list: Vec<(&dyn Block, f64)> = vec![(&blocks.boundary, 1.0)];
    if !blocks.resonance.points.is_empty() {
        list.push((&blocks.resonance, 1.0));
        blocks.add_nuisances(nominal, &list, &mut free, &mut priors);
    }
    Some(fit_blocks(blocks.problem(list, free, priors), start))
}
