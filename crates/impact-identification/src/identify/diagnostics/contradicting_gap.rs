//! A gap that is stated so far off that a fit of all records is nowhere near the rig: each gap is left
//! out in turn, and what remains is fitted again.
//!
//! The first order about a fit, which finds smaller errors of a gap, may then accuse another gap.

use crate::identify::diagnostics::suspicion::{OddGap, recover};
use impact_fit::methods::blocks::Blocks;
use impact_fit::methods::trajectories::record::TrajectoryRecord;
use impact_fit::parameters::Parameters;
use impact_fit::solver::mean_squares;
use impact_records::signal::robust;

/// Mean square of the residuals from which the records contradict each other.
const MISFIT: f64 = 4.0;
/// Greatest share of it that may remain without the odd gap, and of what remains without any other.
const REMAINS: f64 = 0.25;
/// Waveforms of each gap that are looked at.
const FEW: usize = 8;
/// Fewest gaps that can outvote one.
const FEWEST_GAPS: usize = 3;

/// A fit of some records: its parameters, and the mean square of its residuals.
pub type FittedWithMeanSquare = (Parameters, f64);

/// The gap without which all other records fit far better, by `fit`, where that is so of one gap alone;
/// `lost` are records that the blocks have no more. The fit of all starts at what was `found` of them, the others at
/// `start`, which no gap has led astray.
pub fn contradicting_gap(
    blocks: &Blocks,
    lost: &[TrajectoryRecord],
    [start, found]: [&Parameters; 2],
    fit: &dyn Fn(&Blocks, &Parameters) -> Option<FittedWithMeanSquare>,
) -> Option<OddGap> {
    let records = of_each_gap(blocks.trajectory.records.iter().chain(lost).collect());
    let mut few = blocks.with_trajectory(blocks.trajectory.with_records(records));
    few.allow_least(start);
    let mut gaps: Vec<f64> = few
        .trajectory
        .records
        .iter()
        .map(|r| r.clearance_m)
        .collect();
    gaps.dedup();
    let (_, all) = fit(&few, found)?;
    if gaps.len() < FEWEST_GAPS || all < MISFIT {
        return None;
    }
    let mut left: Vec<(f64, Parameters, f64)> = gaps
        .into_iter()
        .filter_map(|gap| {
            let mut others = few.clone();
            others.trajectory.records.retain(|r| r.clearance_m != gap);
            let (parameters, remains) = fit(&others, start)?;
            Some((remains, parameters, gap))
        })
        .collect();
    left.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [(best, parameters, gap), (next, ..), ..] = left.as_slice() else {
        return None;
    };
    let alone = *best < REMAINS * all && *best < REMAINS * next;
    let block = &few.trajectory;
    let own = block.records.iter().filter(|r| r.clearance_m == *gap);
    let own: Vec<TrajectoryRecord> = own.cloned().collect();
    let scores: Vec<f64> = mean_squares(block, parameters)
        .into_iter()
        .flatten()
        .collect();
    let typical = robust::median(&scores).unwrap_or(1.0).max(1.0);
    alone.then(|| recover(block, own, parameters, typical))?
}

/// A few records of each gap, spread over them, in the order of the gaps.
fn of_each_gap(mut records: Vec<&TrajectoryRecord>) -> Vec<TrajectoryRecord> {
    records.sort_by(|a, b| a.clearance_m.total_cmp(&b.clearance_m));
    let gaps = records.chunk_by(|a, b| a.clearance_m == b.clearance_m);
    gaps.flat_map(|gap| {
        let step = gap.len().div_ceil(FEW).max(1);
        gap.iter().step_by(step).copied().cloned()
    })
    .collect()
}
