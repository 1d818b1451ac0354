//! Some of many records.

use crate::methods::trajectories::record::TrajectoryRecord;

/// Of so many items at most, evenly spread.
pub fn every<T: Clone>(items: &[T], most: usize) -> Vec<T> {
    let stride = items.len().div_ceil(most.max(1)).max(1);
    items.iter().step_by(stride).cloned().collect()
}

/// Of so many items at most, evenly chosen over a quantity.
pub(super) fn evenly_over<T: Clone>(items: &[T], most: usize, of: impl Fn(&T) -> f64) -> Vec<T> {
    let mut sorted: Vec<&T> = items.iter().collect();
    sorted.sort_by(|a, b| of(a).total_cmp(&of(b)));
    every(&sorted, most).into_iter().cloned().collect()
}

/// Of each gap so many records at most, evenly spread, in the order of the gaps.
pub fn of_each_gap<'a>(
    records: impl IntoIterator<Item = &'a TrajectoryRecord>,
    most: usize,
) -> Vec<TrajectoryRecord> {
    let mut records: Vec<&TrajectoryRecord> = records.into_iter().collect();
    records.sort_by(|a, b| a.clearance_m.total_cmp(&b.clearance_m));
    let gaps = records.chunk_by(|a, b| a.clearance_m == b.clearance_m);
    gaps.flat_map(|gap| every(gap, most)).cloned().collect()
}
