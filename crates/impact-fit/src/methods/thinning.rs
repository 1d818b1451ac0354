//! Some of many records.

/// Of so many items at most, evenly chosen over a quantity.
pub(super) fn evenly_over<T: Clone>(items: &[T], most: usize, of: impl Fn(&T) -> f64) -> Vec<T> {
    let mut sorted: Vec<&T> = items.iter().collect();
    sorted.sort_by(|a, b| of(a).total_cmp(&of(b)));
    let stride = sorted.len().div_ceil(most.max(1)).max(1);
    sorted.into_iter().step_by(stride).cloned().collect()
}
